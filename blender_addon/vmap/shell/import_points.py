# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Import > Lit points: PLY and glTF points, one or many, or frame by frame."""

import os

import bpy
from bpy_extras.io_utils import ImportHelper

from ..core.errors import AddonError
from ..core.read_cloud import READERS, read_cloud
from ..core.sequence import group_sequences
from . import sequence_player
from .compat import HAS_FILE_HANDLERS
from .datablocks import all_or_nothing, link_and_select
from .point_object import point_object


def chosen_paths(operator):
    """Paths that the file selector, a drop or a script gave."""
    if operator.files and operator.directory:
        names = [entry.name for entry in operator.files if entry.name]
        if names:
            return [os.path.join(bpy.path.abspath(operator.directory), name) for name in names]
    return [bpy.path.abspath(operator.filepath)] if operator.filepath else []


class VMAP_OT_import_points(bpy.types.Operator, ImportHelper):
    """Import lit points: PLY or glTF files written by vmap, and any other with points"""

    bl_idname = "vmap.import_points"
    bl_label = "Import lit points"
    bl_options = {"REGISTER", "UNDO", "PRESET"}

    filename_ext = ".ply"
    filter_glob: bpy.props.StringProperty(default="*.ply;*.glb;*.gltf", options={"HIDDEN"})
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
                    made.append(self._import(context, sequence))
        except AddonError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        link_and_select(context, made)
        _show_materials(context)
        return {"FINISHED"}

    def _import(self, context, sequence):
        path = sequence.path_at(context.scene.frame_current) if sequence.animated else sequence.paths[0]
        cloud = read_cloud(path)
        for warning in cloud.warnings:
            self.report({"WARNING"}, f"{os.path.basename(path)}: {warning}")
        name = os.path.splitext(os.path.basename(path))[0]
        item = point_object(context, cloud, name, self.exposure, as_mesh=sequence.animated)
        if sequence.animated:
            sequence_player.attach(item, sequence)
        return item


def _show_materials(context):
    """The light is in the material: a viewport that shows plain shapes switches to materials."""
    space = context.space_data
    if space is not None and space.type == "VIEW_3D" and space.shading.type in {"SOLID", "WIREFRAME"}:
        space.shading.type = "MATERIAL"


def _menu(self, _context):
    extensions = ", ".join(READERS)
    self.layout.operator(VMAP_OT_import_points.bl_idname, text=f"Lit points ({extensions})")


CLASSES = [VMAP_OT_import_points]
if HAS_FILE_HANDLERS:

    class VMAP_FH_points(bpy.types.FileHandler):
        bl_idname = "VMAP_FH_points"
        bl_label = "Lit points"
        bl_import_operator = VMAP_OT_import_points.bl_idname
        bl_file_extensions = ";".join(READERS)

        @classmethod
        def poll_drop(cls, context):
            return context.area is not None and context.area.type == "VIEW_3D"

    CLASSES.append(VMAP_FH_points)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.TOPBAR_MT_file_import.append(_menu)


def unregister():
    bpy.types.TOPBAR_MT_file_import.remove(_menu)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
