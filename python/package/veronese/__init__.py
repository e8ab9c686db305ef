"""Motion segmentation of two video frames or a clip.

How many motions there are, what each motion is, and which pixels follow it. There is no trained model, and nothing leaves the machine.

A frame is an array of ``uint8`` of shape ``(height, width, 3)``, ``(height, width, 4)`` or ``(height, width)`` (RGB, RGBA or grey), what NumPy
makes such an array of (a tensor, a buffer), a picture of Pillow, or the path or the bytes of a PNG, JPEG, WebP, BMP or PNM file. Sides are 16
to 4096 pixels. Pixels are copied when a call takes them.

Calls release the interpreter's lock: other threads go on, and Ctrl-C ends a call at once. A mistake in a frame, an option or a file
is a :class:`VeroneseError` with a stable ``code``, the same as on the command line.
"""

from __future__ import annotations

import os
from typing import Callable, Iterable, Literal, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _veronese
from ._types import (
    Accepted,
    BackgroundMotion,
    Candidate,
    ClipChange,
    ClipFrame,
    ClipObject,
    ClipTrack,
    ClipTracks,
    Correction,
    FittedMotion,
    Junction,
    Mask,
    MotionFit,
    PaperStages,
    Picture,
    Prompt,
    RankCandidate,
    Refinement,
    SegmentedMotion,
    Segmentation,
    Sighting,
    SupportsArray,
    VeroneseError,
)
from ._veronese import Clip, __version__

__all__ = [
    "Accepted",
    "BackgroundMotion",
    "Candidate",
    "Clip",
    "ClipChange",
    "ClipFrame",
    "ClipObject",
    "ClipProgress",
    "ClipTrack",
    "ClipTracks",
    "Correction",
    "FittedMotion",
    "Frame",
    "Junction",
    "Mask",
    "MotionFit",
    "PaperStages",
    "Progress",
    "Prompt",
    "RankCandidate",
    "Refinement",
    "Segmentation",
    "SegmentedMotion",
    "Sighting",
    "VeroneseError",
    "__version__",
    "fit_points",
    "segment_clip",
    "segment_pair",
]

Frame = Union[NDArray[np.uint8], SupportsArray, Picture, bytes, bytearray, memoryview, str, "os.PathLike[str]"]
"""An array of pixels or what has one, a picture of Pillow, or the bytes or the path of an image file."""

Progress = Callable[[str, int, int], object]
"""Called when a stage begins, with its name, its index and the number of stages. An exception that it raises ends the call."""

ClipProgress = Callable[[str, int, Optional[int]], object]
"""Called when work on a frame begins, with the stage (``"pairs"``, ``"corrections"`` or ``"labels"``), the frame's index and the number of
frames, ``None`` where it is not known. An exception that it raises ends the clip, or takes back what is being said."""


def segment_pair(
    first: Frame,
    second: Frame,
    *,
    motions: Union[int, Literal["auto"]] = "auto",
    quality: Literal["best", "fast"] = "best",
    mark_unknown: bool = False,
    confidence: bool = False,
    subject: bool = False,
    progress: Optional[Progress] = None,
) -> Segmentation:
    """Segments two frames: how many things move, how each one moves, and which pixels belong to it.

    To correct masks, segment the two frames as a clip (:func:`segment_clip`), which takes corrections.

    :param motions: the number of motions, 1 to 10; ``"auto"`` estimates it.
    :param quality: ``"best"`` for accuracy, ``"fast"`` for live use.
    :param mark_unknown: gives label 255 to a pixel that is hidden or outside in the second frame, has no texture around it, or whose label
        would more likely be wrong than right.
    :param confidence: adds the confidence of every label.
    :param subject: takes the main subject for the one object, as for a cut-out, and all else for ground: what else moves is not told apart
        from it. The group of its motions is 1.
    """
    return _veronese.segment_pair(first, second, motions, quality, mark_unknown, confidence, subject, progress)


def segment_clip(
    frames: Union[Iterable[Frame], "os.PathLike[str]"],
    *,
    motions: Union[int, Literal["auto"]] = "auto",
    quality: Literal["best", "fast"] = "best",
    mark_unknown: bool = False,
    subject: bool = False,
    look_ahead: Union[int, Literal["all"], None] = None,
    masks: Optional[Sequence[Mask]] = None,
    corrections: Optional[Sequence[Union[Correction, Prompt]]] = None,
    prompts: Optional[Sequence[Prompt]] = None,
    locked: Optional[Sequence[int]] = None,
    named: Optional[Sequence[int]] = None,
    accepted: Optional[Sequence[Union[int, Accepted]]] = None,
    state: Optional[bytes] = None,
    progress: Optional[ClipProgress] = None,
) -> Clip:
    """Segments a clip: objects that move get a number, which they keep from their first frame to their last. Label 0 is the background.

    A sequence of frames (a list, an array of shape ``(frames, height, width, 3)``, anything with ``len`` and an index) and the path of a
    folder are whole clips: each frame is read for its pairs, nearly all the work, then for its labels, and must be the same each time.
    Other iterables, such as a generator, are streams: a frame is taken when the loop waits for one.

    All frames must have one size. If the source raises or a frame is unusable, the frames before it come first, then the error.

    Nothing that was painted, given, prompted, named, accepted or locked changes when something else is said. An object that was found
    automatically changes by the pixels that another one takes from it or gives back.

    :param motions: the number of motions in each pair of consecutive frames.
    :param mark_unknown: gives label 255 to pixels whose evidence does not tell an object from the background.
    :param subject: takes the main subject for the one object, as for a cut-out, and all else for background.
    :param look_ahead: the number of frames that each frame waits for, 0 to 8, or ``"all"``: as many as matter, of a whole clip. Default: 8
        for a stream, ``"all"`` for a whole clip. A number makes a stream of a sequence, unless one of the options below is given.
    :param masks: masks of objects in some frames, with numbers of your own, which the objects keep. An object that was found
        under one of their numbers gets the lowest free one.
    :param corrections: what is certain in some frames, with the numbers of an earlier run. A correction of a frame that has a mask goes
        before it where it says anything. All count together, in any order; prompts may be among them.
    :param prompts: clicks and boxes that point to objects in some frames, after what is painted.
    :param locked: numbers of objects of which nothing changes a pixel, but annotations of themselves in the same call. Saying anything new of
        one that a ``state`` has locked is a mistake, ``object-locked``. Where it is given, it replaces what a ``state`` has; so do the next two.
    :param named: numbers of objects that only what is said of themselves changes.
    :param accepted: indices of frames that are right, or :class:`Accepted` with their labels. Only what is painted or pointed to in such a
        frame changes labels there, and the objects in it are followed from it as from a correction. Without labels it has those of now: as masks
        and a ``state`` have it, before corrections.
    :param state: what :meth:`Clip.state` gave for the same frames: no pair is solved again. ``motions``, ``quality``, ``subject`` and ``look_ahead``
        are those of the state then.
    """
    said = (masks, corrections, prompts, locked, named, accepted)
    return _veronese.segment_clip(frames, motions, quality, mark_unknown, subject, look_ahead, *said, state, progress)


def fit_points(
    positions: ArrayLike,
    derivatives: ArrayLike,
    *,
    motions: Union[int, Literal["auto"]] = "auto",
    method: Literal["best", "paper"] = "best",
    seed: int = 1,
    progress: Optional[Progress] = None,
) -> MotionFit:
    """Solves Problem 1 of the paper for image measurements of your own.

    :param positions: x and y of each measurement, shape ``(number, 2)``.
    :param derivatives: I_x, I_y and I_t of each, shape ``(number, 3)``.
    :param motions: the number of motions, 1 to 10; ``"auto"`` estimates it.
    :param method: ``"paper"`` for the algorithm of the paper, ``"best"`` for ours, which is more accurate on noisy data.
    """
    return _veronese.fit_points(positions, derivatives, motions, method, seed, progress)
