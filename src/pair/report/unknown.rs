//! Pixels whose label the frames do not tell.

use crate::frame::Plane;
use crate::frame::filter::gaussian;
use crate::frame::warp::{Footprint, RowPath};
use crate::labelling::terms::visibility::hidden;
use crate::pair::Pair;
use crate::pair::labels::Labelled;
use crate::view::cost::{CostModel, cost};
use crate::workspace::Buffer;

/// Standard deviation of the window in which a motion must explain a pixel, working pixels. This and the next two were chosen on generated
/// scenes, where docs/masks.md counts the occluded pixels that are marked.
const UNKNOWN_WINDOW: f32 = 1.5;
/// Share of the saturated cost above which the motion does not explain the pixel.
const UNKNOWN_COST: f32 = 0.7;
/// Standard deviation of the window in which texture is measured, working pixels.
const TEXTURE_WINDOW: f32 = 3.0;
/// Mean squared gradient, in units of the noise variance, below which there is no texture: noise alone has 0.15 to 0.2.
const NO_TEXTURE: f32 = 0.2;

/// Working pixels that leave the frame, are occluded, are not explained by their own motion, have no texture around them, or
/// whose label is more likely wrong than right.
pub(super) fn unknown(pair: &Pair, labelled: &Labelled, probabilities: &[Plane]) -> Buffer<bool> {
    let level = pair.finest();
    let limit = UNKNOWN_COST * CostModel::labels().truncation;
    let texture = gaussian(&level.energy, TEXTURE_WINDOW);
    let no_texture = NO_TEXTURE * level.noise * level.noise;
    let mut unknown = hidden(level, &labelled.motions, &labelled.labels);
    for (k, motion) in labelled.motions.iter().enumerate() {
        let own = gaussian(&cost(level, motion, CostModel::labels()), UNKNOWN_WINDOW);
        let scaled = level.scaled(motion);
        for y in 0..level.height() {
            let path = RowPath::new(&scaled, 0, y);
            for x in 0..level.width() {
                let p = y * level.width() + x;
                if usize::from(labelled.labels[p]) == k {
                    let (px, py) = path.at(x);
                    let inside = Footprint::new(px, py, level.width(), level.height()).inside;
                    let decided = texture.values()[p] > no_texture && probabilities[k].values()[p] >= 0.5;
                    unknown[p] |= !inside || !decided || own.values()[p] > limit;
                }
            }
        }
    }
    unknown
}
