# SPDX-License-Identifier: GPL-3.0-or-later
"""A lit OpenVDB grid as a Blender volume whose color does not depend on how thick it is.

The volume absorbs within a small part of a voxel and glows so that a ray that is absorbed altogether has gathered
exposure * irradiance / pi: with the extinction s it emits s * irradiance / pi per metre, and the integral of
s exp(-s x) is 1.
"""

import math
import os

import bpy

from ..core.errors import AddonError, FileProblem
from ..core.vdb_header import read_vdb_header
from .compat import node_tree_of
from .point_material import EXPOSURE_NODE

DENSITY, IRRADIANCE = "density", "irradiance"
OPTICAL_DEPTH = 20  # of one voxel
MARK = "vmap_volume"


def volume_object(context, sequence, name, exposure=0.0):
    """A new linked object for one file, or for files that differ in their frame number."""
    path = sequence.paths[0]
    irradiance = checked_grid(path)
    volume = bpy.data.volumes.new(name)
    volume.filepath = path
    if not volume.grids.load():
        raise FileProblem(path, f"Blender cannot read it: {volume.grids.error_message}", "an OpenVDB file")
    voxel = voxel_size(volume)
    if sequence.animated:
        volume.is_sequence = True
        volume.frame_start = sequence.frames[0]
        volume.frame_offset = sequence.frames[0] - 1
        volume.frame_duration = sequence.frames[-1] - sequence.frames[0] + 1
    suggested = irradiance.metadata.get("exposure")
    if not (isinstance(suggested, (int, float)) and suggested > 0):
        suggested = 1.0
    volume.materials.append(volume_material(name, voxel, exposure or suggested))
    item = bpy.data.objects.new(name, volume)
    item[MARK] = True
    if irradiance.metadata.get("up") == "y":
        item.rotation_euler = (math.pi / 2, 0, 0)  # (x, y, z) -> (x, -z, y)
    context.collection.objects.link(item)
    return item


def checked_grid(path):
    """Header of the file's grid "irradiance"; throws AddonError when the file has none that Blender can show."""
    file = read_vdb_header(path)
    grid = file.grid(IRRADIANCE)
    names = ", ".join(f'"{g.name}"' for g in file.grids) or "none"
    if grid is None and any(g.holds_points for g in file.grids):
        raise FileProblem(
            path, "holds OpenVDB points, which no version of Blender shows", "grids, or the points as PLY"
        )
    if grid is None or file.grid(DENSITY) is None:
        raise FileProblem(path, f"its grids are {names}", f'grids "{DENSITY}" and "{IRRADIANCE}" as vmap writes them')
    if "vec3s" not in grid.type:
        raise FileProblem(path, f'the grid "{IRRADIANCE}" is of type {grid.type}', "vectors of floats")
    return grid


def voxel_size(volume):
    """Edge of a voxel of the loaded volume."""
    grid = next((g for g in volume.grids if g.name == IRRADIANCE), None)
    size = grid.matrix_object.to_scale().x if grid else 0
    if not size > 0:
        raise AddonError(f"{os.path.basename(volume.filepath)}: its voxels have no size")
    return size


def volume_material(name, voxel, exposure):
    material = bpy.data.materials.new(name)
    material[MARK] = True
    tree = node_tree_of(material)
    tree.nodes.clear()
    link = tree.links.new

    def node(kind, column, row=0, **values):
        made = tree.nodes.new(kind)
        made.location = (220 * column, -220 * row)
        for key, value in values.items():
            setattr(made, key, value)
        return made

    density = node("ShaderNodeAttribute", 0, attribute_name=DENSITY)
    irradiance = node("ShaderNodeAttribute", 0, 1, attribute_name=IRRADIANCE)
    value = node("ShaderNodeValue", 0, 2, name=EXPOSURE_NODE, label="Exposure")
    value.outputs[0].default_value = exposure
    extinction = node("ShaderNodeMath", 1, operation="MULTIPLY")
    extinction.inputs[1].default_value = OPTICAL_DEPTH / voxel
    shown = node("ShaderNodeMath", 1, 2, operation="MULTIPLY")
    shown.inputs[1].default_value = 1 / math.pi
    strength = node("ShaderNodeMath", 2, 1, operation="MULTIPLY")
    absorption = node("ShaderNodeVolumeAbsorption", 3)
    absorption.inputs["Color"].default_value = (0, 0, 0, 1)
    glow = node("ShaderNodeEmission", 3, 1)
    both = node("ShaderNodeAddShader", 4)
    output = node("ShaderNodeOutputMaterial", 5)

    link(density.outputs["Fac"], extinction.inputs[0])
    link(value.outputs[0], shown.inputs[0])
    link(extinction.outputs[0], strength.inputs[0])
    link(shown.outputs[0], strength.inputs[1])
    link(extinction.outputs[0], absorption.inputs["Density"])
    link(irradiance.outputs["Color"], glow.inputs["Color"])
    link(strength.outputs[0], glow.inputs["Strength"])
    link(absorption.outputs[0], both.inputs[0])
    link(glow.outputs[0], both.inputs[1])
    link(both.outputs[0], output.inputs["Volume"])
    return material
