//! α-expansion (Boykov, Veksler, Zabih, PAMI 23(11), 2001): for one label after another, a minimum cut finds the best set of pixels
//! to switch to it, while the others keep theirs.

use super::max_flow::GridFlow;
use crate::labelling::solver::potts::Potts;

/// At most `sweeps` times over all labels, from `init` or from the cheapest label of every pixel. Exact for two labels.
pub(super) fn minimise(problem: &Potts<'_>, sweeps: usize, init: Option<&[u8]>) -> Vec<u8> {
    let (width, height) = (problem.width(), problem.height());
    let mut flow = GridFlow::new(width, height);
    if problem.costs.len() == 2 {
        // From label 0 everywhere, one expansion of label 1 can reach any labelling.
        return expanded(problem, &mut flow, &vec![0; width * height], 1);
    }
    let mut labels = init.map_or_else(|| problem.cheapest(), <[u8]>::to_vec);
    let mut energy = problem.energy(&labels);
    // Consecutive expansions without a change: after a whole round the labels have converged.
    let mut idle = 0;
    for alpha in (0..problem.costs.len()).cycle().take(sweeps * problem.costs.len()) {
        let candidate = expanded(problem, &mut flow, &labels, alpha as u8);
        let reached = problem.energy(&candidate);
        if reached < energy - 1e-6 * (1.0 + energy.abs()) {
            (labels, energy, idle) = (candidate, reached, 1);
        } else {
            idle += 1;
        }
        if idle >= problem.costs.len() {
            break;
        }
    }
    labels
}

/// The labelling of least energy that differs from `labels` only where it is `alpha`.
///
/// Pixel p is on the source's side if it keeps its label. With A, B, C the price of an edge when both keep theirs, the
/// first keeps, the second keeps: A + (C − A) x_p − C x_q + (B + C − A) (1 − x_p) x_q, the last bracket never negative.
fn expanded(problem: &Potts<'_>, flow: &mut GridFlow, labels: &[u8], alpha: u8) -> Vec<u8> {
    let (width, height) = (problem.width(), problem.height());
    flow.reset();
    for y in 0..height {
        for x in 0..width {
            let p = y * width + x;
            let keep = problem.cost(usize::from(labels[p]), p);
            flow.add_terminal(x, y, problem.cost(usize::from(alpha), p) - keep);
            if x + 1 < width {
                let (first, second, edge) = prices(labels[p], labels[p + 1], alpha, problem.horizontal.values()[p]);
                flow.add_terminal(x, y, first);
                flow.add_terminal(x + 1, y, second);
                flow.set_right(x, y, edge);
            }
            if y + 1 < height {
                let (first, second, edge) = prices(labels[p], labels[p + width], alpha, problem.vertical.values()[p]);
                flow.add_terminal(x, y, first);
                flow.add_terminal(x, y + 1, second);
                flow.set_down(x, y, edge);
            }
        }
    }
    flow.run();
    let mut result = labels.to_vec();
    for y in 0..height {
        for x in 0..width {
            if flow.is_sink_side(x, y) {
                result[y * width + x] = alpha;
            }
        }
    }
    result
}

/// What an edge between labels l and m adds to the terminals of its two ends, and its capacity.
fn prices(l: u8, m: u8, alpha: u8, weight: f32) -> (f32, f32, f32) {
    let price = |different: bool| if different { weight } else { 0.0 };
    let (a, b, c) = (price(l != m), price(l != alpha), price(m != alpha));
    (c - a, -c, (b + c - a).max(0.0))
}
