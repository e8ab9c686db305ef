//! Clips: objects keep their numbers from their first frame to their last.
//!
//! 1. Each frame is prepared once and solved in pairs with the next and the previous frame (`clip/pairing.rs`) and, where these show no
//!    object, with an earlier frame (`clip/farther.rs`). Pauses do not count as background (`clip/held.rs`).
//! 2. The log-odds of each pixel are carried along the motions, colours are learned, and the foreground is cut, in two rounds
//!    (`clip/foreground.rs`).
//! 3. The foreground of each frame is assigned to the objects of the previous frame, or to new ones (`clip/identity.rs`).
//! 4. In a whole clip, objects that move apart are divided in the earlier frames as well (`clip/parting.rs`), parts that move together are
//!    joined, and objects of a few frames are dropped (`clip/grouping.rs`).
//! 5. Labels are upsampled along the edges of the full frame (`clip/description.rs`).
//!
//! A [`StreamSegmenter`] does all this frame by frame, for frames that come once. A [`Clip`] keeps the labels at the working size, from its
//! opening to its closing: it is segmented in one range of frames or several, returns the labels of any frame, takes annotations, undoes
//! them, and can be read again from its journal (`clip/session.rs`).

mod annotation;
mod carry;
mod changes;
mod colours;
mod command;
mod correction;
mod description;
mod edits;
mod farther;
mod foreground;
mod frame_annotation;
mod frame_state;
mod grouping;
mod held;
mod identity;
mod job;
mod layer;
mod objects;
mod options;
mod overlay;
mod pairing;
mod pairs;
mod parting;
mod record;
mod runs;
mod saved;
mod segmented_clip;
mod segmenter;
mod session;
mod stream;
mod tracker;
mod tracks;

pub use annotation::{Click, Spread};
pub use changes::Changed;
pub use command::{Annotation, Command, Content, Declaration};
pub use description::{ClipFrame, ClipObject};
pub use objects::Description;
#[cfg(feature = "ablation")]
#[doc(hidden)]
pub use options::vary;
pub use options::{ClipOptions, MAX_LOOK_AHEAD};
pub use segmenter::{FramePairs, solve_pair};
pub use session::{Clip, ClipStage, Events, FrameStatus, Object, OpenOptions, Recovered, Settled, StepId, Wanted};
pub use stream::StreamSegmenter;
pub use tracks::{ClipTrack, ClipTracks};

// What the npm package calls: a segmented clip whose states the caller keeps.
#[doc(hidden)]
pub use annotation::{Accepted, Annotations, Painted, Prompt};
#[doc(hidden)]
pub use job::ClipJob;
#[doc(hidden)]
pub use segmented_clip::SegmentedClip;
#[doc(hidden)]
pub use segmenter::ClipSegmenter;
