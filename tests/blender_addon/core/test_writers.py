# SPDX-License-Identifier: GPL-3.0-or-later
"""GLB, PNG and EXR as others read them."""

import json
import struct
import zlib

import core.glb_writer
import numpy as np
import pytest
from core.errors import AddonError
from core.exr_writer import write_exr
from core.glb_writer import write_glb
from core.png import png_bytes
from core.scene_model import Part, Placement, Scene, SceneCamera, SceneLight, SceneMaterial, SceneMesh, TextureImage

TRIANGLE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)


def scene_of(material=None, **part):
    scene = Scene(materials=[material or SceneMaterial("grey")])
    scene.meshes = [SceneMesh("mesh", [Part(0, TRIANGLE, np.array([[0, 1, 2]]), **part)])]
    scene.placements = [Placement(0, np.diag([2.0, 1, 1, 1]), "object")]
    return scene


def written(tmp_path, scene):
    """Document and binary chunk of the written file."""
    path = tmp_path / "scene.glb"
    write_glb(str(path), scene)
    data = path.read_bytes()
    magic, version, length = struct.unpack_from("<4sII", data)
    size = struct.unpack_from("<I", data, 12)[0]
    assert (magic, version, length) == (b"glTF", 2, len(data)) and size % 4 == 0
    binary = struct.unpack_from("<I4s", data, 20 + size)
    assert binary == (len(data) - 28 - size, b"BIN\0")
    return json.loads(data[20 : 20 + size]), data[28 + size :]


def array(document, binary, accessor):
    accessor = document["accessors"][accessor]
    view = document["bufferViews"][accessor["bufferView"]]
    kind = {5126: "<f4", 5125: "<u4"}[accessor["componentType"]]
    data = binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
    return np.frombuffer(data, kind).reshape(accessor["count"], -1)


def test_geometry_is_written_as_it_is_under_a_root_that_turns_z_to_y(tmp_path):
    document, binary = written(tmp_path, scene_of())
    primitive = document["meshes"][0]["primitives"][0]
    np.testing.assert_array_equal(array(document, binary, primitive["attributes"]["POSITION"]), TRIANGLE)
    np.testing.assert_array_equal(array(document, binary, primitive["indices"]).ravel(), [0, 1, 2])
    assert document["accessors"][0]["min"] == [0, 0, 0] and document["accessors"][0]["max"] == [1, 1, 0]
    root, node = document["nodes"]
    assert root["children"] == [1] and document["scenes"][0]["nodes"] == [0]
    turned = np.array(root["matrix"]).reshape(4, 4).T @ [1, 2, 3, 1]
    np.testing.assert_array_equal(turned, [1, 3, -2, 1])
    assert node["matrix"][0] == 2 and node["name"] == "object"


def test_emission_is_factor_times_strength(tmp_path):
    document, _ = written(tmp_path, scene_of(SceneMaterial("lamp", (0, 0, 0), emission=(50, 25, 0))))
    material = document["materials"][0]
    strength = material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"]
    assert strength == 50 and material["emissiveFactor"] == [1, 0.5, 0]
    assert document["extensionsUsed"] == ["KHR_materials_emissive_strength"]


def test_lights_and_cameras(tmp_path):
    scene = scene_of()
    scene.lights = [
        SceneLight("spot", (1, 1, 1), 7.5, np.eye(4), (0.3, 0.5)),
        SceneLight("directional", (1, 0, 0), 2, np.eye(4)),
    ]
    scene.camera = SceneCamera(np.eye(4), 0.7, aspect=1.5)
    document, _ = written(tmp_path, scene)
    spot, sun = document["extensions"]["KHR_lights_punctual"]["lights"]
    assert spot["intensity"] == 7.5 and spot["spot"] == {"innerConeAngle": 0.3, "outerConeAngle": 0.5}
    assert sun == {"type": "directional", "name": "", "color": [1, 0, 0], "intensity": 2}
    assert document["cameras"][0]["perspective"]["yfov"] == 0.7
    assert [n.get("camera") for n in document["nodes"]] == [None, None, None, None, 0]


def test_orthographic_camera(tmp_path):
    scene = scene_of()
    scene.camera = SceneCamera(np.eye(4), half_height=2, aspect=1.5)
    assert written(tmp_path, scene)[0]["cameras"][0]["orthographic"]["xmag"] == 3


def test_texture_with_coordinates_that_run_down(tmp_path):
    image = TextureImage("checker", np.zeros((2, 2, 4), np.uint8), repeat=False, nearest=True)
    scene = scene_of(SceneMaterial("m", base_texture=0, alpha_cut=True), uvs=TRIANGLE[:, :2], colors=np.ones((3, 4)))
    scene.images = [image]
    document, binary = written(tmp_path, scene)
    attributes = document["meshes"][0]["primitives"][0]["attributes"]
    np.testing.assert_array_equal(array(document, binary, attributes["TEXCOORD_0"]), [[0, 1], [1, 1], [0, 0]])
    assert attributes.keys() == {"POSITION", "TEXCOORD_0", "COLOR_0"}
    assert document["samplers"][0]["wrapS"] == 33071 and document["materials"][0]["alphaMode"] == "MASK"


def test_emission_texture_has_coordinates_of_its_own(tmp_path):
    material = SceneMaterial("m", emission=(1, 1, 1), emission_texture=0)
    scene = scene_of(material, emission_uvs=TRIANGLE[:, :2])
    scene.images = [TextureImage("glow", np.zeros((1, 1, 4), np.uint8))]
    document, _ = written(tmp_path, scene)
    assert document["materials"][0]["emissiveTexture"] == {"index": 0, "texCoord": 1}
    assert "TEXCOORD_1" in document["meshes"][0]["primitives"][0]["attributes"]


def test_faces_are_numbered_through_the_placements():
    scene = scene_of()
    scene.placements.append(Placement(0, np.eye(4), "again"))
    assert scene.face_ranges() == [("object", 0, 1), ("again", 1, 2)] and scene.triangle_count() == 2


def test_what_is_not_carried_is_named_once():
    scene = Scene()
    for name in ("Sun", "Sun", "Sun.001"):
        scene.skip("angle of a sun", name)
    for number in range(9):
        scene.skip("lamp radius", f"Point.{number}")
    assert scene.not_carried() == [
        "angle of a sun: Sun, Sun.001",
        "lamp radius: Point.0, Point.1, Point.2, Point.3 and 5 more",
    ]


def test_more_than_four_gigabytes_is_an_error(tmp_path, monkeypatch):
    monkeypatch.setattr(core.glb_writer, "LARGEST_FILE", 100)
    with pytest.raises(AddonError, match="4 GB"):
        write_glb(str(tmp_path / "scene.glb"), scene_of())
    assert not (tmp_path / "scene.glb").exists()


@pytest.mark.parametrize("channels", [3, 4])
def test_png(channels):
    pixels = np.random.default_rng(1).integers(0, 256, (5, 7, channels), np.uint8)
    data = png_bytes(pixels)
    assert data.startswith(b"\x89PNG\r\n\x1a\n") and data.endswith(b"IEND\xaeB`\x82")
    begin = data.index(b"IDAT")
    size = struct.unpack_from(">I", data, begin - 4)[0]
    rows = np.frombuffer(zlib.decompress(data[begin + 4 : begin + 4 + size]), np.uint8).reshape(5, -1)
    np.testing.assert_array_equal(rows[:, 1:].reshape(pixels.shape), pixels)


def test_exr_layout(tmp_path):
    pixels = np.arange(2 * 3 * 3, dtype=np.float32).reshape(2, 3, 3)
    write_exr(str(tmp_path / "sky.exr"), pixels)
    data = (tmp_path / "sky.exr").read_bytes()
    assert data[:8] == struct.pack("<ii", 20000630, 2)
    row = 8 + 3 * 4 * 3
    first = len(data) - 2 * row
    assert struct.unpack_from("<QQ", data, first - 16) == (first, first + row)
    blue, green, red = np.frombuffer(data, "<f4", 9, first + 8).reshape(3, 3)
    np.testing.assert_array_equal(np.stack([red, green, blue], 1), pixels[0])
