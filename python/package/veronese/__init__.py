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
from typing import Callable, Iterable, Literal, Optional, Protocol, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _veronese
from ._types import (
    BackgroundMotion,
    Candidate,
    ClipChange,
    ClipEntry,
    ClipFrame,
    ClipFrameStatus,
    ClipObject,
    ClipProgress,
    ClipTrack,
    ClipTracks,
    FittedMotion,
    Junction,
    Labels,
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
    Strokes,
    SupportsArray,
    VeroneseError,
)
from ._veronese import Clip, ClipStream, __version__

__all__ = [
    "BackgroundMotion",
    "Candidate",
    "Clip",
    "ClipChange",
    "ClipEntry",
    "ClipFrame",
    "ClipFrameStatus",
    "ClipObject",
    "ClipProgress",
    "ClipStream",
    "ClipTrack",
    "ClipTracks",
    "FittedMotion",
    "Frame",
    "Frames",
    "Junction",
    "Labels",
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
    "Strokes",
    "VeroneseError",
    "__version__",
    "fit_points",
    "open_clip",
    "segment_pair",
    "segment_stream",
]

Frame = Union[NDArray[np.uint8], SupportsArray, Picture, bytes, bytearray, memoryview, str, "os.PathLike[str]"]
"""An array of pixels or an object that NumPy makes one of, a picture of Pillow, or the bytes or the path of an image file."""


class Frames(Protocol):
    """Frames that can be read again: a list, an array of them, or a class of your own."""

    def __len__(self) -> int: ...
    def __getitem__(self, index: int, /) -> Frame: ...


Progress = Callable[[str, int, int], object]
"""Called when a stage begins, with its name, its index and the number of stages. An exception that it raises ends the call."""


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

    To correct masks, open the two frames as a clip (:func:`open_clip`).

    :param motions: the number of motions, 1 to 10; ``"auto"`` estimates it.
    :param quality: ``"best"`` for accuracy, ``"fast"`` for live use.
    :param mark_unknown: gives label 255 to a pixel that is occluded or outside in the second frame, has no texture around it, or whose label
        would more likely be wrong than right.
    :param confidence: adds the confidence of every label.
    :param subject: treats the main subject as the only object, as for a cut-out, and everything else as background, even if it moves. The
        group of its motions is 1.
    """
    return _veronese.segment_pair(first, second, motions, quality, mark_unknown, confidence, subject, progress)


def open_clip(
    frames: Union[Frames, str, "os.PathLike[str]"],
    saved: Optional[bytes] = None,
    journal: Union[str, "os.PathLike[str]", None] = None,
    mark_unknown: bool = False,
) -> Clip:
    """Opens a clip: frames that can be read again, which are segmented, corrected and read until it is closed.

    Frames are a list, an array of shape ``(frames, height, width, 3)``, anything with ``len`` and an index, or the path of a folder of images. They
    have one size, are read whenever they are needed, and must be the same each time.

    :param saved: the result of :meth:`Clip.save` for the same frames.
    :param journal: the path of a file that has every step before a call returns. If it exists, the clip goes on from it: after the end of the
        program or the machine at any time, no finished call is lost. An annotation under way is finished, and the pairs that
        :meth:`Clip.segment` has solved are kept. One clip at a time has a journal open.
    :param mark_unknown: gives label 255 to pixels whose log-odds do not decide between object and background.
    """
    return _veronese.open_clip(frames, saved, journal, mark_unknown)


def segment_stream(
    frames: Union[Iterable[Frame], "os.PathLike[str]"],
    *,
    look_ahead: int = 8,
    motions: Union[int, Literal["auto"]] = "auto",
    quality: Literal["best", "fast"] = "best",
    mark_unknown: bool = False,
    subject: bool = False,
    progress: Optional[ClipProgress] = None,
) -> ClipStream:
    """Segments a clip whose frames come once, as from a camera: a frame is taken when the loop waits for one.

    Objects that move get a number, which they keep from their first frame to their last. Label 0 is the background. If the source raises or a
    frame is unusable, the frames before it come first, then the error.

    :param look_ahead: the number of later frames that each frame waits for, 0 to 8.
    :param motions: the number of motions in each pair of consecutive frames.
    :param mark_unknown: gives label 255 to pixels whose log-odds do not decide between object and background.
    :param subject: treats the main subject as the only object, as for a cut-out, and everything else as background.
    """
    return _veronese.segment_stream(frames, look_ahead, motions, quality, mark_unknown, subject, progress)


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
