//! Pixels whose label the two frames do not determine.

use crate::frame::Plane;
use crate::frame::filter::gaussian;
use crate::frame::warp::{Footprint, RowPath};
use crate::labelling::terms::visibility::hidden;
use crate::pair::labels::LabelledPair;
use crate::view::cost::{RobustKernel, cost};

/// Working pixels that leave the frame, are occluded, are not explained by their own motion, have no texture around them, or
/// whose label is more likely wrong than right.
pub(super) fn unknown(labelled: &LabelledPair, probabilities: &[Plane]) -> Vec<bool> {
    let level = labelled.pair.finest();
    let model = level.model;
    let texture = gaussian(&level.energy, model.texture_window);
    let no_texture = model.no_texture * level.noise * level.noise;
    let mut unknown = hidden(level, &labelled.motions, &labelled.labels);
    for (k, motion) in labelled.motions.iter().enumerate() {
        let own = gaussian(&cost(level, motion, RobustKernel::labels(model)), model.cost_window);
        let scaled = level.scaled(motion);
        for y in 0..level.height() {
            let path = RowPath::new(&scaled, 0, y);
            for x in 0..level.width() {
                let p = y * level.width() + x;
                if usize::from(labelled.labels[p]) == k {
                    let (px, py) = path.at(x);
                    let inside = Footprint::new(px, py, level.width(), level.height()).inside;
                    let decided = texture.values()[p] > no_texture && probabilities[k].values()[p] >= 0.5;
                    unknown[p] |= !inside || !decided || own.values()[p] > model.unexplained;
                }
            }
        }
    }
    unknown
}
