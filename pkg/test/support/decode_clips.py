"""Decodes what `veronese convert` wrote of clips with the tools' own decoders, and compares with the labels: decode_clips.py FOLDER."""

import configparser
import shutil
import sys
import types
import zipfile

# TrackEval imports a solver for its matching, which is not installed: reading needs none.
sys.modules["scipy"] = types.ModuleType("scipy")
sys.modules["scipy.optimize"] = types.ModuleType("scipy.optimize")
sys.modules["scipy.optimize"].linear_sum_assignment = None

import numpy as np
import yaml
from PIL import Image

import decode
from clips import Clip, coco_mask, counted, rasterised, report, united
from decode import COCO, brush

decode.bare("trackeval", "trackeval.datasets")

from datumaro import AnnotationType, Dataset  # noqa: E402
from label_studio_sdk._extensions.label_studio_tools.postprocessing.video import extract_key_frames  # noqa: E402
from trackeval.datasets.davis import DAVIS  # noqa: E402
from trackeval.datasets.mots_challenge import MOTSChallenge  # noqa: E402


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


def cvat_mots(clip):
    with zipfile.ZipFile(clip.path("cvat-mots.zip")) as files:
        files.extractall(clip.path("unzipped"))
    masks = {}
    for item, kind, annotation in datumaro(clip.path("unzipped"), "mots"):
        thing = int(annotation.attributes["track_id"])
        clip.check_class(thing, kind)
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


def yolo(clip):
    names = clip.text("yolo", "names.txt").splitlines()
    pairs = []
    for t, name in enumerate(clip.names):
        for line in clip.text("yolo", "labels", f"{name}.txt").splitlines():
            index, *shares = line.split(" ")
            ring = (np.array(shares, float).reshape(-1, 2) * clip.shape[::-1]).ravel().tolist()
            pairs.append(((t, names[int(index)]), rasterised([ring], clip.shape)))
    return united(pairs)


def yolo_ultralytics(clip):
    """Of frames that are large enough: a line of one pixel from part to part is nothing in these, and below ten pixels nothing is read."""
    if min(clip.shape) < 100:
        return None
    clip.images("yolo", "images")
    data = yaml.safe_load(clip.text("yolo", "data.yaml"))
    images = sorted(str(place) for place in clip.path("yolo", data["val"]).iterdir())
    pairs = []
    for t, (image, file) in enumerate(zip(images, decode.img2label_paths(images))):
        _, rows, shape, rings, _, missing, _, _, _, problem = decode.verify_image_label((image, file, "", False, len(data["names"]), 0, 0, False))
        assert (shape, missing, problem) == (clip.shape, 0, "")
        for row, ring in zip(rows, decode.resample_segments(rings)):
            pairs.append(((t, data["names"][int(row[0])]), decode.polygon2mask(shape, [ring * shape[::-1]]) > 0))
    assert len(images) == len(clip.files)
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


def masks(clip):
    found = {}
    for place in clip.path("masks").glob("*/*.png"):
        grey = np.array(Image.open(place))
        assert set(np.unique(grey)) <= {0, 255}
        found[(clip.names.index(place.stem), int(place.parent.name))] = grey == 255
    return found


# The decoder, the clip's own view of what it should find, and by how much of it at least, if not all.
DECODERS = {
    "coco": (lambda clip: coco(clip, "coco.json"), lambda clip: clip.masks),
    "coco-polygon": (lambda clip: coco(clip, "coco-polygon.json"), lambda clip: clip.masks),
    "coco, read by datumaro": (lambda clip: coco_datumaro(clip, "coco"), lambda clip: clip.masks),
    "coco-polygon, read by datumaro": (lambda clip: coco_datumaro(clip, "coco-polygon"), lambda clip: clip.masks),
    "youtube-vis": (youtube_vis, lambda clip: clip.masks),
    "cvat": (cvat_masks, Clip.in_order),
    "cvat-polygon": (cvat_polygons, Clip.by_class),
    "cvat-video, polygons": (cvat_video, lambda clip: clip.masks),
    "cvat-video, boxes": (cvat_boxes, Clip.boxes),
    "cvat-mots": (cvat_mots, lambda clip: clip.masks),
    "mots": (mots, lambda clip: clip.masks),
    "label-studio": (label_studio, lambda clip: clip.masks),
    "label-studio-polygon": (label_studio_polygons, lambda clip: clip.masks),
    "label-studio-video": (label_studio_video, Clip.boxes),
    "yolo": (yolo, Clip.by_class),
    "yolo, read by ultralytics": (yolo_ultralytics, Clip.by_class, 0.99),
    "davis": (davis, lambda clip: clip.masks),
    "masks": (masks, lambda clip: clip.masks),
}


report(DECODERS)
