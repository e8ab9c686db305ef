//! The likelihood of a mixture of n motions and a class of outliers, and its maximisation by expectation-maximisation.
//!
//! Model: the noise has the same variance on all three derivatives, so the distance of a measurement `y` from the plane of its motion,
//! `d_i = yᵀ A_i x / |A_i x|` (the residual of eq. 5 divided by `√(u² + v² + 1)`), is normal with standard deviation σ. The `y` of an
//! outlier has a uniform direction; for unit length, its distance from a plane is uniform in [−1, 1] (Archimedes), with density ½:
//!
//! `p(y_j | x_j) = Σ_i π_i N(d_ij; 0, σ²) + π_0 / 2`.
//!
//! An iteration computes the weights w_ij of all measurements, makes one Gauss-Newton step per motion on `Σ_j w_ij d_ij²`, and updates π
//! and σ. The gradient is that of d; the gradient of the residual alone would give biased motions.
//!
//! **Pitfalls.** (1) Measurements are processed in blocks of fixed size, and every sum has four explicit lanes. The order of additions
//! determines the bits of the result, and it lets the compiler use vector instructions. (2) With random motions, σ must start large: a
//! small σ freezes the first assignment. (3) The sum of squares after a step is predicted from the quadratic model, which saves a pass
//! over the data per iteration. Near convergence the prediction is exact.

use nalgebra::{Cholesky, Const, Matrix6, Vector6};

use super::samples::{BLOCK, Block, Row, Samples};
use crate::exponential::power_of_two;

/// Density of an outlier's distance, for derivatives of unit length.
pub(crate) const OUTLIER_DENSITY: f64 = 0.5;
/// Lower bound of all shares, which keeps logarithms finite.
const LEAST_SHARE: f64 = 1e-6;
/// Initial share of outliers.
const FIRST_OUTLIERS: f64 = 0.05;
/// Lower bound of σ, in units of the root mean square length of the derivatives.
pub(crate) const LEAST_SIGMA: f64 = 1e-9;
/// Largest change of an entry in one iteration, in normalised coordinates.
const LONGEST_STEP: f64 = 1.0;
/// Number of independent partial sums.
const LANES: usize = 4;
/// Number of densities that are multiplied before a logarithm is taken. Each is between 10⁻⁷ and 10¹⁰.
const FACTORS: usize = 16;

/// n motions in normalised coordinates, their shares, the share of outliers, σ, and the likelihood.
#[derive(Clone, Debug)]
pub(crate) struct Mixture {
    pub(crate) motions: Vec<[f64; 6]>,
    /// Shares π_i of the motions.
    pub(crate) shares: Vec<f64>,
    /// Share π_0 of the outliers.
    pub(crate) outliers: f64,
    /// Standard deviation of the distances.
    pub(crate) sigma: f64,
    /// Natural logarithm of the likelihood of all measurements.
    pub(crate) log_likelihood: f64,
}

/// When to stop. The iteration has converged if both changes are below their bounds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stop {
    /// Maximum number of iterations.
    pub(crate) iterations: usize,
    /// Bound of the relative change of the mean log-likelihood.
    pub(crate) gain: f64,
    /// Bound of the largest change of an entry.
    pub(crate) step: f64,
}

impl Mixture {
    /// Motions with equal shares and the given σ.
    pub(crate) fn new(motions: Vec<[f64; 6]>, sigma: f64) -> Self {
        let shares = vec![(1.0 - FIRST_OUTLIERS) / motions.len().max(1) as f64; motions.len()];
        Mixture {
            motions,
            shares,
            outliers: FIRST_OUTLIERS,
            sigma: sigma.max(LEAST_SIGMA),
            log_likelihood: f64::NEG_INFINITY,
        }
    }

    /// The most probable motion of every measurement, or `None` for an outlier; ties go to the first.
    pub(crate) fn labels(&self, samples: &Samples) -> Vec<Option<usize>> {
        let mut labels = Vec::with_capacity(samples.len());
        let mut scratch = Scratch::default();
        for (b, block) in samples.blocks().iter().enumerate() {
            let mut best = [self.outliers * OUTLIER_DENSITY; BLOCK];
            let mut label = [None; BLOCK];
            scratch.fill(block, self);
            for (i, densities) in scratch.density.iter().enumerate() {
                for j in 0..BLOCK {
                    if densities[j] > best[j] {
                        best[j] = densities[j];
                        label[j] = Some(i);
                    }
                }
            }
            labels.extend_from_slice(&label[..samples.filled(b)]);
        }
        labels
    }

    /// The density π_i N(0; 0, σ²) of motion i at distance 0.
    fn peak(&self, i: usize) -> f64 {
        self.shares[i] / (self.sigma * 2.506_628_274_631_000_5) // √(2π)
    }

    /// The factor of the squared distance in the exponent to base 2.
    fn exponent(&self) -> f64 {
        -0.5 * std::f64::consts::LOG2_E / (self.sigma * self.sigma)
    }
}

/// Intermediate values of a pass for one block, a row per motion.
#[derive(Default)]
struct Scratch {
    distance: Vec<Row>,
    /// Derivative of the distance with respect to the first component of the flow.
    by_u: Vec<Row>,
    /// Derivative of the distance with respect to the second component of the flow.
    by_v: Vec<Row>,
    density: Vec<Row>,
}

impl Scratch {
    fn fill(&mut self, block: &Block, mixture: &Mixture) {
        for rows in [&mut self.distance, &mut self.by_u, &mut self.by_v, &mut self.density] {
            rows.resize(mixture.motions.len(), [0.0; BLOCK]);
        }
        for (i, motion) in mixture.motions.iter().enumerate() {
            gradients(block, motion, &mut self.distance[i], &mut self.by_u[i], &mut self.by_v[i]);
        }
        let exponent = mixture.exponent();
        for (i, (density, distance)) in self.density.iter_mut().zip(&self.distance).enumerate() {
            let peak = mixture.peak(i);
            for j in 0..BLOCK {
                density[j] = power_of_two(exponent * distance[j] * distance[j]) * peak;
            }
        }
    }
}

/// The lanes of a sum.
type Sum = [f64; LANES];

/// The weighted sums of one motion over all measurements.
///
/// The gradient of d with respect to the six entries is `(g_u·(x, y, 1), g_v·(x, y, 1))`, so the normal matrix consists of the 3 × 3
/// matrices `Σ w g_u² X`, `Σ w g_u g_v X`, `Σ w g_v² X` with `X = (x, y, 1)ᵀ(x, y, 1)`. They have 18 different entries.
#[derive(Clone, Copy, Default)]
struct Sums {
    uu: [Sum; 6],
    uv: [Sum; 6],
    vv: [Sum; 6],
    gradient: [Sum; 6],
    weight: Sum,
    squares: Sum,
}

/// The normal equations of one motion. J is the gradient of d with respect to the six entries.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Normal {
    /// `Σ w J Jᵀ`.
    pub(crate) matrix: Matrix6<f64>,
    /// `Σ w J d`.
    pub(crate) gradient: Vector6<f64>,
    /// `Σ w`.
    pub(crate) weight: f64,
    /// `Σ w d²`.
    pub(crate) squares: f64,
}

/// The buffers of the iteration, reused between calls.
#[derive(Default)]
pub(crate) struct EmBuffers {
    scratch: Scratch,
    factors: Factors,
    sums: Vec<Sums>,
}

impl EmBuffers {
    /// Maximises the likelihood, starting from `mixture`. The returned likelihood is that before the last step.
    pub(crate) fn maximise(&mut self, samples: &Samples, mut mixture: Mixture, stop: Stop) -> Mixture {
        let mut previous = f64::NEG_INFINITY;
        let count = samples.len().max(1) as f64;
        for _ in 0..stop.iterations {
            let outlier_weight = self.pass(samples, &mut mixture);
            let step = self.step(count, outlier_weight, &mut mixture);
            let mean = mixture.log_likelihood / count;
            if mean - previous < stop.gain * mean.abs().max(1.0) && step < stop.step {
                break;
            }
            previous = mean;
        }
        mixture
    }

    /// Updates the likelihood of `mixture`; returns the normal equations of its motions.
    pub(crate) fn evaluate(&mut self, samples: &Samples, mixture: &mut Mixture) -> Vec<Normal> {
        self.pass(samples, mixture);
        self.sums.iter().map(Sums::total).collect()
    }

    /// A pass over the data: fills the sums, sets the likelihood, and returns the total weight of the outliers.
    fn pass(&mut self, samples: &Samples, mixture: &mut Mixture) -> f64 {
        self.sums.clear();
        self.sums.resize(mixture.motions.len(), Sums::default());
        let background = mixture.outliers * OUTLIER_DENSITY;
        let mut outlier_weight = [0.0; LANES];
        let mut log_likelihood = 0.0;
        for (b, block) in samples.blocks().iter().enumerate() {
            self.scratch.fill(block, mixture);
            let mut total = [background; BLOCK];
            for densities in &self.scratch.density {
                total.iter_mut().zip(densities).for_each(|(t, density)| *t += density);
            }
            let filled = samples.filled(b);
            for part in total[..filled].chunks(FACTORS) {
                log_likelihood += libm::log(part.iter().product());
            }
            for (t, present) in total.iter_mut().zip(&block.present) {
                *t = present / *t;
            }
            for lanes in total.as_chunks::<LANES>().0 {
                for l in 0..LANES {
                    outlier_weight[l] += background * lanes[l];
                }
            }
            let lanes = filled.next_multiple_of(LANES);
            for (i, sums) in self.sums.iter_mut().enumerate() {
                self.factors.fill(&self.scratch, i, &total);
                sums.add(block, &self.factors, lanes);
            }
        }
        mixture.log_likelihood = log_likelihood;
        add_up(&outlier_weight)
    }

    /// Makes a Gauss-Newton step per motion and updates shares and σ. Returns the largest change of an entry.
    fn step(&self, count: f64, outlier_weight: f64, mixture: &mut Mixture) -> f64 {
        let (mut longest, mut squares, mut weight) = (0.0_f64, 0.0, 0.0);
        mixture.outliers = (outlier_weight / count).max(LEAST_SHARE);
        for (i, sums) in self.sums.iter().enumerate() {
            let normal = sums.total();
            let (step, left) = normal.step();
            for k in 0..6 {
                mixture.motions[i][k] += step[k];
                longest = longest.max(step[k].abs());
            }
            mixture.shares[i] = (normal.weight / count).max(LEAST_SHARE);
            squares += left;
            weight += normal.weight;
        }
        mixture.sigma = (squares / weight.max(1e-9)).sqrt().max(LEAST_SIGMA);
        longest
    }
}

impl Normal {
    /// The Gauss-Newton step, bounded by [`LONGEST_STEP`], and the sum of squares after it as predicted by the quadratic model.
    fn step(&self) -> (Vector6<f64>, f64) {
        let mut step = cholesky(self.ridged()).solve(&-self.gradient);
        let longest = step.amax();
        if longest > LONGEST_STEP {
            step *= LONGEST_STEP / longest;
        }
        let left = self.squares + 2.0 * self.gradient.dot(&step) + step.dot(&(self.matrix * step));
        // The prediction is not accurate enough for a reduction of d by more than two digits.
        (step, left.max(1e-4 * self.squares))
    }

    /// The normal matrix with a ridge that makes it positive definite for all data.
    pub(crate) fn ridged(&self) -> Matrix6<f64> {
        let mut matrix = self.matrix;
        let ridge = 1e-9 * matrix.trace() / 6.0 + 1e-12;
        (0..6).for_each(|k| matrix[(k, k)] += ridge);
        matrix
    }
}

/// The Cholesky decomposition of a symmetric matrix. Pivots are raised to the smallest positive number, so that there always is one.
#[inline(never)]
pub(crate) fn cholesky(mut matrix: Matrix6<f64>) -> Cholesky<f64, Const<6>> {
    for j in 0..6 {
        for k in 0..j {
            let factor = matrix[(j, k)];
            for i in j..6 {
                matrix[(i, j)] -= factor * matrix[(i, k)];
            }
        }
        let root = matrix[(j, j)].max(f64::MIN_POSITIVE).sqrt();
        matrix[(j, j)] = root;
        for i in j + 1..6 {
            matrix[(i, j)] /= root;
        }
    }
    Cholesky::pack_dirty(matrix)
}

/// The factors of the coordinates of a block's measurements in the sums of one motion.
struct Factors {
    uu: Row,
    uv: Row,
    vv: Row,
    du: Row,
    dv: Row,
    weight: Row,
    squares: Row,
}

impl Default for Factors {
    fn default() -> Self {
        let [uu, uv, vv, du, dv, weight, squares] = [[0.0; BLOCK]; 7];
        Factors { uu, uv, vv, du, dv, weight, squares }
    }
}

impl Factors {
    /// `inverse[j]` is the factor that converts densities of measurement j into weights.
    fn fill(&mut self, scratch: &Scratch, i: usize, inverse: &Row) {
        let [density, by_u, by_v, distance] =
            [&scratch.density, &scratch.by_u, &scratch.by_v, &scratch.distance].map(|rows| &rows[i]);
        for j in 0..BLOCK {
            let w = density[j] * inverse[j];
            let (a, b, d) = (by_u[j], by_v[j], distance[j]);
            let (wa, wb) = (w * a, w * b);
            self.uu[j] = wa * a;
            self.uv[j] = wa * b;
            self.vv[j] = wb * b;
            self.du[j] = wa * d;
            self.dv[j] = wb * d;
            self.weight[j] = w;
            self.squares[j] = w * d * d;
        }
    }
}

/// The first `length` entries of a row, in lanes. Because the length is unknown at compile time, the compiler does not unroll loops over
/// a whole block, which would need too many registers.
#[inline(always)]
fn by_lanes(row: &Row, length: usize) -> &[Sum] {
    row[..length.min(BLOCK)].as_chunks().0
}

impl Sums {
    /// Adds the first `length` measurements of a block.
    fn add(&mut self, block: &Block, factors: &Factors, length: usize) {
        add_products(&mut self.uu, &factors.uu, block, length);
        add_products(&mut self.uv, &factors.uv, block, length);
        add_products(&mut self.vv, &factors.vv, block, length);
        let (mut gradient, [mut weight, mut squares]) = (self.gradient, [self.weight, self.squares]);
        let row = |row| by_lanes(row, length).iter();
        for (((x, y), du), dv) in row(&block.x).zip(row(&block.y)).zip(row(&factors.du)).zip(row(&factors.dv)) {
            for l in 0..LANES {
                gradient[0][l] += du[l] * x[l];
                gradient[1][l] += du[l] * y[l];
                gradient[2][l] += du[l];
                gradient[3][l] += dv[l] * x[l];
                gradient[4][l] += dv[l] * y[l];
                gradient[5][l] += dv[l];
            }
        }
        for (w, s) in row(&factors.weight).zip(row(&factors.squares)) {
            for l in 0..LANES {
                weight[l] += w[l];
                squares[l] += s[l];
            }
        }
        (self.gradient, self.weight, self.squares) = (gradient, weight, squares);
    }

    fn total(&self) -> Normal {
        let [uu, uv, vv] = [&self.uu, &self.uv, &self.vv].map(|part| part.map(|sum| add_up(&sum)));
        // Index in the six sums (xx, xy, x, yy, y, 1) of the entry (row, column) of a 3 × 3 matrix.
        const PLACE: [[usize; 3]; 3] = [[0, 1, 2], [1, 3, 4], [2, 4, 5]];
        let mut matrix = Matrix6::zeros();
        for r in 0..3 {
            for c in 0..3 {
                let place = PLACE[r][c];
                matrix[(r, c)] = uu[place];
                matrix[(r, c + 3)] = uv[place];
                matrix[(r + 3, c)] = uv[place];
                matrix[(r + 3, c + 3)] = vv[place];
            }
        }
        Normal {
            matrix,
            gradient: self.gradient.map(|sum| add_up(&sum)).into(),
            weight: add_up(&self.weight),
            squares: add_up(&self.squares),
        }
    }
}

fn add_up(sum: &Sum) -> f64 {
    (sum[0] + sum[2]) + (sum[1] + sum[3])
}

/// Adds `factor·(xx, xy, x, yy, y, 1)` over the first `length` measurements of a block.
fn add_products(sums: &mut [Sum; 6], factor: &Row, block: &Block, length: usize) {
    let mut s = *sums;
    let row = |row| by_lanes(row, length).iter();
    let squares = row(&block.xx).zip(row(&block.xy)).zip(row(&block.yy));
    for (((f, x), y), ((xx, xy), yy)) in row(factor).zip(row(&block.x)).zip(row(&block.y)).zip(squares) {
        for l in 0..LANES {
            s[0][l] += f[l] * xx[l];
            s[1][l] += f[l] * xy[l];
            s[2][l] += f[l] * x[l];
            s[3][l] += f[l] * yy[l];
            s[4][l] += f[l] * y[l];
            s[5][l] += f[l];
        }
    }
    *sums = s;
}

/// The flow at measurement j of a block, `1/√(u² + v² + 1)`, and the distance of the measurement from the motion.
#[inline(always)]
fn distance(block: &Block, a: &[f64; 6], j: usize) -> ([f64; 2], f64, f64) {
    let (x, y) = (block.x[j], block.y[j]);
    let u = a[0] * x + a[1] * y + a[2];
    let v = a[3] * x + a[4] * y + a[5];
    let r = block.ix[j] * u + block.iy[j] * v + block.it[j];
    let shrink = 1.0 / (u * u + v * v + 1.0).sqrt();
    ([u, v], shrink, r * shrink)
}

/// Distances of a block's measurements from a motion.
fn distances(block: &Block, a: &[f64; 6]) -> Row {
    std::array::from_fn(|j| distance(block, a, j).2)
}

/// [`distances`], and their derivatives with respect to the flow.
fn gradients(block: &Block, a: &[f64; 6], out: &mut Row, by_u: &mut Row, by_v: &mut Row) {
    for j in 0..BLOCK {
        let ([u, v], shrink, d) = distance(block, a, j);
        let along = d * shrink;
        out[j] = d;
        by_u[j] = (block.ix[j] - along * u) * shrink;
        by_v[j] = (block.iy[j] - along * v) * shrink;
    }
}

/// The absolute distance of every measurement from its nearest motion.
pub(crate) fn nearest_distances(samples: &Samples, motions: &[[f64; 6]]) -> Vec<f64> {
    let mut nearest = Vec::with_capacity(samples.len());
    for (b, block) in samples.blocks().iter().enumerate() {
        let mut least = [f64::INFINITY; BLOCK];
        for motion in motions {
            for (least, d) in least.iter_mut().zip(distances(block, motion)) {
                *least = smaller(*least, d.abs());
            }
        }
        nearest.extend_from_slice(&least[..samples.filled(b)]);
    }
    nearest
}

/// For each motion, the absolute distances of the measurements to which it is the nearest.
pub(crate) fn own_distances(samples: &Samples, motions: &[[f64; 6]]) -> Vec<Vec<f64>> {
    let mut own = vec![Vec::new(); motions.len()];
    for (b, block) in samples.blocks().iter().enumerate() {
        let mut least = [f64::INFINITY; BLOCK];
        let mut nearest = [0; BLOCK];
        for (i, motion) in motions.iter().enumerate() {
            let distance = distances(block, motion);
            for j in 0..BLOCK {
                let d = distance[j].abs();
                if d < least[j] {
                    (least[j], nearest[j]) = (d, i);
                }
            }
        }
        for j in 0..samples.filled(b) {
            own[nearest[j]].push(least[j]);
        }
    }
    own
}

/// Appends the squared distances of all measurements from one motion, at most `cap²`. Single precision is enough for comparisons.
pub(crate) fn capped_squares(samples: &Samples, motion: &[f64; 6], cap: f64, out: &mut Vec<f32>) {
    let most = cap * cap;
    for (b, block) in samples.blocks().iter().enumerate() {
        out.extend(distances(block, motion)[..samples.filled(b)].iter().map(|d| smaller(most, d * d) as f32));
    }
}

/// The smaller of two numbers in one instruction; `f64::min` would also handle NaN.
#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}
