//! When the events of a shot happen, read off what is in sight.

use std::ops::Range;

use super::super::render::each_covered;
use super::script::Script;
use super::{Event, Occurrence};

/// The parts, one bit each, that cover more than half of every pixel.
pub(super) fn coverage(script: &Script, moment: f64, size: [usize; 2]) -> Vec<u64> {
    let mut covered = vec![0u64; size[0] * size[1]];
    let shapes = script.actors.iter().flat_map(|actor| &actor.parts).map(|part| (part.shape.clone(), [0.0; 2]));
    for (k, (shape, warp)) in shapes.zip(script.parts(moment)).enumerate() {
        each_covered(Some(&shape), &warp.inverse(), size, |p, _, cover| {
            if cover > 0.5 {
                covered[p] |= 1 << k;
            }
        });
    }
    covered
}

/// The part in front of the others.
pub(super) fn front(parts: u64) -> Option<usize> {
    parts.checked_ilog2().map(|part| part as usize)
}

/// Numbers of pixels of an object at one moment.
#[derive(Clone, Copy, Default)]
struct Sight {
    /// Inside the frame.
    inside: usize,
    /// In sight.
    seen: usize,
    /// At the border of the frame.
    border: usize,
}

/// The objects that are in sight in a shot.
pub(super) struct Watch<'a> {
    script: &'a Script,
    size: [usize; 2],
    moments: Vec<Vec<u64>>,
}

impl Watch<'_> {
    pub(super) fn of(script: &Script, size: [usize; 2]) -> Watch<'_> {
        let moments = (0..script.camera.moments).map(|moment| coverage(script, moment as f64, size)).collect();
        Watch { script, size, moments }
    }

    /// When an event happens to these objects; `None` if it does not, or not as it should.
    pub(super) fn occurrence(&self, event: Event, objects: &[u8]) -> Option<Occurrence> {
        let count = self.moments.len();
        let sights: Vec<Sight> = (0..count).map(|moment| self.sight(objects[0], moment)).collect();
        let when = |what: &dyn Fn(usize) -> bool| range((0..count).filter(|&moment| what(moment)));
        let at_ends = |what: &dyn Fn(&Sight) -> bool| [&sights[0], &sights[count - 1]].map(what);
        let seen = |s: &Sight| s.seen > 0;
        let free = |s: &Sight| s.seen > 0 && s.border == 0;
        let mostly = sights.iter().filter(|s| 2 * s.seen > s.inside).count() * 10 >= 9 * count;
        let frames = match event {
            Event::Crossing => when(&|moment| self.overlap(objects, moment)).filter(|_| at_ends(&seen) == [true; 2])?,
            Event::HiddenByBackground | Event::HiddenByObject => {
                when(&|moment| sights[moment].inside > 0 && sights[moment].seen == 0)
                    .filter(|hidden| hidden.len() <= 10 && at_ends(&seen) == [true; 2])?
            }
            Event::StopAndGo => {
                let actor = self.script.actors.iter().find(|actor| actor.number == objects[0])?;
                when(&|moment| actor.path.rests(moment)).filter(|_| mostly)?
            }
            Event::Entering => {
                let from = sights.iter().position(seen).filter(|&from| from > 0)?;
                from..sights.iter().position(free)?
            }
            Event::Leaving => {
                let until = sights.iter().rposition(seen)? + 1;
                sights.iter().rposition(free).filter(|_| until < count)? + 1..until
            }
            _ => Some(0..count).filter(|_| mostly)?,
        };
        // An event that lasts from the first moment or to the last began before the shot or is not over when it ends.
        let whole = matches!(event, Event::Articulated | Event::Slow | Event::Fast);
        let inside = whole || (frames.start > 0 && frames.end < count && !frames.is_empty());
        inside.then(|| Occurrence { event, objects: objects.to_vec(), frames })
    }

    fn sight(&self, object: u8, moment: usize) -> Sight {
        let owners = self.script.owners();
        let own = (0..owners.len()).filter(|&part| owners[part] == object).fold(0u64, |bits, part| bits | 1 << part);
        let [width, height] = self.size;
        let mut sight = Sight::default();
        for (p, &parts) in self.moments[moment].iter().enumerate().filter(|&(_, parts)| parts & own != 0) {
            let (x, y) = (p % width, p / width);
            sight.inside += 1;
            sight.seen += usize::from(front(parts).is_some_and(|part| own >> part & 1 == 1));
            sight.border += usize::from(x == 0 || y == 0 || x + 1 == width || y + 1 == height);
        }
        sight
    }

    /// Whether all of these objects cover some pixel.
    fn overlap(&self, objects: &[u8], moment: usize) -> bool {
        let owners = self.script.owners();
        let covers =
            |parts: u64, object: u8| (0..owners.len()).any(|part| owners[part] == object && parts >> part & 1 == 1);
        self.moments[moment].iter().any(|&parts| objects.iter().all(|&object| covers(parts, object)))
    }
}

/// The range of increasing numbers without a gap; `None` if there is a gap, or no number.
fn range(numbers: impl Iterator<Item = usize>) -> Option<Range<usize>> {
    let numbers: Vec<usize> = numbers.collect();
    let (&first, &last) = (numbers.first()?, numbers.last()?);
    (last + 1 - first == numbers.len()).then_some(first..last + 1)
}
