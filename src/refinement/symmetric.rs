//! Symmetric positive definite 6 × 6 systems: the normal equations of an affine motion.

/// A symmetric 6 × 6 matrix with all entries stored.
pub(crate) type Matrix6 = [[f64; 6]; 6];

/// The Cholesky factor, lower triangular L with `L Lᵀ = matrix`. Pivots that are not positive are raised to the smallest positive number,
/// so the factor always exists.
#[inline(never)]
pub(crate) fn cholesky(matrix: &Matrix6) -> Matrix6 {
    let mut l = [[0.0; 6]; 6];
    for j in 0..6 {
        let mut pivot = matrix[j][j];
        for k in 0..j {
            pivot -= l[j][k] * l[j][k];
        }
        let root = pivot.max(f64::MIN_POSITIVE).sqrt();
        l[j][j] = root;
        for i in j + 1..6 {
            let mut sum = matrix[i][j];
            for k in 0..j {
                sum -= l[i][k] * l[j][k];
            }
            l[i][j] = sum / root;
        }
    }
    l
}

/// Solves `L Lᵀ s = right`.
pub(crate) fn solve(l: &Matrix6, right: &[f64; 6]) -> [f64; 6] {
    let mut s = *right;
    for i in 0..6 {
        for k in 0..i {
            s[i] -= l[i][k] * s[k];
        }
        s[i] /= l[i][i];
    }
    for i in (0..6).rev() {
        for k in i + 1..6 {
            s[i] -= l[k][i] * s[k];
        }
        s[i] /= l[i][i];
    }
    s
}

/// `(L Lᵀ)⁻¹`.
pub(crate) fn inverse(l: &Matrix6) -> Matrix6 {
    let mut result = [[0.0; 6]; 6];
    for j in 0..6 {
        let mut unit = [0.0; 6];
        unit[j] = 1.0;
        let column = solve(l, &unit);
        for i in 0..6 {
            result[i][j] = column[i];
        }
    }
    result
}

/// `log det (L Lᵀ)`.
pub(crate) fn log_determinant(l: &Matrix6) -> f64 {
    (0..6).map(|i| 2.0 * libm::log(l[i][i])).sum()
}

/// `rightᵀ · matrix · right`.
pub(crate) fn quadratic_form(matrix: &Matrix6, right: &[f64; 6]) -> f64 {
    (0..6).map(|i| right[i] * (0..6).map(|j| matrix[i][j] * right[j]).sum::<f64>()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_is_solved_and_inverted() {
        let mut matrix = [[0.0; 6]; 6];
        for i in 0..6 {
            for j in 0..6 {
                matrix[i][j] = 1.0 / (1.0 + (i + j) as f64) + if i == j { 0.5 } else { 0.0 };
            }
        }
        let right = [1.0, -2.0, 3.0, 0.5, 0.0, 7.0];
        let l = cholesky(&matrix);
        let s = solve(&l, &right);
        let inverse = inverse(&l);
        for i in 0..6 {
            let back: f64 = (0..6).map(|j| matrix[i][j] * s[j]).sum();
            assert!((back - right[i]).abs() < 1e-12);
            let other: f64 = (0..6).map(|j| inverse[i][j] * right[j]).sum();
            assert!((other - s[i]).abs() < 1e-12);
        }
        assert!((quadratic_form(&matrix, &s) - (0..6).map(|i| s[i] * right[i]).sum::<f64>()).abs() < 1e-12);
    }

    #[test]
    fn the_determinant_of_a_diagonal_matrix_is_the_product() {
        let mut matrix = [[0.0; 6]; 6];
        for i in 0..6 {
            matrix[i][i] = (i + 1) as f64;
        }
        assert!((log_determinant(&cholesky(&matrix)) - libm::log(720.0)).abs() < 1e-13);
    }
}
