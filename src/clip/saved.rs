//! Values of a clip as bytes: a mark with the version of the format and of the crate, then all values in the order of their fields,
//! then a hash of all that. Numbers are little-endian.

use std::sync::Arc;

use crate::error::{Error, Result};
use crate::hash::hash;
use crate::motion::AffineMotion;
use crate::pair::frame_motions::Prior;

/// A value that can be written as bytes and read again.
pub(super) trait Saved {
    /// Appends the bytes of the value.
    fn write(&self, bytes: &mut Vec<u8>);
    /// Takes a value from the front of the bytes; `None` if they end too early or are not such a value.
    fn read(bytes: &mut &[u8]) -> Option<Self>
    where
        Self: Sized;
}

/// A kind of saved bytes.
pub(super) struct Format {
    /// Their name in errors.
    pub(super) name: &'static str,
    /// Their beginning, which differs in every version.
    pub(super) mark: &'static str,
}

impl Format {
    pub(super) fn written(&self, value: &impl Saved) -> Vec<u8> {
        let mut bytes = self.mark.as_bytes().to_vec();
        value.write(&mut bytes);
        hash(0, &bytes).write(&mut bytes);
        bytes
    }

    pub(super) fn read<T: Saved>(&self, bytes: &[u8]) -> Result<T> {
        let mut rest = self.content(bytes)?;
        T::read(&mut rest).filter(|_| rest.is_empty()).ok_or_else(|| self.damaged())
    }

    /// The bytes of the value, as they were written.
    #[inline(never)]
    fn content<'b>(&self, bytes: &'b [u8]) -> Result<&'b [u8]> {
        if !bytes.starts_with(self.mark.as_bytes()) {
            return Err(self.invalid("these bytes are not of this version: segment the clip again"));
        }
        // A fuzzer does not guess sums, and somebody who changes bytes can compute them.
        let is_sum = |content, sum| cfg!(fuzzing) || hash(0, content) == u64::from_le_bytes(sum);
        let whole = bytes.split_last_chunk().filter(|(content, sum)| is_sum(content, **sum));
        whole.and_then(|(content, _)| content.get(self.mark.len()..)).ok_or_else(|| self.damaged())
    }

    pub(super) fn damaged(&self) -> Error {
        self.invalid("it is damaged")
    }

    fn invalid(&self, reason: &str) -> Error {
        Error::InvalidOption { name: self.name, reason: reason.into() }
    }
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

impl Saved for u64 {
    fn write(&self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(&self.to_le_bytes());
    }

    fn read(bytes: &mut &[u8]) -> Option<u64> {
        let (number, rest) = bytes.split_first_chunk()?;
        *bytes = rest;
        Some(u64::from_le_bytes(*number))
    }
}

impl Saved for f64 {
    fn write(&self, bytes: &mut Vec<u8>) {
        self.to_bits().write(bytes);
    }

    fn read(bytes: &mut &[u8]) -> Option<f64> {
        u64::read(bytes).map(f64::from_bits)
    }
}

impl<T: Saved + Copy + Default, const N: usize> Saved for [T; N] {
    fn write(&self, bytes: &mut Vec<u8>) {
        self.iter().for_each(|value| value.write(bytes));
    }

    fn read(bytes: &mut &[u8]) -> Option<[T; N]> {
        let mut values = [T::default(); N];
        for value in &mut values {
            *value = T::read(bytes)?;
        }
        Some(values)
    }
}

/// The number of values, then the values.
impl<T: Saved> Saved for Vec<T> {
    fn write(&self, bytes: &mut Vec<u8>) {
        self.len().write(bytes);
        self.iter().for_each(|value| value.write(bytes));
    }

    fn read(bytes: &mut &[u8]) -> Option<Vec<T>> {
        // Nothing is allocated in advance: the number may be wrong.
        let mut values = Vec::new();
        for _ in 0..usize::read(bytes)? {
            values.push(T::read(bytes)?);
        }
        Some(values)
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

impl<T: Saved> Saved for Arc<T> {
    fn write(&self, bytes: &mut Vec<u8>) {
        T::write(self, bytes);
    }

    fn read(bytes: &mut &[u8]) -> Option<Arc<T>> {
        T::read(bytes).map(Arc::new)
    }
}

/// The bytes of a text in UTF-8, after their number.
impl Saved for String {
    fn write(&self, bytes: &mut Vec<u8>) {
        self.len().write(bytes);
        bytes.extend_from_slice(self.as_bytes());
    }

    fn read(bytes: &mut &[u8]) -> Option<String> {
        let length = usize::read(bytes)?;
        String::from_utf8(bytes.split_off(..length)?.to_vec()).ok()
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

saved!(Prior { motions, enough, searched });
