//! The two sides of a border around an object, and values for each of them.

use std::ops::{Index, IndexMut};

/// The object, or the ground around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Object,
    Ground,
}

impl Side {
    /// Both sides, in the order of the values of a pair.
    pub(crate) const BOTH: [Side; 2] = [Side::Object, Side::Ground];

    pub(crate) fn object_if(is_object: bool) -> Side {
        if is_object { Side::Object } else { Side::Ground }
    }

    /// The side that log-odds of object against ground favour.
    pub(crate) fn favoured_by(log_odds: f32) -> Side {
        if log_odds < 0.0 { Side::Ground } else { Side::Object }
    }

    pub(crate) fn other(self) -> Side {
        Side::object_if(self == Side::Ground)
    }
}

/// A pair has a value for the object and one for the ground.
impl<T> Index<Side> for [T; 2] {
    type Output = T;

    fn index(&self, side: Side) -> &T {
        &self[side as usize]
    }
}

impl<T> IndexMut<Side> for [T; 2] {
    fn index_mut(&mut self, side: Side) -> &mut T {
        &mut self[side as usize]
    }
}
