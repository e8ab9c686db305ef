//! The algebra in WebAssembly, under Node: the Veronese map, the multibody motion, rank, factorisation and refinement on generated
//! measurements; and a panic, which no call of the package brings about. tests/paper.rs says all this in more cases natively, and golden
//! hashes (tests/golden.json) that the modules answer as the crate does.
#![cfg(target_arch = "wasm32")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "clippy knows #[test] only, not #[wasm_bindgen_test]")]

use js_sys::{Function, Reflect};
use veronese::embedding::monomials::unknowns;
use veronese::embedding::rank::{number_of_motions, numerical_rank};
use veronese::embedding::veronese::{embed, jacobian};
use veronese::embedding::{EmbeddedData, MultibodyMotion};
use veronese::factorisation::differentiation::{POINTS, motions_from_points};
use veronese::factorisation::five_steps;
use veronese::factorisation::ternary::factorise;
use veronese::refinement::product;
use veronese::{AffineMotion, FitOptions, Measurements, Method, MotionCount, Random, fit_motions};
use wasm_bindgen::prelude::*;
use wasm_bindgen_test::wasm_bindgen_test as test;

#[path = "../../tests/synthetic/mod.rs"]
mod synthetic;

use synthetic::{measurements, random_motions, worst_error};

/// Motions and measurements of them.
fn problem(n: usize, noise: f64) -> (Vec<AffineMotion>, Measurements, Random) {
    let mut random = Random::from_seed(20 + n as u64);
    let truth = random_motions(n, &mut random);
    let data = measurements(&truth, 200 * n.max(3), noise, &mut random);
    (truth, data, random)
}

#[test]
fn the_veronese_map_has_all_monomials_and_its_jacobian_obeys_euler() {
    let v = [2.0, 3.0, 5.0];
    assert_eq!(embed(2, v).as_slice(), [4.0, 6.0, 10.0, 9.0, 15.0, 25.0]);
    for n in 1..=10 {
        let (map, jacobian) = (embed(n, v), jacobian(n, v));
        for (row, entry) in map.iter().enumerate() {
            let product: f64 = (0..3).map(|k| jacobian[(row, k)] * v[k]).sum();
            assert!((product - n as f64 * entry).abs() <= 1e-13 * product, "n = {n}, row {row}");
        }
    }
}

#[test]
fn the_multibody_motion_is_the_product_of_the_constraints() {
    for n in 1..=5 {
        let (truth, data, _) = problem(n, 0.1);
        let multibody = MultibodyMotion::from_motions(&truth);
        for ([x, y], derivatives) in data.iter().take(20) {
            let expected: f64 = truth.iter().map(|motion| motion.residual([x, y], derivatives)).product();
            assert!((multibody.evaluate([x, y, 1.0], derivatives) - expected).abs() < 1e-13, "n = {n}");
        }
    }
}

#[test]
fn the_rank_says_how_many_motions_there_are() {
    for n in 1..=3 {
        let (_, data, _) = problem(n, 0.0);
        let values = EmbeddedData::new(&data, n).scaled_singular_values().unwrap();
        assert_eq!(numerical_rank(&values, 1e-11), unknowns(n) - 1, "n = {n}");
        assert_eq!(number_of_motions(&data, 4).unwrap().motions, n);
    }
}

#[test]
fn a_product_of_lines_is_factored() {
    // (z₁ + 2 z₂ − z₃) (z₁ − z₂ + 3 z₃)
    let found = factorise(&[1.0, 1.0, 2.0, -2.0, 7.0, -3.0], 2).unwrap();
    for line in [[1.0, 2.0, -1.0], [1.0, -1.0, 3.0]] {
        let is_line = |factor: &[f64; 3]| (0..3).all(|k| (factor[k] * line[0] - line[k] * factor[0]).abs() < 1e-12);
        assert!(found.iter().any(is_line), "{line:?} is not in {found:?}");
    }
}

#[test]
fn motions_are_recovered_by_both_factorisations() {
    for n in 1..=4 {
        let (truth, data, mut random) = problem(n, 0.0);
        let multibody = MultibodyMotion::estimate(&data, n).unwrap();
        let motions = motions_from_points(&multibody, &data, POINTS, &mut random);
        assert!(worst_error(&truth, &motions) < 1e-9, "n = {n}");
        assert!(worst_error(&truth, &five_steps(&multibody)) < 1e-6, "n = {n}");
    }
}

#[test]
fn the_refinement_lowers_the_error() {
    for n in 1..=4 {
        let (truth, data, _) = problem(n, 0.01);
        let (refined, report) = product::refine(&truth, &data);
        assert_eq!(report.final_cost, product::cost(&refined, &data));
        assert!(report.final_cost < report.initial_cost && report.was_successful(), "n = {n}");
    }
}

#[test]
fn generated_measurements_are_fitted() {
    for n in 1..=3 {
        let (truth, data, _) = problem(n, 0.0);
        for method in [Method::Paper, Method::Best] {
            let options = FitOptions::default().with_method(method).with_motions(MotionCount::Given(n));
            let found = fit_motions(&data, &options, &mut |_| {}).unwrap();
            let motions: Vec<AffineMotion> = found.motions.iter().map(|motion| motion.matrix).collect();
            assert!(worst_error(&truth, &motions) < 1e-8, "n = {n}, {method:?}");
        }
    }
}

fn property(value: &JsValue, name: &str) -> Option<String> {
    Reflect::get(value, &name.into()).ok()?.as_string()
}

#[test]
fn a_panic_is_thrown_as_an_error_that_keeps_its_message_and_place() {
    veronese_wasm::start();
    let panicking = Closure::<dyn Fn()>::new(|| panic!("the reason"));
    let function: &Function = panicking.as_ref().unchecked_ref();
    let thrown = function.call0(&JsValue::UNDEFINED).unwrap_err();
    assert_eq!(property(&thrown, "name").as_deref(), Some("VeroneseError"));
    assert_eq!(property(&thrown, "code").as_deref(), Some("internal"));
    let message = property(&thrown, "message").unwrap();
    assert!(message.contains("the reason") && message.contains("algebra.rs"), "{message}");
    assert!(thrown.is_instance_of::<js_sys::Error>());
}
