# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar of the 3D view."""

import bpy

from .compat import HAS_SAMPLE_GRID, draw_input
from .import_points import VMAP_OT_import_points
from .import_volume import VMAP_OT_import_volume
from .light_mesh import VMAP_OT_light_mesh
from .light_operator import VMAP_OT_cancel, VMAP_OT_light, running
from .point_material import EXPOSURE_NODE, exposure_socket
from .point_object import MODIFIER_NAME
from .scene_settings import shown_material
from .show_meshes import VMAP_OT_show_on_meshes
from .volume_object import MARK as VOLUME_MARK


class _Panel:
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "V-map"


class VMAP_PT_light(_Panel, bpy.types.Panel):
    bl_idname = "VMAP_PT_light"
    bl_label = "Light this scene"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.scene.vmap_light
        run = running()
        if run:
            self._draw_progress(layout, run)
            return
        layout.column().prop(settings, "result")
        if "ATTRIBUTE" in settings.result:
            layout.prop(settings, "domain")
        layout.prop(settings, "tolerance")
        column = layout.column(align=True)
        column.prop(settings, "points")
        column.prop(settings, "spacing")
        layout.prop(settings, "selected_only")
        layout.prop(settings, "use_frames")
        if settings.use_frames:
            column = layout.column(align=True)
            column.prop(settings, "frame_start")
            column.prop(settings, "frame_end")
        if settings.use_frames or "VOLUME" in settings.result:
            layout.prop(settings, "directory")
        layout.prop(settings, "time_limit")
        layout.operator(VMAP_OT_light.bl_idname, icon="LIGHT")

    @staticmethod
    def _draw_progress(layout, run):
        text = run.status()
        if hasattr(layout, "progress"):
            layout.progress(factor=run.overall(), text=text)
        else:
            layout.label(text=f"{100 * run.overall():.0f} %  {text}")
        layout.operator(VMAP_OT_cancel.bl_idname, icon="CANCEL")


class VMAP_PT_show(_Panel, bpy.types.Panel):
    bl_idname = "VMAP_PT_show"
    bl_label = "Lit points and volumes"

    def draw(self, context):
        layout = self.layout
        layout.operator(VMAP_OT_import_points.bl_idname, icon="IMPORT")
        layout.operator(VMAP_OT_import_volume.bl_idname, icon="IMPORT")
        if HAS_SAMPLE_GRID:
            layout.operator(VMAP_OT_light_mesh.bl_idname, icon="OUTLINER_OB_VOLUME")
        overridden = context.view_layer.material_override is not None
        layout.operator(VMAP_OT_show_on_meshes.bl_idname, icon="SHADING_RENDERED", depress=overridden)
        item = context.object
        if item is None:
            return
        material = shown_material(item)
        if material:
            layout.prop(item, "vmap_show")
            layout.prop(exposure_socket(material), "default_value", text="Exposure")
            modifier = item.modifiers.get(MODIFIER_NAME)
            if modifier and modifier.node_group:
                draw_input(layout, modifier, "Size")
        elif item.type == "VOLUME" and VOLUME_MARK in item and item.data.materials:
            node = item.data.materials[0].node_tree.nodes.get(EXPOSURE_NODE)
            if node:
                layout.prop(node.outputs[0], "default_value", text="Exposure")


CLASSES = (VMAP_PT_light, VMAP_PT_show)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
