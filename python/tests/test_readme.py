"""The examples of README.md and the program beside it, as a reader runs them."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import List

import numpy as np
import pytest
from scenes import clip, frame, write_image

HERE = Path(__file__).parent
README = HERE.parent / "README.md"
EXAMPLES: List[str] = re.findall(r"^```python\n(.*?)^```$", README.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
# The only one that needs a package besides NumPy.
OPENCV = [example for example in EXAMPLES if "cv2" in example]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_image(tmp_path / "first.png", frame(0))
    write_image(tmp_path / "second.png", frame(1))
    (tmp_path / "frames").mkdir()
    for index, pixels in enumerate(clip(5)):
        write_image(tmp_path / "frames" / f"{index}.png", pixels)
    return tmp_path


def run(folder: Path, *arguments: object) -> str:
    ended = subprocess.run([sys.executable, *map(str, arguments)], cwd=folder, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
    return ended.stdout


@pytest.mark.parametrize("example", [example for example in EXAMPLES if example not in OPENCV])
def test_an_example_runs(example: str, folder: Path) -> None:
    program = folder / "example.py"
    program.write_text(example, encoding="utf-8")
    assert run(folder, program).strip()


def test_the_example_with_a_camera_runs(folder: Path) -> None:
    """With frames in the place of a video, and OpenCV's call in the place of OpenCV."""
    (example,) = OPENCV
    (folder / "cv2.py").write_text(STAND_IN, encoding="utf-8")
    program = folder / "example.py"
    program.write_text(example, encoding="utf-8")
    np.save(folder / "frames.npy", np.stack(clip(5))[..., ::-1])
    assert run(folder, program).splitlines() == [f"{index} 1" for index in range(5)]


STAND_IN = """
import numpy as np
class VideoCapture:
    def __init__(self, name):
        self.frames = iter(np.load("frames.npy"))
    def read(self):
        frame = next(self.frames, None)
        return frame is not None, frame
"""


def test_the_notebook_runs_and_shows_pictures(folder: Path) -> None:
    """Its cells in order; of the last line of each, what a notebook shows."""
    notebook = json.loads((HERE.parent / "examples" / "clip.ipynb").read_text(encoding="utf-8"))
    assert all(cell["outputs"] == [] for cell in notebook["cells"] if cell["cell_type"] == "code"), "it is kept without outputs"
    cells = ["".join(cell["source"]) for cell in notebook["cells"] if cell["cell_type"] == "code"]
    (folder / "notebook.py").write_text(SHOWN + f"for cell in {cells!r}:\n    show(cell)\n", encoding="utf-8")
    shown = run(folder, folder / "notebook.py").splitlines()
    assert shown[0].startswith("[ClipFrame(0, 96×72, objects=[1]), ")
    assert shown[1] == "a picture"
    assert shown[2].startswith("object 1 has ")
    assert shown[3] == "ClipTracks([ClipTrack(1, frames 0 to 4)])"
    assert sorted(path.name for path in (folder / "masks").iterdir()) == [f"{index:05}.png" for index in range(5)]


SHOWN = """
import ast

names = {}


def show(cell):
    *before, last = ast.parse(cell).body
    exec(compile(ast.Module(before, []), "cell", "exec"), names)
    if not isinstance(last, ast.Expr):
        return exec(compile(ast.Module([last], []), "cell", "exec"), names)
    value = eval(compile(ast.Expression(last.value), "cell", "eval"), names)
    if value is not None:
        print("a picture" if hasattr(value, "_repr_png_") and value._repr_png_() else repr(value))


"""


def test_the_program_writes_masks_and_boxes(folder: Path) -> None:
    printed = run(folder, HERE.parent / "examples" / "clip_to_masks.py", "frames", "out")
    assert printed.startswith("object 1: frames 0 to 4")
    assert np.load(folder / "out" / "00002.npy").shape == (72, 96)
    assert set(json.loads((folder / "out" / "boxes.json").read_text())["1"]) == {"0", "1", "2", "3", "4"}
    ended = subprocess.run(
        [sys.executable, str(HERE.parent / "examples" / "clip_to_masks.py"), "nowhere", "out"], cwd=folder, capture_output=True, text=True
    )
    assert ended.returncode == 1 and ended.stderr.strip().startswith("file-not-found: ")
