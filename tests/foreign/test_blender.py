# SPDX-License-Identifier: GPL-3.0-or-later
"""Our files in Blender, one process for all: in_blender.py imports, renders and writes down what it sees."""

import json
import shutil
import subprocess
from pathlib import Path

import numpy
import pytest
from conftest import z_up

SCRIPT = Path(__file__).with_name("in_blender.py")


@pytest.fixture(scope="module")
def seen(samples, tmp_path_factory):
    blender = shutil.which("blender")
    if not blender:
        pytest.skip("the program blender is missing")
    output = tmp_path_factory.mktemp("blender") / "seen.json"
    command = [blender, "-b", "-t", "1", "--factory-startup", "--python-exit-code", "1", "--python", SCRIPT]
    result = subprocess.run([*command, "--", samples, output], capture_output=True, text=True, timeout=120)
    assert output.exists(), result.stdout + result.stderr
    return json.loads(output.read_text())


def bounds(points):
    return numpy.array([numpy.min(points, axis=0), numpy.max(points, axis=0)])


def test_ply_and_gltf_have_every_point_where_it_belongs(seen, expected):
    places = z_up(expected["positions"])
    for name in ("ply", "glb", "gltf"):
        assert numpy.array(seen[name]) == pytest.approx(places, abs=1e-5), name


def test_volume_coincides_with_the_points_within_a_voxel(seen, expected):
    assert sorted(seen["grids"]) == ["density", "irradiance"]
    # The shell runs through the middle between the outermost voxels and their empty neighbours.
    half = expected["voxel_size"] / 2
    voxels = bounds(seen["shell"]) + numpy.array([[half], [-half]])
    assert numpy.abs(voxels - bounds(z_up(expected["positions"]))).max() <= expected["voxel_size"]


def test_volume_renders_with_the_colour_of_the_light(seen, expected):
    picture = numpy.array(seen["render"])
    assert picture.min() > 0.5, "the render is black"
    assert numpy.median(picture / picture[:, :1], axis=0) == pytest.approx((1, 2 / 3, 1 / 3), rel=0.01)
    # The way down through the floor is five voxels long, two of them on either side of the points.
    assert numpy.median(picture[:, 0]) == pytest.approx(3 * 5 * expected["voxel_size"], rel=0.2)


def test_pictures(seen, expected):
    exr = numpy.array(seen["exr"]).reshape(4, 6, 4)[::-1, :, :3].reshape(-1, 3)  # Blender's rows go upwards
    assert exr == pytest.approx(expected["picture"], rel=1e-6)
    assert seen["png size"] == [6, 4]
