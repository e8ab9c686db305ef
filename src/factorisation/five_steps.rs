//! The paper's factorisation of the multibody motion in five steps (end of section 3.3), to the letter.
//!
//! **Limits.** Step 5 is ambiguous if the (1,3) or the (2,3) entries of two motions are equal, as the paper says. Steps 3 and 4 are also
//! undefined if a motion has a zero row (a static background) or no linear part (a translation).
//! [`differentiation`](super::differentiation) covers these cases.

use super::assignment::assign;
use super::ternary::factorise;
use crate::embedding::MultibodyMotion;
use crate::motion::AffineMotion;

type Vector = [f64; 3];

const E3: Vector = [0.0, 0.0, 1.0];

/// Bound of the absolute entries, which may come from a division by almost zero.
const LARGEST: f64 = 1e6;

/// The motions A_1 … A_n of a multibody motion by the paper's five steps.
///
/// All entries are finite; those that the steps do not determine are 0. The steps do not determine motions with equal (1,3) or (2,3)
/// entries, with a zero row or without a linear part; use [`differentiation`](super::differentiation) for these. For generic motions
/// without noise and n ≤ 4, the error is about 10⁻¹⁰.
///
/// ```
/// use veronese::AffineMotion;
/// use veronese::embedding::MultibodyMotion;
/// use veronese::factorisation::five_steps;
///
/// let truth = [
///     AffineMotion::new([0.1, -0.2, 0.5, 0.2, 0.1, -0.3]),
///     AffineMotion::new([-0.3, 0.4, -0.4, 0.1, 0.2, 0.6]),
/// ];
/// let found = five_steps(&MultibodyMotion::from_motions(&truth));
/// assert!(truth.iter().all(|motion| found.iter().any(|a| motion.relative_error(a) < 1e-9)));
/// ```
pub fn five_steps(multibody: &MultibodyMotion) -> Vec<AffineMotion> {
    let n = multibody.degree();
    // Step 1: the third rows are (0, 0, 1).
    let translations = third_columns(multibody);
    let rows = [0, 1].map(|j| associated(&scaled_rows(multibody, j), &translations, j));
    (0..n)
        .map(|i| {
            let [first, second] = [rows[0][i], rows[1][i]];
            AffineMotion::new([first[0], first[1], first[2], second[0], second[1], second[2]].map(tamed))
        })
        .collect()
}

/// Step 2: the third columns of the A_i, by factoring 𝒜 ν_n(e_3), the last column.
#[doc(hidden)]
pub fn third_columns(multibody: &MultibodyMotion) -> Vec<Vector> {
    let n = multibody.degree();
    let factors = factorise(multibody.multibody_flow(E3).as_slice(), n).unwrap_or_else(|| vec![E3; n]);
    factors.iter().map(|b| [b[0] / b[2], b[1] / b[2], 1.0].map(tamed)).collect()
}

/// Steps 3 and 4: row j of all A_i with their scales, in no particular order.
fn scaled_rows(multibody: &MultibodyMotion, j: usize) -> Vec<Vector> {
    let n = multibody.degree();
    let mut e = [0.0; 3];
    e[j] = 1.0;
    let mut e_plus = E3;
    e_plus[j] = 1.0;
    // Step 3: ã, up to scale, from row 1 or row M_n − n of 𝒜.
    let rows = factorise(multibody.multibody_row(e).as_slice(), n);
    // Step 4: c̃, up to scale, each coplanar with its ã and e_3 (16).
    let sums = factorise(multibody.multibody_row(e_plus).as_slice(), n);
    let (Some(rows), Some(sums)) = (rows, sums) else {
        return vec![[0.0; 3]; n];
    };
    let rows: Vec<Vector> = rows.into_iter().map(unit).collect();
    let sums: Vec<Vector> = sums.into_iter().map(unit).collect();
    let costs: Vec<Vec<f64>> = rows.iter().map(|a| sums.iter().map(|c| out_of_plane(c, a)).collect()).collect();
    let partner = assign(&costs);
    rows.iter()
        .zip(partner)
        .map(|(a, k)| {
            let scale = row_scale(&sums[k], a);
            a.map(|value| tamed(scale * value))
        })
        .collect()
}

/// The scale λ of (17) for which λ ã + e_3 is parallel to c̃.
fn row_scale(c: &Vector, a: &Vector) -> f64 {
    let (ca, ce) = (cross(c, a), cross(c, &E3));
    -dot(&ca, &ce) / dot(&ca, &ca).max(f64::MIN_POSITIVE)
}

/// |c̃ᵀ[e_3]_× ã| for vectors scaled to unit length orthogonally to e_3: the sine of the angle between the vectors of their first two
/// entries, 0 if c̃, ã and e_3 are coplanar.
fn out_of_plane(c: &Vector, a: &Vector) -> f64 {
    let lengths = ((c[0] * c[0] + c[1] * c[1]) * (a[0] * a[0] + a[1] * a[1])).sqrt();
    dot(c, &cross(&E3, a)).abs() / lengths.max(f64::MIN_POSITIVE)
}

/// Step 5: the rows in the order of the third columns. The third entry of row j must equal entry j of the column.
fn associated(rows: &[Vector], translations: &[Vector], j: usize) -> Vec<Vector> {
    let costs: Vec<Vec<f64>> =
        translations.iter().map(|t| rows.iter().map(|row| (row[2] - t[j]).abs()).collect()).collect();
    assign(&costs).into_iter().map(|k| rows[k]).collect()
}

/// The value cut to ±[`LARGEST`]; 0 for NaN.
fn tamed(value: f64) -> f64 {
    if value.is_nan() { 0.0 } else { value.clamp(-LARGEST, LARGEST) }
}

fn unit(v: Vector) -> Vector {
    let length = dot(&v, &v).sqrt();
    if length > 0.0 { v.map(|value| value / length) } else { v }
}

fn dot(a: &Vector, b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
