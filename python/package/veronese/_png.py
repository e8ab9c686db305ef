"""Labels as a PNG file whose palette indices they are, in the colours of the DAVIS benchmark."""

from __future__ import annotations

import struct
import zlib

import numpy as np
from numpy.typing import NDArray

PATTERNED = 22
"""Number of colours that DAVIS takes from the PASCAL VOC pattern; grey levels follow."""


def indexed_png(labels: NDArray[np.uint8]) -> bytes:
    height, width = labels.shape
    rows = np.zeros((height, 1 + width), np.uint8)  # each row begins with its filter: none
    rows[:, 1:] = labels
    parts = (b"IHDR", struct.pack(">II", width, height) + bytes([8, 3, 0, 0, 0])), (b"PLTE", palette()), (b"IDAT", zlib.compress(rows.tobytes())), (b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunk(kind, content) for kind, content in parts)


def chunk(kind: bytes, content: bytes) -> bytes:
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def palette() -> bytes:
    def channel(index: int, shift: int) -> int:
        if index >= PATTERNED:
            return index
        level = ((index >> shift) & 1) << 7 | ((index >> shift + 3) & 1) << 6
        return 191 if level == 192 else level

    return bytes(channel(index, shift) for index in range(256) for shift in range(3))
