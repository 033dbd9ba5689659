# SPDX-License-Identifier: GPL-3.0-or-later
"""Light this scene with the real program, against closed forms."""

import math
import os

import bpy
import numpy as np
import pytest
from blender_helpers import add_cube, add_light, add_plane, diffuse, look, render, use_cycles
from vmap.shell.scene_reader import read_scene

pytestmark = pytest.mark.usefixtures("program")


def light(**arguments):
    assert bpy.ops.vmap.light(**arguments) == {"FINISHED"}
    return bpy.context.view_layer.objects.active


def values(data, name, width=3):
    attribute = data.attributes[name].data
    array = np.empty(len(attribute) * width, np.float32)
    attribute.foreach_get("vector" if width == 3 else "value", array)
    return array.reshape(-1, width)


def positions(item):
    data = item.data
    if "position" in data.attributes:
        return values(data, "position")
    array = np.empty(len(data.vertices) * 3, np.float32)
    data.vertices.foreach_get("co", array)
    return array.reshape(-1, 3)


def lit_floor(item):
    """Positions and light of the points at z = 0 that look up."""
    where = positions(item)
    on_floor = (np.abs(where[:, 2]) < 1e-4) & (values(item.data, "nrm")[:, 2] > 0.9)
    return where[on_floor].astype(float), values(item.data, "irradiance")[on_floor].astype(float)


# Closed forms of the irradiance at (x, y, 0) that faces up. Each light hangs at height 2.
HEIGHT, WATTS = 2.0, 100.0


def point_light(p):
    d2 = (p**2).sum(1) + HEIGHT**2
    return WATTS / (4 * math.pi) * HEIGHT / d2**1.5


def spot_light(p):
    inside = np.hypot(p[:, 0], p[:, 1]) < HEIGHT * math.tan(math.radians(20))
    return point_light(p) * inside


def sun_light(p):
    return np.full(len(p), 3.0 * math.cos(math.radians(60)))


def small_area_light(p):
    # A Lambertian patch of 2 cm: P / pi * cos * cos / d^2; Cycles before 4.0 had 4 for pi.
    d2 = (p**2).sum(1) + HEIGHT**2
    return WATTS / (math.pi if bpy.app.version >= (4, 0) else 4) * HEIGHT**2 / d2**2


LIGHTS = {
    "POINT": (dict(kind="POINT", energy=WATTS, location=(0, 0, HEIGHT)), point_light),
    "SPOT": (dict(kind="SPOT", energy=WATTS, location=(0, 0, HEIGHT), spot_size=math.radians(40)), spot_light),
    "SUN": (dict(kind="SUN", energy=3.0, rotation=(math.radians(60), 0, 0)), sun_light),
    "AREA": (dict(kind="AREA", energy=WATTS, location=(0, 0, HEIGHT), size=0.02), small_area_light),
}


@pytest.mark.parametrize("kind", LIGHTS)
def test_the_same_watts_out_as_in(empty_scene, kind):
    description, expected = LIGHTS[kind]
    add_plane(empty_scene, "floor", size=4.0, material=diffuse("grey", (0.5,) * 3))
    add_light(empty_scene, "lamp", **description)
    where, found = lit_floor(light(points=20_000))
    assert len(where) > 5000
    wanted = expected(where)
    error = np.abs(found[:, 0] - wanted)
    np.testing.assert_array_equal(found[:, 0], found[:, 2])
    assert error.mean() < 0.01 * wanted.mean()


def lit_grid(scene, cells=12):
    """A floor of many quads with no light on it yet, a point light above."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=cells, y_subdivisions=cells, size=4.0)
    item = bpy.context.object
    item.data.materials.append(diffuse("grey", (0.5,) * 3))
    add_light(scene, "lamp", **LIGHTS["POINT"][0])
    return item


@pytest.mark.parametrize("domain", ["POINT", "CORNER"])
def test_light_comes_back_to_the_source_mesh(empty_scene, domain):
    floor = lit_grid(empty_scene)
    assert bpy.ops.vmap.light(result={"ATTRIBUTE"}, domain=domain, points=40_000) == {"FINISHED"}
    attribute = floor.data.attributes["irradiance"]
    assert (attribute.domain, attribute.data_type) == (domain, "FLOAT_VECTOR")
    corners = np.array([v.co for v in floor.data.vertices])
    if domain == "CORNER":
        corners = corners[[loop.vertex_index for loop in floor.data.loops]]
    found, wanted = values(floor.data, "irradiance")[:, 0], point_light(corners)
    assert found.max() > 1.5  # HDR
    assert np.abs(found - wanted).mean() < 0.01 * wanted.mean()
    assert np.abs(found - wanted).max() < 0.05 * wanted.mean()


def test_a_cube_keeps_sharp_edges_at_its_corners(empty_scene):
    cube = add_cube(empty_scene, "cube", material=diffuse("grey", (0.5,) * 3))
    add_light(empty_scene, "sun", "SUN", 2.0)
    assert bpy.ops.vmap.light(result={"ATTRIBUTE"}, points=20_000) == {"FINISHED"}
    found = values(cube.data, "irradiance")[:, 0]
    up = np.repeat([polygon.normal.z > 0.5 for polygon in cube.data.polygons], 4)
    np.testing.assert_allclose(found[up], 2.0, rtol=0.01)
    np.testing.assert_allclose(found[~up], 0, atol=1e-3)


def test_the_light_on_meshes_can_be_seen_and_put_away(empty_scene, tmp_path):
    with pytest.raises(RuntimeError, match="No mesh has the attribute"):
        bpy.ops.vmap.show_on_meshes()
    plane = add_plane(empty_scene, "floor", size=4.0, material=diffuse("grey", (0.5,) * 3))
    add_light(empty_scene, "sun", "SUN", 2.0)
    light(result={"ATTRIBUTE"}, points=5000)
    assert bpy.ops.vmap.show_on_meshes() == {"FINISHED"}
    use_cycles(empty_scene, 4)
    look(empty_scene, (0, 0, 5), (0, 0, 0), ortho=2)
    shown = render(empty_scene, tmp_path, 8)[:, :, :3]
    np.testing.assert_allclose(shown, 2 / math.pi, rtol=0.01)
    assert bpy.ops.vmap.show_on_meshes() == {"FINISHED"}
    assert bpy.context.view_layer.material_override is None and plane.data.materials[0].name == "grey"


def test_the_light_of_one_run_is_not_the_albedo_of_the_next(empty_scene, tmp_path):
    floor = lit_grid(empty_scene)
    before = read_scene(bpy.context, 1, "")
    light(result={"CLOUD", "ATTRIBUTE"}, points=5000)
    after = read_scene(bpy.context, 1, "")
    assert [m.base_color for m in after.materials] == [m.base_color for m in before.materials]
    assert [p.source for p in after.placements] == [p.source for p in before.placements] == [floor.name]
    assert after.meshes[0].parts[0].colors is None
    # Nor does Blender's own exporter take it for a color.
    assert not floor.data.color_attributes


def test_meshes_that_cannot_keep_light_are_named(empty_scene):
    floor = lit_grid(empty_scene)
    twin = floor.copy()
    twin.location.x = 9
    empty_scene.collection.objects.link(twin)
    with pytest.raises(RuntimeError, match="shared by 2 objects"):
        bpy.ops.vmap.light(result={"ATTRIBUTE"}, points=2000)
    assert "irradiance" not in floor.data.attributes


def test_moved_vertices_take_the_light_of_where_they_are(empty_scene):
    floor = lit_grid(empty_scene)
    floor.location = (0, 0, -0.5)
    modifier = floor.modifiers.new("up", "DISPLACE")
    modifier.strength, modifier.mid_level = 0.5, 0.0
    assert bpy.ops.vmap.light(result={"ATTRIBUTE"}, domain="POINT", points=20_000) == {"FINISHED"}
    wanted = point_light(np.array([v.co for v in floor.data.vertices]))
    assert np.abs(values(floor.data, "irradiance")[:, 0] - wanted).mean() < 0.01 * wanted.mean()


def test_spacing_sets_the_number_of_points(empty_scene):
    add_plane(empty_scene, "floor", size=4.0)
    add_light(empty_scene, "lamp", **LIGHTS["POINT"][0])
    item = light(spacing=0.1)
    assert len(positions(item)) == pytest.approx(2 * 16 / 0.01, rel=0.05)  # both sides


def test_a_volume_is_kept_in_the_folder_and_shown(empty_scene, tmp_path):
    lit_grid(empty_scene)
    item = light(result={"VOLUME"}, points=5000, directory=str(tmp_path))
    assert item.type == "VOLUME" and item["vmap_result"] == "VOLUME"
    assert os.path.samefile(bpy.path.abspath(item.data.filepath), tmp_path / "Scene_lit.vdb")


def test_beside_a_saved_file_results_have_a_folder_of_their_own(empty_scene, tmp_path):
    lit_grid(empty_scene)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "room.blend"))
    light(result={"VOLUME"}, points=2000)
    assert (tmp_path / "vmap_light" / "Scene_lit.vdb").exists()


def test_an_animation_is_lit_frame_by_frame(empty_scene, tmp_path):
    lit_grid(empty_scene)
    lamp = bpy.data.objects["lamp"].data
    for frame, power in ((1, 100), (2, 200)):
        lamp.energy = power
        lamp.keyframe_insert("energy", frame=frame)
    item = light(use_frames=True, frame_start=1, frame_end=2, points=2000, directory=str(tmp_path))
    means = []
    for frame in (1, 2):
        empty_scene.frame_set(frame)
        means.append(values(item.data, "irradiance").mean())
    assert means[1] == pytest.approx(2 * means[0], rel=0.01)


def test_a_scene_without_light_says_so(empty_scene):
    add_plane(empty_scene, "floor", material=diffuse("grey", (0.5,) * 3))
    with pytest.raises(RuntimeError, match="light"):
        bpy.ops.vmap.light(points=1000)
