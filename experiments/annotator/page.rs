//! Writes docs/annotating.md from the figures that the steps have left.

use std::fmt::Write;

use crate::measure::Row;
use crate::{measure, objects, pairs};

const HEAD: &str = "\
# Annotating

This page measures what an annotator gets for what he says of a clip: a mask of one frame, a click, strokes. All of it but the figures of
[the page](#in-the-page) is written by

```sh
npm run bench:annotator -- --write-docs
```

which measures every clip again. All figures of ours except the times are the same on every machine. J is the intersection over union
of an object's label and its true mask, the mean over frames; experiments/annotator defines the figures.

";

const PROTOCOL: &str = "\
- **auto**: J of everything but the label with most pixels of the clip, when nothing is said; all frames;
- **mask**: the true mask of the first frame is given; J of its label in the frames between the first and the last, as in the
  semi-supervised protocol of DAVIS 2016;
- **OpenCV**: the same of a baseline: the mask is carried along dense flow (DIS), and GrabCut decides in a band around its border
  (experiments/annotator/peers.py);
- **box**: the smallest box around the true mask of the first frame points to the object; J of what is found at once in that frame;
  **GrabCut**: the same of OpenCV's, 5 iterations at full size; **box, clip**: J as for *mask* when that is carried on;
- **touch**, **touch, clip**: the same of a click at the deepest pixel of the true mask, under a new number;
- **click**: J of the one label that fits best over the clip, as one click gives it; all frames;
- **round 1, 2, …**: a robot goes on from the click. It looks at the frame with the lowest J and draws one stroke in the largest missed
  region and one in the largest wrong region: the pixels at least half as deep in the region as its deepest. Regions below 0.05 % of the
  frame are left. Everything said of a frame counts together;
- **s a round**, **ms a frame**, **ms a box**, **ms a touch**: time of native code for the correction of a round, for each frame that a
  correction changed, masks included, and for the mask that a box or a click points to, with decoded frames, on one core of a machine in
  use.

The clips are training sequences of [DAVIS 2016](https://davischallenge.org), at most 33 frames each, 854 × 480 pixels, taken as
CC BY-NC 4.0; this page shows no pictures of them. They are measured if they are in `../shared/data/clips` next to the checkout. *Old*
are the ten that constants of clips were first set on, *new* the others.

";

const PUBLISHED: &str = "\
### Published figures

J with the true mask of the first frame given, of methods without learning. These clips are other ones, and longer: the figures show
where the field stands and cannot be compared with ours one to one, which are of at most 33 frames of training sequences.

| method | J | clips | frames |
|---|---|---|---|
| OFL, object flow (Tsai et al. 2016) | 0.680 | DAVIS 2016 val, 20 clips | all |
| BVS, bilateral space (Märki et al. 2016) | 0.600 | DAVIS 2016 val, 20 clips | all |
| FCP, fully connected proposals (Perazzi et al. 2015) | 0.584 | DAVIS 2016 val, 20 clips | all |
| JMP, JumpCut (Fan et al. 2015) | 0.570 | DAVIS 2016 val, 20 clips | all |
| HVS, hierarchical graph (Grundmann et al. 2010) | 0.546 | DAVIS 2016 val, 20 clips | all |
| SEA, SeamSeg (Avinash Ramakanth and Babu 2014) | 0.504 | DAVIS 2016 val, 20 clips | all |

Source: the benchmark of DAVIS 2016 (Perazzi et al., *A Benchmark Dataset and Evaluation Methodology for Video Object Segmentation*,
CVPR 2016, and the results on its site).

";

const OBJECTS: &str = "\
## Several objects

Generated clips with exact truth, 320 × 240 pixels, 32 frames, four of each kind; every second one has a camera that pans. The masks of
all objects in sight in the first frame are given at once, each with its number, and everything else as background.

- **assigned**: mean J of an object's number over the frames after the first in which the object is in sight; the mean over objects;
- **after strokes**: the same when the robot has drawn strokes for the object in the worst of those frames, on pixels that are no other
  given object's;
- **pixels of others changed**: how many pixels of the other given objects these strokes have changed, in all frames.

In clips of *similar colours* and *all together* all objects are cut from one cloth.

";

const PAIRS: &str = "\
## Strokes on a pair

Four pairs of neighbouring frames of each clip, if something was found to move. The motions with more than half of their pixels inside the
true mask are the object; the robot draws its strokes for it in the first frame, round after round.

- **found**: J of these motions when nothing is said;
- **ms**: time of native code for a correction, on one core of a machine in use.

";

/// Around the figures that the benchmark of the page writes.
const BY_PAGE: [&str; 2] =
    ["<!-- begin page: written by npm run bench:annotator with --page -->\n", "<!-- end page -->\n"];

const PAGE: &str = "\
## In the page

An expert annotates clips in the page, from their frames to a file for CVAT, in headless Chromium. The figures are written by

```sh
npm run bench:annotator -- --page --write-docs
```

It is a program that knows the truth, but has only the mouse, the keyboard and what is on screen (scripts/lib/annotator). An action is
a press of a key, a click, a box, a stroke, or the choice of files or of an entry in a menu. Opening the frames, starting the
segmentation, accepting all frames, opening the panel of exports and saving are actions too; looking is none, at whichever frame.

The expert looks for the largest region that the object misses or has wrongly in a frame, and rather far from the frames that he has
corrected, because their neighbours follow them. He goes there and paints it in one stroke, as far as the brush fits into it. Where the object
was not found he draws a box around it, and pieces of it he merges. He stops when J on screen is 0.805, or when the next correction would
leave too few of 20 actions to save.

These rules were chosen on motorbike: with the largest region wherever it was, and a thicker brush, it ended at J 0.790 after 18 actions. So
its figures say what can be reached in the page, not what to expect of another clip. Other programs kept both cores busy during the run below,
so its seconds say little.

- **found**: J of the object before corrections;
- **actions**: how many from opening the frames to the saved file;
- **seconds**: time of these actions and of what the page computes after each, on a machine in use;
- **J**: that of the object's track in the file, with polygons as CVAT gets them.

";

const PARTS: &str = "\
## What parts are worth

Measured once. The learning has no constant; the limits of the views were chosen on the generated clips of this page.

| part | figure | without | with | on |
|---|---|---|---|---|
| all that is said of an object is learnt before it is followed | round 1, 2, 3, 4 | 0.757 0.761 0.777 0.788 | 0.757 0.774 0.795 0.809 | the real clips; not fitted |
| one that is hidden is looked for by the view of it | assigned | 0.825 | 0.897 | the generated clips, chosen there |
| | assigned | – | 0.870 | twenty clips of other seeds |
| one that is partly hidden is looked for near its place only | mask | 0.807 | 0.815 | the real clips |
| | box, clip | 0.736 | 0.753 | the real clips |

Tried, and left out because they gained less than chance or lost: to look for what is hidden among the things found automatically that
no other object has (assigned 0.897 → 0.897 and 0.870 → 0.875 where these must look alike closely, 0.884 and 0.861 else); to learn an
object's velocity only while all of it is seen (0.893 and 0.856); to accept a view as changed sooner (0.876; mask 0.806); other limits
for a view to count as seen (0.887 to 0.895, and 0.851 to 0.880, no choice the best of both).

";

const CONSTANTS: &str = "\
## Constants

Nine constants of the propagation (`ClipModel` in src/model.rs) are fitted: `npm run bench:annotator -- fit` moves each by factors of 1.25 while
that helps the mean of *mask* and *round 1* on half of the real clips (every second one by name), and scores the other half, which it has
not seen. Scores are those of the constants used and of the fitted ones.

";

/// The page; sections without figures are left out. `before` is what it was: the figures of the page stay.
pub(crate) fn text(
    real: &[Row],
    generated: &[objects::Row],
    strokes: &[pairs::Row],
    fit: Option<&str>,
    before: &str,
) -> String {
    let mut text = String::from(HEAD);
    let quality = real.first().map(|row| &row.quality).or(generated.first().map(|row| &row.quality));
    if let Some(quality) = quality {
        let _ = writeln!(text, "The quality is *{quality}*.\n");
    }
    if !real.is_empty() {
        let _ = writeln!(text, "## One object\n\n{}\n{PROTOCOL}{PUBLISHED}", measure::table(real, false));
        let _ = writeln!(text, "### By clip\n\n{}", measure::table(real, true));
    }
    if !generated.is_empty() {
        let _ = writeln!(text, "{OBJECTS}{}", objects::table(generated, false));
        let _ = writeln!(
            text,
            "### By generated clip\n\nA name has the kind and the seed.\n\n{}",
            objects::table(generated, true)
        );
    }
    if !strokes.is_empty() {
        let _ = write!(text, "\n{PAIRS}{}", pairs::table(strokes));
    }
    let [begins, ends] = BY_PAGE;
    let by_page = before.split_once(begins).and_then(|(_, rest)| rest.split_once(ends)).map_or("", |(part, _)| part);
    let _ = write!(text, "\n{PAGE}{begins}{by_page}{ends}");
    if !real.is_empty() && !generated.is_empty() {
        let _ = write!(text, "\n{PARTS}");
    }
    if let Some(fit) = fit {
        let _ = write!(text, "\n{CONSTANTS}{fit}");
    }
    text
}
