# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights a mesh from a lit volume: Geometry Nodes read the grid "irradiance" at each vertex (Blender 4.2 and later)."""

import bpy

from .compat import HAS_SAMPLE_GRID, new_socket, set_input
from .datablocks import all_or_nothing
from .point_material import point_material
from .volume_object import IRRADIANCE

GROUP_NAME = "vmap light from volume"


class VMAP_OT_light_mesh(bpy.types.Operator):
    """Light the selected meshes from the selected lit volume: adds a modifier that reads it at each vertex"""

    bl_idname = "vmap.light_mesh"
    bl_label = "Light meshes from volume"
    bl_options = {"REGISTER", "UNDO"}

    exposure: bpy.props.FloatProperty(name="Exposure", description="Factor for the light on display", min=0, default=1)

    def execute(self, context):
        if not HAS_SAMPLE_GRID:
            self.report({"ERROR"}, "This version of Blender cannot read volumes in Geometry Nodes; 4.2 and later can")
            return {"CANCELLED"}
        volumes = [item for item in context.selected_objects if item.type == "VOLUME"]
        meshes = [item for item in context.selected_objects if item.type == "MESH"]
        if len(volumes) != 1 or not meshes:
            found = f"{len(volumes)} volumes and {len(meshes)} meshes are selected"
            self.report({"ERROR"}, f"{found}; expected one lit volume and the meshes that it is to light")
            return {"CANCELLED"}
        with all_or_nothing():
            material = point_material("vmap lit surface", {"irradiance"}, self.exposure, "IRRADIANCE")
            for item in meshes:
                light_mesh(item, volumes[0], material)
        return {"FINISHED"}


def light_mesh(item, volume, material):
    """Adds the modifier, or sets it anew when the object has it."""
    modifier = next((m for m in item.modifiers if m.type == "NODES" and _is_ours(m.node_group)), None)
    if modifier is None:
        modifier = item.modifiers.new("vmap light", "NODES")
        modifier.node_group = bpy.data.node_groups.get(GROUP_NAME) or _group()
    set_input(modifier, "Volume", volume)
    set_input(modifier, "Material", material)


def _is_ours(group):
    return group is not None and group.name == GROUP_NAME


def _group():
    """Geometry -> attribute "irradiance" at each vertex, and a material that shows it."""
    group = bpy.data.node_groups.new(GROUP_NAME, "GeometryNodeTree")
    new_socket(group, "Geometry", "NodeSocketGeometry")
    new_socket(group, "Volume", "NodeSocketObject")
    new_socket(group, "Material", "NodeSocketMaterial")
    new_socket(group, "Geometry", "NodeSocketGeometry", is_output=True)

    def node(kind, column, row=0, **values):
        made = group.nodes.new(kind)
        made.location = (220 * column, -220 * row)
        for key, value in values.items():
            setattr(made, key, value)
        return made

    start = node("NodeGroupInput", 0)
    info = node("GeometryNodeObjectInfo", 1, 1, transform_space="RELATIVE")
    grid = node("GeometryNodeGetNamedGrid", 2, 1, data_type="VECTOR")
    grid.inputs["Name"].default_value = IRRADIANCE
    position = node("GeometryNodeInputPosition", 2, 2)
    sample = node("GeometryNodeSampleGrid", 3, 1, data_type="VECTOR")
    store = node("GeometryNodeStoreNamedAttribute", 4, data_type="FLOAT_VECTOR", domain="POINT")
    store.inputs["Name"].default_value = IRRADIANCE
    material = node("GeometryNodeSetMaterial", 5)
    end = node("NodeGroupOutput", 6)

    link = group.links.new
    link(start.outputs["Volume"], info.inputs["Object"])
    link(info.outputs["Geometry"], grid.inputs["Volume"])
    link(next(s for s in grid.outputs if s.name == "Grid" and s.enabled), sample.inputs["Grid"])
    link(position.outputs[0], sample.inputs["Position"])
    link(start.outputs["Geometry"], store.inputs["Geometry"])
    link(sample.outputs["Value"], next(s for s in store.inputs if s.name == "Value" and s.enabled))
    link(store.outputs[0], material.inputs["Geometry"])
    link(start.outputs["Material"], material.inputs["Material"])
    link(material.outputs[0], end.inputs["Geometry"])
    return group


def register():
    bpy.utils.register_class(VMAP_OT_light_mesh)


def unregister():
    bpy.utils.unregister_class(VMAP_OT_light_mesh)
