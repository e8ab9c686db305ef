//! How the programs of this folder begin and end.

use std::fmt::Display;

/// Runs a program with its options; `None` shows the help. Ends with 1 after a failure, with 2 for wrong options.
pub fn start<O, E: Display>(help: &str, options: Result<Option<O>, String>, run: impl FnOnce(&O) -> Result<(), E>) {
    let (message, code) = match options.map(|options| options.map(|options| run(&options))) {
        Ok(None) => return print!("{help}"),
        Ok(Some(Ok(()))) => return,
        Ok(Some(Err(error))) => (error.to_string(), 1),
        Err(message) => (format!("{message}\n\n{help}"), 2),
    };
    eprintln!("{message}");
    std::process::exit(code);
}
