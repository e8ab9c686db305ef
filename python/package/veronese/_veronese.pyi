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

    It frees what it holds when it is closed, collected or raises. Of a whole clip that is finished, any frame can be asked for again,
    corrected and looked at: nothing is segmented anew.
    """

    def __iter__(self) -> Iterator[ClipFrame]: ...
    def __next__(self) -> ClipFrame: ...
    def frame(self, index: int) -> ClipFrame:
        """A frame of a whole clip as it is now, as often as it is asked for."""
    def correct(self, *said: Union[Correction, Prompt]) -> List[int]:
        """Says what is certain in frames of a whole clip, or points to objects there. Returns the indices of the frames that change.

        Nothing that was said of other objects changes, see :func:`segment_clip`. Numbers are those before any :meth:`merge` or :meth:`delete`.
        What is interrupted changes nothing.
        """
    def lock(self, objects: Sequence[int]) -> None:
        """The objects of which nothing changes a pixel; all others can be changed from now on."""
    def name(self, objects: Sequence[int]) -> None:
        """The objects that only what is said of themselves changes, besides those of which something was said."""
    def accept(self, frames: Sequence[Union[int, Accepted]]) -> List[int]:
        """The frames that are right, as they are or with labels; all others are open from now on. Returns the indices of those that change."""
    def merge(self, *objects: int) -> List[int]:
        """Makes objects one, which keeps the number of the first. Returns the indices of the frames that change. It cannot be undone."""
    def delete(self, *objects: int) -> List[int]:
        """Makes objects background. Returns the indices of the frames that change. It cannot be undone."""
    def changes(self) -> List[ClipChange]:
        """What objects have gained and lost by what was said last, by frame, then by object: by the options of the clip, or by the last call of
        :meth:`correct`, :meth:`accept`, :meth:`lock` or :meth:`name`. What :meth:`merge` and :meth:`delete` change is not counted."""
    def state(self) -> bytes:
        """What is known of a whole clip, corrections included, for the option ``state``: some kilobytes per frame."""
    def tracks(self) -> ClipTracks:
        """The objects of the frames returned so far, as they are now: frames that have changed are read again."""
    def close(self) -> None:
        """Frees what the clip holds."""
    def __enter__(self) -> Clip: ...
    def __exit__(self, *_exception: object) -> None: ...
