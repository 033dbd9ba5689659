# SPDX-License-Identifier: GPL-3.0-or-later
"""What the user sees of a lit Cornell box and of a scene of their own, each against another way to draw it.

With the folder VMAP_PICTURES set, the pictures of docs/blender.md are kept there.
"""

import os
from pathlib import Path

import bpy
import numpy as np
import pytest
from blender_helpers import (
    add_cube,
    add_light,
    add_plane,
    cornell_camera,
    diffuse,
    light_cornell,
    look,
    render,
    use_cycles,
)
from mathutils.kdtree import KDTree
from vmap.core.color import srgb_bytes_from_linear
from vmap.core.png import png_bytes
from vmap.core.read_cloud import read_cloud
from vmap.shell.compat import HAS_SAMPLE_GRID

pytestmark = pytest.mark.usefixtures("program")
SIZE = 192


@pytest.fixture(scope="module")
def cornell(tmp_path_factory):
    return light_cornell(tmp_path_factory.mktemp("cornell"), "--size", f"{SIZE}x{SIZE}")


def keep(name, *pictures, exposure=1.0):
    """Pictures side by side as a PNG for the documentation."""
    if "VMAP_PICTURES" in os.environ:
        row = np.concatenate([p[:, :, :3] for p in pictures], axis=1)
        Path(os.environ["VMAP_PICTURES"], name).write_bytes(png_bytes(srgb_bytes_from_linear(row * exposure)))


def median_difference(picture, wanted):
    seen = wanted[:, :, :3].sum(axis=2) > 1e-3
    mean = wanted[seen][:, :3].mean(axis=1)
    return float(np.median(np.abs(picture - wanted)[seen][:, :3].mean(axis=1) / mean))


def test_the_lit_cloud_looks_as_the_program_renders_it(cornell, empty_scene, tmp_path):
    folder, document = cornell
    bpy.ops.vmap.import_points(filepath=str(folder / "lit.ply"), exposure=1.0)
    item = bpy.context.object
    use_cycles(empty_scene, 16)
    cornell_camera(empty_scene, document)
    ways = {}
    for way in ("LIT", "IRRADIANCE", "ALBEDO", "NORMALS"):
        item.vmap_show = way
        ways[way] = render(empty_scene, tmp_path, SIZE)
    image = bpy.data.images.load(str(folder / "lit.exr"))
    wanted = np.array(image.pixels[:], np.float32).reshape(SIZE, SIZE, -1)[::-1]
    difference = median_difference(ways["LIT"][:, :, :3], wanted[:, :, :3])
    print(f"\nlit Cornell box: median difference {difference:.4f}")
    keep("blender-points.png", ways["LIT"] * 1.5, ways["IRRADIANCE"] * 1.5, ways["ALBEDO"], ways["NORMALS"])
    assert difference <= 0.02
    # The switch is what it says: lit is irradiance times albedo, away from the lamp and from edges.
    product = ways["IRRADIANCE"] * ways["ALBEDO"]
    assert median_difference(ways["LIT"][:, :, :3], product[:, :, :3]) < 0.01


def test_the_volume_shows_what_the_points_show(cornell, empty_scene, tmp_path):
    folder, document = cornell
    size = 128
    use_cycles(empty_scene, 16)
    cornell_camera(empty_scene, document)
    bpy.ops.vmap.import_points(filepath=str(folder / "lit.ply"), exposure=1.0)
    points = bpy.context.object
    points.vmap_show = "IRRADIANCE"
    wanted = render(empty_scene, tmp_path, size)
    points.hide_render = True
    bpy.ops.vmap.import_volume(filepath=str(folder / "lit.vdb"), exposure=1.0)
    shown = render(empty_scene, tmp_path, size)
    difference = median_difference(shown[:, :, :3], wanted[:, :, :3])
    print(f"\nvolume against points: median difference {difference:.4f}")
    keep("blender-volume.png", wanted * 1.5, shown * 1.5)
    assert difference < 0.05


@pytest.mark.skipif(not HAS_SAMPLE_GRID, reason="this Blender has no Sample Grid node")
def test_a_floor_lit_from_the_volume_agrees_with_the_points(cornell, empty_scene):
    folder, _ = cornell
    cloud = read_cloud(str(folder / "lit.ply"))
    on_floor = np.flatnonzero((np.abs(cloud.positions[:, 2]) < 1e-4) & (cloud.normals[:, 2] > 0.9))
    tree = KDTree(len(on_floor))
    for number in on_floor:
        tree.insert(cloud.positions[number], int(number))
    tree.balance()

    bpy.ops.vmap.import_volume(filepath=str(folder / "lit.vdb"), exposure=1.0)
    volume = bpy.context.object
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=20, y_subdivisions=20, size=4.0)
    floor = bpy.context.object
    volume.select_set(True)
    bpy.ops.vmap.light_mesh()
    shape = floor.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    found = np.array([entry.vector for entry in shape.attributes["irradiance"].data]).mean(axis=1)
    nearest = [tree.find(vertex.co)[1] for vertex in shape.vertices]
    wanted = cloud.irradiance[nearest].mean(axis=1)
    difference = np.abs(found - wanted) / wanted.mean()
    print(f"\nfloor lit from the volume against points: median difference {np.median(difference):.4f}")
    assert np.median(difference) < 0.05


def test_light_this_scene_beside_cycles(empty_scene, tmp_path):
    """A picture of the user's scene by Cycles, and of the cloud that comes back."""
    add_plane(empty_scene, "floor", size=8.0, material=diffuse("floor", (0.6, 0.55, 0.5)))
    for x, size, color in ((-1.2, 1.2, (0.7, 0.15, 0.1)), (1.0, 0.8, (0.15, 0.3, 0.7))):
        cube = add_cube(empty_scene, "cube", size=size, material=diffuse("paint", color))
        cube.location, cube.rotation_euler.z = (x, 0.2 * x, size / 2), 0.5 + x
    add_light(empty_scene, "sun", "SUN", 2.0, rotation=(0.7, -0.5, 0))
    add_light(empty_scene, "lamp", "AREA", 60, (2.2, -1.2, 2.5), (0.4, 0.6, 0), size=0.5)
    use_cycles(empty_scene, 64)
    empty_scene.cycles.sample_clamp_indirect = 0
    look(empty_scene, (0, -6, 4), (0, 0, 0.3), fov=0.7)
    wanted = render(empty_scene, tmp_path, SIZE)
    assert bpy.ops.vmap.light(points=300_000, tolerance=0.02) == {"FINISHED"}
    item = bpy.context.view_layer.objects.active
    for other in empty_scene.objects:
        other.hide_render = other not in (item, empty_scene.camera)
    bpy.context.object.data.materials[0].node_tree.nodes["vmap exposure"].outputs[0].default_value = 1.0
    use_cycles(empty_scene, 16)
    shown = render(empty_scene, tmp_path, SIZE)
    difference = median_difference(shown[:, :, :3], wanted[:, :, :3])
    print(f"\nLight this scene beside Cycles: median difference {difference:.4f}")
    keep("blender-light.png", wanted, shown, exposure=1.0)
    assert difference < 0.04
