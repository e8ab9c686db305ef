//! Pages that a program writes end with a seal, the hash of their text. A page that was changed by hand is noticed by it, so that
//! nobody's text is lost when the program writes the page again, or stays by accident. Such text belongs into the program. What a benchmark
//! of the page has written between marks is not sealed.

const BEGINS: &str = "<!-- Written by a program, text and all; seal ";
const ENDS: &str = " -->";

/// Begin of the lines around what a benchmark of the page writes.
const PART_BEGINS: &str = "<!-- begin page";
const PART_ENDS: &str = "<!-- end page";

/// A text with its seal.
pub(crate) fn sealed(text: &str) -> String {
    let text = text.trim_end();
    format!("{text}\n\n{BEGINS}{:016x}{ENDS}\n", hash(text))
}

/// The text of a page, without its seal; none if the page was changed since it was sealed.
pub(crate) fn opened(page: &str) -> Option<&str> {
    let (text, seal) = page.trim_end().rsplit_once(BEGINS)?;
    let text = text.trim_end();
    (seal.strip_suffix(ENDS)? == format!("{:016x}", hash(text))).then_some(text)
}

/// Why a changed page is not written again.
pub(crate) fn changed(page: &str, program: &str) -> String {
    format!("{page} was changed by hand. Move that text into {program}, so that it is written again.")
}

/// FNV-1a, 64 bits, the same for both ways to end a line, without what is not sealed.
fn hash(text: &str) -> u64 {
    let mut inside = false;
    let outside = text.split_inclusive('\n').filter(|line| {
        inside &= !line.starts_with(PART_ENDS);
        let sealed = !inside;
        inside |= line.starts_with(PART_BEGINS);
        sealed
    });
    let bytes = outside.flat_map(str::bytes).filter(|&byte| byte != b'\r');
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}
