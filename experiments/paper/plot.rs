//! Figure 1 as a plot: a panel for each number of motions, errors on a logarithmic scale.
use experiments::Failure;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::figure_1::{Cell, METHODS};

const SIZE: (u32, u32) = (1080, 440);
const LEGEND: i32 = 64;
/// Range of the errors, per cent. Errors without noise are below it.
const RANGE: std::ops::Range<f64> = 0.1..1000.0;
/// A colour for each method, from the palette of Okabe and Ito for all kinds of colour vision.
const COLOURS: [RGBColor; METHODS.len()] =
    [RGBColor(213, 94, 0), RGBColor(230, 159, 0), RGBColor(0, 114, 178), RGBColor(0, 0, 0)];
const GRID: RGBColor = RGBColor(215, 215, 215);
/// Errors stated in the paper for 5 % noise: number of motions, method, error in per cent.
const STATED: [(usize, usize, f64); 4] = [(2, 0, 6.0), (2, 1, 2.1), (3, 1, 8.2), (4, 1, 13.3)];

/// The plot as an SVG file.
pub(crate) fn svg(cells: &[Cell]) -> Result<String, Failure> {
    let mut text = String::new();
    {
        let area = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        area.fill(&WHITE)?;
        let (legend, panels) = area.split_vertically(LEGEND);
        draw_legend(&legend)?;
        for (panel, motions) in panels.split_evenly((1, 3)).iter().zip([2, 3, 4]) {
            let own: Vec<&Cell> = cells.iter().filter(|cell| cell.motions == motions).collect();
            draw_panel(panel, motions, &own)?;
        }
        area.present()?;
    }
    Ok(text)
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

fn draw_panel(area: &Area<'_>, motions: usize, cells: &[&Cell]) -> Result<(), Failure> {
    let mut chart = ChartBuilder::on(area)
        .caption(format!("n = {motions}"), ("sans-serif", 18))
        .margin(10)
        .margin_right(18)
        .x_label_area_size(40)
        .y_label_area_size(58)
        .build_cartesian_2d(0.8..5.2, RANGE.log_scale())?;
    chart
        .configure_mesh()
        .bold_line_style(GRID)
        .light_line_style(TRANSPARENT)
        .x_labels(6)
        .x_label_formatter(&|x| format!("{x:.0} %"))
        .y_label_formatter(&|y| format!("{y} %"))
        .x_desc("noise")
        .y_desc("error (20)")
        .label_style(("sans-serif", 13))
        .draw()?;
    for (m, colour) in COLOURS.iter().enumerate() {
        let curve = |value: fn(&Cell, usize) -> f64| -> Vec<(f64, f64)> {
            let noisy = cells.iter().filter(|cell| cell.noise > 0);
            let clamped = |value: f64| value.clamp(RANGE.start, RANGE.end);
            noisy.map(|cell| (cell.noise as f64, clamped(value(cell, m)))).collect()
        };
        let means = curve(|cell, m| cell.methods[m].mean);
        chart.draw_series(LineSeries::new(means.clone(), colour.stroke_width(2)))?;
        chart.draw_series(means.iter().map(|&point| Circle::new(point, 3, colour.filled())))?;
        let medians = curve(|cell, m| cell.methods[m].median);
        chart.draw_series(DashedLineSeries::new(medians, 4, 4, colour.stroke_width(1)))?;
    }
    for (_, m, error) in STATED.into_iter().filter(|stated| stated.0 == motions) {
        chart.draw_series([Cross::new((5.0, error), 7, COLOURS[m].stroke_width(2))])?;
    }
    Ok(())
}

fn draw_legend(area: &Area<'_>) -> Result<(), Failure> {
    let style = ("sans-serif", 14).into_text_style(area).pos(Pos::new(HPos::Left, VPos::Center));
    let mut left = 60;
    for (method, colour) in METHODS.iter().zip(COLOURS) {
        area.draw(&PathElement::new([(left, 22), (left + 28, 22)], colour.stroke_width(2)))?;
        area.draw(&Circle::new((left + 14, 22), 3, colour.filled()))?;
        area.draw(&Text::new(*method, (left + 36, 22), style.clone()))?;
        left += if method.len() > 10 { 210 } else { 110 };
    }
    let notes = "solid: mean; dashed: median; cross: stated in the paper at 5 % noise";
    area.draw(&Text::new(notes, (60, 48), style))?;
    Ok(())
}
