# SPDX-License-Identifier: GPL-3.0-or-later
"""All or nothing: data that was made before an error goes away again."""

from contextlib import contextmanager

import bpy

COLLECTIONS = ("objects", "meshes", "pointclouds", "volumes", "materials", "node_groups", "collections", "scenes",
               "worlds", "cameras", "images")  # fmt: skip


@contextmanager
def all_or_nothing():
    """Removes what the block added to the file when it ends with an error."""
    before = {name: _pointers(name) for name in COLLECTIONS if hasattr(bpy.data, name)}
    try:
        yield
    except BaseException:
        added = [
            block
            for name, pointers in before.items()
            for block in getattr(bpy.data, name)
            if block.as_pointer() not in pointers and block.library is None
        ]
        if added:
            bpy.data.batch_remove(added)
        raise


def _pointers(name):
    return {block.as_pointer() for block in getattr(bpy.data, name)}


def remove_object(item):
    """The object and its data, if nothing else uses that."""
    data = item.data
    bpy.data.objects.remove(item)
    if data is not None and data.users == 0:
        bpy.data.batch_remove([data])


def link_and_select(context, items):
    """Puts new objects into the active collection, selects them and makes the last one active."""
    for other in context.view_layer.objects:
        other.select_set(False)
    for item in items:
        if item.name not in context.collection.objects:
            context.collection.objects.link(item)
        item.select_set(True)
        context.view_layer.objects.active = item
