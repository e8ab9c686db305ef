//! Progress reports. The core has no clock; a listener that wants times measures them between two calls.

/// A stage of a call that has just begun.
#[non_exhaustive]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stage {
    /// A stable camelCase name, the key of the stage in the timing report.
    pub name: &'static str,
    /// Index of the stage among those of the call, from 0.
    pub index: usize,
    /// Number of stages of the call.
    pub of: usize,
}

/// A listener that is called at the beginning of every stage. A stage that is entered several times is reported each time.
///
/// ```
/// use veronese::{SegmentOptions, segment_pair};
///
/// # fn main() -> veronese::Result<()> {
/// # let scene = scenes::generate(&scenes::SceneOptions { width: 64, height: 48, objects: 1, ..Default::default() })?;
/// # let (first, second) = (scene.first(), scene.second());
/// let mut names = Vec::new();
/// segment_pair(first, second, &SegmentOptions::default(), &mut |stage| {
///     println!("{} of {}: {}", stage.index + 1, stage.of, stage.name);
///     names.push(stage.name);
/// })?;
/// assert_eq!((names[0], names[names.len() - 1]), ("frames", "masks"));
/// # Ok(())
/// # }
/// ```
pub type Progress<'a> = &'a mut dyn FnMut(Stage);

/// Reports the stages of one call by name; their order is defined by the list of names.
pub(crate) struct Stages<'a> {
    names: &'static [&'static str],
    progress: Progress<'a>,
    /// Number of rounds through all stages but the last.
    rounds: usize,
    /// Number of finished rounds.
    over: usize,
}

impl<'a> Stages<'a> {
    pub(crate) fn new(names: &'static [&'static str], progress: Progress<'a>) -> Self {
        Stages { names, progress, rounds: 1, over: 0 }
    }

    /// Begins a round, one of `rounds` through all stages but the last, and reports its first stage.
    pub(crate) fn begin_round(&mut self, round: usize, rounds: usize) {
        (self.over, self.rounds) = (round, rounds);
        self.begin(self.names[0]);
    }

    /// Reports that the stage `name` begins.
    #[inline(never)]
    pub(crate) fn begin(&mut self, name: &'static str) {
        let index = self.names.iter().position(|&n| n == name);
        debug_assert!(index.is_some(), "stage {name} is not in the list");
        let repeated = self.names.len() - 1;
        (self.progress)(Stage {
            name,
            index: self.over * repeated + index.unwrap_or(0),
            of: self.rounds * repeated + 1,
        });
    }
}
