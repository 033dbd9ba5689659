# SPDX-License-Identifier: GPL-3.0-or-later
"""Points over time: loads the file of the frame when the frame changes."""

import json

import bpy

from ..core.errors import AddonError
from ..core.read_cloud import read_cloud
from ..core.sequence import Sequence
from .point_object import fill_geometry

FILES, SHOWN = "vmap_sequence", "vmap_sequence_shown"


def attach(item, sequence):
    """Makes the object follow these files; it shows the one of the present frame."""
    item[FILES] = json.dumps([[frame, _stored(path)] for frame, path in zip(sequence.frames, sequence.paths)])
    item[SHOWN] = sequence.path_at(bpy.context.scene.frame_current)


def sequence_of(item):
    try:
        entries = json.loads(item.get(FILES, ""))
        return Sequence([bpy.path.abspath(path) for _, path in entries], [int(frame) for frame, _ in entries])
    except (ValueError, TypeError):
        return None


def _stored(path):
    """Relative to the .blend file when it has a place, so that both can move together."""
    try:
        return bpy.path.relpath(path) if bpy.data.filepath else path
    except ValueError:
        return path  # another drive


def update(item, frame):
    """Shows the points of this frame. A file that cannot be read leaves the object as it is and is said once."""
    sequence = sequence_of(item)
    if not sequence or not sequence.paths:
        return
    path = sequence.path_at(frame)
    if item.get(SHOWN) == path:
        return
    item[SHOWN] = path
    try:
        fill_geometry(item.data, read_cloud(path))
    except AddonError as error:
        print(f"vmap: {item.name}, frame {frame}: {error}")


@bpy.app.handlers.persistent
def _on_frame(scene, *_):
    for item in scene.objects:
        if FILES in item and item.type == "MESH":
            update(item, scene.frame_current)


def register():
    bpy.app.handlers.frame_change_pre.append(_on_frame)


def unregister():
    if _on_frame in bpy.app.handlers.frame_change_pre:
        bpy.app.handlers.frame_change_pre.remove(_on_frame)
