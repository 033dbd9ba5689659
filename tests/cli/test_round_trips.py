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
    properties = [line.split()[1:] for line in header.decode().splitlines() if line.startswith("property")]
    names = [name for _, name in properties]
    first = sum(1 if kind == "uchar" else 4 for kind, _ in properties[: names.index("face_id")])
    assert names.index("material_id") == names.index("face_id") + 1 and len(back) == len(body)
    size = len(body) // 700
    for i in range(700):
        row, back_row = body[i * size : (i + 1) * size], back[i * size : (i + 1) * size]
        assert row[:first] == back_row[:first] and row[first + 8 :] == back_row[first + 8 :]
