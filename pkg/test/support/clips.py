"""Clips that `veronese convert` wrote, and what should be found in them: for the scripts beside, whose decoders are those of other tools.

Every decoder gives shapes by (frame, object): masks, or boxes as (left, top, width, height). Formats that do not say which object a shape
is are compared in the order of the objects, or class by class.
"""

import base64
import json
import sys
from collections import defaultdict
from pathlib import Path

import numpy as np
from PIL import Image
from pycocotools import mask as coco_mask


class Clip:
    """The converted clip, and what should be found."""

    def __init__(self, case, folder):
        self.folder = folder / case["out"]
        self.name = case["name"]
        self.tracks = case["tracks"]
        self.shape = (self.tracks["height"], self.tracks["width"])
        self.files = self.tracks["files"]
        self.names = self.tracks["frames"]
        self.labels = [np.frombuffer(base64.b64decode(frame), np.uint8).reshape(self.shape) for frame in case["labels"]]
        self.classes = {thing["id"]: thing.get("name", "object") for thing in self.tracks["objects"]}
        self.masks = {(t, int(k)): frame == k for t, frame in enumerate(self.labels) for k in np.unique(frame) if 0 < k < 255}

    def path(self, *names):
        return self.folder.joinpath(*names)

    def text(self, *names):
        return self.path(*names).read_text(encoding="utf-8")

    def json(self, *names):
        return json.loads(self.text(*names))

    def check_class(self, thing, name):
        assert self.classes[thing] == name, f"object {thing} is {name!r}, not {self.classes[thing]!r}"

    def images(self, *names):
        """Puts empty ones into a folder."""
        self.path(*names).mkdir(exist_ok=True)
        for name in self.files:
            Image.new("L", self.shape[::-1]).save(self.path(*names, name))

    def boxes(self):
        found = {}
        for key, mask in self.masks.items():
            (ys, xs) = np.nonzero(mask)
            found[key] = (xs.min(), ys.min(), np.ptp(xs) + 1, np.ptp(ys) + 1)
        return found

    def in_order(self):
        """Masks by (frame, how many come before)."""
        found = {}
        for t in range(len(self.labels)):
            here = sorted(key for key in self.masks if key[0] == t)
            found.update({(t, k): self.masks[key] for k, key in enumerate(here)})
        return found

    def by_class(self):
        return united(((t, self.classes[thing]), mask) for (t, thing), mask in self.masks.items())


def united(pairs):
    masks = {}
    for key, mask in pairs:
        masks[key] = masks[key] | mask if key in masks else mask
    return masks


def counted(pairs):
    """(frame, shape) in their order, by (frame, how many came before)."""
    count = defaultdict(int)
    found = {}
    for t, shape in pairs:
        found[(t, count[t])] = shape
        count[t] += 1
    return found


def placed(small, left, top, shape):
    full = np.zeros(shape, bool)
    full[top : top + small.shape[0], left : left + small.shape[1]] = small
    return full


def rasterised(rings, shape):
    """Polygons as COCO's own code and datumaro fill them."""
    return coco_mask.decode(coco_mask.merge(coco_mask.frPyObjects(rings, *shape))).astype(bool)


def report(decoders):
    """Prints {"format": {"clips", "shapes", "mistakes"}} as JSON, of the clips of cases.json in the folder that the command line names."""
    folder = Path(sys.argv[1])
    clips = [Clip(case, folder) for case in json.loads((folder / "cases.json").read_text())]
    result = {}
    for name, (decoder, truth) in decoders.items():
        read, shapes, mistakes = 0, 0, []
        for index, clip in enumerate(clips):
            try:
                found, expected = decoder(clip), truth(clip)
                read += 1
                if found.keys() != expected.keys():
                    mistakes.append(f"clip {index}: {sorted(found)}, not {sorted(expected)}")
                for key in found.keys() & expected.keys():
                    shapes += 1
                    if not np.array_equal(found[key], expected[key]):
                        mistakes.append(f"clip {index}, {key}: not the same")
            except Exception as error:
                mistakes.append(f"clip {index}: {error!r}")
        result[name] = {"clips": read, "shapes": shapes, "mistakes": mistakes[:5]}
    json.dump(result, sys.stdout)
