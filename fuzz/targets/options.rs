//! Any frames with any options: as a pair, as a stream, as a clip.
#![no_main]

use libfuzzer_sys::arbitrary::{self, Arbitrary};
use libfuzzer_sys::fuzz_target;
use veronese::clip::{ClipSegmenter, StreamSegmenter};
use veronese::{Frame, KeptPixels, MAX_MOTIONS, UNLABELLED, literal_pair, segment_pair};
use veronese_fuzz::{Choices, Film, check_clip};

#[derive(Arbitrary, Debug)]
enum Way {
    Pair,
    /// With a threshold or a share, and with the frame before the first or without it.
    Literal {
        share: bool,
        threshold: f64,
        three: bool,
    },
    Stream,
    Clip,
}

#[derive(Arbitrary, Debug)]
struct Input<'a> {
    way: Way,
    choices: Choices,
    /// A frame of another size than its bytes have.
    claimed: [usize; 2],
    other: Film<'a>,
    film: Film<'a>,
}

fuzz_target!(|input: Input<'_>| {
    let Input { way, choices, claimed, other, film } = input;
    let [width, height] = film.size();
    drop(Frame::from_rgba(claimed[0], claimed[1], [0; 64].as_slice()));
    let (first, second) = (film.frame(0), film.frame(1));
    match way {
        Way::Pair => {
            drop(segment_pair(&first, &other.frame(0), &choices.pair(), &mut |_| {}));
            if let Ok(found) = segment_pair(&first, &second, &choices.pair(), &mut |_| {}) {
                assert_eq!(found.labels.len(), width * height);
                assert!(found.count <= MAX_MOTIONS && found.motions.iter().all(|motion| motion.matrix.is_finite()));
                assert!(found.labels.iter().all(|&l| l == UNLABELLED || usize::from(l) < found.motions.len()));
                assert!(found.confidence.is_none_or(|confidence| confidence.len() == width * height));
            }
        }
        Way::Literal { share, threshold, three } => {
            let kept = if share { KeptPixels::Strongest(threshold) } else { KeptPixels::Above(threshold) };
            let before = film.frame(-1);
            if let Ok(found) = literal_pair(&first, &second, three.then_some(&before), kept, choices.motions()) {
                assert_eq!(found.labels.iter().filter(|&&l| l != UNLABELLED).count(), found.kept);
            }
        }
        Way::Stream => {
            let Ok(mut stream) = StreamSegmenter::new(choices.clip()) else { return };
            let mut count = 0;
            for time in 0..4 {
                count += usize::from(matches!(stream.push(film.frame(time)), Ok(Some(_))));
                if other.size() != film.size() {
                    assert!(stream.push(other.frame(time)).is_err());
                }
            }
            assert_eq!(count + stream.finish().len(), 4);
        }
        Way::Clip => {
            let Ok(mut clip) = ClipSegmenter::new(choices.clip()) else { return };
            let frames: Vec<Frame> = (0..3).map(|time| film.frame(time)).collect();
            for frame in &frames {
                clip.push(frame.clone()).expect("the frames have one size");
                drop(clip.preview());
            }
            check_clip(&clip.conclude(), &frames);
        }
    }
});
