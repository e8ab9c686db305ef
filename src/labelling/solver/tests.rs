//! The solver against the optimum of narrow grids, and against its own bound on problems like those of the pipeline.

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

/// Costs like those of the pipeline: a background and discs, each true label cheap (a saturated squared residual), the
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

/// The least energy, pixel by pixel: `least` holds that of the pixels so far for every labelling of the last `width` of them, its digits to
/// the base of the number of labels, the last pixel's the lowest.
fn optimum(problem: &Potts<'_>) -> f64 {
    let (width, labels) = (problem.width(), problem.costs.len());
    let states = labels.pow(width as u32);
    let mut least = vec![0.0; states];
    for p in 0..width * problem.height() {
        let mut next = vec![f64::INFINITY; states];
        for (state, energy) in least.into_iter().enumerate() {
            let (left, above) = (state % labels, state * labels / states);
            for l in 0..labels {
                let mut sum = energy + f64::from(problem.cost(l, p));
                if p % width > 0 && left != l {
                    sum += f64::from(problem.horizontal.values()[p - 1]);
                }
                if p >= width && above != l {
                    sum += f64::from(problem.vertical.values()[p - width]);
                }
                let place = &mut next[(state * labels + l) % states];
                *place = place.min(sum);
            }
        }
        least = next;
    }
    least.into_iter().fold(f64::INFINITY, f64::min)
}

/// A lower bound of the energy, from so many iterations of message passing in the numbers of the problem, pixel by pixel. The minima that a
/// backward pass takes away from a pixel and from its messages are no more than any labelling costs.
fn bound(problem: &Potts<'_>, iterations: usize) -> f64 {
    let (width, height, labels) = (problem.width(), problem.height(), problem.costs.len());
    let pixels = width * height;
    // The edges of each pixel to its right and lower neighbour: weights and messages.
    let weights: [Vec<f64>; 2] =
        [(problem.horizontal, 1, height), (problem.vertical, 0, height - 1)].map(|(plane, less, rows)| {
            (0..pixels)
                .map(|p| match p % width < width - less && p / width < rows {
                    true => f64::from(plane.values()[p]),
                    false => 0.0,
                })
                .collect()
        });
    let mut messages: [Vec<Vec<f64>>; 2] = [0; 2].map(|_| vec![vec![0.0; labels]; pixels]);
    let share = |p: usize| {
        let x = p % width;
        let [back, ahead] = [[x > 0, p >= width], [x + 1 < width, p + width < pixels]];
        let chains = [back, ahead].map(|edges| edges.into_iter().filter(|edge| *edge).count());
        1.0 / chains[0].max(chains[1]).max(1) as f64
    };
    let mut bound = f64::NEG_INFINITY;
    let mut total = vec![0.0; labels];
    let least = |values: &[f64]| values.iter().copied().fold(f64::INFINITY, f64::min);
    for pass in 0..2 * iterations {
        let forward = pass % 2 == 0;
        let mut sum = 0.0;
        for k in 0..pixels {
            let p = if forward { k } else { pixels - 1 - k };
            let x = p % width;
            let before = [(0, x > 0, 1), (1, p >= width, width)].map(|(d, is, step)| is.then(|| (d, p - step)));
            let after = [(0, x + 1 < width), (1, p + width < pixels)].map(|(d, is)| is.then_some((d, p)));
            total.iter_mut().enumerate().for_each(|(l, t)| *t = f64::from(problem.cost(l, p)));
            for &(d, q) in before.iter().chain(&after).flatten() {
                total.iter_mut().zip(&messages[d][q]).for_each(|(t, m)| *t += m);
            }
            let low = least(&total);
            total.iter_mut().for_each(|t| *t -= low);
            sum += low;
            let share = share(p);
            for (d, q) in if forward { after } else { before }.into_iter().flatten() {
                let message = &mut messages[d][q];
                message.iter_mut().zip(&total).for_each(|(m, t)| *m = share * t - *m);
                let low = least(message);
                message.iter_mut().for_each(|m| *m = (*m - low).min(weights[d][q]));
                sum += low;
            }
        }
        if !forward {
            bound = sum;
        }
    }
    bound
}

/// Widths, heights and numbers of labels. The solver works on bands of eight rows: some grids are part of one, others several.
const NARROW: [[usize; 3]; 8] =
    [[3, 3, 3], [9, 1, 2], [1, 9, 2], [8, 19, 2], [5, 14, 3], [4, 9, 4], [3, 21, 6], [2, 10, 9]];

#[test]
fn narrow_grids_come_within_a_hundredth_of_the_optimum_and_their_bound_is_below_it() {
    let mut random = Random::from_seed(12);
    for [width, height, labels] in NARROW {
        let mut excess = [0.0; SOLVERS.len()];
        for _ in 0..20 {
            let grid = random_grid(&mut random, width, height, labels);
            let problem = grid.problem();
            let optimum = optimum(&problem);
            for (k, solver) in SOLVERS.into_iter().enumerate() {
                let found = problem.energy(&minimise(&problem, solver));
                assert!(found >= optimum - 1e-4, "{found} below the optimum {optimum}");
                excess[k] += (found / optimum - 1.0) / 20.0;
            }
            let bound = bound(&problem, 200);
            assert!(bound <= optimum + 1e-4, "bound {bound} above the optimum {optimum}");
            assert!(bound > 0.9 * optimum, "bound {bound} is far below {optimum}");
        }
        assert!(excess.iter().all(|&e| e < 0.01), "{width}×{height}, {labels} labels: {excess:?}");
    }
}

#[test]
fn trees_are_solved_exactly_by_messages() {
    // On a chain the bound is tight: tree-reweighted message passing is dynamic programming.
    let mut random = Random::from_seed(13);
    for labels in [2, 3, 5] {
        let grid = random_grid(&mut random, 5, 1, labels);
        let problem = grid.problem();
        let optimum = optimum(&problem);
        assert!((problem.energy(&messages::minimise(&problem, 1, 5)) - optimum).abs() < 1e-5);
        assert!((bound(&problem, 5) - optimum).abs() < 1e-4);
    }
}

#[test]
fn the_bound_of_two_labels_is_their_optimum() {
    for seed in 20..24 {
        let grid = scene_like(seed, 16, 18, 2);
        let problem = grid.problem();
        let (bound, optimum) = (bound(&problem, 500), optimum(&problem));
        assert!((bound / optimum - 1.0).abs() < 1e-5, "{bound} for {optimum}");
        let found = problem.energy(&minimise(&problem, Solver::BEST));
        assert!((found / optimum - 1.0).abs() < 1e-5, "{found} for {optimum}");
    }
}

#[test]
fn two_labels_come_near_their_bound() {
    let seeds = 20..32u32;
    let count = f64::from(seeds.end - seeds.start);
    let excess = seeds.map(|seed| {
        let grid = scene_like(seed.into(), 70, 51, 2);
        let problem = grid.problem();
        let (bound, found) = (bound(&problem, 300), problem.energy(&minimise(&problem, Solver::BEST)));
        assert!(found >= bound - 1e-3, "{found} below the bound {bound}");
        found / bound - 1.0
    });
    let excess = excess.sum::<f64>() / count;
    assert!(excess < 0.005, "{excess}");
}

#[test]
fn no_solver_is_worse_than_descent_and_the_bound_holds() {
    for (seed, labels) in [(1, 2), (2, 4), (3, 7), (4, 11)] {
        let grid = scene_like(seed, 70, 51, labels);
        let problem = grid.problem();
        let cost = |p: usize| move |l: &u8| problem.cost(usize::from(*l), p);
        let cheapest = |p| (0..labels as u8).min_by(|a, b| cost(p)(a).total_cmp(&cost(p)(b))).unwrap();
        let mut descended: Vec<u8> = (0..70 * 51).map(cheapest).collect();
        problem.descend(&mut descended, 50);
        let reference = problem.energy(&descended);
        let bound = bound(&problem, 60);
        for solver in SOLVERS {
            let found = minimise(&problem, solver);
            let energy = problem.energy(&found);
            assert!(energy <= reference, "{solver:?}, {labels} labels: {energy} above {reference}");
            assert!(energy >= bound - 1e-3 * bound.abs(), "{solver:?}: {energy} below the bound {bound}");
            assert_eq!(found, minimise(&problem, solver));
        }
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
            assert!(minimise(&problem, solver).iter().all(|&l| l == 1), "{solver:?} {width}×{height}");
        }
    }
    let costs = vec![Plane::filled(20, 20, 1.0); MAX_LABELS];
    let weight = Plane::filled(20, 20, 1.0);
    let problem = Potts { costs: &costs, horizontal: &weight, vertical: &weight };
    assert_eq!(minimise(&problem, Solver::BEST)[..], [0; 400]);
    assert_eq!(minimise(&Potts { costs: &costs[..1], ..problem }, Solver::BEST)[..], [0; 400]);
}

/// Costs and weights as the pipeline has them, on a generated scene with the true motions: truncated squared residuals over
/// the noise, weights that fall across image edges.
fn scene_costs(seed: u64, width: usize, height: usize, objects: usize) -> Grid {
    let options = scenes::SceneOptions { width, height, objects, seed, ..Default::default() };
    let scene = scenes::generate(&options).unwrap();
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
        let bound = bound(&problem, 100);
        for (solver, most) in [(Solver::LIGHT, 0.005), (Solver::FAST, 0.002), (Solver::BEST, 0.0005)] {
            let excess = problem.energy(&minimise(&problem, solver)) / bound - 1.0;
            assert!(excess < most, "seed {seed}, {solver:?}: {excess:.5} above the bound");
        }
    }
}
