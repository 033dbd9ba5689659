# SPDX-License-Identifier: GPL-3.0-or-later
"""Light from points onto the corners and vertices of a mesh.

At each target a plane is fitted to the values of the nearest points that face the same way, weighted by distance and by
the agreement of normals (moving least squares, P. Lancaster, K. Salkauskas, 1981). Unlike a mean it does not pull the
value at an edge towards the middle of the face.
"""

import numpy as np

LEAST_AGREEMENT = 0.5  # cosine; points that face another way do not count
BATCH = 1 << 16


def fit_values(targets, target_normals, neighbors, distances, positions, normals, values):
    """(m, c) float32 values at m targets, from their k nearest of n points.

    - targets, target_normals: (m, 3), in the frame of positions
    - neighbors, distances: (m, k), nearest first; a neighbour of -1 is none
    - positions, normals: (n, 3); values: (n, c)
    - a target without any point that faces its way takes the one that agrees best
    """
    result = np.zeros((len(targets), values.shape[1]), np.float32)
    for begin in range(0, len(targets), BATCH):
        rows = slice(begin, begin + BATCH)
        result[rows] = _fit(
            targets[rows], target_normals[rows], neighbors[rows], distances[rows], positions, normals, values
        )
    return result


def _fit(targets, target_normals, neighbors, distances, positions, normals, values):
    there = neighbors >= 0
    near = np.where(there, neighbors, 0)
    agreement = np.einsum("mkc,mc->mk", normals[near], target_normals)
    agreement = np.where(there, agreement, -2)
    counts = agreement >= LEAST_AGREEMENT
    reach = np.where(there, distances, 0).max(axis=1, keepdims=True)
    falloff = np.clip(1 - distances / np.maximum(reach * 1.05, 1e-30), 0, 1)
    weights = np.where(counts, falloff**2 * agreement, 0).astype(np.float64)
    chosen = values[near].astype(np.float64)  # (m, k, c)

    total = weights.sum(axis=1)
    lost = total <= 0
    mean = np.einsum("mk,mkc->mc", weights, chosen) / np.where(lost, 1, total)[:, None]

    # In the target's tangent plane, in units of the reach: value = a + b u + c v.
    first, second = _tangents(target_normals)
    offsets = (positions[near] - targets[:, None, :]).astype(np.float64) / np.maximum(reach, 1e-30)[:, :, None]
    u, v = np.einsum("mkc,mc->mk", offsets, first), np.einsum("mkc,mc->mk", offsets, second)
    basis = np.stack([np.ones_like(u), u, v], axis=2)
    normal_matrix = np.einsum("mk,mki,mkj->mij", weights, basis, basis)
    right = np.einsum("mk,mki,mkc->mic", weights, basis, chosen)
    damping = 1e-3 * total[:, None, None] * np.diag([0.0, 1.0, 1.0]) + np.where(lost, 1.0, 0.0)[:, None, None] * np.eye(
        3
    )
    fitted = np.linalg.solve(normal_matrix + damping + 1e-12 * np.eye(3), right)[:, 0, :]

    # Never beyond what the points themselves say, and the mean where too few say anything.
    inf = np.inf
    low = np.where(counts[:, :, None], chosen, inf).min(axis=1)
    high = np.where(counts[:, :, None], chosen, -inf).max(axis=1)
    fitted = np.clip(fitted, low - (high - low) / 2, high + (high - low) / 2)
    fitted = np.maximum(fitted, np.minimum(low, 0))
    result = np.where((counts.sum(axis=1) >= 4)[:, None], fitted, mean)
    best = np.argmax(agreement, axis=1)
    fallback = chosen[np.arange(len(targets)), best]
    return np.where(lost[:, None], fallback, result)


def _tangents(normals):
    """Two unit vectors at right angles to each normal and each other."""
    normals = normals.astype(np.float64)
    axis = np.zeros_like(normals)
    axis[np.arange(len(normals)), np.argmin(np.abs(normals), axis=1)] = 1
    first = np.cross(normals, axis)
    first /= np.maximum(np.linalg.norm(first, axis=1, keepdims=True), 1e-30)
    return first, np.cross(normals, first)
