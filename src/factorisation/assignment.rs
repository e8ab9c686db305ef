//! The linear assignment problem: the cheapest one-to-one assignment of n rows to n columns, in O(n³).

/// For each row of an n × n table of costs, the column assigned to it, such that the sum of the costs is smallest.
///
/// Shortest augmenting paths with potentials (Kuhn, Naval Research Logistics Quarterly 2, 1955; Jonker and Volgenant, Computing 38,
/// 1987). Costs that are not finite, and entries missing in short rows, count as 10⁹⁰.
///
/// ```
/// use veronese::factorisation::assignment::assign;
///
/// assert_eq!(assign(&[vec![1.0, 2.0], vec![1.0, 4.0]]), [1, 0]); // 2 + 1 is less than 1 + 4
/// ```
pub fn assign(costs: &[Vec<f64>]) -> Vec<usize> {
    const FORBIDDEN: f64 = 1e90;
    let n = costs.len();
    let cost = |row: usize, column: usize| match costs[row].get(column) {
        Some(c) if c.is_finite() => c.min(FORBIDDEN),
        _ => FORBIDDEN,
    };
    // Column n is a virtual column, from which each search starts.
    let mut row_of = vec![n; n + 1];
    let mut row_potential = vec![0.0; n + 1];
    let mut column_potential = vec![0.0; n + 1];
    for start in 0..n {
        row_of[n] = start;
        let mut distance = vec![f64::INFINITY; n];
        let mut previous = vec![n; n];
        let mut visited = vec![false; n + 1];
        let mut current = n;
        // Each iteration visits one more column, so n + 1 iterations reach a free one.
        for _ in 0..=n {
            visited[current] = true;
            let row = row_of[current];
            let mut nearest = None;
            for column in (0..n).filter(|&c| !visited[c]) {
                let reduced = cost(row, column) - row_potential[row] - column_potential[column];
                if reduced < distance[column] {
                    distance[column] = reduced;
                    previous[column] = current;
                }
                if nearest.is_none_or(|best: usize| distance[column] < distance[best]) {
                    nearest = Some(column);
                }
            }
            let Some(next) = nearest else { break };
            let step = distance[next];
            for column in 0..=n {
                if visited[column] {
                    row_potential[row_of[column]] += step;
                    column_potential[column] -= step;
                } else {
                    distance[column] -= step;
                }
            }
            current = next;
            if row_of[current] == n {
                break;
            }
        }
        while current != n {
            let before = previous[current];
            row_of[current] = row_of[before];
            current = before;
        }
    }
    let mut column_of = vec![0; n];
    for column in 0..n {
        if row_of[column] < n {
            column_of[row_of[column]] = column;
        }
    }
    column_of
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    fn smallest_sum(costs: &[Vec<f64>], row: usize, used: &mut Vec<bool>) -> f64 {
        if row == costs.len() {
            return 0.0;
        }
        let mut best = f64::INFINITY;
        for column in 0..costs.len() {
            if !used[column] {
                used[column] = true;
                best = best.min(costs[row][column] + smallest_sum(costs, row + 1, used));
                used[column] = false;
            }
        }
        best
    }

    #[test]
    fn the_assignment_is_as_cheap_as_the_best_permutation() {
        let mut random = Random::from_seed(8);
        for trial in 0..60 {
            let n = 1 + trial % 6;
            // Small integers give many ties.
            let costs: Vec<Vec<f64>> = (0..n).map(|_| (0..n).map(|_| random.below(5) as f64 - 1.0).collect()).collect();
            let chosen = assign(&costs);
            let mut sorted = chosen.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, (0..n).collect::<Vec<_>>());
            let sum: f64 = chosen.iter().enumerate().map(|(row, &column)| costs[row][column]).sum();
            assert_eq!(sum, smallest_sum(&costs, 0, &mut vec![false; n]));
        }
    }

    #[test]
    fn costs_that_are_not_numbers_still_give_a_permutation() {
        let mut chosen = assign(&[vec![f64::NAN, f64::INFINITY, 1.0], vec![f64::NAN; 3], vec![0.0, f64::NAN, 0.0]]);
        chosen.sort_unstable();
        assert_eq!(chosen, [0, 1, 2]);
    }
}
