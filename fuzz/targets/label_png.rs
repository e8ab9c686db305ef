//! Label files: what is encoded is decoded to the same colours, and what cannot be encoded is refused.
#![no_main]

use libfuzzer_sys::arbitrary::{self, Arbitrary};
use libfuzzer_sys::fuzz_target;
use veronese::codecs::{decode_image, encode_colour_png, encode_grey_png, encode_indexed_png};

#[derive(Arbitrary, Debug)]
struct Input<'a> {
    size: [u8; 2],
    /// Instead of the bytes that fill the picture.
    wrong: Option<[usize; 2]>,
    palette: &'a [u8],
    bytes: &'a [u8],
}

fuzz_target!(|input: Input<'_>| {
    let Input { size, wrong, palette, bytes } = input;
    if let Some([width, height]) = wrong {
        for file in [
            encode_indexed_png(width, height, bytes, palette),
            encode_grey_png(width, height, bytes),
            encode_colour_png(width, height, bytes),
        ] {
            drop(file.map(|file| decode_image(&file)));
        }
        return;
    }
    let [width, height] = size.map(|side| 1 + usize::from(side) % 48);
    let filled = |count: usize| -> Vec<u8> { bytes.iter().chain(&[0]).copied().cycle().take(count).collect() };
    let decoded = |file: &[u8]| decode_image(file).expect("it reads what it has written").rgba;

    let grey = filled(width * height);
    let file = encode_grey_png(width, height, &grey).expect("the bytes fill the picture");
    assert!(decoded(&file).chunks(4).zip(&grey).all(|(pixel, &g)| pixel == [g, g, g, 255]));

    let colour = filled(3 * width * height);
    let file = encode_colour_png(width, height, &colour).expect("the bytes fill the picture");
    assert!(decoded(&file).chunks(4).zip(colour.chunks(3)).all(|(pixel, rgb)| pixel[..3] == *rgb && pixel[3] == 255));

    let colours = palette.len() / 3;
    let fits = palette.len() % 3 == 0 && (1..=256).contains(&colours) && grey.iter().all(|&k| usize::from(k) < colours);
    let file = encode_indexed_png(width, height, &grey, palette);
    assert_eq!(file.is_ok(), fits);
    if let Ok(file) = file {
        let rgba = decoded(&file);
        assert!(rgba.chunks(4).zip(&grey).all(|(pixel, &k)| pixel[..3] == palette[3 * usize::from(k)..][..3]));
    }
});
