"""The journals of clips: what is in them survives, and one clip alone writes to each."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any, Callable, List

import numpy as np
import pytest
from scenes import clip, corner, labels_of, square_mask
from veronese import Clip, Labels, Prompt, Strokes, VeroneseError, open_clip

COUNT = 5
FRAMES = clip(COUNT)


def state(opened: Clip) -> Any:
    return labels_of(opened), opened.objects, opened.frames


def worked(journal: Path) -> Clip:
    """A clip with some steps."""
    opened = open_clip(FRAMES, journal=journal)
    opened.segment(quality="fast")
    opened.annotate(Strokes(2, 9, square_mask(1, 1, 255)))
    opened.describe(9, "car")
    return opened


def test_a_journal_is_complete_after_each_call(tmp_path: Path) -> None:
    journal, copy = tmp_path / "clip.journal", tmp_path / "copy"
    opened = open_clip(FRAMES, journal=str(journal))
    steps: List[Callable[[Clip], Any]] = [
        lambda clip: clip.segment(0, 2, quality="fast"),
        lambda clip: clip.annotate(Strokes(2, 9, square_mask(1, 1, 255)), Prompt(1, 8, click=(5, 5))),
        lambda clip: clip.segment(2, quality="fast"),
        lambda clip: clip.undo(),
        lambda clip: clip.redo(),
        lambda clip: clip.accept([4]),
        lambda clip: clip.merge(9, 8),
        lambda clip: clip.annotate(Labels(0, corner(7), propagate="exact")),
        lambda clip: clip.lock([9]),
    ]
    for at, step in enumerate(steps):
        step(opened)
        shutil.copy(journal, copy)
        # What a process finds that goes on where this one was killed.
        with open_clip(FRAMES, journal=copy) as again:
            assert state(again) == state(opened)
            for later in steps[at + 1 :]:
                later(again)
            last = state(again)
    assert last == state(opened)
    assert not (tmp_path / "clip.journal.new").exists()


PROGRAM = """
import os, sys
from scenes import clip, square_mask
from veronese import Strokes, open_clip

def end(stage, index, of):
    if (stage, index) == (sys.argv[2], int(sys.argv[3])):
        os._exit(7)

opened = open_clip(clip(5), journal=sys.argv[1])
opened.segment(quality="fast", progress=end)
opened.annotate(Strokes(2, 9, square_mask(1, 1, 255)), progress=end)
"""


@pytest.mark.parametrize("stage, index", [("pairs", 3), ("annotations", 4)])
def test_what_a_killed_process_has_begun_is_finished(stage: str, index: int, tmp_path: Path) -> None:
    journal = tmp_path / "clip.journal"
    ended = subprocess.run([sys.executable, "-c", PROGRAM, str(journal), stage, str(index)], cwd=Path(__file__).parent)
    assert ended.returncode == 7
    straight = worked(tmp_path / "other")
    assert straight.undo()
    with open_clip(FRAMES, journal=journal) as opened:
        if stage == "pairs":
            assert list(opened) == []
            opened.segment(quality="fast")
            opened.annotate(Strokes(2, 9, square_mask(1, 1, 255)))
        assert state(opened) == state(straight)


def test_of_interrupted_steps_it_has_the_solved_pairs_alone(tmp_path: Path) -> None:
    journal = tmp_path / "clip.journal"

    def interrupt(stage: str, index: int, of: Any) -> None:
        if (stage, index) in (("pairs", 3), ("annotations", 4)):
            raise KeyboardInterrupt

    with open_clip(FRAMES, journal=journal) as opened:
        with pytest.raises(KeyboardInterrupt):
            opened.segment(quality="fast", progress=interrupt)
    with open_clip(FRAMES, journal=journal) as opened:
        assert list(opened) == [] and len(opened.save()) > 2 * len(open_clip(FRAMES).save())
        opened.segment(quality="fast")
        before = state(opened)
        with pytest.raises(KeyboardInterrupt):
            opened.annotate(Strokes(2, 9, square_mask(1, 1, 255)), progress=interrupt)
    with open_clip(FRAMES, journal=journal) as opened:
        assert state(opened) == before


def test_a_torn_end_is_cut_off(tmp_path: Path) -> None:
    journal = tmp_path / "clip.journal"
    with worked(journal) as opened:
        now = state(opened)
        opened.undo()
        before = state(opened)
        opened.redo()
    content = journal.read_bytes()
    for torn, expected in ((content[:-1], before), (content + b"\0" * 9, now)):
        journal.write_bytes(torn)
        with open_clip(FRAMES, journal=journal) as opened:
            assert state(opened) == expected
            opened.lock([9])
            locked = state(opened)
        with open_clip(FRAMES, journal=journal) as opened:
            assert state(opened) == locked, "what follows is read as well"
    assert [path.name for path in tmp_path.iterdir()] == ["clip.journal"]


def test_a_damaged_journal_is_kept_beside(tmp_path: Path) -> None:
    journal = tmp_path / "clip.journal"
    with open_clip(FRAMES, journal=journal) as opened:
        opened.segment(quality="fast")
        before, length = state(opened), journal.stat().st_size
        opened.lock([1])
        opened.lock([1], on=False)
    damaged = bytearray(journal.read_bytes())
    damaged[length + 8] ^= 1
    journal.write_bytes(damaged)
    with pytest.warns(UserWarning, match=r"the journal is damaged.*clip\.journal\.damaged") as warned:
        opened = open_clip(FRAMES, journal=journal)
    assert warned[0].filename == __file__
    assert state(opened) == before and (tmp_path / "clip.journal.damaged").read_bytes() == damaged
    opened.close()
    with open_clip(FRAMES, journal=journal) as opened:
        assert state(opened) == before


def test_one_clip_has_a_journal(tmp_path: Path) -> None:
    journal = tmp_path / "clip.journal"

    def refused() -> None:
        with pytest.raises(VeroneseError, match="another clip has .*clip.journal' open") as caught:
            open_clip(FRAMES, journal=journal)
        assert caught.value.code == "invalid-option"

    opened = open_clip(FRAMES, journal=journal)
    refused()
    program = "import sys, veronese; veronese.open_clip(sys.argv[2:], journal=sys.argv[1])"
    other = subprocess.run([sys.executable, "-c", program, str(journal), *map(str, range(COUNT))], capture_output=True, text=True)
    assert other.returncode == 1 and "another clip has" in other.stderr
    opened.close()
    with open_clip(FRAMES, journal=journal):
        refused()


def test_a_journal_that_has_grown_is_written_anew(tmp_path: Path) -> None:
    journal = tmp_path / "clip.journal"
    random = np.random.default_rng(1)
    with worked(journal) as opened:
        first = journal.stat().st_ino
        for _ in range(100):
            opened.annotate(Strokes(2, 9, random.integers(0, 2, (72, 96), np.uint8), propagate="exact"))
            if journal.stat().st_ino != first:
                break
        assert journal.stat().st_ino != first
        with pytest.raises(VeroneseError, match="another clip has"):
            open_clip(FRAMES, journal=journal)
        opened.lock([9])
        now = state(opened)
    assert [path.name for path in tmp_path.iterdir()] == ["clip.journal"]
    with open_clip(FRAMES, journal=journal) as opened:
        assert state(opened) == now and opened.undo() and opened.undo()


def test_a_journal_begins_with_what_was_saved(tmp_path: Path) -> None:
    first, second = tmp_path / "first", tmp_path / "second"
    with worked(first) as opened:
        saved, now = opened.save(), state(opened)
    with open_clip(FRAMES, saved=saved, journal=second) as opened:
        assert state(opened) == now
        opened.lock([9])
        now = state(opened)
    with open_clip(FRAMES, journal=second) as opened:
        assert state(opened) == now and opened.undo() and opened.undo()


def test_journals_of_other_clips_are_refused(tmp_path: Path) -> None:
    journal, empty, text = tmp_path / "clip.journal", tmp_path / "empty", tmp_path / "text"
    worked(journal).close()
    empty.touch()
    text.write_text("a text that is longer than the first bytes of a journal")
    content = journal.read_bytes()
    wrong: List[Any] = [
        (lambda: open_clip(FRAMES[1:], journal=journal), "invalid-option", "of a clip of 5 frames, not 4"),
        (lambda: open_clip(FRAMES, journal=text), "invalid-option", "'journal'"),
        (lambda: open_clip(FRAMES, saved=content, journal=journal), "invalid-option", "one of the two"),
        (lambda: open_clip(FRAMES, journal=tmp_path / "nowhere" / "journal"), "file-not-found", "cannot be opened"),
        (lambda: open_clip(FRAMES, journal=tmp_path), "unreadable-file", "cannot be opened"),
    ]
    for call, code, sentence in wrong:
        with pytest.raises(VeroneseError, match=sentence) as caught:
            call()
        assert caught.value.code == code
    assert journal.read_bytes() == content and text.read_text().startswith("a text")
    with open_clip(FRAMES, journal=empty) as opened:
        assert list(opened) == []
    assert empty.stat().st_size > 0
    with open_clip(clip(COUNT, square=(-1, 0)), journal=journal) as opened:
        with pytest.raises(VeroneseError, match="frame 3 is not the one that was segmented"):
            opened.labels(3)


def test_a_step_that_cannot_be_kept_is_taken_back(tmp_path: Path) -> None:
    resource = pytest.importorskip("resource", reason="files cannot be kept short here")
    journal = tmp_path / "clip.journal"
    with worked(journal) as opened:
        before = state(opened)
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (journal.stat().st_size + 3, limits[1]))
        try:
            with pytest.raises(VeroneseError) as caught:
                opened.annotate(Strokes(1, 8, corner(1)))
            assert caught.value.code == "write-failed"
            assert state(opened) == before
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        opened.annotate(Strokes(1, 8, corner(1)))
        before = state(opened)
    with open_clip(FRAMES, journal=journal) as opened:
        assert state(opened) == before
