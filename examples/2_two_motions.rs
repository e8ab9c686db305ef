//! Two motions from image derivatives at points, without knowing which point belongs to which: the multibody affine motion
//! by linear algebra, its factors by differentiation, and the same by the call that also copes with noise.

use veronese::embedding::MultibodyMotion;
use veronese::factorisation::differentiation::{POINTS, motions_from_points};
use veronese::{AffineMotion, FitOptions, Measurements, MotionCount, Random, Result, fit_motions};

/// Public: the tests run it, too.
pub fn main() -> Result<()> {
    let truth =
        [AffineMotion::new([0.1, -0.2, 0.5, 0.2, 0.1, -0.3]), AffineMotion::new([0.0, 0.0, -0.4, 0.0, 0.0, 0.2])];

    let exact = measure(&truth, 0.0)?;
    let both = MultibodyMotion::estimate(&exact, 2)?;
    println!("one matrix for both motions, {} × {}", both.matrix().nrows(), both.matrix().ncols());
    for motion in motions_from_points(&both, &exact, POINTS, &mut Random::from_seed(1)) {
        println!("without noise: wrong by less than 1e-9: {}", error(&truth, &motion) < 1e-9);
    }

    let noisy = measure(&truth, 0.05)?;
    let options = FitOptions::default().with_motions(MotionCount::Given(2));
    for motion in fit_motions(&noisy, &options, &mut |_| {})?.motions {
        let error = 100.0 * error(&truth, &motion.matrix);
        println!("with 5 % noise: {} measurements, wrong by {error:.1} %", motion.measurements);
    }
    Ok(())
}

/// The relative error of a motion: to the nearest true one.
fn error(truth: &[AffineMotion], found: &AffineMotion) -> f64 {
    truth.iter().map(|motion| motion.relative_error(found)).fold(f64::INFINITY, f64::min)
}

/// 400 measurements of motions in turn. By brightness constancy I_x u + I_y v + I_t = 0: given the flow (u, v) and a
/// gradient (I_x, I_y), it fixes I_t.
fn measure(motions: &[AffineMotion], noise: f64) -> Result<Measurements> {
    let mut random = Random::from_seed(7);
    let (mut positions, mut derivatives) = (Vec::new(), Vec::new());
    for j in 0..400 {
        let position = [random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)];
        let [u, v] = motions[j % motions.len()].flow(position[0], position[1]);
        let (ix, iy) = (random.normal(), random.normal());
        positions.push(position);
        derivatives.push([ix, iy, -ix * u - iy * v].map(|value| value + random.uniform(-noise, noise)));
    }
    Measurements::new(positions, derivatives)
}
