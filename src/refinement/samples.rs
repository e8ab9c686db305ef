//! Measurements in the layout of the inner loops: blocks of arrays, one per quantity.

use crate::measurements::Measurements;
use crate::order::median_f64;

/// Measurements per block. The intermediate rows of a block fit the first-level cache with up to 24 motions.
pub(crate) const BLOCK: usize = 32;

/// One number per measurement of a block.
pub(crate) type Row = [f64; BLOCK];

/// [`BLOCK`] measurements `(x, y)`, `(I_x, I_y, I_t)` and the products of coordinates that the normal equations need.
#[derive(Clone)]
pub(crate) struct Block {
    pub(crate) x: Row,
    pub(crate) y: Row,
    pub(crate) xx: Row,
    pub(crate) xy: Row,
    pub(crate) yy: Row,
    pub(crate) ix: Row,
    pub(crate) iy: Row,
    pub(crate) it: Row,
    /// 1 for a measurement, 0 for padding in the last block.
    pub(crate) present: Row,
}

const EMPTY: Block = Block {
    x: [0.0; BLOCK],
    y: [0.0; BLOCK],
    xx: [0.0; BLOCK],
    xy: [0.0; BLOCK],
    yy: [0.0; BLOCK],
    ix: [0.0; BLOCK],
    iy: [0.0; BLOCK],
    it: [0.0; BLOCK],
    present: [0.0; BLOCK],
};

/// Measurements in normalised coordinates (see [`Measurements::normalised`]), in blocks.
#[derive(Clone, Default)]
pub(crate) struct Samples {
    blocks: Vec<Block>,
    len: usize,
}

impl Samples {
    /// All of the (normalised) measurements, in order.
    pub(crate) fn new(measurements: &Measurements) -> Self {
        let mut samples = Samples::default();
        measurements.iter().for_each(|(position, derivatives)| samples.push(position, derivatives));
        samples
    }

    /// The measurements with the given indices (each below `len`), in that order.
    pub(crate) fn subset(&self, indices: impl Iterator<Item = usize>) -> Self {
        let mut samples = Samples::default();
        for j in indices {
            let (block, lane) = (&self.blocks[j / BLOCK], j % BLOCK);
            samples.push([block.x[lane], block.y[lane]], [block.ix[lane], block.iy[lane], block.it[lane]]);
        }
        samples
    }

    fn push(&mut self, [x, y]: [f64; 2], [ix, iy, it]: [f64; 3]) {
        let lane = self.len % BLOCK;
        if lane == 0 {
            self.blocks.push(EMPTY);
        }
        self.len += 1;
        if let Some(block) = self.blocks.last_mut() {
            (block.x[lane], block.y[lane]) = (x, y);
            (block.xx[lane], block.xy[lane], block.yy[lane]) = (x * x, x * y, y * y);
            (block.ix[lane], block.iy[lane], block.it[lane]) = (ix, iy, it);
            block.present[lane] = 1.0;
        }
    }

    /// Number of measurements.
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Position of measurement `j < len`.
    pub(crate) fn position(&self, j: usize) -> [f64; 2] {
        let (block, lane) = (&self.blocks[j / BLOCK], j % BLOCK);
        [block.x[lane], block.y[lane]]
    }

    /// The blocks. The last one is padded with zeros.
    pub(crate) fn blocks(&self) -> &[Block] {
        &self.blocks
    }

    /// Number of measurements in block `b`.
    pub(crate) fn filled(&self, b: usize) -> usize {
        (self.len - b * BLOCK).min(BLOCK)
    }

    /// Median of the normal flow `|I_t| / |(I_x, I_y)|`, an estimate of the typical displacement.
    pub(crate) fn typical_flow(&self) -> f64 {
        let mut flows = Vec::with_capacity(self.len);
        for (b, block) in self.blocks.iter().enumerate() {
            for j in 0..self.filled(b) {
                let gradient = (block.ix[j] * block.ix[j] + block.iy[j] * block.iy[j] + 1e-12).sqrt();
                flows.push(block.it[j].abs() / gradient);
            }
        }
        median_f64(&flows).unwrap_or(0.0)
    }
}
