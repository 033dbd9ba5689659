# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel remembers: how to light the scene, and how points are shown."""

import bpy

from . import point_material

RESULTS = (
    ("CLOUD", "Lit points", "A cloud of lit points", 1),
    ("ATTRIBUTE", "Mesh attribute", 'The attribute "irradiance" on the meshes of the scene', 2),
    ("VOLUME", "Lit volume", "An OpenVDB grid of the light", 4),
)


class LightSettings:
    """Properties that the panel and the operator share. Not registered itself."""

    result: bpy.props.EnumProperty(
        name="Result", description="What to bring back", items=RESULTS, options={"ENUM_FLAG"}, default={"CLOUD"}
    )
    domain: bpy.props.EnumProperty(
        name="Domain",
        description="Where a mesh attribute keeps the light",
        items=(
            ("CORNER", "Face corner", "Sharp edges keep the light of each side"),
            ("POINT", "Vertex", "One value for each vertex"),
        ),
        default="CORNER",
    )
    tolerance: bpy.props.FloatProperty(
        name="Tolerance",
        description="Mean error asked for, as a part of the mean light",
        min=1e-4,
        max=1,
        default=0.01,
        precision=4,
    )
    points: bpy.props.IntProperty(
        name="Points", description="How many points; 0: the program chooses", min=0, default=0, soft_max=10_000_000
    )
    spacing: bpy.props.FloatProperty(
        name="Spacing", description="Distance of neighboring points instead of their number; 0: not given", min=0,
        default=0, unit="LENGTH", precision=4,
    )  # fmt: skip
    selected_only: bpy.props.BoolProperty(
        name="Selected objects only",
        description="The scene consists of the selected objects and all lights; others neither receive nor block light",
    )
    use_frames: bpy.props.BoolProperty(name="Animation", description="Light each frame of a range")
    frame_start: bpy.props.IntProperty(name="First frame", default=1)
    frame_end: bpy.props.IntProperty(name="Last frame", default=1)
    directory: bpy.props.StringProperty(
        name="Folder",
        description='Where volumes and frames are kept; empty: "vmap_light" beside the .blend file',
        subtype="DIR_PATH",
    )
    time_limit: bpy.props.FloatProperty(
        name="Time limit",
        description="Stop the program after so many seconds for one frame; 0: never",
        min=0,
        default=0,
    )


class VMAP_PG_light(bpy.types.PropertyGroup, LightSettings):
    pass


def shown_material(item):
    """The material of ours that the object shows, or None."""
    materials = getattr(item.data, "materials", None) or ()
    return next((m for m in materials if point_material.is_point_material(m)), None)


def _way_items(self, _context):
    material = shown_material(self)
    have = point_material.ways_of(material) if material else []
    return [(*way, number) for number, way in enumerate(point_material.WAYS) if not have or way[0] in have]


def _get_way(self):
    material = shown_material(self)
    way = point_material.get_way(material) if material else "LIT"
    return next(number for number, entry in enumerate(point_material.WAYS) if entry[0] == way)


def _set_way(self, number):
    material = shown_material(self)
    if material:
        point_material.set_way(material, point_material.WAYS[number][0])


def register():
    bpy.utils.register_class(VMAP_PG_light)
    bpy.types.Scene.vmap_light = bpy.props.PointerProperty(type=VMAP_PG_light)
    bpy.types.Object.vmap_show = bpy.props.EnumProperty(
        name="Show", description="What lit points show", items=_way_items, get=_get_way, set=_set_way
    )


def unregister():
    del bpy.types.Object.vmap_show
    del bpy.types.Scene.vmap_light
    bpy.utils.unregister_class(VMAP_PG_light)
