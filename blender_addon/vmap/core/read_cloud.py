# SPDX-License-Identifier: GPL-3.0-or-later
"""A lit cloud from any file of points, by its extension."""

import os

from .cloud import prepared
from .errors import FileProblem
from .gltf_points import read_gltf_points
from .ply import read_ply

READERS = {".ply": read_ply, ".glb": read_gltf_points, ".gltf": read_gltf_points}


def read_cloud(path):
    """The Cloud of the file: Z up, finite, with radii. Throws AddonError with one line."""
    extension = os.path.splitext(path)[1].lower()
    if extension not in READERS:
        raise FileProblem(path, f"extension {extension!r}", ", ".join(READERS))
    cloud = prepared(READERS[extension](path))
    if not len(cloud):
        raise FileProblem(path, "has no points", "at least one point")
    return cloud
