//! The figures as JSON: means over clips for the documentation, and those of every clip and method.
use std::collections::BTreeMap;

use experiments::clips::cases::word;
use experiments::clips::methods::Method;
use scenes::Event;
use serde::Serialize;

use crate::measure::{Measured, Outcome};

/// A figure of an outcome; none where the clip has no such figure.
type Figure = fn(&Outcome) -> Option<f64>;

const FIGURES: [(&str, Figure); 13] = [
    ("auto", |o| Some(o.scores.j_auto)),
    ("oneClick", |o| Some(o.scores.j_track)),
    ("tracks", |o| Some(o.scores.j_tracks)),
    ("oracle", |o| Some(o.scores.j_oracle)),
    ("fAuto", |o| o.scores.f_auto),
    ("fTracks", |o| o.scores.f_tracks),
    ("assigned", |o| o.scores.identities.map(|i| i.assigned)),
    ("switches", |o| o.scores.identities.map(|i| i.switches)),
    ("lost", |o| o.scores.identities.map(|i| i.lost)),
    ("idf1", |o| o.scores.identities.map(|i| i.idf1)),
    ("labels", |o| Some(o.scores.label_count as f64)),
    ("numberRight", |o| Some(f64::from(u8::from(o.scores.label_count == o.scores.object_count + 1)))),
    ("milliseconds", |o| o.milliseconds),
];

/// The figures that exist, by name.
type Named = BTreeMap<&'static str, f64>;

#[derive(Serialize)]
pub(crate) struct Figures {
    generated: Vec<Row>,
    events: Vec<OfEvent>,
    real: Vec<Row>,
}

/// The mean figures of a method on some clips.
#[derive(Serialize)]
struct Row {
    method: &'static str,
    clips: usize,
    #[serde(flatten)]
    figures: Named,
}

#[derive(Serialize)]
struct OfEvent {
    event: &'static str,
    rows: Vec<Row>,
}

/// The figures of a method on a clip.
#[derive(Serialize)]
struct OfClip<'a> {
    clip: &'a str,
    generated: bool,
    size: [usize; 2],
    frames: usize,
    method: &'static str,
    #[serde(flatten)]
    figures: Named,
}

/// Every clip and method, a line of JSON for each.
pub(crate) fn lines(measured: &[Measured]) -> serde_json::Result<String> {
    let of = |one: &Measured, outcome: &Outcome| {
        let (clip, size, frames) = (&*one.case.name, one.size, one.frames);
        let (generated, method) = (one.case.is_generated(), outcome.method.name());
        let figures = FIGURES.iter().filter_map(|(name, figure)| Some((*name, figure(outcome)?))).collect();
        serde_json::to_string(&OfClip { clip, generated, size, frames, method, figures })
    };
    let lines = measured.iter().flat_map(|one| one.outcomes.iter().map(move |outcome| of(one, outcome)));
    Ok(lines.collect::<Result<Vec<_>, _>>()?.join("\n"))
}

impl Figures {
    pub(crate) fn of(measured: &[Measured]) -> Figures {
        let (generated, real): (Vec<&Measured>, Vec<&Measured>) =
            measured.iter().partition(|one| one.case.is_generated());
        Figures { generated: rows(&generated), events: events(&generated), real: rows(&real) }
    }
}

/// The mean figures of a method, if it is there.
fn row(clips: &[&Measured], method: Method) -> Option<Row> {
    let outcomes: Vec<&Outcome> = clips.iter().filter_map(|one| one.of(method)).collect();
    let mean = |figure: &Figure| {
        let values: Vec<f64> = outcomes.iter().filter_map(|outcome| figure(outcome)).collect();
        (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
    };
    let figures = FIGURES.iter().filter_map(|(name, figure)| Some((*name, mean(figure)?))).collect();
    (!outcomes.is_empty()).then(|| Row { method: method.title(), clips: outcomes.len(), figures })
}

fn rows(clips: &[&Measured]) -> Vec<Row> {
    Method::ALL.into_iter().filter_map(|method| row(clips, method)).collect()
}

fn events(clips: &[&Measured]) -> Vec<OfEvent> {
    let of = |event: Event| {
        let own: Vec<&Measured> = clips.iter().copied().filter(|one| one.case.has(event)).collect();
        let methods = [Method::Clip, Method::LayeredMotion];
        OfEvent { event: word(event), rows: methods.into_iter().filter_map(|method| row(&own, method)).collect() }
    };
    Event::ALL.into_iter().map(of).filter(|event| !event.rows.is_empty()).collect()
}
