# SPDX-License-Identifier: GPL-3.0-or-later
"""The Blender side: operators, panels, materials. Works from 3.4 on; asks for features, never for version numbers."""

from . import (
    import_points,
    import_volume,
    light_mesh,
    light_operator,
    panel,
    preferences,
    scene_settings,
    sequence_player,
    show_meshes,
)

MODULES = (preferences, scene_settings, import_points, import_volume, light_mesh, show_meshes, light_operator, panel,
           sequence_player)  # fmt: skip


def register():
    for module in MODULES:
        module.register()


def unregister():
    for module in reversed(MODULES):
        module.unregister()
