//! Telling the caller where the work is. The core has no clock: whoever listens measures the time between two calls.

/// A stage of the work that has just begun.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stage {
    /// A camelCase name, stable: the key of the stage in the timing report.
    pub name: &'static str,
    /// Position of the stage among all stages of this call, from 0.
    pub index: usize,
    /// Number of stages of this call.
    pub of: usize,
}

/// Called at the beginning of every stage. A stage that is entered again (n tried after n) is reported again.
pub type Progress<'a> = &'a mut dyn FnMut(Stage);

/// Reports the stages of one call by name, so that the order stands in one place.
pub(crate) struct Stages<'a> {
    names: &'static [&'static str],
    progress: Progress<'a>,
}

impl<'a> Stages<'a> {
    pub(crate) fn new(names: &'static [&'static str], progress: Progress<'a>) -> Self {
        Stages { names, progress }
    }

    /// Reports that `name` begins. Unknown names are a mistake of ours, caught in tests.
    #[inline(never)]
    pub(crate) fn begin(&mut self, name: &'static str) {
        let index = self.names.iter().position(|&n| n == name);
        debug_assert!(index.is_some(), "stage {name} is not in the list");
        (self.progress)(Stage { name, index: index.unwrap_or(0), of: self.names.len() });
    }
}
