//! What the figures show of each step, where the paper's fails, and what is rejected. That the methods recover motions is tested with them.

use super::*;
use scenes::protocol::{Protocol, Relation};
use veronese::stages::{CandidateSource, segment_pair_stages};
use veronese::{AffineMotion, Frame, Measurements, MotionCount, Quality, Random, SegmentOptions, segment_pair};

fn is_found(truth: &AffineMotion, found: &[AffineMotion], tolerance: f64) -> bool {
    found.iter().any(|motion| truth.relative_error(motion) < tolerance)
}

/// Points on lines through the origin with the given normals.
fn on_lines(normals: &[[f64; 2]], each: usize) -> Vec<f64> {
    let mut random = Random::from_seed(3);
    let mut points = Vec::new();
    for _ in 0..each {
        for [a, b] in normals {
            let t = random.uniform(-1.0, 1.0);
            points.extend([-b * t, a * t]);
        }
    }
    points
}

#[test]
fn points_on_n_lines_have_a_map_of_rank_n_whose_null_vector_factors_into_them() {
    let normals = [[1.0, 0.0], [0.6, 0.8], [0.0, 1.0], [-0.8, 0.6]];
    for n in 1..=4 {
        let points = on_lines(&normals[..n], 12);
        let map = veronese_map(&points, 2, n).unwrap();
        assert_eq!((map.rows, map.columns, map.rank, map.complex), (12 * n, n + 1, n, 0));
        assert_eq!((map.matrix.len(), map.singular_values.len()), (12 * n * (n + 1), n + 1));
        for row in map.matrix.chunks_exact(map.columns) {
            let value: f64 = row.iter().zip(&map.null_vector).map(|(a, b)| a * b).sum();
            assert!(value.abs() < 1e-12, "{n} lines: {value}");
        }
        assert_eq!(map.lines.len(), n);
        for [a, b] in &normals[..n] {
            let meets = |[p, q]: &[f64; 2]| (a * q - b * p).abs() < 1e-6;
            assert!(map.lines.iter().any(meets), "{n} lines: ({a}, {b}) is not among {:?}", map.lines);
        }
        // A map of a lower degree has full rank.
        if n > 1 {
            assert_eq!(veronese_map(&points, 2, n - 1).unwrap().rank, n);
        }
    }
}

#[test]
fn rows_of_the_map_are_the_monomials_in_order() {
    let map = veronese_map(&[2.0, 3.0, 5.0], 3, 2).unwrap();
    assert_eq!(map.exponents, [[2, 0, 0], [1, 1, 0], [1, 0, 1], [0, 2, 0], [0, 1, 1], [0, 0, 2]]);
    assert_eq!(map.matrix, [4.0, 6.0, 10.0, 9.0, 15.0, 25.0]);
    assert!(map.lines.is_empty());
    let map = veronese_map(&[2.0, 3.0], 2, 3).unwrap();
    assert_eq!(map.matrix, [8.0, 12.0, 18.0, 27.0]);
}

#[test]
fn the_polynomial_of_noise_vanishes_on_its_lines() {
    for seed in 0..40 {
        let mut random = Random::from_seed(seed);
        let points: Vec<f64> = (0..12).map(|_| random.uniform(-1.0, 1.0)).collect();
        for degree in [2, 3, 4] {
            let map = veronese_map(&points, 2, degree).unwrap();
            assert_eq!((map.lines.len() + map.complex, map.complex % 2), (degree, 0));
            // The line ax + by = 0 goes through (−b, a).
            for [a, b] in &map.lines {
                let row = veronese_map(&[-b, *a], 2, degree).unwrap().matrix;
                let value: f64 = row.iter().zip(&map.null_vector).map(|(m, c)| m * c).sum();
                assert!(value.abs() < 1e-12, "degree {degree}, seed {seed}: {value}");
            }
        }
    }
}

#[test]
fn factors_that_are_no_real_lines_are_counted() {
    // x² + y², and (x² + y²) y
    assert_eq!(map::lines(&[1.0, 0.0, 1.0]), (vec![], 2));
    assert_eq!(map::lines(&[0.0, 1.0, 0.0, 1.0]), (vec![[0.0, 1.0]], 2));
}

/// Derivatives of pixels that move by these translations, without noise.
fn of_translations(flows: &[[f64; 2]], each: usize) -> Vec<[f64; 3]> {
    let mut random = Random::from_seed(5);
    let mut derivative = |[u, v]: [f64; 2]| {
        let [ix, iy] = [random.normal(), random.normal()];
        [ix, iy, -ix * u - iy * v]
    };
    (0..each * flows.len()).map(|j| derivative(flows[j % flows.len()])).collect()
}

fn is_flow([u, v]: [f64; 2], found: &[[f64; 2]]) -> bool {
    found.iter().any(|[p, q]| (u - p).abs() < 1e-6 && (v - q).abs() < 1e-6)
}

#[test]
fn translations_are_recovered_by_factoring_and_by_differentiation() {
    let flows = [[1.0, 0.5], [-0.5, -1.0], [0.25, 1.5], [2.0, -2.0]];
    for n in 1..=4 {
        let found = multibody_flow(&of_translations(&flows[..n], 30), n).unwrap();
        assert_eq!(found.coefficients.last(), Some(&1.0));
        assert!(found.singular_values.last().unwrap() < &1e-10);
        for flow in &flows[..n] {
            assert!(is_flow(*flow, &found.factors), "{flow:?} is not among the factors {:?}", found.factors);
            assert!(is_flow(*flow, &found.by_differentiation), "{flow:?} is not in {:?}", found.by_differentiation);
        }
    }
}

#[test]
fn translations_with_the_same_vertical_flow_are_recovered_by_differentiation_only() {
    let flows = [[1.0, 0.5], [-0.5, 0.5]];
    let found = multibody_flow(&of_translations(&flows, 40), 2).unwrap();
    assert!(flows.iter().all(|flow| is_flow(*flow, &found.by_differentiation)), "{:?}", found.by_differentiation);
    assert!(!flows.iter().all(|flow| is_flow(*flow, &found.factors)), "{:?}", found.factors);
}

#[test]
fn generic_motions_are_not_ambiguous_and_both_routes_number_them_alike() {
    for (motions, unknowns) in [(1, 7), (2, 25), (3, 65)] {
        let problem = Protocol::new(motions, 0.0).problem(7);
        let stages = paper_stages(&problem.measurements, MotionCount::Given(motions)).unwrap();
        assert!(!stages.ambiguous, "gaps {:?}, mismatches {:?}", stages.gaps, stages.mismatches);
        assert_eq!((stages.third_columns.len(), stages.gaps.is_some()), (motions, motions > 1));
        assert_eq!(stages.embedded, [600, unknowns]);
        let refined = &stages.fit.refined;
        assert!(problem.motions.iter().all(|truth| is_found(truth, refined, 1e-5)), "{motions} motions");
        assert_eq!(stages.differentiation.len(), motions);
        assert!(refined.iter().zip(&stages.differentiation).all(|(one, other)| one.relative_error(other) < 1e-4));
    }
}

#[test]
fn equal_third_columns_are_ambiguous_for_the_factorisation_and_not_for_differentiation() {
    let [truth, other] = [[0.3, -0.2, 0.4, 0.1, 0.5, -0.3], [-0.4, 0.1, 0.4, 0.6, -0.2, -0.3]].map(AffineMotion::new);
    // Exactly equal only where the third columns are those at the centre of the measurements.
    let mut problem = motion_measurements(&[truth, other], &[1.0, 1.0], 600, 0.0, 4).unwrap();
    let corners = [[-1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [1.0, -1.0]];
    let mut positions = problem.measurements.positions().to_vec();
    let mut derivatives = problem.measurements.derivatives().to_vec();
    for (j, [x, y]) in corners.into_iter().enumerate() {
        let [u, v] = [truth, other][j % 2].flow(x, y);
        positions.push([x, y]);
        derivatives.push([0.5, -0.3, -0.5 * u + 0.3 * v]);
    }
    problem.measurements = Measurements::new(positions, derivatives).unwrap();
    let stages = paper_stages(&problem.measurements, MotionCount::Given(2)).unwrap();
    assert!(stages.ambiguous, "gaps {:?}, mismatches {:?}", stages.gaps, stages.mismatches);
    for motion in [truth, other] {
        assert!(is_found(&motion, &stages.differentiation, 1e-6), "{:?}", stages.differentiation);
    }
}

#[test]
fn equal_shares_are_measured_as_the_protocol_does() {
    for n in 1..=4 {
        let protocol = Protocol::new(n, 0.03).problem(21);
        let motions = &protocol.motions;
        let given = motion_measurements(motions, &vec![0.7; n], 600, 0.03, 9).unwrap();
        assert_eq!(given.labels, protocol.labels);
    }
}

#[test]
fn shares_are_kept_and_points_stay_where_they_are() {
    let motions = [AffineMotion::translation(0.5, 0.1), AffineMotion::translation(-0.5, 0.3)];
    let given = motion_measurements(&motions, &[3.0, 1.0], 400, 0.0, 1).unwrap();
    assert_eq!(given.labels.iter().filter(|label| **label == Some(0)).count(), 300);
    let moved = [motions[0], AffineMotion::translation(-0.6, 0.3)];
    let other = motion_measurements(&moved, &[3.0, 1.0], 400, 0.0, 1).unwrap();
    assert_eq!(given.measurements.positions(), other.measurements.positions());
    for ((x, y), label) in given.measurements.iter().zip(&given.labels) {
        assert!(motions[label.unwrap()].residual(x, y).abs() < 1e-12);
    }
    // A share of nothing gets nothing.
    let given = motion_measurements(&motions, &[0.0, 1.0], 50, 0.0, 1).unwrap();
    assert!(given.labels.iter().all(|label| *label == Some(1)));
}

#[test]
fn a_trial_without_noise_has_no_errors() {
    let trial = figure_1_trial(2, 0.0, 3).unwrap();
    assert_eq!(trial.truth.len(), 2);
    for error in [trial.factorisation, trial.refined, trial.best, trial.oracle] {
        assert!(error.mean < 1e-5 && error.mean <= error.largest, "{error:?}");
    }
    assert!(trial.rule_right && trial.best_right);
    // With noise the oracle is the limit, and the factorisation far from it.
    let trial = figure_1_trial(2, 0.05, 3).unwrap();
    assert!(trial.oracle.mean > 1e-3 && trial.factorisation.mean > trial.oracle.mean);
}

#[test]
fn special_configurations_give_finite_numbers() {
    for relation in [Relation::Static, Relation::Translations, Relation::RankOne, Relation::EqualTranslation] {
        let problem = Protocol { relation, ..Protocol::new(2, 0.01) }.problem(1);
        let stages = paper_stages(&problem.measurements, MotionCount::Given(2)).unwrap();
        let all = [&stages.fit.factorisation, &stages.fit.refined, &stages.differentiation];
        assert!(all.iter().flat_map(|motions| motions.iter()).all(AffineMotion::is_finite), "{relation:?}");
    }
}

#[test]
fn derivatives_are_in_grey_levels() {
    let ramp = |shift: u8| {
        let grey = (0..24).flat_map(|_| 0..32).map(|x: u8| 100 + 4 * x - 4 * shift);
        Frame::from_rgba(32, 24, grey.flat_map(|v| [v, v, v, 255]).collect::<Vec<u8>>()).unwrap()
    };
    let y = grey_derivatives(&ramp(0), &ramp(1)).unwrap();
    assert!((y.x.at(16, 12) - 4.0).abs() < 0.1 && (y.t.at(16, 12) + 4.0).abs() < 0.1);
    let small = Frame::from_rgba(16, 16, vec![0; 4 * 256]).unwrap();
    assert_eq!(grey_derivatives(&ramp(0), &small).unwrap_err().code(), "frame-size-mismatch");
}

/// A textured ground that is still or moves, and squares that move over it.
fn scene([width, height]: [usize; 2], ground: usize, moved: usize) -> Frame {
    let texture = |x: usize, y: usize, seed: usize| ((x * x + 3 * y * y + x * y * seed) % 97 + 60) as u8;
    let at = |x: usize, y: usize| match (x.wrapping_sub(width / 4 + moved), y.wrapping_sub(height / 4)) {
        (a, b) if a < width / 3 && b < height / 3 => texture(a / 3, b / 3, 7),
        _ => texture((x + 300 - ground) / 3, y / 3, 2),
    };
    let rgba: Vec<u8> =
        (0..width * height).flat_map(|p| [at(p % width, p / width); 3].into_iter().chain([255])).collect();
    Frame::from_rgba(width, height, rgba).unwrap()
}

#[test]
fn the_report_of_pair_stages_is_that_of_segment_pair() {
    // Small frames, frames that are halved, and large ones whose detail is solved at a finer size.
    for (size, ground) in [([96, 72], 0), ([96, 72], 2), ([500, 120], 1), ([1000, 70], 2)] {
        let [first, second] = [scene(size, 0, 0), scene(size, ground, 4)];
        for quality in [Quality::Best, Quality::Fast] {
            let options = SegmentOptions::default().with_quality(quality).with_confidence(true).with_mark_unknown(true);
            let stages = segment_pair_stages(&first, &second, &options).unwrap();
            let expected = segment_pair(&first, &second, &options, &mut |_| {}).unwrap();
            assert_eq!(format!("{:?}", stages.result), format!("{expected:?}"), "{size:?}");
        }
    }
}

#[test]
fn pair_stages_agree_with_each_other() {
    let [first, second] = [scene([160, 120], 0, 0), scene([160, 120], 1, 5)];
    let options = SegmentOptions::default().with_motions(MotionCount::Given(2));
    let stages = segment_pair_stages(&first, &second, &options).unwrap();
    let taken = &stages.hypotheses[stages.chosen];
    assert_eq!(stages.result.count, 2);
    // Labels of the working size, upsampled, are those of the report: here the frames are not halved.
    let working = &stages.working;
    assert_eq!([working.grid.width, working.grid.height], [160, 120]);
    assert_eq!((working.grid.scale, working.labels.len()), (1.0, 160 * 120));
    for motion in &stages.result.motions {
        assert!(working.motions.contains(&motion.matrix));
    }
    let (base, pixels) = (taken.base, taken.base.width * taken.base.height);
    for plane in [&taken.residual, &taken.derivatives.x, &taken.derivatives.y, &taken.derivatives.t] {
        assert_eq!((plane.width(), plane.height()), (base.width, base.height));
    }
    // Measurements are pixels of the base level, and their flows are those of the derivatives there.
    let measured = taken.measured.as_ref().unwrap();
    assert_eq!((measured.places.len(), measured.weights.len()), (measured.measurements.len(), measured.places.len()));
    for (place, y) in measured.places.iter().zip(measured.measurements.derivatives()) {
        let [column, row] = place.map(|side| (side / base.scale) as usize);
        let [ix, it] = [&taken.derivatives.x, &taken.derivatives.t].map(|plane| f64::from(plane.at(column, row)));
        let ratio = it * y[0] * base.scale / (measured.unit * ix * y[2]);
        assert!(ix.abs() < 1e-3 || it.abs() < 1e-2 || (ratio - 1.0).abs() < 1e-2, "{ratio}");
    }
    assert!(measured.places.len() <= pixels);
    assert!(taken.candidates.iter().any(|one| matches!(one.source, CandidateSource::Constraint(_))));
    assert!(taken.candidates.iter().any(|one| one.source == CandidateSource::Window));
    assert_eq!(taken.selected[0].matrix, taken.dominant);
    // The pixels of a motion are those that it explains best.
    let selection = &taken.selection;
    for (k, one) in taken.selected.iter().enumerate() {
        assert_eq!(selection.motions[k], one.matrix);
        let own = selection.labels.iter().filter(|&&label| usize::from(label) == k).count();
        assert!((own as f64 / selection.labels.len() as f64 - one.support).abs() < 1e-9);
    }
    assert_eq!(taken.refinement.motions.len(), taken.refined.len());
    assert_eq!(taken.refinement.labels.len(), taken.refinement.grid.width * taken.refinement.grid.height);
    assert!((taken.refined.iter().map(|one| one.support).sum::<f64>() - 1.0).abs() < 1e-9);
    let most = usize::from(*taken.draft.labels.iter().max().unwrap());
    assert!(most < taken.draft.motions.len());
    let mut labels: Vec<u8> = stages.groups.concat();
    labels.sort_unstable();
    assert_eq!(labels, [0, 1]);
}

#[test]
fn differentiation_at_a_pixel_fails_only_where_flows_agree() {
    // Equal third columns: the flows agree at (0, 0), where the paper's factorisation looks.
    let truth = [
        AffineMotion::new([0.0, -0.05, 0.45, -0.25, 0.15, 0.4]),
        AffineMotion::new([-0.2, -0.6, 0.45, -0.35, -0.55, 0.4]),
    ];
    let data = motion_measurements(&truth, &[1.0, 1.0], 600, 0.0, 1).unwrap().measurements;
    for (position, angle) in [([0.5, 0.4], 0.9), ([-0.3, 0.8], 2.0)] {
        let found = motions_at_pixel(&data, 2, position, angle).unwrap();
        assert_eq!((found.coefficients.len(), found.coefficients[2], found.motions.len()), (3, 1.0, 2));
        for motion in &truth {
            assert!(is_found(motion, &found.motions, 1e-9));
            let [u, v] = motion.flow(position[0], position[1]);
            let predicted = -(libm::cos(angle) * u + libm::sin(angle) * v);
            assert!(found.roots.iter().any(|root| (root[0] - predicted).abs() < 1e-9 && root[1] == 0.0));
        }
    }
    let centre = motions_at_pixel(&data, 2, [0.0, 0.0], 0.9).unwrap();
    assert!(!truth.iter().all(|motion| is_found(motion, &centre.motions, 1e-3)));
}

#[test]
fn spectra_are_those_of_the_rank_rule_and_go_on_after_it() {
    let data = Protocol::new(2, 0.0).problem(1).measurements;
    let spectra = embedded_spectra(&data, 4).unwrap();
    let ranks = paper_stages(&data, MotionCount::Auto).unwrap().fit.ranks;
    assert_eq!(ranks.len(), 2);
    for (rank, spectrum) in ranks.iter().zip(&spectra) {
        assert_eq!((rank.motions, rank.rank), (spectrum.motions, spectrum.rank));
        assert_eq!(rank.columns, spectrum.singular_values.len());
    }
    let columns: Vec<usize> = spectra.iter().map(|spectrum| spectrum.singular_values.len()).collect();
    assert_eq!(columns, [7, 25, 65, 140]);
    assert!(spectra[2].rank < 64 && spectra[3].rank < 139);
    // 24 measurements are enough for two motions, and not for three.
    let few = data.subset(&(0..24).collect::<Vec<_>>());
    assert_eq!(embedded_spectra(&few, 4).unwrap().len(), 2);
}

#[test]
fn what_cannot_be_computed_is_an_error_with_a_code() {
    let code = |error: Error| error.code();
    let map = |points: &[f64], variables, degree| veronese_map(points, variables, degree).map_err(code).err();
    for (points, variables, degree) in [(2, 4, 2), (2, 2, 7), (2, 2, 0), (3, 2, 2), (0, 2, 2)] {
        assert_eq!(map(&vec![1.0; points], variables, degree), Some("invalid-option"));
    }
    for unusable in [f64::NAN, 1e13] {
        assert_eq!(map(&[1.0, unusable], 2, 2), Some("not-finite"));
    }
    assert_eq!(multibody_flow(&[[1.0; 3]; 9], 5).map_err(code).err(), Some("invalid-option"));
    assert_eq!(multibody_flow(&[[1.0; 3]; 4], 2).map_err(code).err(), Some("too-few-measurements"));
    assert_eq!(multibody_flow(&[[f64::INFINITY; 3]; 9], 2).map_err(code).err(), Some("not-finite"));
    for (motions, noise) in [(5, 0.0), (2, f64::NAN), (2, 0.06)] {
        assert_eq!(figure_1_trial(motions, noise, 1).map_err(code).err(), Some("invalid-option"));
    }
    let motions = [AffineMotion::STATIC];
    let measured = |shares: &[f64], count, noise| motion_measurements(&motions, shares, count, noise, 1).map_err(code);
    for shares in [&[][..], &[-1.0], &[f64::INFINITY]] {
        assert_eq!(measured(shares, 10, 0.0).err(), Some("invalid-option"));
    }
    assert_eq!(measured(&[1.0], 0, 0.0).err(), Some("invalid-option"));
    assert_eq!(measured(&[1.0], 10, -0.1).err(), Some("invalid-option"));
    let huge = AffineMotion::translation(f64::MAX, 0.0);
    assert_eq!(motion_measurements(&[huge], &[1.0], 10, 0.0, 1).map_err(code).err(), Some("not-finite"));
    let none = Measurements::new(Vec::new(), Vec::new()).unwrap();
    assert_eq!(paper_stages(&none, MotionCount::Auto).map_err(code).err(), Some("too-few-measurements"));
    let at = |motions, x| motions_at_pixel(&none, motions, [x, 0.0], 0.0).map_err(code).err();
    assert_eq!(at(2, 0.0), Some("too-few-measurements"));
    assert_eq!(at(5, 0.0), Some("invalid-option"));
    assert_eq!(at(2, f64::NAN), Some("not-finite"));
    assert_eq!(embedded_spectra(&none, 7).map_err(code).err(), Some("invalid-option"));
    assert!(embedded_spectra(&none, 2).unwrap().is_empty());
    // All the same, and all zero.
    assert!(veronese_map(&[0.0; 12], 2, 2).is_ok());
    assert!(multibody_flow(&[[0.0; 3]; 12], 2).is_ok());
    assert!(multibody_flow(&[[1.0, 0.0, 0.0]; 12], 2).is_ok());
    let same = Measurements::new(vec![[1.0, 1.0]; 30], vec![[0.0; 3]; 30]).unwrap();
    assert!(paper_stages(&same, MotionCount::Given(2)).is_ok());
}
