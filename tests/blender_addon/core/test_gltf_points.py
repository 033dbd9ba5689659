# SPDX-License-Identifier: GPL-3.0-or-later
import base64
import json

import numpy as np
import pytest
from core.errors import AddonError
from core.gltf_points import read_gltf_points
from core.read_cloud import read_cloud
from sample_files import glb_bytes, points_document

POSITIONS = [[0, 0, 0], [1, 2, 3]]
LIT = {
    "POSITION": POSITIONS,
    "COLOR_0": [[0.1, 0.2, 0.3, 1]] * 2,
    "_IRRADIANCE": [[3.5, 2, 1]] * 2,
    "_ALBEDO": [[1, 0.5, 0]] * 2,
    "_NORMAL": [[0, 1, 0]] * 2,
}


def test_our_points_arrive_with_z_up(write):
    cloud = read_cloud(write("lit.glb", glb_bytes(*points_document(LIT, extras={"radius": 0.25}))))
    np.testing.assert_array_equal(cloud.positions, [[0, 0, 0], [1, -3, 2]])
    np.testing.assert_array_equal(cloud.normals, [[0, 0, 1]] * 2)
    np.testing.assert_array_equal(cloud.irradiance, [[3.5, 2, 1]] * 2)
    np.testing.assert_array_equal(cloud.albedo, [[1, 0.5, 0]] * 2)
    np.testing.assert_array_equal(cloud.radius, [0.25] * 2)


def test_double_translation_becomes_the_offset(write):
    node = {"translation": [4500000.125, 1, 2]}
    cloud = read_cloud(write("utm.glb", glb_bytes(*points_document(LIT, node))))
    assert cloud.offset == (4500000.125, -2, 1)
    np.testing.assert_array_equal(cloud.positions[1], [1, -3, 2])


def test_rotation_and_scale_of_the_node_count(write):
    node = {"rotation": [0, 0, 0.5**0.5, 0.5**0.5], "scale": [2, 1, 1]}  # x doubled, then a quarter turn about z
    cloud = read_gltf_points(write("turned.glb", glb_bytes(*points_document(LIT, node, {"radius": 1}))))
    np.testing.assert_allclose(cloud.positions[1], [-2, 2, 3], atol=1e-6)
    np.testing.assert_allclose(cloud.normals[0], [-1, 0, 0], atol=1e-6)
    assert cloud.radius[0] == pytest.approx(2 ** (1 / 3))


def test_nodes_multiply_down_the_tree(write):
    document, binary = points_document(LIT, {"translation": [1, 0, 0]})
    document["nodes"].append({"children": [0], "matrix": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 5, 1]})
    document["scenes"] = [{"nodes": [1]}]
    cloud = read_gltf_points(write("tree.glb", glb_bytes(document, binary)))
    np.testing.assert_allclose(cloud.positions + np.array(cloud.offset), [[2, 0, 5], [4, 4, 11]])


@pytest.mark.parametrize("uri", ["data", "points.bin", "my%20points.bin"])
def test_buffers_inside_and_beside_the_file(write, uri):
    document, binary = points_document(LIT)
    if uri == "data":
        uri = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
    else:
        write(uri.replace("%20", " "), binary)
    document["buffers"][0]["uri"] = uri
    cloud = read_gltf_points(write("lit.gltf", json.dumps(document)))
    np.testing.assert_array_equal(cloud.positions, POSITIONS)


def test_foreign_points_have_their_linear_color_as_albedo(write):
    document = points_document({"POSITION": POSITIONS, "COLOR_0": [[0.1, 0.2, 0.3]] * 2})
    cloud = read_cloud(write("foreign.glb", glb_bytes(*document)))
    np.testing.assert_allclose(cloud.albedo, [[0.1, 0.2, 0.3]] * 2)
    assert cloud.irradiance is None


def test_normalised_bytes_are_scaled(write):
    document, binary = points_document({"POSITION": POSITIONS, "COLOR_0": [[0] * 3] * 2})
    colors = np.array([[255, 0, 51, 0]] * 2, np.uint8)
    document["accessors"][1].update(componentType=5121, normalized=True)
    document["bufferViews"][1]["byteStride"] = 4
    cloud = read_gltf_points(write("bytes.glb", glb_bytes(document, binary[:24] + colors.tobytes() + binary[32:])))
    np.testing.assert_allclose(cloud.albedo, [[1, 0, 0.2]] * 2, atol=1e-7)


def test_several_primitives_are_one_cloud(write):
    document, binary = points_document(LIT)
    bare = {"mode": 0, "attributes": {"POSITION": 0}}
    document["meshes"][0]["primitives"].append(bare)
    cloud = read_gltf_points(write("two.glb", glb_bytes(document, binary)))
    assert len(cloud) == 4
    np.testing.assert_array_equal(cloud.irradiance[2:], np.zeros((2, 3)))


def bad(change):
    document, binary = points_document(LIT)
    change(document)
    return glb_bytes(document, binary)


BAD = {
    "empty": b"",
    "foreign": b"\x89PNG\r\n\x1a\n and more of it",
    "header only": b"glTF\x02\0\0\0",
    "triangles": glb_bytes(*points_document(LIT, mode=4)),
    "version 1": glb_bytes({"asset": {"version": "1.0"}}),
    "no asset": b"{}",
    "a list": b"[1]",
    "deep": b"[" * 100_000,
    "no position": bad(lambda d: d["meshes"][0]["primitives"][0]["attributes"].pop("POSITION")),
    "beyond the buffer": bad(lambda d: d["accessors"][0].update(count=10**9)),
    "negative": bad(lambda d: d["accessors"][0].update(count=-1)),
    "another count": bad(lambda d: d["accessors"][2].update(count=1)),
    "sparse": bad(lambda d: d["accessors"][0].update(sparse={})),
    "no accessor": bad(lambda d: d["accessors"].clear()),
    "no nodes": bad(lambda d: d["scenes"][0].update(nodes=[7])),
    "loop": bad(lambda d: d["nodes"][0].update(children=[0])),
    "outside": bad(lambda d: d["buffers"][0].update(uri="../../etc/passwd")),
    "missing buffer": bad(lambda d: d["buffers"][0].update(uri="absent.bin")),
    "no buffer": bad(lambda d: d["buffers"].clear()),
    "words": bad(lambda d: d["nodes"][0].update(translation=["a", "b", "c"])),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_file_is_an_error_of_one_line(write, name):
    with pytest.raises(AddonError) as caught:
        read_cloud(write("bad.glb", BAD[name]))
    assert "\n" not in str(caught.value) and "expected" in str(caught.value)


def test_truncated_at_every_length_is_an_error(write):
    data = glb_bytes(*points_document(LIT))
    for size in range(len(data)):
        with pytest.raises(AddonError):
            read_gltf_points(write("cut.glb", data[:size]))


def test_unknown_extension_says_what_is_read(write):
    with pytest.raises(AddonError, match=r"\.ply, \.glb, \.gltf"):
        read_cloud(write("points.las", b"LASF"))
