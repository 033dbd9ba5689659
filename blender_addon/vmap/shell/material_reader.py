# SPDX-License-Identifier: GPL-3.0-or-later
"""The diffuse and the emitting part of Blender's materials, as far as a glTF file can say them.

Follows the nodes from the output: Principled, Diffuse and Emission shaders, their sums and mixtures, through groups and
reroutes. A color is a constant times at most one image texture times at most one color attribute. What does not fit is
replaced by the socket's own value and named.
"""

from dataclasses import dataclass, field

import numpy as np

from ..core.color import srgb_bytes_from_linear
from ..core.scene_model import SceneMaterial, TextureImage
from .compat import uses_nodes

WHITE, BLACK = (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)
PROCEDURAL = "node that is not carried (its input counts as unlinked)"


@dataclass
class Texture:
    """An image as a surface looks it up."""

    image: int  # index into Scene.images
    uv_map: str = ""  # "": the one that renders
    mapping: tuple = ()  # location, rotation, scale of a Mapping node, or nothing


@dataclass
class Color:
    factor: tuple = WHITE
    texture: Texture = None
    attribute: str = ""


@dataclass
class Surface:
    """What the walk finds: diffuse and emitted color."""

    albedo: Color = field(default_factory=lambda: Color(BLACK))
    emission: Color = field(default_factory=lambda: Color(BLACK))
    alpha_cut: bool = False
    sockets: int = 0


class MaterialReader:
    """Adds materials and images to a Scene, each once."""

    def __init__(self, scene):
        self.scene = scene
        self.images = {}
        self.known = {}  # Blender's name -> (index, Surface)

    def read(self, material):
        """Index of the SceneMaterial and the Surface behind it; None is Blender's default white-grey."""
        name = material.name if material else ""
        if name not in self.known:
            surface = _Walk(self, material).surface() if material else Surface(Color((0.8, 0.8, 0.8)))
            entry = SceneMaterial(name or "default")
            entry.base_color = surface.albedo.factor
            entry.base_texture = surface.albedo.texture.image if surface.albedo.texture else None
            entry.alpha_cut = surface.alpha_cut
            entry.emission = surface.emission.factor
            entry.emission_texture = surface.emission.texture.image if surface.emission.texture else None
            self.scene.materials.append(entry)
            self.known[name] = (len(self.scene.materials) - 1, surface)
        return self.known[name]

    def image(self, node):
        """Index of the node's image, or None when it has no pixels."""
        image = node.image.original if node.image else None
        if image is None or not image.size[0] or not image.size[1] or image.source == "TILED":
            return None
        key = (image.name, node.extension, node.interpolation)
        if key not in self.images:
            repeat, nearest = node.extension == "REPEAT", node.interpolation == "Closest"
            self.scene.images.append(TextureImage(image.name, _srgb_pixels(image), repeat, nearest))
            self.images[key] = len(self.scene.images) - 1
        return self.images[key]


def _srgb_pixels(image):
    """(height, width, 4) 8-bit pixels, rows from the top, sRGB whatever the image's own color space is."""
    width, height = image.size
    values = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(values)
    values = values.reshape(height, width, image.channels)[::-1]
    if image.channels < 3:
        values = np.repeat(values[:, :, :1], 3, axis=2)
    # Blender keeps the bytes of 8-bit images as they are in the file, and floats linear.
    encoded = not image.is_float and image.colorspace_settings.name == "sRGB"
    colors = values[:, :, :3]
    pixels = np.full((height, width, 4), 255, np.uint8)
    pixels[:, :, :3] = np.rint(np.clip(colors, 0, 1) * 255) if encoded else srgb_bytes_from_linear(colors)
    if values.shape[2] == 4:
        pixels[:, :, 3] = np.rint(np.clip(values[:, :, 3], 0, 1) * 255)
    return pixels


class _Walk:
    """One material. Places are (node, stack of group nodes around it)."""

    def __init__(self, reader, material):
        self.reader = reader
        self.material = material

    def surface(self):
        if not uses_nodes(self.material):
            return Surface(Color(tuple(self.material.diffuse_color[:3])))
        tree = self.material.node_tree
        output = tree.get_output_node("CYCLES") or tree.get_output_node("ALL") or tree.get_output_node("EEVEE")
        surface = Surface()
        if output is None or not output.inputs["Surface"].is_linked:
            return surface
        if output.inputs["Volume"].is_linked:
            self.skip("volume in a material")
        self.add(surface, *self.source(output.inputs["Surface"], ()), 1.0)
        return surface

    def skip(self, feature):
        self.reader.scene.skip(feature, self.material.name)

    # --- shaders ---

    def add(self, surface, node, stack, weight):
        """Adds what this shader node reflects and emits, times the weight."""
        if node is None or weight <= 0:
            return
        kind = node.type
        if kind == "BSDF_PRINCIPLED":
            self.add_principled(surface, node, stack, weight)
        elif kind in {"BSDF_DIFFUSE", "SUBSURFACE_SCATTERING", "BSDF_SHEEN"}:
            if kind != "BSDF_DIFFUSE":
                self.skip(f"{node.bl_label} shader (counts as diffuse)")
            self.mix(surface, "albedo", self.color(node.inputs["Color"], stack), weight)
        elif kind == "EMISSION":
            strength = self.number(node.inputs["Strength"], stack)
            self.mix(surface, "emission", self.color(node.inputs["Color"], stack), weight * strength)
        elif kind == "ADD_SHADER":
            for socket in node.inputs:
                self.add(surface, *self.source(socket, stack), weight)
        elif kind == "MIX_SHADER":
            share = min(max(self.number(node.inputs[0], stack), 0.0), 1.0)
            self.add_mixed(surface, node, stack, weight, share)
        elif kind == "BSDF_TRANSPARENT":
            self.skip("transparency (counts as a black surface)")
        else:
            self.skip(f"{node.bl_label} shader (counts as black)")

    def add_mixed(self, surface, node, stack, weight, share):
        first, second = self.source(node.inputs[1], stack), self.source(node.inputs[2], stack)
        if first[0] is not None and first[0].type == "BSDF_TRANSPARENT" and node.inputs[0].is_linked:
            # The usual cut-out: transparent mixed with a surface by the alpha of its texture.
            surface.alpha_cut = True
            self.add(surface, *second, weight)
            return
        self.add(surface, *first, weight * (1 - share))
        self.add(surface, *second, weight * share)

    def add_principled(self, surface, node, stack, weight):
        inputs = node.inputs
        metallic = min(max(self.number(inputs["Metallic"], stack), 0.0), 1.0)
        base = self.color(inputs["Base Color"], stack)
        self.mix(surface, "albedo", base, weight * (1 - metallic))
        transmission = inputs.get("Transmission Weight") or inputs.get("Transmission")
        if metallic > 0:
            self.skip("metallic surface (its share counts as black)")
        elif self.specular(inputs):
            self.skip("specular reflection (only the diffuse part of a Principled shader counts)")
        if transmission and (transmission.is_linked or transmission.default_value > 0):
            self.skip("transmission (counts as diffuse)")
        alpha = inputs["Alpha"]
        if alpha.is_linked and base.texture:
            surface.alpha_cut = True
        elif alpha.is_linked or alpha.default_value < 1:
            self.skip("transparency (counts as opaque)")

        strength = self.number(inputs["Emission Strength"], stack)
        if strength > 0:
            glow = inputs.get("Emission Color") or inputs.get("Emission")
            self.mix(surface, "emission", self.color(glow, stack), weight * strength)

    @staticmethod
    def specular(inputs):
        socket = inputs.get("Specular IOR Level") or inputs.get("Specular")
        return socket is None or socket.is_linked or socket.default_value > 0

    def mix(self, surface, part, color, weight):
        """Adds weight * color to the part; only one of the summands can keep a texture."""
        factor = tuple(float(c) * weight for c in color.factor)
        if max(factor) <= 0:
            return
        present = getattr(surface, part)
        if max(present.factor) <= 0:
            setattr(surface, part, Color(factor, color.texture, color.attribute))
            if part == "emission" and color.attribute:
                self.skip("color attribute in an emission (counts as white)")
            return
        if present.texture or present.attribute or color.texture or color.attribute:
            self.skip("sum of several textures (one is kept)")
        else:
            setattr(surface, part, Color(tuple(a + b for a, b in zip(present.factor, factor))))

    # --- values ---

    def number(self, socket, stack):
        node, stack, source = self.linked(socket, stack)
        if node is None:
            return float(source.default_value)
        if node.type == "VALUE":
            return float(source.default_value)
        self.skip(f"{node.bl_label} {PROCEDURAL}")
        return float(socket.default_value)

    def color(self, socket, stack):
        node, stack, source = self.linked(socket, stack)
        if node is None:
            return Color(_rgb(source.default_value))
        color = self.color_of(node, stack, source)
        if color is None:
            self.skip(f"{node.bl_label} {PROCEDURAL}")
            return Color(_rgb(socket.default_value))
        return color

    def color_of(self, node, stack, source):
        """Color that a node sends out of a socket; None when a constant, a texture and an attribute cannot say it."""
        if node.type in {"RGB", "VALUE"}:
            return Color(_rgb(source.default_value))
        if node.type == "TEX_IMAGE" and source.name == "Color":
            return self.texture_color(node, stack)
        if node.type in {"VERTEX_COLOR", "ATTRIBUTE"} and source.name in {"Color", "Vector"}:
            name = node.layer_name if node.type == "VERTEX_COLOR" else node.attribute_name
            geometry = node.type == "VERTEX_COLOR" or node.attribute_type == "GEOMETRY"
            return Color(attribute=name) if geometry and name else None
        if node.type in {"MIX", "MIX_RGB"} and node.blend_type == "MULTIPLY":
            return self.product(node, stack)
        return None

    def product(self, node, stack):
        if node.type == "MIX" and node.data_type != "RGBA":
            return None
        share, first, second = [s for s in node.inputs if s.enabled and (node.type != "MIX" or _used_by_colors(s))]
        if share.is_linked or share.default_value < 1:
            return None
        a, b = self.color(first, stack), self.color(second, stack)
        if (a.texture and b.texture) or (a.attribute and b.attribute):
            return None
        factor = tuple(x * y for x, y in zip(a.factor, b.factor))
        return Color(factor, a.texture or b.texture, a.attribute or b.attribute)

    def texture_color(self, node, stack):
        image = self.reader.image(node)
        if image is None:
            return None
        lookup, inner, source = self.linked(node.inputs["Vector"], stack)
        mapping = ()
        if lookup is not None and lookup.type == "MAPPING" and lookup.vector_type == "POINT":
            values = [lookup.inputs[name] for name in ("Location", "Rotation", "Scale")]
            if any(value.is_linked for value in values):
                return None
            mapping = tuple(tuple(value.default_value) for value in values)
            lookup, inner, source = self.linked(lookup.inputs["Vector"], inner)
        if lookup is None:
            return Color(texture=Texture(image, "", mapping))
        if lookup.type == "UVMAP":
            return Color(texture=Texture(image, lookup.uv_map, mapping))
        if lookup.type == "TEX_COORD" and source.name == "UV":
            return Color(texture=Texture(image, "", mapping))
        return None

    # --- links ---

    def source(self, socket, stack):
        node, stack, _ = self.linked(socket, stack)
        return node, stack

    def linked(self, socket, stack):
        """Node that feeds the socket, the groups around it and the socket it comes from.

        Without a link the node is None and the socket is the one whose value counts.
        """
        while socket.is_linked and socket.links and not socket.links[0].is_muted:
            origin = socket.links[0].from_socket
            node = origin.node
            if node.type == "REROUTE":
                socket = node.inputs[0]
            elif node.type == "GROUP" and node.node_tree:
                inside = next(
                    (n for n in node.node_tree.nodes if n.type == "GROUP_OUTPUT" and n.is_active_output), None
                )
                if inside is None:
                    return None, stack, socket
                stack, socket = (*stack, node), inside.inputs[list(node.outputs).index(origin)]
            elif node.type == "GROUP_INPUT" and stack:
                outer = stack[-1]
                stack, socket = stack[:-1], outer.inputs[list(node.outputs).index(origin)]
            else:
                return node, stack, origin
        return None, stack, socket


def _used_by_colors(socket):
    return socket.type == "RGBA" or socket.name == "Factor"


def _rgb(value):
    try:
        return tuple(float(c) for c in value[:3])
    except TypeError:
        return (float(value),) * 3
