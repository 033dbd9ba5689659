# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's light units and those of a glTF file that vmap reads with --light-units compat.

Watts in, the same watts out. In the file a point or spot light has the radiant intensity I in W/sr, E = I cos / d^2;
a sun has E at right angles in W/m^2; surfaces emit radiance in W/(m^2 sr).
"""

import math

import numpy as np


def point_intensity(power):
    """W/sr of a point or spot light of this power in W. A cone only cuts a spot: it does not gather the light."""
    return power / (4 * math.pi)


def area_radiance(power, area, before_4_0=False):
    """W/(m^2 sr) of a flat lamp that sends this power in W out of its front, evenly in the sense of Lambert.

    Cycles before Blender 4.0 divides by 4 where pi belongs; the picture that its users know is that one.
    """
    return power / ((4 if before_4_0 else math.pi) * area)


def cone_angles(full_angle, blend):
    """Inner and outer angle of a glTF spot, radians, for Blender's full angle and blend in [0, 1].

    glTF wants the inner one to be smaller: a hard edge is one part in 10^4 wide.
    """
    outer = min(full_angle / 2, math.pi / 2)
    return outer * min(1 - blend, 1 - 1e-4), outer


def lamp_outline(shape, size_x, size_y):
    """Corners (n, 2) of an area lamp in its own plane, counter-clockwise seen from +z."""
    if shape in ("SQUARE", "DISK"):
        size_y = size_x
    if shape in ("SQUARE", "RECTANGLE"):
        corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], np.float64)
    else:
        angles = np.arange(64) * (2 * np.pi / 64)
        corners = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return corners * (size_x / 2, size_y / 2)
