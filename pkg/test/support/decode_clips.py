"""Decodes what `veronese convert` wrote of clips with the tools' own decoders, and compares with the labels: decode_clips.py FOLDER.

Of large tools only the modules that decode are imported, without what their packages import for servers and windows.
"""

import configparser
import contextlib
import importlib.util
import io
import shutil
import sys
import types

import numpy as np
from clips import Clip, coco_mask, counted, rasterised, report, united
from datumaro import AnnotationType, Dataset
from PIL import Image
from pycocotools.coco import COCO

# TrackEval imports a solver for its matching, which is not installed: reading needs none.
sys.modules["scipy"] = types.ModuleType("scipy")
sys.modules["scipy.optimize"] = types.ModuleType("scipy.optimize")
sys.modules["scipy.optimize"].linear_sum_assignment = None

# Packages whose __init__ is not run.
for name in ("label_studio_sdk", "label_studio_sdk.converter", "trackeval", "trackeval.datasets"):
    module = types.ModuleType(name)
    module.__path__ = list(importlib.util.find_spec(name).submodule_search_locations)
    sys.modules[name] = module

from label_studio_sdk.converter import brush  # noqa: E402
from trackeval.datasets.mots_challenge import MOTSChallenge  # noqa: E402


def coco(clip, name):
    with contextlib.redirect_stdout(io.StringIO()):
        data = COCO(clip.path(name))
    frames = {image["id"]: clip.files.index(image["file_name"]) for image in data.imgs.values()}
    assert len(frames) == len(clip.files)
    masks = {}
    for annotation in data.anns.values():
        thing = annotation["attributes"]["track_id"]
        clip.check_class(thing, data.cats[annotation["category_id"]]["name"])
        masks[(frames[annotation["image_id"]], thing)] = data.annToMask(annotation).astype(bool)
    return masks


def youtube_vis(clip):
    document = clip.json("youtube-vis.json")
    (video,) = document["videos"]
    assert (video["file_names"], video["length"], video["height"], video["width"]) == (clip.files, len(clip.files), *clip.shape)
    names = {category["id"]: category["name"] for category in document["categories"]}
    masks = {}
    for track in document["annotations"]:
        clip.check_class(track["id"], names[track["category_id"]])
        assert len(track["segmentations"]) == len(track["bboxes"]) == len(track["areas"]) == len(clip.files)
        for t, rle in enumerate(track["segmentations"]):
            if rle is None:
                assert track["bboxes"][t] is None and track["areas"][t] is None
                continue
            assert list(coco_mask.toBbox(rle)) == track["bboxes"][t] and coco_mask.area(rle) == track["areas"][t]
            masks[(t, track["id"])] = coco_mask.decode(rle).astype(bool)
    return masks


def datumaro(path, name):
    """Items, the name of a class and an annotation, of a data set as Datumaro finds it."""
    data = Dataset.import_from(str(path), name)
    names = [label.name for label in data.categories()[AnnotationType.label]]
    for item in data:
        for annotation in item.annotations:
            yield item, names[annotation.label], annotation


def coco_datumaro(clip, name):
    """Datumaro wants the file in a folder that is called so, and the images beside it."""
    place = clip.path(f"{name}-datumaro", "annotations")
    place.mkdir(parents=True)
    clip.images(f"{name}-datumaro", "images")
    shutil.copy(clip.path(f"{name}.json"), place / "instances_default.json")
    pairs = []
    for item, kind, a in datumaro(place.parent, "coco"):
        thing = a.attributes["track_id"]
        clip.check_class(thing, kind)
        if a.type != AnnotationType.bbox:
            mask = a.image if a.type == AnnotationType.mask else rasterised([a.points], clip.shape)
            pairs.append(((clip.names.index(item.id), thing), np.asarray(mask, bool)))
    return united(pairs)


def cvat(clip, name):
    """CVAT's images have to be there."""
    clip.images("images")
    for item, kind, a in datumaro(clip.path(name), "cvat"):
        assert item.id == clip.names[item.attributes["frame"]]
        yield item.attributes["frame"], kind, a


def cvat_masks(clip):
    return counted((t, a.image.astype(bool)) for t, _, a in cvat(clip, "cvat.xml"))


def cvat_polygons(clip):
    return united(((t, name), rasterised([a.points], clip.shape)) for t, name, a in cvat(clip, "cvat-polygon.xml"))


def cvat_tracks(clip, name):
    """The shapes that are not outside. Those that are mark where a track leaves: once, in the frame after its last one."""
    shapes, left = {}, set()
    for item, kind, annotation in datumaro(clip.path(name), "cvat"):
        t = item.attributes["frame"]
        assert item.id == f"frame_{t:06}"
        thing = annotation.attributes["track_id"]
        clip.check_class(thing, kind)
        assert annotation.attributes["keyframe"]
        if annotation.attributes["outside"]:
            left.add((t, thing))
        else:
            shapes[(t, thing)] = annotation
    assert left == {(t + 1, k) for t, k in clip.masks if t + 1 < len(clip.files) and (t + 1, k) not in clip.masks}
    return shapes


def cvat_video(clip):
    return {key: rasterised([a.points], clip.shape) for key, a in cvat_tracks(clip, "cvat-video.xml").items()}


def cvat_boxes(clip):
    return {key: tuple(a.get_bbox()) for key, a in cvat_tracks(clip, "boxes/cvat-video.xml").items()}


def mots(clip):
    """TrackEval's reader of a folder, without a tracker to judge."""
    reader = MOTSChallenge.__new__(MOTSChallenge)
    reader.data_is_zipped = False
    reader.gt_fol = str(clip.folder)
    reader.config = {"SEQ_INFO": {"mots": None}, "GT_LOC_FORMAT": "{gt_folder}/{seq}/gt/gt.txt"}
    _, reader.seq_lengths = reader._get_seq_info()
    assert reader.seq_lengths["mots"] == len(clip.files)
    info = configparser.ConfigParser()
    info.read(clip.path("mots", "seqinfo.ini"))
    size = info["Sequence"]
    assert (int(size["imHeight"]), int(size["imWidth"]), size["name"], size["imExt"]) == (*clip.shape, clip.name, ".jpg")
    data = reader._load_raw_file(None, "mots", True)
    names = clip.text("mots", "gt", "labels.txt").splitlines()
    masks = {}
    for t in range(data["num_timesteps"]):
        for number, kind, rle in zip(data["gt_ids"][t], data["gt_classes"][t], data["gt_dets"][t]):
            assert number // 1000 == kind
            clip.check_class(number % 1000, names[kind - 1])
            masks[(t, number % 1000)] = coco_mask.decode(rle).astype(bool)
    return masks


def label_studio_results(clip, name):
    tasks = clip.json(name)
    assert [task["data"]["image"] for task in tasks] == clip.files
    for t, task in enumerate(tasks):
        for result in task["predictions"][0]["result"]:
            assert (result["original_height"], result["original_width"]) == clip.shape
            yield t, int(result["id"].split("-")[1]), result["value"]


def label_studio(clip):
    masks = {}
    for t, thing, value in label_studio_results(clip, "label-studio.json"):
        clip.check_class(thing, value["brushlabels"][0])
        masks[(t, thing)] = brush.decode_rle(value["rle"]).reshape(*clip.shape, 4)[:, :, 3] > 0
    return masks


def label_studio_polygons(clip):
    pairs = []
    for t, thing, value in label_studio_results(clip, "label-studio-polygon.json"):
        ring = (np.array(value["points"]) / 100 * clip.shape[::-1]).ravel().tolist()
        pairs.append(((t, thing), rasterised([ring], clip.shape)))
    return united(pairs)


def yolo(clip):
    names = clip.text("yolo", "names.txt").splitlines()
    pairs = []
    for t, name in enumerate(clip.names):
        for line in clip.text("yolo", "labels", f"{name}.txt").splitlines():
            index, *shares = line.split(" ")
            ring = (np.array(shares, float).reshape(-1, 2) * clip.shape[::-1]).ravel().tolist()
            pairs.append(((t, names[int(index)]), rasterised([ring], clip.shape)))
    return united(pairs)


def davis(clip):
    sequence = clip.text("davis", "ImageSets", "2017", "val.txt").strip()
    found = {}
    for t, name in enumerate(clip.names):
        indices = np.array(Image.open(clip.path("davis", "Annotations", "480p", sequence, f"{name}.png")))
        assert ((indices == 255) == (clip.labels[t] == 255)).all(), "void"
        found.update({(t, int(k)): indices == k for k in np.unique(indices) if 0 < k < 255})
    return found


def masks(clip):
    found = {}
    for place in clip.path("masks").glob("*/*.png"):
        grey = np.array(Image.open(place))
        assert set(np.unique(grey)) <= {0, 255}
        found[(clip.names.index(place.stem), int(place.parent.name))] = grey == 255
    return found


report(
    {
        "coco": (lambda clip: coco(clip, "coco.json"), lambda clip: clip.masks),
        "coco-polygon": (lambda clip: coco(clip, "coco-polygon.json"), lambda clip: clip.masks),
        "coco, read by datumaro": (lambda clip: coco_datumaro(clip, "coco"), lambda clip: clip.masks),
        "coco-polygon, read by datumaro": (lambda clip: coco_datumaro(clip, "coco-polygon"), lambda clip: clip.masks),
        "youtube-vis": (youtube_vis, lambda clip: clip.masks),
        "cvat": (cvat_masks, Clip.in_order),
        "cvat-polygon": (cvat_polygons, Clip.by_class),
        "cvat-video, polygons": (cvat_video, lambda clip: clip.masks),
        "cvat-video, boxes": (cvat_boxes, Clip.boxes),
        "mots": (mots, lambda clip: clip.masks),
        "label-studio": (label_studio, lambda clip: clip.masks),
        "label-studio-polygon": (label_studio_polygons, lambda clip: clip.masks),
        "yolo": (yolo, Clip.by_class),
        "davis": (davis, lambda clip: clip.masks),
        "masks": (masks, lambda clip: clip.masks),
    }
)
