# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangle meshes as numpy arrays: quads, boxes and spheres, counter-clockwise seen from their front."""

from dataclasses import dataclass, replace

import numpy as np


@dataclass
class Shape:
    """Triangles in their own frame. Positions are float32, as glTF stores them; uvs and normals may be absent."""

    positions: np.ndarray  # (n, 3) float32
    indices: np.ndarray  # (3 m,) uint16
    normals: np.ndarray | None = None  # (n, 3) float32
    uvs: np.ndarray | None = None  # (n, 2) float32

    def flipped(self):
        """The same surface seen from its other side."""
        triangles = self.indices.reshape(-1, 3)[:, ::-1]
        return replace(self, indices=triangles.reshape(-1), normals=None if self.normals is None else -self.normals)


def join(shapes):
    """One shape out of several that have neither normals nor uvs."""
    offsets = np.cumsum([0] + [len(shape.positions) for shape in shapes])
    indices = [shape.indices + offset for shape, offset in zip(shapes, offsets)]
    return Shape(np.concatenate([shape.positions for shape in shapes]), np.concatenate(indices).astype(np.uint16))


def quad(a, b, c, d, tiles=None):
    """Two triangles (a, b, c), (a, c, d); with tiles = (u, v) texture coordinates run from a (0, 0) to c (u, v)."""
    uvs = None if tiles is None else np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32) * np.float32(tiles)
    return Shape(np.array([a, b, c, d], np.float32), np.array([0, 1, 2, 0, 2, 3], np.uint16), uvs=uvs)


def box_faces(low, high):
    """The six faces of an axis-parallel box by name, each seen from outside."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    return {
        "left": quad((x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)),
        "right": quad((x1, y0, z1), (x1, y0, z0), (x1, y1, z0), (x1, y1, z1)),
        "floor": quad((x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)),
        "ceiling": quad((x0, y1, z1), (x1, y1, z1), (x1, y1, z0), (x0, y1, z0)),
        "back": quad((x1, y0, z0), (x0, y0, z0), (x0, y1, z0), (x1, y1, z0)),
        "front": quad((x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)),
    }


def box(low, high, without=()):
    """A closed box seen from outside, less the faces named in without."""
    return join([face for name, face in box_faces(low, high).items() if name not in without])


def room_faces(low, high):
    """The six faces of a box by name, each seen from inside."""
    return {name: face.flipped() for name, face in box_faces(low, high).items()}


def prism(base, height, bottom=False):
    """A block over a convex polygon of (x, z) corners on y = 0, given in either direction."""
    ends = list(base[1:]) + [base[0]]
    if sum(x0 * z1 - x1 * z0 for (x0, z0), (x1, z1) in zip(base, ends)) < 0:
        base = base[::-1]
    low = [(x, 0, z) for x, z in base]
    high = [(x, height, z) for x, z in base]
    count = len(base)
    sides = [quad(low[(i + 1) % count], low[i], high[i], high[(i + 1) % count]) for i in range(count)]
    fan = np.array([[0, i + 1, i] for i in range(1, count - 1)], np.uint16).reshape(-1)
    lids = [Shape(np.array(high, np.float32), fan)]
    if bottom:
        lids.append(Shape(np.array(low, np.float32), fan).flipped())
    return join(sides + lids)


def sphere(center, radius, levels):
    """An icosahedron whose faces are split `levels` times, on the sphere, with smooth normals."""
    golden = (1 + 5**0.5) / 2
    corners = [(s, t * golden, 0) for s in (-1, 1) for t in (-1, 1)]
    corners += [(0, s, t * golden) for s in (-1, 1) for t in (-1, 1)]
    corners += [(t * golden, 0, s) for s in (-1, 1) for t in (-1, 1)]
    points = [np.array(corner) / np.linalg.norm(corner) for corner in corners]
    triangles = _icosahedron_faces(points)
    for _ in range(levels):
        middles = {}

        def middle(i, j):
            key = (min(i, j), max(i, j))
            if key not in middles:
                middles[key] = len(points)
                between = points[i] + points[j]
                points.append(between / np.linalg.norm(between))
            return middles[key]

        triangles = [
            child
            for a, b, c in triangles
            for ab, bc, ca in [(middle(a, b), middle(b, c), middle(c, a))]
            for child in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))
        ]
    normals = np.array(points)
    positions = (np.array(center) + radius * normals).astype(np.float32)
    return Shape(positions, np.array(triangles, np.uint16).reshape(-1), normals=normals.astype(np.float32))


def _icosahedron_faces(points):
    """Triples of mutual neighbours, counter-clockwise seen from outside."""
    edge = min(np.linalg.norm(points[0] - point) for point in points[1:])

    def near(i, j):
        return abs(np.linalg.norm(points[i] - points[j]) - edge) < 1e-6

    faces = []
    for a in range(12):
        for b in range(a + 1, 12):
            for c in range(b + 1, 12):
                if near(a, b) and near(b, c) and near(c, a):
                    outward = np.dot(np.cross(points[b] - points[a], points[c] - points[a]), points[a]) > 0
                    faces.append((a, b, c) if outward else (a, c, b))
    return faces
