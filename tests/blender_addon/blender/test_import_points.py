# SPDX-License-Identifier: GPL-3.0-or-later
import math
import time

import bpy
import numpy as np
import pytest
from blender_helpers import data_counts, look, render, use_cycles
from sample_files import glb_bytes, grid_positions, our_ply, our_rows, ply_bytes, points_document
from vmap.shell import point_material
from vmap.shell.compat import EEVEE_DRAWS_POINTS
from vmap.shell.point_nodes import SQUARE
from vmap.shell.point_object import SHOWN_SIZE


def attribute(item, name, field="vector", width=3):
    data = item.data.attributes[name].data
    values = np.empty(len(data) * width, np.float32 if field != "value_int" else np.int32)
    data.foreach_get(field.replace("_int", ""), values)
    return values.reshape(-1, width)


def import_points(**arguments):
    assert bpy.ops.vmap.import_points(**arguments) == {"FINISHED"}
    return bpy.context.view_layer.objects.active


def can_make_point_clouds():
    """As the documentation says: from 4.5 on. 4.2 lists the conversion but cannot do it."""
    return bpy.app.version >= (4, 5, 0)


def test_our_ply_keeps_every_value(write):
    data = our_ply([[0, 0, 0], [1, 2, 3]], irradiance=[3.5, 1e4, 0], albedo=[1, 0.5, 0.25], radius=0.125)
    item = import_points(filepath=write("lit.ply", data))
    assert item.name == "lit" and item.select_get()
    assert item.type == ("POINTCLOUD" if can_make_point_clouds() else "MESH")
    np.testing.assert_array_equal(attribute(item, "position") if item.type == "POINTCLOUD" else
                                  [v.co for v in item.data.vertices], [[0, 0, 0], [1, 2, 3]])  # fmt: skip
    np.testing.assert_array_equal(attribute(item, "irradiance"), [[3.5, 1e4, 0]] * 2)
    np.testing.assert_array_equal(attribute(item, "albedo"), [[1, 0.5, 0.25]] * 2)
    np.testing.assert_array_equal(attribute(item, "nrm"), [[0, 0, 1]] * 2)
    np.testing.assert_array_equal(attribute(item, "radius", "value", 1), [[0.125]] * 2)
    np.testing.assert_array_equal(attribute(item, "face_id", "value_int", 1), [[0], [1]])
    assert item["vmap_source"] == "room.glb"


def test_points_show_at_their_radius_times_the_size_that_leaves_no_holes(write):
    item = import_points(filepath=write("lit.ply", our_ply([[0, 0, 0], [1, 0, 0]], radius=0.25)))
    depsgraph = bpy.context.evaluated_depsgraph_get()
    shown = [i.object for i in depsgraph.object_instances if i.object.type == "POINTCLOUD"]
    if EEVEE_DRAWS_POINTS:
        assert len(shown) == 1
        assert [p.radius for p in shown[0].data.points] == pytest.approx([0.25 * SHOWN_SIZE] * 2)
        material = shown[0].data.materials[0]
    else:  # squares
        mesh = item.evaluated_get(depsgraph).data
        assert [polygon.area for polygon in mesh.polygons] == pytest.approx([(2 * 0.25 * SHOWN_SIZE * SQUARE) ** 2] * 2)
        material = mesh.materials[mesh.polygons[0].material_index]
    assert material.name.startswith(item.name)


def test_points_without_normals_show_too(write, tmp_path, empty_scene):
    rows = np.zeros(1, [(n, "f4") for n in ("x", "y", "z", "radius")] + [(n, "u1") for n in ("red", "green", "blue")])
    rows["radius"], rows["red"] = 1.0, 255
    import_points(filepath=write("foreign.ply", ply_bytes(rows)))
    np.testing.assert_allclose(rendered_point(empty_scene, tmp_path), [1, 0, 0], atol=1e-6)


def test_double_offset_is_kept_and_places_the_object(write):
    item = import_points(filepath=write("utm.ply", our_ply([[0, 0, 0]], offset=(4500000.125, -2.5, 3.0))))
    assert tuple(item["vmap_offset"]) == (4500000.125, -2.5, 3.0)
    np.testing.assert_allclose(item.location, (4500000.125, -2.5, 3.0), rtol=1e-7)


def test_gltf_points_stand_where_the_same_ply_stands(write):
    positions, normals = np.array([[1, 2, 3], [0, 0, 1]], np.float32), np.array([[0, 0, 1], [1, 0, 0]], np.float32)
    ply = import_points(filepath=write("a.ply", our_ply(positions, normals=normals, irradiance=2.0)))

    def y_up(v):
        return np.stack([v[:, 0], v[:, 2], -v[:, 1]], axis=1)

    lit = {"POSITION": y_up(positions), "_IRRADIANCE": np.full((2, 3), 2), "_NORMAL": y_up(normals)}
    glb = import_points(filepath=write("a.glb", glb_bytes(*points_document(lit, extras={"radius": 0.01}))))
    for name in ("nrm", "irradiance"):
        np.testing.assert_array_equal(attribute(ply, name), attribute(glb, name))
    if ply.type == "POINTCLOUD":
        np.testing.assert_array_equal(attribute(ply, "position"), attribute(glb, "position"))


def test_several_files_are_several_objects_and_numbered_ones_a_sequence(write, tmp_path):
    names = ["lit_0001.ply", "lit_0002.ply", "other.ply"]
    for number, name in enumerate(names):
        write(name, our_ply([[number, 0, 0]] * (number + 1), irradiance=number + 1))
    files = [{"name": name} for name in names]
    assert bpy.ops.vmap.import_points(directory=str(tmp_path), files=files) == {"FINISHED"}
    assert len(bpy.context.selected_objects) == 2
    item = bpy.data.objects["lit_0001"]
    scene = bpy.context.scene
    for frame, count in ((1, 1), (2, 2), (7, 2), (0, 1)):
        scene.frame_set(frame)
        assert len(item.data.vertices) == count
        np.testing.assert_array_equal(attribute(item, "irradiance"), [[count] * 3] * count)
    assert bpy.ops.vmap.import_points(directory=str(tmp_path), files=files, use_sequence=False) == {"FINISHED"}
    assert len(bpy.context.selected_objects) == 3


def test_a_missing_frame_leaves_the_points_as_they_are(write, tmp_path):
    for name in ("lit_1.ply", "lit_2.ply"):
        write(name, our_ply([[0, 0, 0]] * 3))
    files = [{"name": "lit_1.ply"}, {"name": "lit_2.ply"}]
    bpy.ops.vmap.import_points(directory=str(tmp_path), files=files)
    item = bpy.context.object
    (tmp_path / "lit_2.ply").unlink()
    bpy.context.scene.frame_set(2)
    assert len(item.data.vertices) == 3


def test_foreign_colors_show_as_albedo(write):
    rows = np.zeros(2, [(n, "f4") for n in "xyz"] + [(n, "u1") for n in ("red", "green", "blue")])
    rows["x"], rows["red"] = [0, 1], 255
    item = import_points(filepath=write("foreign.ply", ply_bytes(rows)))
    np.testing.assert_array_equal(attribute(item, "albedo"), [[1, 0, 0]] * 2)
    assert item.vmap_show == "ALBEDO"


def rendered_point(scene, tmp_path):
    """Color at the middle of one big point."""
    use_cycles(scene, 4)
    look(scene, (0, 0, 5), (0, 0, 0), ortho=0.5)
    return render(scene, tmp_path, 8)[3:5, 3:5, :3].mean(axis=(0, 1))


def one_point(write, **values):
    return import_points(filepath=write("one.ply", our_ply([[0, 0, 0]], radius=1.0, **values)))


def test_irradiance_three_and_a_half_on_white_shows_as_its_radiance(write, tmp_path, empty_scene):
    item = one_point(write, irradiance=3.5, albedo=1.0)
    material = item.data.materials[0]
    point_material.exposure_socket(material).default_value = 2.0
    color = rendered_point(empty_scene, tmp_path)
    np.testing.assert_allclose(color, [2 * 3.5 / math.pi] * 3, rtol=1e-3)


@pytest.mark.parametrize("way,shown", [
    ("LIT", [2 * 3.5 / math.pi * 0.5, 2 * 7 / math.pi * 0.25, 0]),
    ("IRRADIANCE", [2 * 3.5 / math.pi, 2 * 7 / math.pi, 0]),
    ("ALBEDO", [0.5, 0.25, 0.125]),
    ("NORMALS", [0.5, 0.5, 1.0]),
])  # fmt: skip
def test_the_switch_shows_light_albedo_and_normals(write, tmp_path, empty_scene, way, shown):
    item = one_point(write, irradiance=[3.5, 7, 0], albedo=[0.5, 0.25, 0.125], exposure=2)
    item.vmap_show = way
    assert item.vmap_show == way
    np.testing.assert_allclose(rendered_point(empty_scene, tmp_path), shown, rtol=1e-3, atol=1e-5)


def test_emission_adds_to_the_lit_color(write, tmp_path, empty_scene):
    rows = our_rows([[0, 0, 0]], irradiance=math.pi, albedo=0.5, radius=1.0)
    from numpy.lib import recfunctions

    glow = np.full(1, 4.0, np.float32)
    rows = recfunctions.append_fields(rows, [f"emission_{c}" for c in "rgb"], [glow] * 3, usemask=False)
    import_points(filepath=write("lamp.ply", ply_bytes(rows)))
    np.testing.assert_allclose(rendered_point(empty_scene, tmp_path), [4.5] * 3, rtol=1e-3)


def test_a_sheet_of_points_has_no_holes(write, tmp_path, empty_scene):
    positions = grid_positions(50, 1.0)
    positions[:, :2] += np.random.default_rng(1).uniform(-0.004, 0.004, (2500, 2))
    radius = (1 / 2500 / math.pi) ** 0.5
    import_points(filepath=write("sheet.ply", our_ply(positions, irradiance=math.pi, albedo=1, radius=radius)))
    use_cycles(empty_scene, 1)
    look(empty_scene, (0, 0, 5), (0, 0, 0), ortho=0.8)
    np.testing.assert_allclose(render(empty_scene, tmp_path, 32)[:, :, :3], 1, rtol=1e-3)


def test_the_back_of_a_wall_does_not_show_through(write, tmp_path, empty_scene):
    """Both sides of a sheet lie in one plane; the front is lit, the back is not."""
    front, back = our_rows(grid_positions(30), irradiance=math.pi), our_rows(grid_positions(31), irradiance=0)
    back["nz"] = -1
    rows = np.concatenate([front, back])
    rows["radius"] = 0.03
    item = import_points(filepath=write("wall.ply", ply_bytes(rows)))
    use_cycles(empty_scene, 1)
    look(empty_scene, (0, 0, 5), (0, 0, 0), ortho=0.8)
    np.testing.assert_allclose(render(empty_scene, tmp_path, 16)[:, :, :3], 0.5, rtol=1e-3)
    item.rotation_euler.x = math.pi
    np.testing.assert_allclose(render(empty_scene, tmp_path, 16)[:, :, :3], 0, atol=1e-6)


def test_a_million_points_within_two_seconds(write):
    path = write("million.ply", our_ply(grid_positions(1000)))
    begin, cpu = time.monotonic(), time.process_time()
    item = import_points(filepath=path)
    wall, cpu = time.monotonic() - begin, time.process_time() - cpu
    print(f"\n1 M points imported as {item.type} in {wall:.2f} s ({cpu:.2f} s of processor)")
    assert cpu < 2


@pytest.mark.parametrize("name,data", [
    ("empty.ply", b""),
    ("foreign.ply", b"solid cube"),
    ("cut.ply", our_ply(np.zeros((9, 3)))[:-20]),
    ("none.ply", our_ply(np.zeros((0, 3)))),
    ("triangles.glb", glb_bytes(*points_document({"POSITION": [[0, 0, 0]] * 3}, mode=4))),
    ("points.xyz", b"0 0 0"),
    ("absent.ply", None),
])  # fmt: skip
def test_bad_files_are_errors_and_leave_nothing(write, tmp_path, nothing_left, name, data):
    path = write(name, data) if data is not None else str(tmp_path / name)
    with pytest.raises(RuntimeError, match=name):
        bpy.ops.vmap.import_points(filepath=path)


def test_one_bad_file_among_good_ones_leaves_nothing(write, tmp_path, nothing_left):
    write("good.ply", our_ply([[0, 0, 0]]))
    write("wrong.ply", b"no")
    with pytest.raises(RuntimeError, match="wrong.ply"):
        bpy.ops.vmap.import_points(directory=str(tmp_path), files=[{"name": "good.ply"}, {"name": "wrong.ply"}])


def test_no_file_is_said(nothing_left):
    with pytest.raises(RuntimeError, match="No file"):
        bpy.ops.vmap.import_points()


@pytest.mark.parametrize("order", [">", ""])
def test_ascii_and_big_endian(write, order):
    item = import_points(filepath=write("lit.ply", our_ply([[1, 2, 3]], order=order, irradiance=3.5)))
    np.testing.assert_array_equal(attribute(item, "irradiance"), [[3.5] * 3])


def test_not_a_number_is_left_out(write):
    positions = np.array([[0, 0, 0], [np.nan, 0, 0], [np.inf, 0, 0]], np.float32)
    item = import_points(filepath=write("nan.ply", our_ply(positions)))
    assert len(attribute(item, "irradiance")) == 1


def test_importing_needs_no_program(write, monkeypatch):
    monkeypatch.setenv("PATH", "")
    import_points(filepath=write("lit.ply", our_ply([[0, 0, 0]])))


def test_saved_files_show_the_points_again(write, tmp_path):
    import_points(filepath=write("lit.ply", our_ply([[0, 0, 0]], irradiance=3.5)))
    path = str(tmp_path / "saved.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    item = bpy.data.objects["lit"]
    np.testing.assert_array_equal(attribute(item, "irradiance"), [[3.5] * 3])
    assert item.vmap_show == "LIT"


def test_importing_twice_shares_the_node_group(write):
    path = write("lit.ply", our_ply([[0, 0, 0]]))
    import_points(filepath=path)
    before = data_counts()["node_groups"]
    import_points(filepath=path)
    assert data_counts()["node_groups"] == before <= 1
