"""Generated frames: a textured square moves before a textured ground."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Iterable, List, Tuple

import numpy as np
from numpy.typing import NDArray
from veronese import Clip, ClipFrame, open_clip

Pixels = NDArray[np.uint8]


def texture(x: NDArray[np.float64], y: NDArray[np.float64], phase: float) -> NDArray[np.float64]:
    """Smooth, without symmetry, in grey levels."""
    value: NDArray[np.float64] = np.sin(0.55 * x + phase) * np.cos(0.37 * y - phase) + 0.6 * np.sin(0.21 * x + 0.43 * y) + 0.4 * np.cos(0.9 * y - 0.3 * x)
    return 128 + 50 * value


def frame(
    t: float,
    *,
    size: Tuple[int, int] = (96, 72),
    ground: Tuple[float, float] = (0, 0),
    square: Tuple[float, float] = (2, 1),
) -> Pixels:
    """RGB at the time t. The ground and the square, of half the shorter side, move by so many pixels in each unit of time."""
    width, height = size
    x, y = np.meshgrid(np.arange(width, dtype=float), np.arange(height, dtype=float))
    left, top, side = width // 4 + t * square[0], height // 4 + t * square[1], min(size) // 2
    inside = (x >= left) & (x < left + side) & (y >= top) & (y < top + side)
    grey = np.where(
        inside,
        texture(x - t * square[0], y - t * square[1], 2),
        texture(x - t * ground[0], y - t * ground[1], 0),
    )
    colours = np.stack([grey, 0.8 * grey + 20, np.where(inside, 0.6, 1) * grey], axis=2)
    pixels: Pixels = np.clip(np.rint(colours), 0, 255).astype(np.uint8)
    return pixels


def clip(count: int, **options: Tuple[float, float]) -> List[Pixels]:
    return [frame(index / 2, **options) for index in range(count)]  # type: ignore[arg-type]


def square_mask(t: float, inside: int, outside: int, size: Tuple[int, int] = (96, 72)) -> Pixels:
    """Labels of the default square in a frame of a clip."""
    width, height = size
    x, y = np.meshgrid(np.arange(width), np.arange(height))
    left, top, side = width // 4 + t * 2, height // 4 + t, min(size) // 2
    covered = (x >= left) & (x < left + side) & (y >= top) & (y < top + side)
    return np.where(covered, inside, outside).astype(np.uint8)


def write_image(path: Path, pixels: Pixels) -> Path:
    """A portable pixmap: frames are recognised by their content, not by their names."""
    height, width, _ = pixels.shape
    path.write_bytes(b"P6\n%d %d\n255\n" % (width, height) + pixels.tobytes())
    return path


def corner(label: int) -> Pixels:
    """Labels of the top left corner of a frame, which is background."""
    labels = np.full((72, 96), 255, np.uint8)
    labels[2:14, 2:18] = label
    return labels


def segmented(frames: Any) -> Clip:
    opened = open_clip(frames)
    opened.segment(quality="fast")
    return opened


def labels_of(frames: Iterable[ClipFrame]) -> List[bytes]:
    return [found.labels.tobytes() for found in frames]
