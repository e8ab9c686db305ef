"""Reads what `veronese convert` wrote of clips as FiftyOne imports it, and compares with the labels: read_fiftyone.py FOLDER.

Its importers are what `Dataset.from_dir` calls; a data set itself would need a server of MongoDB.
"""

import os

os.environ["FIFTYONE_DO_NOT_TRACK"] = "true"

import fiftyone.utils.coco as coco
import fiftyone.utils.cvat as cvat
import fiftyone.utils.data as data
import fiftyone.utils.yolo as yolo
import numpy as np
from clips import Clip, placed, rasterised, report, united


def imported(clip, importer):
    """Each sample, of all frames, with the number of its frame."""
    with importer:
        assert len(importer) == len(clip.files)
        for place, *_, labels in importer:
            yield clip.files.index(os.path.basename(place)), labels


def filled(clip, rings):
    """A polyline as it is kept: FiftyOne's own way to draw one goes half a pixel beyond."""
    return rasterised([(np.array(ring) * clip.shape[::-1]).ravel().tolist() for ring in rings], clip.shape)


def coco_masks(clip, name):
    clip.images("images")
    masks = {}
    importer = coco.COCODetectionDatasetImporter(data_path=str(clip.path("images")), labels_path=str(clip.path(name)), label_types="segmentations")
    for t, labels in imported(clip, importer):
        for thing in labels.detections if labels else []:
            clip.check_class(thing["track_id"], thing.label)
            left, top = (round(share * side) for share, side in zip(thing.bounding_box, clip.shape[::-1]))
            masks[(t, thing["track_id"])] = placed(thing.get_mask(), left, top, clip.shape)
    return masks


def cvat_polygons(clip):
    clip.images("images")
    importer = cvat.CVATImageDatasetImporter(data_path=str(clip.path("images")), labels_path=str(clip.path("cvat-polygon.xml")))
    shapes = ((t, thing) for t, labels in imported(clip, importer) if "polylines" in labels for thing in labels["polylines"].polylines)
    return united(((t, thing.label), filled(clip, thing.points)) for t, thing in shapes)


def cvat_video(clip):
    """The importer looks for a folder of such files, one for each video, and does not open the videos."""
    place = clip.path("labels", "clip.xml")
    place.parent.mkdir()
    place.write_bytes(clip.path("cvat-video.xml").read_bytes())
    masks = {}
    with cvat.CVATVideoDatasetImporter(data_path={"clip": "clip.mp4"}, labels_path=str(place.parent)) as importer:
        ((*_, frames),) = importer
    for number, labels in frames.items():
        for thing in labels["polylines"].polylines:
            clip.check_class(int(thing.index), thing.label)
            masks[(number - 1, int(thing.index))] = filled(clip, thing.points)
    return masks


def yolo_polygons(clip):
    clip.images("yolo", "images")
    importer = yolo.YOLOv5DatasetImporter(yaml_path=str(clip.path("yolo", "data.yaml")), label_type="polylines")
    return united(((t, thing.label), filled(clip, thing.points)) for t, labels in imported(clip, importer) for thing in labels.polylines)


def segmentations(clip):
    """Of each object a folder: of the frames that it is in."""
    clip.images("images")
    masks = {}
    for place in clip.path("masks").iterdir():
        with data.ImageSegmentationDirectoryImporter(data_path=str(clip.path("images")), labels_path=str(place)) as importer:
            for image, _, mask in importer:
                masks[(clip.files.index(os.path.basename(image)), int(place.name))] = mask.get_mask() == 255
    return masks


report(
    {
        "coco": (lambda clip: coco_masks(clip, "coco.json"), lambda clip: clip.masks),
        "coco-polygon": (lambda clip: coco_masks(clip, "coco-polygon.json"), lambda clip: clip.masks),
        "cvat-polygon": (cvat_polygons, Clip.by_class),
        "cvat-video": (cvat_video, lambda clip: clip.masks),
        "yolo": (yolo_polygons, Clip.by_class),
        "masks": (segmentations, lambda clip: clip.masks),
    }
)
