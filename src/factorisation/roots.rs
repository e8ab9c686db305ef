//! All roots of a real polynomial in one variable by the Ehrlich–Aberth iteration (Aberth, Mathematics of Computation 27, 1973).

use nalgebra::Complex;

use crate::order::sort_few;

/// Maximum number of iterations. Polynomials of degree 10 typically need 10 to 20.
const MAX_STEPS: usize = 100;
/// Leading and trailing coefficients below this share of the largest count as zero: their roots are at infinity or at zero.
const NEGLIGIBLE: f64 = 1e-15;
/// A root has converged when its correction is below this share of its absolute value.
const SETTLED: f64 = 4.0 * f64::EPSILON;
/// A root is real if its imaginary part is below this share of its absolute value.
const COMPLEX: f64 = 1e-7;

/// The roots of a polynomial, counted with multiplicity.
#[non_exhaustive]
#[derive(Clone, Debug, PartialEq)]
pub struct Roots {
    /// The finite roots: real, or in exactly conjugate pairs.
    pub finite: Vec<Complex<f64>>,
    /// Number of roots at infinity, which is the number of vanishing leading coefficients.
    pub infinite: usize,
}

/// The roots of `c[0] + c[1] t + … + c[n] tⁿ`.
///
/// Coefficients that are not finite, or all zero, give no finite roots and n infinite ones. Multiple roots have the accuracy that
/// rounding permits, about ε^(1/multiplicity). The iteration ends after at most 100 steps.
///
/// ```
/// use veronese::factorisation::roots::roots;
///
/// let found = roots(&[6.0, -5.0, 1.0, 0.0]); // 6 − 5t + t² + 0t³
/// let mut real: Vec<f64> = found.finite.iter().map(|root| root.re).collect();
/// real.sort_by(f64::total_cmp);
/// assert!((real[0] - 2.0).abs() < 1e-14 && (real[1] - 3.0).abs() < 1e-14);
/// assert_eq!(found.infinite, 1);
/// ```
pub fn roots(coefficients: &[f64]) -> Roots {
    let degree = coefficients.len().saturating_sub(1);
    let largest = coefficients.iter().fold(0.0, |m: f64, c| if c.is_finite() { m.max(c.abs()) } else { f64::INFINITY });
    let significant = |c: &f64| c.abs() > NEGLIGIBLE * largest;
    let bounds = (coefficients.iter().position(significant), coefficients.iter().rposition(significant));
    let (Some(low), Some(high)) = bounds else {
        return Roots { finite: Vec::new(), infinite: degree };
    };
    let core: Vec<f64> = coefficients[low..=high].iter().map(|c| c / largest).collect();
    let mut finite = conjugate_symmetric(aberth(&core));
    finite.extend(std::iter::repeat_n(Complex::new(0.0, 0.0), low));
    Roots { finite, infinite: degree - high }
}

/// The iteration for a polynomial whose first and last coefficients do not vanish.
fn aberth(c: &[f64]) -> Vec<Complex<f64>> {
    let degree = c.len() - 1;
    let mut z = starting_points(c);
    let mut settled = vec![false; degree];
    for _ in 0..MAX_STEPS {
        for i in 0..degree {
            if settled[i] {
                continue;
            }
            let newton = newton_correction(c, z[i]);
            let mut repulsion = Complex::new(0.0, 0.0);
            for j in 0..degree {
                let difference = z[i] - z[j];
                if j != i && difference.norm_sqr() > 0.0 {
                    repulsion += difference.inv();
                }
            }
            let denominator = Complex::new(1.0, 0.0) - newton * repulsion;
            let step = if denominator.norm_sqr() > 1e-300 { newton / denominator } else { newton };
            if !(step.re.is_finite() && step.im.is_finite()) {
                settled[i] = true;
                continue;
            }
            z[i] -= step;
            settled[i] = step.norm_sqr() <= SETTLED * SETTLED * z[i].norm_sqr();
        }
        if settled.iter().all(|&s| s) {
            break;
        }
    }
    z
}

/// p(z) / p'(z) by Horner's rule. Outside the unit circle it uses the reversed polynomial, which keeps powers bounded.
fn newton_correction(c: &[f64], z: Complex<f64>) -> Complex<f64> {
    let degree = (c.len() - 1) as f64;
    if z.norm_sqr() <= 1.0 {
        let (p, d) = horner(c.iter().rev(), z);
        return if d.norm_sqr() > 0.0 { p / d } else { Complex::new(0.0, 0.0) };
    }
    // With q(w) = wⁿ p(1/w), w = 1/z: p'/p = (n − w q'/q) / z.
    let w = z.inv();
    let (q, d) = horner(c.iter(), w);
    let denominator = q * degree - w * d;
    if denominator.norm_sqr() > 0.0 { z * q / denominator } else { Complex::new(0.0, 0.0) }
}

/// Value and derivative of a polynomial with the given coefficients, highest power first.
fn horner<'a>(coefficients: impl Iterator<Item = &'a f64>, z: Complex<f64>) -> (Complex<f64>, Complex<f64>) {
    let mut value = Complex::new(0.0, 0.0);
    let mut derivative = Complex::new(0.0, 0.0);
    for &c in coefficients {
        derivative = derivative * z + value;
        value = value * z + c;
    }
    (value, derivative)
}

/// Starting points on circles whose radii come from the Newton polygon of the coefficients (Bini, Numerical Algorithms 13, 1996).
fn starting_points(c: &[f64]) -> Vec<Complex<f64>> {
    let degree = c.len() - 1;
    let heights: Vec<f64> = c.iter().map(|v| if *v == 0.0 { f64::NEG_INFINITY } else { libm::log(v.abs()) }).collect();
    let mut points = Vec::with_capacity(degree);
    let mut from = 0;
    while from < degree {
        // The next edge of the upper hull is the steepest, and the longest of equally steep ones.
        let slope = |to: usize| (heights[to] - heights[from]) / (to - from) as f64;
        let mut to = from + 1;
        for next in from + 2..=degree {
            if slope(next) >= slope(to) {
                to = next;
            }
        }
        let radius = libm::exp(-slope(to));
        let count = to - from;
        for k in 0..count {
            // The offset avoids the real axis and conjugate points.
            let angle = std::f64::consts::TAU * (k as f64 / count as f64 + from as f64 / degree as f64) + 0.7;
            points.push(Complex::new(radius * libm::cos(angle), radius * libm::sin(angle)));
        }
        from = to;
    }
    points
}

/// Makes nearly real roots real and conjugate pairs exact.
fn conjugate_symmetric(mut z: Vec<Complex<f64>>) -> Vec<Complex<f64>> {
    sort_few(&mut z, |a, b| b.im.total_cmp(&a.im).then(a.re.total_cmp(&b.re)));
    let mut result = Vec::with_capacity(z.len());
    while !z.is_empty() {
        let root = z.remove(0);
        // The partner is the root nearest to the conjugate. A real root is its own partner.
        let distance = |other: &Complex<f64>| (other - root.conj()).norm_sqr();
        let partner = (0..z.len()).min_by(|&i, &j| distance(&z[i]).total_cmp(&distance(&z[j])));
        let is_complex = root.im.abs() > COMPLEX * root.norm_sqr().sqrt();
        match partner {
            Some(j) if is_complex && distance(&z[j]) < root.im * root.im => {
                let other = z.remove(j);
                let mean = Complex::new(0.5 * (root.re + other.re), 0.5 * (root.im - other.im));
                result.push(mean);
                result.push(mean.conj());
            }
            _ => result.push(Complex::new(root.re, 0.0)),
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// Coefficients of Π (t − root) for real roots, lowest power first.
    fn from_roots(values: &[f64]) -> Vec<f64> {
        let mut c = vec![1.0];
        for r in values {
            c.insert(0, 0.0);
            for k in 0..c.len() - 1 {
                c[k] -= r * c[k + 1];
            }
        }
        c
    }

    fn sorted_real_parts(c: &[f64]) -> Vec<f64> {
        let mut found: Vec<f64> = roots(c).finite.iter().map(|z| z.re).collect();
        found.sort_by(f64::total_cmp);
        found
    }

    #[test]
    fn separated_roots_of_every_degree_are_found() {
        let mut random = Random::from_seed(2);
        for degree in 1..=10 {
            for _ in 0..50 {
                let expected: Vec<f64> = (0..degree).map(|k| k as f64 - 4.0 + random.uniform(-0.3, 0.3)).collect();
                for (a, b) in sorted_real_parts(&from_roots(&expected)).iter().zip(&expected) {
                    assert!((a - b).abs() < 1e-8, "degree {degree}: {a} for {b}");
                }
            }
        }
    }

    #[test]
    fn roots_of_very_different_sizes_keep_their_relative_accuracy() {
        let expected = [-3e6, 1e-7, 2e-3, 5.0, 8e4];
        for (a, b) in sorted_real_parts(&from_roots(&expected)).iter().zip(&expected) {
            assert!((a / b - 1.0).abs() < 1e-12, "{a} for {b}");
        }
    }

    #[test]
    fn multiple_roots_are_found_to_what_rounding_allows() {
        for (a, b) in sorted_real_parts(&from_roots(&[0.7, 0.7, 0.7, -2.0])).iter().zip(&[-2.0, 0.7, 0.7, 0.7]) {
            assert!((a - b).abs() < 1e-4, "{a} for {b}");
        }
    }

    #[test]
    fn complex_roots_come_in_exact_pairs() {
        // (t² + 1)(t² − 2t + 5)(t − 3)
        let found = roots(&[-15.0, 11.0, -20.0, 12.0, -5.0, 1.0]).finite;
        assert_eq!(found.len(), 5);
        for root in &found {
            assert!(found.contains(&root.conj()));
        }
        for expected in [Complex::new(0.0, 1.0), Complex::new(1.0, 2.0), Complex::new(3.0, 0.0)] {
            assert!(found.iter().any(|z| (z - expected).norm_sqr() < 1e-20), "{expected} in {found:?}");
        }
    }

    #[test]
    fn zero_and_infinite_roots_are_counted() {
        let found = roots(&[0.0, 0.0, -2.0, 1.0, 0.0]);
        assert_eq!((found.finite.len(), found.infinite), (3, 1));
        assert_eq!(sorted_real_parts(&[0.0, 0.0, -2.0, 1.0, 0.0]), [0.0, 0.0, 2.0]);
        assert_eq!(roots(&[0.0, 0.0, 0.0]), Roots { finite: Vec::new(), infinite: 2 });
        assert_eq!(roots(&[1.0, f64::NAN]), Roots { finite: Vec::new(), infinite: 1 });
        assert_eq!(roots(&[]), Roots { finite: Vec::new(), infinite: 0 });
    }
}
