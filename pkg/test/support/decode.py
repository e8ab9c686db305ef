"""Decodes what the encoders wrote with the tools' own decoders, and compares pixel by pixel.

decode.py FOLDER: reads FOLDER/cases.json, prints {"format": [masks compared, first mistakes]} as JSON.

Of large tools only the modules that decode are loaded, without what their packages import for servers and windows.
"""

import ast
import base64
import contextlib
import importlib.util
import io
import json
import sys
import types
import uuid
import zipfile
import zlib
from collections import defaultdict
from pathlib import Path

import cv2
import numpy as np
import PIL.Image
from PIL import Image
from pycocotools import mask as coco_mask
from pycocotools.coco import COCO


def bare(*names):
    """Packages whose __init__ is not run."""
    for name in names:
        module = types.ModuleType(name)
        module.__path__ = list(importlib.util.find_spec(name).submodule_search_locations)
        sys.modules[name] = module


bare("cvat_sdk", "label_studio_sdk")
bare("label_studio_sdk.converter")

from cvat_sdk.masks import decode_mask  # noqa: E402
from datumaro.plugins.data_formats.cvat.base import CvatBase  # noqa: E402
from datumaro.plugins.data_formats.mots import MotsImporter, MotsPngExtractor  # noqa: E402
from label_studio_sdk.converter import brush  # noqa: E402


def taken(package, place, *functions):
    """Functions of an installed file that cannot be imported without servers or windows."""
    file = Path(importlib.util.find_spec(package).submodule_search_locations[0], *place)
    names = {"np": np, "cv2": cv2, "zlib": zlib, "base64": base64, "io": io, "Image": Image, "PIL": PIL, "uuid": uuid}
    tree = ast.parse(file.read_text(encoding="utf-8"))
    found = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef) and node.name in functions]
    assert len(found) == len(functions), f"{file}: {[node.name for node in found]}"
    for node in found:
        node.decorator_list = []
        node.returns = None
        for argument in node.args.args:
            argument.annotation = None
    exec(compile(ast.Module(found, []), str(file), "exec"), names)
    return names[functions[0]]


sly_decode = taken("supervisely", ["geometry", "bitmap.py"], "base64_2_data")
img_b64_to_arr = taken("labelme", ["utils", "image.py"], "img_b64_to_arr", "img_data_to_arr", "img_data_to_pil")
shapes_to_label = taken("labelme", ["utils", "shape.py"], "shapes_to_label", "shape_to_mask")


def placed(small, left, top, shape):
    full = np.zeros(shape, bool)
    full[top : top + small.shape[0], left : left + small.shape[1]] = small
    return full


def number(name):
    return int(name.removeprefix("motion-"))


def rasterised(rings, shape):
    """Polygons as COCO's own code and datumaro fill them."""
    return coco_mask.decode(coco_mask.merge(coco_mask.frPyObjects(rings, *shape))).astype(bool)


def united(pairs):
    masks = {}
    for label, mask in pairs:
        masks[label] = masks[label] | mask if label in masks else mask
    return masks


def coco(document, shape, folder):
    place = folder / "coco.json"
    place.write_text(json.dumps(document))
    with contextlib.redirect_stdout(io.StringIO()):
        data = COCO(place)
    masks = {}
    for annotation in data.anns.values():
        mask = data.annToMask(annotation).astype(bool)
        assert annotation["area"] == mask.sum(), "area"
        if isinstance(annotation["segmentation"], dict):
            assert list(coco_mask.toBbox(annotation["segmentation"])) == annotation["bbox"], "bbox"
        masks[annotation["category_id"] - 1] = mask
    return masks


def coco_counts(counted, shape, folder):
    return {int(label): coco_mask.decode(coco_mask.frPyObjects(rle, *shape)).astype(bool) for label, rle in counted.items()}


def cvat_xml(text, shape, folder):
    place = folder / "annotations.xml"
    (folder / "images").mkdir()
    Image.new("L", shape[::-1]).save(folder / "images" / "first.png")
    place.write_text(text, encoding="utf-8")
    (item,) = list(CvatBase(str(place)))
    names = [label.name for label in item_labels(place)]
    pairs = []
    for annotation in item.annotations:
        kind = annotation.type.name
        mask = annotation.image.astype(bool) if kind == "mask" else rasterised([annotation.points], shape)
        if mask.shape != shape:
            raise AssertionError(f"mask of {mask.shape}")
        pairs.append((number(names[annotation.label]), mask))
    return united(pairs)


def item_labels(place):
    return list(CvatBase(str(place)).categories().values())[0].items


def cvat_points(shapes, shape, folder):
    return {number(s["label"]): decode_mask(s["points"], image_width=shape[1], image_height=shape[0]) for s in shapes}


def mots(archive, shape, folder):
    """What datumaro says of the first frame."""
    place = folder / "mots"
    with zipfile.ZipFile(io.BytesIO(base64.b64decode(archive))) as files:
        files.extractall(place)
    (source,) = MotsImporter.find_sources(str(place))
    data = MotsPngExtractor(source["url"], subset="default")
    names = [label.name for label in list(data.categories().values())[0].items]
    (item,) = [item for item in data if item.id == "first"]
    return {number(names[a.label]): np.asarray(a.image).astype(bool) for a in item.annotations}


def label_studio(task, shape, folder):
    masks = {}
    for result in task["predictions"][0]["result"]:
        assert (result["original_height"], result["original_width"]) == shape
        image = brush.decode_rle(result["value"]["rle"]).reshape(*shape, 4)
        assert (image == image[:, :, :1]).all() and set(np.unique(image)) <= {0, 255}
        masks[number(result["value"]["brushlabels"][0])] = image[:, :, 3] > 0
    return masks


def label_studio_polygon(task, shape, folder):
    pairs = []
    for result in task["predictions"][0]["result"]:
        ring = (np.array(result["value"]["points"]) / 100 * [shape[1], shape[0]]).ravel().tolist()
        pairs.append((number(result["value"]["polygonlabels"][0]), rasterised([ring], shape)))
    return united(pairs)


def labelme(document, shape, folder):
    shapes = [{**s, "mask": img_b64_to_arr(s["mask"]).astype(bool)} for s in document["shapes"]]
    values = {s["label"]: index + 1 for index, s in enumerate(shapes)}
    classes, _ = shapes_to_label(shape, shapes, values)
    return {number(name): classes == value for name, value in values.items()}


def yolo(files, shape, folder):
    masks = {}
    for line in files["text"].splitlines():
        index, *shares = line.split(" ")
        ring = (np.array(shares, float).reshape(-1, 2) * [shape[1], shape[0]]).ravel().tolist()
        masks[number(files["names"][int(index)])] = rasterised([ring], shape)
    return masks


def davis(png, shape, folder):
    image = Image.open(io.BytesIO(base64.b64decode(png)))
    assert image.mode == "P", image.mode
    labels = np.array(image)
    return {int(label): labels == label for label in np.unique(labels) if label != 255}


def supervisely(annotation, shape, folder):
    masks = {}
    for thing in annotation["objects"]:
        left, top = thing["bitmap"]["origin"]
        masks[number(thing["classTitle"])] = placed(sly_decode(thing["bitmap"]["data"]), left, top, shape)
    return masks


def coco_video(document, shape, folder):
    """Masks of the second frame are moved beyond the first's labels; see the test."""
    return {
        (t, annotation["category_id"] - 1): coco_mask.decode(rle).astype(bool)
        for annotation in document["annotations"]
        for t, rle in enumerate(annotation["segmentations"])
        if rle is not None
    }


DECODERS = {
    "cocoRle": coco,
    "cocoPolygon": coco,
    "cocoCounts": coco_counts,
    "cocoVideo": coco_video,
    "cvatXmlMask": cvat_xml,
    "cvatXmlPolygon": cvat_xml,
    "cvatPoints": cvat_points,
    "cvatMots": mots,
    "labelStudioBrush": label_studio,
    "labelStudioPolygon": label_studio_polygon,
    "labelMe": labelme,
    "yolo": yolo,
    "davis": davis,
    "supervisely": supervisely,
}


def masks_of(labels):
    return {int(label): labels == label for label in np.unique(labels) if label != 255}


def main(folder):
    compared = defaultdict(int)
    images = defaultdict(int)
    mistakes = defaultdict(list)
    for index, case in enumerate(json.loads((folder / "cases.json").read_text())):
        shape = (case["height"], case["width"])
        labels = np.frombuffer(base64.b64decode(case["labels"]), np.uint8).reshape(shape)
        for name, encoded in case["encoded"].items():
            expected = masks_of(labels)
            if name == "cocoVideo":
                frames = [labels, labels[::-1, ::-1] // 2]
                expected = {(t, label): mask for t, frame in enumerate(frames) for label, mask in masks_of(frame).items()}
            place = folder / str(index) / name
            place.mkdir(parents=True)
            try:
                found = DECODERS[name](encoded, shape, place)
                if found.keys() != expected.keys():
                    mistakes[name].append(f"image {index}: masks {sorted(found)}, not {sorted(expected)}")
                for key in found.keys() & expected.keys():
                    compared[name] += 1
                    wrong = int((found[key] != expected[key]).sum())
                    if wrong:
                        mistakes[name].append(f"image {index}, mask {key}: {wrong} pixels")
            except Exception as error:
                mistakes[name].append(f"image {index}: {error!r}")
            images[name] += 1
    report = {name: {"images": images[name], "masks": compared[name], "mistakes": mistakes[name][:5]} for name in DECODERS}
    json.dump(report, sys.stdout)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
