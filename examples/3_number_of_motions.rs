//! How many motions there are: the paper's rule on the rank of the embedded data, and ours on the likelihood, both on data
//! with more and more noise.

use veronese::embedding::rank::{MAX_TRIED, number_of_motions};
use veronese::{AffineMotion, FitOptions, Measurements, Random, Result, fit_motions};

/// Public: the tests run it, too.
pub fn main() -> Result<()> {
    let motions = [
        AffineMotion::new([0.3, -0.6, 0.9, 0.5, 0.2, -0.8]),
        AffineMotion::new([-0.7, 0.1, -0.5, 0.4, 0.6, 0.7]),
        AffineMotion::new([0.2, 0.8, -0.9, -0.6, 0.3, 0.1]),
        AffineMotion::new([0.6, 0.4, 0.2, -0.3, -0.9, -0.6]),
    ];
    for count in 1..=motions.len() {
        for noise in [0.0, 0.02, 0.1] {
            let data = measure(&motions[..count], noise)?;

            // Theorem 1: with n motions the matrix P̃_n has one null vector. How small is null, when there is noise?
            let rule = number_of_motions(&data.normalised().0, MAX_TRIED)?;

            // Ours fits one motion, two, … and weighs what each more explains against what it costs to describe.
            let fit = fit_motions(&data, &FitOptions::default(), &mut |_| {})?;

            println!("{count} motions, noise {noise:4}: the rank says {}, the likelihood {}", rule.motions, fit.count);
        }
    }
    Ok(())
}

/// 600 measurements of the motions in turn: y of unit length and orthogonal to the flow (u, v, 1), then noise.
fn measure(motions: &[AffineMotion], noise: f64) -> Result<Measurements> {
    let mut random = Random::from_seed(3);
    let (mut positions, mut derivatives) = (Vec::new(), Vec::new());
    for j in 0..600 {
        let position = [random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)];
        let [u, v] = motions[j % motions.len()].flow(position[0], position[1]);
        let any: [f64; 3] = std::array::from_fn(|_| random.normal());
        let along = (any[0] * u + any[1] * v + any[2]) / (u * u + v * v + 1.0);
        let y = [any[0] - along * u, any[1] - along * v, any[2] - along];
        let length = (y[0] * y[0] + y[1] * y[1] + y[2] * y[2]).sqrt();
        positions.push(position);
        derivatives.push(y.map(|value| value / length + random.uniform(-noise, noise)));
    }
    Measurements::new(positions, derivatives)
}
