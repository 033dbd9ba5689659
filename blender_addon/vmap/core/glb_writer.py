# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a Scene as a binary glTF 2.0 file. One root node turns Blender's frame into glTF's."""

import json
import math
import struct

import numpy as np

from .axes import GLTF_FROM_BLENDER
from .errors import AddonError
from .png import png_bytes

FLOAT, UINT32 = 5126, 5125
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
CLAMP, REPEAT, NEAREST, LINEAR = 33071, 10497, 9728, 9729
LARGEST_FILE = (1 << 32) - 1


def write_glb(path, scene):
    """The file of this Scene; lights in W/sr and W/m^2 (`--light-units compat`)."""
    document, chunks = _Writer(scene).result()
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    size = sum(len(c) for c in chunks)
    total = 12 + 8 + len(text) + 8 + size
    if total > LARGEST_FILE:
        raise AddonError(f"the scene takes {total / 1e9:.1f} GB, more than the 4 GB that a glTF file can hold")
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, total))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", size, b"BIN\0"))
        for chunk in chunks:
            file.write(chunk)


class _Writer:
    def __init__(self, scene):
        self.scene = scene
        self.chunks, self.size = [], 0
        self.views, self.accessors = [], []
        self.extensions = set()

    def result(self):
        scene = self.scene
        images = [self._image(i) for i in scene.images]
        materials = [self._material(m) for m in scene.materials]
        meshes = [{"name": m.name, "primitives": [self._primitive(p) for p in m.parts]} for m in scene.meshes]
        nodes = [{"mesh": p.mesh, "name": p.source or "lamp", **_matrix(p.matrix)} for p in scene.placements]
        lights = []
        for light in scene.lights:
            nodes.append({"extensions": {"KHR_lights_punctual": {"light": len(lights)}}, **_matrix(light.matrix)})
            lights.append(_light(light))
        if scene.camera:
            nodes.append({"camera": 0, "name": "camera", **_matrix(scene.camera.matrix)})
        root = {"name": "Z up", "children": list(range(1, len(nodes) + 1)), **_matrix(GLTF_FROM_BLENDER)}

        document = {
            "asset": {"version": "2.0", "generator": "vmap Blender add-on"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [root if nodes else {"name": "Z up"}, *nodes],
            "meshes": meshes,
            "materials": materials,
            "images": images,
            "samplers": [_sampler(i) for i in scene.images],
            "textures": [{"source": i, "sampler": i} for i in range(len(images))],
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": self.size}] if self.size else [],
            "cameras": [_camera(scene.camera)] if scene.camera else [],
        }
        if lights:
            self.extensions.add("KHR_lights_punctual")
            document["extensions"] = {"KHR_lights_punctual": {"lights": lights}}
        document["extensionsUsed"] = sorted(self.extensions)
        return {key: value for key, value in document.items() if value not in ([], {})}, self.chunks

    def _view(self, data, target=None):
        data = bytes(data)
        view = {"buffer": 0, "byteOffset": self.size, "byteLength": len(data)}
        if target:
            view["target"] = target
        self.views.append(view)
        padded = data + b"\0" * (-len(data) % 4)
        self.chunks.append(padded)
        self.size += len(padded)
        return len(self.views) - 1

    def _accessor(self, array, kind, target=ARRAY_BUFFER, **bounds):
        component = UINT32 if array.dtype.kind == "u" else FLOAT
        view = self._view(np.ascontiguousarray(array).tobytes(), target)
        self.accessors.append(
            {
                "bufferView": view,
                "componentType": component,
                "count": array.size // _WIDTH[kind],
                "type": kind,
                **bounds,
            }
        )
        return len(self.accessors) - 1

    def _primitive(self, part):
        positions = np.asarray(part.positions, np.float32)
        bounds = {"min": positions.min(axis=0).tolist(), "max": positions.max(axis=0).tolist()}
        attributes = {"POSITION": self._accessor(positions, "VEC3", **bounds)}
        for index, uvs in enumerate(_texcoords(part)):
            attributes[f"TEXCOORD_{index}"] = self._accessor(uvs, "VEC2")
        if part.colors is not None:
            attributes["COLOR_0"] = self._accessor(np.asarray(part.colors, np.float32), "VEC4")
        triangles = np.asarray(part.triangles, np.uint32).reshape(-1)
        indices = self._accessor(triangles, "SCALAR", ELEMENT_ARRAY_BUFFER)
        return {"attributes": attributes, "indices": indices, "material": part.material}

    def _image(self, image):
        return {"name": image.name, "mimeType": "image/png", "bufferView": self._view(png_bytes(image.pixels))}

    def _material(self, material):
        pbr = {"baseColorFactor": [*map(float, material.base_color), 1.0], "metallicFactor": float(material.metallic)}
        if material.base_texture is not None:
            pbr["baseColorTexture"] = {"index": material.base_texture}
        entry = {"name": material.name, "pbrMetallicRoughness": pbr, "doubleSided": material.double_sided}
        if material.alpha_cut:
            entry["alphaMode"] = "MASK"
        strength = float(max(material.emission))
        if strength > 0:
            entry["emissiveFactor"] = [float(channel) / strength for channel in material.emission]
            entry["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}
            self.extensions.add("KHR_materials_emissive_strength")
            if material.emission_texture is not None:
                entry["emissiveTexture"] = {"index": material.emission_texture, "texCoord": EMISSION_SET}
        return entry


_WIDTH = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
EMISSION_SET = 1


def _texcoords(part):
    """The sets of the part, v downwards: 0 for the base texture, 1 for the emission texture."""
    if part.uvs is None and part.emission_uvs is None:
        return []
    count = len(part.positions)
    sets = [part.uvs] if part.emission_uvs is None else [part.uvs, part.emission_uvs]
    flipped = [np.zeros((count, 2), np.float32) if s is None else np.array(s, np.float32) for s in sets]
    for uvs in flipped:
        uvs[:, 1] = 1 - uvs[:, 1]
    return flipped


def _matrix(matrix):
    matrix = np.asarray(matrix, np.float64)
    return {} if np.array_equal(matrix, np.eye(4)) else {"matrix": matrix.T.reshape(-1).tolist()}


def _light(light):
    entry = {"type": light.kind, "name": light.name, "color": list(map(float, light.color))}
    entry["intensity"] = float(light.intensity)
    if light.cone:
        entry["spot"] = {"innerConeAngle": light.cone[0], "outerConeAngle": light.cone[1]}
    return entry


def _camera(camera):
    if camera.half_height is not None:
        lens = {"xmag": camera.half_height * camera.aspect, "ymag": camera.half_height, "znear": 0.0, "zfar": 1e4}
        return {"type": "orthographic", "orthographic": lens}
    fov = min(camera.vertical_fov, math.pi * 0.99)
    return {"type": "perspective", "perspective": {"yfov": fov, "aspectRatio": camera.aspect, "znear": 1e-3}}


def _sampler(image):
    wrap = REPEAT if image.repeat else CLAMP
    filtering = NEAREST if image.nearest else LINEAR
    return {"wrapS": wrap, "wrapT": wrap, "magFilter": filtering, "minFilter": filtering}
