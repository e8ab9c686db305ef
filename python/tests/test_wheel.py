"""The content of the wheel."""

from __future__ import annotations

import os
import re
import zipfile
from pathlib import Path

import pytest

WHEEL = os.environ.get("VERONESE_WHEEL", "")
ROOT = Path(__file__).parents[2]
LARGEST = 1_500_000

pytestmark = pytest.mark.skipif(not WHEEL, reason="VERONESE_WHEEL names no wheel: `npm test -- python` builds one")
# The wheel of the tests is compiled as they are.
as_published = pytest.mark.skipif("VERONESE_PUBLISHED" not in os.environ, reason="of a wheel as it is published: `npm run soak -- python`")


@as_published
def test_it_is_small() -> None:
    assert os.path.getsize(WHEEL) <= LARGEST


def test_it_is_for_all_versions() -> None:
    assert re.search(r"^veronese-[\d.]+-cp39-abi3-", Path(WHEEL).name)


def test_it_has_the_licences_and_the_notices_of_what_is_in_it() -> None:
    with zipfile.ZipFile(WHEEL) as archive:
        names = archive.namelist()
        for name in ("LICENSE-MIT", "LICENSE-APACHE", "THIRD-PARTY-NOTICES"):
            (inside,) = [path for path in names if path.endswith(f".dist-info/licenses/{name}")]
            source = ROOT / ("python" if name == "THIRD-PARTY-NOTICES" else "") / name
            assert archive.read(inside) == source.read_bytes()
        metadata = archive.read(next(path for path in names if path.endswith("/METADATA"))).decode()
    assert "License-Expression: MIT OR Apache-2.0" in metadata
    assert "Requires-Dist: numpy" in metadata
    assert {"veronese/py.typed", "veronese/_veronese.pyi", "veronese/__init__.py"} <= set(names)
    assert not [name for name in names if "test" in name or "sbom" in name]


def test_the_notices_name_what_is_linked() -> None:
    text = (ROOT / "python" / "THIRD-PARTY-NOTICES").read_text(encoding="utf-8")
    lock = (ROOT / "Cargo.lock").read_text(encoding="utf-8")
    for name in ("pyo3", "pyo3-ffi", "numpy", "ndarray", "nalgebra", "png", "zune-jpeg"):
        (version,) = re.findall(rf'name = "{name}"\nversion = "([^"]+)"', lock)
        assert f"- {name} {version}: " in text, name
    for name in ("wasm-bindgen", "pyo3-macros", "syn", "criterion", "fflate"):
        assert f"- {name} " not in text, f"{name} is not in it"
    assert not re.search(r"/(?:home|root)/|\.cargo|registry|crates\.io|pypi", text)


def test_what_is_published_is_built_with_the_maturin_of_the_tests() -> None:
    (version,) = re.findall(r"^maturin==(\S+)$", (ROOT / "python/tests/requirements.txt").read_text(encoding="utf-8"), re.MULTILINE)
    assert f'requires = ["maturin=={version}"]' in (ROOT / "python/pyproject.toml").read_text(encoding="utf-8")
    assert f"maturin-version: v{version}\n" in (ROOT / ".github/workflows/release.yml").read_text(encoding="utf-8")


@as_published
def test_no_folder_of_the_builder_is_in_it() -> None:
    with zipfile.ZipFile(WHEEL) as archive:
        content = b"".join(archive.read(name) for name in archive.namelist())
    assert str(ROOT).encode() not in content
    assert not re.search(rb"/(?:root|home/\w+|Users/\w+)/", content)
