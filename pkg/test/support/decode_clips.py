"""Decodes what `veronese convert` wrote of clips with the tools' own decoders, and compares with the labels.

decode_clips.py FOLDER: reads FOLDER/cases.json, prints {"format": {"clips", "shapes", "mistakes"}} as JSON.

Every decoder gives shapes by (frame, object): masks, or boxes as (left, top, width, height). Formats that do not say which object a shape
is are compared in the order of the objects, or class by class.
"""

import configparser
import json
import sys
import types
import zipfile
from collections import defaultdict
from pathlib import Path

# TrackEval imports a solver for its matching, which is not installed: reading needs none.
sys.modules["scipy"] = types.ModuleType("scipy")
sys.modules["scipy.optimize"] = types.ModuleType("scipy.optimize")
sys.modules["scipy.optimize"].linear_sum_assignment = None

import numpy as np
from PIL import Image

import decode
from decode import COCO, CvatBase, MotsPngExtractor, brush, coco_mask, decode_mask, img_b64_to_arr, placed, rasterised, shapes_to_label, sly_decode

decode.bare("trackeval", "trackeval.datasets")

from datumaro.plugins.data_formats.mot import MotSeqBase  # noqa: E402
from label_studio_sdk._extensions.label_studio_tools.postprocessing.video import extract_key_frames  # noqa: E402
from trackeval.datasets.davis import DAVIS  # noqa: E402
from trackeval.datasets.mot_challenge_2d_box import MotChallenge2DBox  # noqa: E402
from trackeval.datasets.mots_challenge import MOTSChallenge  # noqa: E402


class Clip:
    """The converted clip, and what should be found."""

    def __init__(self, case, folder):
        self.folder = folder / case["out"]
        self.name = case["name"]
        self.tracks = case["tracks"]
        self.shape = (self.tracks["height"], self.tracks["width"])
        self.files = self.tracks["files"]
        self.names = self.tracks["frames"]
        self.labels = [np.frombuffer(decode.base64.b64decode(frame), np.uint8).reshape(self.shape) for frame in case["labels"]]
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


def coco(clip, name):
    with decode.contextlib.redirect_stdout(decode.io.StringIO()):
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


def with_images(clip):
    """CVAT's images have to be there: empty ones."""
    (clip.folder / "images").mkdir(exist_ok=True)
    for name in clip.files:
        Image.new("L", clip.shape[::-1]).save(clip.folder / "images" / name)


def cvat(clip, name):
    with_images(clip)
    data = CvatBase(str(clip.path(name)))
    names = [label.name for label in list(data.categories().values())[0].items]
    for item in data:
        t = item.attributes["frame"]
        assert item.id == clip.names[t]
        for annotation in item.annotations:
            yield t, names[annotation.label], annotation


def cvat_masks(clip):
    return counted((t, a.image.astype(bool)) for t, _, a in cvat(clip, "cvat.xml"))


def cvat_polygons(clip):
    return united(((t, name), rasterised([a.points], clip.shape)) for t, name, a in cvat(clip, "cvat-polygon.xml"))


def cvat_tracks(clip, name):
    """The shapes that are not outside. Those that are mark where a track leaves: once, in the frame after its last one."""
    data = CvatBase(str(clip.path(name)))
    names = [label.name for label in list(data.categories().values())[0].items]
    shapes, left = {}, set()
    for item in data:
        t = item.attributes["frame"]
        assert item.id == f"frame_{t:06}"
        for annotation in item.annotations:
            thing = annotation.attributes["track_id"]
            clip.check_class(thing, names[annotation.label])
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


def cvat_points(clip):
    shapes = clip.json("cvat-points.json")
    return counted((s["frame"], decode_mask(s["points"], image_width=clip.shape[1], image_height=clip.shape[0])) for s in shapes)


def cvat_mots(clip):
    with zipfile.ZipFile(clip.path("cvat-mots.zip")) as files:
        files.extractall(clip.path("unzipped"))
    data = MotsPngExtractor(str(clip.path("unzipped", "default")), subset="default")
    names = [label.name for label in list(data.categories().values())[0].items]
    masks = {}
    for item in data:
        for annotation in item.annotations:
            thing = int(annotation.attributes["track_id"])
            clip.check_class(thing, names[annotation.label])
            masks[(clip.names.index(item.id), thing)] = np.asarray(annotation.image).astype(bool)
    return masks


def track_eval(reader_class, clip, sequence):
    """TrackEval's reader of a folder, without a tracker to judge."""
    reader = reader_class.__new__(reader_class)
    reader.data_is_zipped = False
    reader.gt_fol = str(clip.folder)
    reader.config = {"SEQ_INFO": {sequence: None}, "GT_LOC_FORMAT": "{gt_folder}/{seq}/gt/gt.txt"}
    _, reader.seq_lengths = reader._get_seq_info()
    assert reader.seq_lengths[sequence] == len(clip.files)
    info = configparser.ConfigParser()
    info.read(clip.path(sequence, "seqinfo.ini"))
    size = info["Sequence"]
    assert (int(size["imHeight"]), int(size["imWidth"]), size["name"], size["imExt"]) == (*clip.shape, clip.name, ".jpg")
    return reader._load_raw_file(None, sequence, True)


def classes_of(clip, folder):
    return clip.text(folder, "gt", "labels.txt").splitlines()


def mots(clip):
    data = track_eval(MOTSChallenge, clip, "mots")
    names = classes_of(clip, "mots")
    masks = {}
    for t in range(data["num_timesteps"]):
        for number, kind, rle in zip(data["gt_ids"][t], data["gt_classes"][t], data["gt_dets"][t]):
            assert number // 1000 == kind
            clip.check_class(number % 1000, names[kind - 1])
            masks[(t, number % 1000)] = coco_mask.decode(rle).astype(bool)
    return masks


def mot(clip):
    """The benchmark counts pixels from 1."""
    data = track_eval(MotChallenge2DBox, clip, "mot")
    names = classes_of(clip, "mot")
    boxes = {}
    for t in range(data["num_timesteps"]):
        assert (data["gt_extras"][t]["zero_marked"] == 1).all()
        for number, kind, (left, top, width, height) in zip(data["gt_ids"][t], data["gt_classes"][t], data["gt_dets"][t]):
            clip.check_class(number, names[kind - 1])
            boxes[(t, int(number))] = (left - 1, top - 1, width, height)
    return boxes


def mot_datumaro(clip):
    boxes = {}
    data = MotSeqBase(str(clip.path("mot", "gt", "gt.txt")))
    names = [label.name for label in list(data.categories().values())[0].items]
    for item in data:
        for a in item.annotations:
            clip.check_class(a.attributes["track_id"], names[a.label])
            assert not a.attributes["ignored"] and not a.attributes["occluded"]
            boxes[(int(item.id) - 1, a.attributes["track_id"])] = (a.x - 1, a.y - 1, a.w, a.h)
    return boxes


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


def label_studio_video(clip):
    """Every frame that the tool shows a box in: key frames, and those that it puts between two of them."""
    (task,) = clip.json("label-studio-video.json")
    boxes = {}
    for result in extract_key_frames(task["predictions"][0]["result"]):
        thing = int(result["id"].split("-")[1])
        clip.check_class(thing, result["value"]["labels"][0])
        assert result["value"]["framesCount"] == len(clip.files)
        for box in result["value"]["sequence"]:
            (height, width) = clip.shape
            share = [box["x"] * width, box["y"] * height, box["width"] * width, box["height"] * height]
            boxes[(box["frame"] - 1, thing)] = tuple(np.round(np.array(share) / 100, 9))
    return boxes


def labelme(clip):
    masks = {}
    for t, name in enumerate(clip.names):
        document = clip.json("labelme", f"{name}.json")
        assert document["imagePath"] == clip.files[t]
        for s in document["shapes"]:
            clip.check_class(s["group_id"], s["label"])
            _, instances = shapes_to_label(clip.shape, [{**s, "mask": img_b64_to_arr(s["mask"]).astype(bool)}], {s["label"]: 1})
            masks[(t, s["group_id"])] = instances > 0
    return masks


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
    reader = DAVIS.__new__(DAVIS)
    reader.gt_fol = str(clip.path("davis", "Annotations", "480p"))
    sequence = clip.text("davis", "ImageSets", "2017", "val.txt").strip()
    reader.seq_lengths = {sequence: len(clip.files)}
    data = reader._load_raw_file(None, sequence, True)
    masks = {}
    for t in range(data["num_timesteps"]):
        assert (coco_mask.decode(data["masks_void"][t]).astype(bool) == (clip.labels[t] == 255)).all(), "void"
        for thing, rle in zip(data["gt_ids"][t], data["gt_dets"][t]):
            masks[(t, int(thing))] = coco_mask.decode(rle).astype(bool)
    return masks


def supervisely(clip):
    pairs = []
    for t, file in enumerate(clip.files):
        for thing in clip.json("supervisely", "ann", f"{file}.json")["objects"]:
            left, top = thing["bitmap"]["origin"]
            pairs.append((t, placed(sly_decode(thing["bitmap"]["data"]), left, top, clip.shape)))
    return counted(pairs)


def masks(clip):
    found = {}
    for place in clip.path("masks").glob("*/*.png"):
        grey = np.array(Image.open(place))
        assert set(np.unique(grey)) <= {0, 255}
        found[(clip.names.index(place.stem), int(place.parent.name))] = grey == 255
    return found


# The decoder, and the clip's own view of what it should find.
DECODERS = {
    "coco": (lambda clip: coco(clip, "coco.json"), lambda clip: clip.masks),
    "coco-polygon": (lambda clip: coco(clip, "coco-polygon.json"), lambda clip: clip.masks),
    "youtube-vis": (youtube_vis, lambda clip: clip.masks),
    "cvat": (cvat_masks, Clip.in_order),
    "cvat-polygon": (cvat_polygons, Clip.by_class),
    "cvat-video, polygons": (cvat_video, lambda clip: clip.masks),
    "cvat-video, boxes": (cvat_boxes, Clip.boxes),
    "cvat-points": (cvat_points, Clip.in_order),
    "cvat-mots": (cvat_mots, lambda clip: clip.masks),
    "mots": (mots, lambda clip: clip.masks),
    "mot": (mot, Clip.boxes),
    "mot, read by datumaro": (mot_datumaro, Clip.boxes),
    "label-studio": (label_studio, lambda clip: clip.masks),
    "label-studio-polygon": (label_studio_polygons, lambda clip: clip.masks),
    "label-studio-video": (label_studio_video, Clip.boxes),
    "labelme": (labelme, lambda clip: clip.masks),
    "yolo": (yolo, Clip.by_class),
    "davis": (davis, lambda clip: clip.masks),
    "supervisely": (supervisely, Clip.in_order),
    "masks": (masks, lambda clip: clip.masks),
}


def main(folder):
    clips = [Clip(case, folder) for case in json.loads((folder / "cases.json").read_text())]
    report = {}
    for name, (decoder, truth) in DECODERS.items():
        shapes, mistakes = 0, []
        for index, clip in enumerate(clips):
            try:
                found, expected = decoder(clip), truth(clip)
                if found.keys() != expected.keys():
                    mistakes.append(f"clip {index}: {sorted(found)}, not {sorted(expected)}")
                for key in found.keys() & expected.keys():
                    shapes += 1
                    if not np.array_equal(found[key], expected[key]):
                        mistakes.append(f"clip {index}, {key}: not the same")
            except Exception as error:
                mistakes.append(f"clip {index}: {error!r}")
        report[name] = {"clips": len(clips), "shapes": shapes, "mistakes": mistakes[:5]}
    json.dump(report, sys.stdout)


main(Path(sys.argv[1]))
