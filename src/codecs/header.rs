//! The size of an image according to the header of its file, read before a decoder opens it. Some decoders unpack metadata when they open
//! a file, and report sizes that overflow their arithmetic as damage.

use image::ImageFormat;

use crate::error::{Error, Result};
use crate::frame::MAX_SIDE;

/// The longest side of a picture that is to be scaled down, pixels: four times that of a frame, so that RGBA fits into WebAssembly's memory
/// twice.
pub(super) const LARGE_SIDE: usize = 4 * MAX_SIDE;

/// Checks the size. A file without a complete header passes; the decoder rejects it.
///
/// # Errors
/// [`Error::FrameSizeUnsupported`] for a side of 0 or above `longest`; [`Error::UnreadableImage`] for a WebP file with a metadata chunk that is
/// longer than the file.
pub(super) fn check(format: ImageFormat, bytes: &[u8], longest: usize) -> Result<()> {
    let sides = match format {
        ImageFormat::Png => png(bytes),
        ImageFormat::Jpeg => jpeg(bytes),
        ImageFormat::Bmp => bmp(bytes),
        ImageFormat::Pnm => pnm(bytes),
        ImageFormat::WebP => return webp(bytes, longest),
        _ => None,
    };
    sides.map_or(Ok(()), |sides| supported(sides, longest))
}

/// Checks a width and a height.
///
/// # Errors
/// [`Error::FrameSizeUnsupported`] for a side of 0 or above `longest`.
pub(super) fn supported((width, height): (usize, usize), longest: usize) -> Result<()> {
    if (1..=longest).contains(&width) && (1..=longest).contains(&height) {
        return Ok(());
    }
    Err(Error::FrameSizeUnsupported { width, height, min: crate::MIN_SIDE, max: longest })
}

fn png(bytes: &[u8]) -> Option<(usize, usize)> {
    let side = |at| Some(u32::from_be_bytes(array(bytes, at)?) as usize);
    (array(bytes, 12)? == *b"IHDR").then_some(())?;
    Some((side(16)?, side(20)?))
}

/// The size in the frame header, which is somewhere before the first scan.
fn jpeg(bytes: &[u8]) -> Option<(usize, usize)> {
    let short = |at| Some(usize::from(u16::from_be_bytes(array(bytes, at)?)));
    let mut at = 2;
    loop {
        match array(bytes, at)? {
            // Fill bytes, and markers without a segment.
            [0xff, 0xff] => at += 1,
            [0xff, 0x01 | 0xd0..=0xd8] => at += 2,
            // Frame headers; the markers missing here are tables.
            [0xff, 0xc0..=0xc3 | 0xc5..=0xc7 | 0xc9..=0xcb | 0xcd..=0xcf] => {
                return Some((short(at + 7)?, short(at + 5)?));
            }
            [0xff, 0xd9 | 0xda] => return None,
            [0xff, _] => at += 2 + short(at + 2)?,
            _ => return None,
        }
    }
}

/// The height is negative if rows are stored from the top down.
fn bmp(bytes: &[u8]) -> Option<(usize, usize)> {
    const CORE_HEADER: u32 = 12;
    if u32::from_le_bytes(array(bytes, 14)?) == CORE_HEADER {
        let side = |at| Some(usize::from(u16::from_le_bytes(array(bytes, at)?)));
        return Some((side(18)?, side(20)?));
    }
    let side = |at| Some(i32::from_le_bytes(array(bytes, at)?));
    Some((usize::try_from(side(18)?).ok()?, side(22)?.unsigned_abs() as usize))
}

fn pnm(bytes: &[u8]) -> Option<(usize, usize)> {
    let lines = bytes.get(2..)?.split(|&byte| byte == b'\n' || byte == b'\r');
    if bytes.starts_with(b"P7") {
        let mut header = lines.take_while(|line| *line != b"ENDHDR").map(words);
        let (mut width, mut height) = (None, None);
        for mut line in header.by_ref() {
            match line.next() {
                Some(b"WIDTH") => width = number(line.next()?),
                Some(b"HEIGHT") => height = number(line.next()?),
                _ => {}
            }
        }
        return width.zip(height);
    }
    let mut numbers = lines.filter_map(|line| line.split(|&byte| byte == b'#').next()).flat_map(words).map(number);
    Some((numbers.next()??, numbers.next()??))
}

fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(|byte| b" \t\r\x0b\x0c".contains(byte)).filter(|word| !word.is_empty())
}

/// A decimal number, saturating; `None` if there is another character.
fn number(digits: &[u8]) -> Option<usize> {
    digits.iter().try_fold(0_usize, |value, digit| {
        digit.is_ascii_digit().then(|| value.saturating_mul(10).saturating_add(usize::from(digit - b'0')))
    })
}

/// Checks the size in the header of the file and in each frame, because the decoder allocates memory for the latter.
fn webp(bytes: &[u8], longest: usize) -> Result<()> {
    for chunk in webp_chunks(bytes.get(12..).unwrap_or_default()) {
        if chunk.kind == *b"ANMF" {
            // Only the first frame is decoded.
            let parts = webp_chunks(chunk.content.get(16..).unwrap_or_default());
            return parts.map(|part| part.check(longest)).chain([chunk.check(longest)]).collect();
        }
        chunk.check(longest)?;
    }
    Ok(())
}

struct WebpChunk<'a> {
    kind: [u8; 4],
    /// Length according to its header, bytes.
    length: usize,
    /// The content, cut at the end of the file.
    content: &'a [u8],
}

impl WebpChunk<'_> {
    fn check(&self, longest: usize) -> Result<()> {
        // The decoder allocates this length before it reads.
        if self.kind == *b"EXIF" && self.length > self.content.len() {
            return Err(Error::UnreadableImage { reason: "its Exif data end after the file".into() });
        }
        self.sides().map_or(Ok(()), |sides| supported(sides, longest))
    }

    fn sides(&self) -> Option<(usize, usize)> {
        match &self.kind {
            b"VP8X" => {
                let side = |at| array(self.content, at).map(|[a, b, c]| u32::from_le_bytes([a, b, c, 0]) as usize + 1);
                Some((side(4)?, side(7)?))
            }
            b"VP8 " => {
                let side = |at| Some(usize::from(u16::from_le_bytes(array(self.content, at)?) & 0x3fff));
                Some((side(6)?, side(8)?))
            }
            b"VP8L" => {
                let bits = u32::from_le_bytes(array(self.content, 1)?) as usize;
                Some(((bits & 0x3fff) + 1, (bits >> 14 & 0x3fff) + 1))
            }
            _ => None,
        }
    }
}

fn webp_chunks(mut rest: &[u8]) -> impl Iterator<Item = WebpChunk<'_>> {
    std::iter::from_fn(move || {
        let kind = array(rest, 0)?;
        let length = u32::from_le_bytes(array(rest, 4)?) as usize;
        let content = &rest[8..];
        rest = content.get(length.saturating_add(length % 2)..).unwrap_or_default();
        Some(WebpChunk { kind, length, content: &content[..length.min(content.len())] })
    })
}

fn array<const N: usize>(bytes: &[u8], at: usize) -> Option<[u8; N]> {
    bytes.get(at..)?.first_chunk().copied()
}
