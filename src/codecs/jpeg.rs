//! JPEG files, to which phones append videos, and of which networks lose pieces. A file is read to its own end, and no further. Decoders
//! fill missing parts of a scan with grey, which would be segmented like image content; here a missing part is an error, unless it is
//! allowed.

use crate::error::{Error, Result};

mod scan;

/// The part of a file that is the image.
///
/// # Errors
/// `unreadable-image` where the end or a part of a scan is missing, unless the file may be damaged.
pub(super) fn image(bytes: &[u8], allow_damaged: bool) -> Result<&[u8]> {
    let Some(end) = end(bytes) else {
        return if allow_damaged { Ok(bytes) } else { Err(unreadable("it is a JPEG file without its end")) };
    };
    let file = &bytes[..end];
    if allow_damaged || scan::are_whole(file) {
        return Ok(file);
    }
    Err(unreadable("it is a JPEG file of which a part is missing or damaged"))
}

fn unreadable(reason: &str) -> Error {
    Error::UnreadableImage { reason: reason.into() }
}

/// Where the image ends: after its own marker "end of image". Previews lie in segments, which are skipped; after the end there may be any
/// bytes. `None` without an end.
fn end(bytes: &[u8]) -> Option<usize> {
    let mut at = 2;
    loop {
        at += bytes.get(at..)?.iter().position(|&byte| byte == 0xff)?;
        match *bytes.get(at + 1)? {
            // A fill byte, which may be the first of a marker.
            0xff => at += 1,
            // A byte of a scan, or a marker without a segment.
            0 | 1 | 0xd0..=0xd8 => at += 2,
            0xd9 => return Some(at + 2),
            _ => at += 2 + usize::from(u16::from_be_bytes([*bytes.get(at + 2)?, *bytes.get(at + 3)?])).max(2),
        }
    }
}

#[cfg(test)]
mod tests {
    use image::codecs::jpeg::JpegEncoder;

    use crate::codecs::{Decoding, decode_image, decode_image_with};

    const SIZE: (u32, u32) = (96, 72);

    /// A file with much in every part of its scan.
    fn file() -> Vec<u8> {
        let rgb: Vec<u8> = (0..SIZE.0 * SIZE.1 * 3).map(|at| (at.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
        let mut file = Vec::new();
        JpegEncoder::new_with_quality(&mut file, 90)
            .encode(&rgb, SIZE.0, SIZE.1, image::ExtendedColorType::Rgb8)
            .unwrap();
        file
    }

    /// The file without the bytes between two positions, given as shares of its length.
    fn without(file: &[u8], from: f64, until: f64) -> Vec<u8> {
        let at = |share: f64| (share * file.len() as f64) as usize;
        [&file[..at(from)], &file[at(until)..]].concat()
    }

    #[test]
    fn what_is_appended_is_not_read() {
        let plain = decode_image(&file()).unwrap();
        let tails: [&[u8]; 5] = [b"\xff\xd9\xff\xda", b"\xff\xd8\xff\xda\xff\xd9", b"\xff", &[0; 100], &file()];
        for tail in tails {
            assert_eq!(decode_image(&[&file()[..], tail].concat()).unwrap(), plain, "{:?}", &tail[..tail.len().min(6)]);
        }
    }

    #[test]
    fn a_scan_with_a_part_missing_is_unreadable_unless_that_is_allowed() {
        let file = file();
        let allowed = Decoding { allow_damaged: true, ..Decoding::default() };
        for (from, until) in [(0.5, 0.6), (0.4, 0.95), (0.3, 0.9)] {
            let error = decode_image(&without(&file, from, until)).map(|_| ()).unwrap_err();
            assert_eq!(error.code(), "unreadable-image");
            assert!(error.to_string().contains("missing or damaged"), "{error}");
            let picture = decode_image_with(&without(&file, from, until), &allowed).unwrap();
            assert_eq!((picture.width, picture.height), (SIZE.0 as usize, SIZE.1 as usize));
        }
        let cut = &file[..file.len() / 2];
        assert!(decode_image(cut).unwrap_err().to_string().contains("without its end"));
        assert!(decode_image_with(cut, &allowed).is_ok());
        assert_eq!(decode_image_with(&file, &allowed).unwrap(), decode_image(&file).unwrap());
    }

    #[test]
    fn no_damage_is_a_panic() {
        let file = file();
        for at in (2..file.len()).step_by(23) {
            let mut other = file.clone();
            other[at] ^= 0xff;
            for bytes in [&other[..], &file[..at], &without(&file, 0.1, at as f64 / file.len() as f64)[..]] {
                let error = decode_image(bytes).err();
                assert!(
                    error.is_none_or(|error| ["unreadable-image", "frame-size-unsupported"].contains(&error.code()))
                );
            }
        }
    }
}
