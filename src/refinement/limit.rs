//! Tests that the search reaches the likelihood that EM reaches from the true motions. A lower likelihood is a failure of the search; a
//! higher one, or a wrong motion, is a property of the data.

use super::mixture::{EmBuffers, Mixture, Stop};
use super::{Samples, Search};

use crate::measurements::Measurements;
use crate::motion::AffineMotion;
use scenes::protocol::{Protocol, Relation};

const LONG: Stop = Stop { iterations: 100, gain: 1e-9, step: 1e-7 };

/// Number of trials in which the fit is less likely than the one that EM reaches from the true motions.
fn losses(protocol: &Protocol, trials: u64) -> u64 {
    let lost = |seed: &u64| {
        let problem = protocol.problem(40_000_000 + seed);
        // Their types are those of the crate as `scenes` has it, without tests.
        let (positions, derivatives) = (problem.measurements.positions(), problem.measurements.derivatives());
        let data = Measurements::new(positions.to_vec(), derivatives.to_vec()).unwrap();
        let (normalised, normalisation) = data.normalised();
        let samples = Samples::new(&normalised);
        let in_normalised = |motion| normalisation.apply(&AffineMotion::new(motion)).matrix;
        let truth = problem.motions.iter().map(|motion| in_normalised(motion.matrix)).collect();
        let limit = EmBuffers::default().maximise(&samples, Mixture::new(truth, 0.03), LONG);
        let found = Search::new(&samples, 1).fit(protocol.motions, &[], f64::INFINITY);
        found.log_likelihood < limit.log_likelihood - 0.5
    };
    (0..trials).filter(lost).count() as u64
}

#[test]
fn the_search_reaches_the_likelihood_of_the_truth() {
    let general = Protocol::new(4, 0.05);
    for protocol in [
        general.clone(),
        Protocol { first_share: Some(0.05), ..general },
        Protocol { first_share: Some(0.05), ..Protocol::new(2, 0.05) },
        Protocol { outliers: 0.3, ..Protocol::new(4, 0.02) },
        Protocol { relation: Relation::Near(0.2), ..Protocol::new(2, 0.05) },
    ] {
        assert_eq!(losses(&protocol, 10), 0, "{protocol:?}");
    }
}
