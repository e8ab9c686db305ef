"""Clips: whole ones and streams, their annotations, and what happens when something goes wrong."""

from __future__ import annotations

import gc
import os
import time
from pathlib import Path
from typing import Any, Iterator, List, Tuple

import numpy as np
import pytest
from scenes import Pixels, clip, frame, square_mask, write_image
from veronese import Accepted, Clip, ClipFrame, Correction, Mask, Prompt, VeroneseError, segment_clip

COUNT = 6
FRAMES = clip(COUNT)
FAST: Any = {"quality": "fast"}


def labels_of(frames: Any, **options: Any) -> List[bytes]:
    return [found.labels.tobytes() for found in segment_clip(frames, **FAST, **options)]


WHOLE = labels_of(FRAMES)


def test_an_object_keeps_its_number_through_a_whole_clip() -> None:
    told: List[Tuple[str, int, Any]] = []
    segmented = segment_clip(FRAMES, **FAST, progress=lambda *step: told.append(step))
    assert not told, "nothing is done before somebody asks"
    found = list(segmented)
    assert [one.index for one in found] == list(range(COUNT))
    for one in found:
        assert one.labels.shape == (72, 96)
        (thing,) = one.objects
        assert thing.id == 1 and thing.pixels == int((one.labels == 1).sum())
        x, y, width, height = thing.bbox
        assert (one.labels[y : y + height, x : x + width] == 1).sum() == thing.pixels
    assert found[0].background is not None and found[-1].background is None
    assert told == [(stage, index, COUNT) for stage in ("pairs", "labels") for index in range(COUNT)]
    (track,) = segmented.tracks().objects
    assert (track.id, track.first, track.last, len(track.frames)) == (1, 0, COUNT - 1, COUNT)
    assert [sighting.pixels for sighting in track.frames] == [one.objects[0].pixels for one in found]
    assert [motion.frame for motion in segmented.tracks().background] == list(range(COUNT - 1))
    assert next(segmented, None) is None


class Readable:
    """A sequence that is neither list nor array."""

    def __len__(self) -> int:
        return COUNT

    def __getitem__(self, index: int) -> Pixels:
        if index >= COUNT:
            raise IndexError(index)
        return FRAMES[index]


def test_all_forms_of_a_whole_clip_give_the_same(tmp_path: Path) -> None:
    paths = [write_image(tmp_path / f"frame-{9 + index}.png", pixels) for index, pixels in enumerate(FRAMES)]
    (tmp_path / ".hidden.png").touch()
    (tmp_path / "notes.txt").touch()
    forms = {
        "tuple": tuple(FRAMES),
        "array": np.stack(FRAMES),
        "sequence": Readable(),
        "paths": paths,
        "folder": tmp_path,
        "name of a folder": str(tmp_path),
    }
    for name, form in forms.items():
        assert labels_of(form) == WHOLE, name
    assert labels_of(iter(paths)) == labels_of(iter(FRAMES)), "a stream of paths"


def test_a_stream_takes_frames_when_they_are_wanted() -> None:
    taken: List[int] = []

    def camera() -> Iterator[Pixels]:
        buffer = np.empty_like(FRAMES[0])
        for index, pixels in enumerate(FRAMES):
            taken.append(index)
            buffer[:] = pixels
            yield buffer

    stream = segment_clip(camera(), **FAST, look_ahead=2)
    assert taken == []
    assert next(stream).index == 0
    assert taken == [0, 1, 2]
    assert [one.index for one in stream] == list(range(1, COUNT))
    tracks = stream.tracks()
    assert tracks.objects[0].frames[-1].matrix is None, "nothing moves on from the last frame"
    assert tracks.objects[0].frames[0].matrix is not None
    assert [motion.frame for motion in tracks.background] == list(range(COUNT - 1))
    with pytest.raises(VeroneseError, match="whole clip"):
        stream.state()


def test_fewer_than_two_frames_are_no_clip() -> None:
    for count, found in ((0, "none"), (1, "one")):
        for given in (FRAMES[:count], iter(FRAMES[:count])):
            with pytest.raises(VeroneseError, match=f"a clip needs two frames, found {found}") as raised:
                list(segment_clip(given, **FAST))
            assert raised.value.code == "too-few-frames"
        assert len(list(segment_clip(iter(FRAMES[:count]), **FAST, look_ahead=0))) == count, "it may end at any time"


def test_a_number_to_look_ahead_makes_a_stream_of_a_sequence() -> None:
    steps: List[Any] = []
    found = labels_of(FRAMES, look_ahead=2, progress=lambda *step: steps.append(step))
    assert found == labels_of(iter(FRAMES), look_ahead=2)
    assert steps == [("pairs", index, COUNT) for index in range(COUNT)]
    assert labels_of(iter(FRAMES)) == labels_of(FRAMES, look_ahead=8)


LATER: Any = {
    "corrections": ([Correction(3, square_mask(1.5, 9, 255)), Prompt(1, 9, click=(48, 36))], lambda clip, said: clip.correct(*said)),
    "prompts": ([Prompt(2, 9, (20, 14, 46, 46), clicks=[(40, 40, 1)])], lambda clip, said: clip.correct(*said)),
    "locked": ([1], Clip.lock),
    "named": ([1], Clip.name),
    "accepted": ([1, Accepted(4, square_mask(2, 1, 0))], Clip.accept),
}


@pytest.mark.parametrize("name", LATER)
def test_what_is_said_later_holds_as_what_is_said_at_the_beginning(name: str) -> None:
    """Its results are compared with those of Node in test_same_as_node.py."""
    said, say = LATER[name]
    wide = np.full((72, 96), 255, np.uint8)
    wide[10:60, 15:40] = 8
    at_once, later = segment_clip(FRAMES, **FAST, **{name: said}), segment_clip(FRAMES, **FAST)
    say(later, said)
    assert later.state() == at_once.state()
    changed = later.correct(Correction(2, wide))
    assert 2 in changed and at_once.correct(Correction(2, wide)) == changed
    assert later.changes() == at_once.changes() != []
    assert {one.frame for one in later.changes()} == {*changed}
    now = [one.labels.tobytes() for one in later]
    assert now == [one.labels.tobytes() for one in at_once]
    assert 8 in [track.id for track in later.tracks().objects]

    stages: List[str] = []
    restored = segment_clip(FRAMES, state=later.state(), progress=lambda stage, *_: stages.append(stage))
    assert [one.labels.tobytes() for one in restored] == now
    assert {*stages} == {"labels"}, "no pair is solved again"


def corner(label: int) -> Pixels:
    """The top left corner of a frame, which is ground."""
    said = np.full((72, 96), 255, np.uint8)
    said[2:14, 2:18] = label
    return said


def test_of_a_locked_object_nothing_new_is_said() -> None:
    said = Correction(3, square_mask(1.5, 1, 0))
    segmented = segment_clip(FRAMES, **FAST, corrections=[said])
    segmented.lock([1])
    state = segmented.state()

    def says(*given: Any) -> Any:
        return lambda: segmented.correct(*given)

    for wrong in (
        says(Correction(2, square_mask(1, 1, 0))),
        says(Correction(2, corner(0), object=1)),
        says(Correction(0, corner(9)), Prompt(2, 1, click=(45, 36))),
        lambda: segmented.delete(1),
    ):
        with pytest.raises(VeroneseError) as caught:
            wrong()
        assert caught.value.code == "object-locked" and "object 1 is locked" in str(caught.value)
        assert segmented.state() == state, "nothing is changed then"
    assert segmented.correct(said) == [], "it is what was said before"
    segmented.lock([])
    assert segmented.delete(1)

    # A lock holds from the annotations that it is given with.
    stroke = Correction(2, corner(0), object=1)
    assert labels_of(FRAMES, corrections=[stroke], locked=[1]) == labels_of(FRAMES, corrections=[stroke])


def test_objects_are_merged_and_deleted() -> None:
    segmented = segment_clip(FRAMES, **FAST, masks=[Mask(0, square_mask(0, 7, 0))])
    list(segmented)
    assert segmented.merge(12, 7) == [], "no object has the first number"
    assert segmented.delete(7)
    assert [track.id for track in segmented.tracks().objects] != [7]
    with pytest.raises(VeroneseError):
        segmented.delete(0)


def test_frames_before_a_failure_come_first() -> None:
    class Mine(Exception):
        pass

    class Failing(Readable):
        def __getitem__(self, index: int) -> Pixels:
            if index == 4:
                raise Mine
            return FRAMES[index]

    def failing() -> Iterator[Pixels]:
        yield from FRAMES[:4]
        raise Mine

    for source, error in [(Failing(), Mine), (failing(), Mine), ([*FRAMES[:4], "nowhere.png"], VeroneseError)]:
        given: List[int] = []
        with pytest.raises(error):
            for one in segment_clip(source, **FAST):  # type: ignore[arg-type]
                given.append(one.index)
        assert given == [0, 1, 2, 3]
    with pytest.raises(VeroneseError) as caught:
        list(segment_clip([*FRAMES[:2], frame(0, size=(96, 64))], **FAST))
    assert caught.value.code == "frame-size-mismatch" and "frame 2" in str(caught.value)


def test_what_a_listener_raises_ends_the_clip() -> None:
    def listener(stage: str, index: int, of: Any) -> None:
        if index == 2:
            raise KeyError(stage)

    segmented = segment_clip(FRAMES, **FAST, progress=listener)
    with pytest.raises(KeyError):
        next(segmented)
    assert next(segmented, None) is None


@pytest.mark.parametrize("said", [[Correction(3, square_mask(1.5, 9, 255))], [Correction(1, square_mask(0.5, 8, 255)), Prompt(4, 9, click=(5, 5))]])
def test_what_is_interrupted_changes_nothing(said: List[Any]) -> None:
    steps: List[int] = []

    def listener(stage: str, index: int, of: Any) -> None:
        if stage == "corrections":
            steps.append(index)
            if len(steps) == 3:
                raise KeyboardInterrupt

    segmented = segment_clip(FRAMES, **FAST, progress=listener)
    list(segmented)
    before = segmented.state()
    with pytest.raises(KeyboardInterrupt):
        segmented.correct(*said)
    assert segmented.state() == before
    assert segmented.changes() == []
    segmented.correct(*said)
    assert segmented.state() != before


FULL = np.zeros((72, 96), np.uint8)


@pytest.mark.parametrize(
    "options",
    [
        {"look_ahead": 9},
        {"look_ahead": -1},
        {"look_ahead": "some"},
        {"masks": [Mask(COUNT, FULL)]},
        {"masks": [Mask(0, FULL), Mask(0, FULL)]},
        {"masks": [Mask(0, FULL.astype(np.int64))]},
        {"masks": [Mask(0, FULL[1:])]},
        {"masks": [FULL]},
        {"masks": 3},
        {"corrections": [Correction(0, FULL, propagate="up")]},  # type: ignore[arg-type]
        {"corrections": [Correction(0, FULL), Correction(0, FULL)]},
        {"corrections": [Correction(0, FULL, object=1), Correction(0, FULL, object=1)]},
        {"corrections": [Correction(0, FULL, object=0)]},
        {"corrections": [Correction(0, FULL + 2, object=1)]},
        {"corrections": [Prompt(0, 1, box=(0, 0, 5, 5), click=(7, 1))]},
        {"corrections": [Prompt(0, 1, clicks=[(1, 1, -1)])]},
        {"corrections": [Prompt(0, 1, clicks=[(1, 1, 0)])]},  # type: ignore[list-item]
        {"corrections": [Prompt(0, 1, clicks=[(1, 1)])]},  # type: ignore[list-item]
        {"corrections": [Prompt(0, 1, box=(0, 0, 0, 5))]},
        {"corrections": [Prompt(0, 255, click=(1, 1))]},
        {"corrections": [Prompt(0, 1, click=(96, 1))]},
        {"prompts": [Prompt(0, 1, clicks=[(1, 1, 1), (1, 72, -1)])]},
        {"prompts": [Prompt(0, 1, box=(90, 0, 7, 5))]},
        {"prompts": [Correction(0, FULL)]},
        {"corrections": [Prompt(0, 1, click=(1, 1)), Prompt(0, 1, click=(2, 2))]},
        {"locked": [0]},
        {"locked": [255]},
        {"named": [0]},
        {"accepted": [COUNT]},
        {"accepted": [1, 1]},
        {"accepted": [Accepted(0, FULL[1:])]},
        {"accepted": 3},
        {"state": b"something else"},
    ],
)
def test_wrong_options_are_refused_before_a_pair_is_solved(options: Any) -> None:
    steps: List[Any] = []
    with pytest.raises(VeroneseError) as caught:
        next(segment_clip(FRAMES, **FAST, progress=lambda *step: steps.append(step), **options))
    assert caught.value.code == "invalid-option"
    assert not steps


def test_a_state_is_of_its_frames() -> None:
    state = segment_clip(FRAMES, **FAST).state()
    for frames in (FRAMES[1:], clip(COUNT, square=(-1, 0))):
        with pytest.raises(VeroneseError) as caught:
            list(segment_clip(frames, state=state))
        assert caught.value.code == "invalid-option" and "state" in str(caught.value)


def test_options_for_frames_that_come_once_are_refused() -> None:
    options: Any
    said: Any = [{name: []} for name in ("masks", "corrections", "prompts", "locked", "named", "accepted")]
    for options in (*said, {"state": b""}, {"look_ahead": "all"}):
        with pytest.raises(VeroneseError, match="read again"):
            segment_clip(iter(FRAMES), **options)
    frames: Any
    for frames in (3, len):
        with pytest.raises(VeroneseError) as caught:
            segment_clip(frames)
        assert caught.value.code == "invalid-input"


def test_frames_that_are_not_there_are_refused() -> None:
    segmented = segment_clip(FRAMES, **FAST)
    with pytest.raises(VeroneseError, match="no frame 6"):
        segmented.frame(COUNT)


TASKS = Path("/proc/self/task")


@pytest.mark.skipif(not TASKS.exists(), reason="threads that are not Python's are not to be seen here")
def test_a_clip_that_is_closed_or_dropped_ends_its_thread() -> None:
    def threads() -> int:
        return len(list(TASKS.iterdir()))

    before = threads()
    with segment_clip(FRAMES, **FAST) as segmented:
        next(segmented)
    assert next(segmented, None) is None
    with pytest.raises(VeroneseError):
        segmented.state()
    dropped: List[Clip] = [segment_clip(FRAMES, **FAST) for _ in range(5)]
    assert threads() > before
    dropped.clear()

    class Viewer:
        """Refers to its clip, which refers to it."""

        def __init__(self) -> None:
            self.clip = segment_clip(FRAMES, **FAST, progress=self.listen)

        def listen(self, *step: object) -> None:
            pass

    viewers = [Viewer() for _ in range(5)]
    assert threads() > before
    viewers.clear()
    gc.collect()
    until = time.monotonic() + 60
    while threads() > before and time.monotonic() < until:
        time.sleep(0.01)
    assert threads() <= before


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_a_clip_stays_in_its_process() -> None:
    segmented = segment_clip(FRAMES, **FAST)
    child = os.fork()
    if child == 0:
        code = ""
        try:
            next(segmented)
        except VeroneseError as error:
            code = error.code
        os._exit(0 if code == "worker-failed" else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    assert next(segmented).index == 0


def test_frames_of_a_clip_are_typed() -> None:
    one: ClipFrame = next(segment_clip(FRAMES, **FAST))
    assert one.labels.flags.writeable and one.labels.flags.c_contiguous
