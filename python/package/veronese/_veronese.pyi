from typing import Any, Iterator, List, Optional, Sequence, Union, final

from numpy.typing import ArrayLike

from ._types import Accepted, ClipChange, ClipFrame, ClipTracks, Correction, MotionFit, Prompt, Segmentation

__all__ = ["Clip", "__version__", "fit_points", "segment_clip", "segment_pair"]

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
def segment_clip(
    frames: object,
    motions: object,
    quality: object,
    mark_unknown: bool,
    subject: bool,
    look_ahead: object,
    masks: object,
    corrections: object,
    prompts: object,
    locked: object,
    named: object,
    accepted: object,
    state: Optional[bytes],
    progress: Optional[Any],
) -> Clip: ...
@final
class Clip:
    """The frames of a clip, in order, as they are finished.

    It frees its memory when it is closed, collected or raises. Any frame of a finished whole clip can be asked for again and corrected;
    no pair is solved again.
    """

    def __iter__(self) -> Iterator[ClipFrame]: ...
    def __next__(self) -> ClipFrame: ...
    def frame(self, index: int) -> ClipFrame:
        """A frame of a whole clip with its current labels."""
    def correct(self, *annotations: Union[Correction, Prompt]) -> List[int]:
        """Annotates frames of a whole clip by label maps, strokes and prompts. Returns the indices of the frames that change.

        Other annotated objects do not change, see :func:`segment_clip`. Numbers are those before any :meth:`merge` or :meth:`delete`.
        A call that is interrupted changes nothing.
        """
    def lock(self, objects: Sequence[int]) -> None:
        """Locks these objects: no annotation changes their pixels. All others are unlocked."""
    def name(self, objects: Sequence[int]) -> None:
        """Names these objects: like annotated objects, they change only by annotations of themselves."""
    def accept(self, frames: Sequence[Union[int, Accepted]]) -> List[int]:
        """Accepts these frames, as they are or with labels, and no others. Returns the indices of the frames that change."""
    def merge(self, *objects: int) -> List[int]:
        """Merges objects under the number of the first. Returns the indices of the frames that change. It cannot be undone."""
    def delete(self, *objects: int) -> List[int]:
        """Turns objects into background. Returns the indices of the frames that change. It cannot be undone."""
    def changes(self) -> List[ClipChange]:
        """The pixels that objects have gained and lost by the last annotations, by frame, then by object: those of the options of the clip, or of
        the last call of :meth:`correct`, :meth:`accept`, :meth:`lock` or :meth:`name`. :meth:`merge` and :meth:`delete` are not counted."""
    def state(self) -> bytes:
        """A whole clip with its annotations, for the option ``state``: some kilobytes per frame."""
    def tracks(self) -> ClipTracks:
        """The tracks of the objects in the frames returned so far, with current labels: frames that have changed are read again."""
    def close(self) -> None:
        """Frees the memory of the clip."""
    def __enter__(self) -> Clip: ...
    def __exit__(self, *_exception: object) -> None: ...
