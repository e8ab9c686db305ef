//! The algebra in WebAssembly, under Node, from measurements to motions; and a panic, which no call of the package brings about. Each part of
//! the algebra is tested natively (tests/paper.rs, tests/properties.rs), and golden hashes (tests/golden.json) say that the modules answer as
//! the crate does.
#![cfg(target_arch = "wasm32")]
#![allow(clippy::unwrap_used, clippy::panic, reason = "clippy knows #[test] only, not #[wasm_bindgen_test]")]

use js_sys::{Function, Reflect};
use scenes::protocol::Protocol;
use veronese::embedding::MultibodyMotion;
use veronese::embedding::rank::number_of_motions;
use veronese::factorisation::differentiation::{POINTS, motions_from_points};
use veronese::factorisation::five_steps;
use veronese::refinement::product;
use veronese::{AffineMotion, FitOptions, Method, MotionCount, Random, fit_motions};
use wasm_bindgen::prelude::*;
use wasm_bindgen_test::wasm_bindgen_test as test;

#[test]
fn motions_are_recovered_from_measurements_by_each_step_of_the_algebra() {
    for n in 1..=3 {
        let truth = Protocol::new(n, 0.0).problem(20 + n as u64);
        let data = &truth.measurements;
        let wrong = |found: &[AffineMotion]| truth.errors(found).1;
        assert_eq!(number_of_motions(data, 4).unwrap().motions, n);
        let multibody = MultibodyMotion::estimate(data, n).unwrap();
        let expected = MultibodyMotion::from_motions(&truth.motions);
        assert!((multibody.matrix() - expected.matrix()).amax() < 1e-10 * expected.matrix().amax(), "n = {n}");
        assert!(wrong(&five_steps(&multibody)) < 1e-6, "n = {n}");
        let differentiated = motions_from_points(&multibody, data, POINTS, &mut Random::from_seed(1));
        assert!(wrong(&differentiated) < 1e-9, "n = {n}");
        for method in [Method::Paper, Method::Best] {
            let options = FitOptions::default().with_method(method).with_motions(MotionCount::Given(n));
            let found = fit_motions(data, &options, &mut |_| {}).unwrap();
            let motions: Vec<AffineMotion> = found.motions.iter().map(|motion| motion.matrix).collect();
            assert!(wrong(&motions) < 1e-8, "n = {n}, {method:?}");
        }
        let noisy = Protocol::new(n, 0.01).problem(20 + n as u64);
        let (_, report) = product::refine(&noisy.motions, &noisy.measurements);
        assert!(report.final_cost < report.initial_cost && report.was_successful(), "n = {n}");
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
