//! The data of Figure 1 as text, a row for each number of motions and noise level.

use std::fmt::Write;

use crate::figure_1::{Cell, METHODS};

/// Comma-separated values with a header line.
pub(crate) fn csv(cells: &[Cell]) -> String {
    let mut text = String::from("motions,noise %");
    for method in METHODS {
        let method = method.replace(',', "");
        let _ = write!(text, ",{method} mean %,{method} median %,{method} gross %");
    }
    text.push_str(",number right by the paper's rule %,number right by ours %\n");
    for cell in cells {
        let _ = write!(text, "{},{}", cell.motions, cell.noise);
        for errors in &cell.methods {
            let _ = write!(text, ",{:e},{:e},{}", errors.mean, errors.median, errors.gross);
        }
        let _ = writeln!(text, ",{},{}", cell.count_right[0], cell.count_right[1]);
    }
    text
}

/// A Markdown table.
pub(crate) fn markdown(cells: &[Cell], trials: usize, seed: u64) -> String {
    let mut text = format!(
        "Error (20), %: mean / median over {trials} trials [share of trials with a motion wrong by more than 20 %, %]; \
         `npm run paper -- --trials {trials} --seed {seed}`.\n\n| n | noise |"
    );
    for method in METHODS {
        let _ = write!(text, " {method} |");
    }
    text.push_str(" n right, paper | n right, ours |\n|---|---|");
    text.push_str(&"---|".repeat(METHODS.len() + 2));
    for cell in cells {
        let _ = write!(text, "\n| {} | {} % |", cell.motions, cell.noise);
        for errors in &cell.methods {
            let (mean, median) = (short(errors.mean), short(errors.median));
            let _ = write!(text, " {mean} / {median} [{:.1}] |", errors.gross);
        }
        let _ = write!(text, " {:.1} % | {:.1} % |", cell.count_right[0], cell.count_right[1]);
    }
    text.push('\n');
    text
}

/// A number with about three significant digits.
fn short(value: f64) -> String {
    match value {
        value if value == 0.0 || !value.is_finite() => value.to_string(),
        value if !(1e-3..1e4).contains(&value) => format!("{value:.0e}"),
        value if value < 1.0 => format!("{value:.3}"),
        value if value < 10.0 => format!("{value:.2}"),
        value => format!("{value:.1}"),
    }
}
