//! Writes docs/clips.md: the figures as a readable page, with strips of the best and the worst clips. Only generated clips have
//! pictures, because the licence of the real ones does not allow redistribution here.

use std::fmt::Write;

use scenes::Event;

use crate::cases::word;
use crate::figures::{FIGURES, mean};
use crate::measure::{Measured, Outcome};
use crate::methods::Method;

/// How many of the best and of the worst clips are shown.
const SHOWN: usize = 3;

const HEAD: &str = "\
# Clips

This page measures labels that persist through time: an object should have one label in all frames of a clip. All of it is written by

```sh
npm run bench:clips -- --ablation --write-docs
```

which measures every clip again. The seeds are fixed, so all figures of ours except the times are the same on every machine.
experiments/clips/scores.rs defines the figures and tests/clip_scores.rs checks them. The *background label* is the label with most
pixels of the clip.

- **auto**: J (intersection over union of the foreground, all objects as one, mean over the frames) of everything but the background
  label; no truth is used;
- **one click**: J of the one label that fits best over the whole clip;
- **tracks**: J of the best union of labels, chosen once for the clip, as some clicks give it;
- **oracle**: J of the best union in every frame, a bound where time does not matter;
- **F auto**, **F tracks**: F measure of the foreground's border within 0.8 % of the diagonal;
- **assigned**: mean IoU of every object with a label of its own for the whole clip, assigned one to one;
- **switches**: how often the label that carries an object changes, per object and 30 frames;
- **lost**: share of the frames with an object in sight in which no label carries it;
- **IDF1**: F measure of detections with the right identity, at an IoU of 0.5;
- **n right**: share of clips with the right number of labels (labels below 0.2 % of every frame do not count).

Nothing on this page is held out: the constants of clips were set on the ten real clips, and the generated ones were looked at while
identities were made.

*clip* is the clip segmenter on the whole clip, *stream* has its frames once and waits for four or none. *pair by pair* segments each
frame with the next by `segment_pair` and takes its groups; a mask keeps its number if, carried along its motions, it overlaps a mask of the next frame (IoU of 0.1, best first). The peers are OpenCV's, in
experiments/clips/peers.py: dense flow (DIS) with one affine background motion by RANSAC and Otsu's threshold of what differs from
it, and the background subtractors MOG2 and KNN; their connected regions are linked in the same way.

";

const REAL: &str = "\
The real clips are ten training sequences of [DAVIS 2016](https://davischallenge.org), 32 frames each, taken as CC BY-NC 4.0; this page
shows no pictures of them. Their truth has one object: other things that move count as background, so that a right number of labels
means little and is left out. They are measured if they are in `../shared/data/clips` next to the checkout.

";

pub(crate) struct Page<'a> {
    pub(crate) measured: &'a [Measured],
}

impl Page<'_> {
    /// The page's text. A picture's file name is `prefix` followed by the clip's name.
    pub(crate) fn text(&self, prefix: &str) -> String {
        let mut text = String::from(HEAD);
        let count = self.generated().count();
        if count > 0 {
            let _ =
                writeln!(text, "## Generated clips\n\n{count} clips of 320 × 240 pixels, 32 frames, 48 with a cut.\n");
            self.means(&mut text, true);
            self.events(&mut text);
            self.clips(&mut text);
            self.strips(&mut text, prefix);
        }
        if self.measured.iter().any(|one| !one.case.is_generated()) {
            text.push_str("## Real clips\n\n");
            self.means(&mut text, false);
            self.real(&mut text);
            text.push_str(REAL);
        }
        self.ablation(&mut text);
        text.truncate(text.trim_end().len());
        text.push('\n');
        text
    }

    /// The clips whose strips are shown: the best, then the worst.
    pub(crate) fn shown(&self) -> Vec<&Measured> {
        let [best, worst] = self.ends();
        best.into_iter().chain(worst).collect()
    }

    fn generated(&self) -> impl Iterator<Item = &Measured> {
        self.measured.iter().filter(|one| one.case.is_generated())
    }

    fn means(&self, text: &mut String, generated: bool) {
        const TITLES: [(&str, &str); 10] = [
            ("auto", "j_auto"),
            ("one click", "j_track"),
            ("tracks", "j_tracks"),
            ("oracle", "j_oracle"),
            ("F auto", "f_auto"),
            ("F tracks", "f_tracks"),
            ("assigned", "assigned"),
            ("switches", "switches"),
            ("lost", "lost"),
            ("IDF1", "idf1"),
        ];
        let last = if generated { "n right | labels | ms" } else { "labels | ms" };
        let titles = TITLES.map(|(title, _)| title).join(" | ");
        let columns = TITLES.len() + last.split('|').count() + 1;
        let _ = writeln!(text, "| method | {titles} | {last} |\n|{}", "---|".repeat(columns));
        for method in Method::ALL {
            let own = || -> Vec<&Outcome> {
                let clips = self.measured.iter().filter(|one| one.case.is_generated() == generated);
                clips.filter_map(|one| one.of(method)).collect()
            };
            let outcomes = own();
            if outcomes.is_empty() {
                continue;
            }
            let of = |name: &str| {
                let figure = FIGURES.iter().find(|(other, _)| *other == name);
                figure.map_or(f64::NAN, |(_, figure)| mean(outcomes.iter().copied(), *figure))
            };
            let cells =
                TITLES.map(|(_, name)| if name == "switches" { number(of(name), 2) } else { number(of(name), 3) });
            let right = if generated { format!("{} % | ", number(100.0 * of("n_right"), 0)) } else { String::new() };
            let last = [number(of("n_labels"), 1), number(of("milliseconds"), 0)].join(" | ");
            let _ = writeln!(text, "| {} | {} | {right}{last} |", method.title(), cells.join(" | "));
        }
        text.push_str(
            "\nSwitches are per object and 30 frames; times are milliseconds per frame of native code on one core of a machine in use, with \
             other clips running on the other cores: only large differences mean something.\n\n",
        );
    }

    /// The clip segmenter without each of its parts, if that was measured.
    fn ablation(&self, text: &mut String) {
        let there = |method: &Method| self.measured.iter().any(|one| one.of(*method).is_some());
        let methods: Vec<Method> = Method::ablations().filter(there).collect();
        if methods.is_empty() {
            return;
        }
        text.push_str(
            "## What each part is worth\n\nThe clip segmenter without one of its parts, on the real clips and every fourth of the generated ones.\n\n| | generated clips: auto | assigned | switches | \
             n right | real clips: auto | one click | tracks | F tracks | switches |\n|---|---|---|---|---|---|---|---|---|---|\n",
        );
        for method in [Method::Clip].into_iter().chain(methods) {
            let of = |generated: bool, name: &str, digits: usize| {
                let clips = self.measured.iter().filter(|one| one.case.in_ablation);
                let clips = clips.filter(|one| one.case.is_generated() == generated);
                let figure = FIGURES.iter().find(|(other, _)| *other == name);
                let value = figure.map(|(_, figure)| mean(clips.filter_map(|one| one.of(method)), *figure));
                number(value.unwrap_or(f64::NAN), digits)
            };
            let generated = ["j_auto", "assigned"].map(|name| of(true, name, 3)).join(" | ");
            let real = ["j_auto", "j_track", "j_tracks", "f_tracks"].map(|name| of(false, name, 3)).join(" | ");
            let (switches, right) = ([true, false].map(|of_| of(of_, "switches", 2)), of(true, "n_right", 2));
            let [first, second] = switches;
            let _ = writeln!(text, "| {} | {generated} | {first} | {right} | {real} | {second} |", method.title());
        }
        text.push('\n');
    }

    /// The methods whose figures of single clips are shown.
    fn own(&self) -> Vec<Method> {
        let there = |method: &Method| self.measured.iter().any(|one| one.of(*method).is_some());
        [Method::Clip, Method::Pairs, Method::Flow].into_iter().filter(there).collect()
    }

    fn events(&self, text: &mut String) {
        let methods = self.own();
        let heads: Vec<String> =
            methods.iter().map(|method| format!("{0}: auto | assigned | switches", method.title())).collect();
        let _ = writeln!(
            text,
            "### By event\n\nMeans over the clips with an event, which most have others too.\n\n| event | clips | {} |\n|{}",
            heads.join(" | "),
            "---|".repeat(2 + 3 * methods.len())
        );
        for event in Event::ALL {
            let clips: Vec<&Measured> = self.generated().filter(|one| one.case.has(event)).collect();
            if clips.is_empty() {
                continue;
            }
            let cells: Vec<String> = methods
                .iter()
                .map(|&method| {
                    let outcomes: Vec<&Outcome> = clips.iter().filter_map(|one| one.of(method)).collect();
                    three_figures(&outcomes)
                })
                .collect();
            let _ = writeln!(text, "| {} | {} | {} |", word(event), clips.len(), cells.join(" | "));
        }
        text.push('\n');
    }

    fn clips(&self, text: &mut String) {
        let methods = self.own();
        let heads: Vec<String> =
            methods.iter().map(|method| format!("{0}: auto | assigned | switches", method.title())).collect();
        let _ = writeln!(
            text,
            "### By clip\n\n| clip | objects | {} |\n|{}",
            heads.join(" | "),
            "---|".repeat(2 + 3 * methods.len())
        );
        for one in self.generated() {
            let objects = one.own().map_or(0, |outcome| outcome.scores.object_count);
            let cells: Vec<String> = methods.iter().map(|&method| three_figures(one.of(method).as_slice())).collect();
            let _ = writeln!(text, "| {} | {objects} | {} |", one.case.name, cells.join(" | "));
        }
        text.push_str(
            "\nA name has the seed and the events: *stop* is stop and go, *hidden* hidden by the background, *covered* hidden by another \
             object, *limbs* an articulated object; *plain* has none.\n\n",
        );
    }

    fn real(&self, text: &mut String) {
        let methods = self.own();
        let heads: Vec<String> = methods
            .iter()
            .map(|method| format!("{0}: auto | one click | tracks | switches | lost", method.title()))
            .collect();
        let _ = writeln!(text, "| clip | {} |\n|{}", heads.join(" | "), "---|".repeat(1 + 5 * methods.len()));
        for one in self.measured.iter().filter(|one| !one.case.is_generated()) {
            let cells = |&method: &Method| match one.of(method) {
                Some(Outcome { scores, .. }) => {
                    let (switches, lost) = scores.identities.map_or((f64::NAN, f64::NAN), |i| (i.switches, i.lost));
                    let [auto, track, tracks] = [scores.j_auto, scores.j_track, scores.j_tracks].map(|j| number(j, 3));
                    [auto, track, tracks, number(switches, 1), number(lost, 2)].join(" | ")
                }
                None => ["–"; 5].join(" | "),
            };
            let _ =
                writeln!(text, "| {} | {} |", one.case.name, methods.iter().map(cells).collect::<Vec<_>>().join(" | "));
        }
        text.push('\n');
    }

    fn strips(&self, text: &mut String, prefix: &str) {
        let [best, worst] = self.ends();
        let method = self.own().first().map_or("", |method| method.title());
        for (title, list) in [("best", best), ("worst", worst)] {
            if list.is_empty() {
                continue;
            }
            let _ = writeln!(
                text,
                "### The {title} clips\n\nBy *assigned*. Every fourth frame; above the frames, in the middle the labels of *{method}*, below the \
                 true ones. A colour is a label.\n"
            );
            for one in list {
                let (name, value) = (&one.case.name, assigned(one));
                let _ = writeln!(text, "**{name}**: assigned {}\n", number(value, 3));
                let _ = writeln!(text, "![Frames, labels found and true labels of {name}]({prefix}{name}.png)\n");
            }
        }
    }

    /// The best clips, and the worst in reverse; no clip is in both.
    fn ends(&self) -> [Vec<&Measured>; 2] {
        let mut list: Vec<&Measured> = self.generated().collect();
        list.sort_by(|a, b| assigned(b).total_cmp(&assigned(a)));
        let many = SHOWN.min(list.len() / 2);
        let mut worst = list.split_off(list.len() - many);
        worst.reverse();
        list.truncate(many);
        [list, worst]
    }
}

/// What clips are ranked by.
fn assigned(one: &Measured) -> f64 {
    one.own().and_then(|own| own.scores.identities).map_or(0.0, |identities| identities.assigned)
}

fn three_figures(outcomes: &[&Outcome]) -> String {
    let of = |figure| mean(outcomes.iter().copied(), figure);
    let auto = of(|o| Some(o.scores.j_auto));
    let assigned = of(|o| o.scores.identities.map(|i| i.assigned));
    let switches = of(|o| o.scores.identities.map(|i| i.switches));
    [number(auto, 3), number(assigned, 3), number(switches, 1)].join(" | ")
}

fn number(value: f64, digits: usize) -> String {
    if value.is_finite() { format!("{value:.digits$}") } else { "–".into() }
}
