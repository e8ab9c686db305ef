//! The workspace: dropped buffers are kept and reused, so a call like the previous one allocates only its result and a few short lists.
//!
//! Each thread has its own workspace. It is used only during a call; buffers that the caller creates and drops (frames, measurements)
//! come from the allocator. A call begins by freeing the buffers that the previous one did not use, or all of them if the size of the
//! frames has changed, which avoids fragmentation.

use std::cell::{Cell, RefCell};
use std::ops::{Deref, DerefMut};
use std::thread::LocalKey;

/// A type of values whose buffers are reused.
pub(crate) trait Kept: Copy + Default + 'static {
    /// This thread's free buffers of the type.
    fn shelf() -> &'static LocalKey<Cell<Shelf<Self>>>;
}

/// Free buffers, each with the number of the call that used it last.
pub(crate) struct Shelf<T> {
    kept: Vec<(u32, Vec<T>)>,
    /// Whether it is registered in [`SHELVES`].
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

/// The state of a thread's calls.
#[derive(Clone, Copy)]
struct Calls {
    /// Whether a call is in progress.
    busy: bool,
    /// Number of the last call.
    number: u32,
    /// Width and height of its frames.
    size: [usize; 2],
}

thread_local! {
    static CALLS: Cell<Calls> = const { Cell::new(Calls { busy: false, number: 0, size: [0; 2] }) };
    /// For each shelf, the function that frees buffers not used since a given call.
    static SHELVES: RefCell<Vec<fn(u32)>> = const { RefCell::new(Vec::new()) };
}

/// A call in progress. Dropping it ends the call.
pub(crate) struct Call(());

/// Begins a call on frames of the given width and height.
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

/// Frees the buffers that this thread keeps for its next call on frames: for large frames, about thirty bytes per pixel.
///
/// Results never depend on it. It is meant for threads that live on but have no more frames to segment.
///
/// ```
/// use veronese::scene::{self, SceneOptions};
/// use veronese::{SegmentOptions, release_workspace, segment_pair};
///
/// # fn main() -> veronese::Result<()> {
/// let scene = scene::generate(&SceneOptions { width: 64, height: 48, objects: 1, ..SceneOptions::default() })?;
/// let segment = || segment_pair(scene.first(), scene.second(), &SegmentOptions::default(), &mut |_| {});
/// let found = segment()?;
/// release_workspace();
/// assert_eq!(segment()?.labels, found.labels);
/// # Ok(())
/// # }
/// ```
pub fn release_workspace() {
    let unused = CALLS.get().number.wrapping_add(1);
    SHELVES.with_borrow(|shelves| shelves.iter().for_each(|sweep| sweep(unused)));
}

/// Implements [`Kept`] for types.
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

/// A vector whose memory comes from the workspace and returns to it when dropped.
#[derive(Debug, PartialEq)]
pub(crate) struct Buffer<T: Kept>(Vec<T>);

impl<T: Kept> Buffer<T> {
    /// An empty buffer with at least the given capacity.
    #[inline(never)]
    pub(crate) fn with_capacity(length: usize) -> Self {
        let mut buffer = Self::used(length);
        buffer.0.clear();
        buffer
    }

    /// A buffer of unspecified values, for callers that overwrite all of them.
    #[inline(never)]
    pub(crate) fn unwritten(length: usize) -> Self {
        let mut buffer = Self::used(length);
        buffer.0.truncate(length);
        buffer.0.resize_with(length, T::default);
        buffer
    }

    /// A buffer of equal values.
    #[inline]
    pub(crate) fn filled(length: usize, value: T) -> Self {
        let mut buffer = Self::unwritten(length);
        buffer.0.fill(value);
        buffer
    }

    /// An empty buffer with the largest free capacity, for lists of unknown length.
    #[inline(never)]
    pub(crate) fn list() -> Self {
        let mut buffer = Buffer(T::shelf().with(|shelf| take(shelf, None)));
        buffer.0.clear();
        buffer
    }

    /// A copy of a slice.
    #[inline(never)]
    pub(crate) fn of(values: &[T]) -> Self {
        let mut buffer = Self::with_capacity(values.len());
        buffer.0.extend_from_slice(values);
        buffer
    }

    /// A buffer with at least the given capacity and arbitrary contents.
    #[inline(never)]
    fn used(length: usize) -> Self {
        let capacity = if CALLS.get().busy { rounded(length) } else { length };
        let kept = T::shelf().with(|shelf| take(shelf, Some(capacity)));
        Buffer(if kept.capacity() > 0 { kept } else { Vec::with_capacity(capacity) })
    }
}

/// The smallest size class of at least `length` values: powers of two, and three equal steps between each and the next.
fn rounded(length: usize) -> usize {
    let step = (length.max(8).next_power_of_two() / 8).max(1);
    length.next_multiple_of(step)
}

/// A free buffer of the given capacity, or the largest for `None`; one without capacity if there is none. Never inlined, like [`put`],
/// because the code is nearly the same for all types.
#[inline(never)]
fn take<T>(shelf: &Cell<Shelf<T>>, capacity: Option<usize>) -> Vec<T> {
    if !CALLS.get().busy {
        return Vec::new();
    }
    let mut stock = shelf.take();
    let found = match capacity {
        // The most recently used buffer is most likely still in the cache.
        Some(capacity) => stock.kept.iter().rposition(|(_, buffer)| buffer.capacity() == capacity),
        None => (0..stock.kept.len()).max_by_key(|&k| stock.kept[k].1.capacity()),
    };
    let buffer = found.map_or(Vec::new(), |k| stock.kept.swap_remove(k).1);
    shelf.set(stock);
    buffer
}

/// Keeps a buffer if a call is in progress and its capacity is a size class.
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

/// Frees the buffers that were not last used by the call number `since`.
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
        // Fails while a thread ends, after its workspace has been freed.
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
        // The upper bound: unused capacity is reused later anyway.
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

    /// The address of a buffer's values.
    fn place(buffer: &Buffer<f64>) -> *const f64 {
        buffer.as_ptr()
    }

    #[test]
    fn a_size_class_is_large_enough_and_its_own_class() {
        for length in (0..5000).chain([76_800, 307_200, 16_777_216]) {
            let size = rounded(length);
            assert!(size >= length && size <= length + length / 4 + 1, "{size} for {length}");
            assert_eq!(rounded(size), size);
        }
        assert_eq!(rounded(1 << 24), 1 << 24);
    }

    /// Capacities of the free buffers of a type.
    fn kept<T: Kept>() -> Vec<usize> {
        T::shelf().with(|shelf| {
            let stock = shelf.take();
            let capacities = stock.kept.iter().map(|(_, buffer)| buffer.capacity()).collect();
            shelf.set(stock);
            capacities
        })
    }

    #[test]
    fn dropped_buffers_are_reused() {
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
    fn buffers_that_a_call_did_not_use_are_freed() {
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
    fn release_workspace_frees_all_buffers() {
        let call = begin([320, 240]);
        drop(Buffer::filled(100, 0u32));
        drop(call);
        assert_eq!(kept::<u32>(), [rounded(100)]);
        release_workspace();
        assert!(kept::<u32>().is_empty());
    }

    #[test]
    fn buffers_dropped_outside_a_call_are_not_kept() {
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
