//! Labels of the working size: solved, thinned out to what pays for itself, corrected for occlusion, split, cleaned.

use super::Work;
use super::hypothesis::Found;
use super::settings::{Part, Settings};
use crate::alignment::cost::{CostModel, cost};
use crate::frame::Plane;
use crate::labelling::appearance::appearance_costs;
use crate::labelling::components::absorb_small;
use crate::labelling::description::{SMALLEST_SHARE, counts, worth};
use crate::labelling::energy::{Borders, label_costs};
use crate::labelling::potts::Solver;
use crate::labelling::splitting::{split_bodies, split_components};
use crate::labelling::visibility::with_visibility;
use crate::motion::AffineMotion;

/// Rounds of visibility.
const VISIBILITY_ROUNDS: usize = 2;
/// A label that came from a split competes only this far around its region, as a share of the root of its pixels …
const REACH_SHARE: f64 = 0.25;
/// … and at least this many pixels.
const SMALLEST_REACH: usize = 12;

/// Motions (pixels of the working size) and the label of each pixel, with what they were decided by.
pub(super) struct Labelled {
    pub(super) motions: Vec<AffineMotion>,
    pub(super) labels: Vec<u8>,
    /// What every motion costs at every pixel, everything considered.
    pub(super) costs: Vec<Plane>,
    pub(super) borders: Borders,
    /// The best motion that is not among them: it did not pay for itself, here or when motions were selected.
    pub(super) left_out: Option<AffineMotion>,
}

/// A labelling in the making: motions, what each costs, who has which pixel.
struct Draft<'a> {
    work: &'a Work,
    settings: &'a Settings,
    borders: Borders,
    motions: Vec<AffineMotion>,
    /// Label costs.
    costs: Vec<Plane>,
    /// Estimation costs, for the description length.
    raw: Vec<Plane>,
    labels: Vec<u8>,
    /// What was taken away last, else what the selection left out.
    left_out: Option<AffineMotion>,
}

pub(super) fn label(work: &Work, found: Found, settings: &Settings) -> Labelled {
    let level = work.finest();
    let mut draft = Draft {
        work,
        settings,
        borders: if settings.has(Part::Edges) {
            Borders::new(&work.picture, level.noise, settings.coherence)
        } else {
            Borders::uniform(level.width(), level.height(), settings.coherence)
        },
        costs: Vec::new(),
        raw: Vec::new(),
        labels: vec![0; level.width() * level.height()],
        motions: found.layers.into_iter().map(|layer| layer.motion).collect(),
        left_out: found.left_out,
    };
    draft.measure();
    draft.solve();
    draft.thin_out();
    draft.see();
    if draft.split() {
        draft.thin_out();
    }
    draft.look();
    draft.finish();
    draft.clean();
    let Draft { motions, labels, costs, borders, left_out, .. } = draft;
    Labelled { motions, labels, costs, borders, left_out }
}

impl Draft<'_> {
    fn size(&self) -> (usize, usize) {
        (self.work.finest().width(), self.work.finest().height())
    }

    /// Costs of all motions.
    fn measure(&mut self) {
        let level = self.work.finest();
        self.raw = self.motions.iter().map(|m| cost(level, m, CostModel::ESTIMATION)).collect();
        self.costs = label_costs(level, &self.motions, self.settings.coherence);
    }

    fn solve(&mut self) {
        self.labels = self.borders.solve(&self.costs, self.settings.coherence.draft_solver);
    }

    /// Adds what the colours say.
    fn look(&mut self) {
        if self.motions.len() < 2 || !self.settings.has(Part::Colour) {
            return;
        }
        let said = appearance_costs(&self.work.palette, &self.costs, &self.labels);
        for (cost, said) in self.costs.iter_mut().zip(said) {
            cost.values_mut().iter_mut().zip(said.values()).for_each(|(c, s)| *c += s);
        }
    }

    /// Solves with care: exactly where there are two labels, close to it otherwise.
    fn finish(&mut self) {
        let solver = match self.motions.len() {
            2 => Solver::Expansion { sweeps: 1 },
            _ => self.settings.coherence.solver,
        };
        self.labels = self.borders.solve(&self.costs, solver);
    }

    /// Takes away the motion that is worth least, while that is less than nothing, and solves again.
    fn thin_out(&mut self) {
        let most = self.settings.most;
        while self.motions.len() > self.settings.least
            && (self.settings.has(Part::ModelSelection) || self.motions.len() > most)
        {
            let worths = worth(&self.raw, &self.labels, self.size().0);
            let Some((weakest, value)) = worths.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)) else { break };
            if *value > 0.0 && self.motions.len() <= most {
                break;
            }
            self.left_out = Some(self.motions[weakest]);
            self.remove(weakest);
            self.solve();
        }
    }

    fn remove(&mut self, k: usize) {
        self.motions.remove(k);
        self.costs.remove(k);
        self.raw.remove(k);
    }

    /// Corrects for occlusion, twice: what is hidden depends on the masks.
    fn see(&mut self) {
        if self.motions.len() < 2 || !self.settings.has(Part::Visibility) {
            return;
        }
        let unhidden = self.costs.clone();
        for _ in 0..VISIBILITY_ROUNDS {
            let departure = self.settings.coherence.departure;
            self.costs = with_visibility(self.work.finest(), &self.motions, &unhidden, &self.labels, departure);
            self.solve();
        }
        self.thin_out();
    }

    /// Splits regions that are several bodies. Returns whether there were any.
    fn split(&mut self) -> bool {
        if self.motions.len() < 2 || self.settings.least > 1 || !self.settings.has(Part::Splitting) {
            return false;
        }
        let level = self.work.finest();
        self.clean();
        let most = self.settings.most + 3;
        let parts = split_components(level, &mut self.motions, &mut self.labels, most);
        let bodies = split_bodies(level, &mut self.motions, &mut self.labels, most);
        if !(parts || bodies) {
            return false;
        }
        self.measure();
        self.restrict();
        let departure = self.settings.coherence.departure;
        self.costs = with_visibility(level, &self.motions, &self.costs, &self.labels, departure);
        self.solve();
        true
    }

    /// Objects compete only near where they are, so that two bodies with like motions do not share their pixels.
    fn restrict(&mut self) {
        let (width, height) = self.size();
        let sizes = counts(&self.labels, self.motions.len());
        for k in 1..self.motions.len() {
            let reach = SMALLEST_REACH.max((REACH_SHARE * (sizes[k] as f64).sqrt()) as usize);
            let near = near_label(&self.labels, k as u8, width, height, reach);
            for (c, near) in self.costs[k].values_mut().iter_mut().zip(near) {
                if !near {
                    *c += CostModel::ESTIMATION.truncation;
                }
            }
        }
    }

    /// Gives small components to what surrounds them, and drops motions without pixels.
    fn clean(&mut self) {
        let (width, height) = self.size();
        let smallest = (SMALLEST_SHARE * (width * height) as f64) as usize;
        absorb_small(&mut self.labels, width, smallest);
        let sizes = counts(&self.labels, self.motions.len());
        let mut next = 0u8;
        let renumbered: Vec<u8> = (0..self.motions.len())
            .map(|k| {
                let number = next;
                if k == 0 || sizes[k] > 0 {
                    next += 1;
                }
                number
            })
            .collect();
        self.labels.iter_mut().for_each(|l| *l = renumbered[usize::from(*l)]);
        for k in (1..sizes.len()).rev() {
            if sizes[k] == 0 {
                self.remove(k);
            }
        }
    }
}

/// Which pixels lie within `reach` (in the larger of both coordinate differences) of a label.
fn near_label(labels: &[u8], label: u8, width: usize, height: usize, reach: usize) -> Vec<bool> {
    let spread = |line: &mut dyn FnMut(usize) -> (bool, usize), length: usize, out: &mut [bool]| {
        let mut last: Option<usize> = None;
        for k in 0..length {
            let (set, p) = line(k);
            if set {
                last = Some(k);
            }
            out[p] |= last.is_some_and(|l| k - l <= reach);
        }
    };
    let mut rows = vec![false; labels.len()];
    for y in 0..height {
        spread(&mut |k| (labels[y * width + k] == label, y * width + k), width, &mut rows);
        spread(&mut |k| (labels[y * width + width - 1 - k] == label, y * width + width - 1 - k), width, &mut rows);
    }
    let mut near = vec![false; labels.len()];
    for x in 0..width {
        spread(&mut |k| (rows[k * width + x], k * width + x), height, &mut near);
        spread(&mut |k| (rows[(height - 1 - k) * width + x], (height - 1 - k) * width + x), height, &mut near);
    }
    near
}
