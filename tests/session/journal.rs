//! The journal of a clip: killed after any record, cut and damaged at any byte, compacted.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::LazyLock;

use super::{PIXELS, fast, print, read, run, said, segment, settle, start, summary};
use crate::support::moving::{scene_of, thing};
use veronese::clip::{
    Annotation, Click, Clip, ClipStage, Command, Content, Declaration, Description, FramePairs, OpenOptions, Recovered,
    Spread, StepId, solve_pair,
};
use veronese::{Frame, Random};

/// Seeds of the sequences of so many actions that are killed after each, and of those whose journals are cut and damaged.
const ACTIONS: usize = 22;
const KILLED: std::ops::Range<u64> = 0..3;
const CUT: std::ops::Range<u64> = 0..2;

const SMALL: [usize; 2] = [48, 36];
const TINY: [usize; 2] = [32, 24];

/// Bytes of the head of a journal and of its first record.
const FIRST: usize = 16 + 6 + 4 + 8;

/// What a person or a host does.
#[derive(Clone, Debug)]
enum Action {
    Give(Command),
    Undo,
    Redo,
    /// Cancels a step, counted from the last.
    Cancel(usize),
    Finish,
    /// Takes so many frames, with or without the pairs of others.
    Take(usize, bool),
    Look(usize),
    /// Reads the clip from what it saves.
    Save,
}

/// Frames with the pairs of each but the first.
struct Film<'a> {
    frames: &'a [Frame],
    pairs: &'a [FramePairs],
}

/// A clip with its journal.
struct Player<'a> {
    film: &'a Film<'a>,
    clip: Clip,
    journal: Vec<u8>,
    given: Vec<StepId>,
    /// How many frames each step has taken since it began.
    taken: BTreeMap<StepId, usize>,
    /// Pairs that were solved here.
    solved: usize,
}

impl<'a> Player<'a> {
    fn new(film: &'a Film<'a>) -> Player<'a> {
        let clip = Clip::new(film.frames.len(), OpenOptions::default()).unwrap();
        Player { film, clip, journal: Vec::new(), given: Vec::new(), taken: BTreeMap::new(), solved: 0 }
    }

    /// Appends the records to the journal.
    fn keep(&mut self) {
        let events = self.clip.take_events();
        if events.replaces {
            self.journal.clear();
        }
        self.journal.extend(events.records);
    }

    fn take(&mut self, helps: bool) -> bool {
        let Some(wanted) = self.clip.wanted() else { return false };
        let pairs = wanted.frame.checked_sub(1).map(|before| &self.film.pairs[before]).filter(|_| helps);
        self.solved += usize::from(wanted.stage == ClipStage::Pairs && pairs.is_none());
        self.clip.take(wanted.frame, &self.film.frames[wanted.frame], pairs).unwrap();
        wanted.step.into_iter().for_each(|step| *self.taken.entry(step).or_default() += 1);
        true
    }

    /// Does something; returns what has come of it. How many frames a clip takes after it was killed is known from one that was not.
    fn act(&mut self, action: &Action, progress: Option<&str>) -> String {
        let outcome = match action {
            Action::Give(command) => match self.clip.apply(command.clone()) {
                Ok(step) => {
                    self.given.push(step);
                    format!("{step:?}")
                }
                Err(error) => error.to_string(),
            },
            Action::Undo => self.clip.undo().to_string(),
            Action::Redo => self.clip.redo().to_string(),
            Action::Cancel(back) => match self.given.iter().rev().nth(*back) {
                Some(step) => self.clip.cancel(*step).to_string(),
                None => String::new(),
            },
            Action::Finish => {
                // Only of a range whose frames are in again.
                if let Some(step) = self.clip.wanted().filter(|of| of.stage == ClipStage::Pairs).and_then(|of| of.step)
                {
                    self.clip.finish(step);
                }
                String::new()
            }
            Action::Take(count, helps) => {
                let count = progress.map_or(*count, |_| 500);
                let _ = (0..count).all(|_| progress != Some(&self.progress()) && self.take(*helps));
                String::new()
            }
            Action::Look(index) => {
                self.clip.look_at(*index);
                if self.clip.wanted().is_some_and(|wanted| wanted.stage == ClipStage::Labels) {
                    self.take(false);
                }
                String::new()
            }
            Action::Save => {
                let saved = self.clip.save();
                self.clip = read(&saved);
                self.journal = saved;
                self.taken.clear();
                String::new()
            }
        };
        self.keep();
        outcome
    }

    /// What is known, what there is to do, and how far that is.
    fn progress(&self) -> String {
        let wanted = self.clip.wanted();
        let taken = wanted.and_then(|wanted| self.taken.get(&wanted.step?));
        format!("{wanted:?} {taken:?} {:?} {}", self.clip.steps(), summary(&self.clip))
    }

    /// The process ends: the clip is read from its journal, and goes on to where it was.
    fn kill(&mut self, context: &str) {
        let before = self.progress();
        self.taken.clear();
        let Recovered { clip, used, is_damaged, .. } = Clip::read(&self.journal, OpenOptions::default()).unwrap();
        assert_eq!((used, is_damaged), (self.journal.len(), false), "{context}");
        self.clip = clip;
        self.keep();
        let _ = (0..500).all(|_| self.progress() != before && self.take(false));
        assert_eq!(self.progress(), before, "{context}");
    }

    fn end(&mut self) -> (u64, [usize; 3]) {
        while self.take(true) {}
        self.keep();
        let film = self.film;
        let mut prints = Vec::new();
        // Of this state, and of all before and after.
        let steps = self.clip.steps();
        while self.clip.undo() {}
        loop {
            for index in 0..film.frames.len() {
                self.clip.look_at(index);
                while self.take(true) {}
                let shown = self.clip.labels(index);
                prints.push(shown.map(|of| (of.labels, format!("{:?} {:?}", of.objects, of.background))));
            }
            prints.push(Some((Vec::new(), summary(&self.clip))));
            if !self.clip.redo() {
                break;
            }
        }
        use std::hash::{DefaultHasher, Hash, Hasher};
        let mut hasher = DefaultHasher::new();
        prints.hash(&mut hasher);
        (hasher.finish(), steps)
    }
}

/// A random action of a clip of so many frames. Most commands come before anything was found.
fn action(random: &mut Random, frames: usize, size: [usize; 2]) -> Action {
    let mut below = |limit: usize| random.uniform(0.0, limit as f64) as usize;
    let frame = below(frames);
    let object = [1, 2, 9][below(3)];
    let sides = [below(size[0] - 12), below(size[1] - 10), 12, 10];
    let is_in = |p: usize| {
        let [x, y] = [p % size[0], p / size[0]];
        (sides[0]..sides[0] + sides[2]).contains(&x) && (sides[1]..sides[1] + sides[3]).contains(&y)
    };
    let drawn = |label: u8| (0..size[0] * size[1]).map(|p| if is_in(p) { label } else { 255 }).collect::<Vec<u8>>();
    let spread = [Spread::Both, Spread::Both, Spread::Forward, Spread::Exact][below(4)];
    let some = |content| Command::Annotate(vec![Annotation { frame, content, spread }]);
    Action::Give(match below(24) {
        0..5 => return Action::Take(1 + below(8), below(4) > 0),
        5 => return Action::Take(60, true),
        6 => return Action::Undo,
        7 => return Action::Redo,
        8 => return Action::Cancel(below(3)),
        9 => return Action::Finish,
        10 => return Action::Look(frame),
        11 => return Action::Save,
        12 | 13 => {
            let start = below(frames - 1);
            segment(start..start + 2 + below(frames - 1 - start))
        }
        14 | 15 => some(Content::Strokes { object, labels: drawn(below(2) as u8) }),
        16 => some(Content::Labels(drawn(object))),
        17 => some(Content::Given(drawn(object))),
        18 => {
            let clicks = vec![Click { at: [sides[0] + 6, sides[1] + 5], inside: true }];
            Command::Annotate(vec![Annotation::new(frame, Content::Prompt { object, clicks, within: Some(sides) })])
        }
        19 => Command::Accept { frames: vec![frame], on: below(3) > 0 },
        20 => Command::Lock { objects: vec![object], on: below(2) == 0 },
        21 => {
            let name = ["", "a", "b"][below(3)].into();
            Command::Describe { object, description: Description { name, ..Description::default() }, coalesce: true }
        }
        22 => [Command::Merge(vec![object, 1]), Command::Delete(vec![object]), Command::Clear { frame, object: None }]
            [below(3)]
        .clone(),
        _ => Command::ReplaceAnnotations(Declaration {
            annotations: vec![Annotation::new(frame, Content::Strokes { object, labels: drawn(1) })],
            accepted: vec![below(frames)],
            ..Declaration::default()
        }),
    })
}

fn script(seed: u64, length: usize, frames: usize, size: [usize; 2]) -> Vec<Action> {
    let mut random = Random::from_seed(seed);
    let first = Action::Give(segment(0..frames - 1));
    std::iter::once(first).chain((0..length).map(|_| action(&mut random, frames, size))).collect()
}

/// Two things that move, in few small frames.
fn small() -> Film<'static> {
    static MADE: LazyLock<(Vec<Frame>, Vec<FramePairs>)> = LazyLock::new(|| {
        let things = [
            thing(2, [14.0, 12.0], |t| [2.0 + 4.0 * t as f32, 4.0]),
            thing(3, [12.0, 12.0], |t| [32.0 - 3.0 * t as f32, 22.0]),
        ];
        let frames = scene_of(SMALL, 1, &things, 5).0;
        let pairs = frames.windows(2).map(|pair| solve_pair(&pair[0], &pair[1], &fast()).unwrap()).collect();
        (frames, pairs)
    });
    Film { frames: &MADE.0, pairs: &MADE.1 }
}

#[test]
fn a_clip_that_is_killed_after_any_action_goes_on_to_the_same_bits() {
    for seed in KILLED {
        let (film, script) = (small(), script(seed, ACTIONS, 5, SMALL));
        let mut whole = Player::new(&film);
        let done: Vec<(String, String)> =
            script.iter().map(|action| (whole.act(action, None), whole.progress())).collect();
        let end = whole.end();
        for killed in 0..script.len() {
            let mut player = Player::new(&film);
            for (k, (action, (outcome, progress))) in script.iter().zip(&done).enumerate() {
                let context = format!("seed {seed}, killed after {killed}, at {k}: {action:?}");
                let context = &context[..context.len().min(200)];
                assert_eq!(&player.act(action, Some(progress)), outcome, "{context}");
                if k == killed {
                    player.kill(context);
                }
            }
            assert_eq!(player.end(), end, "seed {seed}, killed after {killed}");
        }
    }
}

/// A box that moves, in three tiny frames.
fn tiny() -> Film<'static> {
    static MADE: LazyLock<(Vec<Frame>, Vec<FramePairs>)> = LazyLock::new(|| {
        let frames = scene_of(TINY, 1, &[thing(2, [12.0, 10.0], |t| [4.0 + 3.0 * t as f32, 6.0])], 3).0;
        let pairs = frames.windows(2).map(|pair| solve_pair(&pair[0], &pair[1], &fast()).unwrap()).collect();
        (frames, pairs)
    });
    Film { frames: &MADE.0, pairs: &MADE.1 }
}

/// Commands, each until it has settled.
struct Told {
    /// With their steps; without those that were refused.
    commands: Vec<(String, Action)>,
    journal: Vec<u8>,
    /// Everything that was known at any time.
    known: BTreeSet<String>,
    end: (u64, [usize; 3]),
}

fn told(film: &Film<'_>, seed: u64) -> Told {
    let mut player = Player::new(film);
    let (mut commands, mut known) = (Vec::new(), BTreeSet::from([summary(&player.clip)]));
    for action in script(seed, ACTIONS, film.frames.len(), TINY) {
        if !matches!(action, Action::Give(_)) {
            continue;
        }
        let outcome = player.act(&action, None);
        if outcome.starts_with("StepId") {
            commands.push((outcome, action));
        }
        known.insert(summary(&player.clip));
        while player.take(true) {
            player.keep();
            known.insert(summary(&player.clip));
        }
    }
    let journal = player.journal.clone();
    Told { commands, journal, known, end: player.end() }
}

#[test]
fn a_journal_that_is_cut_at_any_byte_is_that_of_a_clip_before() {
    let film = tiny();
    for seed in CUT {
        let Told { commands, journal, known, end } = told(&film, seed);
        let mut ends = Vec::new();
        for length in 0..=journal.len() {
            let Ok(Recovered { clip, used, is_damaged, .. }) = Clip::read(&journal[..length], OpenOptions::default())
            else {
                assert!(length < FIRST, "seed {seed}, cut at {length}");
                continue;
            };
            assert!(used <= length && !is_damaged, "seed {seed}, cut at {length}");
            if ends.last() == Some(&used) {
                continue;
            }
            ends.push(used);
            assert!(known.contains(&summary(&clip)), "seed {seed}, cut at {length}: no state that there was");
            // What was lost is given again, and what is written then is read with what was kept.
            let mut player = Player::new(&film);
            (player.clip, player.journal) = (clip, journal[..used].to_vec());
            let next = Clip::read(&journal[..used], OpenOptions::default()).unwrap().clip.apply(segment(0..2)).unwrap();
            for (step, action) in &commands[commands.len().min(number(next) - 1)..] {
                while player.take(true) {}
                assert_eq!(player.act(action, None), *step, "seed {seed}, cut at {length}");
            }
            while player.take(true) {}
            player.keep();
            player.clip = read(&player.journal);
            assert_eq!(player.end(), end, "seed {seed}, cut at {length}");
        }
        assert!(ends.len() > 15 && ends.last() == Some(&journal.len()), "{}", ends.len());
    }
}

/// The number in a step.
fn number(step: StepId) -> usize {
    format!("{step:?}").trim_matches(|c: char| !c.is_ascii_digit()).parse().unwrap()
}

#[test]
fn a_damaged_journal_is_that_of_a_clip_before_the_damage() {
    let film = tiny();
    for seed in CUT {
        let Told { journal, known, .. } = told(&film, seed);
        for at in 0..journal.len() {
            let mut bytes = journal.clone();
            bytes[at] ^= [1, 0x80, 0xff, 0x10][at % 4];
            let read = Clip::read(&bytes, OpenOptions::default());
            assert_eq!(read.is_err(), at < FIRST, "seed {seed}, byte {at}");
            if let Ok(Recovered { clip, used, is_damaged, .. }) = read {
                // Also in the last record: nothing is taken for the end of a record that is there as a whole.
                assert!(used <= at && is_damaged, "seed {seed}, byte {at}");
                assert!(known.contains(&summary(&clip)), "seed {seed}, byte {at}: no state that there was");
            }
        }
        // Zeros in the place of what was not written are no damage; other bytes are.
        for (byte, is_damage) in [(0, false), (7, true)] {
            let read = Clip::read(&[&journal[..], &[byte; 40]].concat(), OpenOptions::default()).unwrap();
            assert_eq!((read.used, read.is_damaged), (journal.len(), is_damage));
        }
    }
}

#[test]
fn a_journal_that_grows_is_compacted_and_stays_the_same_clip() {
    let mut clip = start();
    let mut journal = clip.save();
    let mut random = Random::from_seed(1);
    let (mut replaced, mut count) = (0, 0);
    while replaced < 2 {
        let labels: Vec<u8> = (0..PIXELS).map(|_| [0, 1, 255][random.uniform(0.0, 3.0) as usize]).collect();
        let spread = Spread::Exact;
        let step = clip
            .apply(Command::Annotate(vec![Annotation {
                frame: count % 3,
                content: Content::Mask { object: 9, labels },
                spread,
            }]))
            .unwrap();
        run(&mut clip);
        count += 1;
        // Not while anything is under way.
        let range = clip.apply(segment(0..2)).unwrap();
        let events = clip.take_events();
        assert!(!events.replaces && events.settled[0].step == step);
        journal.extend(events.records);
        clip.cancel(range);
        let events = clip.take_events();
        if events.replaces {
            let before = std::mem::take(&mut journal);
            assert!(before.len() > 1 << 20 && events.records.len() < before.len());
            journal = events.records;
            assert!(journal == clip.save());
            replaced += 1;
            let mut again = read(&journal);
            let mut last = read(&before);
            assert!(last.cancel(range));
            assert_eq!(again.steps(), clip.steps());
            assert_eq!(print(&mut again), print(&mut clip));
            last.undo();
            again.undo();
            assert_eq!(print(&mut again), print(&mut last), "an undone step of the journal before");
        } else {
            journal.extend(events.records);
        }
        assert!(count < 400);
    }
    settle(&mut clip, said(1, Content::Strokes { object: 8, labels: vec![1; PIXELS] })).unwrap();
    journal.extend(clip.take_events().records);
}
