"""The interpreter while a call works: other threads go on, signals are heard, listeners are called."""

from __future__ import annotations

import _thread
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from queue import SimpleQueue
from typing import Any, Callable, List, Tuple

import pytest
from scenes import clip, frame, labels_of, segmented
from veronese import Clip, Prompt, open_clip, segment_pair, segment_stream

SIZE = (640, 480)
FIRST, SECOND = frame(0, size=SIZE, square=(3, 2)), frame(1, size=SIZE, square=(3, 2))


def test_other_threads_go_on() -> None:
    ticks: List[float] = []
    ended = threading.Event()

    def tick() -> None:
        while not ended.wait(0.001):
            ticks.append(time.monotonic())

    thread = threading.Thread(target=tick)
    thread.start()
    begun = time.monotonic()
    segment_pair(FIRST, SECOND)
    done = time.monotonic()
    ended.set()
    thread.join()
    # A call that held the lock would let nobody tick.
    assert any(begun < at < done for at in ticks)


def test_stages_are_told_in_order() -> None:
    told: List[Tuple[str, int, int]] = []
    thread = threading.get_ident()
    where: List[int] = []

    def listener(stage: str, index: int, of: int) -> None:
        told.append((stage, index, of))
        where.append(threading.get_ident())

    segment_pair(frame(0), frame(1), progress=listener)
    assert told[0][:2] == ("frames", 0) and told[-1][0] == "masks"
    assert all(index < of for _, index, of in told)
    assert set(where) == {thread}


def test_what_a_listener_raises_ends_the_call() -> None:
    def listener(stage: str, index: int, of: int) -> None:
        raise LookupError(stage)

    with pytest.raises(LookupError, match="frames"):
        segment_pair(FIRST, SECOND, progress=listener)


def interrupted(work: Callable[[Callable[..., None]], Any]) -> List[str]:
    """Has Ctrl-C end some work after its first stage. Returns all stages that were told."""
    told: SimpleQueue[str] = SimpleQueue()
    stages: List[str] = []

    def interrupt() -> None:
        stages.append(told.get())
        _thread.interrupt_main()

    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        # A listener that is no Python code: it is not there that the signal is heard.
        work(told.put)
    thread.join()
    return stages + [told.get() for _ in range(told.qsize())]


def test_keyboard_interrupt_ends_a_pair_at_once() -> None:
    stages = interrupted(lambda listener: segment_pair(FIRST, SECOND, progress=listener))
    assert "masks" not in stages, "the last one"
    # A call after it is as any other.
    assert segment_pair(frame(0), frame(1)).count == 2


FRAMES = clip(30, size=(160, 120))


def test_keyboard_interrupt_ends_a_stream() -> None:
    streams: List[Any] = []

    def work(listener: Callable[..., None]) -> None:
        streams.append(segment_stream(FRAMES, progress=listener))
        list(streams[0])

    assert len(interrupted(work)) < len(FRAMES)
    assert next(streams[0], None) is None


def test_keyboard_interrupt_ends_a_segmentation() -> None:
    opened, straight = open_clip(FRAMES[:8]), segmented(FRAMES[:8])
    assert len(interrupted(lambda listener: opened.segment(progress=listener))) < 8
    assert list(opened) == [] and not opened.undo()
    opened.segment(quality="fast")
    assert labels_of(opened) == labels_of(straight)


def test_keyboard_interrupt_takes_an_annotation_back() -> None:
    opened = segmented(FRAMES)
    before = labels_of(opened)
    prompt = Prompt(15, 9, box=(100, 10, 50, 50))
    assert len(interrupted(lambda listener: opened.annotate(prompt, progress=listener))) < len(FRAMES)
    assert labels_of(opened) == before and [thing.number for thing in opened.objects] == [1]
    opened.annotate(prompt)
    assert labels_of(opened) != before


def test_two_clips_in_two_threads_give_the_same() -> None:
    def work(index: int) -> List[bytes]:
        opened: Clip = segmented(FRAMES[:6])
        opened.annotate(Prompt(2, 9, box=(100, 10, 50, 50)))
        return labels_of(opened)

    with ThreadPoolExecutor(2) as pool:
        one, other = pool.map(work, range(2))
    assert one == other == work(0)


def test_calls_in_threads_give_the_same() -> None:
    expected = segment_pair(frame(0), frame(1)).labels.tobytes()
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda _: segment_pair(frame(0), frame(1)).labels.tobytes(), range(8)))
    assert set(found) == {expected}
