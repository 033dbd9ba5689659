# SPDX-License-Identifier: GPL-3.0-or-later
"""Geometry Nodes that show lit points at the size of their attribute "radius" times a factor, with a material."""

import bpy

from .compat import EEVEE_DRAWS_POINTS, enabled, new_socket

NOT_SHOWN = ("area", "face_id", "material_id", "radius")
SQUARE = 0.85  # half edge of a square that stands for a disc of radius 1
LIFT = 0.05  # of its middle above the point, so that the two sides of a sheet do not lie in one plane


def points_group(object_type, has_normals):
    """The node group for objects of this type; made when the file has none yet. Inputs: Material, Size."""
    if object_type == "POINTCLOUD":
        name, build = "vmap point size", _of_point_cloud
    elif EEVEE_DRAWS_POINTS:
        name, build = "vmap points of a mesh", _of_vertices
    elif has_normals:
        name, build = "vmap squares", _squares
    else:
        name, build = "vmap balls", _balls
    return bpy.data.node_groups.get(name) or _Builder(name, build).group


class _Builder:
    """Group Input -> what build makes of the geometry -> Set Material -> Group Output."""

    def __init__(self, name, build):
        self.group = bpy.data.node_groups.new(name, "GeometryNodeTree")
        new_socket(self.group, "Geometry", "NodeSocketGeometry")
        new_socket(self.group, "Material", "NodeSocketMaterial")
        new_socket(self.group, "Size", "NodeSocketFloat")
        new_socket(self.group, "Geometry", "NodeSocketGeometry", is_output=True)
        self.column = 0
        start = self.node("NodeGroupInput")
        self.size = start.outputs["Size"]
        shown = build(self, start.outputs["Geometry"])
        material, end = self.node("GeometryNodeSetMaterial"), self.node("NodeGroupOutput")
        self.link(shown, material.inputs["Geometry"])
        self.link(start.outputs["Material"], material.inputs["Material"])
        self.link(material.outputs[0], end.inputs["Geometry"])

    def node(self, kind, row=0, **values):
        made = self.group.nodes.new(kind)
        made.location = (200 * self.column, -200 * row)
        self.column += 1
        for key, value in values.items():
            setattr(made, key, value)
        return made

    def link(self, source, target):
        self.group.links.new(source, target)

    def attribute(self, name, kind):
        node = self.node("GeometryNodeInputNamedAttribute", 1, data_type=kind)
        node.inputs["Name"].default_value = name
        return enabled(node.outputs, "Attribute")

    def scaled(self, radius):
        node = self.node("ShaderNodeMath", 1, operation="MULTIPLY")
        self.link(radius, node.inputs[0])
        self.link(self.size, node.inputs[1])
        return node.outputs[0]


def _of_point_cloud(builder, points):
    node = builder.node("GeometryNodeSetPointRadius")
    builder.link(points, node.inputs[0])
    builder.link(builder.scaled(builder.node("GeometryNodeInputRadius", 2).outputs[0]), node.inputs["Radius"])
    return node.outputs[0]


def _of_vertices(builder, mesh):
    node = builder.node("GeometryNodeMeshToPoints")
    builder.link(mesh, node.inputs["Mesh"])
    builder.link(builder.attribute("radius", "FLOAT"), node.inputs["Radius"])
    # Scaled in a step of its own: some versions let the mesh's attribute win over what the conversion is told.
    return _of_point_cloud(builder, node.outputs[0])


def _squares(builder, mesh):
    """A square across the normal of each vertex."""
    square = builder.node("GeometryNodeMeshGrid", 1)
    for name, value in (("Size X", 2 * SQUARE), ("Size Y", 2 * SQUARE), ("Vertices X", 2), ("Vertices Y", 2)):
        square.inputs[name].default_value = value
    lift = builder.node("GeometryNodeTransform", 1)
    lift.inputs["Translation"].default_value = (0, 0, LIFT)
    builder.link(square.outputs["Mesh"], lift.inputs["Geometry"])
    turn = builder.node("FunctionNodeAlignEulerToVector", 2, axis="Z")
    builder.link(builder.attribute("nrm", "FLOAT_VECTOR"), turn.inputs["Vector"])
    return _instances(builder, mesh, lift.outputs["Geometry"], turn.outputs["Rotation"])


def _balls(builder, mesh):
    """A coarse ball around each vertex."""
    ball = builder.node("GeometryNodeMeshIcoSphere", 1)
    ball.inputs["Subdivisions"].default_value = 1
    return _instances(builder, mesh, ball.outputs["Mesh"], None)


def _instances(builder, mesh, instance, rotation):
    place = builder.node("GeometryNodeInstanceOnPoints")
    builder.link(mesh, place.inputs["Points"])
    builder.link(instance, place.inputs["Instance"])
    builder.link(builder.scaled(builder.attribute("radius", "FLOAT")), place.inputs["Scale"])
    if rotation:
        builder.link(rotation, place.inputs["Rotation"])
    geometry = place.outputs["Instances"]
    for name in NOT_SHOWN:  # each would take memory four times
        remove = builder.node("GeometryNodeRemoveAttribute")
        remove.inputs["Name"].default_value = name
        builder.link(geometry, remove.inputs["Geometry"])
        geometry = remove.outputs["Geometry"]
    realize = builder.node("GeometryNodeRealizeInstances")
    builder.link(geometry, realize.inputs[0])
    return realize.outputs[0]
