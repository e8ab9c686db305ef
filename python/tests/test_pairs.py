"""Two frames: what a segmentation has, which forms frames come in, and what is refused."""

from __future__ import annotations

import pickle
import struct
import zlib
from pathlib import Path
from typing import Any, Dict

import numpy as np
import pytest
import veronese
from scenes import Pixels, frame, write_image
from veronese import Labels, Mask, Strokes, VeroneseError, open_clip, segment_pair, segment_stream

FIRST, SECOND = frame(0), frame(1)


class Tensor:
    """As torch has it: the protocol, and no base that NumPy knows."""

    def __init__(self, pixels: Pixels) -> None:
        self.pixels = pixels

    def __array__(self, dtype: Any = None, copy: Any = None) -> Pixels:
        return self.pixels


class Interface:
    def __init__(self, pixels: Pixels) -> None:
        self.__array_interface__ = pixels.__array_interface__
        self.pixels = pixels


class Picture:
    """As Pillow has it: its array is that of its mode, which only `convert` changes."""

    def __init__(self, mode: str, pixels: Pixels) -> None:
        self.mode, self.info, self.pixels = mode, {"transparency": 0}, pixels

    def convert(self, mode: str, /) -> Picture:
        alpha = np.full((*self.pixels.shape[:2], 1), 255, np.uint8)
        return Picture(mode, np.concatenate([self.pixels, alpha], axis=2) if mode == "RGBA" else self.pixels)

    @property
    def __array_interface__(self) -> Dict[str, Any]:
        self.shown = self.pixels[..., 0].copy() if self.mode == "P" else self.pixels
        return self.shown.__array_interface__


def test_a_moving_square_is_found_with_its_motion() -> None:
    found = segment_pair(FIRST, SECOND)
    assert (found.width, found.height, found.count) == (96, 72, 2)
    assert found.labels.shape == (72, 96) and found.labels.dtype == np.uint8
    assert found.labels[36, 42] == 1 and found.labels[5, 5] == 0
    ground, square = found.motions
    assert square.matrix.shape == (6,) and square.matrix.dtype == np.float64
    flow = square.matrix.reshape(2, 3) @ [42, 36, 1]
    np.testing.assert_allclose(flow, [2, 1], atol=0.3)
    assert ground.pixels == int((found.labels == 0).sum())
    assert ground.share == pytest.approx(ground.pixels / found.labels.size)
    assert found.confidence is None and found.unlabelled == 0 and found.quality == "best"
    assert [candidate.motions for candidate in found.candidates] == list(range(1, len(found.candidates) + 1))
    assert all(one.labels == (0, 1) and 0 <= one.likelihood <= 1 for one in found.junctions)


def test_options_reach_the_core() -> None:
    found = segment_pair(FIRST, SECOND, motions=1, quality="fast", mark_unknown=True, confidence=True)
    assert found.count == 1 and found.quality == "fast"
    assert found.unlabelled == int((found.labels == 255).sum()) > 0
    assert found.confidence is not None and found.confidence.shape == found.labels.shape
    assert not found.confidence[found.labels == 255].any()


def test_all_forms_of_a_frame_give_the_same(tmp_path: Path) -> None:
    def labels(form: Any) -> bytes:
        return segment_pair(form(FIRST, 0), form(SECOND, 1), quality="fast").labels.tobytes()

    expected = labels(lambda pixels, _: pixels)
    alpha = np.full((72, 96, 1), 255, dtype=np.uint8)
    forms: Dict[str, Any] = {
        "RGBA": lambda pixels, _: np.concatenate([pixels, alpha], axis=2),
        "a view with steps": lambda pixels, _: np.repeat(np.repeat(pixels, 2, axis=0), 2, axis=1)[::2, ::2],
        "turned twice": lambda pixels, _: np.ascontiguousarray(pixels[::-1, ::-1])[::-1, ::-1],
        "column by column": lambda pixels, _: np.asfortranarray(pixels),
        "a path": lambda pixels, k: write_image(tmp_path / f"{k}.png", pixels),
        "a text": lambda pixels, k: str(write_image(tmp_path / f"{k}.png", pixels)),
        "bytes of a file": lambda pixels, k: write_image(tmp_path / f"{k}.png", pixels).read_bytes(),
        "a buffer with the bytes of a file": lambda pixels, k: memoryview(write_image(tmp_path / f"{k}.png", pixels).read_bytes()),
        "a buffer of pixels": lambda pixels, _: memoryview(pixels),
        "a tensor": lambda pixels, _: Tensor(pixels),
        "an array interface": lambda pixels, _: Interface(pixels),
        "a picture": lambda pixels, _: Picture("RGB", pixels),
        "a picture with a palette": lambda pixels, _: Picture("P", pixels),
    }
    for name, form in forms.items():
        assert labels(form) == expected, name
    grey = labels(lambda pixels, _: pixels[..., 0])
    assert grey == labels(lambda pixels, _: np.stack([pixels[..., 0]] * 3, axis=2))


def test_the_caller_may_write_to_the_arrays_afterwards() -> None:
    first, second = FIRST.copy(), SECOND.copy()
    found = segment_pair(first, second)
    first[:], second[:] = 0, 0
    found.labels[:] = 7
    assert segment_pair(FIRST, SECOND).count == 2


@pytest.mark.parametrize(
    ("code", "first", "options"),
    [
        ("frame-size-mismatch", frame(0, size=(96, 64)), {}),
        ("frame-size-unsupported", np.zeros((15, 96, 3), np.uint8), {}),
        ("frame-size-unsupported", np.zeros((16, 4097), np.uint8), {}),
        ("invalid-input", FIRST.astype(np.float32), {}),
        ("invalid-input", FIRST[..., :2], {}),
        ("invalid-input", 3, {}),
        ("invalid-input", [[1, 2], [3, 4]], {}),
        ("invalid-input", Tensor(FIRST.transpose(2, 0, 1)), {}),
        ("invalid-input", Picture("I;16", FIRST), {}),
        ("unreadable-image", b"text", {}),
        ("file-not-found", "nowhere.png", {}),
        ("unreadable-file", Path(__file__).parent, {}),
        ("unreadable-image", __file__, {}),
        ("invalid-option", FIRST, {"motions": 11}),
        ("invalid-option", FIRST, {"motions": 0}),
        ("invalid-option", FIRST, {"motions": True}),
        ("invalid-option", FIRST, {"motions": 2.0}),
        ("invalid-option", FIRST, {"motions": "two"}),
        ("invalid-option", FIRST, {"quality": "good"}),
        ("invalid-option", FIRST, {"quality": None}),
    ],
)
def test_what_cannot_be_processed_has_a_code(code: str, first: Any, options: Any) -> None:
    with pytest.raises(VeroneseError) as caught:
        segment_pair(first, SECOND, **options)
    assert caught.value.code == code
    assert str(caught.value)


def test_a_misspelt_option_is_refused() -> None:
    with pytest.raises(TypeError, match="motion"):
        segment_pair(FIRST, SECOND, motion=2)  # type: ignore[call-arg]


def test_what_is_printed_is_short_and_a_notebook_shows_the_labels() -> None:
    found = segment_pair(FIRST, SECOND, quality="fast")
    assert repr(found) == "Segmentation(96×72, 2 motions)"
    clip = open_clip([FIRST, SECOND])
    clip.segment(quality="fast")
    seen = clip.labels(0)
    assert repr(seen) == "ClipFrame(0, 96×72, objects=[1])"
    assert repr(clip) == "Clip(2 frames)" and repr(segment_stream([FIRST])) == "ClipStream()"
    assert repr(clip.tracks()) == "ClipTracks([ClipTrack(1, frames 0 to 1)])"
    said = [Strokes(1, 3, found.labels), Mask(0, 2, found.labels == 1), Labels(0, found.labels, own=True)]
    assert repr(said) == "[Strokes(1, 3, 96×72), Mask(0, 2, 96×72), Labels(0, 96×72, own=True)]"
    for one in (found, seen):
        assert one._repr_png_() == one.png()
        np.testing.assert_array_equal(read_indexed(one.png()), one.labels)


def read_indexed(file: bytes) -> Pixels:
    """The indices of a PNG file with eight bits for each and no filters, as the package writes it."""
    parts: Dict[bytes, bytes] = {}
    at = 8
    while at < len(file):
        (length,) = struct.unpack(">I", file[at : at + 4])
        kind, content = file[at + 4 : at + 8], file[at + 8 : at + 8 + length]
        assert struct.unpack(">I", file[at + 8 + length : at + 12 + length]) == (zlib.crc32(kind + content),)
        parts[kind] = content
        at += 12 + length
    width, height = struct.unpack(">II", parts[b"IHDR"][:8])
    assert list(parts[b"PLTE"][:9]) == [0, 0, 0, 128, 0, 0, 0, 128, 0] and parts[b"PLTE"][-3:] == b"\xff" * 3
    rows = np.frombuffer(zlib.decompress(parts[b"IDAT"]), np.uint8).reshape(height, 1 + width)
    assert not rows[:, 0].any()
    return rows[:, 1:]


def test_errors_and_results_cross_processes() -> None:
    error = pickle.loads(pickle.dumps(VeroneseError("invalid-input", "a sentence")))
    assert (error.code, str(error)) == ("invalid-input", "a sentence")
    found = pickle.loads(pickle.dumps(segment_pair(FIRST, SECOND, quality="fast")))
    assert found.motions[1].matrix.shape == (6,)


def test_a_clip_of_two_frames_takes_strokes() -> None:
    clip = open_clip([FIRST, SECOND])
    clip.segment()
    found = [frame.labels for frame in clip]
    stroke = np.full_like(found[0], 255)
    stroke[:36] = 0
    assert {one.frame for one in clip.annotate(Strokes(0, 1, stroke))} == {0, 1}
    changed = [frame.labels for frame in clip]
    assert (found[0][:36] == 1).any() and not (changed[0][:36] == 1).any()
    assert all((now == 1).sum() < (before == 1).sum() for now, before in zip(changed, found))
    clip.clear(0, 1)
    assert all((frame.labels == found[frame.index]).all() for frame in clip)


def test_the_version_is_that_of_the_wheel() -> None:
    from importlib.metadata import version

    assert veronese.__version__ == version("veronese")
