//! The layers of a scene.

use super::SceneOptions;
use super::shape::Shape;
use super::texture::{Style, Texture};
use veronese::{AffineMotion, Random};

/// A texture with an outline.
pub(super) struct Sprite {
    pub(super) texture: Texture,
    /// Added to a pixel, gives its position in the texture.
    pub(super) offset: [f64; 2],
    /// Outline and its centre; none for the background.
    pub(super) shape: Option<(Shape, [f64; 2])>,
}

/// A moving sprite. Its coordinates are those of the frame `first`.
pub(super) struct Layer {
    pub(super) motion: AffineMotion,
    pub(super) sprite: Sprite,
}

/// Minimum contrast of a textured background, grey levels.
pub(super) const RICH: f64 = 15.0;

/// The background, with a margin around the frame and, if its style permits, at least the given contrast in grey levels.
pub(super) fn background(
    random: &mut Random,
    options: &SceneOptions,
    motion: AffineMotion,
    margin: usize,
    (style, contrast): (&Style, f64),
) -> Layer {
    let size = [options.width + 2 * margin, options.height + 2 * margin];
    let sprite = Sprite::backdrop(random, size, [margin as f64; 2], options.colour, (style, contrast));
    Layer { motion, sprite }
}

/// An object in front of the background.
pub(super) fn object(
    random: &mut Random,
    options: &SceneOptions,
    motion: AffineMotion,
    shape: Shape,
    centre: [f64; 2],
    style: &Style,
) -> Layer {
    Layer { motion, sprite: Sprite::cut(random, shape, centre, options.colour, style) }
}

impl Sprite {
    /// A texture of `size`, in which the origin is at `offset`; of at least some contrast, where its style has it.
    pub(super) fn backdrop(
        random: &mut Random,
        size: [usize; 2],
        offset: [f64; 2],
        colour: bool,
        (style, contrast): (&Style, f64),
    ) -> Sprite {
        let texture = textured(random, style, size[0], size[1], colour, contrast);
        Sprite { texture, offset, shape: None }
    }

    /// A texture as large as the shape needs.
    pub(super) fn cut(random: &mut Random, shape: Shape, centre: [f64; 2], colour: bool, style: &Style) -> Sprite {
        let side = (2.0 * shape.reach()) as usize + 8;
        let texture = textured(random, style, side, side, colour, 22.0);
        let half = 0.5 * side as f64;
        Sprite { texture, offset: [half - centre[0], half - centre[1]], shape: Some((shape, centre)) }
    }

    /// Gives all of them the largest of their textures, middle on middle.
    pub(super) fn share<'a>(sprites: impl Iterator<Item = &'a mut Sprite>) {
        let mut sprites: Vec<&mut Sprite> = sprites.collect();
        let half = |sprite: &Sprite| sprite.shape.as_ref().map_or(0.0, |(_, centre)| sprite.offset[0] + centre[0]);
        let largest = sprites.iter().max_by(|a, b| half(a).total_cmp(&half(b)));
        let Some((texture, most)) = largest.map(|sprite| (sprite.texture.clone(), half(sprite))) else { return };
        for sprite in &mut sprites {
            let shift = most - half(sprite);
            sprite.offset = sprite.offset.map(|offset| offset + shift);
            sprite.texture = texture.clone();
        }
    }
}

/// The first of nine random textures with at least the given contrast, or the last.
fn textured(random: &mut Random, style: &Style, width: usize, height: usize, colour: bool, contrast: f64) -> Texture {
    let mut texture = Texture::draw(random, style, width, height, colour);
    for _ in 0..8 {
        if texture.contrast >= contrast {
            break;
        }
        texture = Texture::draw(random, style, width, height, colour);
    }
    texture
}
