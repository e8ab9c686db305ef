"""The decoders of annotation tools: of large tools only the modules that decode, without what their packages import for servers and windows."""

import ast
import base64
import contextlib
import importlib.util
import io
import sys
import types
import uuid
import zlib
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
from datumaro.plugins.data_formats.mots import MotsPngExtractor  # noqa: E402
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


def rasterised(rings, shape):
    """Polygons as COCO's own code and datumaro fill them."""
    return coco_mask.decode(coco_mask.merge(coco_mask.frPyObjects(rings, *shape))).astype(bool)
