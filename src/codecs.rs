//! Image files: PNG, JPEG, WebP, BMP and PNM in, PNG out. For Node and native programs (feature `codecs`); a browser decodes
//! by itself.
//!
//! The bytes come from outside, so nothing is believed: the header's size is checked before anything is allocated for the
//! pixels, and whatever a decoder complains about becomes [`Error::UnreadableImage`].

use std::io::Cursor;

use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use crate::error::{Error, Result};
use crate::frame::{Frame, MAX_SIDE};

/// Most that one decoder may allocate, bytes: 16-bit RGBA of the largest frame, three times over.
const MAX_ALLOCATION: u64 = 3 * 8 * (MAX_SIDE as u64) * (MAX_SIDE as u64);

/// A decoded image: RGBA bytes row by row, as `ImageData` has them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// Width × height × 4 bytes: red, green, blue, alpha.
    pub rgba: Vec<u8>,
}

impl Picture {
    /// The picture as a frame of a pair.
    ///
    /// # Errors
    /// [`Error::FrameSizeUnsupported`] for sides outside 16…4096.
    pub fn frame(&self) -> Result<Frame> {
        Frame::from_rgba(self.width, self.height, &self.rgba)
    }
}

/// Decodes a PNG, JPEG, WebP, BMP or PNM file; the format is told by its first bytes. An Exif orientation is applied, as
/// browsers do; of an animation the first image is taken.
///
/// # Errors
/// [`Error::FrameSizeUnsupported`] for a header with a side above 4096, [`Error::UnreadableImage`] for everything that a
/// decoder refuses: another format, damaged or truncated data.
pub fn decode_image(bytes: &[u8]) -> Result<Picture> {
    if bytes.is_empty() {
        return Err(unreadable("it is empty"));
    }
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(unreadable)?;
    let format = reader
        .format()
        .filter(|format| format.reading_enabled())
        .ok_or_else(|| unreadable("it is neither PNG, JPEG, WebP, BMP nor PNM"))?;
    if format == ImageFormat::Jpeg && !jpeg_ends(bytes) {
        return Err(unreadable("it is a JPEG file without its end"));
    }
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MAX_ALLOCATION);
    reader.limits(limits);
    let mut decoder = reader.into_decoder().map_err(unreadable)?;
    let (width, height) = decoder.dimensions();
    let (width, height) = (width as usize, height as usize);
    if width > MAX_SIDE || height > MAX_SIDE {
        return Err(Error::FrameSizeUnsupported { width, height, min: crate::MIN_SIDE, max: MAX_SIDE });
    }
    let orientation = decoder.orientation().unwrap_or(Orientation::NoTransforms);
    let mut image = DynamicImage::from_decoder(decoder).map_err(unreadable)?;
    image.apply_orientation(orientation);
    let rgba = image.into_rgba8();
    Ok(Picture { width: rgba.width() as usize, height: rgba.height() as usize, rgba: rgba.into_raw() })
}

/// Whether the marker "end of image" follows the start of the (last) scan. The decoder fills what a truncated file lacks
/// with grey, and a segmentation of grey would look like an answer.
fn jpeg_ends(bytes: &[u8]) -> bool {
    const START_OF_SCAN: [u8; 2] = [0xff, 0xda];
    const END_OF_IMAGE: [u8; 2] = [0xff, 0xd9];
    let last = |marker: [u8; 2]| bytes.windows(2).rposition(|pair| pair == marker);
    match (last(START_OF_SCAN), last(END_OF_IMAGE)) {
        (Some(scan), Some(end)) => scan < end,
        _ => false,
    }
}

fn unreadable(reason: impl std::fmt::Display) -> Error {
    // One line: decoders put causes on lines of their own.
    let reason = reason.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
    Error::UnreadableImage { reason }
}

/// Encodes an 8-bit indexed PNG: one index per pixel, row by row, and up to 256 RGB colours. A reader that ignores colours
/// gets the indices back as they were.
///
/// # Errors
/// [`Error::InvalidOption`] where indices do not fill width × height, the palette is empty, longer than 256 colours, not
/// whole colours, or shorter than the largest index asks for.
pub fn encode_indexed_png(width: usize, height: usize, indices: &[u8], palette: &[u8]) -> Result<Vec<u8>> {
    let colours = palette.len() / 3;
    let needed = indices.iter().max().map_or(0, |&largest| usize::from(largest) + 1);
    if !palette.len().is_multiple_of(3) || colours == 0 || colours > 256 || colours < needed {
        return Err(Error::InvalidOption {
            name: "palette",
            reason: format!(
                "must hold 3 bytes for each of {} to 256 colours, not {} bytes",
                needed.max(1),
                palette.len()
            ),
        });
    }
    encode(width, height, indices, png::ColorType::Indexed, Some(palette))
}

/// Encodes an 8-bit grey PNG from one byte per pixel, row by row.
///
/// # Errors
/// [`Error::InvalidOption`] where the bytes do not fill width × height.
pub fn encode_grey_png(width: usize, height: usize, grey: &[u8]) -> Result<Vec<u8>> {
    encode(width, height, grey, png::ColorType::Grayscale, None)
}

/// Encodes an 8-bit RGB PNG from three bytes per pixel, or an RGBA PNG from four, row by row.
///
/// # Errors
/// [`Error::InvalidOption`] where the bytes fill width × height pixels neither of three bytes nor of four.
pub fn encode_colour_png(width: usize, height: usize, pixels: &[u8]) -> Result<Vec<u8>> {
    let alpha = width.checked_mul(height).and_then(|n| n.checked_mul(4)) == Some(pixels.len());
    encode(width, height, pixels, if alpha { png::ColorType::Rgba } else { png::ColorType::Rgb }, None)
}

fn encode(
    width: usize,
    height: usize,
    pixels: &[u8],
    colour: png::ColorType,
    palette: Option<&[u8]>,
) -> Result<Vec<u8>> {
    let needed = width.checked_mul(height).and_then(|n| n.checked_mul(colour.samples()));
    let (Ok(png_width), Ok(png_height)) = (u32::try_from(width), u32::try_from(height)) else {
        return Err(Error::InvalidOption { name: "width", reason: "is too large for PNG".into() });
    };
    if needed != Some(pixels.len()) || pixels.is_empty() {
        let reason = format!("{} bytes do not fill {width}×{height} pixels", pixels.len());
        return Err(Error::InvalidOption { name: "pixels", reason });
    }
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, png_width, png_height);
    encoder.set_color(colour);
    encoder.set_depth(png::BitDepth::Eight);
    if let Some(palette) = palette {
        encoder.set_palette(palette);
    }
    encoder
        .write_header()
        .and_then(|mut writer| {
            writer.write_image_data(pixels)?;
            writer.finish()
        })
        .map_err(|error| Error::InvalidOption { name: "pixels", reason: error.to_string() })?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture without symmetry: a transposed or mirrored one differs.
    fn picture(width: usize, height: usize) -> Vec<u8> {
        (0..width * height).flat_map(|i| [(i % width) as u8, (i / width) as u8, (i % 251) as u8]).collect()
    }

    #[test]
    fn an_encoded_colour_picture_decodes_to_the_same_pixels() {
        let rgb = picture(37, 21);
        let decoded = decode_image(&encode_colour_png(37, 21, &rgb).unwrap()).unwrap();
        assert_eq!((decoded.width, decoded.height), (37, 21));
        for (given, found) in rgb.chunks_exact(3).zip(decoded.rgba.chunks_exact(4)) {
            assert_eq!(given, &found[..3]);
            assert_eq!(found[3], 255);
        }
    }

    #[test]
    fn a_truncated_file_is_unreadable_wherever_it_is_cut() {
        let file = encode_colour_png(37, 21, &picture(37, 21)).unwrap();
        // 12 bytes of IEND carry no pixels, nor does the checksum before them.
        for length in 0..file.len() - 20 {
            let error = decode_image(&file[..length]).unwrap_err();
            assert_eq!(error.code(), "unreadable-image", "{length} of {} bytes", file.len());
        }
    }

    #[test]
    fn a_header_of_enormous_sides_is_refused_before_its_pixels_are_allocated() {
        let error = decode_image(b"P6\n1000000 1000000\n255\n").unwrap_err();
        assert_eq!(error.code(), "frame-size-unsupported");
    }

    #[test]
    fn indices_beyond_the_palette_are_refused() {
        assert!(encode_indexed_png(2, 1, &[0, 1], &[0, 0, 0, 9, 9, 9]).is_ok());
        for palette in [&[0, 0, 0][..], &[], &[0; 7], &[0; 257 * 3]] {
            assert_eq!(encode_indexed_png(2, 1, &[0, 1], palette).unwrap_err().code(), "invalid-option");
        }
    }

    #[test]
    fn bytes_that_do_not_fill_the_picture_are_refused() {
        assert_eq!(encode_grey_png(3, 3, &[0; 8]).unwrap_err().code(), "invalid-option");
        assert_eq!(encode_grey_png(0, 3, &[]).unwrap_err().code(), "invalid-option");
        assert_eq!(encode_colour_png(usize::MAX, 2, &[0; 8]).unwrap_err().code(), "invalid-option");
    }
}
