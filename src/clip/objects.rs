//! The objects of a clip: their numbers, locks, names and descriptions.

use super::annotation::{ObjectSet, is_object};
use super::saved::saved;
use crate::error::{Error, Result};

/// An object's name, class and colour. An empty text is none.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Description {
    /// Its name. Objects with a name change only by annotations of themselves.
    pub name: String,
    /// Its class.
    pub class: String,
    /// The colour in which it is shown: red, green and blue.
    pub colour: Option<[u8; 3]>,
}

saved!(Description { name, class, colour });

/// All objects of a clip, by number.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Objects {
    /// For each object, its number in the results: its own unless the object was merged or deleted.
    pub(super) numbers: [u8; 256],
    /// For each object, whether it is locked.
    pub(super) locked: ObjectSet,
    /// For each object, whether a person has named it, so that only annotations of itself change it.
    pub(super) named: ObjectSet,
    /// For each object, whether masks of it were given, which replace the object found there.
    pub(super) given: ObjectSet,
    /// The numbers that objects have had: none is given again.
    pub(super) used: ObjectSet,
    /// Number of objects for which no number was left; they count as background.
    pub(super) dropped: usize,
    /// By number.
    pub(super) descriptions: Vec<(u8, Description)>,
}

saved!(Objects { numbers, locked, named, given, used, dropped, descriptions });

impl Objects {
    pub(super) fn new(dropped: usize) -> Objects {
        let [locked, named, given, used] = [[false; 256]; 4];
        let numbers = std::array::from_fn(|k| k as u8);
        Objects { numbers, locked, named, given, used, dropped, descriptions: Vec::new() }
    }

    /// These objects, and those that were merged into them.
    pub(super) fn with_merged(&self, objects: &[u8]) -> ObjectSet {
        std::array::from_fn(|k| objects.contains(&(k as u8)) || objects.contains(&self.numbers[k]))
    }

    /// The number under which an object goes on, its own unless it was merged.
    ///
    /// # Errors
    /// [`Error::InvalidOption`] for a number out of range, and for an object that was deleted.
    pub(super) fn current(&self, object: u8) -> Result<u8> {
        let reason = match self.number(object) {
            _ if !is_object(object) => format!("{object} is no number of an object: these are 1 to 254"),
            0 => format!("object {object} was deleted, and its number is not given again"),
            number => return Ok(number),
        };
        Err(Error::InvalidOption { name: "object", reason })
    }

    /// The name, class and colour of an object.
    pub(super) fn description(&self, object: u8) -> Description {
        self.descriptions.iter().find(|(of, _)| *of == object).map(|(_, of)| of.clone()).unwrap_or_default()
    }

    /// Sets the name, class and colour of an object.
    pub(super) fn describe(&mut self, object: u8, description: Description) {
        self.descriptions.retain(|(of, _)| *of != object);
        if description != Description::default() {
            let at = self.descriptions.partition_point(|(of, _)| *of < object);
            self.descriptions.insert(at, (object, description));
        }
    }

    /// The number of an object in the results; 0 if it was deleted.
    pub(super) fn number(&self, object: u8) -> u8 {
        self.numbers[usize::from(object)]
    }
}
