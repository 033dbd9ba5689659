# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of our own come back as they were."""

import pytest
from conftest import scene, succeed


@pytest.fixture
def points(folder):
    succeed("sample", scene("cornell_box"), "--points", 700, "-o", "points.ply", "--quiet")
    return folder / "points.ply"


def again(folder, file):
    succeed("sample", file, "-o", "again.ply", "--quiet")
    return (folder / "again.ply").read_bytes()


def test_ply_points(folder, points):
    assert again(folder, points) == points.read_bytes()


def test_vmap(folder, points):
    succeed("build", points, "-o", "points.vmap", "--quiet")
    assert again(folder, "points.vmap") == points.read_bytes()


@pytest.mark.parametrize("name", ["points.glb", "points.gltf"])
def test_gltf_points_but_for_the_numbers_of_faces(folder, points, name):
    succeed("sample", points, "-o", name, "--quiet")
    header, _, body = points.read_bytes().partition(b"end_header\n")
    back_header, _, back = again(folder, name).partition(b"end_header\n")
    assert header == back_header
    size = len(body) // 700
    ids = header.split(b"property").index(b" uint face_id\n") - 1
    assert ids == 17 and len(back) == len(body)
    first = 6 * 4 + 3 + 8 * 4  # place, normal, colour; irradiance, albedo, radius, area
    for i in range(700):
        row, back_row = body[i * size : (i + 1) * size], back[i * size : (i + 1) * size]
        assert row[:first] == back_row[:first] and row[first + 8 :] == back_row[first + 8 :]
