//! Clustering of flows and positions: Lloyd's k-means with farthest-first initialisation.

/// A point: flow and position, in comparable units.
pub(super) type Point = [f64; 4];

/// A safeguard: clusters settle sooner.
const MAX_ITERATIONS: usize = 30;

fn distance(a: &Point, b: &Point) -> f64 {
    a.iter().zip(b).map(|(p, q)| (p - q) * (p - q)).sum()
}

/// The group of every point, below `groups`.
pub(super) fn k_means(points: &[Point], groups: usize) -> Vec<usize> {
    let mut centres = farthest_first(points, groups);
    let mut assignment = vec![0; points.len()];
    for _ in 0..MAX_ITERATIONS {
        let mut changed = false;
        // Sum and number of the points of each group.
        let mut sums = vec![([0.0; 4], 0.0); centres.len()];
        for (slot, point) in assignment.iter_mut().zip(points) {
            let mut nearest = (f64::INFINITY, 0);
            for (k, centre) in centres.iter().enumerate() {
                let d = distance(point, centre);
                if d < nearest.0 {
                    nearest = (d, k);
                }
            }
            changed |= *slot != nearest.1;
            *slot = nearest.1;
            let (sum, count) = &mut sums[nearest.1];
            sum.iter_mut().zip(point).for_each(|(s, p)| *s += p);
            *count += 1.0;
        }
        for (centre, (sum, count)) in centres.iter_mut().zip(sums) {
            if count > 0.0 {
                *centre = sum.map(|s| s / count);
            }
        }
        if !changed {
            break;
        }
    }
    assignment
}

/// Starts at the mean; each further centre is the point farthest from all earlier ones.
fn farthest_first(points: &[Point], groups: usize) -> Vec<Point> {
    let count = points.len().max(1) as f64;
    let mut mean = [0.0; 4];
    for point in points {
        mean.iter_mut().zip(point).for_each(|(m, p)| *m += p / count);
    }
    let mut centres = vec![mean];
    let mut nearest: Vec<f64> = points.iter().map(|p| distance(p, &mean)).collect();
    while centres.len() < groups {
        let Some((farthest, _)) = nearest.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)) else { break };
        let centre = points[farthest];
        nearest.iter_mut().zip(points).for_each(|(n, p)| *n = n.min(distance(p, &centre)));
        centres.push(centre);
    }
    centres
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn separated_groups_are_found() {
        let mut points = Vec::new();
        for k in 0..30 {
            let e = 0.01 * f64::from(k % 7);
            points.push([e, 0.0, e, 0.0]);
            points.push([3.0 + e, 1.0, 0.0, e]);
            points.push([-2.0, 4.0 + e, 0.0, 0.0]);
        }
        let assignment = k_means(&points, 3);
        assert_ne!(assignment[0], assignment[1]);
        assert_ne!(assignment[1], assignment[2]);
        for (k, group) in assignment.iter().enumerate() {
            assert_eq!(*group, assignment[k % 3]);
        }
    }

    #[test]
    fn fewer_points_than_groups_is_fine() {
        assert_eq!(k_means(&[[1.0; 4]], 5).len(), 1);
        assert!(k_means(&[], 3).is_empty());
    }
}
