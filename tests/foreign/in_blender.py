# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside Blender: in_blender.py -- SAMPLES OUTPUT.json"""

import json
import os
import sys
import traceback
from pathlib import Path

import bpy
import numpy

if not hasattr(numpy, "bool"):
    numpy.bool = bool  # Blender 3.4's glTF importer asks for it, Debian 12's numpy no longer has it


def imported(operator, path):
    """World positions of the vertices of what an operator imports."""
    bpy.ops.object.select_all(action="DESELECT")
    before = set(bpy.data.objects)
    operator(filepath=str(path))
    (new,) = [o for o in bpy.data.objects if o not in before and o.type == "MESH"]
    bpy.context.view_layer.update()
    places = [list(new.matrix_world @ vertex.co) for vertex in new.data.vertices]
    bpy.data.objects.remove(new)
    return places


def import_ply(filepath):
    """The name of the operator changed with Blender 4."""
    operator = bpy.ops.wm.ply_import if hasattr(bpy.types, "WM_OT_ply_import") else bpy.ops.import_mesh.ply
    operator(filepath=filepath)


def import_volume(path):
    bpy.ops.object.volume_import(filepath=str(path), align="WORLD", location=(0, 0, 0))
    volume = bpy.context.object
    volume.data.grids.load()
    bpy.context.view_layer.update()
    return volume


def shell_of(volume):
    """World positions of the surface around the voxels where the density is one."""
    thing = bpy.data.objects.new("shell", bpy.data.meshes.new("shell"))
    bpy.context.scene.collection.objects.link(thing)
    modifier = thing.modifiers.new("shell", "VOLUME_TO_MESH")
    modifier.object = volume
    modifier.grid_name = "density"
    modifier.threshold = 0.5
    evaluated = thing.evaluated_get(bpy.context.evaluated_depsgraph_get())
    places = [list(vertex.co) for vertex in evaluated.to_mesh().vertices]
    bpy.data.objects.remove(thing)
    return places


def glow(volume):
    """Emission by the grid's irradiance."""
    material = bpy.data.materials.new("glow")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    attribute = nodes.new("ShaderNodeAttribute")
    attribute.attribute_name = "irradiance"
    emission = nodes.new("ShaderNodeEmission")
    output = nodes.new("ShaderNodeOutputMaterial")
    material.node_tree.links.new(attribute.outputs["Color"], emission.inputs["Color"])
    material.node_tree.links.new(emission.outputs["Emission"], output.inputs["Volume"])
    volume.data.materials.append(material)


def render(folder):
    """Pixels of a small picture of the whole from above."""
    scene = bpy.context.scene
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.type = "ORTHO"
    camera.data.ortho_scale = 4
    camera.location = (2, -1, 10)
    scene.collection.objects.link(camera)
    scene.camera = camera
    scene.world.use_nodes = False
    scene.world.color = (0, 0, 0)
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 16
    scene.cycles.use_denoising = False
    scene.render.resolution_x, scene.render.resolution_y = 32, 16
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.render.filepath = str(folder / "render.exr")
    bpy.ops.render.render(write_still=True)
    pixels = list(bpy.data.images.load(scene.render.filepath).pixels)
    return [pixels[i : i + 3] for i in range(0, len(pixels), 4)]


def main(samples, output):
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    seen = {
        "ply": imported(import_ply, samples / "lit.ply"),
        "glb": imported(bpy.ops.import_scene.gltf, samples / "lit.glb"),
        "gltf": imported(bpy.ops.import_scene.gltf, samples / "lit.gltf"),
        "exr": list(bpy.data.images.load(str(samples / "picture.exr")).pixels),
        "png size": list(bpy.data.images.load(str(samples / "picture.png")).size),
    }
    volume = import_volume(samples / "lit.vdb")
    seen["grids"] = [grid.name for grid in volume.data.grids]
    seen["shell"] = shell_of(volume)
    glow(volume)
    seen["render"] = render(output.parent)
    output.write_text(json.dumps(seen))


if __name__ == "__main__":
    status = 0
    try:
        main(*(Path(argument) for argument in sys.argv[sys.argv.index("--") + 1 :]))
    except Exception:
        traceback.print_exc()
        status = 1
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)  # Blender can hang or crash on its own way out
