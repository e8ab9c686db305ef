"""Answers the cases of a folder and prints their hashes: python bits.py DIR. The order of the numbers is that of bits.mjs."""

from __future__ import annotations

import hashlib
import json
import sys
from pathlib import Path
from typing import Any, Dict, Iterator, List

import numpy as np
from veronese import segment_clip, segment_pair

FOLDER = Path(sys.argv[1])
NAMES = {"markUnknown": "mark_unknown", "lookAhead": "look_ahead"}


def flat(value: Any) -> Iterator[float]:
    if isinstance(value, (list, tuple, np.ndarray)):
        for one in value:
            yield from flat(one)
    else:
        yield value


def perhaps(matrix: Any) -> List[Any]:
    """0 for no motion; 1 and its entries for one."""
    return [0] if matrix is None else [1, *matrix]


def of_pair(found: Any) -> List[Any]:
    return [
        [[one.label, one.matrix, one.pixels, one.share, one.residual, one.bbox, one.group] for one in found.motions],
        [[one.labels, one.likelihood, one.border] for one in found.junctions],
        [[one.motions, one.score] for one in found.candidates],
        [] if found.confidence is None else found.confidence.ravel(),
    ]


def of_frame(found: Any) -> List[Any]:
    objects = [[one.id, one.pixels, one.bbox, one.confidence, perhaps(one.matrix)] for one in found.objects]
    return [found.index, objects, perhaps(found.background)]


def bits(case: Dict[str, Any]) -> Dict[str, str]:
    options = {NAMES.get(name, name): value for name, value in case["options"].items()}
    shape = (case["height"], case["width"], 4)
    frames = [np.fromfile(FOLDER / name, np.uint8).reshape(shape) for name in case["frames"]]
    if case["clip"]:
        found = list(segment_clip(iter(frames) if "look_ahead" in options else frames, **options))
        labels, numbers = b"".join(one.labels.tobytes() for one in found), [of_frame(one) for one in found]
    else:
        pair = segment_pair(*frames, **options)
        labels, numbers = pair.labels.tobytes(), of_pair(pair)
    doubles = np.fromiter(flat(numbers), dtype="<f8")
    return {"labels": hashlib.sha256(labels).hexdigest(), "numbers": hashlib.sha256(doubles.tobytes()).hexdigest()}


print(json.dumps({case["name"]: bits(case) for case in json.loads((FOLDER / "cases.json").read_text())}))
