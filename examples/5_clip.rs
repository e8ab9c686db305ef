//! A clip from its opening to its closing: segmented, corrected by a stroke, undone, and read again from its journal. Two things move
//! before a background; the frames are made for the purpose.

use scenes::{ClipSceneOptions, generate_clip};
use veronese::clip::{Annotation, Clip, Command, Content, OpenOptions};
use veronese::{Frame, Result, SegmentOptions};

/// Gives the clip the frames that it wants. Returns the number of pixels of each object in each frame.
fn masks(clip: &mut Clip, frames: &[Frame]) -> Result<Vec<Vec<usize>>> {
    let mut masks = Vec::new();
    for index in 0..frames.len() {
        clip.look_at(index);
        while let Some(wanted) = clip.wanted() {
            clip.take(wanted.frame, &frames[wanted.frame], None)?;
        }
        masks.extend(clip.labels(index).map(|frame| frame.objects.iter().map(|object| object.pixels).collect()));
    }
    Ok(masks)
}

/// Public: the tests run it, too.
pub fn main() -> Result<()> {
    let options = ClipSceneOptions { frames: 5, objects: 2, ..ClipSceneOptions::default() };
    let scene = generate_clip(&options)?;
    let frames = &(0..options.frames).map(|t| scene.frame(t)).collect::<Result<Vec<_>>>()?;

    // The journal is a file, a database or, as here, memory. What is in it survives everything.
    let mut journal = Vec::new();
    let mut clip = Clip::new(frames.len(), OpenOptions::default());
    clip.apply(Command::Segment { frames: 0..frames.len(), options: SegmentOptions::default() })?;
    println!("found:     {:?}", masks(&mut clip, frames)?);

    // A stroke in frame 2: these pixels are a new object's. The frames before and after follow.
    let width = frames[0].width();
    let is_in = |p: usize| (30..50).contains(&(p % width)) && (30..50).contains(&(p / width));
    let labels = (0..width * frames[0].height()).map(|p| if is_in(p) { 1 } else { 255 }).collect();
    clip.apply(Command::Annotate(vec![Annotation::new(2, Content::Strokes { object: 9, labels })]))?;
    println!("corrected: {:?}", masks(&mut clip, frames)?);

    clip.undo();
    println!("undone:    {:?}", masks(&mut clip, frames)?);
    clip.redo();
    journal.extend(clip.take_events().records);

    let mut again = Clip::read(&journal, OpenOptions::default())?.clip;
    println!("again:     {:?}", masks(&mut again, frames)?);
    println!("{} bytes of journal, {} steps", journal.len(), again.steps()[0]);
    Ok(())
}
