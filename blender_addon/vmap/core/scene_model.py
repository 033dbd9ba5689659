# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene as it goes to the program: plain data in Blender's frame (Z up), between the Blender shell and the writer."""

from dataclasses import dataclass, field

import numpy as np


@dataclass
class TextureImage:
    name: str
    pixels: np.ndarray  # (height, width, 4) uint8, sRGB, rows from the top
    repeat: bool = True  # else clamped at its edge
    nearest: bool = False


@dataclass
class SceneMaterial:
    name: str
    base_color: tuple = (0.8, 0.8, 0.8)  # linear
    base_texture: int = None  # index into Scene.images
    alpha_cut: bool = False  # the texture's alpha below one half is cut away
    metallic: float = 0.0
    emission: tuple = (0.0, 0.0, 0.0)  # W/(m^2 sr), linear
    emission_texture: int = None
    double_sided: bool = True


@dataclass
class Part:
    """Triangles of one material in the frame of their node."""

    material: int
    positions: np.ndarray  # (n, 3) float32
    triangles: np.ndarray  # (m, 3) uint32, counter-clockwise seen from the front
    uvs: np.ndarray = None  # (n, 2) float32, v upwards as in Blender; for the base texture
    emission_uvs: np.ndarray = None  # the same for the emission texture
    colors: np.ndarray = None  # (n, 4) float32, linear


@dataclass
class SceneMesh:
    name: str
    parts: list


@dataclass
class Placement:
    """A mesh in the world; source is the name of the object that shows it, "" for lamps made into surfaces."""

    mesh: int
    matrix: np.ndarray  # (4, 4) float64, column vectors: world = matrix @ local
    source: str = ""


@dataclass
class SceneLight:
    kind: str  # point, spot or directional; shines along its own -z
    color: tuple
    intensity: float  # W/sr; W/m^2 for directional
    matrix: np.ndarray
    cone: tuple = None  # inner and outer angle of a spot, radians
    name: str = ""


@dataclass
class SceneCamera:
    matrix: np.ndarray  # looks along its own -z, y up
    vertical_fov: float = 0.8  # radians
    half_height: float = None  # orthographic when set
    aspect: float = 1.0


@dataclass
class Scene:
    materials: list = field(default_factory=list)
    images: list = field(default_factory=list)
    meshes: list = field(default_factory=list)
    placements: list = field(default_factory=list)
    lights: list = field(default_factory=list)
    camera: SceneCamera = None
    sky: str = ""  # "r,g,b" in W/(m^2 sr), or the path of a panorama
    skipped: dict = field(default_factory=dict)  # feature that the program will not see -> names that have it

    def skip(self, feature, name):
        names = self.skipped.setdefault(feature, [])
        if name not in names:
            names.append(name)

    def not_carried(self, shown=4):
        """One line for each feature."""
        lines = []
        for feature, names in self.skipped.items():
            more = f" and {len(names) - shown} more" if len(names) > shown else ""
            lines.append(f"{feature}: {', '.join(names[:shown])}{more}")
        return lines

    def triangle_count(self):
        return sum(len(p.triangles) for placed in self.placements for p in self.meshes[placed.mesh].parts)

    def face_ranges(self):
        """(source, first face, end) of each placement: faces are numbered through in the order of the file."""
        ranges, begin = [], 0
        for placed in self.placements:
            end = begin + sum(len(p.triangles) for p in self.meshes[placed.mesh].parts)
            ranges.append((placed.source, begin, end))
            begin = end
        return ranges
