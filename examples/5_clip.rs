//! A clip from its opening to its closing: segmented, corrected by a stroke, undone, and read again from its journal. Two things move
//! before a background; the frames are made for the purpose.

use scenes::{ClipSceneOptions, generate_clip};
use veronese::clip::{Annotation, Clip, Command, Content, OpenOptions};
use veronese::{Quality, Result, SegmentOptions};

/// Public: the tests run it, too.
pub fn main() -> Result<()> {
    let options = ClipSceneOptions { width: 160, height: 120, frames: 30, objects: 2, ..ClipSceneOptions::default() };
    let scene = generate_clip(&options)?;

    // The objects of frame 20, by number, with their numbers of pixels. The clip asks for the frames that it needs.
    let objects = |clip: &mut Clip| -> Result<Vec<(u8, usize)>> {
        clip.look_at(20);
        clip.run(|index| scene.frame(index))?;
        let frame = clip.labels(20).unwrap_or_default();
        Ok(frame.objects.iter().map(|object| (object.id, object.pixels)).collect())
    };

    let mut clip = Clip::new(options.frames, OpenOptions::default())?;
    let fast = SegmentOptions::default().with_quality(Quality::Fast);
    clip.apply(Command::Segment { frames: 0..options.frames, options: fast })?;
    println!("found: {:?}", objects(&mut clip)?);

    // A stroke in frame 15: these pixels are a new object's. The frames before and after follow.
    let is_in = |p: usize| (60..80).contains(&(p % 160)) && (20..40).contains(&(p / 160));
    let labels = (0..160 * 120).map(|p| if is_in(p) { 1 } else { 255 }).collect();
    clip.apply(Command::Annotate(vec![Annotation::new(15, Content::Strokes { object: 9, labels })]))?;
    println!("corrected: {:?}", objects(&mut clip)?);

    clip.undo();
    println!("undone: {:?}", objects(&mut clip)?);
    clip.redo();

    // The journal is a file, a database or, as here, memory. What is in it survives everything.
    let journal = clip.take_events().records;
    let mut again = Clip::read(&journal, OpenOptions::default())?.clip;
    println!("read again: {:?}", objects(&mut again)?);
    println!("{} bytes of journal for {} steps", journal.len(), again.steps()[0]);
    Ok(())
}
