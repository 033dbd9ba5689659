# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows the light that meshes keep in their attribute, without touching their materials."""

import bpy

from .bring_back import NAME
from .point_material import point_material

MATERIAL_NAME = "vmap lit surface"


class VMAP_OT_show_on_meshes(bpy.types.Operator):
    """Show the attribute "irradiance" on all meshes, as white paper would show it: overrides the materials of the view
    layer; once more shows the materials again"""

    bl_idname = "vmap.show_on_meshes"
    bl_label = "Show light on meshes"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        layer = context.view_layer
        if layer.material_override is not None:
            if layer.material_override.name != MATERIAL_NAME:
                self.report({"ERROR"}, f"The view layer already overrides materials by {layer.material_override.name}")
                return {"CANCELLED"}
            layer.material_override = None
            return {"FINISHED"}
        if not any(item.type == "MESH" and NAME in item.data.attributes for item in context.scene.objects):
            self.report(
                {"ERROR"}, f'No mesh has the attribute "{NAME}"; light the scene with the result "Mesh attribute"'
            )
            return {"CANCELLED"}
        material = bpy.data.materials.get(MATERIAL_NAME)
        layer.material_override = material or point_material(MATERIAL_NAME, {NAME}, 1.0, "IRRADIANCE")
        return {"FINISHED"}


def register():
    bpy.utils.register_class(VMAP_OT_show_on_meshes)


def unregister():
    bpy.utils.unregister_class(VMAP_OT_show_on_meshes)
