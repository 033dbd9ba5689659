# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene as the render shows it: modifiers at render level, instances, what is hidden in renders left out.

Only a render engine gets the render's own depsgraph. So a copy of the scene, which shares its objects, is rendered at a
few pixels by an engine that draws nothing and reads everything; the user's scene and its last render stay as they are.
"""

import math
import os
from contextlib import contextmanager

import bpy
import numpy as np

from ..core.errors import AddonError
from ..core.scene_model import Placement, Scene, SceneCamera, SceneMesh
from .lamp_reader import add_lamp
from .material_reader import MaterialReader
from .mesh_reader import read_parts
from .world_reader import read_world

RESULT_MARK = "vmap_result"  # objects that hold results are no part of the scene
NO_SURFACE = {"EMPTY", "ARMATURE", "LATTICE", "CAMERA", "LIGHT_PROBE", "SPEAKER", "LIGHT", "CURVE", "SURFACE", "FONT",
              "META"}  # fmt: skip  # curves and the like come as instances of their mesh


def read_scene(context, frame, folder, selected_only=False, with_sky=True):
    """The Scene at this frame; a panorama of the world, if it needs one, goes to the folder.

    Throws AddonError when nothing is there to light.
    """
    source = context.scene
    chosen = {item.name for item in context.view_layer.objects if item.select_get()} if selected_only else None
    scene = Scene()
    with _copy_of(source, context.view_layer, frame) as copy:
        _read_render(copy, lambda depsgraph: _read(depsgraph, scene, chosen, source))
    if not scene.triangle_count():
        wanted = "a selected object with a surface" if selected_only else "an object with a surface that renders"
        raise AddonError(f"nothing to light in scene {source.name}; expected {wanted}")
    read_world(scene, source, os.path.join(folder, "world.exr"), with_sky)
    return scene


@contextmanager
def _copy_of(source, view_layer, frame):
    """A scene that shares the objects of another, with a camera, ready to be rendered at a few pixels."""
    copy, camera = source.copy(), None
    try:
        copy.frame_current = frame
        render = copy.render
        render.resolution_x = render.resolution_y = 4
        render.resolution_percentage = 100
        render.use_compositing = render.use_sequencer = render.use_border = render.use_multiview = False
        for layer in copy.view_layers:
            layer.use = layer.name == view_layer.name
        if copy.camera is None:
            camera = bpy.data.objects.new("vmap", bpy.data.cameras.new("vmap"))
            copy.collection.objects.link(camera)
            copy.camera = camera
        yield copy
    finally:
        bpy.data.scenes.remove(copy)
        if camera:
            bpy.data.cameras.remove(camera.data)


def _read_render(scene, read):
    """Calls read(depsgraph) from within a render of the scene."""
    failure = []

    class VMAP_RE_reader(bpy.types.RenderEngine):
        bl_idname = "VMAP_READER"
        bl_label = "vmap reader"
        bl_use_preview = False

        def render(self, depsgraph):
            try:
                read(depsgraph)
            except BaseException as error:  # Blender would print and forget it
                failure.append(error)

    bpy.utils.register_class(VMAP_RE_reader)
    try:
        scene.render.engine = VMAP_RE_reader.bl_idname
        # The operator's own argument for a scene would carry the frame of the user's scene over.
        with bpy.context.temp_override(scene=scene):
            bpy.ops.render.render()
    except RuntimeError as error:
        failure.append(AddonError(f"Blender cannot evaluate the scene: {error}"))
    finally:
        bpy.utils.unregister_class(VMAP_RE_reader)
    if failure:
        raise failure[0]


def _read(depsgraph, scene, chosen, source):
    materials, meshes = MaterialReader(scene), {}
    for instance in depsgraph.object_instances:
        if not instance.show_self:
            continue
        item = instance.object
        matrix = np.array(instance.matrix_world, np.float64)
        if not np.isfinite(matrix).all():
            scene.skip("object whose place is not finite", item.name)
        elif item.type == "LIGHT":
            linking = getattr(item, "light_linking", None)
            if linking and (linking.receiver_collection or linking.blocker_collection):
                scene.skip("light linking (the light falls on everything)", item.name)
            add_lamp(scene, item.name, item.data, matrix)
        elif item.type == "MESH":
            _add_mesh(scene, instance, item, matrix, materials, meshes, chosen)
        elif item.type not in NO_SURFACE and RESULT_MARK not in _owner(instance):
            scene.skip(f"{item.type.lower().replace('_', ' ')} object", item.name)
    if source.camera is not None:
        _add_camera(scene, depsgraph, source.render)


def _owner(instance):
    """The object in the user's scene that shows this."""
    return (instance.parent if instance.is_instance and instance.parent else instance.object).original


def _add_mesh(scene, instance, item, matrix, materials, meshes, chosen):
    owner = _owner(instance)
    if RESULT_MARK in owner or (chosen is not None and owner.name not in chosen and item.name not in chosen):
        return
    if not getattr(item, "visible_shadow", True) or not getattr(item, "visible_diffuse", True):
        scene.skip("ray visibility of an object (it is fully visible)", item.name)
    if getattr(item, "is_shadow_catcher", False) or getattr(item, "is_holdout", False):
        scene.skip("shadow catcher or holdout (it is an ordinary object)", item.name)
    slots = tuple(slot.material for slot in item.material_slots) or (None,)
    key = (item.data.as_pointer(), tuple(m.name if m else "" for m in slots))
    if key not in meshes:
        parts = read_parts(item.data, [materials.read(m) for m in slots])
        meshes[key] = None
        if parts:
            scene.meshes.append(SceneMesh(item.data.name, parts))
            meshes[key] = len(scene.meshes) - 1
    if meshes[key] is not None:
        source = "" if instance.is_instance else item.original.name
        scene.placements.append(Placement(meshes[key], matrix, source))


def _add_camera(scene, depsgraph, render):
    camera = depsgraph.scene.camera
    if camera.type != "CAMERA" or camera.data.type == "PANO":
        return
    width, height = render.resolution_x, render.resolution_y
    lens = camera.calc_matrix_camera(depsgraph, x=width, y=height)
    entry = SceneCamera(np.array(camera.matrix_world.normalized(), np.float64), aspect=width / height)
    if camera.data.type == "ORTHO":
        entry.half_height = 1 / lens[1][1]
    else:
        entry.vertical_fov = 2 * math.atan(1 / lens[1][1])
    scene.camera = entry
