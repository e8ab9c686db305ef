"""Motion segmentation of two video frames or a clip.

How many motions there are, what each motion is, and which pixels follow it. There is no trained model, and nothing leaves the machine.

A frame is an array of ``uint8`` of shape ``(height, width, 3)``, ``(height, width, 4)`` or ``(height, width)`` (RGB, RGBA or grey), what NumPy
makes such an array of (a tensor, a buffer), a picture of Pillow, or the path or the bytes of a PNG, JPEG, WebP, BMP or PNM file. Sides are 16
to 4096 pixels. Pixels are copied when a call takes them.

Calls release the interpreter's lock: other threads continue, and Ctrl-C ends a call at once. An invalid frame, option or file raises
a :class:`VeroneseError` with a stable ``code``, the same as on the command line.
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
"""An array of pixels or an object that NumPy makes one of, a picture of Pillow, or the bytes or the path of an image file."""

Progress = Callable[[str, int, int], object]
"""Called when a stage begins, with its name, its index and the number of stages. An exception that it raises ends the call."""

ClipProgress = Callable[[str, int, Optional[int]], object]
"""Called when work on a frame begins, with the stage (``"pairs"``, ``"corrections"`` or ``"labels"``), the frame's index and the number of
frames, ``None`` where it is not known. An exception that it raises ends the clip, or undoes the annotations that are being applied."""


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
    """Segments two frames: estimates how many motions there are, each motion, and the pixels that follow it.

    Labels are those of the pixels of ``first``. They number the motions from 0 by decreasing number of pixels.

    To correct masks, segment the two frames as a clip (:func:`segment_clip`), which takes corrections.

    :param motions: the number of motions, 1 to 10; ``"auto"`` estimates it.
    :param quality: ``"best"`` for accuracy, ``"fast"`` for live use.
    :param mark_unknown: gives label 255 to a pixel that is occluded or outside in the second frame, has no texture around it, or whose label
        would more likely be wrong than right.
    :param confidence: adds the confidence of every label.
    :param subject: treats the main subject as the only object, as for a cut-out, and everything else as background, even if it moves. The
        group of its motions is 1.
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

    Objects that were painted, given as masks, prompted, named, accepted or locked change only by annotations of themselves. An object that
    was found automatically changes by the pixels that annotated objects take from it or give back.

    :param motions: the number of motions in each pair of consecutive frames.
    :param mark_unknown: gives label 255 to pixels whose log-odds do not decide between object and background.
    :param subject: treats the main subject as the only object, as for a cut-out, and everything else as background.
    :param look_ahead: the number of later frames that each frame waits for, 0 to 8, or, for a whole clip, ``"all"``: as many as matter. Default: 8
        for a stream, ``"all"`` for a whole clip. A number makes a stream of a sequence, unless one of the options below is given.
    :param masks: masks of objects in some frames, with numbers of your own, which the objects keep. An object that was found
        under one of their numbers gets the lowest free one.
    :param corrections: labels that are certain in some frames, with the numbers of an earlier run. Where a correction is not 255, it replaces
        the mask of its frame. All are applied together, in any order; prompts may be among them.
    :param prompts: clicks and boxes that point to objects in some frames. They are applied after ``masks`` and ``corrections``.
    :param locked: numbers of objects whose pixels no annotation changes, except annotations of themselves in the same call. A new annotation
        of an object that a ``state`` has locked raises ``object-locked``. This option replaces the locks of a ``state``; so do the next two.
    :param named: numbers of objects that change only by annotations of themselves.
    :param accepted: indices of frames whose labels are right, or :class:`Accepted` with their labels. Labels in such a frame change only by
        annotations of the frame itself, and its objects are followed from it as from a correction. Without labels, those after the masks and
        the ``state``, before corrections, are accepted.
    :param state: the result of :meth:`Clip.state` for the same frames: no pair is solved again. ``motions``, ``quality``, ``subject`` and
        ``look_ahead`` are then those of the state.
    """
    annotations = (masks, corrections, prompts, locked, named, accepted)
    return _veronese.segment_clip(frames, motions, quality, mark_unknown, subject, look_ahead, *annotations, state, progress)


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
