# SPDX-License-Identifier: GPL-3.0-or-later
"""The material of lit points: shows what their attributes say, whatever lights the scene has.

One branch for each way to look at them; the switch links one of them to the Emission node:
  lit         exposure (emission + albedo irradiance / pi): the radiance that the points send out
  irradiance  exposure irradiance / pi: the same on white paper
  albedo, normals: as they are

A point is seen from the side that its normal points to only: the two sides of a wall do not show through each other.
"""

import math

import bpy

from .compat import node_tree_of

WAYS = (
    ("LIT", "Lit color", "Light that the points send out, times the exposure"),
    ("IRRADIANCE", "Irradiance", "Light that arrives, as white paper would show it, times the exposure"),
    ("ALBEDO", "Albedo", "Color of the surface without light"),
    ("NORMALS", "Normals", "Direction of the surface as a color"),
)
EXPOSURE_NODE, EMISSION_NODE, BRANCH_PREFIX = "vmap exposure", "vmap shown", "vmap branch "
MARK = "vmap_points"


def point_material(name, has, exposure, way):
    """A new material; has: names of the attributes that exist."""
    material = bpy.data.materials.new(name)
    material[MARK] = True
    tree = node_tree_of(material)
    tree.nodes.clear()
    builder = _Builder(tree)
    builder.build(has, exposure)
    _keep_out_of_light_sampling(material)
    if hasattr(material, "blend_method"):
        material.blend_method = "CLIP"  # what EEVEE before 4.2 needs to cut something out
    set_way(material, way)
    return material


def is_point_material(material):
    return material is not None and MARK in material


def ways_of(material):
    """Identifiers of the branches that this material has."""
    nodes = material.node_tree.nodes
    return [way for way, _, _ in WAYS if BRANCH_PREFIX + way in nodes]


def get_way(material):
    links = material.node_tree.nodes[EMISSION_NODE].inputs["Color"].links
    return links[0].from_node.name[len(BRANCH_PREFIX) :] if links else "LIT"


def set_way(material, way):
    nodes = material.node_tree.nodes
    branch = nodes.get(BRANCH_PREFIX + way)
    if branch:
        material.node_tree.links.new(branch.outputs[0], nodes[EMISSION_NODE].inputs["Color"])


def exposure_socket(material):
    return material.node_tree.nodes[EXPOSURE_NODE].outputs[0]


class _Builder:
    def __init__(self, tree):
        self.tree = tree
        self.row = 0

    def build(self, has, exposure):
        value = self.node("ShaderNodeValue", EXPOSURE_NODE)
        value.label = "Exposure"
        value.outputs[0].default_value = exposure
        emission = self.node("ShaderNodeEmission", EMISSION_NODE)
        output = self.node("ShaderNodeOutputMaterial")
        shown = self.seen_from_its_front(emission.outputs[0]) if "normals" in has else emission.outputs[0]
        self.tree.links.new(shown, output.inputs["Surface"])

        irradiance = self.attribute("irradiance") if "irradiance" in has else None
        albedo = self.attribute("albedo") if "albedo" in has else None
        light = None
        if irradiance:
            white = self.vector("SCALE", irradiance, scale=1 / math.pi)
            self.branch("IRRADIANCE", "SCALE", white, scale=value.outputs[0])
            light = self.vector("MULTIPLY", white, albedo) if albedo else white
        if "emission" in has:
            glow = self.attribute("emission")
            light = self.vector("ADD", light, glow) if light else glow
        if light:
            self.branch("LIT", "SCALE", light, scale=value.outputs[0])
        if albedo:
            self.branch("ALBEDO", "SCALE", albedo, scale=1.0)
        if "normals" in has:
            self.branch("NORMALS", "MULTIPLY_ADD", self.attribute("nrm"), (0.5, 0.5, 0.5), (0.5, 0.5, 0.5))

    def seen_from_its_front(self, shader):
        turn = self.node("ShaderNodeVectorTransform")
        turn.vector_type, turn.convert_from, turn.convert_to = "NORMAL", "OBJECT", "WORLD"
        self.tree.links.new(self.attribute("nrm"), turn.inputs[0])
        facing = self.node("ShaderNodeVectorMath")
        facing.operation = "DOT_PRODUCT"
        self.tree.links.new(turn.outputs[0], facing.inputs[0])
        self.tree.links.new(self.node("ShaderNodeNewGeometry").outputs["Incoming"], facing.inputs[1])
        front = self.node("ShaderNodeMath")
        front.operation = "GREATER_THAN"
        front.inputs[1].default_value = -1e-6  # a point without a normal has no back
        self.tree.links.new(facing.outputs["Value"], front.inputs[0])
        mix = self.node("ShaderNodeMixShader")
        self.tree.links.new(front.outputs[0], mix.inputs[0])
        self.tree.links.new(self.node("ShaderNodeBsdfTransparent").outputs[0], mix.inputs[1])
        self.tree.links.new(shader, mix.inputs[2])
        return mix.outputs[0]

    def node(self, kind, name=None):
        node = self.tree.nodes.new(kind)
        if name:
            node.name = name
        node.location = (250 * (self.row % 5), -180 * (self.row // 5))
        self.row += 1
        return node

    def attribute(self, name):
        node = self.node("ShaderNodeAttribute")
        node.attribute_type = "GEOMETRY"
        node.attribute_name = name
        return node.outputs["Vector"]

    def vector(self, operation, *operands, scale=None, name=None):
        node = self.node("ShaderNodeVectorMath", name)
        node.operation = operation
        sockets = [*operands, *([scale] if scale is not None else [])]
        inputs = [*node.inputs[: len(operands)], *([node.inputs["Scale"]] if scale is not None else [])]
        for source, target in zip(sockets, inputs):
            if isinstance(source, bpy.types.NodeSocket):
                self.tree.links.new(source, target)
            else:
                target.default_value = source
        return node.outputs[0]

    def branch(self, way, operation, *operands, scale=None):
        self.vector(operation, *operands, scale=scale, name=BRANCH_PREFIX + way)


def _keep_out_of_light_sampling(material):
    """A million glowing points are no lamps that Cycles should pick one by one."""
    settings = getattr(material, "cycles", None)
    if settings is None:
        return
    if hasattr(settings, "emission_sampling"):
        settings.emission_sampling = "NONE"
    elif hasattr(settings, "sample_as_light"):
        settings.sample_as_light = False
