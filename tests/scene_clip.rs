//! The truth of generated clips agrees with their frames, events happen when the clip says, and the same options give the same bytes
//! everywhere.
#![allow(clippy::unwrap_used, reason = "test code may panic")]

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use std::ops::Range;

use veronese::AffineMotion;
use veronese::scene::{ClipScene, ClipSceneOptions, Event, generate_clip};

const WIDTH: usize = 160;
const HEIGHT: usize = 120;

fn clip(events: &[Event], seed: u64) -> ClipScene {
    let options =
        ClipSceneOptions { width: WIDTH, height: HEIGHT, events: events.to_vec(), seed, ..ClipSceneOptions::default() };
    generate_clip(&options).unwrap()
}

fn frames(clip: &ClipScene) -> Range<usize> {
    0..clip.options.frames
}

/// Pixels of an object in every frame.
fn areas(clip: &ClipScene, object: u8) -> Vec<usize> {
    frames(clip).map(|t| clip.labels(t).unwrap().iter().filter(|&&l| l == object).count()).collect()
}

/// Whether an object touches the border of the frame.
fn at_border(clip: &ClipScene, object: u8, t: usize) -> bool {
    let labels = clip.labels(t).unwrap();
    let border =
        |p: usize| p < WIDTH || p + WIDTH >= labels.len() || p.is_multiple_of(WIDTH) || (p + 1).is_multiple_of(WIDTH);
    (0..labels.len()).any(|p| labels[p] == object && border(p))
}

/// Speed of an object relative to the background, at the middle of its pixels in frame `t`.
fn speed(clip: &ClipScene, object: u8, t: usize) -> f64 {
    let labels = clip.labels(t).unwrap();
    let own: Vec<usize> = (0..labels.len()).filter(|&p| labels[p] == object).collect();
    let mean = |of: &dyn Fn(usize) -> usize| own.iter().map(|&p| of(p) as f64).sum::<f64>() / own.len() as f64;
    let (x, y) = (mean(&|p| p % WIDTH), mean(&|p| p / WIDTH));
    let flow = |number: u8| clip.motion(number, t).unwrap().flow(x, y);
    let ([u, v], [a, b]) = (flow(object), flow(0));
    ((u - a) * (u - a) + (v - b) * (v - b)).sqrt()
}

fn brightness(clip: &ClipScene, t: usize) -> f64 {
    let rgba = clip.rgba(t).unwrap();
    rgba.chunks_exact(4).map(|p| f64::from(p[1])).sum::<f64>() / (rgba.len() / 4) as f64
}

/// Where a pixel of frame `t` is in the next frame; `None` outside.
fn landing(flow: &[[f32; 2]], p: usize) -> Option<usize> {
    let x = ((p % WIDTH) as f32 + flow[p][0]).round();
    let y = ((p / WIDTH) as f32 + flow[p][1]).round();
    let inside = x >= 0.0 && y >= 0.0 && x < WIDTH as f32 && y < HEIGHT as f32;
    inside.then(|| y as usize * WIDTH + x as usize)
}

#[test]
fn every_event_happens_when_the_clip_says() {
    for event in Event::ALL {
        for (seed, company) in [(1, None), (2, Some(Event::Pan)), (3, Some(Event::StopAndGo))] {
            let clip = clip(
                &[Some(event), company.filter(|&other| other != event)].into_iter().flatten().collect::<Vec<_>>(),
                seed,
            );
            let mut found = clip.occurrences.iter().filter(|o| o.event == event).peekable();
            assert!(found.peek().is_some(), "{event:?} does not happen with seed {seed}");
            for occurrence in found {
                assert_eq!(occurrence.objects.len(), event.objects());
                assert!(!occurrence.frames.is_empty() && occurrence.frames.end <= clip.options.frames);
                happens(&clip, event, &occurrence.objects, occurrence.frames.clone());
            }
        }
    }
}

fn happens(clip: &ClipScene, event: Event, objects: &[u8], range: Range<usize>) {
    let count = clip.options.frames;
    let areas: Vec<Vec<usize>> = objects.iter().map(|&object| areas(clip, object)).collect();
    let outside = || (0..count).filter(|t| !range.contains(t));
    match event {
        Event::Crossing => {
            let touch = |t: usize| {
                let labels = clip.labels(t).unwrap();
                let pair = |a: u8, b: u8| objects.contains(&a) && objects.contains(&b) && a != b;
                (WIDTH..labels.len()).any(|p| pair(labels[p], labels[p - 1]) || pair(labels[p], labels[p - WIDTH]))
            };
            // One passes before the other, which loses a quarter of its pixels at least.
            let least = areas[0][range.clone()].iter().min().unwrap();
            assert!(4 * least < 3 * areas[0][range.start - 1], "{range:?}: {:?}", areas[0]);
            assert!(range.clone().filter(|&t| areas[0][t] > 0).all(touch), "{range:?}");
            assert!(areas.iter().all(|area| area[0] > 0 && area[count - 1] > 0));
        }
        Event::HiddenByBackground | Event::HiddenByObject => {
            assert!(range.len() <= 10);
            assert!(
                range.clone().all(|t| areas[0][t] == 0) && outside().all(|t| areas[0][t] > 0),
                "{range:?}: {:?}",
                areas[0]
            );
            if event == Event::HiddenByObject {
                assert!(range.clone().all(|t| areas[1][t] > 0));
            }
        }
        Event::StopAndGo => {
            let object = objects[0];
            for t in range.clone() {
                assert!(speed(clip, object, t) < 1e-9, "frame {t}");
            }
            for t in [range.start - 1, range.end] {
                assert!((0.1..3.0).contains(&speed(clip, object, t)), "frame {t}: {}", speed(clip, object, t));
            }
        }
        Event::Entering | Event::Leaving => {
            let out = |t: usize| if event == Event::Entering { t < range.start } else { t >= range.end };
            assert!((0..count).all(|t| (areas[0][t] == 0) == out(t)), "{range:?}: {:?}", areas[0]);
            assert!(range.clone().all(|t| at_border(clip, objects[0], t)));
            let whole = if event == Event::Entering { range.end } else { range.start - 1 };
            assert!(!at_border(clip, objects[0], whole));
        }
        Event::Articulated => {
            let bends = |t: usize| {
                let (labels, flow) = (clip.labels(t).unwrap(), clip.flow(t).unwrap());
                let body = clip.motion(objects[0], t).unwrap();
                let apart = |p: usize| {
                    let [u, v] = body.flow((p % WIDTH) as f64, (p / WIDTH) as f64);
                    (u - f64::from(flow[p][0])).abs() + (v - f64::from(flow[p][1])).abs() > 0.5
                };
                (0..flow.len()).any(|p| labels[p] == objects[0] && apart(p))
            };
            assert!((10..20).any(bends));
        }
        // The speed swings a little over the shot.
        Event::Slow => {
            let (slow, quick) = range_of(range.start..range.end - 1, |t| speed(clip, objects[0], t));
            assert!(slow > 0.2 && quick < 1.1, "{slow} to {quick}");
        }
        Event::Fast => {
            // In frames of half the size, half as fast; the object also turns and grows.
            let (slow, quick) = range_of(range.start..range.end - 1, |t| speed(clip, objects[0], t));
            assert!(slow > 4.0 && quick < 8.5, "{slow} to {quick}");
        }
        Event::Pan => {
            let flow = |t: usize| clip.motion(0, t).unwrap().flow(0.5 * WIDTH as f64, 0.5 * HEIGHT as f64);
            let (slow, quick) = range_of(range.start..range.end - 1, |t| flow(t)[0].hypot(flow(t)[1]));
            assert!(slow > 0.25 && quick < 2.0, "{slow} to {quick}");
        }
        Event::Zoom => {
            let (slow, quick) = range_of(range.start..range.end - 1, |t| clip.motion(0, t).unwrap().matrix[0].abs());
            assert!(slow > 0.0029 && quick < 0.0071, "{slow} to {quick}");
        }
        Event::Cut => {
            let numbers = |t: usize| clip.labels(t).unwrap().into_iter().filter(|&l| l > 0).collect::<Vec<u8>>();
            let (before, after) = (numbers(range.start - 1), numbers(range.start));
            assert!(before.iter().all(|l| !after.contains(l)) && !before.is_empty() && !after.is_empty());
            assert_eq!(clip.motion(0, range.start - 1), None);
            assert_eq!(clip.flow(range.start - 1), None);
        }
        Event::Exposure => {
            let [first, last] = [range.start - 1, range.end - 1].map(|t| brightness(clip, t));
            assert!((last / first - 1.0).abs() > 0.08, "{first} to {last}");
        }
        Event::Flash => {
            let before = brightness(clip, range.start - 1);
            assert!(range.len() <= 2 && range.clone().all(|t| brightness(clip, t) > before + 25.0));
            assert!((brightness(clip, range.end) - before).abs() < 10.0);
        }
        Event::Repeats => {
            let t = range.start;
            assert_eq!(clip.rgba(t).unwrap(), clip.rgba(t - 1).unwrap());
            assert_eq!(clip.labels(t).unwrap(), clip.labels(t - 1).unwrap());
            let still = clip.motion(0, t - 1).unwrap().relative_error(&AffineMotion::STATIC);
            assert!(still < 1e-12, "{still}");
        }
    }
}

/// The least and the largest value.
fn range_of(frames: Range<usize>, value: impl Fn(usize) -> f64) -> (f64, f64) {
    frames.map(value).fold((f64::INFINITY, 0.0), |(low, high), v| (low.min(v), high.max(v)))
}

#[test]
fn labels_carried_by_the_true_motion_land_on_the_labels_of_the_next_frame() {
    for (seed, events) in [
        (1, vec![Event::Crossing, Event::Pan, Event::Zoom]),
        (2, vec![Event::Articulated, Event::Fast, Event::Repeats]),
        (3, vec![Event::HiddenByBackground, Event::Leaving, Event::Pan]),
    ] {
        let clip = clip(&events, seed);
        for t in 0..clip.options.frames - 1 {
            let (now, next, flow) = (clip.labels(t).unwrap(), clip.labels(t + 1).unwrap(), clip.flow(t).unwrap());
            for object in 1..=clip.objects() as u8 {
                let own: Vec<usize> = (0..now.len()).filter(|&p| now[p] == object).collect();
                let body = clip.motion(object, t).unwrap();
                let rigid = own.iter().all(|&p| {
                    let [u, v] = body.flow((p % WIDTH) as f64, (p / WIDTH) as f64);
                    (u - f64::from(flow[p][0])).abs() + (v - f64::from(flow[p][1])).abs() < 1e-4
                });
                let articulated =
                    clip.occurrences.iter().any(|o| o.event == Event::Articulated && o.objects == [object]);
                assert!(rigid || articulated, "seed {seed}, object {object}, frame {t}");
                // What is covered in the next frame is covered by something in front; rounding moves a pixel by half its width.
                let lands: Vec<usize> = own.iter().filter_map(|&p| landing(&flow, p)).collect();
                let right = lands.iter().filter(|&&q| {
                    let around = [
                        q,
                        q.saturating_sub(1),
                        (q + 1).min(next.len() - 1),
                        q.saturating_sub(WIDTH),
                        (q + WIDTH).min(next.len() - 1),
                    ];
                    around.iter().any(|&p| next[p] == object)
                });
                let in_front = covered(&clip, object);
                let share = right.count() as f64 / lands.len().max(1) as f64;
                assert!(
                    in_front || lands.is_empty() || share > 0.99,
                    "seed {seed}, object {object}, frame {t}: {share}"
                );
            }
        }
    }
}

/// Whether an object is behind something at some time.
fn covered(clip: &ClipScene, object: u8) -> bool {
    let meets = [Event::Crossing, Event::HiddenByBackground, Event::HiddenByObject];
    clip.occurrences.iter().any(|o| meets.contains(&o.event) && o.objects[0] == object)
        || clip.occurrences.iter().any(|o| o.event == Event::Fast && o.objects[0] != object)
}

#[test]
fn the_true_flow_brings_the_next_frame_back() {
    for (seed, events) in [
        (4, vec![Event::Crossing, Event::Pan, Event::Zoom]),
        (5, vec![Event::Articulated, Event::Fast]),
        (6, vec![Event::HiddenByObject, Event::Slow]),
    ] {
        let options =
            ClipSceneOptions { width: WIDTH, height: HEIGHT, events, seed, noise: 0.0, ..ClipSceneOptions::default() };
        let clip = generate_clip(&options).unwrap();
        for t in [3, 17, 28] {
            let (now, next) = (clip.frame(t).unwrap(), clip.frame(t + 1).unwrap());
            let (labels, after, flow) = (clip.labels(t).unwrap(), clip.labels(t + 1).unwrap(), clip.flow(t).unwrap());
            let sums = |shift: f64| {
                let mut sums = vec![(0.0, 0usize); clip.objects() + 1];
                for p in (3..HEIGHT - 3).flat_map(|y| (3..WIDTH - 3).map(move |x| y * WIDTH + x)) {
                    let near = |q: usize| (0..49).map(move |k| q + k % 7 + k / 7 * WIDTH - 3 - 3 * WIDTH);
                    let alike = |q: usize| {
                        labels[q] == labels[p]
                            && (flow[q][0] - flow[p][0]).abs() + (flow[q][1] - flow[p][1]).abs() < 0.3
                    };
                    let (x, y) =
                        ((p % WIDTH) as f64 + f64::from(flow[p][0]), (p / WIDTH) as f64 + f64::from(flow[p][1]));
                    let inside = x >= 4.0 && y >= 4.0 && x < (WIDTH - 5) as f64 && y < (HEIGHT - 5) as f64;
                    if !inside || !near(p).all(alike) {
                        continue;
                    }
                    let q = y.round() as usize * WIDTH + x.round() as usize;
                    if near(q).any(|q| after[q] != labels[p]) {
                        continue;
                    }
                    let change =
                        sample(next.luminance(), x + shift, y - shift) - f64::from(now.luminance().values()[p]);
                    let sum = &mut sums[usize::from(labels[p])];
                    *sum = (sum.0 + change * change, sum.1 + 1);
                }
                sums
            };
            for (object, (right, wrong)) in sums(0.0).into_iter().zip(sums(0.6)).enumerate() {
                let rms = |(sum, count): (f64, usize)| (sum / count.max(1) as f64).sqrt();
                // Limbs are too thin, hidden objects too small to be judged in every frame.
                if right.1 > 60 {
                    assert!(
                        rms(right) < 2.5 && rms(right) < 0.5 * rms(wrong),
                        "seed {seed}, frame {t}, object {object}: {} {}",
                        rms(right),
                        rms(wrong)
                    );
                }
                assert!(object > 0 || right.1 > 5000);
            }
        }
    }
}

/// Bicubic (Catmull-Rom) value between the pixels, two pixels or more from the border.
fn sample(plane: &veronese::Plane, x: f64, y: f64) -> f64 {
    let (column, row) = (x.floor(), y.floor());
    let weights = |f: f64| {
        let (f2, f3) = (f * f, f * f * f);
        [-0.5 * f3 + f2 - 0.5 * f, 1.5 * f3 - 2.5 * f2 + 1.0, -1.5 * f3 + 2.0 * f2 + 0.5 * f, 0.5 * f3 - 0.5 * f2]
    };
    let (wx, wy) = (weights(x - column), weights(y - row));
    let at = |i: usize, j: usize| f64::from(plane.at(column as usize + i - 1, row as usize + j - 1));
    (0..4).map(|j| wy[j] * (0..4).map(|i| wx[i] * at(i, j)).sum::<f64>()).sum()
}

#[test]
fn frames_may_be_asked_for_in_any_order() {
    let events = [Event::Repeats, Event::Flash];
    let (one, two) = (clip(&events, 9), clip(&events, 9));
    let forward: Vec<Vec<u8>> = frames(&one).map(|t| one.rgba(t).unwrap()).collect();
    for t in frames(&two).rev() {
        assert!(two.rgba(t).unwrap() == forward[t], "frame {t}");
    }
    let differ = (1..forward.len()).filter(|&t| forward[t] != forward[t - 1]).count();
    let repeated = one.occurrences.iter().filter(|o| o.event == Event::Repeats).count();
    assert_eq!(differ + repeated, forward.len() - 1);
}

#[test]
fn options_out_of_range_and_frames_that_do_not_exist_are_refused() {
    let ok = ClipSceneOptions { width: WIDTH, height: HEIGHT, ..ClipSceneOptions::default() };
    let code = |o: ClipSceneOptions| generate_clip(&o).map(|_| ()).unwrap_err().code();
    assert_eq!(code(ClipSceneOptions { width: 15, ..ok.clone() }), "frame-size-unsupported");
    assert_eq!(code(ClipSceneOptions { frames: 29, ..ok.clone() }), "invalid-option");
    assert_eq!(code(ClipSceneOptions { frames: 121, ..ok.clone() }), "invalid-option");
    assert_eq!(code(ClipSceneOptions { objects: 9, ..ok.clone() }), "invalid-option");
    assert_eq!(code(ClipSceneOptions { noise: f64::NAN, ..ok.clone() }), "invalid-option");
    assert_eq!(code(ClipSceneOptions { events: vec![Event::Crossing; 5], ..ok.clone() }), "invalid-option");
    let clip = generate_clip(&ClipSceneOptions { objects: 0, ..ok.clone() }).unwrap();
    assert_eq!(clip.objects(), 0);
    assert!(clip.labels(31).unwrap().iter().all(|&l| l == 0));
    assert_eq!(clip.frame(32).unwrap_err().code(), "invalid-option");
    assert_eq!(clip.labels(32).unwrap_err().code(), "invalid-option");
    assert!(clip.motion(0, 30).is_some() && clip.motion(1, 30).is_none());
    assert!(clip.motion(0, 31).is_none() && clip.motion(0, usize::MAX - 1).is_none());
    // In the smallest frames events may find no place; then the clip does not claim them.
    let tiny =
        generate_clip(&ClipSceneOptions { width: 16, height: 16, events: Event::ALL[..6].to_vec(), ..ok }).unwrap();
    assert_eq!((tiny.objects(), tiny.labels(29).unwrap().len()), (8, 256));
}

/// FNV-1a, 64 bits.
fn hash(bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes.into_iter().fold(0xcbf2_9ce4_8422_2325, |h, b| (h ^ u64::from(b)).wrapping_mul(0x0100_0000_01b3))
}

#[test]
fn the_same_seed_gives_the_same_bytes_on_every_machine() {
    let events = vec![
        Event::Crossing,
        Event::Articulated,
        Event::HiddenByBackground,
        Event::Fast,
        Event::StopAndGo,
        Event::Pan,
        Event::Zoom,
        Event::Cut,
        Event::Exposure,
        Event::Flash,
        Event::Repeats,
    ];
    let clip = generate_clip(&ClipSceneOptions {
        width: 96,
        height: 64,
        frames: 40,
        events,
        seed: 99,
        ..ClipSceneOptions::default()
    })
    .unwrap();
    let motions = frames(&clip).flat_map(|t| (0..=clip.objects() as u8).map(move |object| (object, t)));
    let motions: Vec<u8> = motions
        .filter_map(|(object, t)| clip.motion(object, t))
        .flat_map(|motion| motion.matrix)
        .flat_map(|a| a.to_bits().to_le_bytes())
        .collect();
    let pixels = frames(&clip).flat_map(|t| [clip.rgba(t).unwrap(), clip.labels(t).unwrap()].concat());
    assert_eq!(format!("{:016x}", hash(pixels.chain(motions))), "a21618cdc3d202a4");
}
