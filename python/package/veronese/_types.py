"""Arguments and results of the calls besides arrays."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Callable, Iterator, List, Literal, Optional, Protocol, Sequence, Tuple, Union

import numpy as np
from numpy.typing import NDArray

from ._png import indexed_png

if TYPE_CHECKING:
    from ._veronese import Clip

Matrix = NDArray[np.float64]
"""``[a11, a12, a13, a21, a22, a23]``, shape ``(6,)``: the pixel (x, y) of the first frame is displaced by u = a11·x + a12·y + a13,
v = a21·x + a22·y + a23 pixels in the second. (0, 0) is the centre of the top-left pixel, x right, y down."""

LabelImage = NDArray[np.uint8]
"""One label per pixel, shape ``(height, width)``."""

Box = Tuple[int, int, int, int]
"""First column, first row, width and height of a rectangle, pixels."""

Click = Tuple[int, int, Literal[1, -1]]
"""Column and row of a pixel, and 1 if it belongs to an object, -1 if it does not."""

Colour = Tuple[int, int, int]
"""Red, green and blue, 0 to 255."""

ClipProgress = Callable[[str, int, Optional[int]], object]
"""Called when work on a frame begins, with the stage (``"pairs"`` or ``"annotations"``), the frame's index and the number of frames, ``None``
where it is not known. An exception that it raises ends the call, which changes nothing then."""


class SupportsArray(Protocol):
    """An object that NumPy makes an array of, such as a tensor."""

    def __array__(self) -> NDArray[np.uint8]: ...


class Picture(Protocol):
    """A picture of Pillow."""

    @property
    def mode(self) -> str: ...
    def convert(self, mode: str, /) -> Any: ...


Propagation = Literal["both", "forward", "backward", "none", "exact"]
"""The frames to which an annotation of a frame spreads: those before and after it, those on one side, or none. ``"exact"``: none, and no
other pixel of its frame changes; the labels are drawn over all others but those of locked objects."""


class VeroneseError(Exception):
    """An input that cannot be processed, and why. ``code`` is stable, the same as on the command line; the message may change."""

    code: str

    def __init__(self, code: str, message: str) -> None:
        super().__init__(message)
        self.code = code

    def __reduce__(self) -> Tuple[Any, ...]:
        return type(self), (self.code, *self.args)


@dataclass(frozen=True)
class Candidate:
    """A number of motions that was tried; a smaller score is better."""

    motions: int
    score: float


@dataclass(frozen=True, eq=False)
class SegmentedMotion:
    """One motion of a :class:`Segmentation`."""

    label: int
    matrix: Matrix
    pixels: int
    """Number of its pixels."""
    share: float
    """Their share of all pixels, 0 to 1."""
    residual: float
    """Root mean square of the motion-compensated intensity difference over its pixels, in grey levels (0 to 255)."""
    bbox: Box
    """Bounding box of its pixels."""
    group: int
    """Number of the group: motions that are parts of one thing share it; group 0 is the background."""


@dataclass(frozen=True)
class Junction:
    """The common border of two motions of a :class:`Segmentation`, and how likely both belong to one thing."""

    labels: Tuple[int, int]
    """The labels of the two motions, the smaller first."""
    likelihood: float
    """Probability, 0 to 1, that the two motions belong to one thing: one object, or one background."""
    border: int
    """Length of the border in pixels of the frame, measured at the working size."""


@dataclass(frozen=True, eq=False, repr=False)
class Segmentation:
    """The result of :func:`segment_pair`."""

    width: int
    height: int
    count: int
    """Number of motions."""
    motions: List[SegmentedMotion]
    """By decreasing number of pixels: ``motions[i].label == i``."""
    labels: LabelImage
    """One label per pixel of the first frame, an index of ``motions``; 255 is unlabelled."""
    junctions: List[Junction]
    """Neighbouring motions, by labels. Borders of a few pixels are left out."""
    candidates: List[Candidate]
    """Description lengths of both frames in nats, from one motion to one more than were found."""
    unlabelled: int
    """Number of pixels with label 255."""
    confidence: Optional[NDArray[np.uint8]]
    """255 times the probability that the label of each pixel is right; ``None`` unless it was asked for."""
    quality: Literal["best", "fast"]

    def __repr__(self) -> str:
        return f"Segmentation({self.width}×{self.height}, {_counted(self.count, 'motion')})"

    def png(self) -> bytes:
        """The labels as a PNG file: palette indices in the colours of the DAVIS benchmark."""
        return indexed_png(self.labels)

    def _repr_png_(self) -> bytes:
        """The image that a notebook shows."""
        return self.png()


@dataclass(frozen=True, eq=False)
class FittedMotion:
    """One motion of a :class:`MotionFit`."""

    label: int
    matrix: Matrix
    measurements: int
    """Number of measurements that belong to it."""
    determined: int
    """How many of the six parameters the measurements determine; below 6, the others are arbitrary."""
    covariance: Optional[NDArray[np.float64]]
    """Covariance of the six entries, shape ``(6, 6)``, with the labels taken as known; only with the method ``"best"``."""


@dataclass(frozen=True)
class RankCandidate:
    """The rank of the embedded data for a number of motions; the rule is satisfied if it is one less than the number of columns."""

    motions: int
    rank: int
    columns: int
    ratio: float


@dataclass(frozen=True)
class Refinement:
    """How a refinement ended."""

    termination: Literal["converged", "stalled", "maxIterations"]
    iterations: int
    initial_cost: float
    final_cost: float


@dataclass(frozen=True, eq=False)
class PaperStages:
    """The results of the steps of the paper's algorithm."""

    ranks: List[RankCandidate]
    """For each number of motions that was tried; empty if the number was given."""
    rank_rule_fired: Optional[bool]
    """Whether some number satisfied the rank rule; ``None`` if the number was given."""
    factorisation: List[Matrix]
    """Motions after the polynomial factorisation."""
    refined: List[Matrix]
    """Motions after the nonlinear refinement."""
    refinement: Refinement


@dataclass(frozen=True, eq=False, repr=False)
class MotionFit:
    """The result of :func:`fit_points`."""

    count: int
    """Number of motions."""
    motions: List[FittedMotion]
    """By decreasing number of measurements: ``motions[i].label == i``."""
    labels: NDArray[np.uint8]
    """One label per measurement, in the order of the input; 255 is an outlier."""
    candidates: List[Candidate]
    singular_values: NDArray[np.float64]
    """Of the embedded data, decreasing; empty with the method ``"best"``."""
    stages: Optional[PaperStages]
    """Only with the method ``"paper"``."""

    def __repr__(self) -> str:
        return f"MotionFit({_counted(self.count, 'motion')}, {_counted(len(self.labels), 'measurement')})"


@dataclass(frozen=True, eq=False)
class ClipObject:
    """An object in one frame of a clip."""

    id: int
    """1 to 254, the same in all frames."""
    pixels: int
    """Number of its pixels."""
    bbox: Box
    """Bounding box of its pixels."""
    confidence: float
    """Mean probability that its pixels belong to an object, 0 to 1."""
    matrix: Optional[Matrix]
    """Motion of its largest part to the next frame; ``None`` if there is none. In a stream, its motion from the previous frame, continued."""


@dataclass(frozen=True, eq=False, repr=False)
class ClipFrame:
    """One frame of a clip, segmented."""

    index: int
    labels: LabelImage
    """0 for the background, 255 for a pixel that is marked as unknown, otherwise the number of an object."""
    objects: List[ClipObject]
    """The visible objects by number."""
    background: Optional[Matrix]
    """Motion of the background, as :attr:`ClipObject.matrix`."""

    def __repr__(self) -> str:
        return f"ClipFrame({self.index}, {_size(self.labels)}, objects={[thing.id for thing in self.objects]})"

    def png(self) -> bytes:
        """The labels as a PNG file: palette indices in the colours of the DAVIS benchmark."""
        return indexed_png(self.labels)

    def _repr_png_(self) -> bytes:
        """The image that a notebook shows."""
        return self.png()


@dataclass(frozen=True, eq=False)
class Sighting:
    """An object in one frame of its track; see :class:`ClipObject`."""

    frame: int
    pixels: int
    bbox: Box
    confidence: float
    matrix: Optional[Matrix]


@dataclass(frozen=True, eq=False, repr=False)
class ClipTrack:
    """One object through a clip."""

    id: int
    first: int
    """Index of the first frame that shows it."""
    last: int
    """Index of the last frame that shows it."""
    frames: List[Sighting]
    """One entry for each frame that shows it."""

    def __repr__(self) -> str:
        return f"ClipTrack({self.id}, frames {self.first} to {self.last})"


@dataclass(frozen=True, eq=False)
class BackgroundMotion:
    """Motion of the background from a frame to the next one."""

    frame: int
    matrix: Matrix


@dataclass(frozen=True, eq=False, repr=False)
class ClipTracks:
    """The result of :meth:`Clip.tracks` and :meth:`ClipStream.tracks`."""

    objects: List[ClipTrack]
    """By number, which is the order of appearance."""
    background: List[BackgroundMotion]
    """One entry for each frame that is followed by another frame of its scene."""
    dropped: int
    """Number of objects beyond 254, which count as background."""

    def __repr__(self) -> str:
        return f"ClipTracks({self.objects})"


@dataclass(frozen=True, eq=False, repr=False)
class _ObjectMask:
    frame: int
    object: int
    """The number of the object, 1 to 254; one that no object has makes a new object."""
    mask: Union[LabelImage, NDArray[np.bool_]]
    propagate: Propagation = "both"

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.frame}, {self.object}, {_size(self.mask)})"


class Strokes(_ObjectMask):
    """Strokes of an object in a frame, over its earlier strokes there.

    ``mask`` has 1 where the object is, 0 where it is not and 255 where that is left open. Of an array of bools, True is the object and False is
    open.
    """


class Mask(_ObjectMask):
    """The mask of an object in a frame, in place of its earlier strokes there.

    ``mask`` has 1 where the object is, 0 where it is not and 255 where that is left open. Of an array of bools, True is the object and False is
    not: a picture of 0 and 255 is ``mask=picture == 255``.
    """


@dataclass(frozen=True, eq=False, repr=False)
class Labels:
    """A label map of a frame, over earlier ones there: the number of an object, old or new, 0 where none of these objects is, and 255 where that
    is left open. A map of 0 and 255 alone is an eraser: it removes all objects from its zeros."""

    frame: int
    labels: LabelImage
    own: bool = False
    """Whether the numbers are your own, as those of another program: an object that was found under one of them gets the lowest free number.
    Otherwise they are the numbers of the clip's objects."""
    propagate: Propagation = "both"

    def __repr__(self) -> str:
        return f"Labels({self.frame}, {_size(self.labels)}{', own=True' if self.own else ''})"


@dataclass(frozen=True)
class Prompt:
    """Points to an object in a frame, whether it was found or not. Its mask there is made at once.

    Clicks and a box together describe one object; a box or a click inside the object is needed. A prompt replaces an earlier one of its object
    and frame; one without clicks and box removes it. It does not annotate other objects.
    """

    frame: int
    object: int
    """The number of the object, 1 to 254; one that no object has makes a new object."""
    box: Optional[Box] = None
    """A rectangle that contains the whole object."""
    click: Optional[Tuple[int, int]] = None
    """Column and row of a pixel of the object, short for a click ``(x, y, 1)``."""
    clicks: Sequence[Click] = ()
    propagate: Propagation = "both"
    """Not ``"exact"``."""


@dataclass(frozen=True)
class ClipChange:
    """Numbers of pixels that an object has gained and lost in a frame by a step."""

    frame: int
    object: int
    """Its number; 0 for the background."""
    gained: int
    """Number of pixels that it has now and did not have before."""
    lost: int
    """Number of pixels that it had before and does not have now."""


@dataclass(frozen=True)
class ClipEntry:
    """An object of a clip."""

    number: int
    """1 to 254, the same in all frames. It is never given to another object."""
    name: str
    """Empty for an object without a name, as is the class."""
    class_name: str
    colour: Optional[Colour]
    locked: bool
    annotated: bool
    """Whether it was annotated in any frame."""
    became: int
    """The number under which it goes on: its own, that of the object it was merged into, or 0 if it was deleted."""


@dataclass(frozen=True)
class ClipFrameStatus:
    """What is known of a frame of a clip."""

    has_masks: bool
    """Whether it was segmented."""
    accepted: bool
    annotated: bool


def labelled_frames(clip: Clip) -> Iterator[ClipFrame]:
    """The frames of a clip that have masks, in order."""
    for index, status in enumerate(clip.frames):
        if status.has_masks:
            yield clip.labels(index)


def _size(image: NDArray[Any]) -> str:
    return "×".join(map(str, reversed(np.shape(image))))


def _counted(count: int, thing: str) -> str:
    return f"{count} {thing}{'' if count == 1 else 's'}"
