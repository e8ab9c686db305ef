import os
from typing import Any, Iterator, List, Literal, Optional, Sequence, Union, final

from numpy.typing import ArrayLike

from ._types import (
    ClipChange,
    ClipEntry,
    ClipFrame,
    ClipFrameStatus,
    ClipProgress,
    ClipTracks,
    Colour,
    Labels,
    Mask,
    MotionFit,
    Prompt,
    Segmentation,
    Strokes,
)

__all__ = ["Clip", "ClipStream", "__version__", "fit_points", "open_clip", "segment_pair", "segment_stream"]

__version__: str

def segment_pair(
    first: object,
    second: object,
    motions: object,
    quality: object,
    mark_unknown: bool,
    confidence: bool,
    subject: bool,
    progress: Optional[Any],
) -> Segmentation: ...
def fit_points(
    positions: ArrayLike,
    derivatives: ArrayLike,
    motions: object,
    method: object,
    seed: object,
    progress: Optional[Any],
) -> MotionFit: ...
def open_clip(
    frames: object,
    saved: Optional[bytes],
    journal: Union[str, "os.PathLike[str]", None],
    mark_unknown: bool,
) -> Clip: ...
def segment_stream(
    frames: object,
    look_ahead: object,
    motions: object,
    quality: object,
    mark_unknown: bool,
    subject: bool,
    progress: Optional[Any],
) -> ClipStream: ...
@final
class Clip:
    """A clip, from its opening to its closing: :func:`open_clip`.

    It is segmented, its masks are corrected in steps that can be undone, and read as often as they are wanted. Whatever raises or is
    interrupted changes nothing.
    """

    def segment(
        self,
        first: int = 0,
        last: Optional[int] = None,
        motions: Union[int, Literal["auto"]] = "auto",
        quality: Literal["best", "fast"] = "best",
        subject: bool = False,
        progress: Optional[ClipProgress] = None,
    ) -> None:
        """Segments the frames from ``first`` to ``last``, by default all of them, for the first time or again: objects that move get a number,
        1 to 254, which they keep from their first frame to their last. Label 0 is the background.

        Objects that are found again keep their numbers, and annotations are applied again. If it is interrupted, the pairs of frames that
        were solved are kept, and the same call goes on from them. A frame that is unusable ends the range: those before it get masks, then its
        error is raised.

        :param motions: the number of motions in each pair of consecutive frames, 1 to 10; ``"auto"`` estimates it.
        :param quality: ``"best"`` for accuracy, ``"fast"`` for quick results.
        :param subject: treats the main subject as the only object, as for a cut-out, and everything else as background.
        """
    def annotate(
        self, *annotations: Union[Strokes, Mask, Labels, Prompt], progress: Optional[ClipProgress] = None
    ) -> List[ClipChange]:
        """Annotates frames, all in one step: label maps and strokes take effect first, then prompts. Returns what objects have gained and lost.

        Annotations spread to other frames. An object that was annotated, accepted or named changes only by annotations of itself; one that was
        found also changes by the pixels that annotated objects take from it or give back. No pair is solved again.
        """
    def clear(self, frame: int, object: Optional[int] = None) -> List[ClipChange]:
        """Takes back the annotations of a frame: of an object, or all."""
    def accept(self, frames: Sequence[int], on: bool = True) -> List[ClipChange]:
        """Accepts frames as correct, or no longer. Annotations of other frames do not change an accepted frame; one of itself ends the
        acceptance."""
    def lock(self, objects: Sequence[int], on: bool = True) -> None:
        """Locks objects, or unlocks them. Only segmenting its frames again changes the pixels of a locked object; annotating it
        raises ``object-locked``."""
    def describe(
        self, number: int, name: str = "", class_name: str = "", colour: Optional[Colour] = None
    ) -> None:
        """Gives an object a name, a class and a colour, in place of all three before. An object with a name changes only by annotations of
        itself."""
    def merge(self, *objects: int) -> None:
        """Merges objects under the number of the first."""
    def delete(self, *objects: int) -> None:
        """Turns objects into background."""
    def split(self, object: int, frame: int) -> List[ClipChange]:
        """Makes a new object, with the number :attr:`next_object`, of all connected pieces of an object but the largest in a frame. Other
        frames follow."""
    def undo(self) -> bool:
        """Takes back the last step: a call that segments, annotates, or changes anything else. Returns whether there was one."""
    def redo(self) -> bool:
        """Does again the step that was taken back last. Returns whether there was one."""
    def labels(self, frame: int) -> ClipFrame:
        """The labels and objects of a frame as they are now. The frame is read unless they are known."""
    @property
    def objects(self) -> List[ClipEntry]:
        """All objects that there have been, by number."""
    @property
    def frames(self) -> List[ClipFrameStatus]:
        """What is known of each frame."""
    @property
    def next_object(self) -> Optional[int]:
        """The lowest number that no object has had; ``None`` if none is left."""
    def tracks(self) -> ClipTracks:
        """The tracks of all objects in all frames that have masks."""
    def save(self) -> bytes:
        """The clip with its steps, for ``open_clip(frames, saved=…)``: some kilobytes per frame."""
    def close(self) -> None:
        """Frees the memory of the clip. Its journal can be opened again when this returns."""
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[ClipFrame]: ...
    def __enter__(self) -> Clip: ...
    def __exit__(self, *_exception: object) -> None: ...
@final
class ClipStream:
    """The frames of a clip that come once, in order, as they are finished: :func:`segment_stream`. It frees its memory when it is closed,
    collected or raises."""

    def __iter__(self) -> Iterator[ClipFrame]: ...
    def __next__(self) -> ClipFrame: ...
    def tracks(self) -> ClipTracks:
        """The tracks of the objects in the frames returned so far."""
    def close(self) -> None:
        """Frees the memory of the stream."""
    def __enter__(self) -> ClipStream: ...
    def __exit__(self, *_exception: object) -> None: ...
