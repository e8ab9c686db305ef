"""Clips and streams: their calls, and what happens when something goes wrong. Journals are in test_journals.py."""

from __future__ import annotations

import gc
import os
import time
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, Tuple

import numpy as np
import pytest
from scenes import Pixels, clip, corner, frame, labels_of, segmented, square_mask, write_image
from veronese import Clip, ClipEntry, ClipFrame, Labels, Mask, Prompt, Strokes, VeroneseError, open_clip, segment_stream

COUNT = 6
FRAMES = clip(COUNT)
FAST: Any = {"quality": "fast"}
WHOLE = labels_of(segmented(FRAMES))


def test_an_object_keeps_its_number_through_a_clip() -> None:
    told: List[Tuple[str, int, Any]] = []
    opened = open_clip(FRAMES)
    assert [status.has_masks for status in opened.frames] == [False] * COUNT and list(opened) == []
    opened.segment(**FAST, progress=lambda *step: told.append(step))
    assert told == [("pairs", index, COUNT) for index in range(COUNT)]
    found = list(opened)
    assert [one.index for one in found] == list(range(COUNT)) == [one.index for one in opened], "as often as one likes"
    for one in found:
        assert one.labels.shape == (72, 96)
        (thing,) = one.objects
        assert thing.id == 1 and thing.pixels == int((one.labels == 1).sum())
        x, y, width, height = thing.bbox
        assert (one.labels[y : y + height, x : x + width] == 1).sum() == thing.pixels
    assert found[0].background is not None and found[-1].background is None
    (track,) = opened.tracks().objects
    assert (track.id, track.first, track.last, len(track.frames)) == (1, 0, COUNT - 1, COUNT)
    assert [sighting.pixels for sighting in track.frames] == [one.objects[0].pixels for one in found]
    assert [motion.frame for motion in opened.tracks().background] == list(range(COUNT - 1))
    assert len(opened) == COUNT and repr(opened) == "Clip(6 frames)" and repr(open_clip(FRAMES[:1])) == "Clip(1 frame)"


class Readable:
    """A sequence that is neither list nor array."""

    def __len__(self) -> int:
        return COUNT

    def __getitem__(self, index: int) -> Pixels:
        if index >= COUNT:
            raise IndexError(index)
        return FRAMES[index]


def test_all_forms_of_frames_give_the_same(tmp_path: Path) -> None:
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
        assert labels_of(segmented(form)) == WHOLE, name
    again: List[Any] = [iter(paths), iter(FRAMES), FRAMES, tmp_path]
    streams = [labels_of(segment_stream(form, **FAST)) for form in again]
    assert all(stream == streams[0] for stream in streams)


def test_a_stream_takes_frames_when_they_are_wanted() -> None:
    taken: List[int] = []
    told: List[Any] = []

    def camera() -> Iterator[Pixels]:
        buffer = np.empty_like(FRAMES[0])
        for index, pixels in enumerate(FRAMES):
            taken.append(index)
            buffer[:] = pixels
            yield buffer

    stream = segment_stream(camera(), **FAST, look_ahead=2, progress=lambda *step: told.append(step))
    assert taken == []
    assert next(stream).index == 0
    assert taken == [0, 1, 2]
    assert [one.index for one in stream] == list(range(1, COUNT))
    assert told == [("pairs", index, None) for index in range(COUNT)]
    tracks = stream.tracks()
    assert tracks.objects[0].frames[-1].matrix is None, "nothing moves on from the last frame"
    assert tracks.objects[0].frames[0].matrix is not None
    assert [motion.frame for motion in tracks.background] == list(range(COUNT - 1))
    stream.close()
    assert next(stream, None) is None and repr(stream) == "ClipStream(closed)"


def test_fewer_than_two_frames_are_no_clip() -> None:
    for count, found in ((0, "none"), (1, "one")):
        calls: List[Callable[[], Any]] = [lambda: segmented(FRAMES[:count]), lambda: list(segment_stream(iter(FRAMES[:count])))]
        for call in calls:
            with pytest.raises(VeroneseError, match=f"a clip needs two frames, found {found}") as raised:
                call()
            assert raised.value.code == "too-few-frames"
        assert len(list(segment_stream(iter(FRAMES[:count]), look_ahead=0))) == count, "it may end at any time"


def test_steps_are_taken_back_and_done_again() -> None:
    opened = segmented(FRAMES)
    steps: List[Callable[[], Any]] = [
        lambda: opened.annotate(Strokes(3, 9, square_mask(1.5, 1, 255)), Prompt(1, 8, click=(5, 5))),
        lambda: opened.annotate(Labels(0, square_mask(0, 7, 0), own=True)),
        lambda: opened.clear(3, 9),
        lambda: opened.accept([4]),
        lambda: opened.describe(7, "car", "vehicle", (255, 0, 9)),
        lambda: opened.lock([7]),
        lambda: opened.merge(8, 9),
        lambda: opened.delete(8),
    ]

    def state() -> Any:
        return labels_of(opened), opened.objects, opened.frames, opened.next_object, repr(opened.tracks())

    states = [state()]
    for step in steps:
        changes = step()
        assert changes is None or all(one.gained + one.lost > 0 for one in changes)
        states.append(state())
        assert states[-1] != states[-2]
    for earlier in states[-2::-1]:
        assert opened.undo() and state() == earlier
    assert opened.undo(), "the masks"
    assert list(opened) == [] and not opened.undo()
    for later in states:
        assert opened.redo() and state() == later
    assert not opened.redo()
    # What is saved has all steps.
    with open_clip(FRAMES, saved=opened.save()) as again:
        assert (labels_of(again), again.objects, again.frames) == states[-1][:3]
        assert again.undo() and labels_of(again) == states[-2][0]


def test_changes_are_what_objects_have_gained_and_lost() -> None:
    opened = segmented(FRAMES)
    before = [one.labels for one in opened]
    changes = opened.annotate(Mask(2, 9, square_mask(1, 1, 0) == 1))
    counts: Dict[Tuple[int, int], Tuple[int, int]] = {}
    for index, (was, now) in enumerate(zip(before, (one.labels for one in opened))):
        for number in (0, 1, 9):
            gained, lost = int(((now == number) & (was != number)).sum()), int(((now != number) & (was == number)).sum())
            if gained + lost:
                counts[index, number] = gained, lost
    assert {(one.frame, one.object): (one.gained, one.lost) for one in changes} == counts != {}


def test_masks_are_arrays_of_labels_or_bools() -> None:
    inside = square_mask(1, 1, 0) == 1
    for given, same in (
        (Strokes(2, 9, inside), Strokes(2, 9, np.where(inside, 1, 255).astype(np.uint8))),
        (Mask(2, 9, inside), Mask(2, 9, inside.astype(np.uint8))),
    ):
        one, other = segmented(FRAMES), segmented(FRAMES)
        assert one.annotate(given) == other.annotate(same) != []
        assert labels_of(one) == labels_of(other) != WHOLE


def test_strokes_lie_over_earlier_ones_and_a_mask_replaces_them() -> None:
    upper, lower = np.zeros((72, 96), bool), np.zeros((72, 96), bool)
    upper[2:14, 2:18] = lower[50:62, 2:18] = True
    twice, once = segmented(FRAMES), segmented(FRAMES)
    twice.annotate(Strokes(2, 9, upper))
    twice.annotate(Strokes(2, 9, lower))
    once.annotate(Strokes(2, 9, upper | lower))
    assert (twice.labels(2).labels == once.labels(2).labels).all()
    twice.annotate(Mask(2, 9, lower))
    assert ((twice.labels(2).labels == 9) == lower).all()


@pytest.mark.parametrize("form", [Strokes, Mask, Labels])
def test_what_is_drawn_exactly_changes_no_other_pixel(form: Any) -> None:
    opened = segmented(FRAMES)
    before = [one.labels for one in opened]
    drawn = corner(9 if form is Labels else 1)
    number = () if form is Labels else (9,)
    changes = opened.annotate(form(2, *number, drawn, propagate="exact"))
    assert {one.frame for one in changes} == {2}
    before[2] = np.where(drawn != 255, np.uint8(9), before[2])
    assert [one.labels.tobytes() for one in opened] == [one.tobytes() for one in before]
    assert opened.frames[2].annotated


def test_of_a_locked_object_nothing_new_is_said() -> None:
    opened = segmented(FRAMES)
    opened.annotate(Mask(3, 1, square_mask(1.5, 1, 0)))
    opened.lock([1])
    labels, saved = labels_of(opened), opened.save()
    said: List[Any] = [
        [Strokes(2, 1, square_mask(1, 1, 255))],
        [Labels(2, square_mask(1, 1, 0))],
        [Strokes(0, 9, corner(1)), Prompt(2, 1, click=(45, 36))],
    ]
    wrong: List[Callable[[], Any]] = [*(lambda given=given: opened.annotate(*given) for given in said), lambda: opened.delete(1)]
    for call in wrong:
        with pytest.raises(VeroneseError, match="object 1 is locked") as caught:
            call()
        assert caught.value.code == "object-locked"
        assert labels_of(opened) == labels and len(opened.save()) == len(saved), "nothing is changed then"
    everything = np.zeros((72, 96), np.uint8)
    opened.annotate(Mask(3, 9, everything + 1, propagate="none"))
    assert ((opened.labels(3).labels == 1) == (square_mask(1.5, 1, 0) == 1)).all()
    opened.lock([1], on=False)
    opened.delete(1)
    assert 1 not in [track.id for track in opened.tracks().objects]


def test_objects_are_described_merged_deleted_and_split() -> None:
    opened = segmented(FRAMES)
    assert opened.objects == [ClipEntry(1, "", "", None, False, False, 1)] and opened.next_object == 2
    opened.describe(1, "car", "vehicle", (255, 128, 0))
    assert opened.objects[0] == ClipEntry(1, "car", "vehicle", (255, 128, 0), False, False, 1)
    opened.describe(1, class_name="bus")
    assert (opened.objects[0].name, opened.objects[0].class_name, opened.objects[0].colour) == ("", "bus", None)
    two = corner(1)
    two[60:70, 80:94] = 1
    opened.annotate(Mask(2, 9, two == 1))
    assert opened.next_object == 2
    opened.split(9, 2)
    assert opened.next_object == 3
    shown = opened.labels(2).labels
    assert ((shown == 9) == (corner(1) == 1)).all() and (shown[60:70, 80:94] == 2).all()
    opened.merge(9, 2)
    assert (opened.labels(2).labels == 2).sum() == 0
    assert {one.number: one.became for one in opened.objects} == {1: 1, 2: 9, 9: 9}
    opened.delete(9)
    assert {one.number: one.became for one in opened.objects} == {1: 1, 2: 0, 9: 0}
    for call in (lambda: opened.annotate(Strokes(0, 9, corner(1))), lambda: opened.split(1, 0), lambda: opened.merge(1)):
        with pytest.raises(VeroneseError) as caught:
            call()
        assert caught.value.code == "invalid-option"


def test_ranges_are_segmented_one_after_another() -> None:
    opened = open_clip(FRAMES)
    opened.segment(0, 2, **FAST)
    assert [one.index for one in opened] == [0, 1, 2]
    opened.segment(3, **FAST)
    assert [one.index for one in opened] == list(range(COUNT))
    assert [track.id for track in opened.tracks().objects] == [1], "it keeps its number"
    opened.annotate(Strokes(4, 9, square_mask(2, 1, 255)))
    assert 9 in [thing.id for thing in opened.labels(0).objects], "annotations spread across"
    opened.segment(0, 2, **FAST)
    assert 9 in [thing.id for thing in opened.labels(4).objects]
    while opened.frames[5].has_masks:
        assert opened.undo()
    assert [status.has_masks for status in opened.frames] == [True] * 3 + [False] * 3


def test_frames_before_a_failure_get_masks() -> None:
    class Mine(Exception):
        pass

    class Failing(Readable):
        fails = True

        def __getitem__(self, index: int) -> Pixels:
            if index == 4 and self.fails:
                raise Mine
            return FRAMES[index]

    def failing() -> Iterator[Pixels]:
        yield from FRAMES[:4]
        raise Mine

    sources: List[Tuple[Any, Any]] = [(Failing(), Mine), ([*FRAMES[:4], "nowhere.png"], VeroneseError)]
    for source, error in sources:
        opened = open_clip(source)
        with pytest.raises(error):
            opened.segment(**FAST)
        assert [one.index for one in opened] == [0, 1, 2, 3]
    source = Failing()
    opened = open_clip(source)
    with pytest.raises(Mine):
        opened.segment(3, **FAST)
    assert list(opened) == [] and not opened.undo(), "one frame is none"
    source.fails = False
    opened.segment(**FAST)
    assert labels_of(opened) == WHOLE
    given: List[int] = []
    with pytest.raises(Mine):
        for one in segment_stream(failing(), **FAST):
            given.append(one.index)
    assert given == [0, 1, 2, 3]
    with pytest.raises(VeroneseError) as caught:
        segmented([*FRAMES[:2], frame(0, size=(96, 64))])
    assert caught.value.code == "frame-size-mismatch" and "frame 2" in str(caught.value)


def test_a_frame_that_has_changed_is_named() -> None:
    opened = segmented(FRAMES)
    for call in (lambda clip: clip.labels(3), lambda clip: clip.annotate(Strokes(3, 9, corner(1))), list):
        with pytest.raises(VeroneseError, match="frame [1-3] is not the one that was segmented") as caught:
            call(open_clip(clip(COUNT, square=(-1, 0)), saved=opened.save()))
        assert caught.value.code == "invalid-input"


def test_a_listener_that_raises_ends_a_call() -> None:
    def listener(stage: str, index: int, of: Any) -> None:
        if index == 2:
            raise KeyError(stage)

    opened = open_clip(FRAMES)
    with pytest.raises(KeyError, match="pairs"):
        opened.segment(**FAST, progress=listener)
    assert list(opened) == [] and not opened.undo()
    opened.segment(**FAST)
    assert labels_of(opened) == WHOLE
    stream = segment_stream(iter(FRAMES), progress=listener)
    with pytest.raises(KeyError):
        next(stream)
    assert next(stream, None) is None


@pytest.mark.parametrize("said", [[Strokes(3, 9, square_mask(1.5, 1, 255))], [Labels(1, square_mask(0.5, 8, 255)), Prompt(4, 9, click=(5, 5))]])
def test_what_is_interrupted_changes_nothing(said: List[Any]) -> None:
    steps: List[int] = []

    def listener(stage: str, index: int, of: Any) -> None:
        steps.append(index)
        if len(steps) == 3:
            raise KeyboardInterrupt

    opened = segmented(FRAMES)
    saved = opened.save()
    with pytest.raises(KeyboardInterrupt):
        opened.annotate(*said, progress=listener)
    assert opened.save() == saved and labels_of(opened) == WHOLE
    changes = opened.annotate(*said)
    assert changes == segmented(FRAMES).annotate(*said) and labels_of(opened) != WHOLE


FULL = np.zeros((72, 96), np.uint8)


@pytest.mark.parametrize(
    "said",
    [
        FULL,
        Mask(COUNT, 1, FULL),
        Mask(-1, 1, FULL),
        Mask(0, 0, FULL),
        Mask(0, 255, FULL),
        Mask(0, 1, FULL + 2),
        Mask(0, 1, FULL[1:]),
        Mask(0, 1, FULL.astype(np.int64)),  # type: ignore[arg-type]
        Strokes(0, 1, FULL, propagate="up"),  # type: ignore[arg-type]
        Labels(0, FULL == 1),
        Labels(0, FULL[1:]),
        Prompt(0, 1, box=(0, 0, 5, 5), click=(7, 1)),
        Prompt(0, 1, clicks=[(1, 1, -1)]),
        Prompt(0, 1, clicks=[(1, 1, 0)]),  # type: ignore[list-item]
        Prompt(0, 1, clicks=[(1, 1)]),  # type: ignore[list-item]
        Prompt(0, 1, box=(0, 0, 0, 5)),
        Prompt(0, 1, box=(90, 0, 7, 5)),
        Prompt(0, 255, click=(1, 1)),
        Prompt(0, 1, click=(96, 1)),
        Prompt(0, 1, click=(1, 1), propagate="exact"),
    ],
)
def test_wrong_annotations_are_refused(said: Any) -> None:
    opened = segmented(FRAMES)
    with pytest.raises(VeroneseError) as caught:
        opened.annotate(Strokes(2, 9, corner(1)), said)
    assert caught.value.code == "invalid-option"
    assert labels_of(opened) == WHOLE


def test_wrong_arguments_are_refused() -> None:
    opened, empty = segmented(FRAMES), open_clip(FRAMES)
    wrong: List[Callable[[], Any]] = [
        lambda: opened.segment(2, 2),
        lambda: opened.segment(0, COUNT),
        lambda: opened.segment(motions=0),
        lambda: opened.segment(quality="good"),  # type: ignore[arg-type]
        lambda: opened.labels(COUNT),
        lambda: opened.labels(-1),
        lambda: empty.labels(0),
        lambda: empty.annotate(Mask(0, 1, FULL)),
        lambda: opened.accept([COUNT]),
        lambda: opened.accept(3),  # type: ignore[arg-type]
        lambda: opened.clear(0, 0),
        lambda: opened.lock([0]),
        lambda: opened.describe(1, colour=(0, 0, 256)),
        lambda: opened.delete(255),
        lambda: open_clip(FRAMES, saved=b"something else"),
        lambda: open_clip(FRAMES, saved=opened.save()[:-1]),
        lambda: open_clip(FRAMES[1:], saved=opened.save()),
        lambda: segment_stream(FRAMES, look_ahead=9),
        lambda: segment_stream(FRAMES, look_ahead=-1),
        lambda: segment_stream(FRAMES, look_ahead="all"),  # type: ignore[arg-type]
    ]
    for call in wrong:
        with pytest.raises(VeroneseError) as caught:
            call()
        assert caught.value.code == "invalid-option", caught.value
    frames: Any
    for frames in (3, len, iter(FRAMES)):
        with pytest.raises(VeroneseError) as caught:
            open_clip(frames)
        assert caught.value.code == "invalid-input"
    assert labels_of(opened) == WHOLE


TASKS = Path("/proc/self/task")


@pytest.mark.skipif(not TASKS.exists(), reason="threads that are not Python's are not to be seen here")
def test_a_clip_that_is_closed_or_dropped_ends_its_thread() -> None:
    def name(task: Path) -> str:
        try:
            return (task / "comm").read_text().strip()
        except OSError:  # it has ended since it was listed
            return ""

    def threads() -> int:
        return sum(name(task) == "veronese" for task in TASKS.iterdir())

    def wait_for_none() -> None:
        gc.collect()
        until = time.monotonic() + 60
        while threads() > 0 and time.monotonic() < until:
            time.sleep(0.01)
        assert threads() == 0

    wait_for_none()
    with segmented(FRAMES) as opened, segment_stream(FRAMES, **FAST) as stream:
        next(stream)
    assert next(stream, None) is None and repr(opened) == "Clip(closed)" and len(opened) == COUNT
    for call in (opened.save, opened.segment, lambda: opened.objects, lambda: list(opened)):
        with pytest.raises(VeroneseError, match="the clip is closed"):
            call()
    dropped: List[Clip] = [open_clip(FRAMES) for _ in range(5)]
    assert threads() > 0
    dropped.clear()
    wait_for_none()

    class Viewer(Readable):
        """Refers to its clip, which refers to it."""

        def __init__(self) -> None:
            self.clip = open_clip(self)
            self.stream = segment_stream(FRAMES, progress=self.listen)

        def listen(self, *step: object) -> None:
            pass

    viewers = [Viewer() for _ in range(5)]
    assert threads() > 0
    viewers.clear()
    wait_for_none()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_a_clip_stays_in_its_process() -> None:
    opened = segmented(FRAMES)
    child = os.fork()
    if child == 0:
        code = ""
        try:
            opened.labels(0)
        except VeroneseError as error:
            code = error.code
        os._exit(0 if code == "worker-failed" else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    assert opened.labels(0).index == 0


def test_frames_of_a_clip_are_typed() -> None:
    one: ClipFrame = next(iter(segmented(FRAMES)))
    assert one.labels.flags.writeable and one.labels.flags.c_contiguous
