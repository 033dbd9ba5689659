# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Import > Lit volume: OpenVDB grids written by vmap."""

import os

import bpy
from bpy_extras.io_utils import ImportHelper

from ..core.errors import AddonError
from ..core.sequence import group_sequences
from .compat import HAS_FILE_HANDLERS
from .datablocks import all_or_nothing, link_and_select
from .import_points import chosen_paths
from .volume_object import volume_object


class VMAP_OT_import_volume(bpy.types.Operator, ImportHelper):
    """Import lit volumes: OpenVDB grids written by vmap"""

    bl_idname = "vmap.import_volume"
    bl_label = "Import lit volume"
    bl_options = {"REGISTER", "UNDO", "PRESET"}

    filename_ext = ".vdb"
    filter_glob: bpy.props.StringProperty(default="*.vdb", options={"HIDDEN"})
    files: bpy.props.CollectionProperty(type=bpy.types.OperatorFileListElement, options={"HIDDEN", "SKIP_SAVE"})
    directory: bpy.props.StringProperty(subtype="DIR_PATH", options={"HIDDEN", "SKIP_SAVE"})
    exposure: bpy.props.FloatProperty(
        name="Exposure", description="Factor for the light on display; 0: what the file suggests", min=0, default=0
    )
    use_sequence: bpy.props.BoolProperty(
        name="Sequence", description="Files that differ in their number only become one object over time", default=True
    )

    def invoke(self, context, event):
        if self.directory and self.files:
            return self.execute(context)  # dropped
        return ImportHelper.invoke(self, context, event)

    def execute(self, context):
        paths = chosen_paths(self)
        if not paths:
            self.report({"ERROR"}, "No file was chosen")
            return {"CANCELLED"}
        made = []
        try:
            with all_or_nothing():
                for sequence in group_sequences(paths, self.use_sequence):
                    name = os.path.splitext(os.path.basename(sequence.paths[0]))[0]
                    made.append(volume_object(context, sequence, name, self.exposure))
        except AddonError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        link_and_select(context, made)
        return {"FINISHED"}


def _menu(self, _context):
    self.layout.operator(VMAP_OT_import_volume.bl_idname, text="Lit volume (.vdb)")


CLASSES = [VMAP_OT_import_volume]
if HAS_FILE_HANDLERS:

    class VMAP_FH_volume(bpy.types.FileHandler):
        bl_idname = "VMAP_FH_volume"
        bl_label = "Lit volume"
        bl_import_operator = VMAP_OT_import_volume.bl_idname
        bl_file_extensions = ".vdb"

        @classmethod
        def poll_drop(cls, context):
            return context.area is not None and context.area.type == "VIEW_3D"

    CLASSES.append(VMAP_FH_volume)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.TOPBAR_MT_file_import.append(_menu)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(_menu)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
