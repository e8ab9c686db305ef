//! Writes the generated sample pair of the page, and the thumbnails of all: `cargo run --release --package experiments --example samples`.
//! How the frames of cars were made stands in the LICENCE.md beside them.

use std::error::Error;
use std::fs;
use std::path::Path;

use image::codecs::jpeg::JpegEncoder;
use image::{ExtendedColorType, ImageEncoder};
use scenes::{Scene, parallax};
use veronese::codecs::{decode_image, encode_colour_png};

const FOLDER: &str = "www/public/samples";
/// Twice the size on the page, for screens with small pixels.
const THUMBNAIL: (usize, usize) = (108, 72);
const JPEG_QUALITY: u8 = 75;

fn main() -> Result<(), Box<dyn Error>> {
    write("parallax", &parallax(4)?)?;
    for (name, frame) in
        [("passing-cars", "frames/22.webp"), ("intel-two-cars", "first.png"), ("parallax", "first.png")]
    {
        write_thumbnail(&Path::new(FOLDER).join(name), frame)?;
    }
    Ok(())
}

/// The middle of a frame in the shape of a thumbnail, scaled down by means over boxes of pixels.
fn write_thumbnail(folder: &Path, frame: &str) -> Result<(), Box<dyn Error>> {
    let picture = decode_image(&fs::read(folder.join(frame))?)?;
    let (across, down) = THUMBNAIL;
    let scale = (picture.width as f64 / across as f64).min(picture.height as f64 / down as f64);
    let left = (picture.width as f64 - scale * across as f64) / 2.0;
    let top = (picture.height as f64 - scale * down as f64) / 2.0;
    let mut rgb = Vec::with_capacity(3 * across * down);
    for y in 0..down {
        for x in 0..across {
            let range = |start: f64, at: usize| {
                ((start + scale * at as f64) as usize)..((start + scale * (at + 1) as f64) as usize)
            };
            let (columns, rows) = (range(left, x), range(top, y));
            let count = columns.len() * rows.len();
            for channel in 0..3 {
                let pixels = rows.clone().flat_map(|row| columns.clone().map(move |column| (row, column)));
                let sum: usize = pixels
                    .map(|(row, column)| usize::from(picture.rgba[4 * (row * picture.width + column) + channel]))
                    .sum();
                rgb.push(((sum + count / 2) / count) as u8);
            }
        }
    }
    let file = fs::File::create(folder.join("thumbnail.jpg"))?;
    JpegEncoder::new_with_quality(file, JPEG_QUALITY).write_image(
        &rgb,
        across as u32,
        down as u32,
        ExtendedColorType::Rgb8,
    )?;
    Ok(())
}

fn write(name: &str, scene: &Scene) -> Result<(), Box<dyn Error>> {
    let folder = Path::new(FOLDER).join(name);
    fs::create_dir_all(&folder)?;
    let size = (scene.options.width, scene.options.height);
    for (file, rgba) in [("first.png", &scene.rgba[1]), ("second.png", &scene.rgba[2])] {
        let rgb: Vec<u8> = rgba.chunks_exact(4).flat_map(|pixel| pixel[..3].to_vec()).collect();
        fs::write(folder.join(file), encode_colour_png(size.0, size.1, &rgb)?)?;
    }
    Ok(())
}
