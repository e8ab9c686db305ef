//! The stability: the real pairs again, with frames altered in ways that leave what moves as it was.
//!
//! A labelling of altered frames is carried back to the pixels of the first frame and compared with that of the frames as they are.

use image::ExtendedColorType;
use image::codecs::jpeg::JpegEncoder;
use serde_json::{Value, json};
use veronese::codecs::decode_image;
use veronese::{Frame, SegmentOptions, Segmentation, segment_pair};

use crate::Failure;
use crate::cases::{Case, Data, Set};
use crate::parallel::in_parallel;
use crate::scores::{VOID, scores};

/// Grey levels that are added.
const BRIGHTER: u8 = 10;
/// What every value is multiplied by.
const DARKER: f64 = 0.9;
const JPEG_QUALITY: u8 = 90;
/// Pixels that are cut off along every side.
const CROP: usize = 1;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Alteration {
    Mirrored,
    Flipped,
    Transposed,
    Swapped,
    Brighter,
    Darker,
    Compressed,
    Cropped,
}

/// The alterations with their names in the table.
const ALTERATIONS: [(Alteration, &str); 8] = [
    (Alteration::Mirrored, "mirrored, left to right"),
    (Alteration::Flipped, "flipped, top to bottom"),
    (Alteration::Transposed, "transposed"),
    (Alteration::Swapped, "frames exchanged"),
    (Alteration::Brighter, "10 grey levels brighter"),
    (Alteration::Darker, "multiplied by 0.9"),
    (Alteration::Compressed, "JPEG of quality 90"),
    (Alteration::Cropped, "a pixel cut off every side"),
];

/// RGBA bytes and their width.
type Pixels = (Vec<u8>, usize);

impl Alteration {
    /// What becomes of a frame.
    fn frame(self, rgba: &[u8], width: usize) -> Result<Frame, Failure> {
        let height = rgba.len() / 4 / width;
        let each = |value: &dyn Fn(u8) -> u8| -> Pixels {
            let colours = |pixel: &[u8]| [value(pixel[0]), value(pixel[1]), value(pixel[2]), pixel[3]];
            (rgba.chunks_exact(4).flat_map(colours).collect(), width)
        };
        let (bytes, width) = match self {
            Alteration::Mirrored | Alteration::Flipped | Alteration::Transposed | Alteration::Cropped => {
                let (columns, rows) = match self {
                    Alteration::Transposed => (height, width),
                    Alteration::Cropped => (width - 2 * CROP, height - 2 * CROP),
                    _ => (width, height),
                };
                let from = |p: usize| self.source(p % columns, p / columns, [width, height]);
                let pixel = |p: usize| rgba[4 * from(p)..4 * from(p) + 4].to_vec();
                ((0..columns * rows).flat_map(pixel).collect(), columns)
            }
            Alteration::Brighter => each(&|v| v.saturating_add(BRIGHTER)),
            Alteration::Darker => each(&|v| (DARKER * f64::from(v)).round() as u8),
            Alteration::Compressed => {
                let rgb: Vec<u8> = rgba.chunks_exact(4).flat_map(|pixel| pixel[..3].to_vec()).collect();
                let mut file = Vec::new();
                let mut encoder = JpegEncoder::new_with_quality(&mut file, JPEG_QUALITY);
                encoder.encode(&rgb, width as u32, height as u32, ExtendedColorType::Rgb8)?;
                (decode_image(&file)?.rgba, width)
            }
            Alteration::Swapped => (rgba.to_vec(), width),
        };
        Ok(Frame::from_rgba(width, bytes.len() / 4 / width, &bytes)?)
    }

    /// The pixel of the frame that comes to (x, y) of the altered one.
    fn source(self, x: usize, y: usize, [width, height]: [usize; 2]) -> usize {
        match self {
            Alteration::Mirrored => y * width + width - 1 - x,
            Alteration::Flipped => (height - 1 - y) * width + x,
            Alteration::Transposed => x * width + y,
            Alteration::Cropped => (y + CROP) * width + x + CROP,
            _ => y * width + x,
        }
    }

    /// For every pixel of the first frame the pixel of the altered labelling that shows the same, if there is one.
    fn places(self, found: &Segmentation, altered: &Segmentation) -> Vec<Option<usize>> {
        if self == Alteration::Swapped {
            return in_second_frame(found);
        }
        let mut places = vec![None; found.labels.len()];
        for p in 0..altered.labels.len() {
            let (x, y) = (p % altered.width, p / altered.width);
            places[self.source(x, y, [found.width, found.height])] = Some(p);
        }
        places
    }
}

/// Where every pixel of the first frame is in the second; none where it leaves the frame, or something that moves otherwise comes to the
/// same place and one of them is hidden.
fn in_second_frame(found: &Segmentation) -> Vec<Option<usize>> {
    let (width, height) = (found.width as f64, found.height as f64);
    let place = |(p, &label): (usize, &u8)| {
        let (x, y) = ((p % found.width) as f64, (p / found.width) as f64);
        let [u, v] = found.motions.get(usize::from(label))?.matrix.flow(x, y);
        let (x, y) = ((x + u).round(), (y + v).round());
        let inside = x >= 0.0 && y >= 0.0 && x < width && y < height;
        inside.then(|| y as usize * found.width + x as usize)
    };
    let mut places: Vec<Option<usize>> = found.labels.iter().enumerate().map(place).collect();
    let mut claims: Vec<Option<u8>> = vec![None; places.len()];
    let mut disputed = vec![false; places.len()];
    for (&label, &place) in found.labels.iter().zip(&places) {
        if let Some(place) = place {
            disputed[place] |= claims[place].is_some_and(|other| other != label);
            claims[place] = Some(label);
        }
    }
    places.iter_mut().for_each(|place| *place = place.filter(|&place| !disputed[place]));
    places
}

/// Share of the pixels on which two labellings agree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Agreement {
    /// Labels, matched one to one so that most pixels agree.
    labels: f64,
    /// Foreground or background, where the background is the largest group.
    foreground: f64,
}

fn agreement(alteration: Alteration, found: &Segmentation, altered: &Segmentation) -> Agreement {
    let is_object =
        |found: &Segmentation, label: u8| found.motions.get(usize::from(label)).is_some_and(|motion| motion.group != 0);
    let (mut own, mut other) = (found.labels.clone(), vec![VOID; found.labels.len()]);
    let (mut same, mut all) = (0usize, 0usize);
    for (p, place) in alteration.places(found, altered).into_iter().enumerate() {
        match place {
            Some(place) => {
                other[p] = altered.labels[place];
                all += 1;
                same += usize::from(is_object(found, own[p]) == is_object(altered, other[p]));
            }
            None => own[p] = VOID,
        }
    }
    Agreement { labels: scores(&own, &other, found.width).accuracy, foreground: same as f64 / all as f64 }
}

/// A pair's agreement under every alteration.
pub(crate) struct Compared {
    agreements: Vec<Agreement>,
}

/// Measures the real pairs among the cases.
pub(crate) fn measure(cases: &[Case]) -> Result<Vec<Compared>, Failure> {
    let pairs: Vec<Case> = cases.iter().filter(|case| case.set == Set::Pairs).cloned().collect();
    in_parallel(&pairs, |case| {
        let data = case.load().map_err(|error| error.to_string())?;
        let found = segment_pair(&data.first, &data.second, &SegmentOptions::default(), &mut |_| {})?;
        let compared = |&(alteration, _): &(Alteration, &str)| -> Result<Agreement, Failure> {
            Ok(agreement(alteration, &found, &segmented(alteration, &data)?))
        };
        let agreements = ALTERATIONS.iter().map(compared).collect::<Result<_, _>>()?;
        eprintln!("{}", case.name);
        Ok(Compared { agreements })
    })
}

fn segmented(alteration: Alteration, data: &Data) -> Result<Segmentation, Failure> {
    let [one, two] = &data.rgba;
    let (one, two) = if alteration == Alteration::Swapped { (two, one) } else { (one, two) };
    let frame = |rgba: &[u8]| alteration.frame(rgba, data.first.width());
    Ok(segment_pair(&frame(one)?, &frame(two)?, &SegmentOptions::default(), &mut |_| {})?)
}

/// The value below which a share of the values lies, interpolated.
fn quantile(compared: &[Compared], k: usize, share: f64, figure: fn(&Agreement) -> f64) -> f64 {
    let mut values: Vec<f64> = compared.iter().map(|one| figure(&one.agreements[k])).collect();
    values.sort_by(f64::total_cmp);
    let Some(last) = values.len().checked_sub(1) else { return f64::NAN };
    let place = share * last as f64;
    let (below, rest) = (place as usize, place.fract());
    values[below] + rest * (values[(below + 1).min(last)] - values[below])
}

/// The agreements as values for programs: medians and tenth percentiles.
pub(crate) fn json(compared: &[Compared]) -> Value {
    let row = |(k, (_, title)): (usize, &(Alteration, &str))| {
        let of = |figure| [0.5, 0.1].map(|share| quantile(compared, k, share, figure));
        json!({ "alteration": title, "labels": of(|one| one.labels), "foreground": of(|one| one.foreground) })
    };
    json!({ "pairs": compared.len(), "rows": ALTERATIONS.iter().enumerate().map(row).collect::<Vec<_>>() })
}
