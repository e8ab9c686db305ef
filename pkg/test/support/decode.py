"""The decoders of annotation tools: of large tools only the modules that decode, without what their packages import for servers and windows."""

import ast
import base64
import contextlib
import importlib.util
import io
import os
import sys
import types
import uuid
import zlib
from pathlib import Path

import cv2
import numpy as np
import PIL.Image
from PIL import Image
from pycocotools.coco import COCO


def bare(*names):
    """Packages whose __init__ is not run."""
    for name in names:
        module = types.ModuleType(name)
        module.__path__ = list(importlib.util.find_spec(name).submodule_search_locations)
        sys.modules[name] = module


bare("label_studio_sdk")
bare("label_studio_sdk.converter")

from label_studio_sdk.converter import brush  # noqa: E402


def taken(package, place, *wanted, **given):
    """Functions and constants of an installed file that cannot be imported without servers, windows or much else; `given` is what they use."""
    file = Path(importlib.util.find_spec(package).submodule_search_locations[0], *place)
    names = {"np": np, "cv2": cv2, "zlib": zlib, "base64": base64, "io": io, "os": os, "Image": Image, "PIL": PIL, "uuid": uuid, **given}
    found = {}
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.FunctionDef):
            node.decorator_list = []
            node.returns = None
            for argument in node.args.args:
                argument.annotation = None
            found.setdefault(node.name, node)
        elif isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            found.setdefault(node.targets[0].id, node)
    exec(compile(ast.Module([found[name] for name in wanted], []), str(file), "exec"), names)
    return [names[name] for name in wanted]


# Of Ultralytics what it does between a file and the masks of a batch; its functions take tensors too, and there are none.
NO_TENSORS = types.SimpleNamespace(Tensor=())
segments2boxes, resample_segments, *_ = taken("ultralytics", ["utils", "ops.py"], "segments2boxes", "resample_segments", "xyxy2xywh", "empty_like", torch=NO_TENSORS)
verify_image_label, polygon2mask, img2label_paths, *_ = taken(
    "ultralytics", ["data", "utils.py"], "verify_image_label", "polygon2mask", "img2label_paths", "check_image", "exif_size", "IMG_FORMATS", segments2boxes=segments2boxes
)
