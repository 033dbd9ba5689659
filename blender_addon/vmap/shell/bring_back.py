# SPDX-License-Identifier: GPL-3.0-or-later
"""Light from a lit cloud onto the meshes that it was sampled from, as the attribute "irradiance" (W/m^2, linear).

A vector, not a color: a color attribute would become the albedo of the next export by Blender's own glTF exporter.
"""

import numpy as np
from mathutils.kdtree import KDTree

from ..core.transfer import fit_values
from .compat import fill

NAME = "irradiance"
NEIGHBORS = 24


def light_on_meshes(context, cloud, face_ranges, domain, report):
    """Writes the attribute on every mesh object that the scene shows as itself.

    face_ranges: (object's name, first face, end) of what was sampled; report: called with one line for each object that
    is left out. Returns the objects written. Nothing is written unless all values are there.
    """
    depsgraph = context.evaluated_depsgraph_get()
    values = []
    for item, begin, end in _targets(context, face_ranges, report):
        own = (cloud.face_id >= begin) & (cloud.face_id < end)
        if not own.any():
            report(f"{item.name}: no points lie on it")
            continue
        values.append((item, _corner_values(item, depsgraph, cloud, own)))
    for item, corners in values:
        _write(item.data, corners, domain)
    return [item for item, _ in values]


def _targets(context, face_ranges, report):
    """Objects with their faces; an object may be there once, and its mesh too."""
    shown = {}
    for source, begin, end in face_ranges:
        if source:
            shown.setdefault(source, []).append((begin, end))
    items = [item for item in context.scene.objects if item.name in shown]
    for item in items:
        sharing = [other.name for other in items if other.data == item.data]
        if item.type != "MESH":
            report(f"{item.name}: only meshes can keep light, this is a {item.type.lower()}")
        elif len(sharing) > 1:
            report(
                f"{item.name}: its mesh is shared by {len(sharing)} objects; make it single-user (Object > Relations)"
            )
        elif item.data.library is not None:
            report(f"{item.name}: its mesh is linked from another file")
        else:
            yield item, *shown[item.name][0]


def _corner_values(item, depsgraph, cloud, own):
    """(corners, 3) irradiance at the corners of the object's mesh."""
    mesh = item.data
    evaluated = item.evaluated_get(depsgraph)
    # Where modifiers only move vertices the moved ones count; where they make others the mesh's own must do.
    shape = evaluated.data if len(evaluated.data.vertices) == len(mesh.vertices) else mesh
    positions = _get(shape.vertices, "co", 3)
    vertex_of_corner = _get(mesh.loops, "vertex_index", 1, np.int32).ravel()
    polygon_of_corner = np.repeat(np.arange(len(mesh.polygons)), _get(mesh.polygons, "loop_total", 1, np.int32).ravel())
    polygons = shape.polygons if len(shape.polygons) == len(mesh.polygons) else mesh.polygons
    normals = _get(polygons, "normal", 3)[polygon_of_corner]

    world = np.array(evaluated.matrix_world, np.float64)
    middle = cloud.positions[own].mean(axis=0)  # small numbers for the tree
    origin = np.array(cloud.offset) + middle
    targets = (positions @ world[:3, :3].T + (world[:3, 3] - origin)).astype(np.float32)
    turned = normals @ np.linalg.pinv(world[:3, :3])
    turned = (turned / np.maximum(np.linalg.norm(turned, axis=1, keepdims=True), 1e-30)).astype(np.float32)

    points = cloud.positions[own] - middle
    near, distances = _nearest(points, targets)
    return fit_values(targets[vertex_of_corner], turned, near[vertex_of_corner], distances[vertex_of_corner], points,
                      cloud.normals[own], cloud.irradiance[own])  # fmt: skip


def _nearest(points, targets):
    """Numbers and distances of the nearest points, (targets, k); -1 where there are fewer."""
    tree = KDTree(len(points))
    for number, point in enumerate(points.tolist()):
        tree.insert(point, number)
    tree.balance()
    count = min(NEIGHBORS, len(points))
    near = np.full((len(targets), count), -1, np.int64)
    distances = np.zeros((len(targets), count), np.float32)
    for row, target in enumerate(targets.tolist()):
        found = tree.find_n(target, count)
        near[row, : len(found)] = [entry[1] for entry in found]
        distances[row, : len(found)] = [entry[2] for entry in found]
    return near, distances


def _write(mesh, corners, domain):
    values = corners
    if domain == "POINT":
        vertices = _get(mesh.loops, "vertex_index", 1, np.int32).ravel()
        counts = np.maximum(np.bincount(vertices, minlength=len(mesh.vertices)), 1)
        sums = [np.bincount(vertices, corners[:, c], len(mesh.vertices)) for c in range(3)]
        values = np.stack(sums, axis=1) / counts[:, None]
    attribute = mesh.attributes.get(NAME)
    if attribute is not None and (attribute.domain, attribute.data_type) != (domain, "FLOAT_VECTOR"):
        mesh.attributes.remove(attribute)
        attribute = None
    attribute = attribute or mesh.attributes.new(NAME, "FLOAT_VECTOR", domain)
    fill(attribute.data, "vector", np.ascontiguousarray(values, np.float32))
    mesh.update_tag()


def _get(collection, name, width, dtype=np.float32):
    values = np.empty(len(collection) * width, dtype)
    collection.foreach_get(name, values)
    return values.reshape(-1, width)
