//! Two frames in, masks out, on a scene made for the purpose, whose truth is known: two things move before a background
//! that moves as well.

use scenes::{SceneOptions, generate};
use veronese::{Result, SegmentOptions, segment_pair};

/// Public: the tests run it, too.
pub fn main() -> Result<()> {
    let scene = generate(&SceneOptions { width: 160, height: 120, objects: 2, seed: 5, ..SceneOptions::default() })?;

    // Frames of your own: `Frame::from_rgba(width, height, &bytes)`, or with the feature `codecs`
    // `decode_image(&file)?.frame()?`.
    let found = segment_pair(scene.first(), scene.second(), &SegmentOptions::default(), &mut |_| {})?;

    println!("{} motions", found.count);
    for motion in &found.motions {
        let [left, top, width, height] = motion.bbox;
        let [u, v] = motion.matrix.flow((2 * left + width) as f64 / 2.0, (2 * top + height) as f64 / 2.0);
        let share = 100.0 * motion.share;
        println!(
            "motion {}: {share:.1} % of the pixels; the centre of its box moves by ({u:.2}, {v:.2})",
            motion.label
        );
    }

    // `labels` has one number per pixel. Which true layer has each label most of its pixels in?
    let mut agreement = vec![vec![0; scene.motions.len()]; found.count];
    for (&label, &layer) in found.labels.iter().zip(&scene.labels) {
        agreement[usize::from(label)][usize::from(layer)] += 1;
    }
    let right: usize = agreement.iter().filter_map(|row| row.iter().max()).sum();
    println!("{:.1} % of the pixels agree with the truth", 100.0 * right as f64 / found.labels.len() as f64);
    Ok(())
}
