# SPDX-License-Identifier: GPL-3.0-or-later
"""The glTF files as trimesh reads them and as gltfpack's parser (cgltf) validates them."""

import shutil
import subprocess

import numpy
import pytest
from conftest import radiance


def load(samples, name):
    trimesh = pytest.importorskip("trimesh", reason="the package trimesh is missing")
    scene = trimesh.load(str(samples / name))
    (cloud,) = scene.dump()
    assert isinstance(cloud, trimesh.PointCloud)
    return cloud


@pytest.mark.parametrize("name", ["lit.glb", "lit.gltf"])
def test_trimesh_reads_points(samples, expected, name):
    cloud = load(samples, name)
    assert cloud.vertices == pytest.approx(expected["positions"], rel=1e-6)
    shown = numpy.clip(radiance(expected) * expected["exposure"], 0, 1)
    assert numpy.abs(cloud.colors[:, :3] / 255 - shown).max() < 0.005


def test_custom_attributes_are_exact(samples, expected):
    """Taken from the container by its own rules, with nothing but numpy."""
    import json
    import struct

    content = (samples / "lit.glb").read_bytes()
    magic, version, length, json_size, json_kind = struct.unpack("<4sIII4s", content[:20])
    assert (magic, version, length, json_kind) == (b"glTF", 2, len(content), b"JSON")
    document = json.loads(content[20 : 20 + json_size])
    data = content[28 + json_size :]
    (primitive,) = document["meshes"][0]["primitives"]
    assert primitive["mode"] == 0
    for attribute, key in (("_IRRADIANCE", "irradiance"), ("_ALBEDO", "albedo"), ("_NORMAL", "normals")):
        accessor = document["accessors"][primitive["attributes"][attribute]]
        view = document["bufferViews"][accessor["bufferView"]]
        assert (accessor["componentType"], accessor["type"]) == (5126, "VEC3")
        values = numpy.frombuffer(data, numpy.float32, 3 * accessor["count"], view["byteOffset"]).reshape(-1, 3)
        assert (values == expected[key].astype(numpy.float32)).all()
    assert document["asset"]["extras"]["up"] == "y"
    assert document["meshes"][0]["extras"]["radius"] == pytest.approx(numpy.sqrt(0.01 / numpy.pi), rel=1e-6)


@pytest.mark.parametrize("name", ["lit.glb", "lit.gltf", "empty.glb"])
def test_gltfpack_validates(samples, tmp_path, name):
    if not shutil.which("gltfpack"):
        pytest.skip("the program gltfpack is missing")
    command = ["gltfpack", "-i", samples / name, "-o", tmp_path / "packed.glb", "-v"]
    result = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert result.returncode == 0, result.stdout + result.stderr
