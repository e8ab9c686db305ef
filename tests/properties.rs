//! Properties of the algebra for random inputs; more of them with the environment variable PROPTEST_CASES.
#![allow(clippy::unwrap_used, reason = "test code may panic")]

use proptest::prelude::*;
use veronese::AffineMotion;
use veronese::embedding::{MultibodyMotion, veronese as map};
use veronese::factorisation::ternary::factorise;
use veronese::refinement::product;

/// Step of central differences. Their error is about its square.
const STEP: f64 = 1e-5;

fn vector() -> impl Strategy<Value = [f64; 3]> {
    prop::array::uniform3(-1.5..1.5f64)
}

fn motions(most: usize) -> impl Strategy<Value = Vec<AffineMotion>> {
    prop::collection::vec(prop::array::uniform6(-1.0..1.0f64).prop_map(AffineMotion::new), 1..=most)
}

fn moved(mut v: [f64; 3], k: usize, by: f64) -> [f64; 3] {
    v[k] += by;
    v
}

fn power(value: f64, exponent: usize) -> f64 {
    (0..exponent).map(|_| value).product()
}

/// Coefficients of Π b_iᵀz, as 𝒜ᵀν_n(y) of motions with y = (1, 0, 1).
fn expanded(forms: &[[f64; 3]]) -> Vec<f64> {
    // For y = (1, 0, 1), A_iᵀy is (a11, a12, a13 + 1).
    let motions: Vec<AffineMotion> =
        forms.iter().map(|b| AffineMotion::new([b[0], b[1], b[2] - 1.0, 0.0, 0.0, 0.0])).collect();
    MultibodyMotion::from_motions(&motions).multibody_row([1.0, 0.0, 1.0]).as_slice().to_vec()
}

/// Sine of the angle between two vectors.
fn sine(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let length = |v: &[f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
    length(&cross) / (length(a) * length(b))
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_veronese_map_is_homogeneous(n in 1usize..=10, v in vector(), factor in -1.5..1.5f64) {
        let scaled = map::embed(n, v.map(|c| factor * c));
        let expected = map::embed(n, v) * power(factor, n);
        prop_assert!((scaled - &expected).amax() <= 1e-13 * expected.amax().max(1e-30));
    }

    #[test]
    fn euler_the_jacobian_times_the_vector_is_n_times_the_map(n in 1usize..=10, v in vector()) {
        let product = map::jacobian(n, v) * nalgebra::Vector3::from(v);
        let expected = map::embed(n, v) * n as f64;
        prop_assert!((product - &expected).amax() <= 1e-13 * (1.0 + expected.amax()));
    }

    #[test]
    fn the_jacobian_agrees_with_differences(n in 1usize..=6, v in vector()) {
        let jacobian = map::jacobian(n, v);
        for k in 0..3 {
            let difference = (map::embed(n, moved(v, k, STEP)) - map::embed(n, moved(v, k, -STEP))) / (2.0 * STEP);
            prop_assert!((jacobian.column(k) - &difference).amax() <= 1e-6 * (1.0 + difference.amax()));
        }
    }

    #[test]
    fn the_gradients_of_the_multibody_motion_agree_with_differences(a in motions(5), x in vector(), y in vector()) {
        let multibody = MultibodyMotion::from_motions(&a);
        let (by_x, by_y) = (multibody.gradient_x(x, y), multibody.gradient_y(x, y));
        let size = 1.0 + by_x.iter().chain(&by_y).fold(0.0, |m: f64, g| m.max(g.abs()));
        for k in 0..3 {
            let ends = [STEP, -STEP].map(|by| multibody.evaluate(moved(x, k, by), y));
            prop_assert!((by_x[k] - (ends[0] - ends[1]) / (2.0 * STEP)).abs() <= 1e-5 * size);
            let ends = [STEP, -STEP].map(|by| multibody.evaluate(x, moved(y, k, by)));
            prop_assert!((by_y[k] - (ends[0] - ends[1]) / (2.0 * STEP)).abs() <= 1e-5 * size);
        }
    }

    #[test]
    fn the_multibody_motion_does_not_depend_on_the_order_of_motions(a in motions(5)) {
        let mut reversed = a.clone();
        reversed.reverse();
        let (p, q) = (MultibodyMotion::from_motions(&a), MultibodyMotion::from_motions(&reversed));
        prop_assert!((p.matrix() - q.matrix()).amax() <= 1e-14 * p.matrix().amax().max(1.0));
    }

    #[test]
    fn the_gradient_of_the_product_agrees_with_differences(
        a in motions(5), x in prop::array::uniform2(-1.0..1.0f64), y in vector(),
    ) {
        let mut gradient = vec![0.0; 6 * a.len()];
        let mut unused = gradient.clone();
        let value = product::residual_and_gradient(&a, x, y, &mut gradient);
        prop_assert!((value - a.iter().map(|m| m.residual(x, y)).product::<f64>()).abs() <= 1e-13);
        let size = 1.0 + gradient.iter().fold(0.0, |m: f64, g| m.max(g.abs()));
        for k in 0..gradient.len() {
            let ends = [STEP, -STEP].map(|by| {
                let mut b = a.clone();
                b[k / 6].matrix[k % 6] += by;
                product::residual_and_gradient(&b, x, y, &mut unused)
            });
            prop_assert!((gradient[k] - (ends[0] - ends[1]) / (2.0 * STEP)).abs() <= 1e-6 * size);
        }
    }

    #[test]
    fn factorising_an_expanded_product_gives_its_forms(forms in prop::collection::vec(vector(), 1..=5)) {
        // The method needs the second and third entries of the forms to have different ratios.
        let apart = |a: &[f64; 3], b: &[f64; 3]| sine(&[0.0, a[1], a[2]], &[0.0, b[1], b[2]]) > 0.15;
        prop_assume!(forms.iter().all(|b| (b[1] * b[1] + b[2] * b[2]).sqrt() > 0.2));
        prop_assume!(forms.iter().enumerate().all(|(i, a)| forms[..i].iter().all(|b| apart(a, b))));
        let mut found = factorise(&expanded(&forms), forms.len()).unwrap();
        prop_assert_eq!(found.len(), forms.len());
        for form in &forms {
            let nearest = (0..found.len()).min_by(|&i, &j| sine(form, &found[i]).total_cmp(&sine(form, &found[j])));
            let factor = found.remove(nearest.unwrap());
            prop_assert!(sine(form, &factor) < 1e-7, "{:?} is not {:?}", factor, form);
        }
    }
}

/// A form without second entry has its root at infinity, and one without third entry at zero: the leading and the last coefficient vanish.
#[test]
fn forms_without_second_or_third_entry_are_found() {
    let forms = [[0.5, 0.0, 1.0], [-1.0, 2.0, 0.0], [0.3, 1.0, 1.0]];
    let found = factorise(&expanded(&forms), 3).unwrap();
    for form in &forms {
        assert!(found.iter().any(|factor| sine(form, factor) < 1e-12), "{form:?} is not in {found:?}");
    }
    assert!(factorise(&[0.0; 6], 2).is_none());
    assert!(factorise(&[1.0; 5], 2).is_none());
    assert!(factorise(&[f64::NAN; 6], 2).is_none());
}
