//! Inner loops of the QR decomposition: dot products and updates of contiguous columns.
//!
//! The compiler does not reorder floating-point sums, so a plain loop does one addition at a time. Here each sum has two lanes (the width
//! of SSE2 and of WebAssembly's SIMD), and several columns are processed together, so that each value loaded is used in several
//! products. The order of the additions is fixed, which fixes the bits of the result.

use crate::lanes::each_with;

/// The two lanes of a 128-bit register.
type Pair = [f64; 2];

#[inline(always)]
fn multiply_add(sum: Pair, a: Pair, b: Pair) -> Pair {
    [sum[0] + a[0] * b[0], sum[1] + a[1] * b[1]]
}

/// aᵀb over the common length, in eight lanes. Never inlined, like [`add_multiple`], to keep the module small: it has many callers.
#[inline(never)]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let length = a.len().min(b.len());
    let (a, a_rest) = a[..length].as_chunks::<8>();
    let (b, b_rest) = b[..length].as_chunks::<8>();
    let mut lanes = [0.0; 8];
    for (p, q) in a.iter().zip(b) {
        for k in 0..8 {
            lanes[k] += p[k] * q[k];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(p, q)| p * q).sum();
    let [s, t, u, v] = [0, 1, 2, 3].map(|k| lanes[k] + lanes[k + 4]);
    (s + u) + (t + v) + rest
}

/// y ← y + factor·x over the common length.
#[inline(never)]
pub(crate) fn add_multiple(y: &mut [f64], factor: f64, x: &[f64]) {
    each_with(y, [x], |y, [x]| y + factor * x);
}

/// Scales a vector to unit length. Returns false, and leaves `vector` unspecified, if it is zero or not finite.
pub(crate) fn normalise(vector: &mut [f64]) -> bool {
    let largest = vector.iter().fold(0.0, |m: f64, v| if v.is_finite() { m.max(v.abs()) } else { f64::INFINITY });
    if !(largest > 0.0 && largest.is_finite()) {
        return false;
    }
    // Divide by the largest entry first: squares of large entries would overflow.
    vector.iter_mut().for_each(|v| *v /= largest);
    let length = dot(vector, vector).sqrt();
    vector.iter_mut().for_each(|v| *v /= length);
    true
}

/// |a − (aᵀb) b|², the squared sine of the angle between two unit vectors.
pub(crate) fn squared_sine(a: &[f64], b: &[f64]) -> f64 {
    let same = dot(a, b);
    a.iter().zip(b).map(|(a, b)| (a - same * b) * (a - same * b)).sum()
}

/// The eight dot products of four columns `v` with two columns `b`, all of one even length: `result[i][j] = v_iᵀ b_j`.
#[inline(always)]
pub(super) fn dot_four_by_two(v: [&[Pair]; 4], b: [&[Pair]; 2]) -> [[f64; 2]; 4] {
    let length = v[0].len();
    let v = v.map(|column| &column[..length]);
    let b = b.map(|column| &column[..length]);
    let mut sums = [[[0.0; 2]; 2]; 4];
    for r in 0..length {
        let (p, q) = (b[0][r], b[1][r]);
        for i in 0..4 {
            sums[i][0] = multiply_add(sums[i][0], v[i][r], p);
            sums[i][1] = multiply_add(sums[i][1], v[i][r], q);
        }
    }
    sums.map(|row| row.map(|lanes| lanes[0] + lanes[1]))
}

/// `b_j ← b_j − Σ_i w[i][j] v_i` for four columns `v` and two columns `b` of one even length.
#[inline(always)]
pub(super) fn subtract_four_by_two(b: [&mut [Pair]; 2], v: [&[Pair]; 4], w: [[f64; 2]; 4]) {
    let length = v[0].len();
    let v = v.map(|column| &column[..length]);
    let [p, q] = b;
    let (p, q) = (&mut p[..length], &mut q[..length]);
    let w = w.map(|row| row.map(|x| [-x; 2]));
    for r in 0..length {
        let (mut s, mut t) = (p[r], q[r]);
        for i in 0..4 {
            s = multiply_add(s, v[i][r], w[i][0]);
            t = multiply_add(t, v[i][r], w[i][1]);
        }
        p[r] = s;
        q[r] = t;
    }
}
