# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles of an evaluated mesh, one Part for each of its materials."""

import numpy as np

from ..core.scene_model import Part


def read_parts(mesh, slot_materials):
    """Parts of the mesh; slot_materials: (material index, Surface) of each material slot, at least one."""
    mesh.calc_loop_triangles()
    triangles = mesh.loop_triangles
    count = len(triangles)
    if not count:
        return []
    vertices = _ints(triangles, "vertices", 3 * count).reshape(-1, 3)
    slots = np.minimum(_ints(triangles, "material_index", count), len(slot_materials) - 1)
    positions = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", positions)
    positions = positions.reshape(-1, 3)

    parts = []
    for slot in np.unique(slots):
        chosen = slots == slot
        material, surface = slot_materials[slot]
        lookups = [color.texture for color in (surface.albedo, surface.emission)]
        if any(lookups) or surface.albedo.attribute:
            loops = _ints(triangles, "loops", 3 * count).reshape(-1, 3)[chosen].reshape(-1)
            part = Part(material, positions[vertices[chosen].reshape(-1)], np.arange(len(loops)).reshape(-1, 3))
            part.uvs, part.emission_uvs = (_uvs(mesh, texture, loops) for texture in lookups)
            part.colors = _colors(mesh, surface.albedo.attribute, loops, vertices[chosen].reshape(-1))
        else:
            used, numbers = np.unique(vertices[chosen], return_inverse=True)
            part = Part(material, positions[used], numbers.reshape(-1, 3))
        parts.append(part)
    return parts


def _ints(collection, name, count):
    values = np.empty(count, np.int32)
    collection.foreach_get(name, values)
    return values


def _uvs(mesh, texture, loops):
    if texture is None:
        return None
    layers = mesh.uv_layers
    layer = layers.get(texture.uv_map) if texture.uv_map else next((u for u in layers if u.active_render), None)
    if layer is None:
        return np.zeros((len(loops), 2), np.float32)
    uvs = np.empty(2 * len(layer.data), np.float32)
    layer.data.foreach_get("uv", uvs)
    uvs = uvs.reshape(-1, 2)[loops]
    if texture.mapping:
        location, rotation, scale = texture.mapping
        cos, sin = np.cos(rotation[2]), np.sin(rotation[2])
        uvs = uvs * scale[:2] @ np.array([[cos, sin], [-sin, cos]]) + location[:2]
    return uvs.astype(np.float32)


def _colors(mesh, name, loops, vertices):
    """Linear colors of an attribute at these corners; an attribute that the mesh lacks is black, as in Cycles."""
    if not name:
        return None
    attribute = mesh.attributes.get(name)
    colors = np.zeros((len(loops), 4), np.float32)
    colors[:, 3] = 1
    if attribute is None or attribute.domain not in {"POINT", "CORNER"}:
        return colors
    rows = loops if attribute.domain == "CORNER" else vertices
    count = len(attribute.data)
    if attribute.data_type in {"FLOAT_COLOR", "BYTE_COLOR"}:
        values = np.empty(4 * count, np.float32)
        attribute.data.foreach_get("color", values)
        colors[:, :3] = values.reshape(-1, 4)[rows, :3]
    elif attribute.data_type == "FLOAT_VECTOR":
        values = np.empty(3 * count, np.float32)
        attribute.data.foreach_get("vector", values)
        colors[:, :3] = values.reshape(-1, 3)[rows]
    return colors
