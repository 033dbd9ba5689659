# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's lamps: point, spot and sun as lights, area lamps as surfaces that emit, the same watts in and out."""

import math

import bpy
import numpy as np

from ..core.lights import area_radiance, cone_angles, lamp_outline, point_intensity
from ..core.scene_model import Part, Placement, SceneLight, SceneMaterial, SceneMesh
from .compat import uses_nodes

# How Cycles takes a lamp's watts is nowhere to be asked: the one place where the version itself counts.
OLD_LAMPS = bpy.app.version < (4, 0, 0)


def add_lamp(scene, name, lamp, matrix):
    """Adds the lamp (evaluated data) at this world matrix; names what a glTF light cannot say."""
    color = _color(scene, name, lamp)
    power = lamp.energy * 2 ** getattr(lamp, "exposure", 0)
    if power <= 0 or max(color) <= 0:
        if power < 0:
            scene.skip("negative light", name)
        return
    _name_what_is_lost(scene, name, lamp)
    if lamp.type == "AREA":
        _add_area(scene, name, lamp, matrix, color, power)
        return
    matrix = _without_scale(matrix)
    if lamp.type == "SUN":
        if lamp.angle > 0:
            scene.skip("angle of a sun (it counts as infinitely far)", name)
        scene.lights.append(SceneLight("directional", color, power, matrix, None, name))
        return
    if lamp.shadow_soft_size > 0:
        scene.skip("radius of a light (it counts as a point)", name)
    cone = None
    if lamp.type == "SPOT":
        if OLD_LAMPS and lamp.spot_size > math.radians(30):
            scene.skip("cosine by which Cycles before Blender 4.0 dims a spot towards its edge", name)
        if lamp.spot_blend > 0:
            scene.skip("shape of a spot's soft edge (glTF has another)", name)
        cone = cone_angles(lamp.spot_size, lamp.spot_blend)
    scene.lights.append(SceneLight(lamp.type.lower(), color, point_intensity(power), matrix, cone, name))


def _color(scene, name, lamp):
    """Color of the lamp times what its nodes say."""
    color = np.array(lamp.color, np.float64)
    if getattr(lamp, "use_temperature", False):
        color = color * np.array(lamp.temperature_color, np.float64)
    if uses_nodes(lamp):
        output = lamp.node_tree.get_output_node("CYCLES") or lamp.node_tree.get_output_node("ALL")
        links = output.inputs["Surface"].links if output else ()
        node = links[0].from_node if links else None
        if node is None or node.type != "EMISSION" or any(socket.is_linked for socket in node.inputs):
            scene.skip("nodes of a light", name)
        else:
            color = color * np.array(node.inputs["Color"].default_value[:3]) * node.inputs["Strength"].default_value
    return tuple(float(c) for c in color)


def _name_what_is_lost(scene, name, lamp):
    settings = getattr(lamp, "cycles", None)
    casts = getattr(settings, "cast_shadow", True) and getattr(lamp, "use_shadow", True)
    if not casts:
        scene.skip("light without shadows (it casts them here)", name)
    if lamp.type != "AREA" and not getattr(lamp, "normalize", True):
        scene.skip("light whose strength is not normalized", name)


def _add_area(scene, name, lamp, matrix, color, power):
    if getattr(getattr(lamp, "cycles", None), "is_portal", False):
        return
    if getattr(lamp, "spread", math.pi) < math.pi * 0.999:
        scene.skip("spread of an area light (it shines to all sides)", name)
    scene.skip("area light that casts no shadow itself (here it is a surface, which does)", name)
    outline = lamp_outline(lamp.shape, lamp.size, lamp.size_y)[::-1]  # it shines along -z
    corners = np.zeros((len(outline), 3), np.float32)
    corners[:, :2] = outline
    matrix = np.array(matrix, np.float64)
    flat = np.linalg.norm(np.cross(matrix[:3, 0], matrix[:3, 1]))
    x, y = outline.T
    area = flat * abs(float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))) / 2
    if not area > 0:
        scene.skip("area light without size", name)
        return
    shared_by = area if getattr(lamp, "normalize", True) else 1.0
    radiance = area_radiance(power, shared_by, OLD_LAMPS)
    emission = tuple(radiance * c for c in color)
    scene.materials.append(SceneMaterial(f"lamp {name}", (0, 0, 0), emission=emission, double_sided=False))
    fan = np.array([(0, i, i + 1) for i in range(1, len(corners) - 1)])
    scene.meshes.append(SceneMesh(f"lamp {name}", [Part(len(scene.materials) - 1, corners, fan)]))
    scene.placements.append(Placement(len(scene.meshes) - 1, matrix))


def _without_scale(matrix):
    """The place and the direction only: scale does not change a point, spot or sun."""
    matrix = np.array(matrix, np.float64)
    back = matrix[:3, 2] / max(np.linalg.norm(matrix[:3, 2]), 1e-30)
    side = matrix[:3, 0] - back * (matrix[:3, 0] @ back)
    length = np.linalg.norm(side)
    if length < 1e-12:
        side = np.cross(back, [1, 0, 0] if abs(back[0]) < 0.9 else [0, 1, 0])
        length = np.linalg.norm(side)
    side = side / length
    turned = np.eye(4)
    turned[:3, 0], turned[:3, 1], turned[:3, 2], turned[:3, 3] = side, np.cross(back, side), back, matrix[:3, 3]
    return turned
