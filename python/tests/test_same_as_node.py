"""The same bits as the npm package: labels, motions, tracks and changes."""

from __future__ import annotations

import hashlib
import json
import re
import shutil
import subprocess
from dataclasses import fields
from pathlib import Path
from typing import Any, Dict, Iterator, List, Optional, Tuple

import numpy as np
import pytest
import veronese
from numpy.typing import NDArray
from scenes import Pixels, clip, frame, square_mask
from veronese import ClipTracks, Labels, Mask, Prompt, Segmentation, Strokes, fit_points, open_clip, segment_pair, segment_stream

HERE = Path(__file__).parent
SAMPLES = HERE.parents[1] / "www" / "public" / "samples"
NODE = shutil.which("node") or ""

pytestmark = pytest.mark.skipif(not NODE, reason="there is no node to compare with")

NAMES = {"mark_unknown": "markUnknown", "look_ahead": "lookAhead"}
# Edits of a clip once it is segmented.
EDITS = ("accepted", "locked", "named")


def sha256(content: Any) -> str:
    return hashlib.sha256(content).hexdigest()


def numbers(values: Any) -> str:
    """A hash of all numbers in nested lists."""

    def flat(value: Any) -> Iterator[float]:
        if isinstance(value, (list, tuple, np.ndarray)):
            for one in value:
                yield from flat(one)
        else:
            yield value

    return sha256(np.fromiter(flat(values), dtype="<f8").tobytes())


def matrix(entries: Optional[NDArray[np.float64]]) -> List[float]:
    return [0] if entries is None else [1, *entries]


class Asked:
    """Calls of both: frames as files of bytes for Node, as arrays or paths for Python."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.pairs: List[Tuple[Any, Any, Dict[str, Any]]] = []
        self.clips: List[Tuple[List[Any], bool, Dict[str, Any]]] = []
        self.points: List[Tuple[NDArray[np.float64], NDArray[np.float64], Dict[str, Any]]] = []
        self.files = 0

    def write(self, content: bytes) -> str:
        self.files += 1
        path = self.folder / f"{self.files}.bin"
        path.write_bytes(content)
        return str(path)

    def frame(self, given: Any) -> Dict[str, Any]:
        if isinstance(given, Path):
            return {"path": str(given)}
        height, width = given.shape[:2]
        rgba = np.full((height, width, 4), 255, np.uint8)
        rgba[..., :3] = given
        return {"path": self.write(rgba.tobytes()), "width": width, "height": height}

    def annotation(self, given: Any) -> Dict[str, Any]:
        """An annotation as Node has it."""
        common: Dict[str, Any] = {"frame": given.frame, "propagate": given.propagate}
        if isinstance(given, Labels):
            return {**common, "labels": self.write(given.labels.tobytes()), "own": given.own}
        common["object"] = given.object
        if isinstance(given, Prompt):
            clicks = [*([(*given.click, 1)] if given.click else []), *given.clicks]
            return {**common, "clicks": clicks, **({"box": given.box} if given.box else {})}
        form = "mask" if isinstance(given, Mask) else "strokes"
        return {**common, form: self.write(given.mask.tobytes())}

    def of_node(self) -> Any:
        def options(given: Dict[str, Any]) -> Dict[str, Any]:
            return {NAMES.get(name, name): value for name, value in given.items() if name not in (*EDITS, "annotations")}

        asked = {
            "pairs": [{"frames": [self.frame(one) for one in pair], "options": options(given)} for *pair, given in self.pairs],
            "clips": [
                {
                    "frames": [self.frame(one) for one in frames],
                    "stream": stream,
                    "options": options(given),
                    **{name: given[name] for name in EDITS if name in given},
                    "annotations": [self.annotation(one) for one in given.get("annotations", ())],
                }
                for frames, stream, given in self.clips
            ],
            "points": [
                {"positions": xy.ravel().tolist(), "derivatives": of.ravel().tolist(), "options": options(given)}
                for xy, of, given in self.points
            ],
        }
        ended = subprocess.run([NODE, str(HERE / "node_results.mjs")], input=json.dumps(asked), capture_output=True, text=True)
        assert ended.returncode == 0, ended.stderr
        return json.loads(ended.stdout)


def of_pair(found: Segmentation) -> Dict[str, Any]:
    motions = [[one.label, one.matrix, one.pixels, one.share, one.residual, one.bbox, one.group] for one in found.motions]
    junctions = [[one.labels, one.likelihood, one.border] for one in found.junctions]
    candidates = [[one.motions, one.score] for one in found.candidates]
    return {
        "labels": sha256(found.labels.tobytes()),
        "confidence": None if found.confidence is None else sha256(found.confidence.tobytes()),
        "numbers": numbers([motions, junctions, candidates]),
    }


def of_tracks(tracks: ClipTracks) -> str:
    objects = [
        [track.id, track.first, track.last, [[at.frame, at.pixels, at.bbox, at.confidence, matrix(at.matrix)] for at in track.frames]]
        for track in tracks.objects
    ]
    return numbers([objects, [[one.frame, one.matrix] for one in tracks.background], tracks.dropped])


def of_clip(frames: List[Any], stream: bool, options: Dict[str, Any]) -> Dict[str, Any]:
    if stream:
        segmented = segment_stream(iter(frames), **options)
        return {"labels": [sha256(one.labels.tobytes()) for one in segmented], "tracks": of_tracks(segmented.tracks()), "changes": []}
    clip = open_clip(frames, mark_unknown=options.get("mark_unknown", False))
    clip.segment(quality=options.get("quality", "best"))
    for number in options.get("named", ()):
        clip.describe(number, "thing")
    clip.lock(options.get("locked", ()))
    clip.accept(options.get("accepted", ()))
    changes = clip.annotate(*options["annotations"]) if "annotations" in options else []
    labels = [sha256(one.labels.tobytes()) for one in clip]
    return {"labels": labels, "tracks": of_tracks(clip.tracks()), "changes": [[one.frame, one.object, one.gained, one.lost] for one in changes]}


def test_ten_pairs(tmp_path: Path) -> None:
    asked = Asked(tmp_path)
    for k in range(9):
        size = [(96, 72), (120, 90), (160, 120)][k % 3]
        ground, square = (0.4 * k - 1.5, 0.3 - 0.2 * k), (2.0 + 0.5 * k, 1.5 - 0.4 * k)
        pair = [frame(t, size=size, ground=ground, square=square) for t in (0, 1)]
        options: Dict[str, Any] = {
            "quality": ["best", "fast"][k % 2],
            "mark_unknown": k % 4 == 1,
            "confidence": k % 3 == 0,
            "subject": k % 4 == 2,
            **({"motions": 2 + k % 2} if k % 4 == 3 else {}),
        }
        asked.pairs.append((pair[0], pair[1], options))
    asked.pairs.append((SAMPLES / "intel-two-cars" / "first.png", SAMPLES / "intel-two-cars" / "second.png", {"quality": "fast"}))
    found = [of_pair(segment_pair(first, second, **options)) for first, second, options in asked.pairs]
    assert found == asked.of_node()["pairs"]
    assert len({one["numbers"] for one in found}) == 10, "all are different"


def moving(count: int, size: Tuple[int, int]) -> List[Pixels]:
    return [frame(index / 2, size=size, ground=(0.5, 0.25), square=(3, -1)) for index in range(count)]


def test_two_clips_whole_corrected_and_as_streams(tmp_path: Path) -> None:
    asked = Asked(tmp_path)
    generated = clip(6)
    real = [SAMPLES / "passing-cars" / "frames" / f"{index:02}.webp" for index in range(4)]
    partly = square_mask(1.5, 9, 255)
    partly[:, :40] = 255
    annotations: Dict[str, Any] = {
        "annotations": [
            Labels(1, square_mask(0.5, 7, 0), own=True),
            Labels(4, square_mask(2, 7, 255), own=True, propagate="backward"),
            Labels(3, partly),
            Labels(4, square_mask(2, 255, 0), propagate="forward"),
            Prompt(5, 3, box=(60, 5, 30, 20)),
            Prompt(3, 2, click=(5, 5)),
        ]
    }
    others: List[Any] = [
        Labels(3, partly),
        Mask(3, 1, square_mask(1.5, 1, 255)),
        Strokes(1, 5, square_mask(0.5, 0, 255), propagate="forward"),
        Prompt(2, 6, (60, 5, 30, 20), clicks=[(70, 10, 1), (62, 24, -1)]),
        Prompt(4, 6, click=(75, 12), propagate="backward"),
    ]
    asked.clips = [
        (generated, False, {}),
        (generated, False, {"quality": "fast", **annotations}),
        (generated, False, {"quality": "fast", **annotations, "locked": [1]}),
        (generated, False, {"quality": "fast", "named": [1], "accepted": [0, 5], "annotations": others}),
        (generated, True, {"quality": "fast", "look_ahead": 2, "mark_unknown": True}),
        (moving(10, (120, 90)), True, {"quality": "fast"}),
        (real, False, {"quality": "fast", "mark_unknown": True}),
        (real, True, {"quality": "fast", "look_ahead": 0, "subject": True}),
    ]
    found = [of_clip(*one) for one in asked.clips]
    assert found == asked.of_node()["clips"]
    assert len({one["tracks"] for one in found}) == len(found), "all are different"
    assert [bool(one["changes"]) for one in found] == [False, True, True, True, False, False, False, False]


def test_measurements(tmp_path: Path) -> None:
    asked = Asked(tmp_path)
    j = np.arange(200)
    positions = np.column_stack([(j * 37) % 101, (j * 53) % 89]).astype(float)
    gradients = np.column_stack([np.cos(1.7 * j), np.sin(2.3 * j)])
    flow = np.where(j[:, None] < 130, [1.5, -0.5], [-0.5, 0.75])
    derivatives = np.column_stack([gradients, -(gradients * flow).sum(axis=1) + 0.01 * np.sin(11.0 * j)])
    asked.points = [(positions, derivatives, {"method": method, "seed": 5}) for method in ("best", "paper")]
    found = []
    for xy, of, options in asked.points:
        fit = fit_points(xy, of, **options)
        motions = [[one.matrix, one.measurements, one.determined] for one in fit.motions]
        found.append({"labels": sha256(fit.labels.tobytes()), "numbers": numbers([motions, fit.singular_values])})
    assert found == asked.of_node()["points"]
    entries = asked.of_node()["entries"]
    assert set(entries) == {"FittedMotion", "PaperStages", "Refinement", "RankCandidate"}
    assert_known(entries)


def assert_known(entries: Dict[str, List[str]]) -> None:
    """Whatever Node's reports have, Python's classes have."""
    for name, known in entries.items():
        names = {re.sub("[A-Z]", lambda letter: "_" + letter.group().lower(), one) for one in known}
        assert names <= {field.name for field in fields(getattr(veronese, name))}, name


def test_nothing_of_a_report_is_left_out(tmp_path: Path) -> None:
    asked = Asked(tmp_path)
    asked.pairs = [(SAMPLES / "intel-two-cars" / "first.png", SAMPLES / "intel-two-cars" / "second.png", {"quality": "fast"})]
    asked.clips = [(clip(4), False, {"quality": "fast"})]
    entries = asked.of_node()["entries"]
    assert set(entries) == {"SegmentedMotion", "Junction", "Candidate", "Sighting", "BackgroundMotion"}
    assert_known(entries)
