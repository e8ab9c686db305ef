//! How well labels that last through time agree with the truth.
//!
//! In the truth 0 is the background, [`VOID`] is not known and left out everywhere, every other number is an object. In what was found
//! every number is a label, and [`VOID`] is none. The background label is the label with most pixels of the whole clip.

use veronese::factorisation::assignment::assign;

use crate::boundary::Grid;

/// "Not known" in the truth, "no label" in what was found.
pub const VOID: u8 = 255;
/// Least IoU of an object and the label that carries it in a frame.
const CARRIES: f64 = 0.25;
/// Least IoU of a detection with its object.
const DETECTS: f64 = 0.5;
/// Least share of the frame of a detection.
const SMALLEST_DETECTION: f64 = 0.0005;
/// Least share of some frame of a label that is counted.
const SMALLEST_LABEL: f64 = 0.002;

/// The figures of the labels of a clip. J is the mean over all frames of the IoU of the foreground (all objects as one), 1 where true
/// and found foreground are empty; F is that of its border, within 0.8 % of the diagonal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scores {
    /// J of everything but the background label: no truth is used.
    pub j_auto: f64,
    /// J of the one label that fits best over the whole clip: what one click gives.
    pub j_track: f64,
    /// J of the union of labels that fits best, chosen once: what some clicks give.
    pub j_tracks: f64,
    /// J of the best union in every frame: how good labels are if time does not matter.
    pub j_oracle: f64,
    /// F of the foreground of `j_auto` and of `j_tracks`; none where the truth is unknown along all borders.
    pub f_auto: Option<f64>,
    pub f_tracks: Option<f64>,
    /// The figures of single objects; none if the truth has no object.
    pub identities: Option<Identities>,
    /// Number of labels that cover 0.2 % of some frame, the background label included.
    pub label_count: usize,
    /// Number of true objects.
    pub object_count: usize,
}

/// How objects and labels go together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Identities {
    /// Mean over the objects of the mean IoU with the label assigned to each, one to one for the whole clip (DAVIS 2017).
    pub assigned: f64,
    /// How often the label that carries an object changes, per object and 30 frames. A label carries an object if its IoU is the
    /// largest and at least 0.25; the background label carries nothing.
    pub switches: f64,
    /// Share of the frames with an object in sight in which no label carries it.
    pub lost: f64,
    /// 2 IDTP / (2 IDTP + IDFP + IDFN) at an IoU of 0.5; labels under 0.05 % of the frame are no detections (Ristani et al. 2016).
    pub idf1: f64,
}

/// Pixels of one frame by true object (row 0 is the background) and label (the last column is no label).
type Counts = Vec<[usize; 256]>;

/// What objects and labels have in common, frame by frame.
struct Contingency {
    frames: Vec<Counts>,
    /// The labels that occur.
    labels: Vec<usize>,
    /// The label of the background.
    background: Option<usize>,
}

/// Pixels in common, pixels of a label.
#[derive(Clone, Copy)]
struct Common {
    inside: usize,
    size: usize,
}

fn overlap(inside: usize, a: usize, b: usize) -> f64 {
    let union = a + b - inside;
    if union == 0 { 1.0 } else { inside as f64 / union as f64 }
}

impl Contingency {
    fn new(truths: &[Vec<u8>], found: &[Vec<u8>]) -> Contingency {
        let mut objects: Vec<u8> = Vec::new();
        for truth in truths {
            let mut seen = [false; 256];
            truth.iter().for_each(|&object| seen[usize::from(object)] = true);
            objects.extend((1..VOID).filter(|&object| seen[usize::from(object)]));
        }
        objects.sort_unstable();
        objects.dedup();
        let mut row = [0usize; 256];
        objects.iter().enumerate().for_each(|(k, &object)| row[usize::from(object)] = k + 1);
        let count = |(truth, found): (&Vec<u8>, &Vec<u8>)| {
            let mut counts = vec![[0usize; 256]; objects.len() + 1];
            for (&object, &label) in truth.iter().zip(found).filter(|&(&object, _)| object != VOID) {
                counts[row[usize::from(object)]][usize::from(label)] += 1;
            }
            counts
        };
        let frames: Vec<Counts> = truths.iter().zip(found).map(count).collect();
        let mut all = Contingency { frames, labels: (0..usize::from(VOID)).collect(), background: None };
        let sizes: Vec<usize> = all.labels.iter().map(|&label| all.whole(label).size).collect();
        all.labels.retain(|&label| sizes[label] > 0);
        // The first of equals.
        all.background = all.labels.iter().copied().reduce(|a, b| if sizes[b] > sizes[a] { b } else { a });
        all
    }

    fn objects(&self) -> usize {
        self.frames.first().map_or(0, |counts| counts.len() - 1)
    }

    fn in_frame(&self, t: usize, label: usize) -> Common {
        let size = self.area(t, label);
        Common { inside: size - self.frames[t][0][label], size }
    }

    fn whole(&self, label: usize) -> Common {
        let all = (0..self.frames.len()).map(|t| self.in_frame(t, label));
        all.fold(Common { inside: 0, size: 0 }, |a, b| Common { inside: a.inside + b.inside, size: a.size + b.size })
    }

    /// Pixels of a label.
    fn area(&self, t: usize, label: usize) -> usize {
        self.frames[t].iter().map(|row| row[label]).sum()
    }

    /// Pixels of an object, from 1.
    fn extent(&self, t: usize, object: usize) -> usize {
        self.frames[t][object].iter().sum()
    }

    /// Pixels of all objects.
    fn foreground(&self, t: usize) -> usize {
        (1..=self.objects()).map(|object| self.extent(t, object)).sum()
    }

    /// Mean IoU of the foreground with the labels that `chosen` gives for every frame.
    fn j(&self, chosen: impl Fn(usize) -> Vec<usize>) -> f64 {
        let of_frame = |t: usize| {
            let parts = chosen(t).into_iter().map(|label| self.in_frame(t, label));
            let (inside, size) = parts.fold((0, 0), |(inside, size), part| (inside + part.inside, size + part.size));
            overlap(inside, size, self.foreground(t))
        };
        (0..self.frames.len()).map(of_frame).sum::<f64>() / self.frames.len() as f64
    }

    /// The union of labels with the largest IoU with a region of `truth` pixels. The IoU of a union is Σ inside / (truth + Σ outside):
    /// the best one is a prefix of the labels in the order of their precision.
    fn best_union(&self, of: impl Fn(usize) -> Common, truth: usize) -> Vec<usize> {
        let mut order: Vec<(usize, Common)> = self.labels.iter().map(|&label| (label, of(label))).collect();
        order.retain(|(_, part)| part.inside > 0);
        order.sort_by(|(_, a), (_, b)| (b.inside * a.size).cmp(&(a.inside * b.size)));
        let (mut inside, mut outside, mut best, mut length) = (0, 0, 0.0, 0);
        for (k, (_, part)) in order.iter().enumerate() {
            inside += part.inside;
            outside += part.size - part.inside;
            let value = inside as f64 / (truth + outside) as f64;
            if value > best {
                (best, length) = (value, k + 1);
            }
        }
        order[..length].iter().map(|(label, _)| *label).collect()
    }

    fn identities(&self, pixels: usize) -> Option<Identities> {
        let (objects, count) = (self.objects(), self.frames.len());
        if objects == 0 {
            return None;
        }
        let iou = |t: usize, object: usize, label: usize| {
            overlap(self.frames[t][object][label], self.extent(t, object), self.area(t, label))
        };
        let mean = |object: usize, label: usize| (0..count).map(|t| iou(t, object, label)).sum::<f64>() / count as f64;
        // An object without a label of its own is right where it is out of sight.
        let alone = |object: usize| (0..count).filter(|&t| self.extent(t, object) == 0).count() as f64 / count as f64;
        let assigned = self.best_sum(alone, mean) / objects as f64;

        let (mut switches, mut lost, mut seen) = (0, 0, 0);
        for object in 1..=objects {
            let mut carrier = None;
            for t in (0..count).filter(|&t| self.extent(t, object) > 0) {
                seen += 1;
                let mut best: Option<(usize, f64)> = None;
                for &label in
                    self.labels.iter().filter(|&&label| Some(label) != self.background && self.area(t, label) > 0)
                {
                    let value = iou(t, object, label);
                    if best.is_none_or(|(_, most)| value > most) {
                        best = Some((label, value));
                    }
                }
                match best.filter(|&(_, value)| value >= CARRIES) {
                    None => lost += 1,
                    Some((label, _)) => {
                        switches += usize::from(carrier.is_some_and(|before| before != label));
                        carrier = Some(label);
                    }
                }
            }
        }

        let detected = |t: usize, label: usize| {
            Some(label) != self.background && self.area(t, label) as f64 >= SMALLEST_DETECTION * pixels as f64
        };
        let hit = |t: usize, object: usize, label: usize| {
            self.extent(t, object) > 0 && detected(t, label) && iou(t, object, label) >= DETECTS
        };
        let hits = |object: usize, label: usize| (0..count).filter(|&t| hit(t, object, label)).count() as f64;
        let right = self.best_sum(|_| 0.0, hits);
        let detections: usize =
            (0..count).map(|t| self.labels.iter().filter(|&&label| detected(t, label)).count()).sum();
        Some(Identities {
            assigned,
            switches: switches as f64 / objects as f64 * 30.0 / count as f64,
            lost: lost as f64 / seen.max(1) as f64,
            idf1: 2.0 * right / (seen + detections).max(1) as f64,
        })
    }

    /// The largest sum of `value(object, label)` over one-to-one assignments, an object without a label counting `alone(object)`.
    fn best_sum(&self, alone: impl Fn(usize) -> f64, value: impl Fn(usize, usize) -> f64) -> f64 {
        let objects = self.objects();
        // Behind the labels a place without one for each object, and rows that take what is left.
        let size = self.labels.len() + objects;
        let row = |object: usize| {
            let labels = self.labels.iter().map(|&label| -value(object, label));
            labels.chain(std::iter::repeat_n(-alone(object), objects)).collect()
        };
        let mut costs: Vec<Vec<f64>> = (1..=objects).map(row).collect();
        costs.resize(size, vec![0.0; size]);
        -assign(&costs).into_iter().enumerate().map(|(row, place)| costs[row][place]).sum::<f64>()
    }
}

/// All figures of labels of frames `width` pixels wide. `truths` and `found` have the same frames, at least one.
pub fn scores(truths: &[Vec<u8>], found: &[Vec<u8>], width: usize) -> Scores {
    let all = Contingency::new(truths, found);
    let count = all.frames.len();
    let pixels = truths.first().map_or(0, Vec::len);
    let foreground: usize = (0..count).map(|t| all.foreground(t)).sum();
    let moving: Vec<usize> = all.labels.iter().copied().filter(|&label| Some(label) != all.background).collect();
    let fit = |label: usize| {
        let Common { inside, size } = all.whole(label);
        overlap(inside, size, foreground)
    };
    let track = all.labels.iter().copied().reduce(|a, b| if fit(b) > fit(a) { b } else { a });
    let tracks = all.best_union(|label| all.whole(label), foreground);
    let f = |labels: &[usize]| {
        let of_frame = |(truth, found): (&Vec<u8>, &Vec<u8>)| border(truth, found, labels, width);
        let values: Vec<f64> = truths.iter().zip(found).filter_map(of_frame).collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    };
    let large = |label: &&usize| (0..count).any(|t| all.area(t, **label) as f64 >= SMALLEST_LABEL * pixels as f64);
    Scores {
        j_auto: all.j(|_| moving.clone()),
        j_track: all.j(|_| track.into_iter().collect()),
        j_tracks: all.j(|_| tracks.clone()),
        j_oracle: all.j(|t| all.best_union(|label| all.in_frame(t, label), all.foreground(t))),
        f_auto: f(&moving),
        f_tracks: f(&tracks),
        identities: all.identities(pixels),
        label_count: all.labels.iter().filter(large).count(),
        object_count: all.objects(),
    }
}

/// F of the border of the foreground against that of these labels.
fn border(truth: &[u8], found: &[u8], labels: &[usize], width: usize) -> Option<f64> {
    let known: Vec<bool> = truth.iter().map(|&object| object != VOID).collect();
    let mut chosen = [false; 256];
    labels.iter().for_each(|&label| chosen[label] = true);
    let objects: Vec<i16> = truth.iter().map(|&object| i16::from(object != 0 && object != VOID)).collect();
    let masks: Vec<i16> =
        found.iter().zip(&known).map(|(&label, &known)| i16::from(known && chosen[usize::from(label)])).collect();
    // Two masks without a border are everything or nothing.
    let uniform = |mask: &[i16]| mask.iter().all(|&m| m == mask[0]);
    if uniform(&objects) && uniform(&masks) {
        return Some(f64::from(u8::from(objects == masks)));
    }
    Grid { width, known: &known }.boundary(&objects, &masks)
}
