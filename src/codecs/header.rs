//! The sides of an image as the header of its file says them, read before a decoder is asked. A decoder that opens a file may
//! already unpack what it finds on the way, and refuses sides that overflow its own arithmetic as damage.

use image::ImageFormat;

use super::unreadable;
use crate::error::{Error, Result};
use crate::frame::MAX_SIDE;

/// Passes what has supported sides, and what has no whole header: that is for the decoder to complain about.
///
/// # Errors
/// [`Error::FrameSizeUnsupported`] for a side of 0 or above 4096, [`Error::UnreadableImage`] for a WebP file with a chunk of
/// metadata that is longer than the file.
pub(super) fn check(format: ImageFormat, bytes: &[u8]) -> Result<()> {
    let sides = match format {
        ImageFormat::Png => png(bytes),
        ImageFormat::Jpeg => jpeg(bytes),
        ImageFormat::Bmp => bmp(bytes),
        ImageFormat::Pnm => pnm(bytes),
        ImageFormat::WebP => return webp(bytes),
        _ => None,
    };
    sides.map_or(Ok(()), supported)
}

/// # Errors
/// [`Error::FrameSizeUnsupported`].
pub(super) fn supported((width, height): (usize, usize)) -> Result<()> {
    if (1..=MAX_SIDE).contains(&width) && (1..=MAX_SIDE).contains(&height) {
        return Ok(());
    }
    Err(Error::FrameSizeUnsupported { width, height, min: crate::MIN_SIDE, max: MAX_SIDE })
}

fn png(bytes: &[u8]) -> Option<(usize, usize)> {
    let side = |at| Some(u32::from_be_bytes(array(bytes, at)?) as usize);
    (array(bytes, 12)? == *b"IHDR").then_some(())?;
    Some((side(16)?, side(20)?))
}

/// From the frame header, which stands somewhere before the first scan.
fn jpeg(bytes: &[u8]) -> Option<(usize, usize)> {
    let short = |at| Some(usize::from(u16::from_be_bytes(array(bytes, at)?)));
    let mut at = 2;
    loop {
        match array(bytes, at)? {
            // Fill bytes, and markers without a segment.
            [0xff, 0xff] => at += 1,
            [0xff, 0x01 | 0xd0..=0xd8] => at += 2,
            // Tables are numbered among the frame headers, too.
            [0xff, 0xc0..=0xc3 | 0xc5..=0xc7 | 0xc9..=0xcb | 0xcd..=0xcf] => {
                return Some((short(at + 7)?, short(at + 5)?));
            }
            [0xff, 0xd9 | 0xda] => return None,
            [0xff, _] => at += 2 + short(at + 2)?,
            _ => return None,
        }
    }
}

/// A negative height says that the rows go from the top down.
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

/// The largest number there is in the place of those beyond it.
fn number(digits: &[u8]) -> Option<usize> {
    digits.iter().try_fold(0_usize, |value, digit| {
        digit.is_ascii_digit().then(|| value.saturating_mul(10).saturating_add(usize::from(digit - b'0')))
    })
}

/// Sides stand in the file's header and again in each frame, and the decoder makes room for those of the frame.
fn webp(bytes: &[u8]) -> Result<()> {
    for chunk in webp_chunks(bytes.get(12..).unwrap_or_default()) {
        if chunk.kind == *b"ANMF" {
            // The first frame is the one that is taken.
            let parts = webp_chunks(chunk.content.get(16..).unwrap_or_default());
            return parts.map(|part| part.check()).chain([chunk.check()]).collect();
        }
        chunk.check()?;
    }
    Ok(())
}

struct WebpChunk<'a> {
    kind: [u8; 4],
    /// What it claims.
    length: usize,
    /// As much of it as there is.
    content: &'a [u8],
}

impl WebpChunk<'_> {
    fn check(&self) -> Result<()> {
        // The decoder makes room for the claimed length before it reads.
        if self.kind == *b"EXIF" && self.length > self.content.len() {
            return Err(unreadable("its Exif data end after the file"));
        }
        self.sides().map_or(Ok(()), supported)
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
