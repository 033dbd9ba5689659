# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the points (primitives of mode 0) of a glTF file: ours with their light, others with their colours."""

import base64
import json
import os
import struct
from urllib.parse import unquote

import numpy as np

from .cloud import Cloud
from .errors import FileProblem, printable

POINTS = 0
MAX_DEPTH = 256
COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
SPACE = "a glTF file with points"


def read_gltf_points(path):
    """The Cloud of all points of the file's scene, Y up. Throws AddonError with one line."""
    try:
        with open(path, "rb") as file:
            data = file.read()
    except OSError as error:
        raise FileProblem(path, f"cannot read: {error.strerror or error}", SPACE) from None
    document, binary = _split(path, data)
    try:
        return _Reader(path, document, binary).cloud()
    except (KeyError, IndexError, TypeError, ValueError, AttributeError) as error:
        raise FileProblem(path, f"not valid ({type(error).__name__} {printable(error)})", SPACE) from None


def _split(path, data):
    """JSON document and binary chunk of a .glb or .gltf."""
    binary = None
    if data[:4] == b"glTF":
        if len(data) < 20:
            raise FileProblem(path, "ends too early", SPACE)
        _, version, length = struct.unpack_from("<4sII", data)
        json_size, json_type = struct.unpack_from("<I4s", data, 12)
        if version != 2 or length > len(data) or 20 + json_size > len(data) or json_type != b"JSON":
            raise FileProblem(path, "its GLB header does not fit its size", SPACE)
        text = data[20 : 20 + json_size]
        begin = 20 + json_size
        if begin + 8 <= length:
            size, kind = struct.unpack_from("<I4s", data, begin)
            if begin + 8 + size > len(data):
                raise FileProblem(path, "ends too early", SPACE)
            if kind == b"BIN\0":
                binary = data[begin + 8 : begin + 8 + size]
    else:
        text = data
    try:
        document = json.loads(text)
    except (ValueError, RecursionError):
        raise FileProblem(path, "is empty" if not data else "is not JSON", SPACE) from None
    if not isinstance(document, dict) or not str(document.get("asset", {}).get("version", "")).startswith("2."):
        raise FileProblem(path, "no asset of version 2", SPACE)
    return document, binary


class _Reader:
    def __init__(self, path, document, binary):
        self.path = path
        self.document = document
        self.binary = binary
        self.buffers = {}

    def cloud(self):
        parts, offset = [], None
        for mesh, matrix in self._placed_meshes():
            for primitive in mesh["primitives"]:
                if primitive.get("mode", 4) != POINTS:
                    continue
                if offset is None:
                    offset = matrix[:3, 3].copy()
                parts.append(self._part(mesh, primitive, matrix, offset))
        if not parts:
            raise FileProblem(self.path, "has no points", "a primitive of mode 0 (POINTS)")
        cloud = _joined(parts)
        cloud.offset = tuple(offset.tolist())
        self._describe(cloud)
        return cloud

    def _describe(self, cloud):
        """What our own writer says about its file."""
        extras = self.document["asset"].get("extras")
        extras = extras if isinstance(extras, dict) else {}
        cloud.up = "z" if extras.get("up") == "z" else "y"
        exposure = extras.get("exposure", 1)
        cloud.exposure = float(exposure) if isinstance(exposure, (int, float)) and exposure > 0 else 1.0
        cloud.info = {key: str(extras[key]) for key in ("light_units", "source") if key in extras}

    def _placed_meshes(self):
        """Each mesh of the scene with its world matrix, column vectors."""
        nodes = self.document.get("nodes", [])
        scenes = self.document.get("scenes", [])
        roots = scenes[self.document.get("scene", 0)].get("nodes", []) if scenes else range(len(nodes))
        pending = [(index, np.eye(4), 0) for index in roots]
        visited = 0
        while pending:
            index, parent, depth = pending.pop()
            visited += 1
            if depth > MAX_DEPTH or visited > len(nodes):
                raise FileProblem(self.path, "its nodes form a loop", "a tree of nodes")
            node = nodes[index]
            matrix = parent @ _local_matrix(node)
            if "mesh" in node:
                yield self.document["meshes"][node["mesh"]], matrix
            pending.extend((child, matrix, depth + 1) for child in reversed(node.get("children", [])))

    def _part(self, mesh, primitive, matrix, offset):
        attributes = primitive["attributes"]

        def vectors(name):
            return self._accessor(attributes[name])[:, :3] if name in attributes else None

        linear = matrix[:3, :3]
        shift = matrix[:3, 3] - offset
        positions = vectors("POSITION")
        if not (np.array_equal(linear, np.eye(3)) and not shift.any()):
            positions = (positions.astype(np.float64) @ linear.T + shift).astype(np.float32)
        part = Cloud(positions)
        part.normals = vectors("_NORMAL") if "_NORMAL" in attributes else vectors("NORMAL")
        if part.normals is not None:
            part.normals = _turned_normals(part.normals, linear)
        part.irradiance, part.emission = vectors("_IRRADIANCE"), vectors("_EMISSION")
        part.albedo = vectors("_ALBEDO")
        if part.albedo is None and part.irradiance is None:
            part.albedo = vectors("COLOR_0")  # linear by the specification
        for name, array in part.arrays():
            if len(array) != len(part):
                raise FileProblem(self.path, f"{name} of {len(array)} points", f"{len(part)}")
        extras = mesh.get("extras") if isinstance(mesh.get("extras"), dict) else {}
        radius = extras.get("radius", 0)
        if isinstance(radius, (int, float)) and radius > 0:
            scale = abs(np.linalg.det(linear)) ** (1 / 3)
            part.radius = np.full(len(part), radius * scale, np.float32)
        return part

    def _accessor(self, index):
        """(count, width) float32 values; normalised integers are scaled."""
        accessor = self.document["accessors"][index]
        if "sparse" in accessor or "bufferView" not in accessor:
            raise FileProblem(self.path, "points in a sparse accessor", "plain accessors")
        view = self.document["bufferViews"][accessor["bufferView"]]
        dtype = np.dtype(COMPONENTS[accessor["componentType"]])
        width, count = WIDTHS[accessor["type"]], accessor["count"]
        row = dtype.itemsize * width
        stride = view.get("byteStride", row)
        begin = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        data = self._buffer(view["buffer"])
        if min(count, begin) < 0 or stride < row or (count and begin + (count - 1) * stride + row > len(data)):
            raise FileProblem(self.path, "an accessor reaches beyond its buffer", SPACE)
        if not count:
            return np.zeros((0, width), np.float32)
        values = np.ndarray((count, width), dtype, data, begin, (stride, dtype.itemsize))
        if dtype.kind == "f":
            return values.astype(np.float32)
        return (values.astype(np.float32) / np.iinfo(dtype).max if accessor.get("normalized") else values).astype(
            np.float32
        )

    def _buffer(self, index):
        if index not in self.buffers:
            self.buffers[index] = self._load_buffer(self.document["buffers"][index], index)
        return self.buffers[index]

    def _load_buffer(self, buffer, index):
        uri = buffer.get("uri")
        if uri is None:
            if index != 0 or self.binary is None:
                raise FileProblem(self.path, "a buffer without data", SPACE)
            return self.binary
        if uri.startswith("data:"):
            return base64.b64decode(uri.partition(",")[2])
        folder = os.path.realpath(os.path.dirname(os.path.abspath(self.path)))
        target = os.path.realpath(os.path.join(folder, unquote(uri)))
        if os.path.commonpath([folder, target]) != folder:
            raise FileProblem(self.path, f"buffer {printable(uri)!r}", "a file inside the scene's folder")
        try:
            with open(target, "rb") as file:
                return file.read()
        except OSError as error:
            raise FileProblem(target, f"cannot read: {error.strerror or error}", "the buffer of a glTF file") from None


def _local_matrix(node):
    if "matrix" in node:
        return np.array(node["matrix"], np.float64).reshape(4, 4).T
    matrix = np.eye(4)
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    rotation = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, :3] = np.array(rotation) * np.array(node.get("scale", (1, 1, 1)), np.float64)
    matrix[:3, 3] = node.get("translation", (0, 0, 0))
    return matrix


def _turned_normals(normals, linear):
    if np.array_equal(linear, np.eye(3)):
        return normals
    turned = normals.astype(np.float64) @ np.linalg.inv(linear)  # inverse transpose, for rows
    length = np.linalg.norm(turned, axis=1, keepdims=True)
    return (turned / np.where(length > 0, length, 1)).astype(np.float32)


def _joined(parts):
    """One cloud of several; an attribute that a part lacks is 0 there."""
    if len(parts) == 1:
        return parts[0]
    result = Cloud(np.concatenate([p.positions for p in parts]))
    for name in ("normals", "irradiance", "albedo", "emission", "radius"):
        if any(getattr(p, name) is not None for p in parts):
            shape = () if name == "radius" else (3,)
            arrays = [getattr(p, name) for p in parts]
            filled = [np.zeros((len(p), *shape), np.float32) if a is None else a for p, a in zip(parts, arrays)]
            setattr(result, name, np.concatenate(filled))
    return result
