# SPDX-License-Identifier: GPL-3.0-or-later
"""What the tests in Blender share: pictures by Cycles, volumes, small scenes."""

import json
import os
import subprocess
import textwrap
from pathlib import Path

import bpy
import numpy as np
import pytest
from vmap.shell.compat import node_tree_of

ROOT = Path(__file__).resolve().parents[2]


def data_counts():
    names = ("objects", "meshes", "pointclouds", "volumes", "materials", "node_groups", "collections", "scenes", "worlds",
             "cameras", "lights", "images")  # fmt: skip
    counts = {name: len(getattr(bpy.data, name)) for name in names if hasattr(bpy.data, name)}
    counts["images"] -= "Render Result" in bpy.data.images  # Blender's own, for whatever is rendered
    return counts


def use_cycles(scene, samples=16):
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_denoising = False
    scene.cycles.use_adaptive_sampling = False
    if hasattr(scene.cycles, "volume_biased"):
        scene.cycles.volume_biased = True
    scene.view_settings.view_transform = "Standard"


def look(scene, position, target, ortho=None, fov=None):
    """A camera at a position that looks at a target; ortho: width of what it sees."""
    from mathutils import Vector

    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    scene.collection.objects.link(camera)
    camera.location = position
    direction = Vector(target) - Vector(position)
    camera.rotation_euler = direction.to_track_quat("-Z", "Y").to_euler()
    if ortho:
        camera.data.type, camera.data.ortho_scale = "ORTHO", ortho
    if fov:
        camera.data.angle = fov
    scene.camera = camera
    return camera


def render(scene, folder, width, height=None):
    """(height, width, 4) linear floats, rows from the top."""
    path = os.path.join(str(folder), "render.exr")
    settings = scene.render
    settings.resolution_x, settings.resolution_y, settings.resolution_percentage = width, height or width, 100
    settings.image_settings.file_format = "OPEN_EXR"
    settings.image_settings.color_mode = "RGBA"
    settings.image_settings.color_depth = "32"
    settings.filepath = path
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(path, check_existing=False)
    pixels = np.empty(image.size[0] * image.size[1] * 4, np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(image.size[1], image.size[0], 4)[::-1].copy()
    bpy.data.images.remove(image)
    return pixels


def write_vdb(path, irradiance=3.5, voxels=16, voxel=0.125, density=True, metadata=None, name="irradiance"):
    """A cube of voxels around the origin, by Debian's OpenVDB module in a process of its own.

    As in our files the irradiance reaches two voxels further than the density.
    """
    script = textwrap.dedent(f"""
        import pyopenvdb as vdb, numpy as np
        n, grids = {voxels}, []
        transform = vdb.createLinearTransform(voxelSize={voxel})
        transform.translate((-n * {voxel} / 2 + {voxel} / 2,) * 3)
        def grid(kind, values, name, corner):
            g = kind(); g.copyFromArray(values, ijk=(corner,) * 3); g.name = name; g.gridClass = vdb.GridClass.FOG_VOLUME
            g.transform = transform
            for key, value in {metadata or {}!r}.items(): g[key] = value
            grids.append(g)
        if {density}: grid(vdb.FloatGrid, np.ones((n,) * 3, np.float32), "density", 0)
        field = np.empty((n + 4,) * 3 + (3,), np.float32); field[:] = {irradiance!r}
        grid(vdb.Vec3SGrid, field, {name!r}, -2)
        vdb.write({str(path)!r}, grids)
    """)
    subprocess.run(["/usr/bin/python3", "-c", script], check=True, capture_output=True, timeout=60)
    return str(path)


def has_openvdb():
    return subprocess.run(["/usr/bin/python3", "-c", "import pyopenvdb"], capture_output=True).returncode == 0


def diffuse(name, color, emission=0.0):
    """A Diffuse material; emission adds an Emission shader of that radiance in white."""
    material = bpy.data.materials.new(name)
    tree = node_tree_of(material)
    tree.nodes.clear()
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    shader = tree.nodes.new("ShaderNodeBsdfDiffuse")
    shader.inputs["Color"].default_value = (*color, 1)
    if emission:
        shader = tree.nodes.new("ShaderNodeEmission")
        shader.inputs["Strength"].default_value = emission
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def add_mesh(scene, name, vertices, faces, material=None):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    mesh.update()
    item = bpy.data.objects.new(name, mesh)
    scene.collection.objects.link(item)
    if material:
        mesh.materials.append(material)
    return item


def add_plane(scene, name, size=2.0, z=0.0, material=None):
    h = size / 2
    return add_mesh(scene, name, [(-h, -h, z), (h, -h, z), (h, h, z), (-h, h, z)], [(0, 1, 2, 3)], material)


def add_cube(scene, name, size=2.0, material=None):
    h = size / 2
    vertices = [(x, y, z) for x in (-h, h) for y in (-h, h) for z in (-h, h)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return add_mesh(scene, name, vertices, faces, material)


def add_light(scene, name, kind, energy, location=(0, 0, 0), rotation=(0, 0, 0), **values):
    """A lamp without size and angle unless values say otherwise."""
    lamp = bpy.data.lights.new(name, kind)
    lamp.energy = energy
    if kind in {"POINT", "SPOT"}:
        lamp.shadow_soft_size = 0
    if kind == "SUN":
        lamp.angle = 0
    if kind == "SPOT":
        lamp.spot_blend = 0
    for key, value in values.items():
        setattr(lamp, key, value)
    item = bpy.data.objects.new(name, lamp)
    item.location, item.rotation_euler = location, rotation
    scene.collection.objects.link(item)
    return item


def light_cornell(folder, *options):
    """Folder with lit.ply, lit.glb, lit.vdb and lit.exr of the Cornell box in scenes/, and its glTF document."""
    scene = ROOT / "scenes" / "cornell_box.gltf"
    program = os.environ["VMAP_PROGRAM"]
    if not os.access(program, os.X_OK):
        pytest.skip(f"SKIPPED: no program at {program}")
    outputs = [word for name in ("lit.ply", "lit.glb", "lit.vdb", "lit.exr") for word in ("-o", str(folder / name))]
    command = [program, "light", str(scene), *outputs, "--points", "200000", *options]
    subprocess.run(command, check=True, capture_output=True, timeout=120)
    return folder, json.loads(scene.read_text())


def cornell_camera(scene, document):
    node = next(n for n in document["nodes"] if "camera" in n)
    x, y, z = node["translation"]
    return look(scene, (x, -z, y), (x, -z + 1, y), fov=document["cameras"][0]["perspective"]["yfov"])
