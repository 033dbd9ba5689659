# SPDX-License-Identifier: GPL-3.0-or-later
"""Where Blender's versions differ, asked of Blender itself."""

import bpy

HAS_FILE_HANDLERS = hasattr(bpy.types, "FileHandler")
HAS_SAMPLE_GRID = hasattr(bpy.types, "GeometryNodeSampleGrid")
# EEVEE draws point clouds since it was written anew; before (seen in 3.4) it leaves them out.
EEVEE_DRAWS_POINTS = "surface_render_method" in bpy.types.Material.bl_rna.properties


def node_tree_of(owner):
    """Node tree of a material, world or light; made when there is none."""
    if owner.node_tree is None:
        owner.use_nodes = True
    return owner.node_tree


def uses_nodes(owner):
    """Whether the owner's nodes count. From 5.0 on materials and worlds always use them."""
    return owner.node_tree is not None and getattr(owner, "use_nodes", True)


def new_socket(group, name, kind, is_output=False):
    """Adds a socket to the interface of a node group; returns its identifier."""
    if hasattr(group, "interface"):
        socket = group.interface.new_socket(name, in_out="OUTPUT" if is_output else "INPUT", socket_type=kind)
    else:
        socket = (group.outputs if is_output else group.inputs).new(kind, name)
    return socket.identifier


def input_identifier(group, name):
    """Identifier of the input of this name."""
    if hasattr(group, "interface"):
        items = (i for i in group.interface.items_tree if i.item_type == "SOCKET" and i.in_out == "INPUT")
    else:
        items = iter(group.inputs)
    return next(i.identifier for i in items if i.name == name)


def set_input(modifier, name, value):
    """Sets an input of a Geometry Nodes modifier."""
    identifier = input_identifier(modifier.node_group, name)
    try:
        modifier[identifier] = value
    except TypeError:
        getattr(modifier.properties.inputs, identifier).value = value
    modifier.id_data.update_tag()


def draw_input(layout, modifier, name):
    """Shows an input of a Geometry Nodes modifier in a panel."""
    identifier = input_identifier(modifier.node_group, name)
    if identifier in modifier.keys():
        layout.prop(modifier, f'["{identifier}"]', text=name)
    elif hasattr(modifier, "properties"):
        layout.prop(getattr(modifier.properties.inputs, identifier), "value", text=name)


def enabled(sockets, name=None):
    """The socket that is in use; older nodes have one for each type under the same name."""
    return next(s for s in sockets if s.enabled and (name is None or s.name == name))


def fill(sequence, name, array):
    """foreach_set of a numpy array; Blender wants it flat."""
    sequence.foreach_set(name, array.reshape(-1))


def point_clouds_resize():
    return "resize" in bpy.types.PointCloud.bl_rna.functions
