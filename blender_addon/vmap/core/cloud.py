# SPDX-License-Identifier: GPL-3.0-or-later
"""Points with light on them, as read from a file and before Blender sees them."""

from dataclasses import dataclass, field, fields

import numpy as np

from .axes import z_up_from_y_up

VECTORS = ("normals", "irradiance", "albedo", "emission")
NUMBERS = ("radius", "area")
IDS = ("face_id", "material_id")


@dataclass
class Cloud:
    """n points. Each array is None or has n rows.

    positions are relative to offset; both in the axes that `up` names until z_up() has turned them.
    """

    positions: np.ndarray  # (n, 3) float32
    normals: np.ndarray = None  # (n, 3) float32, unit length
    irradiance: np.ndarray = None  # (n, 3) float32, W/m^2, linear Rec.709
    albedo: np.ndarray = None  # (n, 3) float32, linear Rec.709
    emission: np.ndarray = None  # (n, 3) float32, W/(m^2 sr)
    radius: np.ndarray = None  # (n,) float32
    area: np.ndarray = None  # (n,) float32
    face_id: np.ndarray = None  # (n,) int32
    material_id: np.ndarray = None  # (n,) int32
    offset: tuple = (0.0, 0.0, 0.0)  # doubles, to be added to positions
    up: str = "z"
    exposure: float = 1.0  # that the file suggests for display
    info: dict = field(default_factory=dict)  # what else the header says: light_units, vmap, source
    warnings: list = field(default_factory=list)

    def __len__(self):
        return len(self.positions)

    def arrays(self):
        """Name and array of everything that is there."""
        for entry in fields(self):
            value = getattr(self, entry.name)
            if isinstance(value, np.ndarray):
                yield entry.name, value


def prepared(cloud):
    """The cloud as Blender wants it: Z up, finite, every point with a radius."""
    return with_radius(without_invalid(z_up(cloud)))


def z_up(cloud):
    if cloud.up != "z":
        cloud.positions = z_up_from_y_up(cloud.positions)
        if cloud.normals is not None:
            cloud.normals = z_up_from_y_up(cloud.normals)
        cloud.offset = tuple(float(v) for v in z_up_from_y_up(np.array(cloud.offset)))
        cloud.up = "z"
    return cloud


def without_invalid(cloud):
    """Drops points without a finite position and blackens light that is not finite; says how many."""
    finite = np.isfinite(cloud.positions).all(axis=1)
    dropped = len(cloud) - int(finite.sum())
    if dropped:
        for name, array in list(cloud.arrays()):
            setattr(cloud, name, np.ascontiguousarray(array[finite]))
        cloud.warnings.append(f"{dropped} points without a finite position are left out")

    repaired = 0
    for name in VECTORS + NUMBERS:
        array = getattr(cloud, name)
        if array is None or np.isfinite(np.sum(array, dtype=np.float64)):
            continue
        bad = ~np.isfinite(array)
        repaired += int((bad.any(axis=1) if bad.ndim == 2 else bad).sum())
        array[bad] = 0
    if repaired:
        cloud.warnings.append(f"{repaired} values that are not finite count as 0")
    return cloud


def with_radius(cloud):
    """Radii from the file, else from the areas, else from how densely the points lie."""
    if cloud.radius is not None and (cloud.radius > 0).any():
        return cloud
    if cloud.area is not None and (cloud.area > 0).any():
        cloud.radius = np.sqrt(cloud.area / np.float32(np.pi)).astype(np.float32)
    else:
        cloud.radius = np.full(len(cloud), estimated_radius(cloud.positions), np.float32)
    return cloud


def estimated_radius(positions):
    """Radius of the discs that would cover a surface with these points, in their unit.

    Counts the cubes of a grid that hold points: a surface cuts about (area / size^2) of them. The size is brought to
    about six points a cube. One point, or all in one place: 1 percent of a unit.
    """
    fallback = 0.01
    count = len(positions)
    if count < 2:
        return fallback
    low = positions.min(axis=0).astype(np.float64)
    diagonal = float(np.linalg.norm(positions.max(axis=0) - low))
    if not diagonal > 0:
        return fallback
    wanted = 6.0
    size = diagonal * (wanted / count) ** 0.5 / 2
    occupied = count
    for _ in range(4):
        size = max(size, diagonal * 1e-6)
        cells = ((positions - low) / size).astype(np.int64)
        keys = (cells[:, 0] << 42) ^ (cells[:, 1] << 21) ^ cells[:, 2]
        occupied = len(np.unique(keys))
        per_cube = count / occupied
        if wanted / 2 < per_cube < wanted * 2 or occupied == 1:
            break
        size *= (wanted / per_cube) ** 0.5
    # A tilted sheet cuts about 1.5 times as many cubes as one along the axes; 1.25 is between.
    area = occupied * size * size / 1.25
    return float((area / count / np.pi) ** 0.5)
