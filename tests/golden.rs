//! Golden hashes, natively: tests/golden.json says what is asked, and which bits the answers have. pkg/test/golden.test.mjs asks the module
//! that is shipped for the same.
#![allow(clippy::unwrap_used, clippy::panic, reason = "test code may panic")]

use std::fs;

use serde_json::{Value, json};
use veronese::clip::{Annotations, ClipFrame, ClipOptions, ClipSegmenter, Painted, Spread, StreamSegmenter};
use veronese::codecs::decode_image;
use veronese::{
    FitOptions, Frame, Measurements, Method, MotionCount, Quality, SegmentOptions, fit_motions, segment_pair,
};

/// FNV-1a, 64 bits.
fn fnv(bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes.into_iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// The bytes of all numbers of an answer, entries in the order of their names.
fn numbers(answer: &Value) -> Vec<u8> {
    match answer {
        Value::Number(number) => number.as_f64().unwrap().to_le_bytes().to_vec(),
        Value::Array(values) => values.iter().flat_map(numbers).collect(),
        Value::Object(entries) => entries.values().flat_map(numbers).collect(),
        Value::Null | Value::Bool(_) | Value::String(_) => Vec::new(),
    }
}

/// An answer: its bytes, then what else it has.
type Answer = (Vec<u8>, Value);

fn frames(golden: &Value, name: &Value) -> Vec<Frame> {
    let files = golden["frames"][name.as_str().unwrap()].as_array().unwrap();
    let frame = |file: &Value| decode_image(&fs::read(file.as_str().unwrap()).unwrap()).unwrap().frame().unwrap();
    files.iter().map(frame).collect()
}

/// Measurements spread by remainders. The package's test computes them in the same order, so that both have the same bits.
fn measurements(wanted: &Value) -> Measurements {
    let motions: Vec<[f64; 6]> = serde_json::from_value(wanted["motions"].clone()).unwrap();
    let noise = wanted["noise"].as_f64().unwrap();
    let spread = |j: usize, factor: usize, modulus: usize| (j * factor % modulus) as f64 / (modulus / 2) as f64 - 1.0;
    let (mut positions, mut derivatives) = (Vec::new(), Vec::new());
    for j in 0..wanted["count"].as_u64().unwrap() as usize {
        let [x, y] = [spread(j, 37, 101), spread(j, 53, 97)];
        let [ix, iy] = [spread(j, 29, 83), spread(j, 71, 89)];
        let m = motions[j % motions.len()];
        let [u, v] = [m[0] * x + m[1] * y + m[2], m[3] * x + m[4] * y + m[5]];
        positions.push([x, y]);
        derivatives.push([ix, iy, noise * spread(j, 67, 79) - (ix * u + iy * v)]);
    }
    Measurements::new(positions, derivatives).unwrap()
}

fn count(options: &Value) -> MotionCount {
    options["motions"].as_u64().map_or(MotionCount::Auto, |n| MotionCount::Given(n as usize))
}

fn pair_options(options: &Value) -> SegmentOptions {
    let flag = |name: &str| options[name].as_bool().unwrap_or(false);
    SegmentOptions::default()
        .with_quality(if options["quality"] == "fast" { Quality::Fast } else { Quality::Best })
        .with_motions(count(options))
        .with_mark_unknown(flag("markUnknown"))
        .with_confidence(flag("confidence"))
        .with_subject(flag("subject"))
}

/// A label at the pixels of a box, 255 elsewhere.
fn filled(frame: &Frame, rectangle: &Value, label: u8) -> Vec<u8> {
    let [left, top, width, height]: [usize; 4] = serde_json::from_value(rectangle.clone()).unwrap();
    let is_inside = |p: usize| {
        (left..left + width).contains(&(p % frame.width())) && (top..top + height).contains(&(p / frame.width()))
    };
    (0..frame.width() * frame.height()).map(|p| if is_inside(p) { label } else { 255 }).collect()
}

fn pair(frames: &[Frame], options: &SegmentOptions) -> Answer {
    let found = segment_pair(&frames[0], &frames[1], options, &mut |_| {}).unwrap();
    ([&found.labels[..], found.confidence.as_deref().unwrap_or_default()].concat(), json!(found))
}

fn clip(frames: &[Frame], asked: &Value) -> Answer {
    let look_ahead = asked["options"]["lookAhead"].as_u64().map(|frames| frames as usize);
    let options = ClipOptions::default().with_pair(pair_options(&asked["options"])).with_look_ahead(look_ahead);
    let done: Vec<ClipFrame> = if look_ahead.is_some() {
        let mut stream = StreamSegmenter::new(options).unwrap();
        let mut done: Vec<ClipFrame> = frames.iter().filter_map(|frame| stream.push(frame.clone()).unwrap()).collect();
        done.extend(stream.finish());
        done
    } else {
        let mut pairs = ClipSegmenter::new(options).unwrap();
        frames.iter().for_each(|frame| drop(pairs.push(frame.clone()).unwrap()));
        let mut clip = pairs.conclude();
        let painted = |said: &Value| Painted {
            frame: said["frame"].as_u64().unwrap() as usize,
            object: None,
            labels: filled(&frames[0], &said["box"], said["label"].as_u64().unwrap() as u8),
            spread: Spread::Both,
        };
        let corrections = asked["corrections"].as_array().into_iter().flatten().map(painted).collect();
        let mut job = clip.annotate(Annotations { corrections, ..Annotations::default() }).unwrap();
        while let Some(wanted) = job.wanted() {
            job.take(&mut clip, &frames[wanted]).unwrap();
        }
        frames.iter().enumerate().map(|(index, frame)| clip.frame(index, frame).unwrap()).collect()
    };
    (done.iter().flat_map(|frame| frame.labels.clone()).collect(), json!(done))
}

fn fit(measurements: &Measurements, options: &Value) -> Answer {
    let method = if options["method"] == "paper" { Method::Paper } else { Method::Best };
    let options = FitOptions::default()
        .with_method(method)
        .with_motions(count(options))
        .with_seed(options["seed"].as_u64().unwrap_or(1));
    let found = fit_motions(measurements, &options, &mut |_| {}).unwrap();
    (found.labels.clone(), json!(found))
}

#[test]
fn answers_have_the_bits_of_the_golden_hashes() {
    let golden: Value = serde_json::from_str(&fs::read_to_string("tests/golden.json").unwrap()).unwrap();
    let mut wrong = String::new();
    for asked in golden["answers"].as_array().unwrap() {
        let (of, options) = (&asked["of"], &asked["options"]);
        let (bytes, others) = match asked["call"].as_str().unwrap() {
            "segmentPair" => pair(&frames(&golden, of), &pair_options(options)),
            "segmentClip" => clip(&frames(&golden, of), asked),
            "fitMotions" => fit(&measurements(&golden["measurements"][of.as_str().unwrap()]), options),
            call => panic!("there is no call {call}"),
        };
        let found = format!("{:016x}", fnv(bytes.into_iter().chain(numbers(&others))));
        if asked["hash"] != found.as_str() {
            wrong += &format!("{} of {of}, {options}: {found}\n", asked["call"].as_str().unwrap());
        }
    }
    assert!(wrong.is_empty(), "other bits:\n{wrong}");
}
