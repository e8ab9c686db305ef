"""Objects of a clip as polygons in CVAT's tracks, and what a person changed in them.

CVAT's server takes masks in tracks, but its page cannot open a job that has one (cvat-ai/cvat#6264): an object is a track of polygons. The
group of a track is the number of its object. Ids cannot be: CVAT gives a track another one each time that it is saved.

What is known of an object is {frame: [points, ...]}: no polygon where it certainly is not, and nothing between two key frames, where CVAT
interpolates.
"""

from xml.etree import ElementTree

from cvat_sdk import models

POLYGON = "polygon"
# The numbers that an object can have.
NUMBERS = range(1, 255)
# CVAT may round coordinates, but not to more than this, pixels.
ROUNDING = 0.01


def known(track, frames):
    """The polygons of a track by its key frames. Before the first and after one that is outside, the object is not there."""
    keys = {shape.frame: shape for shape in track.shapes}
    said, last = {}, None
    for frame in frames:
        if frame in keys:
            last = keys[frame]
            said[frame] = [] if last.outside else [list(last.points)]
        elif last is None or last.outside:
            said[frame] = []
    return said


def united(tracks, frames):
    """The same of several tracks that are one object."""
    parts = [known(track, frames) for track in tracks]
    whole = {}
    for frame in frames:
        polygons = [points for part in parts for points in part.get(frame, [])]
        if polygons or all(frame in part for part in parts):
            whole[frame] = polygons
    return whole


def of_polygons(tracks):
    """Those of objects, the first ones first."""
    polygons = [track for track in tracks if all(shape.type.value == POLYGON for shape in track.shapes)]
    return sorted(polygons, key=lambda track: (track.frame, track.id))


def by_number(tracks, taken):
    """The tracks of polygons by the number of their object. Those of a person, whose group is no number, get numbers that are not `taken`."""
    groups = {}
    for track in of_polygons(tracks):
        groups.setdefault(track.group or f"track {track.id}", []).append(track)
    found = {group: members for group, members in groups.items() if group in NUMBERS}
    free = iter(number for number in NUMBERS if number not in found and number not in taken)
    for group, members in groups.items():
        if group not in found:
            found[next(free)] = members
    return found


def same(one, other):
    """Whether two lists of polygons are the same but for what CVAT rounds."""
    return len(one) == len(other) and all(
        len(a) == len(b) and all(abs(x - y) <= ROUNDING for x, y in zip(a, b)) for a, b in zip(one, other)
    )


def says(tracks, said, frames):
    """Whether tracks say just this of an object."""
    now = united(tracks, frames)
    return all(frame in now and same(now[frame], said[frame]) for frame in frames)


def changes(before, now, frames):
    """The frames in which a person changed an object: {number: [frame, ...]}."""
    changed = {}
    for number, said in now.items():
        old = before.get(number, {frame: [] for frame in frames})
        changed[number] = [frame for frame, polygons in said.items() if frame not in old or not same(polygons, old[frame])]
    return {number: where for number, where in changed.items() if where}


def write_xml(path, objects, changed, frames, size):
    """Writes what is known of the frames that changed, in CVAT's own format for videos, with frames counted as the clip counts them. What changed
    lies on top."""
    only = {frame for where in changed.values() for frame in where}
    root = ElementTree.Element("annotations")
    original = ElementTree.SubElement(ElementTree.SubElement(ElementTree.SubElement(root, "meta"), "task"), "original_size")
    for side, value in zip(("width", "height"), size):
        ElementTree.SubElement(original, side).text = str(value)
    for number, said in sorted(objects.items()):
        track = ElementTree.SubElement(root, "track", id=str(number), label="object")
        for index, frame in enumerate(frames):
            for points in said.get(frame, []) if frame in only else []:
                pairs = ";".join(f"{x},{y}" for x, y in zip(points[::2], points[1::2]))
                above = str(int(frame in changed.get(number, ())))
                ElementTree.SubElement(track, POLYGON, frame=str(index), outside="0", points=pairs, z_order=above)
    ElementTree.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)


def read_xml(path, frames):
    """The objects in what `veronese convert --to cvat-video` wrote: it has a key frame wherever an object is."""
    objects = {}
    for track in ElementTree.parse(path).getroot().iter("track"):
        said = objects.setdefault(int(track.get("id")), {frame: [] for frame in frames})
        for shape in track.iter(POLYGON):
            if shape.get("outside") == "0":
                said[frames[int(shape.get("frame"))]] = [[float(value) for value in shape.get("points").replace(";", ",").split(",")]]
    return objects


def track_of(number, said, frames, *, label, drawn=(), old=()):
    """The track to send, a key frame wherever the object is. A person's frames are `drawn`; `old` tracks give the attributes."""
    keys = {shape.frame: shape for track in old for shape in track.shapes}
    shapes = []
    for frame in frames:
        polygons = said[frame]
        if polygons:
            shapes.append(shape_of(frame, polygons[0], False, keys.get(frame)))
        elif shapes and not shapes[-1].outside:
            shapes.append(shape_of(frame, shapes[-1].points, True, keys.get(frame)))
    return models.LabeledTrackRequest(
        **({"id": old[0].id} if old else {}),
        frame=shapes[0].frame,
        label_id=label,
        group=number,
        source="semi-auto" if drawn else "auto",
        shapes=shapes,
        attributes=attributes_of(old[0]) if old else [],
    )


def shape_of(frame, points, outside, old):
    return models.TrackedShapeRequest(
        type=models.ShapeType(POLYGON),
        frame=frame,
        points=list(points),
        outside=outside,
        occluded=old.occluded if old else False,
        z_order=old.z_order if old else 0,
        rotation=0.0,
        attributes=attributes_of(old) if old else [],
    )


def attributes_of(annotation):
    return [models.AttributeValRequest(spec_id=value.spec_id, value=value.value) for value in annotation.attributes]
