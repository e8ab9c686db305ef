"""Follows what moves through a folder of frames, and keeps a mask of every frame and the tracks.

    python clip_to_masks.py FRAMES OUT

If it is interrupted, it goes on the next time: what it has done is in OUT/clip.journal.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Optional

import numpy as np
from veronese import VeroneseError, open_clip


def report(stage: str, frame: int, of: Optional[int]) -> None:
    print(f"\r{stage}: frame {frame + 1} of {of}   ", end="", file=sys.stderr, flush=True)


def main(frames: Path, out: Path) -> None:
    out.mkdir(parents=True, exist_ok=True)
    with open_clip(frames, journal=out / "clip.journal") as clip:
        if not all(frame.has_masks for frame in clip.frames):
            clip.segment(quality="fast", progress=report)
            print(file=sys.stderr)
        for frame in clip:
            np.save(out / f"{frame.index:05}.npy", frame.labels)  # (height, width): 0 is the background, other numbers are objects
        tracks = clip.tracks()
    boxes = {track.id: {sighting.frame: sighting.bbox for sighting in track.frames} for track in tracks.objects}
    (out / "boxes.json").write_text(json.dumps(boxes), encoding="utf-8")
    for track in tracks.objects:
        print(f"object {track.id}: frames {track.first} to {track.last}, at most {max(at.pixels for at in track.frames)} pixels")


if __name__ == "__main__":
    try:
        main(*map(Path, sys.argv[1:3]))
    except VeroneseError as error:
        sys.exit(f"{error.code}: {error}")
