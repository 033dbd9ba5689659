# SPDX-License-Identifier: GPL-3.0-or-later
"""Axes: the one place where Y up (glTF) meets Z up (Blender). Both frames are right-handed."""

import numpy as np

# glTF (x, y, z) arrives in Blender as (x, -z, y). Column vectors: blender = matrix @ gltf.
BLENDER_FROM_GLTF = np.array([[1, 0, 0, 0], [0, 0, -1, 0], [0, 1, 0, 0], [0, 0, 0, 1]], np.float64)
GLTF_FROM_BLENDER = np.ascontiguousarray(BLENDER_FROM_GLTF.T)


def z_up_from_y_up(vectors):
    """Rows (x, y, z) with Y up as rows with Z up: positions and directions alike."""
    vectors = np.asarray(vectors)
    return np.stack([vectors[..., 0], -vectors[..., 2], vectors[..., 1]], axis=-1)
