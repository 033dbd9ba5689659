# SPDX-License-Identifier: GPL-3.0-or-later
import math

import bpy
import numpy as np
import pytest
from blender_helpers import add_plane, has_openvdb, look, render, use_cycles, write_vdb
from mathutils import Vector
from vmap.shell.compat import HAS_SAMPLE_GRID

pytestmark = pytest.mark.skipif(not has_openvdb(), reason="SKIPPED: needs Debian's python3-openvdb to make the files")


def import_volume(**arguments):
    assert bpy.ops.vmap.import_volume(**arguments) == {"FINISHED"}
    return bpy.context.view_layer.objects.active


def center(pixels):
    height, width = pixels.shape[:2]
    return pixels[height // 2 - 2 : height // 2 + 2, width // 2 - 2 : width // 2 + 2, :3].mean(axis=(0, 1))


@pytest.mark.parametrize("thickness", [0.25, 1.0])
def test_irradiance_shows_rightly_whatever_the_thickness(tmp_path, empty_scene, thickness):
    path = write_vdb(tmp_path / "lit.vdb", irradiance=(3.5, 7, 0), metadata={"exposure": 2.0})
    item = import_volume(filepath=path)
    item.scale.z = thickness
    use_cycles(empty_scene, 64)
    look(empty_scene, (0, 0, 5), (0, 0, 0), ortho=1.5)
    shown = center(render(empty_scene, tmp_path, 16))
    np.testing.assert_allclose(shown, np.array([3.5, 7, 0]) * 2 / math.pi, rtol=0.02, atol=1e-4)


def test_y_up_stands_upright(tmp_path):
    item = import_volume(filepath=write_vdb(tmp_path / "lit.vdb", metadata={"up": "y"}))
    turned = item.matrix_basis.to_3x3() @ Vector((1, 2, 3))
    np.testing.assert_allclose(turned, (1, -3, 2), atol=1e-6)


def test_numbered_files_are_a_sequence(tmp_path, empty_scene):
    for frame, value in ((3, 1.0), (4, 2.0)):
        write_vdb(tmp_path / f"lit_{frame:04d}.vdb", irradiance=(value,) * 3)
    files = [{"name": "lit_0003.vdb"}, {"name": "lit_0004.vdb"}]
    item = import_volume(directory=str(tmp_path), files=files)
    assert item.data.is_sequence
    use_cycles(empty_scene, 16)
    look(empty_scene, (0, 0, 5), (0, 0, 0), ortho=1.0)
    for frame, value in ((3, 1.0), (4, 2.0)):
        empty_scene.frame_set(frame)
        shown = center(render(empty_scene, tmp_path, 8))
        np.testing.assert_allclose(shown, [value / math.pi] * 3, rtol=0.02)


@pytest.mark.parametrize("name,values,text", [
    ("plain.vdb", {"name": "velocity"}, 'its grids are "density", "velocity"'),
    ("alone.vdb", {"density": False}, 'expected grids "density" and "irradiance"'),
])  # fmt: skip
def test_other_grids_are_named(tmp_path, nothing_left, name, values, text):
    path = write_vdb(tmp_path / name, **values)
    with pytest.raises(RuntimeError, match=text):
        bpy.ops.vmap.import_volume(filepath=path)


def test_bad_files_are_errors_and_leave_nothing(tmp_path, write, nothing_left):
    whole = open(write_vdb(tmp_path / "lit.vdb"), "rb").read()
    for name, data in (("empty.vdb", b""), ("foreign.vdb", b"ply\nformat"), ("cut.vdb", whole[: len(whole) // 2])):
        with pytest.raises(RuntimeError, match=name):
            bpy.ops.vmap.import_volume(filepath=write(name, data))


def test_a_mesh_is_lit_from_the_volume(tmp_path, empty_scene):
    plane = add_plane(empty_scene, "plane", size=1.0)
    item = import_volume(filepath=write_vdb(tmp_path / "lit.vdb", irradiance=(3.5, 7, 0)))
    plane.select_set(True)
    item.select_set(True)
    if not HAS_SAMPLE_GRID:
        with pytest.raises(RuntimeError, match="4.2 and later"):
            bpy.ops.vmap.light_mesh()
        return
    assert bpy.ops.vmap.light_mesh() == {"FINISHED"}
    shape = plane.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    values = np.array([v.vector for v in shape.attributes["irradiance"].data])
    np.testing.assert_allclose(values, [[3.5, 7, 0]] * 4, rtol=1e-5)

    item.hide_render = True
    use_cycles(empty_scene, 4)
    look(empty_scene, (0, 0, 5), (0, 0, 0), ortho=0.5)
    shown = center(render(empty_scene, tmp_path, 8))
    np.testing.assert_allclose(shown, np.array([3.5, 7, 0]) / math.pi, rtol=1e-3, atol=1e-5)
    assert bpy.ops.vmap.light_mesh() == {"FINISHED"} and len(plane.modifiers) == 1


@pytest.mark.skipif(not HAS_SAMPLE_GRID, reason="this Blender has no Sample Grid node")
def test_lighting_a_mesh_says_what_must_be_selected(empty_scene):
    add_plane(empty_scene, "plane").select_set(True)
    with pytest.raises(RuntimeError, match="0 volumes and 1 meshes are selected"):
        bpy.ops.vmap.light_mesh()
