# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds one glTF 2.0 scene and writes it as a .gltf with its buffer inside, the same bytes on every run.

It also measures what it wrote (triangles, areas, box), so that the expected values come from the transforms in the file.
"""

import base64
import json
import math
import struct
import zlib

import numpy as np

FLOAT, USHORT = 5126, 5123


class Gltf:
    def __init__(self):
        self.materials, self.meshes, self.nodes, self.cameras, self.lights, self.textures = [], [], [], [], [], []
        self._shapes = []  # the (shape, material) list behind each mesh
        self._accessors, self._views, self._images, self._buffer = [], [], [], bytearray()
        self._extensions = set()

    # --- content ---------------------------------------------------------------------------------------------------

    def material(self, name, albedo, emission=(0, 0, 0), double_sided=False, texture=None):
        """albedo: linear; emission: radiance Le in W/(m^2 sr); texture: an index from checker_texture()."""
        base = {"baseColorFactor": [*numbers(albedo), 1], "metallicFactor": 0, "roughnessFactor": 1}
        if texture is not None:
            base["baseColorTexture"] = {"index": texture}
        material = {"name": name, "pbrMetallicRoughness": base}
        strength = max(emission)
        if strength > 0:
            material["emissiveFactor"] = numbers([channel / max(strength, 1) for channel in emission])
        if strength > 1:
            material["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}
            self._extensions.add("KHR_materials_emissive_strength")
        if double_sided:
            material["doubleSided"] = True
        self.materials.append(material)
        return len(self.materials) - 1

    def checker_texture(self, colors, squares, square_size):
        """A PNG of squares x squares fields of two sRGB colours, nearest filtering, repeated."""
        field = (np.add.outer(np.arange(squares), np.arange(squares)) % 2).repeat(square_size, 0).repeat(square_size, 1)
        self._images.append({"mimeType": "image/png", "bufferView": self._view(_png(np.array(colors, np.uint8)[field]))})
        self.textures.append({"source": len(self._images) - 1, "sampler": 0})
        return len(self.textures) - 1

    def mesh(self, name, parts):
        """parts: (shape, material) pairs, one primitive each."""
        self.meshes.append({"name": name, "primitives": [self._primitive(shape, material) for shape, material in parts]})
        self._shapes.append(list(parts))
        return len(self.meshes) - 1

    def node(self, name, children=(), root=True, **content):
        """content: mesh, translation, rotation, scale or matrix as glTF has them. A child must say root=False."""
        node = {"name": name, **{key: value for key, value in content.items() if value is not None}}
        if children:
            node["children"] = list(children)
        self.nodes.append((node, root))
        return len(self.nodes) - 1

    def place(self, name, shape, material):
        """One shape as a mesh and a node of the same name, in world coordinates."""
        return self.node(name, mesh=self.mesh(name, [(shape, material)]))

    def camera(self, name, position, target, degrees, aspect=1):
        """A perspective camera; degrees: its vertical field of view."""
        perspective = {"yfov": number(math.radians(degrees)), "aspectRatio": aspect, "znear": 0.01, "zfar": 1000}
        self.cameras.append({"name": name, "type": "perspective", "perspective": perspective})
        self.node(name, camera=len(self.cameras) - 1, **_pose(position, target))

    def light(self, kind, color, intensity, position=(0, 0, 0), target=(0, 0, -1), cone=None):
        """kind: point, spot or directional; shines from position to target; cone: inner and outer angle in radians."""
        light = {"name": kind, "type": kind, "color": numbers(color), "intensity": intensity}
        if cone:
            light["spot"] = {"innerConeAngle": cone[0], "outerConeAngle": cone[1]}
        self.lights.append(light)
        self._extensions.add("KHR_lights_punctual")
        reference = {"KHR_lights_punctual": {"light": len(self.lights) - 1}}
        self.node(f"{kind} light {len(self.lights)}", extensions=reference, **_pose(position, target))

    # --- what it is ------------------------------------------------------------------------------------------------

    def measure(self):
        """Triangles, areas and box of everything in the scene, in world coordinates."""
        triangles, area, lit_area, emissive_area, corners = 0, 0.0, 0.0, 0.0, []
        for world, mesh in self._instances():
            for shape, material_index in self._shapes[mesh]:
                positions = shape.positions.astype(np.float64) @ world[:3, :3].T + world[:3, 3]
                a, b, c = positions[shape.indices.reshape(-1, 3)].transpose(1, 0, 2)
                part = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()
                material = self.materials[material_index]
                triangles += len(a)
                area += part
                lit_area += part * (2 if material.get("doubleSided") else 1)
                emissive_area += part if "emissiveFactor" in material else 0
                corners.append(positions)
        corners = np.concatenate(corners)
        return {
            "triangles": triangles,
            "area": number(area),
            "lit_area": number(lit_area),
            "emissive_area": number(emissive_area),
            "lights": len(self.lights),
            "cameras": len(self.cameras),
            "box": [numbers(corners.min(0)), numbers(corners.max(0))],
        }

    def _instances(self):
        """World matrix (column vectors) and mesh of every node that has one."""
        stack = [(index, np.eye(4)) for index, (_, root) in enumerate(self.nodes) if root]
        while stack:
            index, parent = stack.pop()
            node = self.nodes[index][0]
            world = parent @ _matrix(node)
            if "mesh" in node:
                yield world, node["mesh"]
            stack += [(child, world) for child in node.get("children", [])]

    # --- how it is stored ------------------------------------------------------------------------------------------

    def text(self):
        """The file's content."""
        document = {
            "asset": {"version": "2.0", "generator": "vmap scenes/make_scenes.py"},
            "extensionsUsed": sorted(self._extensions),
            "scene": 0,
            "scenes": [{"nodes": [index for index, (_, root) in enumerate(self.nodes) if root]}],
            "nodes": [node for node, _ in self.nodes],
            "meshes": self.meshes,
            "materials": self.materials,
            "cameras": self.cameras,
            "textures": self.textures,
            "images": self._images,
            "samplers": [{"magFilter": 9728, "minFilter": 9728}] if self.textures else [],
            "accessors": self._accessors,
            "bufferViews": self._views,
            "buffers": [{"byteLength": len(self._buffer), "uri": _data_uri(self._buffer)}],
            "extensions": {"KHR_lights_punctual": {"lights": self.lights}} if self.lights else {},
        }
        document = {key: value for key, value in document.items() if value != [] and value != {}}
        return json.dumps(document, indent=1, default=number) + "\n"

    def _primitive(self, shape, material):
        attributes = {"POSITION": self._accessor(shape.positions, FLOAT, "VEC3", bounds=True)}
        if shape.normals is not None:
            attributes["NORMAL"] = self._accessor(shape.normals, FLOAT, "VEC3")
        if shape.uvs is not None:
            attributes["TEXCOORD_0"] = self._accessor(shape.uvs, FLOAT, "VEC2")
        return {"attributes": attributes, "indices": self._accessor(shape.indices, USHORT, "SCALAR"), "material": material}

    def _accessor(self, array, component, kind, bounds=False):
        accessor = {"bufferView": self._view(array.tobytes()), "componentType": component, "count": len(array), "type": kind}
        if bounds:
            accessor["min"], accessor["max"] = ([float(x) for x in limit] for limit in (array.min(0), array.max(0)))
        self._accessors.append(accessor)
        return len(self._accessors) - 1

    def _view(self, data):
        self._buffer += bytes(-len(self._buffer) % 4)
        self._views.append({"buffer": 0, "byteOffset": len(self._buffer), "byteLength": len(data)})
        self._buffer += data
        return len(self._views) - 1


def number(value):
    """Nine significant digits, so that the last bit of a square root does not reach the file."""
    value = float(f"{float(value):.9g}")
    return int(value) if value.is_integer() and abs(value) < 1e15 else value


def numbers(values):
    return [number(value) for value in values]


def _data_uri(data):
    return "data:application/octet-stream;base64," + base64.b64encode(bytes(data)).decode()


def _pose(position, target):
    """Translation and rotation of a node whose -Z looks from position to target, with +Y (else -Z) upwards."""
    back = np.array(position, float) - np.array(target, float)
    back /= np.linalg.norm(back)
    up = np.array([0.0, 1, 0]) if abs(back[1]) < 0.999 else np.array([0.0, 0, -1])
    right = np.cross(up, back)
    right /= np.linalg.norm(right)
    return {"translation": numbers(position), "rotation": numbers(_quaternion(right, np.cross(back, right), back))}


def _quaternion(x, y, z):
    """(x, y, z, w) of the rotation whose columns are three axes (Shepperd's method, largest component first)."""
    squares = [1 + x[0] - y[1] - z[2], 1 - x[0] + y[1] - z[2], 1 - x[0] - y[1] + z[2], 1 + x[0] + y[1] + z[2]]
    rows = [
        (squares[0], x[1] + y[0], z[0] + x[2], y[2] - z[1]),
        (x[1] + y[0], squares[1], y[2] + z[1], z[0] - x[2]),
        (z[0] + x[2], y[2] + z[1], squares[2], x[1] - y[0]),
        (y[2] - z[1], z[0] - x[2], x[1] - y[0], squares[3]),
    ]
    row = np.array(rows[int(np.argmax(squares))])
    return row / np.linalg.norm(row)


def _matrix(node):
    """Local matrix of a node, column vectors."""
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    rotation = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    matrix = np.eye(4)
    matrix[:3, :3] = rotation * np.array(node.get("scale", (1, 1, 1)), float)
    matrix[:3, 3] = node.get("translation", (0, 0, 0))
    return matrix


def _png(pixels):
    """An RGB picture as PNG. Stored, not compressed, so that the bytes do not depend on the version of zlib."""
    height, width, _ = pixels.shape
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    blocks = [rows[start : start + 65535] for start in range(0, len(rows), 65535)]
    stored = b"\x78\x01"
    for index, block in enumerate(blocks):
        stored += struct.pack("<BHH", index == len(blocks) - 1, len(block), len(block) ^ 0xFFFF) + block
    stored += struct.pack(">I", zlib.adler32(rows))
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = ((b"IHDR", header), (b"IDAT", stored), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)) for kind, data in chunks
    )
