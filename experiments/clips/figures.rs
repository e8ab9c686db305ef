//! The figures by name, their means, and files of them for programs.

use std::fmt::Write;

use serde_json::{Map, Value, json};

use crate::measure::{Measured, Outcome};
use crate::methods::Method;

/// A figure of an outcome; none where the clip has no such figure.
pub(crate) type Figure = fn(&Outcome) -> Option<f64>;

/// All figures, named as score_clips names them.
pub(crate) const FIGURES: [(&str, Figure); 14] = [
    ("j_auto", |o| Some(o.scores.j_auto)),
    ("j_track", |o| Some(o.scores.j_track)),
    ("j_tracks", |o| Some(o.scores.j_tracks)),
    ("j_oracle", |o| Some(o.scores.j_oracle)),
    ("f_auto", |o| o.scores.f_auto),
    ("f_tracks", |o| o.scores.f_tracks),
    ("assigned", |o| o.scores.identities.map(|i| i.assigned)),
    ("switches", |o| o.scores.identities.map(|i| i.switches)),
    ("lost", |o| o.scores.identities.map(|i| i.lost)),
    ("idf1", |o| o.scores.identities.map(|i| i.idf1)),
    ("n_labels", |o| Some(o.scores.label_count as f64)),
    ("n_objects", |o| Some(o.scores.object_count as f64)),
    ("n_right", |o| Some(f64::from(u8::from(o.scores.label_count == o.scores.object_count + 1)))),
    ("milliseconds", |o| o.milliseconds),
];

/// The mean of a figure over the clips that have it; NaN over none.
pub(crate) fn mean<'a>(outcomes: impl Iterator<Item = &'a Outcome>, figure: Figure) -> f64 {
    let values: Vec<f64> = outcomes.filter_map(figure).collect();
    values.iter().sum::<f64>() / values.len() as f64
}

/// Comma separated values with a header line; a figure that does not exist is empty.
pub(crate) fn csv(measured: &[Measured]) -> String {
    let names = FIGURES.map(|(name, _)| name).join(",");
    let mut text = format!("clip,generated,width,height,frames,method,{names}\n");
    for one in measured {
        for outcome in &one.outcomes {
            let ([width, height], generated) = (one.size, one.case.is_generated());
            let _ =
                write!(text, "{},{generated},{width},{height},{},{}", one.case.name, one.frames, outcome.method.name());
            for (_, figure) in FIGURES {
                let _ = match figure(outcome) {
                    Some(value) => write!(text, ",{value}"),
                    None => write!(text, ","),
                };
            }
            text.push('\n');
        }
    }
    text
}

/// Everything that was measured: clip by clip, and the means over generated and real clips.
pub(crate) fn all(measured: &[Measured]) -> Value {
    let of = |outcome: &Outcome| -> Value {
        let values = FIGURES.iter().filter_map(|(name, figure)| Some(((*name).to_owned(), json!(figure(outcome)?))));
        Value::Object(values.collect())
    };
    let clip = |one: &Measured| {
        let methods: Map<String, Value> = one.outcomes.iter().map(|o| (o.method.name().to_owned(), of(o))).collect();
        json!({
            "clip": one.case.name, "generated": one.case.is_generated(), "size": one.size, "frames": one.frames,
            "methods": methods,
        })
    };
    let means = |generated: bool| -> Value {
        let mut methods = Map::new();
        for method in Method::ALL.into_iter().chain(Method::ablations()) {
            let own =
                || measured.iter().filter(|one| one.case.is_generated() == generated).filter_map(|one| one.of(method));
            if own().next().is_some() {
                let values = FIGURES.iter().map(|(name, figure)| ((*name).to_owned(), json!(mean(own(), *figure))));
                methods.insert(method.name().to_owned(), Value::Object(values.collect()));
            }
        }
        Value::Object(methods)
    };
    json!({
        "clips": measured.iter().map(clip).collect::<Vec<Value>>(),
        "means": { "generated": means(true), "real": means(false) },
    })
}
