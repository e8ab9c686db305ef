//! What is kept of a clip, as bytes: a mark with the version of the format, then all values in the order of their fields. Numbers are
//! little-endian.

use crate::error::{Error, Result};
use crate::motion::AffineMotion;
use crate::pair::solution::Prior;

/// A value that can be written as bytes and read again.
pub(super) trait Saved: Sized {
    /// Appends the bytes of the value.
    fn write(&self, bytes: &mut Vec<u8>);
    /// Takes a value from the front of the bytes; `None` if they end too early or mean no such value.
    fn read(bytes: &mut &[u8]) -> Option<Self>;
}

/// A mark and a value.
pub(super) fn to_bytes(mark: &[u8; 8], value: &impl Saved) -> Vec<u8> {
    let mut bytes = mark.to_vec();
    value.write(&mut bytes);
    bytes
}

/// The value after a mark.
pub(super) fn from_bytes<T: Saved>(mark: &[u8; 8], bytes: &[u8]) -> Result<T> {
    let invalid = |reason: &str| Error::InvalidOption { name: "state", reason: reason.into() };
    let mut rest = bytes.strip_prefix(mark).ok_or_else(|| invalid("these bytes are not of this version"))?;
    T::read(&mut rest).filter(|_| rest.is_empty()).ok_or_else(|| invalid("it is damaged"))
}

/// Implements [`Saved`] for a struct whose fields are all saved.
macro_rules! saved {
    ($name:ident { $($field:tt),* }) => {
        impl $crate::clip::saved::Saved for $name {
            fn write(&self, bytes: &mut Vec<u8>) {
                $($crate::clip::saved::Saved::write(&self.$field, bytes);)*
            }

            fn read(bytes: &mut &[u8]) -> Option<Self> {
                Some($name { $($field: $crate::clip::saved::Saved::read(bytes)?),* })
            }
        }
    };
}
pub(super) use saved;

impl Saved for u8 {
    fn write(&self, bytes: &mut Vec<u8>) {
        bytes.push(*self);
    }

    fn read(bytes: &mut &[u8]) -> Option<u8> {
        bytes.split_off_first().copied()
    }
}

impl Saved for bool {
    fn write(&self, bytes: &mut Vec<u8>) {
        u8::from(*self).write(bytes);
    }

    fn read(bytes: &mut &[u8]) -> Option<bool> {
        match u8::read(bytes)? {
            0 => Some(false),
            1 => Some(true),
            _ => None,
        }
    }
}

/// In four bytes: all numbers of a clip are below 2³².
impl Saved for usize {
    fn write(&self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(&(*self as u32).to_le_bytes());
    }

    fn read(bytes: &mut &[u8]) -> Option<usize> {
        let (number, rest) = bytes.split_first_chunk()?;
        *bytes = rest;
        Some(u32::from_le_bytes(*number) as usize)
    }
}

impl Saved for f64 {
    fn write(&self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(&self.to_le_bytes());
    }

    fn read(bytes: &mut &[u8]) -> Option<f64> {
        let (number, rest) = bytes.split_first_chunk()?;
        *bytes = rest;
        Some(f64::from_le_bytes(*number))
    }
}

impl<T: Saved, const N: usize> Saved for [T; N] {
    fn write(&self, bytes: &mut Vec<u8>) {
        self.iter().for_each(|value| value.write(bytes));
    }

    fn read(bytes: &mut &[u8]) -> Option<[T; N]> {
        let values: Option<Vec<T>> = (0..N).map(|_| T::read(bytes)).collect();
        values?.try_into().ok()
    }
}

/// The number of values, then the values.
impl<T: Saved> Saved for Vec<T> {
    fn write(&self, bytes: &mut Vec<u8>) {
        self.len().write(bytes);
        self.iter().for_each(|value| value.write(bytes));
    }

    fn read(bytes: &mut &[u8]) -> Option<Vec<T>> {
        // Nothing is allocated in advance: the number may be damaged.
        (0..usize::read(bytes)?).map(|_| T::read(bytes)).collect()
    }
}

/// Whether there is a value, then the value.
impl<T: Saved> Saved for Option<T> {
    fn write(&self, bytes: &mut Vec<u8>) {
        self.is_some().write(bytes);
        self.iter().for_each(|value| value.write(bytes));
    }

    fn read(bytes: &mut &[u8]) -> Option<Option<T>> {
        if bool::read(bytes)? { T::read(bytes).map(Some) } else { Some(None) }
    }
}

impl<A: Saved, B: Saved> Saved for (A, B) {
    fn write(&self, bytes: &mut Vec<u8>) {
        self.0.write(bytes);
        self.1.write(bytes);
    }

    fn read(bytes: &mut &[u8]) -> Option<(A, B)> {
        Some((A::read(bytes)?, B::read(bytes)?))
    }
}

saved!(AffineMotion { matrix });

/// Only streams follow motions; the pairs of a whole clip do not need the cost after the last search.
impl Saved for Prior {
    fn write(&self, bytes: &mut Vec<u8>) {
        self.motions.write(bytes);
        self.enough.write(bytes);
    }

    fn read(bytes: &mut &[u8]) -> Option<Prior> {
        let (motions, enough) = Saved::read(bytes)?;
        Some(Prior { motions, enough, searched: enough })
    }
}
