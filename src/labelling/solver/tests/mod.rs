//! The solver against brute force on small grids, and against α-expansion by minimum cuts on problems like those of the pipeline.

mod expansion;
mod max_flow;

use super::*;
use crate::frame::Plane;
use crate::random::Random;

const SOLVERS: [Solver; 3] = [Solver::FAST, Solver::BEST, Solver { levels: 1, iterations: 30 }];

struct Grid {
    costs: Vec<Plane>,
    horizontal: Plane,
    vertical: Plane,
}

impl Grid {
    fn problem(&self) -> Potts<'_> {
        Potts { costs: &self.costs, horizontal: &self.horizontal, vertical: &self.vertical }
    }
}

fn random_grid(random: &mut Random, width: usize, height: usize, labels: usize) -> Grid {
    let mut plane = |scale: f64| Plane::from_fn(width, height, |_, _| random.uniform(0.0, scale) as f32);
    Grid { costs: (0..labels).map(|_| plane(2.0)).collect(), horizontal: plane(1.0), vertical: plane(1.0) }
}

/// What the pipeline's costs look like: a background and discs, each true label cheap (a saturated squared residual), the
/// others between cheap (no texture: any motion explains the pixel) and 2; weights 6, weaker across image edges.
fn scene_like(seed: u64, width: usize, height: usize, labels: usize) -> Grid {
    let mut random = Random::from_seed(seed);
    let discs: Vec<[f64; 3]> = (1..labels)
        .map(|_| {
            let r = random.uniform(0.08, 0.2) * width as f64;
            [random.uniform(0.0, width as f64), random.uniform(0.0, height as f64), r]
        })
        .collect();
    let truth: Vec<usize> = (0..width * height)
        .map(|p| {
            let (x, y) = ((p % width) as f64, (p / width) as f64);
            let covers = |d: &[f64; 3]| (x - d[0]) * (x - d[0]) + (y - d[1]) * (y - d[1]) < d[2] * d[2];
            discs.iter().rposition(covers).map_or(0, |i| i + 1)
        })
        .collect();
    // Texture in patches of 16 pixels; a third of them flat.
    let patches: Vec<f64> =
        (0..(width / 16 + 1) * (height / 16 + 1)).map(|_| random.uniform(-1.0, 2.0).max(0.05)).collect();
    let costs = (0..labels)
        .map(|l| {
            Plane::from_fn(width, height, |x, y| {
                let texture = patches[(y / 16) * (width / 16 + 1) + x / 16];
                let noise = random.normal();
                let shift = if truth[y * width + x] == l { 0.0 } else { 4.0 * texture * random.normal() };
                let e = (noise + shift) * (noise + shift);
                (e / (1.0 + e / 2.0)) as f32
            })
        })
        .collect();
    let mut weight = |step: usize| {
        Plane::from_fn(width, height, |x, y| {
            let p = y * width + x;
            let edge = truth.get(p + step).is_some_and(|&t| t != truth[p]);
            (6.0 * if edge { 0.25 } else { random.uniform(0.5, 1.0) }) as f32
        })
    };
    let (horizontal, vertical) = (weight(1), weight(width));
    Grid { costs, horizontal, vertical }
}

fn brute_force(problem: &Potts<'_>) -> f64 {
    let size = problem.width() * problem.height();
    let labels = problem.costs.len();
    let mut lowest = f64::INFINITY;
    let mut current = vec![0u8; size];
    for code in 0..labels.pow(size as u32) {
        let mut rest = code;
        for l in &mut current {
            *l = (rest % labels) as u8;
            rest /= labels;
        }
        lowest = lowest.min(problem.energy(&current));
    }
    lowest
}

#[test]
fn two_labels_are_solved_exactly_by_expansion() {
    let mut random = Random::from_seed(11);
    for (width, height) in [(1, 9), (9, 1), (2, 5), (3, 4), (4, 3), (1, 1)] {
        for _ in 0..12 {
            let grid = random_grid(&mut random, width, height, 2);
            let problem = grid.problem();
            let found = problem.energy(&expansion::minimise(&problem, 1, None));
            assert!((found - brute_force(&problem)).abs() < 1e-5, "{width}×{height}");
        }
    }
}

#[test]
fn three_labels_come_within_a_hundredth_of_brute_force_on_average() {
    let mut random = Random::from_seed(12);
    let mut excess = [0.0; SOLVERS.len()];
    for _ in 0..20 {
        let grid = random_grid(&mut random, 3, 3, 3);
        let problem = grid.problem();
        let optimum = brute_force(&problem);
        for (k, solver) in SOLVERS.into_iter().enumerate() {
            let found = problem.energy(&minimise(&problem, solver, None));
            assert!(found >= optimum - 1e-5);
            excess[k] += (found / optimum - 1.0) / 20.0;
        }
        let solution = messages::minimise(&problem, 1, 200);
        assert!(solution.bound <= optimum + 1e-4, "bound {} above the optimum {optimum}", solution.bound);
        assert!(solution.bound > 0.9 * optimum, "bound {} is far below {optimum}", solution.bound);
    }
    assert!(excess.iter().all(|&e| e < 0.01), "{excess:?}");
}

#[test]
fn trees_are_solved_exactly_by_messages() {
    // On a chain the bound is tight: tree-reweighted message passing is dynamic programming.
    let mut random = Random::from_seed(13);
    for labels in [2, 3, 5] {
        let grid = random_grid(&mut random, 5, 1, labels);
        let problem = grid.problem();
        let solution = messages::minimise(&problem, 1, 5);
        let optimum = brute_force(&problem);
        assert!((problem.energy(&solution.labels) - optimum).abs() < 1e-5);
        assert!((solution.bound - optimum).abs() < 1e-4);
    }
}

#[test]
fn two_labels_come_near_the_minimum_cut() {
    for seed in 20..24 {
        let grid = scene_like(seed, 70, 51, 2);
        let problem = grid.problem();
        let optimum = problem.energy(&expansion::minimise(&problem, 1, None));
        let found = problem.energy(&minimise(&problem, Solver::BEST, None));
        assert!(found >= optimum - 1e-3 && found <= 1.005 * optimum, "{found} for {optimum}");
    }
}

#[test]
fn no_solver_is_worse_than_descent_and_the_bound_holds() {
    for (seed, labels) in [(1, 2), (2, 4), (3, 7), (4, 11)] {
        let grid = scene_like(seed, 70, 51, labels);
        let problem = grid.problem();
        let mut descended = problem.cheapest();
        problem.descend(&mut descended, 50);
        let reference = problem.energy(&descended);
        let bound = messages::minimise(&problem, 1, 60).bound;
        for solver in SOLVERS {
            let found = minimise(&problem, solver, None);
            let energy = problem.energy(&found);
            assert!(energy <= reference, "{solver:?}, {labels} labels: {energy} above {reference}");
            assert!(energy >= bound - 1e-3 * bound.abs(), "{solver:?}: {energy} below the bound {bound}");
            assert_eq!(found, minimise(&problem, solver, None));
        }
    }
}

#[test]
fn the_start_is_never_made_worse_and_bad_starts_are_ignored() {
    let grid = scene_like(5, 40, 30, 3);
    let problem = grid.problem();
    let good = expansion::minimise(&problem, 5, None);
    for solver in SOLVERS {
        let from_good = problem.energy(&minimise(&problem, solver, Some(&good)));
        assert!(from_good <= problem.energy(&good) + 1e-9);
        assert_eq!(minimise(&problem, solver, Some(&[9; 1200])), minimise(&problem, solver, None));
        assert_eq!(minimise(&problem, solver, Some(&[0; 3])), minimise(&problem, solver, None));
    }
}

#[test]
fn forbidden_labels_and_odd_sizes_are_handled() {
    for (width, height) in [(16, 16), (17, 33), (1, 40), (40, 1), (2, 2)] {
        let mut costs = vec![Plane::filled(width, height, f32::NAN), Plane::filled(width, height, 1.0)];
        costs.push(Plane::filled(width, height, f32::INFINITY));
        let weight = Plane::filled(width, height, 0.5);
        let problem = Potts { costs: &costs, horizontal: &weight, vertical: &weight };
        for solver in SOLVERS {
            assert!(minimise(&problem, solver, None).iter().all(|&l| l == 1), "{solver:?} {width}×{height}");
        }
    }
    let costs = vec![Plane::filled(20, 20, 1.0); MAX_LABELS];
    let weight = Plane::filled(20, 20, 1.0);
    let problem = Potts { costs: &costs, horizontal: &weight, vertical: &weight };
    assert_eq!(minimise(&problem, Solver::BEST, None)[..], [0; 400]);
    assert_eq!(minimise(&Potts { costs: &costs[..1], ..problem }, Solver::BEST, None)[..], [0; 400]);
}

/// Costs and weights as the pipeline has them, on a generated scene with the true motions: truncated squared residuals over
/// the noise, weights that fall across image edges.
fn scene_costs(seed: u64, width: usize, height: usize, objects: usize) -> Grid {
    use crate::scene;
    let options = scene::SceneOptions { width, height, objects, seed, ..scene::SceneOptions::default() };
    let scene = scene::generate(&options).unwrap();
    let (first, second) = (scene.first().luminance(), scene.second().luminance());
    let at = |x: f64, y: f64| {
        let (x, y) = (x.clamp(0.0, (width - 2) as f64), y.clamp(0.0, (height - 2) as f64));
        let (i, j, f, g) = (x as usize, y as usize, x.fract() as f32, y.fract() as f32);
        let row = |j: usize| (1.0 - f) * second.at(i, j) + f * second.at(i + 1, j);
        (1.0 - g) * row(j) + g * row(j + 1)
    };
    let cost = |l: usize, x: usize, y: usize| {
        let [u, v] = scene.motions[l].flow(x as f64, y as f64);
        let r = at(x as f64 + u, y as f64 + v) - first.at(x, y);
        let e = r * r / 9.0;
        e / (1.0 + e / 2.0) + if l > 0 { 0.05 } else { 0.0 }
    };
    let costs = (0..scene.motions.len()).map(|l| Plane::from_fn(width, height, |x, y| cost(l, x, y))).collect();
    let weight = |dx: usize, dy: usize| {
        Plane::from_fn(width, height, |x, y| {
            let step = first.at((x + dx).min(width - 1), (y + dy).min(height - 1)) - first.at(x, y);
            6.0 * (0.15 + 0.85 * libm::expf(-step.abs() / 10.0))
        })
    };
    Grid { costs, horizontal: weight(1, 0), vertical: weight(0, 1) }
}

#[test]
fn scenes_are_solved_to_a_fraction_of_a_per_cent() {
    for seed in [1, 2] {
        let grid = scene_costs(seed, 320, 240, 3);
        let problem = grid.problem();
        let bound = messages::minimise(&problem, 1, 100).bound;
        for (solver, most) in [(Solver::LIGHT, 0.005), (Solver::FAST, 0.002), (Solver::BEST, 0.0005)] {
            let excess = problem.energy(&minimise(&problem, solver, None)) / bound - 1.0;
            assert!(excess < most, "seed {seed}, {solver:?}: {excess:.5} above the bound");
        }
    }
}
