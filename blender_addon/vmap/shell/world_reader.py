# SPDX-License-Identifier: GPL-3.0-or-later
"""The world's light: a plain color as numbers, anything else (HDRI, sky texture, ...) as a panorama that Cycles draws."""

import math

import bpy

from .compat import uses_nodes

WIDTH = 2048
SAMPLES = 4


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
    elif color is not None:
        scene.sky = ",".join(repr(c) for c in color)
    elif _draw_panorama(world, path):
        scene.sky = path
    else:
        scene.skip("nodes of the world (Cycles is not there to draw them)", world.name)


def _plain_color(world):
    """(r, g, b) of the world, or None when its nodes say something else."""
    if not uses_nodes(world):
        return tuple(float(c) for c in world.color)
    output = world.node_tree.get_output_node("CYCLES") or world.node_tree.get_output_node("ALL")
    links = output.inputs["Surface"].links if output else ()
    if not links:
        return (0.0, 0.0, 0.0)
    node = links[0].from_node
    if node.type != "BACKGROUND" or node.inputs["Color"].is_linked or node.inputs["Strength"].is_linked:
        return None
    strength = node.inputs["Strength"].default_value
    return tuple(float(c) * strength for c in node.inputs["Color"].default_value[:3])


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
        bpy.ops.render.render(scene=scene.name, write_still=True)
        return True
    finally:
        bpy.data.cameras.remove(camera.data)
        bpy.data.scenes.remove(scene)


def _set_lens(camera):
    camera.type = "PANO"
    owner = camera if hasattr(camera, "panorama_type") else camera.cycles
    owner.panorama_type = "EQUIRECTANGULAR"
