"""The interpreter while a call works: other threads go on, signals are heard, listeners are called."""

from __future__ import annotations

import _thread
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from typing import Any, Callable, List, Tuple

import pytest
from scenes import clip, frame
from veronese import segment_clip, segment_pair

SIZE = (640, 480)
FIRST, SECOND = frame(0, size=SIZE, square=(3, 2)), frame(1, size=SIZE, square=(3, 2))


def test_other_threads_go_on() -> None:
    ticks: List[float] = []
    ended = threading.Event()

    def tick() -> None:
        while not ended.wait(0.005):
            ticks.append(time.monotonic())

    thread = threading.Thread(target=tick)
    thread.start()
    begun = time.monotonic()
    segment_pair(FIRST, SECOND)
    done = time.monotonic()
    ended.set()
    thread.join()
    during = [at for at in ticks if begun < at < done]
    # A call that held the lock would let nobody tick; where cores are short, some ticks are late.
    assert len(during) > (done - begun) / 0.1


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


def interrupted(work: Callable[[Callable[..., None]], Any]) -> float:
    """Seconds from Ctrl-C, which comes when the first listener is called, to the end of the call."""
    at: List[float] = []

    def interrupt() -> None:
        at.append(time.monotonic())
        _thread.interrupt_main()

    def listener(*_: object) -> None:
        if not timers:
            timers.append(threading.Timer(0.02, interrupt))
            timers[0].start()

    timers: List[threading.Timer] = []
    with pytest.raises(KeyboardInterrupt):
        work(listener)
    assert at, "the interruption came from elsewhere"
    return time.monotonic() - at[0]


def test_keyboard_interrupt_ends_a_pair_at_once() -> None:
    begun = time.monotonic()
    segment_pair(FIRST, SECOND)
    whole = time.monotonic() - begun
    assert interrupted(lambda listener: segment_pair(FIRST, SECOND, progress=listener)) < whole / 2
    # A call after it is as any other.
    assert segment_pair(frame(0), frame(1)).count == 2


def test_keyboard_interrupt_ends_a_clip() -> None:
    frames = clip(30, size=(160, 120))
    segmented: List[Any] = []

    def work(listener: Callable[..., None]) -> None:
        segmented.append(segment_clip(frames, progress=listener))
        list(segmented[0])

    assert interrupted(work) < 1
    assert next(segmented[0], None) is None


def test_calls_in_threads_give_the_same() -> None:
    expected = segment_pair(frame(0), frame(1)).labels.tobytes()
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda _: segment_pair(frame(0), frame(1)).labels.tobytes(), range(8)))
    assert set(found) == {expected}
