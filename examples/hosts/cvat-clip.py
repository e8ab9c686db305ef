"""A clip in CVAT: its objects become tracks, and what a person changes in them goes on to the other frames.

python cvat-clip.py annotate TASK --out DIR [--label NAME]
python cvat-clip.py correct TASK --out DIR [--propagate both|forward|backward|none]

Server and credentials are given as to CVAT's own command line: --server-host and the like, CVAT_ACCESS_TOKEN. See cvat.md.
"""

import argparse
import io
import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import cvat_sdk
import cvat_tracks
from cvat_sdk import models
from cvat_sdk.api_client.exceptions import ApiException, OpenApiException
from cvat_sdk.core.exceptions import CvatSdkException
from cvat_sdk.core.proxies.annotations import AnnotationUpdateAction
from PIL import Image
from urllib3.exceptions import HTTPError

# The most that is taken of a task: the limits of the servers beside this program.
FRAMES = 3000
PIXELS = 4096 * 2304
BYTES = 64 * 1024 * 1024
# The label of a pixel that is left open.
SILENT = 255


class Refusal(Exception):
    def __init__(self, code, sentence):
        super().__init__(f"{code}: {sentence}")


class Work:
    """The folder of a task: its frames, the clip, its corrections, and what CVAT held when this program last looked."""

    def __init__(self, folder, task):
        self.folder = Path(folder)
        self.frames, self.clip, self.said = (self.folder / name for name in ("frames", "clip", "corrections"))
        self.file = self.folder / "cvat.json"
        self.held = json.loads(self.file.read_text(encoding="utf-8")) if self.file.exists() else None
        if self.held and self.held["task"] != task:
            raise Refusal("wrong-folder", f"'{folder}' is of task {self.held['task']}, not {task}")

    def objects(self):
        return by_frame(self.held["objects"])

    def drawn(self):
        return {int(number): set(frames) for number, frames in self.held["drawn"].items()}

    def sending(self):
        """The content of an upload to CVAT; None where none has begun, or the last one has ended."""
        plan = self.held and self.held.get("sending")
        if plan is None:
            return None
        objects, drawn, tracks = ({int(number): value for number, value in plan[name].items()} for name in ("objects", "drawn", "tracks"))
        return by_frame(objects), {number: set(where) for number, where in drawn.items()}, tracks

    def begin(self, task, frames, label, objects, drawn, tracks):
        """Notes what is about to be sent, and the ids of the tracks that are there, so that another run can end what breaks off."""
        held = self.held or {"objects": {}, "drawn": {}, "numbers": []}
        sending = {"objects": objects, "drawn": sorted_values(drawn), "tracks": tracks}
        self.write({**held, "task": task, "frames": frames, "label": label, "sending": sending})

    def hold(self, objects, drawn):
        """Notes what CVAT holds. `numbers` are all that objects ever had: a new object gets another."""
        numbers = sorted({*objects, *self.held["numbers"]})
        kept = {name: self.held[name] for name in ("task", "frames", "label")}
        self.write({**kept, "objects": objects, "drawn": sorted_values(drawn), "numbers": numbers})

    def write(self, content):
        """As a whole or not at all."""
        draft = self.file.with_suffix(".new")
        draft.write_text(json.dumps(content), encoding="utf-8")
        draft.replace(self.file)
        self.held = json.loads(json.dumps(content))


def by_frame(objects):
    """With the numbers that JSON made words."""
    return {int(number): {int(frame): polygons for frame, polygons in said.items()} for number, said in objects.items()}


def sorted_values(sets):
    return {key: sorted(values) for key, values in sets.items()}


def main():
    options = arguments()
    try:
        work = Work(options.out, options.task)
        # The credentials are sent to this server alone: a redirect to another does not get them.
        with cvat_sdk.make_client_from_cli(options) as client:
            run = {"annotate": annotate, "correct": correct}[options.command]
            print(json.dumps(run(client.tasks.retrieve(options.task), work, options)))
    except Refusal as refusal:
        sys.exit(f"cvat-clip: error: {refusal}")
    except ApiException as error:
        sys.exit(f"cvat-clip: error: cvat-answered: CVAT answered {error.status}: {one_line(error.body or error.reason)}")
    except OpenApiException as error:
        sys.exit(f"cvat-clip: error: cvat-answered: CVAT answered what this version of its SDK does not know: {one_line(error)}")
    except (CvatSdkException, HTTPError) as error:
        sys.exit(f"cvat-clip: error: cvat-unreachable: {one_line(error)}")


def one_line(text):
    text = text.decode(errors="replace") if isinstance(text, bytes) else str(text)
    return " ".join(text.split())[:500]


def arguments():
    parser = argparse.ArgumentParser(prog="cvat-clip", description="Objects of a clip as tracks in CVAT, and back.")
    parser.add_argument("command", choices=["annotate", "correct"])
    parser.add_argument("task", type=int)
    parser.add_argument("--out", required=True, help="folder of the task: its frames, its masks, and what was said of them")
    parser.add_argument("--label", help="the task's label for objects")
    parser.add_argument("--quality", choices=["fast", "best"], default="best")
    parser.add_argument("--tolerance", type=float, default=0.5, help="of polygons, pixels")
    parser.add_argument("--propagate", choices=["both", "forward", "backward", "none"], default="both", help="where what a person drew spreads")
    parser.add_argument("--frames", type=int, default=FRAMES, help="most frames")
    parser.add_argument("--pixels", type=int, default=PIXELS, help="most pixels of a frame")
    parser.add_argument("--veronese", default=os.environ.get("VERONESE", "npx veronese"), help="the program, with its first arguments")
    cvat_sdk.configure_client_auth_arguments(parser)
    return parser.parse_args()


def annotate(task, work, options):
    """Frames of the task → clip → tracks."""
    if work.held and not work.sending():
        raise Refusal("annotated-already", f"the task has its tracks already: use 'correct', or another folder than '{options.out}'")
    if not work.held:
        label = label_of(task, options.label)
        if any(shape.type.value == cvat_tracks.POLYGON for track in task.get_annotations().tracks for shape in track.shapes):
            raise Refusal("task-not-empty", "the task has tracks of polygons already, which could not be told from those of this program")
        frames = download(task, work.frames, options)
        veronese(options, "clip", work.frames, "--out", work.clip, "--quality", options.quality)
        work.begin(task.id, frames, label, outlines(work, options, frames), {}, {})
    upload(task, work)
    return {"task": task.id, "frames": len(work.held["frames"]), "objects": len(work.held["objects"])}


def correct(task, work, options):
    """Tracks that a person changed → corrections → the clip again → tracks. Untouched tracks stay as they are."""
    if not work.held:
        raise Refusal("not-annotated", f"'{options.out}' has no clip of this task: use 'annotate' first")
    ended = upload(task, work) if work.sending() else 0
    frames, before, drawn = work.held["frames"], work.objects(), work.drawn()
    edits = edits_in(work.said)
    tracks = cvat_tracks.by_number(task.get_annotations().tracks, work.held["numbers"])
    now = {number: cvat_tracks.united(members, frames) for number, members in tracks.items()}
    changed = cvat_tracks.changes(before, now, frames)
    deleted = [number for number in before if number not in now]
    if not changed and not deleted:
        return {"task": task.id, "changed": 0, "deleted": 0, "tracks": ended}

    say(work, options, before, now, changed)
    touched = {*drawn, *changed} - {*deleted}
    for number, where in changed.items():
        drawn[number] = drawn.get(number, set()) | {*where}
    edits["delete"] = sorted({*edits["delete"], *deleted})
    edits["locked"] = sorted({*now} - touched)
    edits["propagate"].update({name_of(frame): options.propagate for where in changed.values() for frame in where})
    (work.said / "edits.json").write_text(json.dumps(edits), encoding="utf-8")
    veronese(options, "clip", work.frames, "--out", work.clip, "--quality", options.quality, "--corrections", work.said)

    found = as_drawn(outlines(work, options, frames), now, drawn)
    drawn = {number: where for number, where in drawn.items() if number in found}
    ids = {number: [track.id for track in members] for number, members in tracks.items()}
    work.begin(task.id, frames, work.held["label"], found, drawn, ids)
    sent = upload(task, work)
    return {"task": task.id, "changed": len(changed), "deleted": len(deleted), "tracks": ended + sent}


def upload(task, work):
    """
    Sends what is to be sent, as far as CVAT does not have it yet, so that a run that broke off can be ended by another. What a person has
    changed since it was noted is left as it is: to the next 'correct' it is a change like others. Returns how many tracks were sent.

    CVAT gives a track another id each time that it is saved: one whose id was noted is as it was then.
    """
    objects, drawn, noted = work.sending()
    frames = work.held["frames"]
    noted_ids = {track for ids in noted.values() for track in ids}
    there = cvat_tracks.of_polygons(task.get_annotations().tracks)
    updated, created, lost, others = [], [], [], set()
    for number in sorted({*objects, *noted}):
        said, ids = objects.get(number), noted.get(number, [])
        old = [track for track in there if track.id in ids]
        new = [track for track in there if track.group == number and track.id not in noted_ids]
        if said and len(new) == 1 and cvat_tracks.says(new, said, frames):
            lost += old
        elif new or (said and len(old) < len(ids)):
            others.add(number)
        elif not said:
            # An object can be lost by corrections of others.
            lost += old
        else:
            if not (len(old) == 1 and old[0].group == number and cvat_tracks.says(old, said, frames)):
                label = old[0].label_id if old else work.held["label"]
                track = cvat_tracks.track_of(number, said, frames, label=label, drawn=drawn.get(number, ()), old=old)
                (updated if old else created).append(track)
            # It may have been of several tracks.
            lost += old[1:]
    send(task, AnnotationUpdateAction.UPDATE, updated)
    send(task, AnnotationUpdateAction.CREATE, created)
    if lost:
        task.remove_annotations(ids=[track.id for track in lost])
    held = read_back(task, frames, {*objects} - others)
    work.hold({number: held.get(number, said) for number, said in objects.items()}, drawn)
    return len(updated) + len(created)


def as_drawn(found, now, drawn):
    """The outlines, in a person's frames as they were drawn: those of the labels would only be near that. A track has one polygon a frame."""
    for number, where in drawn.items():
        held = now.get(number, {})
        if number in found:
            found[number].update({frame: held[frame] for frame in where if frame in held and len(held[frame]) < 2})
    return {number: said for number, said in found.items() if any(said.values())}


def label_of(task, name):
    """The id of the label that objects get: the one that is named, or the only one that polygons can have."""
    labels = [label for label in task.get_labels() if str(label.type) in ("any", "polygon")]
    fitting = [label for label in labels if name is None or label.name == name]
    if len(fitting) == 1:
        return fitting[0].id
    names = ", ".join(f"'{label.name}'" for label in labels) or "none"
    raise Refusal("no-label", f"say by --label which label objects have; those of the task for polygons are: {names}")


def download(task, folder, options):
    """Writes the files of all frames that are not deleted; returns their numbers."""
    if 0 < task.segment_size < task.size:
        raise Refusal("several-jobs", "the task is cut into jobs, and an object would be cut with it: only tasks of one job are possible")
    if task.size > options.frames:
        raise Refusal("too-many-frames", f"the task has {task.size} frames: at most {options.frames} are taken (--frames)")
    meta = task.get_meta()
    for frame in meta.frames:
        check_size(frame.width, frame.height, options)
    frames = [frame for frame in range(task.size) if frame not in meta.deleted_frames]
    # A frame of an earlier run that has been deleted since would be one of the clip.
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    for frame in frames:
        content = task.get_frame(frame, quality="original").read(BYTES + 1)
        if len(content) > BYTES:
            raise Refusal("unreadable-file", f"frame {frame} has more than {BYTES} bytes")
        try:
            with Image.open(io.BytesIO(content)) as image:
                check_size(*image.size, options)
                # Pillow's name of a JPEG file with further pictures in it; the first one is taken.
                kind = {"MPO": "jpeg"}.get(image.format, image.format.lower())
        except (OSError, Image.DecompressionBombError) as error:
            raise Refusal("unreadable-file", f"frame {frame} is no image: {error}") from error
        # The very bytes: pixels that are compressed once more are others.
        (folder / f"{name_of(frame)}.{kind}").write_bytes(content)
    return frames


def check_size(width, height, options):
    if width * height > options.pixels:
        raise Refusal("frame-size-unsupported", f"a frame of {width}×{height} pixels is too large: at most {options.pixels} are taken (--pixels)")


def name_of(frame):
    return f"{frame:06d}"


def veronese(options, command, *arguments):
    """Runs the program; its messages go to the terminal."""
    # Backslashes of Windows are no escapes.
    name, *first = (word.strip('"') for word in shlex.split(options.veronese, posix=os.name != "nt"))
    program = shutil.which(name)
    if program is None:
        raise Refusal("no-program", f"there is no program '{name}': say by --veronese how veronese is started")
    # It needs no way into CVAT.
    environment = {key: value for key, value in os.environ.items() if key not in ("CVAT_ACCESS_TOKEN", "PASS")}
    ended = subprocess.run([program, *first, command, *map(str, arguments)], stdout=subprocess.DEVNULL, env=environment)
    if ended.returncode != 0:
        raise Refusal("veronese-failed", f"'veronese {command}' ended with {ended.returncode}; see above")


def outlines(work, options, frames):
    """The objects of the clip as polygons."""
    veronese(options, "convert", work.clip, "--to", "cvat-video", "--tolerance", options.tolerance, "--out", work.clip)
    taken = len(json.loads((work.clip / "tracks.json").read_text(encoding="utf-8"))["frames"])
    if taken != len(frames):
        raise Refusal("unreadable-file", f"{len(frames) - taken} of {len(frames)} frames are files of a kind that veronese does not read")
    return cvat_tracks.read_xml(work.clip / "cvat-video.xml", frames)


def edits_in(folder):
    """The earlier edits of whole objects, in a folder that is made if it is missing."""
    folder.mkdir(exist_ok=True)
    file = folder / "edits.json"
    return json.loads(file.read_text(encoding="utf-8")) if file.exists() else {"delete": [], "locked": [], "propagate": {}}


def say(work, options, before, now, changed):
    """Writes the frames in which something changed as corrections."""
    only = {frame for where in changed.values() for frame in where}
    tracks = json.loads((work.clip / "tracks.json").read_text(encoding="utf-8"))
    size = tracks["width"], tracks["height"]
    with tempfile.TemporaryDirectory() as folder:
        old, new = (drawn_masks(work, options, Path(folder) / name, objects, changed, size) for name, objects in (("before", before), ("now", now)))
    empty = bytes(size[0] * size[1])
    for frame in only:
        name = name_of(frame)
        with Image.open(work.clip / "labels" / f"{name}.png") as image:
            found = image.tobytes()
        touched = {number for number, where in changed.items() if frame in where}
        pixels = zip(old.get(name, empty), new.get(name, empty), found)
        said = bytes(certain(*pixel, touched) for pixel in pixels)
        Image.frombytes("L", size, said).save(work.said / f"{name}.png")


def certain(old, new, found, touched):
    """The label that is certain of a pixel, from the polygons before and now, and what was found: polygons may only be near to that."""
    if old != new or new in touched or found in touched:
        return new
    # Objects that nobody touched are left open: they would be followed anew.
    return 0 if found == 0 else SILENT


def drawn_masks(work, options, folder, objects, changed, size):
    """The labels of the frames that changed, as `veronese convert --to corrections` draws polygons; none of a frame without any."""
    folder.mkdir()
    cvat_tracks.write_xml(folder / "tracks.xml", objects, changed, work.held["frames"], size)
    if not any(said.get(frame) for said in objects.values() for where in changed.values() for frame in where):
        return {}
    veronese(options, "convert", folder / "tracks.xml", "--to", "corrections", "--clip", work.clip, "--out", folder / "labels")
    masks = {}
    for path in (folder / "labels").glob("*.png"):
        with Image.open(path) as image:
            masks[path.stem] = image.tobytes()
    return masks


def send(task, action, tracks):
    if tracks:
        task.update_annotations(models.PatchedLabeledDataRequest(tracks=tracks), action=action)


def read_back(task, frames, numbers):
    """These objects as CVAT holds them now: a person will change that."""
    tracks = cvat_tracks.by_number(task.get_annotations().tracks, {})
    return {number: cvat_tracks.united(tracks[number], frames) for number in numbers if number in tracks}


if __name__ == "__main__":
    main()
