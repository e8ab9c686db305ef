//! Image files are not trusted: whatever the bytes, there is a picture of its size or an error with a published code.
#![no_main]

use libfuzzer_sys::fuzz_target;
use veronese::MAX_SIDE;
use veronese::codecs::decode_image;

fuzz_target!(|bytes: &[u8]| match decode_image(bytes) {
    Ok(picture) => {
        assert!((1..=MAX_SIDE).contains(&picture.width) && (1..=MAX_SIDE).contains(&picture.height));
        assert_eq!(picture.rgba.len(), 4 * picture.width * picture.height);
        // Frames of large pictures are tried elsewhere, and take long here.
        if picture.rgba.len() <= 4 * 48 * 48 {
            drop(picture.frame());
        }
    }
    Err(error) => assert!(matches!(error.code(), "unreadable-image" | "frame-size-unsupported"), "{error}"),
});
