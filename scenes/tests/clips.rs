//! The truth of generated clips holds from frame to frame, and the same options give the same bytes everywhere.
#![allow(clippy::unwrap_used, reason = "test code may panic")]

use std::ops::Range;

use crate::hash;
use scenes::{ClipScene, ClipSceneOptions, Event, generate_clip};

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

/// Where a pixel of frame `t` is in the next frame; `None` outside.
fn landing(flow: &[[f32; 2]], p: usize) -> Option<usize> {
    let x = ((p % WIDTH) as f32 + flow[p][0]).round();
    let y = ((p / WIDTH) as f32 + flow[p][1]).round();
    let inside = x >= 0.0 && y >= 0.0 && x < WIDTH as f32 && y < HEIGHT as f32;
    inside.then(|| y as usize * WIDTH + x as usize)
}

#[test]
fn objects_are_out_of_sight_when_the_clip_says() {
    for event in [Event::HiddenByBackground, Event::HiddenByObject, Event::Entering, Event::Leaving] {
        for seed in 0..3 {
            let clip = clip(&[event], seed);
            let happened = clip.occurrences.iter().find(|o| o.event == event).unwrap();
            let (range, areas) = (&happened.frames, areas(&clip, happened.objects[0]));
            let hidden = |t: usize| match event {
                Event::Entering => t < range.start,
                Event::Leaving => t >= range.end,
                _ => range.contains(&t),
            };
            assert!(frames(&clip).all(|t| (areas[t] == 0) == hidden(t)), "{event:?}, {range:?}: {areas:?}");
        }
    }
}

#[test]
fn a_slow_clip_shows_the_middle_of_the_usual_one() {
    let usual = clip(&[Event::Crossing, Event::Articulated, Event::Pan], 4);
    let slow = generate_clip(&ClipSceneOptions { speed: 0.25, ..usual.options.clone() }).unwrap();
    // Four frames show what one usually does.
    let middle = usual.options.frames as f64 / 2.0 - 0.5;
    for (object, t) in (0..=usual.objects() as u8).flat_map(|object| [2, 13, 28].map(|t| (object, t))) {
        let then = (middle + 0.25 * (t as f64 - middle)) as usize;
        let [slow, usual] = [slow.motion(object, t), usual.motion(object, then)].map(|motion| motion.unwrap());
        let (at, then) = (slow.flow(80.0, 60.0), usual.flow(80.0, 60.0));
        for k in 0..2 {
            assert!((4.0 * at[k] - then[k]).abs() < 0.1, "object {object}, frame {t}: {at:?}, {then:?}");
        }
    }
    assert!(generate_clip(&ClipSceneOptions { speed: 0.0, ..usual.options }).is_err());
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
                // Pixels that are covered in the next frame are covered by something in front; rounding moves a pixel by half its width.
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

fn hash_of(events: &[Event], frames: usize) -> String {
    let options = ClipSceneOptions { width: 96, height: 64, frames, seed: 99, ..ClipSceneOptions::default() };
    let clip = generate_clip(&ClipSceneOptions { events: events.to_vec(), ..options }).unwrap();
    let motions = (0..frames).flat_map(|t| (0..=clip.objects() as u8).map(move |object| (object, t)));
    let motions: Vec<u8> = motions
        .filter_map(|(object, t)| clip.motion(object, t))
        .flat_map(|motion| motion.matrix)
        .flat_map(|a| a.to_bits().to_le_bytes())
        .collect();
    let pixels = (0..frames).flat_map(|t| [clip.rgba(t).unwrap(), clip.labels(t).unwrap()].concat());
    format!("{:016x}", hash(pixels.chain(motions)))
}

/// All events between them: what a clip shows and claims changes only on purpose.
#[test]
fn the_same_seed_gives_the_same_bytes_on_every_machine() {
    let many = [
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
    assert_eq!(hash_of(&many, 40), "a21618cdc3d202a4");
    let others = [Event::Entering, Event::Leaving, Event::HiddenByObject, Event::Slow];
    assert_eq!(hash_of(&others, 32), "b2d439ce14255c89");
}

/// The mean colour of an object in frame 0.
fn mean_colour(clip: &ClipScene, object: u8) -> [f64; 3] {
    let (rgba, labels) = (clip.rgba(0).unwrap(), clip.labels(0).unwrap());
    let own: Vec<&[u8]> =
        rgba.chunks_exact(4).zip(labels).filter(|(_, label)| *label == object).map(|(pixel, _)| pixel).collect();
    [0, 1, 2].map(|k| own.iter().map(|pixel| f64::from(pixel[k])).sum::<f64>() / own.len() as f64)
}

#[test]
fn objects_that_are_alike_have_colours_in_common_and_move_as_others_do() {
    let mut distances = [0.0; 2];
    for seed in 0..6 {
        let options =
            ClipSceneOptions { width: WIDTH, height: HEIGHT, objects: 2, seed, ..ClipSceneOptions::default() };
        let clips = [false, true].map(|alike| generate_clip(&ClipSceneOptions { alike, ..options.clone() }).unwrap());
        for t in [0, 31] {
            assert_eq!(clips[0].labels(t).unwrap(), clips[1].labels(t).unwrap());
        }
        for (clip, distance) in clips.iter().zip(&mut distances) {
            let [one, two] = [1, 2].map(|object| mean_colour(clip, object));
            *distance += one.iter().zip(two).map(|(a, b)| (a - b).abs()).sum::<f64>() / 18.0;
        }
    }
    assert!(distances[1] < 0.4 * distances[0], "{distances:?}");
}
