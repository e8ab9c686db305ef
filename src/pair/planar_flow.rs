//! The distance of the flow of each region from the flow of one plane.
//!
//! A camera that moves before a plane sees the flow
//!
//! ```text
//! u = a₁ + a₂ x + a₃ y + (a₇ x + a₈ y) x,    v = a₄ + a₅ x + a₆ y + (a₇ x + a₈ y) y
//! ```
//! (Longuet-Higgins, "The visual ambiguity of a moving plane", 1984). It is fitted robustly to the flow of the regions at textured points,
//! so that points far from it do not count: receding ground is one plane with several affine motions, and an object is not part of it.

use crate::frame::filter::gaussian;
use crate::linear::Triangle;
use crate::motion::AffineMotion;
use crate::order::median_f64;
use crate::view::level::PairLevel;

/// Number of entries of the flow of a plane.
const ENTRIES: usize = 8;
/// Spacing of the points, pixels.
const STEP: usize = 6;
/// Standard deviation of the window in which texture is measured, pixels.
const WINDOW: f32 = 2.0;
/// Smallest mean squared gradient of textured points, squared grey levels per pixel.
const TEXTURE: f32 = 3.0;
/// Fewest points for which the distance of a region is computed.
const FEWEST: usize = 5;
/// Distance at which the weight of a point has fallen to a quarter, pixels.
const NEAR: f64 = 0.7;
/// The same in the first round; it is halved in every round.
const NEAR_AT_FIRST: f64 = 11.2;
/// Rounds of the fit.
const ROUNDS: usize = 8;

/// A point of a region and its flow.
struct Point {
    region: usize,
    /// From the centre, in widths of the frame.
    place: [f64; 2],
    /// Pixels per frame.
    flow: [f64; 2],
}

/// The median distance of the flow of each region from that of the plane, pixels of the level; `None` where there are too few points.
pub(super) fn distances_to_plane(level: &PairLevel, motions: &[AffineMotion], labels: &[u8]) -> Vec<Option<f64>> {
    let points = points(level, motions, labels);
    let plane = fitted(&points);
    let mut distances = vec![Vec::new(); motions.len()];
    points.iter().for_each(|point| distances[point.region].push(distance(&plane, point)));
    distances.iter_mut().map(|of| median_f64(of).filter(|_| of.len() >= FEWEST)).collect()
}

fn points(level: &PairLevel, motions: &[AffineMotion], labels: &[u8]) -> Vec<Point> {
    let (width, height) = (level.width(), level.height());
    let texture = gaussian(&level.energy, WINDOW);
    let mut points = Vec::new();
    for y in (STEP / 2..height).step_by(STEP) {
        for x in (STEP / 2..width).step_by(STEP).filter(|&x| texture.at(x, y) > TEXTURE) {
            let region = usize::from(labels[y * width + x]);
            let place = [x, y].map(|value| value as f64 / width as f64 - 0.5);
            points.push(Point { region, place, flow: motions[region].flow(x as f64, y as f64) });
        }
    }
    points
}

/// The plane that fits the most points.
fn fitted(points: &[Point]) -> Vec<f64> {
    let mut plane = vec![0.0; ENTRIES];
    for round in 0..ROUNDS {
        let near = (NEAR_AT_FIRST / f64::from(1u32 << round)).max(NEAR);
        let (mut gram, mut right) = (vec![0.0; ENTRIES * ENTRIES], vec![0.0; ENTRIES]);
        for point in points {
            let ratio = if round == 0 { 0.0 } else { distance(&plane, point) / near };
            let weight = 1.0 / ((1.0 + ratio * ratio) * (1.0 + ratio * ratio));
            for (row, value) in rows(point.place).iter().zip(point.flow) {
                for (k, a) in row.iter().enumerate() {
                    right[k] += weight * a * value;
                    row[k..].iter().enumerate().for_each(|(l, b)| gram[(k + l) * ENTRIES + k] += weight * a * b);
                }
            }
        }
        Triangle::of_gram(ENTRIES, gram, RIDGE).solve_normal(&mut right, RIDGE);
        plane = right;
    }
    plane
}

/// Share of each entry's information that is added to it, so that few points suffice.
const RIDGE: f64 = 1e-9;

/// The flow of a plane at a point, (u, v), is linear in its entries: the two rows of coefficients.
fn rows([x, y]: [f64; 2]) -> [[f64; ENTRIES]; 2] {
    [[1.0, x, y, 0.0, 0.0, 0.0, x * x, x * y], [0.0, 0.0, 0.0, 1.0, x, y, x * y, y * y]]
}

fn distance(plane: &[f64], point: &Point) -> f64 {
    let [u, v] = rows(point.place).map(|row| row.iter().zip(plane).map(|(a, b)| a * b).sum::<f64>());
    let [du, dv] = [point.flow[0] - u, point.flow[1] - v];
    (du * du + dv * dv).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Plane;
    use crate::view::level::build;

    #[test]
    fn a_ground_that_recedes_is_one_plane_and_an_object_is_not_of_it() {
        let (width, height) = (160, 120);
        let texture = Plane::from_fn(width, height, |x, y| {
            let (x, y) = (x as f64, y as f64);
            (128.0 + 50.0 * libm::sin(0.7 * x + 0.2 * y) + 40.0 * libm::sin(0.9 * y - 0.3 * x)) as f32
        });
        let level = &build(texture.clone(), texture, 24)[0];
        // A camera turns down: (u, v) = y (x, y)/3600 from the middle, which three strips follow, each with its tangent.
        let strip = |y: f64| {
            let [slope, middle] = [(y - 80.0) / 3600.0, y - 80.0];
            AffineMotion::new([slope, 0.0, -80.0 * slope, 0.0, 2.0 * slope, -slope * (160.0 + middle)])
        };
        let motions = [strip(20.0), strip(60.0), strip(100.0), AffineMotion::translation(3.0, 1.0)];
        let labels: Vec<u8> = (0..width * height)
            .map(|p| match (p % width, p / width) {
                (60..90, 50..80) => 3,
                (_, y) => (y / 40) as u8,
            })
            .collect();
        let distances = distances_to_plane(level, &motions, &labels);
        let distances: Vec<f64> = distances.into_iter().map(|distance| distance.unwrap_or(f64::NAN)).collect();
        let [near, middle, far, object] = distances[..] else { panic!() };
        assert!([near, middle, far].iter().all(|distance| *distance < 0.2), "{near} {middle} {far}");
        assert!(object > 2.0, "{object}");
    }

    #[test]
    fn without_texture_nothing_is_known() {
        let flat = Plane::filled(64, 48, 100.0);
        let level = &build(flat.clone(), flat, 24)[0];
        assert_eq!(distances_to_plane(level, &[AffineMotion::STATIC], &[0; 64 * 48]), [None]);
    }
}
