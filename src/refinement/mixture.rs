//! The likelihood of n motions and a class of outliers, and its maximisation by expectation-maximisation.
//!
//! Model: the noise is equal on all three derivatives, so the distance of a measurement `y` to the plane of its motion,
//! `d_i = yᵀ A_i x / |A_i x|` (the residual of eq. 5 over `√(u² + v² + 1)`), is normal with deviation σ. An outlier's `y` has any
//! direction; the distance of such a vector of length 1 to a plane is uniform in [−1, 1] (Archimedes), density ½. Hence
//!
//! `p(y_j | x_j) = Σ_i π_i N(d_ij; 0, σ²) + π_0 / 2`.
//!
//! One iteration computes every measurement's share in every motion, then one Gauss-Newton step per motion on
//! `Σ_j w_ij d_ij²` with the exact gradient of d (not that of the residual alone: that one is biased), and new π and σ.
//!
//! Pitfalls. (1) Measurements go by in blocks of fixed arrays and every sum has four explicit lanes: the order of additions is part
//! of the result, and it is what lets the compiler use vector instructions. (2) σ starts wide when motions start at random: a narrow start
//! freezes the first assignment. (3) The sum of squares after a step is predicted from the quadratic model, which saves
//! one pass over the data per iteration; near convergence the prediction is exact.

use super::exponential::power_of_two;
use super::samples::{BLOCK, Block, Row, Samples};
use super::symmetric::{Matrix6, cholesky, quadratic_form, solve};

/// Density of an outlier's distance, for derivatives of unit length.
pub(crate) const OUTLIER_DENSITY: f64 = 0.5;
/// No share falls below this: it keeps every logarithm finite.
const LEAST_SHARE: f64 = 1e-6;
/// Share of outliers assumed at the start.
const FIRST_OUTLIERS: f64 = 0.05;
/// The noise that is never undercut, in units of the derivatives' root mean square.
pub(crate) const LEAST_SIGMA: f64 = 1e-9;
/// The longest step of one entry in one iteration, in normalised coordinates.
const LONGEST_STEP: f64 = 1.0;
/// Independent partial sums.
const LANES: usize = 4;
/// How many densities are multiplied before one logarithm is taken: each is between 10⁻⁷ and 10¹⁰.
const FACTORS: usize = 16;

/// n motions in normalised coordinates, their shares, the outliers' share, the noise, and how likely all that is.
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

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stop {
    /// Largest number of iterations.
    pub(crate) iterations: usize,
    /// Change of the mean log-likelihood, relative to it, below which …
    pub(crate) gain: f64,
    /// … and longest step below which the iteration has converged.
    pub(crate) step: f64,
}

impl Mixture {
    /// Motions with equal shares and a given noise.
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

    /// The motion of every measurement: the most probable one, or `None` for an outlier; ties go to the first.
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

    /// The density of motion i at distance 0.
    fn peak(&self, i: usize) -> f64 {
        self.shares[i] / (self.sigma * 2.506_628_274_631_000_5) // √(2π)
    }

    /// What the squared distance is multiplied with in the exponent to base 2.
    fn exponent(&self) -> f64 {
        -0.5 * std::f64::consts::LOG2_E / (self.sigma * self.sigma)
    }
}

/// What one pass knows about one block: a row per motion of everything.
#[derive(Default)]
struct Scratch {
    distance: Vec<Row>,
    /// Derivative of the distance by the flow's first and second component.
    by_u: Vec<Row>,
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

/// Lanes of a sum.
type Sum = [f64; LANES];

/// The weighted sums of one motion over all measurements.
///
/// The gradient of d by the six entries is `(g_u·(x, y, 1), g_v·(x, y, 1))`, so the normal matrix consists of the three 3×3
/// matrices `Σ w g_u² X`, `Σ w g_u g_v X`, `Σ w g_v² X` with `X = (x, y, 1)ᵀ(x, y, 1)`: 18 different sums, not 21.
#[derive(Clone, Copy, Default)]
struct Sums {
    uu: [Sum; 6],
    uv: [Sum; 6],
    vv: [Sum; 6],
    gradient: [Sum; 6],
    weight: Sum,
    squares: Sum,
}

/// The normal equations of one motion, summed up.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Normal {
    /// `Σ w J Jᵀ`.
    pub(crate) matrix: Matrix6,
    /// `Σ w J d`.
    pub(crate) gradient: [f64; 6],
    /// `Σ w`.
    pub(crate) weight: f64,
    /// `Σ w d²`.
    pub(crate) squares: f64,
}

/// The buffers of the iteration, kept between calls.
#[derive(Default)]
pub(crate) struct EmBuffers {
    scratch: Scratch,
    factors: Factors,
    sums: Vec<Sums>,
}

impl EmBuffers {
    /// Maximises the likelihood from `start` on. The returned likelihood is that of the last completed pass.
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

    /// The likelihood of `mixture` as it is, and the normal equations of its motions.
    pub(crate) fn evaluate(&mut self, samples: &Samples, mixture: &mut Mixture) -> Vec<Normal> {
        self.pass(samples, mixture);
        self.sums.iter().map(Sums::total).collect()
    }

    /// One pass over the data: fills the sums, sets the likelihood, returns the outliers' total weight.
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

    /// One Gauss-Newton step per motion, new shares and noise. Returns the longest change of an entry.
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
    /// The Gauss-Newton step, bounded, and the sum of squares that the quadratic model promises after it.
    fn step(&self) -> ([f64; 6], f64) {
        let right: [f64; 6] = std::array::from_fn(|k| -self.gradient[k]);
        let mut step = solve(&cholesky(&self.ridged()), &right);
        let longest = step.iter().fold(0.0_f64, |a, s| a.max(s.abs()));
        if longest > LONGEST_STEP {
            step.iter_mut().for_each(|s| *s *= LONGEST_STEP / longest);
        }
        let slope: f64 = (0..6).map(|k| self.gradient[k] * step[k]).sum();
        let left = self.squares + 2.0 * slope + quadratic_form(&self.matrix, &step);
        // The model is not to be trusted with more than two digits at once.
        (step, left.max(1e-4 * self.squares))
    }

    /// The normal matrix with what makes it positive definite whatever the data.
    pub(crate) fn ridged(&self) -> Matrix6 {
        let mut matrix = self.matrix;
        let trace: f64 = (0..6).map(|k| matrix[k][k]).sum();
        for (k, row) in matrix.iter_mut().enumerate() {
            row[k] += 1e-9 * trace / 6.0 + 1e-12;
        }
        matrix
    }
}

/// What the coordinates of each measurement of a block are multiplied with in the sums of one motion.
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
    /// `inverse[j]` is what turns the densities of measurement j into weights.
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

/// The first `length` entries of a row, by lanes. A length that the compiler does not know keeps it from unrolling the loops over
/// a whole block, for which there are not enough registers.
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
        // Where in the six sums (xx, xy, x, yy, y, 1) the entry (row, column) of a 3×3 part is.
        const PLACE: [[usize; 3]; 3] = [[0, 1, 2], [1, 3, 4], [2, 4, 5]];
        let mut matrix = [[0.0; 6]; 6];
        for r in 0..3 {
            for c in 0..3 {
                let place = PLACE[r][c];
                matrix[r][c] = uu[place];
                matrix[r][c + 3] = uv[place];
                matrix[r + 3][c] = uv[place];
                matrix[r + 3][c + 3] = vv[place];
            }
        }
        Normal {
            matrix,
            gradient: self.gradient.map(|sum| add_up(&sum)),
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

/// The flow at measurement j of a block, `1/√(u² + v² + 1)`, and its distance to the motion.
#[inline(always)]
fn distance(block: &Block, a: &[f64; 6], j: usize) -> ([f64; 2], f64, f64) {
    let (x, y) = (block.x[j], block.y[j]);
    let u = a[0] * x + a[1] * y + a[2];
    let v = a[3] * x + a[4] * y + a[5];
    let r = block.ix[j] * u + block.iy[j] * v + block.it[j];
    let shrink = 1.0 / (u * u + v * v + 1.0).sqrt();
    ([u, v], shrink, r * shrink)
}

/// Distances of a block's measurements to a motion.
fn distances(block: &Block, a: &[f64; 6]) -> Row {
    std::array::from_fn(|j| distance(block, a, j).2)
}

/// The same, and their derivatives by the flow.
fn gradients(block: &Block, a: &[f64; 6], out: &mut Row, by_u: &mut Row, by_v: &mut Row) {
    for j in 0..BLOCK {
        let ([u, v], shrink, d) = distance(block, a, j);
        let along = d * shrink;
        out[j] = d;
        by_u[j] = (block.ix[j] - along * u) * shrink;
        by_v[j] = (block.iy[j] - along * v) * shrink;
    }
}

/// The smallest absolute distance of every measurement to any of the motions.
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

/// For each motion the absolute distances of the measurements that are nearest to it.
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

/// Appends the squared distances of all measurements to one motion, cut at `cap²`; single precision is enough to compare by.
pub(crate) fn capped_squares(samples: &Samples, motion: &[f64; 6], cap: f64, out: &mut Vec<f32>) {
    let most = cap * cap;
    for (b, block) in samples.blocks().iter().enumerate() {
        out.extend(distances(block, motion)[..samples.filled(b)].iter().map(|d| smaller(most, d * d) as f32));
    }
}

/// The smaller of two numbers: one instruction, other than `min`, which asks whether one is NaN.
#[inline(always)]
fn smaller(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}
