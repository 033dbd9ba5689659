# SPDX-License-Identifier: GPL-3.0-or-later
"""The world's light: a plain color as numbers; an HDRI as its own pixels, turned; anything else (sky texture, mixtures)
as a panorama that Cycles draws."""

import math

import bpy
import numpy as np

from ..core.exr_writer import write_exr
from .compat import uses_nodes

WIDTH = 1024  # of a drawn panorama
SAMPLES = 16


def read_world(scene, source, path, with_sky=True):
    """Sets scene.sky; a panorama is written to the path, an EXR whose centre looks along +X and whose top is up."""
    world = source.world
    if world is None:
        return
    color = _plain_color(world)
    if color is not None and max(color) <= 0:
        return
    if not with_sky:
        scene.skip("light of the world (this version of the program has no --sky)", world.name)
        return
    if color is not None:
        scene.sky = ",".join(repr(c) for c in color)
        return
    pixels = _environment_pixels(world)
    if pixels is not None:
        write_exr(path, pixels)
    elif not _draw_panorama(world, path):
        scene.skip("nodes of the world (Cycles is not there to draw them)", world.name)
        return
    scene.sky = path


def _plain_color(world):
    """(r, g, b) of the world, or None when its nodes say something else."""
    if not uses_nodes(world):
        return tuple(float(c) for c in world.color)
    node = _surface_node(world)
    if node is None:
        return (0.0, 0.0, 0.0)
    if node.type != "BACKGROUND" or node.inputs["Color"].is_linked or node.inputs["Strength"].is_linked:
        return None
    strength = node.inputs["Strength"].default_value
    return tuple(float(c) * strength for c in node.inputs["Color"].default_value[:3])


def _surface_node(world):
    output = world.node_tree.get_output_node("CYCLES") or world.node_tree.get_output_node("ALL")
    return _source(output.inputs["Surface"]) if output else None


def _source(socket):
    return socket.links[0].from_node if socket.is_linked and socket.links else None


def _environment_pixels(world):
    """(height, width, 3) radiance, rows from the top, of a world that is one equirectangular image; None for others."""
    background = _surface_node(world)
    if background.type != "BACKGROUND" or background.inputs["Strength"].is_linked:
        return None
    texture = _source(background.inputs["Color"])
    if texture is None or texture.type != "TEX_ENVIRONMENT" or texture.projection != "EQUIRECTANGULAR":
        return None
    turn = _turn_about_z(texture.inputs["Vector"])
    image = texture.image
    if turn is None or image is None or not image.is_float or image.channels < 3:
        return None
    width, height = image.size
    values = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(values)
    values = values.reshape(height, width, image.channels)[::-1, :, :3] * background.inputs["Strength"].default_value
    # A direction at the angle a is looked up at a + turn; angles fall from left to right.
    shift = turn / (2 * math.pi) * width
    whole = math.floor(shift)
    part = np.float32(shift - whole)
    return np.roll(values, whole, axis=1) * (1 - part) + np.roll(values, whole + 1, axis=1) * part


def _turn_about_z(socket):
    """Angle by which a Mapping node turns directions about Z; None for anything else that it does."""
    node = _source(socket)
    if node is None:
        return 0.0
    if node.type == "TEX_COORD":
        return 0.0 if socket.links[0].from_socket.name == "Generated" else None
    if node.type != "MAPPING" or node.vector_type not in {"POINT", "VECTOR"}:
        return None
    location, rotation, scale = (node.inputs[name] for name in ("Location", "Rotation", "Scale"))
    simple = not any(s.is_linked for s in (location, rotation, scale)) and tuple(scale.default_value) == (1, 1, 1)
    moved = node.vector_type == "POINT" and any(location.default_value)
    if not simple or moved or any(rotation.default_value[:2]) or _turn_about_z(node.inputs["Vector"]) != 0:
        return None
    return rotation.default_value[2]


def _draw_panorama(world, path):
    """Renders the world alone; False without Cycles."""
    scene = bpy.data.scenes.new("vmap world")
    camera = bpy.data.objects.new("vmap world", bpy.data.cameras.new("vmap world"))
    try:
        try:
            scene.render.engine = "CYCLES"
        except TypeError:
            return False
        scene.world = world
        scene.collection.objects.link(camera)
        scene.camera = camera
        camera.rotation_euler = (math.pi / 2, 0, -math.pi / 2)  # looks along +X, up is up
        _set_lens(camera.data)
        scene.cycles.device = "CPU"
        scene.cycles.samples = SAMPLES
        scene.cycles.use_denoising = scene.cycles.use_adaptive_sampling = False
        scene.cycles.pixel_filter_type = "BOX"
        scene.cycles.filter_width = 1
        render = scene.render
        render.resolution_x, render.resolution_y, render.resolution_percentage = WIDTH, WIDTH // 2, 100
        render.film_transparent = False
        render.image_settings.file_format = "OPEN_EXR"
        render.image_settings.color_mode = "RGB"
        render.image_settings.color_depth = "32"
        render.filepath = path
        render.use_file_extension = False
        with bpy.context.temp_override(scene=scene):
            bpy.ops.render.render(write_still=True)
        return True
    finally:
        bpy.data.cameras.remove(camera.data)
        bpy.data.scenes.remove(scene)


def _set_lens(camera):
    camera.type = "PANO"
    owner = camera if hasattr(camera, "panorama_type") else camera.cycles
    owner.panorama_type = "EQUIRECTANGULAR"
