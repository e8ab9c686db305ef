//! The journal of a clip: an append-only log of records, from which the clip can be read again.
//!
//! A head of 16 bytes is followed by records. A record is its kind, the length of its content, a check of both, the content, and a hash of
//! all that, seeded with the hash of the record before: a record that is missing, damaged or cut off ends the reading.

use super::history::Difference;
use crate::clip::saved::Saved;
use crate::hash::hash;

/// The first bytes of a journal: the name of the format, its version and a zero.
const HEAD: &[u8; 16] = b"VERONESE CLIP\x01\0\0";

/// Bytes of a record before its content, and after it.
const BEFORE: usize = 6;
const AFTER: usize = 8;

/// What a record contains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// The number of frames.
    Open = 1,
    /// A frame and its solved pairs.
    Pairs = 2,
    /// A command, when it is given.
    Command = 3,
    /// What a command has changed, when it has taken effect.
    Result = 4,
    /// The current step, after undo or redo.
    Current = 5,
    /// A command that was cancelled or failed.
    Dropped = 6,
    /// The labels of a frame as they are shown.
    Shown = 7,
    /// Where a range ends, and whether all its frames have been in.
    Range = 8,
}

impl Kind {
    fn of(code: u8) -> Option<Kind> {
        use Kind::{Command, Current, Dropped, Open, Pairs, Range, Result, Shown};
        [Open, Pairs, Command, Result, Current, Dropped, Shown, Range].into_iter().find(|kind| *kind as u8 == code)
    }
}

/// A log that is being written.
#[derive(Clone, Debug)]
pub(super) struct Log {
    /// Records that the host has not taken yet.
    records: Vec<u8>,
    /// The hash of the last record.
    last: u64,
    /// Length of the whole log, bytes.
    pub(super) length: usize,
    /// Its length when it was compacted last, bytes.
    pub(super) compacted: usize,
    /// Whether the records are the whole log, in place of the one before.
    replaces: bool,
}

impl Log {
    /// A new log.
    pub(super) fn new() -> Log {
        Log { records: HEAD.to_vec(), last: 0, length: HEAD.len(), compacted: 0, replaces: true }
    }

    /// A new log of about so many bytes.
    pub(super) fn with_capacity(bytes: usize) -> Log {
        let mut log = Log::new();
        log.records.reserve(bytes);
        log
    }

    /// A log that goes on after the records that were read, of which about so many bytes are still needed.
    pub(super) fn after(reader: &Reader<'_>, compacted: usize) -> Log {
        Log { records: Vec::new(), last: reader.last, length: reader.used, compacted, replaces: false }
    }

    pub(super) fn append(&mut self, kind: Kind, content: &dyn Saved) {
        let start = self.records.len();
        self.records.push(kind as u8);
        [0u8; BEFORE - 1].write(&mut self.records);
        content.write(&mut self.records);
        let length = self.records.len() - start - BEFORE;
        let head = head(kind as u8, length);
        self.records[start..start + BEFORE].copy_from_slice(&head);
        self.last = hash(self.last, &self.records[start..]);
        self.last.write(&mut self.records);
        self.length += self.records.len() - start;
    }

    /// Puts a compacted log in the place of this one.
    pub(super) fn replace(&mut self, compacted: Log) {
        let length = compacted.length;
        *self = Log { compacted: length, replaces: true, ..compacted };
    }

    /// The records since the last call, and whether they replace the log.
    pub(super) fn take(&mut self) -> (Vec<u8>, bool) {
        let replaces = std::mem::take(&mut self.replaces);
        (std::mem::take(&mut self.records), replaces)
    }
}

/// Reads the records of a log.
pub(super) struct Reader<'b> {
    bytes: &'b [u8],
    /// The hash of the last record.
    last: u64,
    /// Number of bytes that were read.
    pub(super) used: usize,
}

impl<'b> Reader<'b> {
    /// `None` for bytes that are no log of this format.
    pub(super) fn new(bytes: &'b [u8]) -> Option<Reader<'b>> {
        bytes.starts_with(HEAD).then_some(Reader { bytes, last: 0, used: HEAD.len() })
    }

    /// The next record; `None` at the end, and where a record is cut off or damaged.
    pub(super) fn next(&mut self) -> Option<(Kind, &'b [u8])> {
        let rest = self.bytes.get(self.used..)?;
        let length = length_of(rest)?;
        let end = length.checked_add(BEFORE)?;
        let (record, mut sum) = (rest.get(..end)?, rest.get(end..end.checked_add(AFTER)?)?);
        let hash = hash(self.last, record);
        // A fuzzer does not guess sums.
        if u64::read(&mut sum)? != hash && !cfg!(fuzzing) {
            return None;
        }
        let kind = Kind::of(record[0])?;
        self.last = hash;
        self.used += end + AFTER;
        Some((kind, &record[BEFORE..]))
    }

    /// Goes back before the record that was read last, whose length is given: its content is not valid.
    pub(super) fn refuse(&mut self, content: &[u8], last: u64) {
        self.used -= BEFORE + content.len() + AFTER;
        self.last = last;
    }

    /// The hash of the last record.
    pub(super) fn hash(&self) -> u64 {
        self.last
    }

    /// Whether what could not be read is damaged. The beginning of a record that was cut off is not, nor are zeros that a file system has put
    /// in the place of what was not written.
    pub(super) fn is_damaged(&self) -> bool {
        let rest = self.bytes.get(self.used..).unwrap_or_default();
        let is_cut_off = match length_of(rest) {
            Some(length) => rest.len() < length.saturating_add(BEFORE + AFTER),
            None => rest.len() < BEFORE,
        };
        !is_cut_off && rest.iter().any(|&byte| byte != 0)
    }
}

/// The bytes before the content of a record: its kind, the length of its content, and the sum of these bytes.
fn head(kind: u8, length: usize) -> [u8; BEFORE] {
    let [a, b, c, d] = (length as u32).to_le_bytes();
    let sum = [kind, a, b, c, d].into_iter().fold(0x5a_u8, |sum, byte| sum.rotate_left(3).wrapping_add(byte));
    [kind, a, b, c, d, sum]
}

/// The length of the content of a record; `None` if its head is cut off or damaged.
fn length_of(record: &[u8]) -> Option<usize> {
    let found = record.first_chunk::<BEFORE>()?;
    let length = usize::read(&mut &found[1..5])?;
    (*found == head(found[0], length)).then_some(length)
}

/// A content of a record that is written already.
#[derive(Clone, Debug)]
pub(super) struct Written(pub(super) Vec<u8>);

impl Saved for Written {
    fn write(&self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(&self.0);
    }

    fn read(bytes: &mut &[u8]) -> Option<Written> {
        Some(Written(std::mem::take(bytes).to_vec()))
    }
}

/// The content of a record of where a range ends, and whether all its frames have been in.
pub(super) fn range_record(step: u32, end: usize, is_complete: bool) -> Written {
    let mut bytes = Vec::new();
    ([step as usize, end], is_complete).write(&mut bytes);
    Written(bytes)
}

/// The content of a record of what a step has changed.
pub(super) fn result(step: u32, parent: u32, difference: &Difference, is_open: bool, is_first: bool) -> Written {
    let mut bytes = Vec::new();
    [step as usize, parent as usize].write(&mut bytes);
    difference.write(&mut bytes);
    [is_open, is_first].write(&mut bytes);
    Written(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clip::{Annotation, Clip, Command, Content, OpenOptions, Spread};
    use crate::{Frame, Quality, Random, SegmentOptions};

    /// The log with other bytes, and sums that fit them: as of somebody who can compute sums.
    fn sealed(bytes: &[u8], changed: impl Fn(usize, Kind, Vec<u8>) -> Vec<u8>) -> Vec<u8> {
        let mut reader = Reader::new(bytes).expect("it is a log");
        let mut log = Log::new();
        let mut at = 0;
        while let Some((kind, content)) = reader.next() {
            let content = changed(at, kind, content.to_vec());
            log.append(kind, &super::super::Written(content));
            at += 1;
        }
        log.take().0
    }

    fn frames() -> Vec<Frame> {
        let value = |t: usize, p: usize| {
            let [x, y] = [p % 32, p / 32];
            let is_in = (4 + 3 * t..16 + 3 * t).contains(&x) && (6..16).contains(&y);
            let seed = if is_in { 7 * (x - 3 * t) + 13 * y } else { 11 * x + 5 * y };
            (seed.wrapping_mul(seed) >> 2) as u8
        };
        let rgba =
            |t: usize| (0..32 * 24).flat_map(|p| [value(t, p), value(t, p), value(t, p), 255]).collect::<Vec<u8>>();
        (0..3).map(|t| Frame::from_rgba(32, 24, rgba(t)).expect("a frame")).collect()
    }

    /// Gives the clip all frames that it wants, as far as they are the right ones.
    fn run(clip: &mut Clip, frames: &[Frame]) {
        for _ in 0..200 {
            let Some(wanted) = clip.wanted() else { return };
            if frames.get(wanted.frame).is_none_or(|frame| clip.take(wanted.frame, frame, None).is_err()) {
                match wanted.step {
                    Some(step) => assert!(clip.cancel(step)),
                    None => clip.look_at(usize::MAX),
                }
            }
        }
        panic!("it does not end");
    }

    fn journal(frames: &[Frame]) -> Vec<u8> {
        let mut clip = Clip::new(3, OpenOptions::default()).unwrap();
        let options = SegmentOptions::default().with_quality(Quality::Fast);
        let content =
            Content::Strokes { object: 7, labels: (0..32 * 24).map(|p| if p % 32 < 9 { 1 } else { 255 }).collect() };
        let commands = [
            Command::Segment { frames: 0..3, options },
            Command::Annotate(vec![Annotation::new(1, content.clone())]),
            Command::Annotate(vec![Annotation { frame: 0, content: content.clone(), spread: Spread::Exact }]),
            Command::Accept { frames: vec![1], on: true },
        ];
        for command in commands {
            clip.apply(command).expect("the command is valid");
            run(&mut clip, frames);
        }
        clip.undo();
        clip.look_at(1);
        run(&mut clip, frames);
        clip.apply(Command::Segment { frames: 0..3, options }).expect("the range is valid");
        clip.take(0, &frames[0], None).expect("the first frame");
        clip.apply(Command::Annotate(vec![Annotation::new(1, content)])).expect("the command is valid");
        clip.take_events().records
    }

    #[test]
    fn records_that_somebody_has_changed_are_refused_or_are_those_of_a_clip() {
        read_changed_records(0..400);
    }

    #[test]
    #[ignore = "npm run soak"]
    fn thousands_of_records_that_somebody_has_changed_are_refused_or_are_those_of_a_clip() {
        read_changed_records(400..4000);
    }

    fn read_changed_records(seeds: std::ops::Range<u64>) {
        let least = (seeds.end - seeds.start) / 40;
        let frames = frames();
        let original = journal(&frames);
        assert!(sealed(&original, |_, _, content| content) == original);
        let saved = Clip::read(&original, OpenOptions::default()).expect("it is a journal").clip.save();
        let mut read = [0; 2];
        for seed in seeds {
            let bytes = if seed % 2 == 0 { &original } else { &saved };
            let mut random = Random::from_seed(seed);
            let mut below = |limit: usize| random.uniform(0.0, limit as f64) as usize;
            let count = bytes.len() / 200;
            let (record, at, length) = (below(count.clamp(8, 24)), below(1 << 16), 1 + below(5));
            // Small numbers, that are indices, counts and objects, and large ones.
            let value = [below(8), below(256), 255, 0, 254][below(5)] as u8;
            let bytes = sealed(bytes, |index, kind, mut content| {
                if index == record && kind != Kind::Open && !content.is_empty() {
                    // Most at the beginning, where numbers are.
                    let at = if at % 3 == 0 { at % content.len() } else { at % content.len().min(40) };
                    content.iter_mut().skip(at).take(length).for_each(|byte| *byte = value);
                }
                content
            });
            let Ok(recovered) = Clip::read(&bytes, OpenOptions::default()) else { continue };
            read[usize::from(recovered.is_damaged)] += 1;
            let mut clip = recovered.clip;
            if clip.size()[0] > 48 || clip.size()[1] > 48 {
                continue;
            }
            run(&mut clip, &frames);
            for index in 0..clip.len() {
                clip.look_at(index);
                run(&mut clip, &frames);
            }
            drop((clip.tracks(), clip.objects(), clip.frames()));
            let options = SegmentOptions::default().with_quality(Quality::Fast);
            if seed % 16 == 0 && clip.apply(Command::Segment { frames: 0..3, options }).is_ok() {
                run(&mut clip, &frames);
            }
            assert!(
                !Clip::read(&clip.save(), OpenOptions::default()).expect("it is its own").is_damaged,
                "seed {seed}"
            );
            while clip.undo() {}
            assert!(!clip.frames().is_empty());
        }
        assert!(read.iter().all(|count| *count > least), "{read:?}");
    }
}
