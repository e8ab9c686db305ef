//! The workspace: buffers that were let go are kept for the next of their size, so that a call like the one before it asks the
//! allocator for nothing but its result and a few short lists.
//!
//! Each thread has its own, and only while a call is under way is anything taken from it or put into it: what a caller makes and lets go
//! of, frames and measurements, is the allocator's. A call begins by giving back what the one before it did not use; where frames are
//! of another size than before, everything, so that this is one piece again before anything new is asked for.

use std::cell::{Cell, RefCell};
use std::ops::{Deref, DerefMut};
use std::thread::LocalKey;

/// Values of which buffers are kept.
pub(crate) trait Kept: Copy + Default + 'static {
    /// This thread's buffers of such values that nobody uses.
    fn shelf() -> &'static LocalKey<Cell<Shelf<Self>>>;
}

/// Buffers that nobody uses, each with the number of the call that used it last.
pub(crate) struct Shelf<T> {
    kept: Vec<(u32, Vec<T>)>,
    /// Whether [`SHELVES`] knows of it.
    known: bool,
}

impl<T> Shelf<T> {
    pub(crate) const EMPTY: Shelf<T> = Shelf { kept: Vec::new(), known: false };
}

impl<T> Default for Shelf<T> {
    fn default() -> Self {
        Self::EMPTY
    }
}

/// A thread's calls.
#[derive(Clone, Copy)]
struct Calls {
    /// Whether one is under way.
    busy: bool,
    /// The number of the last, and the size of its frames.
    number: u32,
    size: [usize; 2],
}

thread_local! {
    static CALLS: Cell<Calls> = const { Cell::new(Calls { busy: false, number: 0, size: [0; 2] }) };
    /// What gives back the buffers of each shelf that no call has used since the one of a number.
    static SHELVES: RefCell<Vec<fn(u32)>> = const { RefCell::new(Vec::new()) };
}

/// A call under way: it ends when this is let go.
pub(crate) struct Call(());

/// Begins a call on frames of a size.
pub(crate) fn begin(size: [usize; 2]) -> Call {
    let last = CALLS.get();
    let number = last.number.wrapping_add(1);
    CALLS.set(Calls { busy: true, number, size });
    let since = if size == last.size { last.number } else { number };
    SHELVES.with_borrow(|shelves| shelves.iter().for_each(|sweep| sweep(since)));
    Call(())
}

impl Drop for Call {
    fn drop(&mut self) {
        CALLS.set(Calls { busy: false, ..CALLS.get() });
    }
}

/// Gives back to the allocator what this thread's last call on frames left for the next: about as much as the call took, some thirty
/// bytes for each pixel of large frames. Never needed for an answer; for a thread that goes on and has no more frames to segment.
pub fn release_workspace() {
    let unused = CALLS.get().number.wrapping_add(1);
    SHELVES.with_borrow(|shelves| shelves.iter().for_each(|sweep| sweep(unused)));
}

/// Makes [`Kept`] of types.
macro_rules! kept {
    ($($value:ty),*) => {$(
        impl $crate::workspace::Kept for $value {
            fn shelf() -> &'static std::thread::LocalKey<std::cell::Cell<$crate::workspace::Shelf<Self>>> {
                thread_local! {
                    static SHELF: std::cell::Cell<$crate::workspace::Shelf<$value>> =
                        const { std::cell::Cell::new($crate::workspace::Shelf::EMPTY) };
                }
                &SHELF
            }
        }
    )*};
}
pub(crate) use kept;

kept!(f32, f64, u8, u16, u32, u64, usize, bool, [f32; 2], [f32; 4], [f32; 8], [f32; 16]);

/// A vector whose memory comes from the workspace and goes back there.
#[derive(Debug, PartialEq)]
pub(crate) struct Buffer<T: Kept>(Vec<T>);

impl<T: Kept> Buffer<T> {
    /// Without values, with room for some.
    #[inline(never)]
    pub(crate) fn with_capacity(length: usize) -> Self {
        let mut buffer = Self::used(length);
        buffer.0.clear();
        buffer
    }

    /// As many values as asked for, of whatever was there before: for those who write all of them.
    #[inline(never)]
    pub(crate) fn unwritten(length: usize) -> Self {
        let mut buffer = Self::used(length);
        buffer.0.truncate(length);
        buffer.0.resize_with(length, T::default);
        buffer
    }

    /// One value, many times.
    #[inline]
    pub(crate) fn filled(length: usize, value: T) -> Self {
        let mut buffer = Self::unwritten(length);
        buffer.0.fill(value);
        buffer
    }

    /// Without values, with as much room as there is: for lists of which nobody knows how long they will be.
    #[inline(never)]
    pub(crate) fn list() -> Self {
        let mut buffer = Buffer(T::shelf().with(|shelf| take(shelf, None)));
        buffer.0.clear();
        buffer
    }

    /// A copy of some values.
    #[inline(never)]
    pub(crate) fn of(values: &[T]) -> Self {
        let mut buffer = Self::with_capacity(values.len());
        buffer.0.extend_from_slice(values);
        buffer
    }

    /// Room for some values, with whatever values are in it.
    #[inline(never)]
    fn used(length: usize) -> Self {
        let capacity = if CALLS.get().busy { rounded(length) } else { length };
        let kept = T::shelf().with(|shelf| take(shelf, Some(capacity)));
        Buffer(if kept.capacity() > 0 { kept } else { Vec::with_capacity(capacity) })
    }
}

/// The smallest of the sizes that has room for `length` values: powers of two, and three steps between each and the next.
fn rounded(length: usize) -> usize {
    let step = (length.max(8).next_power_of_two() / 8).max(1);
    length.next_multiple_of(step)
}

/// A buffer of a size, or the largest there is; one without any room where none is kept. This and the next are never inlined because
/// they are nearly the same code for all types.
#[inline(never)]
fn take<T>(shelf: &Cell<Shelf<T>>, capacity: Option<usize>) -> Vec<T> {
    if !CALLS.get().busy {
        return Vec::new();
    }
    let mut stock = shelf.take();
    let found = match capacity {
        // What was used last is most likely still in the cache.
        Some(capacity) => stock.kept.iter().rposition(|(_, buffer)| buffer.capacity() == capacity),
        None => (0..stock.kept.len()).max_by_key(|&k| stock.kept[k].1.capacity()),
    };
    let buffer = found.map_or(Vec::new(), |k| stock.kept.swap_remove(k).1);
    shelf.set(stock);
    buffer
}

/// Keeps a buffer, if a call is under way and it is of a size that is ever looked for.
#[inline(never)]
fn put<T>(shelf: &Cell<Shelf<T>>, buffer: Vec<T>, sweep: fn(u32)) {
    let Calls { busy, number, .. } = CALLS.get();
    if busy && buffer.capacity() > 0 && buffer.capacity() == rounded(buffer.capacity()) {
        let mut stock = shelf.take();
        if !stock.known {
            stock.known = true;
            SHELVES.with_borrow_mut(|shelves| shelves.push(sweep));
        }
        stock.kept.push((number, buffer));
        shelf.set(stock);
    }
}

/// Gives back what no call has used since the one of a number.
fn sweep<T: Kept>(since: u32) {
    T::shelf().with(|shelf| {
        let mut stock = shelf.take();
        while let Some(k) = stock.kept.iter().position(|(used, _)| *used != since) {
            stock.kept.swap_remove(k);
        }
        shelf.set(stock);
    });
}

impl<T: Kept> Drop for Buffer<T> {
    #[inline(never)]
    fn drop(&mut self) {
        let values = std::mem::take(&mut self.0);
        // A thread that ends takes its workspace along.
        let _ = T::shelf().try_with(|shelf| put(shelf, values, sweep::<T>));
    }
}

impl<T: Kept> Default for Buffer<T> {
    fn default() -> Self {
        Buffer(Vec::new())
    }
}

impl<T: Kept> Clone for Buffer<T> {
    fn clone(&self) -> Self {
        Self::of(&self.0)
    }
}

impl<T: Kept> Deref for Buffer<T> {
    type Target = Vec<T>;
    #[inline(always)]
    fn deref(&self) -> &Vec<T> {
        &self.0
    }
}

impl<T: Kept> DerefMut for Buffer<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut Vec<T> {
        &mut self.0
    }
}

impl<T: Kept> FromIterator<T> for Buffer<T> {
    #[inline]
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        let values = values.into_iter();
        // Room for as many as there may be: what is not used is there for the next.
        let (least, most) = values.size_hint();
        let mut buffer = Self::with_capacity(most.unwrap_or(least));
        buffer.0.extend(values);
        buffer
    }
}

impl<'a, T: Kept> IntoIterator for &'a Buffer<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;
    #[inline]
    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

impl<T: Kept> From<Vec<T>> for Buffer<T> {
    fn from(values: Vec<T>) -> Self {
        Buffer(values)
    }
}

impl<'a, T: Kept> IntoIterator for &'a mut Buffer<T> {
    type Item = &'a mut T;
    type IntoIter = std::slice::IterMut<'a, T>;
    #[inline]
    fn into_iter(self) -> Self::IntoIter {
        self.0.iter_mut()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a buffer's values lie.
    fn place(buffer: &Buffer<f64>) -> *const f64 {
        buffer.as_ptr()
    }

    #[test]
    fn a_size_has_room_and_is_its_own_size() {
        for length in (0..5000).chain([76_800, 307_200, 16_777_216]) {
            let size = rounded(length);
            assert!(size >= length && size <= length + length / 4 + 1, "{size} for {length}");
            assert_eq!(rounded(size), size);
        }
        assert_eq!(rounded(1 << 24), 1 << 24);
    }

    /// Sizes of the buffers that are kept.
    fn kept<T: Kept>() -> Vec<usize> {
        T::shelf().with(|shelf| {
            let stock = shelf.take();
            let capacities = stock.kept.iter().map(|(_, buffer)| buffer.capacity()).collect();
            shelf.set(stock);
            capacities
        })
    }

    #[test]
    fn what_is_let_go_is_used_again() {
        let _call = begin([640, 480]);
        let first = Buffer::filled(1000, 1.0);
        let at = place(&first);
        drop(first);
        let second: Buffer<f64> = Buffer::unwritten(1001);
        assert_eq!(place(&second), at, "of the same size after rounding");
        let other: Buffer<f64> = Buffer::filled(1000, 2.0);
        assert_ne!(place(&other), at);
        assert!(other.iter().all(|&v| v == 2.0) && other.len() == 1000);
        drop(second);
        let mut list: Buffer<f64> = Buffer::list();
        assert!(list.is_empty() && list.capacity() >= 1000);
        list.push(1.0);
        assert_eq!(list[..], [1.0]);
    }

    #[test]
    fn what_a_call_did_not_use_is_given_back() {
        let used = |size, lengths: &[usize]| {
            let _call = begin(size);
            lengths.iter().for_each(|&length| drop(Buffer::filled(length, 0u64)));
            let mut sizes = kept::<u64>();
            sizes.sort_unstable();
            sizes
        };
        let [small, large] = [100, 1000].map(rounded);
        assert_eq!(used([320, 240], &[100, 1000]), [small, large]);
        assert_eq!(used([320, 240], &[100]), [small, large], "what the call before used");
        assert_eq!(used([320, 240], &[]), [small]);
        assert_eq!(used([320, 240], &[1000]), [large]);
        assert_eq!(used([640, 480], &[100]), [small], "another size of frames");
    }

    #[test]
    fn a_thread_can_let_go_of_everything() {
        let call = begin([320, 240]);
        drop(Buffer::filled(100, 0u32));
        drop(call);
        assert_eq!(kept::<u32>(), [rounded(100)]);
        release_workspace();
        assert!(kept::<u32>().is_empty());
    }

    #[test]
    fn between_calls_nothing_is_kept() {
        drop(Buffer::filled(64, 0u16));
        assert!(kept::<u16>().is_empty());
        let call = begin([320, 240]);
        let first = Buffer::filled(64, 0u16);
        drop(Buffer::filled(64, 0u16));
        drop(call);
        drop(first);
        assert_eq!(kept::<u16>(), [64]);
        assert_eq!(Buffer::<u16>::unwritten(65).capacity(), 65, "and nothing is rounded");
    }
}
