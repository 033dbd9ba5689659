# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the program is, and whether it is the right one."""

import bpy

from ..core.errors import AddonError
from ..core.program import check_program, find_program

ADDON = __package__.rpartition(".")[0]


class VMAP_AddonPreferences(bpy.types.AddonPreferences):
    bl_idname = ADDON

    program: bpy.props.StringProperty(
        name="vmap program", description="Path of the program; empty: the one on PATH", subtype="FILE_PATH"
    )

    def draw(self, _context):
        self.layout.prop(self, "program")
        if not self.program:
            try:
                self.layout.label(text=f"On PATH: {find_program()}", icon="CHECKMARK")
            except AddonError as error:
                self.layout.label(text=str(error), icon="ERROR")
        self.layout.operator(VMAP_OT_check_program.bl_idname)


class VMAP_OT_check_program(bpy.types.Operator):
    """Ask the vmap program for its version"""

    bl_idname = "vmap.check_program"
    bl_label = "Check the program"

    def execute(self, _context):
        try:
            program = check_program(program_path())
        except AddonError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"vmap {program.version_text()} at {program.path}")
        return {"FINISHED"}


def program_path():
    """The path in the preferences; "" when there are none, as after a bare register()."""
    addon = bpy.context.preferences.addons.get(ADDON)
    path = addon.preferences.program if addon and addon.preferences else ""
    return bpy.path.abspath(path) if path else ""


CLASSES = (VMAP_AddonPreferences, VMAP_OT_check_program)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister():
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
