//! Writes docs/masks.md: the scores as a readable page, with the best and the worst cases. Only generated cases have pictures, because
//! the licences of the real pairs do not allow redistribution.

use std::fmt::Write;

use serde_json::{Map, Value};

use crate::ablation::Worth;
use crate::cases::Set;
use crate::measure::Measured;
use crate::outcome::{Method, Outcome};
use crate::summary::Summary;

/// How many of the best and of the worst cases are shown …
const SHOWN: usize = 5;
/// … and of the worst real pairs.
const WORST_REAL: usize = 20;
/// Sets whose pictures belong to the project and whose truth has one label per object.
const OWN: [Set; 4] = [Set::Generated, Set::Colour, Set::Large, Set::Robots];

pub(crate) struct Page<'a> {
    pub(crate) measured: &'a [Measured],
    pub(crate) worths: &'a [Worth],
    /// Explanations of the results, by case name.
    pub(crate) reasons: Map<String, Value>,
    /// The page as it was, with the texts of the steps that are measured by themselves.
    pub(crate) before: &'a str,
}

const HEAD: &str = "\
# Masks

This page measures the masks of `segment_pair` and compares them with a baseline built on OpenCV. All of it is written by

```sh
npm run bench:masks -- --write-docs
```

which measures every case again, and by options of their own for the sensitivity, the stability, the calibration and the neighbouring
motions. Sections are not always measured at the same time: compare figures within one. What a change is worth, `npm run score` says. The
seeds are fixed, so all figures except the times are the same on every machine. The scores are the usual ones for motion segmentation;
experiments/masks/scores.rs defines them and tests/scores.rs checks them:

- **mean IoU**: the mean over all true labels, each matched one to one with a found label;
- **n right**: the share of cases with the right number of motions (labels below 0.2 % of the frame do not count);
- **sub-pixel**: mean IoU of the cases in which objects move by less than a pixel and a half relative to the background;
- **J**: intersection over union of the foreground, computed on *groups*; the foreground is everything except the label with most
  background pixels;
- **J by hand**: the same on single motions, each assigned to foreground or background by the truth, as a user would join them;
- **F**: F measure of the foreground's border within 0.8 % of the diagonal; on single motions for scenes, on groups for real pairs.

*best* and *fast* are the two qualities. The *baseline* computes dense optical flow (OpenCV's DIS, medium preset), fits affine motions
by sequential RANSAC with an inlier threshold from the flow's noise, assigns each pixel to the nearest motion, applies a median
filter and removes small regions. It is the best of several such pipelines, tuned on generated scenes.

";

const LICENCE: &str = "\
The real pairs are frames of [DAVIS 2016](https://davischallenge.org) (taken as CC BY-NC 4.0), [CDnet 2014](http://changedetection.net),
Wallflower, Middlebury, FlyingChairs and Yosemite. Their licences allow research but not redistribution here, so this page shows no
pictures of them. If they are in `../shared/data` next to the checkout, `npm run bench:masks` draws all of them into `out/masks/`. The
one real pair that may be redistributed is [in the README](../README.md); it has no ground truth to score against.

";

/// Markers around the text of a step that is measured by itself.
fn markers(step: &str) -> [String; 2] {
    let begins = format!("<!-- begin {step}: written by npm run bench:masks -- --{step} --write-docs -->");
    [begins, format!("<!-- end {step} -->")]
}

/// The text of a step in a page, without its markers.
fn text_of<'p>(step: &str, page: &'p str) -> Option<&'p str> {
    let [begins, ends] = markers(step);
    Some(page.split_once(&begins)?.1.split_once(&ends)?.0.trim())
}

/// A page with other text of a step.
pub(crate) fn with_text(page: &str, step: &str, text: &str) -> Option<String> {
    let [begins, ends] = markers(step);
    let (before, rest) = page.split_once(&begins)?;
    let (_, after) = rest.split_once(&ends)?;
    Some(format!("{before}{begins}\n{}\n{ends}{after}", text.trim()))
}

/// The head of a table of real pairs.
const REAL_HEAD: &str =
    "| pairs | cases | method | J | J by hand | F | adjusted Rand | ms |\n|---|---|---|---|---|---|---|---|";

/// Which cases a row is about.
type Belongs<'b> = &'b dyn Fn(&Measured) -> bool;

impl Page<'_> {
    /// The page's text. A picture's file name is `prefix` followed by the case's name.
    pub(crate) fn text(&self, prefix: &str) -> String {
        let mut text = String::from(HEAD);
        self.scenes(&mut text);
        self.sequences(&mut text);
        self.pairs(&mut text);
        self.flows(&mut text);
        self.ablation(&mut text);
        self.apart(&mut text, "Sensitivity", "sensitivity");
        self.apart(&mut text, "Stability", "stability");
        self.apart(&mut text, "Calibration of the confidence", "calibration");
        self.apart(&mut text, "Which motions are one thing", "junctions");
        self.pictures(&mut text, prefix);
        self.real_ends(&mut text);
        text.push_str(LICENCE);
        while text.ends_with("\n\n") {
            text.pop();
        }
        text
    }

    /// The cases whose pictures are shown: the best, then the worst.
    pub(crate) fn shown(&self) -> Vec<&Measured> {
        let ranked = self.ranked(|one| OWN.contains(&one.case.set), |best| best.single.map(|s| s.miou));
        let [best, worst] = ends(ranked, [SHOWN; 2]);
        best.into_iter().chain(worst).map(|(one, _)| one).collect()
    }

    fn scenes(&self, text: &mut String) {
        text.push_str("## Generated scenes\n\n");
        let _ = writeln!(
            text,
            "| scenes | cases | method | mean IoU | n right | sub-pixel | F | ms |\n|---|---|---|---|---|---|---|---|"
        );
        let rows = Set::ALL.into_iter().filter(|set| set.is_scene());
        for set in rows {
            self.scene_rows(text, set.title(), &|one| one.case.set == set);
        }
        let own = [Set::Generated, Set::Colour, Set::Large];
        self.scene_rows(text, "**generated, grey and colour, all sizes**", &|one| own.contains(&one.case.set));
        text.push_str(
            "\nTimes are milliseconds of native code on one core of a machine in use, with other cases running on the \
             other cores. The baseline reports its own times. The size at which the motions of large frames are searched was chosen on large \
             scenes like these.\n\n",
        );
    }

    fn scene_rows(&self, text: &mut String, title: &str, belongs: &dyn Fn(&Measured) -> bool) {
        for method in Method::ALL {
            let s = self.summary(method, belongs);
            if s.cases > 0 {
                let (miou, sub) = (three(s.miou), three(s.sub_pixel));
                let (right, f) = (per_cent(s.count_right), three(s.boundary));
                let row = format!("{} | {miou} | {right} | {sub} | {f} | {:.0}", method.name(), s.milliseconds);
                let _ = writeln!(text, "| {title} | {} | {row} |", s.cases);
            }
        }
    }

    fn sequences(&self, text: &mut String) {
        let mut sequences: Vec<&str> = self.of_set(Set::Sequences).map(|one| one.case.sequence()).collect();
        sequences.dedup();
        if sequences.is_empty() {
            return;
        }
        let _ = writeln!(text, "## Real pairs of {} sequences\n", sequences.len());
        let _ = writeln!(text, "{REAL_HEAD}");
        // Pairs of one sequence are alike, so that folds are made of whole sequences.
        let fold = |one: &Measured, rest: usize| {
            sequences.iter().position(|name| *name == one.case.sequence()).is_some_and(|k| k % 2 == rest)
        };
        let folds: [(&str, Belongs<'_>); 3] = [
            ("all", &|one| one.case.set == Set::Sequences),
            ("first fold", &|one| one.case.set == Set::Sequences && fold(one, 0)),
            ("second fold", &|one| one.case.set == Set::Sequences && fold(one, 1)),
        ];
        self.real_rows(text, &folds);
        text.push_str(
            "\nUp to six pairs of each training sequence of DAVIS 2016, as JPEG. The settings were chosen on all of them, so neither fold \
             (every second sequence) is held out; the folds show how much the figures depend on the sequences.\n\n",
        );
    }

    fn real_rows(&self, text: &mut String, parts: &[(&str, Belongs<'_>)]) {
        for (title, belongs) in parts {
            for method in Method::ALL {
                let s = self.summary(method, belongs);
                if s.cases > 0 {
                    let row = [s.j_background, s.j_oracle, s.grouped_boundary, s.rand].map(three).join(" | ");
                    let _ =
                        writeln!(text, "| {title} | {} | {} | {row} | {:.0} |", s.cases, method.name(), s.milliseconds);
                }
            }
        }
    }

    fn pairs(&self, text: &mut String) {
        let names: Vec<&str> = self.of_set(Set::Pairs).map(|one| one.case.name.as_str()).collect();
        if names.is_empty() {
            return;
        }
        text.push_str("## Real pairs with masks\n\n");
        let _ = writeln!(text, "{REAL_HEAD}");
        // Pairs alternate in the order of their names.
        let half = |one: &Measured, rest: usize| {
            names.iter().position(|name| *name == one.case.name).is_some_and(|k| k % 2 == rest)
        };
        let halves: [(&str, Belongs<'_>); 3] = [
            ("all", &|one| one.case.set == Set::Pairs),
            ("first half", &|one| one.case.set == Set::Pairs && half(one, 0)),
            ("second half", &|one| one.case.set == Set::Pairs && half(one, 1)),
        ];
        self.real_rows(text, &halves);
        let odd: Vec<String> = names.iter().step_by(2).map(|name| format!("`{name}`")).collect();
        let _ = writeln!(
            text,
            "\nOnly the main object of each pair has a true mask; everything else that moves counts as background. The `davis_*` pairs, except `davis_car_shadow`, show sequences of the table above, on which the settings were chosen: they are not held out. The first half are {}.\n",
            odd.join(", ")
        );
    }

    fn flows(&self, text: &mut String) {
        if self.of_set(Set::Flow).next().is_none() {
            return;
        }
        text.push_str(
            "## Pairs with true flow\n\nMedian end point error, in pixels, of the optical flow that the labels and motions imply.\n\n",
        );
        let _ = writeln!(text, "| pair | best | fast | baseline |\n|---|---|---|---|");
        for one in self.of_set(Set::Flow) {
            let cell = |method| {
                let error = one.of(method).and_then(|outcome| outcome.flow_error);
                error.map_or("–".into(), |error| format!("{error:.2}"))
            };
            let _ = writeln!(text, "| {} | {} |", one.case.name, Method::ALL.map(cell).join(" | "));
        }
        text.push('\n');
    }

    fn ablation(&self, text: &mut String) {
        let Some(whole) = self.worths.first() else { return };
        let [best, _] = &whole.with;
        let _ = writeln!(
            text,
            "## Ablation\n\nEach row leaves out one part; the change is in brackets. First the {} generated scenes and \
             the {} scenes of cars on bare ground, with *best* unless something else is said.\n\n\
             | without | mean IoU | n right | sub-pixel | F | mean IoU, bare ground | mean IoU, fast |\n\
             |---|---|---|---|---|---|---|",
            best.scenes.cases, best.bare.cases
        );
        for worth in self.worths {
            let ([now, fast], [of_whole, fast_whole]) = (&worth.with, &whole.with);
            let (s, w) = (&now.scenes, &of_whole.scenes);
            let first = std::ptr::eq(worth, whole);
            let cells = [
                changed(s.miou, w.miou, first),
                per_cent(s.count_right),
                changed(s.sub_pixel, w.sub_pixel, first),
                changed(s.boundary, w.boundary, first),
                changed(now.bare.miou, of_whole.bare.miou, first),
                changed(fast.scenes.miou, fast_whole.scenes.miou, first),
            ];
            let _ = writeln!(text, "| {} | {} |", worth.title, cells.join(" | "));
        }
        text.push('\n');
        if let Some(pairs) = &best.pairs {
            let _ = writeln!(
                text,
                "The {} real pairs of sequences, with both qualities:\n\n\
                 | without | J, best | J by hand, best | F, best | J, fast | J by hand, fast | F, fast |\n\
                 |---|---|---|---|---|---|---|",
                pairs.cases
            );
        }
        for worth in self.worths {
            let first = std::ptr::eq(worth, whole);
            let cells = worth.with.iter().zip(&whole.with).filter_map(|(now, of_whole)| {
                let (s, w) = (now.pairs.as_ref()?, of_whole.pairs.as_ref()?);
                let values = [
                    (s.j_background, w.j_background),
                    (s.j_oracle, w.j_oracle),
                    (s.grouped_boundary, w.grouped_boundary),
                ];
                Some(values.map(|(value, of_whole)| changed(value, of_whole, first)).join(" | "))
            });
            let cells: Vec<String> = cells.collect();
            if !cells.is_empty() {
                let _ = writeln!(text, "| {} | {} |", worth.title, cells.join(" | "));
            }
        }
        text.push_str(
            "\nDifferences below about 0.01, and below 0.02 on the real pairs, come from a single object in a few cases and are not \
             significant.\n\n",
        );
    }

    /// What another step has measured, as it was.
    fn apart(&self, text: &mut String, title: &str, step: &str) {
        let [begins, ends] = markers(step);
        let _ = writeln!(text, "## {title}\n\n{begins}\n{}\n{ends}\n", text_of(step, self.before).unwrap_or_default());
    }

    fn pictures(&self, text: &mut String, prefix: &str) {
        let ranked = self.ranked(|one| OWN.contains(&one.case.set), |best| best.single.map(|s| s.miou));
        let [best, worst] = ends(ranked, [SHOWN; 2]);
        for (title, list) in [("The five best scenes", best), ("The five worst scenes", worst)] {
            if list.is_empty() {
                continue;
            }
            let _ = writeln!(
                text,
                "## {title}\n\nFrom left to right: the first frame, our labels (best), the baseline's labels if it ran, the true labels.\n"
            );
            for (one, miou) in list {
                let name = &one.case.name;
                let description = one.case.description();
                let _ = writeln!(text, "**{name}** ({description}): mean IoU {miou:.3}. {}\n", self.reason(name));
                let _ = writeln!(text, "![First frame, labels found and true labels of {name}]({prefix}{name}.png)\n");
            }
        }
    }

    fn real_ends(&self, text: &mut String) {
        let real = |one: &Measured| [Set::Pairs, Set::Sequences].contains(&one.case.set);
        let ranked = self.ranked(real, |best| best.grouped.and_then(|s| s.j_background));
        let [best, worst] = ends(ranked, [SHOWN, WORST_REAL]);
        for (title, list) in [("The five best real pairs", best), ("The twenty worst real pairs", worst)] {
            if list.is_empty() {
                continue;
            }
            let _ =
                writeln!(text, "## {title}\n\n| pair | J | J by hand | baseline's J | why |\n|---|---|---|---|---|");
            for (one, j) in list {
                let by_hand = one.of(Method::Best).and_then(|best| best.single).and_then(|s| s.j_oracle);
                let theirs = one.of(Method::Baseline).and_then(|outcome| outcome.grouped).and_then(|s| s.j_background);
                let [by_hand, theirs] = [by_hand, theirs].map(|j| three(j.unwrap_or(f64::NAN)));
                let name = &one.case.name;
                let _ = writeln!(text, "| `{name}` | {j:.3} | {by_hand} | {theirs} | {} |", self.reason(name));
            }
            text.push('\n');
        }
    }

    fn reason(&self, name: &str) -> &str {
        self.reasons.get(name).and_then(Value::as_str).unwrap_or("Not analysed yet.")
    }

    fn of_set(&self, set: Set) -> impl Iterator<Item = &Measured> {
        self.measured.iter().filter(move |one| one.case.set == set)
    }

    fn summary(&self, method: Method, belongs: &dyn Fn(&Measured) -> bool) -> Summary {
        let own = self.measured.iter().filter(|one| belongs(one));
        Summary::of(own.filter_map(|one| one.of(method).map(|outcome| (&one.case, outcome))))
    }

    /// The cases that `belongs` accepts, sorted by a score of the best quality, largest first.
    fn ranked(
        &self,
        belongs: impl Fn(&Measured) -> bool,
        figure: impl Fn(&Outcome) -> Option<f64>,
    ) -> Vec<(&Measured, f64)> {
        let with_figure = |one| Some((one, Measured::of(one, Method::Best).and_then(&figure)?));
        let mut list: Vec<(&Measured, f64)> =
            self.measured.iter().filter(|one| belongs(one)).filter_map(with_figure).collect();
        list.sort_by(|a, b| b.1.total_cmp(&a.1));
        list
    }
}

/// So many of the first and of the last, the latter in reverse; no case is in both.
fn ends<T>(mut list: Vec<T>, [first, last]: [usize; 2]) -> [Vec<T>; 2] {
    let half = list.len() / 2;
    let mut worst = list.split_off(list.len() - last.min(half));
    worst.reverse();
    list.truncate(first.min(half));
    [list, worst]
}

/// A figure with its change in brackets; alone in the first row.
fn changed(value: f64, of_whole: f64, first: bool) -> String {
    if first { three(value) } else { format!("{} ({:+.3})", three(value), value - of_whole) }
}

fn three(value: f64) -> String {
    if value.is_finite() { format!("{value:.3}") } else { "–".into() }
}

fn per_cent(share: f64) -> String {
    if share.is_finite() { format!("{:.0} %", 100.0 * share) } else { "–".into() }
}
