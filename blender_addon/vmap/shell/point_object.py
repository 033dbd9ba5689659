# SPDX-License-Identifier: GPL-3.0-or-later
"""Lit points as a Blender object: a PointCloud where Blender can make one, else a mesh of vertices with Geometry Nodes
that show them as points, or as small squares where EEVEE draws no points."""

import bpy
import numpy as np

from .compat import fill, point_clouds_resize, set_input
from .point_material import point_material
from .point_nodes import points_group

MODIFIER_NAME = "vmap points"
# The radius in a file is that of the disc with the point's area. Shown at that size, evenly spread points leave holes:
# a place can be 1.6 such radii away from the nearest point.
SHOWN_SIZE = 1.65
# Name of the array in a Cloud -> name, type and property of the attribute. "normal" is taken in some versions.
ATTRIBUTES = {
    "irradiance": ("irradiance", "FLOAT_VECTOR", "vector"),
    "albedo": ("albedo", "FLOAT_VECTOR", "vector"),
    "emission": ("emission", "FLOAT_VECTOR", "vector"),
    "normals": ("nrm", "FLOAT_VECTOR", "vector"),
    "radius": ("radius", "FLOAT", "value"),
    "area": ("area", "FLOAT", "value"),
    "face_id": ("face_id", "INT", "value"),
    "material_id": ("material_id", "INT", "value"),
}


def point_object(context, cloud, name, exposure=0.0, way="", as_mesh=False):
    """A new object, linked and selected; exposure 0: what the file suggests; way: see point_material.WAYS."""
    item = None
    if point_clouds_resize() and not as_mesh:
        data = bpy.data.pointclouds.new(name)
        data.resize(len(cloud))
        fill_geometry(data, cloud)
        item = bpy.data.objects.new(name, data)
        context.collection.objects.link(item)
    else:
        data = bpy.data.meshes.new(name)
        fill_geometry(data, cloud)
        item = bpy.data.objects.new(name, data)
        context.collection.objects.link(item)
        if not as_mesh:
            _convert(context, item)

    has = {key for key, _ in cloud.arrays()}
    material = point_material(name, has, exposure or cloud.exposure, way or _first_way(cloud))
    item.data.materials.append(material)
    modifier = item.modifiers.new(MODIFIER_NAME, "NODES")
    modifier.node_group = points_group(item.type, "normals" in has)
    set_input(modifier, "Material", material)
    set_input(modifier, "Size", SHOWN_SIZE)
    item.location = cloud.offset
    item["vmap_offset"] = cloud.offset  # doubles: a location has seven digits only
    for key, value in cloud.info.items():
        item["vmap_" + key] = value
    return item


def _first_way(cloud):
    if cloud.irradiance is not None or cloud.emission is not None:
        return "LIT"
    return "ALBEDO" if cloud.albedo is not None else "NORMALS"


def fill_geometry(data, cloud):
    """Puts the points into a mesh or a PointCloud of the right size; a mesh is emptied first."""
    if isinstance(data, bpy.types.Mesh):
        data.clear_geometry()
        data.vertices.add(len(cloud))
    position = data.attributes.get("position")
    if position is not None:
        fill(position.data, "vector", cloud.positions)
    else:
        fill(data.vertices, "co", cloud.positions)
    for key, array in cloud.arrays():
        if key in ATTRIBUTES:
            name, kind, field = ATTRIBUTES[key]
            attribute = data.attributes.get(name) or data.attributes.new(name, kind, "POINT")
            fill(attribute.data, field, np.ascontiguousarray(array))
    data.update_tag()


def _convert(context, item):
    """Turns the mesh object into a PointCloud object where this Blender can; leaves it alone elsewhere."""
    targets = bpy.ops.object.convert.get_rna_type().properties["target"].enum_items.keys()
    if "POINTCLOUD" not in targets:
        return
    selected, active = list(context.selected_objects), context.view_layer.objects.active
    for other in selected:
        other.select_set(False)
    item.select_set(True)
    context.view_layer.objects.active = item
    mesh = item.data
    try:
        with context.temp_override(
            active_object=item, object=item, selected_objects=[item], selected_editable_objects=[item]
        ):
            bpy.ops.object.convert(target="POINTCLOUD")
    except RuntimeError:
        pass  # it stays a mesh
    if item.data != mesh and mesh.users == 0:
        bpy.data.meshes.remove(mesh)
    item.select_set(False)
    for other in selected:
        other.select_set(True)
    context.view_layer.objects.active = active
