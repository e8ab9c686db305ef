//! Writes the generated sample pairs of the page: `cargo run --release --features codecs --example samples`.

use std::error::Error;
use std::fs;
use std::path::Path;

use veronese::codecs::encode_colour_png;
use veronese::scene::{Scene, leader_follower, parallax};

const FOLDER: &str = "www/public/samples";

fn main() -> Result<(), Box<dyn Error>> {
    write("leader-follower", &leader_follower(1)?)?;
    write("parallax", &parallax(4)?)
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
