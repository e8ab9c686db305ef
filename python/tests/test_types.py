"""Types: what callers write passes `mypy --strict`, and the stubs are those of the module."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path


HERE = Path(__file__).parent
FILES = sorted([*HERE.glob("*.py"), *(HERE.parent / "examples").glob("*.py")])


def run(*arguments: object) -> str:
    ended = subprocess.run([sys.executable, *map(str, arguments)], capture_output=True, text=True, cwd=HERE)
    assert ended.returncode == 0, ended.stdout + ended.stderr
    return ended.stdout


def test_the_package_its_example_and_its_tests_pass_strictly(tmp_path: Path) -> None:
    run("-m", "mypy", "--strict", "--cache-dir", tmp_path, "--package", "veronese")
    run("-m", "mypy", "--strict", "--cache-dir", tmp_path, *FILES)


def test_the_stubs_are_those_of_the_module(tmp_path: Path) -> None:
    run("-m", "mypy.stubtest", "veronese._veronese", "--mypy-config-file", HERE / "stubtest.ini")


WRONG = """
from veronese import open_clip, segment_pair
import numpy as np

frame = np.zeros((48, 64, 3), np.uint8)
segment_pair(frame, frame, quality="good")
segment_pair(frame, frame, motions="two")
segment_pair(frame, frame, seed=1)
open_clip([frame]).annotate(frame)
fractions = np.zeros((48, 64, 3), np.float32)
segment_pair(frame, fractions)
reveal_type(segment_pair(frame, frame).motions[0].matrix)
"""


def test_mistakes_are_found(tmp_path: Path) -> None:
    program = tmp_path / "wrong.py"
    program.write_text(WRONG, encoding="utf-8")
    ended = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path), str(program)], capture_output=True, text=True, cwd=tmp_path
    )
    wrong = [line for line in ended.stdout.splitlines() if ": error:" in line]
    assert len(wrong) == 5, ended.stdout
    assert "float64" in ended.stdout


