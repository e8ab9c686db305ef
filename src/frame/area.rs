//! Rectangles of pixels.

use std::ops::Range;

/// A rectangle of pixels.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Area {
    pub(crate) columns: Range<usize>,
    pub(crate) rows: Range<usize>,
}

impl Area {
    pub(crate) fn whole(width: usize, height: usize) -> Area {
        Area { columns: 0..width, rows: 0..height }
    }

    /// Bounding rectangle of some pixels of a grid, given by their indices; empty if there are none.
    pub(crate) fn of(pixels: &[usize], width: usize) -> Area {
        let Some(&first) = pixels.first() else { return Area::whole(0, 0) };
        let one = |p: usize| Area { columns: p % width..p % width + 1, rows: p / width..p / width + 1 };
        pixels.iter().fold(one(first), |area, &p| area.with(&one(p)))
    }

    pub(crate) fn width(&self) -> usize {
        self.columns.len()
    }

    pub(crate) fn height(&self) -> usize {
        self.rows.len()
    }

    /// Grown by a margin, clipped to a grid.
    pub(crate) fn grown(&self, by: usize, width: usize, height: usize) -> Area {
        let grown = |range: &Range<usize>, size: usize| range.start.saturating_sub(by)..(range.end + by).min(size);
        Area { columns: grown(&self.columns, width), rows: grown(&self.rows, height) }
    }

    /// The part that lies in another one.
    pub(crate) fn within(&self, other: &Area) -> Area {
        let part = |a: &Range<usize>, b: &Range<usize>| a.start.max(b.start).min(b.end)..a.end.min(b.end).max(b.start);
        Area { columns: part(&self.columns, &other.columns), rows: part(&self.rows, &other.rows) }
    }

    /// Bounding rectangle of both.
    pub(crate) fn with(&self, other: &Area) -> Area {
        let both = |a: &Range<usize>, b: &Range<usize>| a.start.min(b.start)..a.end.max(b.end);
        Area { columns: both(&self.columns, &other.columns), rows: both(&self.rows, &other.rows) }
    }

    /// Whether both share a pixel, a side or a corner.
    pub(crate) fn touches(&self, other: &Area) -> bool {
        let touch = |a: &Range<usize>, b: &Range<usize>| a.start <= b.end && b.start <= a.end;
        touch(&self.columns, &other.columns) && touch(&self.rows, &other.rows)
    }

    /// The indices, in a grid that is `width` wide, of the area's pixels.
    pub(crate) fn pixels(&self, width: usize) -> impl Iterator<Item = usize> + use<> {
        let columns = self.columns.clone();
        self.rows.clone().flat_map(move |y| columns.clone().map(move |x| y * width + x))
    }

    /// Index within the area of a pixel of a grid that is `width` wide.
    pub(crate) fn index_of(&self, p: usize, width: usize) -> usize {
        (p / width - self.rows.start) * self.width() + p % width - self.columns.start
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_around_pixels() {
        let area = Area::of(&[23, 14, 31], 10);
        assert_eq!(area, Area { columns: 1..5, rows: 1..4 });
        assert_eq!((area.width(), area.height(), area.index_of(23, 10)), (4, 3, 6));
        assert_eq!(area.grown(2, 10, 5), Area { columns: 0..7, rows: 0..5 });
        assert!(area.touches(&Area { columns: 5..6, rows: 0..1 }));
        assert!(!area.touches(&Area { columns: 6..7, rows: 2..3 }));
        assert_eq!(Area::of(&[], 10).width(), 0);
    }
}
