# SPDX-License-Identifier: GPL-3.0-or-later
"""Light from beyond the scene: --sky."""

import json
import math

import pytest
from conftest import FILE_ERROR, UNSUPPORTED, USAGE, content, error_lines, scene, succeed, triangle, vmap


@pytest.fixture
def ground(folder):
    (folder / "ground.gltf").write_text(triangle())
    return folder


def light(sky):
    succeed("light", "ground.gltf", "--points", 500, "--sky", sky, "-o", "lit.ply", "--json", "r.json")
    return json.load(open("r.json"))["mean_irradiance"]


def test_an_even_sky_gives_pi_times_its_radiance(ground):
    assert light("2") == pytest.approx(2 * math.pi, rel=1e-4)
    assert light("1,2,6") == pytest.approx(3 * math.pi, rel=1e-4)


def test_a_panorama_is_read_from_a_file(ground):
    succeed("light", scene("furnace_50"), "--points", 2000, "-o", "sky.exr", "--size", "64x32")
    assert light("sky.exr") == pytest.approx(math.pi, rel=0.02)


@pytest.mark.parametrize(
    ("sky", "code"), [("nowhere.exr", FILE_ERROR), ("ground.gltf", UNSUPPORTED), ("1,2", USAGE), ("-1", USAGE)]
)
def test_what_is_no_sky_is_refused(ground, sky, code):
    before = content(ground)
    done = vmap("light", "ground.gltf", "--sky", sky, "-o", "lit.ply")
    assert done.returncode == code, done.stderr.decode()
    (line,) = error_lines(done)
    assert sky in line
    assert content(ground) == before
