//! Pages that programs write: no text of theirs is written by hand.
#![cfg(not(target_arch = "wasm32"))]
#![allow(clippy::unwrap_used, reason = "test code may panic")]

#[path = "../experiments/sealed.rs"]
mod sealed;

use std::fs;

use sealed::{changed, opened, sealed};

#[test]
fn the_pages_are_as_their_programs_wrote_them() {
    let programs = [("masks", "masks"), ("clips", "clips"), ("annotating", "annotator")];
    for (page, program) in programs.map(|(page, program)| (format!("docs/{page}.md"), format!("experiments/{program}")))
    {
        let text = fs::read_to_string(format!("{}/{page}", env!("CARGO_MANIFEST_DIR"))).unwrap();
        assert!(opened(&text).is_some(), "{}", changed(&page, &program));
    }
}

#[test]
fn a_seal_holds_until_the_text_changes() {
    let page = sealed("# Masks\n\nA sentence.\n");
    assert_eq!(opened(&page), Some("# Masks\n\nA sentence."));
    assert_eq!(opened(&page.replace('\n', "\r\n")), Some("# Masks\r\n\r\nA sentence."));
    assert_eq!(sealed(opened(&page).unwrap()), page);
    for other in [
        page.replace("A sentence.", "A sentence.\n\nAnother one."),
        page.replace("seal ", "seal 1"),
        format!("{page}More."),
    ] {
        assert_eq!(opened(&other), None, "{other}");
    }
    assert_eq!(opened("# Masks\n"), None);
}
