# SPDX-License-Identifier: GPL-3.0-or-later
"""V-map light: imports lit clouds and volumes, and lights a scene with the vmap program.

core/ needs no Blender; shell/ is everything that does.
"""

bl_info = {  # for Blender before 4.2, which does not read blender_manifest.toml
    "name": "V-map light",
    "author": "The vmap authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "File > Import; 3D View > Sidebar > V-map",
    "description": "Imports lit points and volumes, and lights a scene with the vmap program",
    "category": "Import-Export",
}

from . import shell  # noqa: E402


def register():
    shell.register()


def unregister():
    shell.unregister()
