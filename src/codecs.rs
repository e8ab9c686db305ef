//! Image files: decoding of PNG, JPEG, WebP, BMP and PNM, encoding of PNG. For Node and native programs (feature `codecs`); browsers
//! decode images themselves.
//!
//! Files are not trusted. The size in the header is checked before a decoder opens the file, compressed metadata are not unpacked, and all
//! complaints of a decoder become [`Error::UnreadableImage`].
//!
//! ```
//! use veronese::codecs::{decode_image, encode_colour_png};
//!
//! let rgb: Vec<u8> = (0..32 * 24).flat_map(|p| [p as u8, (p / 32) as u8, 200]).collect();
//! let picture = decode_image(&encode_colour_png(32, 24, &rgb)?)?;
//! assert_eq!((picture.width, picture.height), (32, 24));
//! assert_eq!(picture.rgba[..4], [0, 0, 200, 255]);
//! let frame = picture.frame()?; // for `segment_pair`
//! assert_eq!((frame.width(), frame.height()), (32, 24));
//! # Ok::<(), veronese::Error>(())
//! ```

use std::io::Cursor;

use image::metadata::Orientation;
use image::{DynamicImage, ImageBuffer, ImageDecoder, ImageFormat, ImageReader, Limits, Pixel, Rgba, RgbaImage};

use crate::error::{Error, Result};
use crate::frame::{Frame, MAX_SIDE};

mod header;
mod jpeg;

/// Maximum allocation of a decoder in bytes: three times the largest frame in 16-bit RGBA.
const MAX_ALLOCATION: usize = 3 * 8 * MAX_SIDE * MAX_SIDE;

/// The same for a large picture: the largest one in 8-bit RGBA.
const LARGE_ALLOCATION: usize = 4 * header::LARGE_SIDE * header::LARGE_SIDE;

/// A decoded image: RGBA bytes, row by row, like `ImageData`. See the [module example](self).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// Width × height × 4 bytes: red, green, blue, alpha.
    pub rgba: Vec<u8>,
    /// For a file with 16-bit samples: the smallest and the largest sample, except alpha.
    pub range: Option<(u16, u16)>,
}

/// Options of decoding, for files that the defaults do not suit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Decoding {
    /// Decodes a damaged JPEG file as far as it goes: the missing part of its scan is grey. Without this, such a file is an error.
    pub allow_damaged: bool,
    /// The 16-bit samples that become 0 and 255. Without this they are 0 and 65535, of which cameras and scanners may use a small part.
    pub range: Option<(u16, u16)>,
    /// Allows sides up to 16384 pixels; such pictures must be scaled down to become frames.
    pub large: bool,
}

impl Decoding {
    /// The longest side, pixels, and the maximum allocation of a decoder, bytes.
    fn limits(&self) -> (usize, usize) {
        if self.large { (header::LARGE_SIDE, LARGE_ALLOCATION) } else { (MAX_SIDE, MAX_ALLOCATION) }
    }
}

impl Picture {
    /// Converts the picture to a frame.
    ///
    /// # Errors
    /// [`Error::FrameSizeUnsupported`] for a side outside 16 to 4096 pixels; [`Error::PixelCountMismatch`] if the bytes do not fill it.
    pub fn frame(&self) -> Result<Frame> {
        Frame::from_rgba(self.width, self.height, &self.rgba)
    }
}

/// Decodes a PNG, JPEG, WebP, BMP or PNM file, whose format is recognised by its first bytes. The Exif orientation is applied, as in
/// browsers. Of an animation, the first image is decoded.
///
/// ```
/// use veronese::codecs::decode_image;
///
/// let picture = decode_image(b"P5 2 1 255 \x07\xff")?; // PNM, grey
/// assert_eq!(picture.rgba, [7, 7, 7, 255, 255, 255, 255, 255]);
/// assert_eq!(decode_image(b"P5 2 1 255 \x07").unwrap_err().code(), "unreadable-image"); // truncated
/// assert_eq!(decode_image(b"P5 9999 1 255 ").unwrap_err().code(), "frame-size-unsupported");
/// # Ok::<(), veronese::Error>(())
/// ```
///
/// # Errors
/// [`Error::FrameSizeUnsupported`] for a side of 0 or above 4096 in the header; [`Error::UnreadableImage`] for another format, and for
/// damaged or truncated data.
pub fn decode_image(bytes: &[u8]) -> Result<Picture> {
    decode_image_with(bytes, &Decoding::default())
}

/// Decodes an image as [`decode_image`] does, with options.
///
/// ```
/// use veronese::codecs::{Decoding, decode_image_with};
///
/// let file = b"P5 2 1 65535 \x00\x10\x00\x20"; // PNM, 16 bits: 16 and 32
/// let dark = decode_image_with(file, &Decoding::default())?;
/// assert_eq!((dark.rgba[0], dark.rgba[4], dark.range), (0, 0, Some((16, 32))));
/// let mut decoding = Decoding::default();
/// decoding.range = dark.range;
/// assert_eq!(decode_image_with(file, &decoding)?.rgba, [0, 0, 0, 255, 255, 255, 255, 255]);
///
/// decoding.large = true;
/// let wide = [b"P5 9999 1 255 ", &[7; 9999][..]].concat();
/// assert_eq!(decode_image_with(&wide, &decoding)?.width, 9999);
/// assert_eq!(decode_image_with(b"P5 16385 1 255 ", &decoding).unwrap_err().code(), "frame-size-unsupported");
/// # Ok::<(), veronese::Error>(())
/// ```
///
/// # Errors
/// As of [`decode_image`].
pub fn decode_image_with(bytes: &[u8], decoding: &Decoding) -> Result<Picture> {
    if bytes.is_empty() {
        return Err(unreadable("it is empty"));
    }
    let format = image::guess_format(bytes)
        .ok()
        .filter(|format| *format == ImageFormat::Png || format.reading_enabled())
        .ok_or_else(|| unreadable("it is neither PNG, JPEG, WebP, BMP nor PNM"))?;
    let limits = decoding.limits();
    header::check(format, bytes, limits.0)?;
    let (mut image, orientation) = match format {
        ImageFormat::Png => png_image(bytes, limits),
        ImageFormat::Jpeg => other_image(jpeg::image(bytes, decoding.allow_damaged)?, format, limits),
        _ => other_image(bytes, format, limits),
    }?;
    image.apply_orientation(orientation);
    let range = range_of(&image);
    let rgba = match (range, decoding.range) {
        (Some(_), Some(stretched)) => stretch(image.into_rgba16(), stretched),
        _ => image.into_rgba8(),
    };
    Ok(Picture { width: rgba.width() as usize, height: rgba.height() as usize, rgba: rgba.into_raw(), range })
}

/// The smallest and the largest 16-bit sample, except alpha; `None` for samples of 8 bits.
fn range_of(image: &DynamicImage) -> Option<(u16, u16)> {
    fn of<P: Pixel<Subpixel = u16>>(image: &ImageBuffer<P, Vec<u16>>) -> (u16, u16) {
        let colours = usize::from(P::CHANNEL_COUNT) - usize::from(P::HAS_ALPHA);
        let samples = image.pixels().flat_map(|pixel| &pixel.channels()[..colours]);
        samples.fold((u16::MAX, 0), |(low, high), &sample| (low.min(sample), high.max(sample)))
    }
    match image {
        DynamicImage::ImageLuma16(image) => Some(of(image)),
        DynamicImage::ImageLumaA16(image) => Some(of(image)),
        DynamicImage::ImageRgb16(image) => Some(of(image)),
        DynamicImage::ImageRgba16(image) => Some(of(image)),
        _ => None,
    }
}

/// Converts 16-bit samples to bytes: `low` and below become 0, `high` and above 255. Alpha keeps its range.
fn stretch(image: ImageBuffer<Rgba<u16>, Vec<u16>>, (low, high): (u16, u16)) -> RgbaImage {
    let span = u32::from(high.saturating_sub(low)).max(1);
    let byte = |sample: u16, low: u16, span: u32| {
        ((u32::from(sample.saturating_sub(low)).min(span) * 255 + span / 2) / span) as u8
    };
    let (width, height) = image.dimensions();
    RgbaImage::from_fn(width, height, |x, y| {
        let Rgba([red, green, blue, alpha]) = *image.get_pixel(x, y);
        let colour = |sample| byte(sample, low, span);
        Rgba([colour(red), colour(green), colour(blue), byte(alpha, 0, u32::from(u16::MAX))])
    })
}

/// Decodes PNG with the crate `png` directly. The crate `image` unpacks the colour profile when it opens a file, which is not needed and
/// may be a thousand times as large as the file.
fn png_image(bytes: &[u8], (_, allocation): (usize, usize)) -> Result<(DynamicImage, Orientation)> {
    let mut decoder = png::Decoder::new_with_limits(Cursor::new(bytes), png::Limits { bytes: allocation });
    decoder.set_ignore_iccp_chunk(true);
    decoder.set_ignore_text_chunk(true);
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(unreadable)?;
    let (width, height) = reader.info().size();
    let orientation = reader.info().exif_metadata.as_ref().and_then(|exif| Orientation::from_exif_chunk(exif));
    let mut samples = vec![0; reader.output_buffer_size().ok_or_else(|| unreadable("it is too large"))?];
    reader.next_frame(&mut samples).map_err(unreadable)?;
    let wide = |samples: Vec<u8>| samples.as_chunks().0.iter().map(|pair| u16::from_be_bytes(*pair)).collect();
    let image = match reader.output_color_type() {
        (png::ColorType::Grayscale, png::BitDepth::Eight) => DynamicImage::ImageLuma8(filled(width, height, samples)?),
        (png::ColorType::GrayscaleAlpha, png::BitDepth::Eight) => {
            DynamicImage::ImageLumaA8(filled(width, height, samples)?)
        }
        (png::ColorType::Rgb, png::BitDepth::Eight) => DynamicImage::ImageRgb8(filled(width, height, samples)?),
        (png::ColorType::Rgba, png::BitDepth::Eight) => DynamicImage::ImageRgba8(filled(width, height, samples)?),
        (png::ColorType::Grayscale, _) => DynamicImage::ImageLuma16(filled(width, height, wide(samples))?),
        (png::ColorType::GrayscaleAlpha, _) => DynamicImage::ImageLumaA16(filled(width, height, wide(samples))?),
        (png::ColorType::Rgb, _) => DynamicImage::ImageRgb16(filled(width, height, wide(samples))?),
        (png::ColorType::Rgba, _) => DynamicImage::ImageRgba16(filled(width, height, wide(samples))?),
        (png::ColorType::Indexed, _) => return Err(unreadable("its palette is missing")),
    };
    Ok((image, orientation.unwrap_or(Orientation::NoTransforms)))
}

fn filled<P: Pixel>(width: u32, height: u32, samples: Vec<P::Subpixel>) -> Result<ImageBuffer<P, Vec<P::Subpixel>>> {
    ImageBuffer::from_raw(width, height, samples).ok_or_else(|| unreadable("it has too few pixels"))
}

fn other_image(
    bytes: &[u8],
    format: ImageFormat,
    (longest, allocation): (usize, usize),
) -> Result<(DynamicImage, Orientation)> {
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(allocation as u64);
    reader.limits(limits);
    let mut decoder = reader.into_decoder().map_err(unreadable)?;
    let (width, height) = decoder.dimensions();
    header::supported((width as usize, height as usize), longest)?;
    let orientation = decoder.orientation().unwrap_or(Orientation::NoTransforms);
    Ok((DynamicImage::from_decoder(decoder).map_err(unreadable)?, orientation))
}

fn unreadable(reason: impl std::fmt::Display) -> Error {
    // On one line: decoders put causes on separate lines.
    let reason = reason.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
    Error::UnreadableImage { reason }
}

/// Encodes an 8-bit indexed PNG from one index per pixel, row by row, and a palette of up to 256 RGB colours. A reader that ignores the
/// palette gets the indices unchanged.
///
/// ```
/// use veronese::codecs::{decode_image, encode_indexed_png};
///
/// let file = encode_indexed_png(3, 1, &[0, 1, 0], &[0, 0, 0, 255, 128, 0])?; // black and orange
/// assert_eq!(decode_image(&file)?.rgba, [0, 0, 0, 255, 255, 128, 0, 255, 0, 0, 0, 255]);
/// assert_eq!(encode_indexed_png(3, 1, &[0, 1, 2], &[0; 6]).unwrap_err().code(), "invalid-option");
/// # Ok::<(), veronese::Error>(())
/// ```
///
/// # Errors
/// [`Error::InvalidOption`] if the number of indices is not width × height, or if the palette is empty, is not a multiple of three bytes,
/// has more than 256 colours, or has no colour for the largest index.
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
/// ```
/// use veronese::codecs::{decode_image, encode_grey_png};
///
/// assert_eq!(decode_image(&encode_grey_png(2, 1, &[0, 99])?)?.rgba, [0, 0, 0, 255, 99, 99, 99, 255]);
/// # Ok::<(), veronese::Error>(())
/// ```
///
/// # Errors
/// [`Error::InvalidOption`] if the number of bytes is not width × height, or is 0.
pub fn encode_grey_png(width: usize, height: usize, grey: &[u8]) -> Result<Vec<u8>> {
    encode(width, height, grey, png::ColorType::Grayscale, None)
}

/// Encodes an 8-bit RGB PNG from three bytes per pixel, or an RGBA PNG from four bytes per pixel, row by row.
///
/// ```
/// use veronese::codecs::{decode_image, encode_colour_png};
///
/// let rgba = [255, 128, 0, 255, 60, 150, 255, 128];
/// assert_eq!(decode_image(&encode_colour_png(2, 1, &rgba)?)?.rgba, rgba);
/// # Ok::<(), veronese::Error>(())
/// ```
///
/// # Errors
/// [`Error::InvalidOption`] if the number of bytes is neither 3 · width · height nor 4 · width · height, or is 0.
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

    /// A picture without symmetry.
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
        // The last 12 bytes, IEND, and the checksum before them carry no pixels.
        for length in 0..file.len() - 20 {
            let error = decode_image(&file[..length]).unwrap_err();
            assert_eq!(error.code(), "unreadable-image", "{length} of {} bytes", file.len());
        }
    }

    /// A PNG of 64 × 64 black pixels with an additional chunk between header and pixels.
    fn png_with(kind: &[u8; 4], content: &[u8]) -> Vec<u8> {
        let plain = encode_grey_png(64, 64, &[0; 64 * 64]).unwrap();
        let mut file = plain[..33].to_vec();
        file.extend(chunk(kind, content));
        file.extend(&plain[33..]);
        file
    }

    fn chunk(kind: &[u8; 4], content: &[u8]) -> Vec<u8> {
        let mut chunk = (content.len() as u32).to_be_bytes().to_vec();
        chunk.extend(kind);
        chunk.extend(content);
        let sum = chunk[4..].iter().fold(!0_u32, |sum, &byte| {
            (0..8).fold(sum ^ u32::from(byte), |sum, _| (sum >> 1) ^ if sum & 1 == 1 { 0xedb8_8320 } else { 0 })
        });
        chunk.extend((!sum).to_be_bytes());
        chunk
    }

    fn png_header(width: u32, height: u32) -> Vec<u8> {
        let mut content = [width.to_be_bytes(), height.to_be_bytes()].concat();
        content.extend([16, 6, 0, 0, 0]);
        [b"\x89PNG\r\n\x1a\n".to_vec(), chunk(b"IHDR", &content)].concat()
    }

    fn bmp_header(width: i32, height: i32) -> Vec<u8> {
        let mut file =
            [b"BM".to_vec(), vec![0; 8], 54_u32.to_le_bytes().to_vec(), 40_u32.to_le_bytes().to_vec()].concat();
        file.extend([width.to_le_bytes(), height.to_le_bytes()].concat());
        file.extend([1, 0, 24, 0]);
        file.resize(60, 0);
        file
    }

    fn jpeg_header(width: u16, height: u16) -> Vec<u8> {
        let mut file = vec![0xff, 0xd8, 0xff, 0xe0, 0, 4, 0, 0, 0xff, 0xff, 0xc0, 0, 11, 8];
        file.extend([height.to_be_bytes(), width.to_be_bytes()].concat());
        file.extend([1, 1, 0x11, 0, 0xff, 0xda, 0, 8, 1, 1, 0, 0, 63, 0, 0xff, 0xd9]);
        file
    }

    /// A WebP file with the given chunks.
    fn webp(chunks: &[(&[u8; 4], Vec<u8>)]) -> Vec<u8> {
        let mut body = b"WEBP".to_vec();
        for (kind, content) in chunks {
            body.extend(*kind);
            body.extend((content.len() as u32).to_le_bytes());
            body.extend(content);
            body.resize(body.len().next_multiple_of(2), 0);
        }
        [b"RIFF".to_vec(), (body.len() as u32).to_le_bytes().to_vec(), body].concat()
    }

    fn lossy(width: u16, height: u16) -> Vec<u8> {
        let mut content = vec![0x10, 0, 0, 0x9d, 0x01, 0x2a];
        content.extend([width.to_le_bytes(), height.to_le_bytes()].concat());
        content
    }

    fn lossless(width: u32, height: u32) -> Vec<u8> {
        let mut content = vec![0x2f];
        content.extend(((width - 1) | (height - 1) << 14).to_le_bytes());
        content
    }

    fn extended(flags: u8, width: u32, height: u32) -> Vec<u8> {
        let mut content = vec![flags, 0, 0, 0];
        for side in [width, height] {
            content.extend(&(side - 1).to_le_bytes()[..3]);
        }
        content
    }

    #[test]
    fn unsupported_sizes_are_recognised_in_every_format() {
        let pam =
            |side: &str| format!("P7\nWIDTH {side}\n# wide\nHEIGHT 8\nDEPTH 1\nMAXVAL 255\nENDHDR\n").into_bytes();
        let files = [
            png_header(30_000, 30_000),
            png_header(u32::MAX, u32::MAX),
            png_header(0, 0),
            png_header(4097, 1),
            bmp_header(70_000, 16),
            bmp_header(16, -70_000),
            bmp_header(0, 0),
            jpeg_header(65_535, 65_535),
            jpeg_header(0, 16),
            webp(&[(b"VP8 ", lossy(16_383, 16_383))]),
            webp(&[(b"VP8 ", lossy(0, 0))]),
            webp(&[(b"VP8L", lossless(16_384, 16_384))]),
            webp(&[(b"VP8X", extended(0, 1 << 24, 1 << 24))]),
            b"P6\n1000000 1000000\n255\n".to_vec(),
            b"P5 99999999999999999999 4 255\n".to_vec(),
            b"P4 4294967295 4294967295 ".to_vec(),
            b"P5\n0 0\n255\n".to_vec(),
            b"P5 # 1\n16 # 2\n 0 255\n".to_vec(),
            b"P2 0 0 255".to_vec(),
            pam("0"),
            pam("99999999999"),
        ];
        for file in files {
            let error = decode_image(&file).unwrap_err();
            let start = String::from_utf8_lossy(&file[..file.len().min(40)]).into_owned();
            assert_eq!(error.code(), "frame-size-unsupported", "{start:?}: {error}");
        }
    }

    #[test]
    fn the_size_of_a_frame_inside_a_file_is_checked() {
        // 400 MB of planes for a canvas of 64 × 64 pixels.
        for file in [
            webp(&[(b"VP8X", extended(0, 64, 64)), (b"VP8 ", lossy(16_383, 16_383))]),
            webp(&[
                (b"VP8X", extended(2, 64, 64)),
                (b"ANIM", vec![0; 6]),
                (b"ANMF", [vec![0; 16], webp(&[(b"VP8 ", lossy(16_383, 16_383))])[12..].to_vec()].concat()),
            ]),
        ] {
            assert_eq!(decode_image(&file).unwrap_err().code(), "frame-size-unsupported");
        }
    }

    #[test]
    fn a_chunk_longer_than_the_file_is_rejected() {
        let mut file = webp(&[(b"VP8X", extended(8, 64, 64)), (b"VP8 ", lossy(64, 64)), (b"EXIF", vec![0; 4])]);
        let size = file.len() - 8;
        file[size..size + 4].copy_from_slice(&0x7000_0000_u32.to_le_bytes());
        assert_eq!(decode_image(&file).unwrap_err().code(), "unreadable-image");
    }

    #[test]
    fn png_metadata_do_not_change_the_pixels() {
        let plain = decode_image(&encode_grey_png(64, 64, &[0; 64 * 64]).unwrap()).unwrap();
        // None of these chunks has valid content.
        for kind in [b"iCCP", b"zTXt", b"iTXt", b"tEXt", b"eXIf", b"gAMA", b"veRo"] {
            assert_eq!(decode_image(&png_with(kind, &[b'a'; 300])).unwrap(), plain, "{kind:?}");
        }
    }

    #[test]
    fn indices_beyond_the_palette_are_rejected() {
        assert!(encode_indexed_png(2, 1, &[0, 1], &[0, 0, 0, 9, 9, 9]).is_ok());
        for palette in [&[0, 0, 0][..], &[], &[0; 7], &[0; 257 * 3]] {
            assert_eq!(encode_indexed_png(2, 1, &[0, 1], palette).unwrap_err().code(), "invalid-option");
        }
    }

    #[test]
    fn bytes_that_do_not_fill_the_picture_are_rejected() {
        assert_eq!(encode_grey_png(3, 3, &[0; 8]).unwrap_err().code(), "invalid-option");
        assert_eq!(encode_grey_png(0, 3, &[]).unwrap_err().code(), "invalid-option");
        assert_eq!(encode_colour_png(usize::MAX, 2, &[0; 8]).unwrap_err().code(), "invalid-option");
    }
}
