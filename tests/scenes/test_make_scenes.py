# SPDX-License-Identifier: GPL-3.0-or-later
"""The bundled scenes are what their script makes, byte for byte, and the measures beside them hold together."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

SCENES = Path(__file__).parents[2] / "scenes"


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """A folder with a fresh set."""
    folder = tmp_path_factory.mktemp("scenes")
    subprocess.run([sys.executable, SCENES / "make_scenes.py", folder], check=True)
    return folder


def test_script_makes_exactly_the_committed_files(made):
    committed = sorted(path.name for path in SCENES.glob("*.gltf")) + ["expected.json"]
    assert sorted(path.name for path in made.iterdir()) == sorted(committed)
    for name in committed:
        assert (made / name).read_bytes() == (SCENES / name).read_bytes(), name


def test_every_scene_has_a_camera_and_is_described(made):
    expected = json.loads((made / "expected.json").read_text())
    description = (SCENES / "README.md").read_text()
    assert sorted(expected) == sorted(path.name for path in SCENES.glob("*.gltf"))
    for name, values in expected.items():
        assert values["cameras"] >= 1, name
        assert f"`{name}`" in description, name


def test_every_scene_has_light(made):
    expected = json.loads((made / "expected.json").read_text())
    for name, values in expected.items():
        assert values["lights"] > 0 or values["emissive_area"] > 0, name
