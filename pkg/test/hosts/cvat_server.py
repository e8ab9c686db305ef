"""The part of CVAT that a task of one job needs: CVAT's REST interface in the words of its own SDK.

cvat_server.py FRAMES prints its port. The real SDK 2.80.0, which asks, checks both with its models, made of the schema of CVAT's interface
(cvat/schema.yml of that version). Requests that CVAT's page cannot open are refused here. As in CVAT (cvat/apps/dataset_manager/task.py), what is
updated is deleted and created again, with other ids, which the answer has.

Beside it, for the test: GET /test/log gives the actions that changed tracks, and the groups of those;
after POST /test/break the next change is made and not answered.
"""

import itertools
import json
import re
import sys
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

from PIL import Image

TASK = 42
TOKEN = "personal-token"
LABELS = [(7, "thing", "polygon"), (8, "frame", "rectangle"), (9, "other", "any")]
FILES = sorted(Path(sys.argv[1]).iterdir())
SIZE = Image.open(FILES[0]).size
WHEN = "2026-01-01T00:00:00Z"
USER_MODEL = {"url": "http://localhost/api/users/1", "id": 1, "username": "annotator", "first_name": "", "last_name": ""}

ids = itertools.count(1)
tracks = {}
log = []
breaks = []


class Broken(Exception):
    """The connection breaks off."""


class Refused(Exception):
    def __init__(self, status, reason):
        super().__init__(reason)
        self.status = status


def task():
    return {
        "url": f"http://localhost/api/tasks/{TASK}", "id": TASK, "name": "clip", "project_id": None, "mode": "annotation", "owner": USER_MODEL,
        "assignee": None, "bug_tracker": "", "created_date": WHEN, "updated_date": WHEN, "overlap": 0, "segment_size": len(FILES),
        "status": "annotation", "data_chunk_size": 72, "data_compressed_chunk_type": "imageset", "guide_id": None, "data_original_chunk_type": "imageset",
        "size": len(FILES), "image_quality": 70, "data": 1, "dimension": "2d", "subset": "", "organization_id": None, "organization": None,
        "target_storage": None, "source_storage": None, "assignee_updated_date": None, "validation_mode": None, "initial_replicas": 0, "project_name": None, "data_cloud_storage_id": None,
        "jobs": {"url": "", "count": 1, "completed": 0, "validation": 0}, "labels": {"url": f"http://localhost/api/labels?task_id={TASK}"},
    }


def labels():
    of = {"attributes": [], "color": "#ff0000", "sublabels": [], "task_id": TASK, "has_parent": False}
    return {"count": len(LABELS), "next": None, "previous": None, "results": [{**of, "id": number, "name": name, "type": kind} for number, name, kind in LABELS]}


def meta():
    frames = [{"width": SIZE[0], "height": SIZE[1], "name": file.name, "related_files": 0, "has_related_context": False} for file in FILES]
    return {
        "chunk_size": 72, "size": len(FILES), "image_quality": 70, "start_frame": 0, "stop_frame": len(FILES) - 1, "frame_filter": "",
        "frames": frames, "chunks_updated_date": WHEN, "deleted_frames": [], "included_frames": None, "storage": "local", "cloud_storage_id": None,
    }


def annotations():
    return labelled(tracks.values())


def labelled(found):
    return {"version": 0, "tags": [], "shapes": [], "tracks": list(found), "intervals": []}


def checked(data):
    """Throws unless CVAT's page can show it."""
    if data.get("tags") or data.get("shapes"):
        raise Refused(400, "nothing but tracks is expected")
    kinds = {number: kind for number, _, kind in LABELS}
    for track in data["tracks"]:
        frames = [shape["frame"] for shape in track["shapes"]]
        if track["label_id"] not in kinds or frames != sorted(set(frames)) or track["frame"] != frames[0]:
            raise Refused(400, "a track has a label of the task, and a shape for each of its frames, in order, from its own")
        for shape in track["shapes"]:
            check_shape(shape, kinds[track["label_id"]])
    return data["tracks"]


def check_shape(shape, kind):
    if shape["type"] not in ("rectangle", "polygon") or kind not in (shape["type"], "any"):
        raise Refused(400, f"a track of a label for '{kind}' has no {shape['type']}")
    x, y = shape["points"][::2], shape["points"][1::2]
    if len(x) != len(y) or len(x) < (3 if shape["type"] == "polygon" else 2):
        raise Refused(400, "too few points")
    if min(x + y) < 0 or max(x) > SIZE[0] or max(y) > SIZE[1] or not 0 <= shape["frame"] < len(FILES):
        raise Refused(400, "a shape is not in the task")


def patch(action, data):
    wanted = checked(data)
    if action not in ("create", "update", "delete"):
        raise Refused(400, "there is no such action")
    if action != "create":
        for track in wanted:
            if tracks.pop(track.get("id"), None) is None:
                raise Refused(400, f"there is no track {track.get('id')}")
    log.append({"action": action, "groups": [track.get("group") for track in wanted]})
    answer = labelled(wanted if action == "delete" else [created(track) for track in wanted])
    if breaks:
        raise breaks.pop()
    return answer


def created(track):
    number = next(ids)
    shapes = [{**shape, "id": next(ids), "points": [round(value, 2) for value in shape["points"]]} for shape in track["shapes"]]
    tracks[number] = {**track, "id": number, "shapes": shapes, "elements": []}
    return tracks[number]


class Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def log_message(self, *_):
        pass

    def answer(self):
        url = urlsplit(self.path)
        query = {name: values[0] for name, values in parse_qs(url.query).items()}
        body = self.rfile.read(int(self.headers.get("Content-Length") or 0))
        try:
            content = self.found(f"{self.command} {url.path.rstrip('/')}", query, body)
            self.send(200, content)
        except Refused as refused:
            self.send(refused.status, {"detail": str(refused)})
        except Broken:
            self.close_connection = True

    do_GET = do_PATCH = do_POST = answer

    def found(self, route, query, body):
        if route == "GET /api/server/about":
            return {"name": "CVAT", "description": "", "version": "2.80.0", "logo_url": "", "subtitle": ""}
        if route == "GET /test/log":
            return log
        if route == "POST /test/break":
            breaks.append(Broken())
            return {}
        if self.headers.get("Authorization") != f"Bearer {TOKEN}":
            raise Refused(401, "Authentication credentials were not provided.")
        if route == "GET /api/users/self":
            return USER_MODEL
        if route == "GET /api/labels":
            return labels()
        if (match := re.fullmatch(r"(\w+) /api/tasks/(\d+)(.*)", route)) and int(match[2]) == TASK:
            return self.of_task(match[1] + match[3], query, body)
        raise Refused(404, f"Not found: {route}")

    def of_task(self, route, query, body):
        if route == "GET":
            return task()
        if route == "GET/data/meta":
            return meta()
        if route == "GET/data" and query.get("type") == "frame" and query.get("quality") == "original":
            return FILES[int(query["number"])].read_bytes()
        if route == "GET/annotations":
            return annotations()
        if route == "PATCH/annotations":
            return patch(query.get("action"), json.loads(body))
        raise Refused(404, f"Not found: {route}")

    def send(self, status, content):
        raw = content if isinstance(content, bytes) else json.dumps(content).encode()
        self.send_response(status)
        self.send_header("Content-Type", "image/png" if isinstance(content, bytes) else "application/json")
        self.send_header("Content-Length", str(len(raw)))
        self.end_headers()
        self.wfile.write(raw)


server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
print(server.server_address[1], flush=True)
server.serve_forever()
