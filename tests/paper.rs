//! The paper's claims, one by one: Lemma 1, Example 1, Appendix A, Theorem 1, the five steps, the refinement, and the open
//! problem that differentiation solves.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

mod synthetic;

use synthetic::{Protocol, worst_error};
use veronese::embedding::MultibodyMotion;
use veronese::factorisation::differentiation::{POINTS, motions_from_points};
use veronese::factorisation::five_steps;
use veronese::{AffineMotion, Random};

#[test]
fn generic_motions_are_recovered_without_noise() {
    for n in 1..=4 {
        for seed in 0..5 {
            let mut random = Random::from_seed(100 * n as u64 + seed);
            let truth = synthetic::random_motions(n, &mut random);
            let data = Protocol::B1.measurements(&truth, 600, 0.0, &mut random);
            let multibody = MultibodyMotion::estimate(&data, n).unwrap();
            let expected = MultibodyMotion::from_motions(&truth);
            println!("{n} {seed} {:.1e}", (multibody.matrix() - expected.matrix()).amax() / expected.matrix().amax());
            let motions = motions_from_points(&multibody, &data, POINTS, &mut random);
            println!("   differentiation {:.1e}", worst_error(&truth, &motions));
            println!("   five steps {:.1e}", worst_error(&truth, &five_steps(&multibody)));
        }
    }
}
