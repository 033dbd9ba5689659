# SPDX-License-Identifier: GPL-3.0-or-later
"""The scene as it goes to the program is the scene as the render shows it."""

import math
import os

import bpy
import numpy as np
import pytest
from blender_helpers import add_cube, add_light, add_mesh, add_plane, data_counts, diffuse, look
from mathutils import Matrix
from vmap.core.errors import AddonError
from vmap.shell import world_reader
from vmap.shell.compat import enabled, new_socket, node_tree_of
from vmap.shell.scene_reader import read_scene


@pytest.fixture(autouse=True)
def small_panoramas(monkeypatch):
    monkeypatch.setattr(world_reader, "WIDTH", 128)


def read(folder="", **options):
    return read_scene(bpy.context, bpy.context.scene.frame_current, str(folder), **options)


def world_triangles(scene, source=None):
    """(n, 3, 3) corners of all triangles in the world."""
    found = [np.zeros((0, 3, 3))]
    for placed in scene.placements:
        if source is None or placed.source == source:
            for part in scene.meshes[placed.mesh].parts:
                corners = part.positions[part.triangles].astype(float)
                found.append(corners @ placed.matrix[:3, :3].T + placed.matrix[:3, 3])
    return np.concatenate(found)


def areas(triangles):
    return np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1) / 2


# --- geometry ---


def test_modifiers_count_at_render_level(empty_scene):
    cube = add_cube(empty_scene, "cube")
    modifier = cube.modifiers.new("subdivision", "SUBSURF")
    modifier.levels, modifier.render_levels = 0, 2
    assert read().triangle_count() == 6 * 4 * 4 * 2
    modifier.show_render = False
    assert read().triangle_count() == 12


def test_what_the_render_hides_is_left_out_and_what_only_the_viewport_hides_is_not(empty_scene):
    for name in ("shown", "render", "viewport", "eye", "collection"):
        add_plane(empty_scene, name)
    bpy.data.objects["render"].hide_render = True
    bpy.data.objects["viewport"].hide_viewport = True
    bpy.context.view_layer.update()
    bpy.data.objects["eye"].hide_set(True)
    hidden = bpy.data.collections.new("hidden")
    hidden.hide_render = True
    empty_scene.collection.children.link(hidden)
    empty_scene.collection.objects.unlink(bpy.data.objects["collection"])
    hidden.objects.link(bpy.data.objects["collection"])
    assert {p.source for p in read().placements} == {"shown", "viewport", "eye"}


def test_collection_instances_share_one_mesh(empty_scene):
    cube = add_cube(empty_scene, "cube")
    group = bpy.data.collections.new("group")
    group.objects.link(cube)
    empty_scene.collection.objects.unlink(cube)
    for number in range(3):
        empty = bpy.data.objects.new(f"empty {number}", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", group
        empty.location.x = 5 * number
        empty_scene.collection.objects.link(empty)
    scene = read()
    assert len(scene.meshes) == 1 and len(scene.placements) == 3
    assert sorted(round(p.matrix[0, 3]) for p in scene.placements) == [0, 5, 10]
    assert all(p.source == "" for p in scene.placements)


def instancing_group(instance):
    """Geometry Nodes: a copy of the object at each vertex, and the vertices' own mesh no more."""
    group = bpy.data.node_groups.new("instances", "GeometryNodeTree")
    new_socket(group, "Geometry", "NodeSocketGeometry")
    new_socket(group, "Geometry", "NodeSocketGeometry", is_output=True)
    start, info, points, end = (group.nodes.new(kind) for kind in (
        "NodeGroupInput", "GeometryNodeObjectInfo", "GeometryNodeInstanceOnPoints", "NodeGroupOutput"))  # fmt: skip
    info.inputs["Object"].default_value = instance
    group.links.new(start.outputs[0], points.inputs["Points"])
    group.links.new(enabled(info.outputs, "Geometry"), points.inputs["Instance"])
    group.links.new(points.outputs[0], end.inputs[0])
    return group


def test_geometry_nodes_instances_are_there(empty_scene):
    cube = add_cube(empty_scene, "cube", size=0.5)
    cube.hide_render = True
    plane = add_plane(empty_scene, "plane", size=4.0)
    plane.modifiers.new("nodes", "NODES").node_group = instancing_group(cube)
    scene = read()
    assert scene.triangle_count() == 4 * 12
    assert len(scene.meshes) == 1
    triangles = world_triangles(scene)
    np.testing.assert_allclose(triangles.reshape(-1, 3).max(axis=0), [2.25, 2.25, 0.25])
    assert areas(triangles).sum() == pytest.approx(4 * 6 * 0.25)


def test_instances_of_geometry_without_an_object_keep_their_shapes(empty_scene):
    """A small cube and a large one, made by nodes, at each of two vertices."""
    group = bpy.data.node_groups.new("shapes", "GeometryNodeTree")
    new_socket(group, "Geometry", "NodeSocketGeometry")
    new_socket(group, "Geometry", "NodeSocketGeometry", is_output=True)
    start, join, end = (group.nodes.new(k) for k in ("NodeGroupInput", "GeometryNodeJoinGeometry", "NodeGroupOutput"))
    for size in (0.5, 1.0):
        cube, points = (group.nodes.new(k) for k in ("GeometryNodeMeshCube", "GeometryNodeInstanceOnPoints"))
        cube.inputs["Size"].default_value = (size, size, size)
        group.links.new(start.outputs[0], points.inputs["Points"])
        group.links.new(cube.outputs["Mesh"], points.inputs["Instance"])
        group.links.new(points.outputs[0], join.inputs[0])
    group.links.new(join.outputs[0], end.inputs[0])
    item = add_mesh(empty_scene, "points", [(0, 0, 0), (5, 0, 0)], [])
    item.modifiers.new("nodes", "NODES").node_group = group
    scene = read()
    assert areas(world_triangles(scene)).sum() == pytest.approx(2 * 6 * (0.25 + 1.0))


@pytest.mark.parametrize("make", ["metaball", "surface"])
def test_metaballs_and_surfaces_are_their_meshes(empty_scene, make):
    if make == "surface":
        bpy.ops.surface.primitive_nurbs_surface_sphere_add(radius=1.0)
    else:
        bpy.ops.object.metaball_add(type="BALL", radius=1.0)
    scene = read()
    total = areas(world_triangles(scene)).sum()
    assert 1 < total < 4 * math.pi * 1.1
    assert not scene.not_carried()


def test_curves_and_texts_are_their_meshes_once(empty_scene):
    curve = bpy.data.curves.new("ring", "CURVE")
    curve.dimensions, curve.bevel_depth = "3D", 0.1
    spline = curve.splines.new("POLY")
    spline.points.add(1)
    spline.points[0].co, spline.points[1].co = (0, 0, 0, 1), (0, 0, 1, 1)
    empty_scene.collection.objects.link(bpy.data.objects.new("ring", curve))
    total = areas(world_triangles(read())).sum()
    assert total == pytest.approx(2 * math.pi * 0.1, rel=0.02)


def test_objects_stand_in_blenders_frame(empty_scene):
    plane = add_plane(empty_scene, "plane", size=2.0)
    plane.matrix_world = Matrix.Translation((1, 2, 3)) @ Matrix.Diagonal((-1, 1, 2, 1))
    triangles = world_triangles(read())
    np.testing.assert_allclose(triangles.reshape(-1, 3).min(axis=0), [0, 1, 3])


def test_only_the_selected_objects_and_all_lights(empty_scene):
    add_plane(empty_scene, "chosen").select_set(True)
    add_plane(empty_scene, "other")
    add_light(empty_scene, "lamp", "POINT", 100)
    scene = read(selected_only=True)
    assert [p.source for p in scene.placements] == ["chosen"] and len(scene.lights) == 1


def test_a_scene_without_surface_says_so(empty_scene):
    add_light(empty_scene, "lamp", "POINT", 100)
    with pytest.raises(AddonError, match="nothing to light in scene"):
        read()
    add_plane(empty_scene, "plane")
    with pytest.raises(AddonError, match="selected object"):
        read(selected_only=True)


def test_the_frame_asked_for_counts_and_the_scene_stays_where_it_is(empty_scene):
    plane = add_plane(empty_scene, "plane")
    for frame in (1, 11):
        plane.location.z = frame
        plane.keyframe_insert("location", frame=frame)
    assert read_scene(bpy.context, 11, "").placements[0].matrix[2, 3] == 11
    assert read_scene(bpy.context, 1, "").placements[0].matrix[2, 3] == 1
    assert empty_scene.frame_current == 1


def test_reading_leaves_the_file_as_it_was(empty_scene, tmp_path):
    add_plane(empty_scene, "plane", material=diffuse("grey", (0.5,) * 3))
    add_light(empty_scene, "lamp", "AREA", 100)
    gradient_world(empty_scene)
    add_cube(empty_scene, "cube").modifiers.new("subdivision", "SUBSURF")
    before, engine = data_counts(), empty_scene.render.engine
    read(tmp_path)
    assert (data_counts(), empty_scene.render.engine) == (before, engine)
    assert bpy.context.scene == empty_scene and len(bpy.data.scenes) == 1


def test_our_own_results_are_no_part_of_the_scene(empty_scene):
    add_plane(empty_scene, "plane")
    add_plane(empty_scene, "result")["vmap_result"] = "CLOUD"
    assert [p.source for p in read().placements] == ["plane"]


# --- lights ---


def test_watts_become_intensity_and_irradiance(empty_scene):
    add_plane(empty_scene, "plane")
    add_light(empty_scene, "point", "POINT", 100, (1, 2, 3), color=(1, 0.5, 0))
    add_light(empty_scene, "spot", "SPOT", 100, spot_size=math.radians(90))
    add_light(empty_scene, "sun", "SUN", 2.5, rotation=(math.radians(90), 0, 0))
    lights = {light.name: light for light in read().lights}
    assert lights["point"].intensity == pytest.approx(100 / (4 * math.pi))
    assert lights["point"].color == pytest.approx((1, 0.5, 0))
    np.testing.assert_allclose(lights["point"].matrix[:3, 3], (1, 2, 3))
    assert lights["spot"].intensity == pytest.approx(100 / (4 * math.pi))
    assert lights["spot"].cone[1] == pytest.approx(math.radians(45))
    assert lights["sun"].intensity == 2.5 and lights["sun"].kind == "directional"
    np.testing.assert_allclose(-lights["sun"].matrix[:3, 2], (0, 1, 0), atol=1e-6)


@pytest.mark.parametrize("shape,area", [
    ("SQUARE", 4), ("RECTANGLE", 6), ("DISK", math.pi), ("ELLIPSE", 1.5 * math.pi),
])  # fmt: skip
def test_area_lights_become_surfaces_that_emit_their_watts_downwards(empty_scene, shape, area):
    add_plane(empty_scene, "plane")
    lamp = add_light(empty_scene, "lamp", "AREA", 100, (0, 0, 5), shape=shape, size=2.0, size_y=3.0)
    lamp.scale = (2, 1, 1)
    scene = read()
    triangles = world_triangles(scene, "")
    found = areas(triangles)
    assert found.sum() == pytest.approx(2 * area, rel=3e-3)
    emission = next(m for m in scene.materials if m.name == "lamp lamp").emission
    assert (math.pi if bpy.app.version >= (4, 0) else 4) * emission[0] * found.sum() == pytest.approx(100)
    normal = np.cross(triangles[0, 1] - triangles[0, 0], triangles[0, 2] - triangles[0, 0])
    assert normal[2] < 0


def test_what_a_light_cannot_carry_is_named(empty_scene):
    add_plane(empty_scene, "plane")
    add_light(empty_scene, "big", "POINT", 1, shadow_soft_size=0.5)
    add_light(empty_scene, "wide", "SUN", 1, angle=0.1)
    add_light(empty_scene, "soft", "SPOT", 1, spot_blend=0.5)
    add_light(empty_scene, "narrow", "AREA", 1, spread=0.5)
    add_light(empty_scene, "dark", "POINT", -1)
    text = "\n".join(read().not_carried())
    for name in ("big", "wide", "soft", "narrow", "dark"):
        assert name in text


@pytest.mark.skipif("light_linking" not in bpy.types.Object.bl_rna.properties, reason="this Blender has no light linking")
def test_light_linking_is_named(empty_scene):
    add_plane(empty_scene, "plane")
    lamp = add_light(empty_scene, "lamp", "POINT", 1)
    lamp.light_linking.receiver_collection = bpy.data.collections.new("linked")
    assert "light linking" in read().not_carried()[0]


def test_lights_inside_collection_instances_shine_at_each_place(empty_scene):
    add_plane(empty_scene, "plane")
    lamp = add_light(empty_scene, "lamp", "POINT", 100)
    group = bpy.data.collections.new("group")
    group.objects.link(lamp)
    empty_scene.collection.objects.unlink(lamp)
    for x in (0, 7):
        empty = bpy.data.objects.new("empty", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", group
        empty.location.x = x
        empty_scene.collection.objects.link(empty)
    assert sorted(light.matrix[0, 3] for light in read().lights) == [0, 7]


# --- materials ---


def read_material(empty_scene, material, folder=""):
    add_plane(empty_scene, "plane", material=material)
    scene = read(folder)
    return scene, scene.materials[scene.meshes[0].parts[0].material]


def principled(**values):
    material = bpy.data.materials.new("principled")
    tree = node_tree_of(material)
    tree.nodes.clear()
    shader = tree.nodes.new("ShaderNodeBsdfPrincipled")
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    for name, value in values.items():
        socket = shader.inputs.get(name.replace("_", " "))
        socket.default_value = value
    return material, tree, shader


def test_principled_base_color_and_metallic(empty_scene):
    _, entry = read_material(empty_scene, principled(Base_Color=(0.1, 0.2, 0.4, 1), Metallic=0.5)[0])
    assert entry.base_color == pytest.approx((0.05, 0.1, 0.2))


def test_emission_is_color_times_strength(empty_scene):
    material, _, shader = principled(Base_Color=(0, 0, 0, 1))
    (shader.inputs.get("Emission Color") or shader.inputs["Emission"]).default_value = (1, 0.5, 0, 1)
    shader.inputs["Emission Strength"].default_value = 8
    _, entry = read_material(empty_scene, material)
    assert entry.emission == pytest.approx((8, 4, 0)) and entry.base_color == (0, 0, 0)


def test_diffuse_and_emission_shaders_add_and_mix(empty_scene):
    material = bpy.data.materials.new("mixed")
    tree = node_tree_of(material)
    tree.nodes.clear()
    red, glow, mix, output = (tree.nodes.new(kind) for kind in (
        "ShaderNodeBsdfDiffuse", "ShaderNodeEmission", "ShaderNodeMixShader", "ShaderNodeOutputMaterial"))  # fmt: skip
    red.inputs["Color"].default_value = (0.8, 0, 0, 1)
    glow.inputs["Strength"].default_value = 4
    mix.inputs[0].default_value = 0.25
    tree.links.new(red.outputs[0], mix.inputs[1])
    tree.links.new(glow.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    _, entry = read_material(empty_scene, material)
    assert entry.base_color == pytest.approx((0.6, 0, 0)) and entry.emission == pytest.approx((1, 1, 1))


def test_groups_and_reroutes_are_followed(empty_scene):
    group = bpy.data.node_groups.new("paint", "ShaderNodeTree")
    new_socket(group, "Paint", "NodeSocketColor")
    new_socket(group, "Shader", "NodeSocketShader", is_output=True)
    start, shader, end = (group.nodes.new(kind) for kind in (
        "NodeGroupInput", "ShaderNodeBsdfDiffuse", "NodeGroupOutput"))  # fmt: skip
    group.links.new(start.outputs[0], shader.inputs["Color"])
    group.links.new(shader.outputs[0], end.inputs[0])
    material = bpy.data.materials.new("grouped")
    tree = node_tree_of(material)
    tree.nodes.clear()
    node, reroute, output = (tree.nodes.new(k) for k in ("ShaderNodeGroup", "NodeReroute", "ShaderNodeOutputMaterial"))
    node.node_tree = group
    node.inputs[0].default_value = (0.1, 0.2, 0.3, 1)
    tree.links.new(node.outputs[0], reroute.inputs[0])
    tree.links.new(reroute.outputs[0], output.inputs["Surface"])
    _, entry = read_material(empty_scene, material)
    assert entry.base_color == pytest.approx((0.1, 0.2, 0.3))


def checker_image():
    image = bpy.data.images.new("checker", 2, 2)
    image.pixels.foreach_set(np.array([1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 0.5, 0.5, 0.5, 1], np.float32))
    return image


def test_textures_come_with_their_coordinates(empty_scene):
    material, tree, shader = principled()
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image, texture.interpolation, texture.extension = checker_image(), "Closest", "EXTEND"
    tree.links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    plane = add_plane(empty_scene, "plane", material=material)
    layer = plane.data.uv_layers.new(name="map")
    for loop, uv in zip(plane.data.loops, [(0, 0), (1, 0), (1, 1), (0, 1)]):
        layer.data[loop.index].uv = uv
    scene = read()
    part = scene.meshes[0].parts[0]
    image = scene.images[scene.materials[part.material].base_texture]
    assert (image.repeat, image.nearest) == (False, True)
    np.testing.assert_array_equal(image.pixels[1, 0], [255, 0, 0, 255])  # rows from the top
    np.testing.assert_array_equal(image.pixels[0, 1], [128, 128, 128, 255])
    for position, uv in zip(part.positions, part.uvs):
        np.testing.assert_allclose(uv, (position[:2] + 1) / 2, atol=1e-6)


def test_a_mapping_node_moves_the_coordinates(empty_scene):
    material, tree, shader = principled()
    texture, mapping, uv = (tree.nodes.new(k) for k in ("ShaderNodeTexImage", "ShaderNodeMapping", "ShaderNodeUVMap"))
    texture.image, uv.uv_map = checker_image(), "map"
    mapping.inputs["Location"].default_value = (0.5, 0, 0)
    mapping.inputs["Rotation"].default_value = (0, 0, math.radians(90))
    mapping.inputs["Scale"].default_value = (2, 1, 1)
    tree.links.new(uv.outputs[0], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    plane = add_plane(empty_scene, "plane", material=material)
    layer = plane.data.uv_layers.new(name="map")
    for loop in plane.data.loops:
        layer.data[loop.index].uv = (1, 0.25)
    np.testing.assert_allclose(read().meshes[0].parts[0].uvs, [[0.5 - 0.25, 2]] * 6, atol=1e-6)


def test_color_attributes_become_vertex_colors(empty_scene):
    material, tree, shader = principled()
    node = tree.nodes.new("ShaderNodeVertexColor")
    node.layer_name = "paint"
    tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])
    plane = add_plane(empty_scene, "plane", material=material)
    paint = plane.data.attributes.new("paint", "FLOAT_COLOR", "CORNER")
    for number, entry in enumerate(paint.data):
        entry.color = (0.1 * number, 0.5, 0, 1)
    part = read().meshes[0].parts[0]
    np.testing.assert_allclose(sorted(set(part.colors[:, 0])), [0, 0.1, 0.2, 0.3], atol=1e-6)
    assert (part.colors[:, 1] == 0.5).all()


def test_what_a_material_cannot_carry_is_named(empty_scene):
    material, tree, shader = principled(Metallic=1.0)
    tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs["Color"], shader.inputs["Base Color"])
    scene, _ = read_material(empty_scene, material)
    text = "\n".join(scene.not_carried())
    assert "Noise Texture" in text and "metallic" in text and "principled" in text


def test_specular_reflection_is_named_unless_there_is_none(empty_scene):
    material, _, shader = principled()
    assert "specular" in read_material(empty_scene, material)[0].not_carried()[0]
    (shader.inputs.get("Specular IOR Level") or shader.inputs["Specular"]).default_value = 0
    assert not read().not_carried()


def test_several_materials_are_several_parts_in_the_order_of_slots(empty_scene):
    cube = add_cube(empty_scene, "cube", material=diffuse("a", (0.1,) * 3))
    cube.data.materials.append(diffuse("b", (0.2,) * 3))
    cube.data.polygons[5].material_index = 1
    scene = read()
    assert [len(part.triangles) for part in scene.meshes[0].parts] == [10, 2]
    assert scene.face_ranges() == [("cube", 0, 12)]


def test_a_material_of_the_object_counts_over_that_of_the_mesh(empty_scene):
    plane = add_plane(empty_scene, "plane", material=diffuse("mesh", (0.1,) * 3))
    plane.material_slots[0].link = "OBJECT"
    plane.material_slots[0].material = diffuse("object", (0.9,) * 3)
    assert [m.name for m in read().materials] == ["object"]


# --- world and camera ---


def set_world(empty_scene, strength=1.0):
    world = bpy.data.worlds.new("world")
    empty_scene.world = world
    tree = node_tree_of(world)
    tree.nodes.clear()
    background, output = tree.nodes.new("ShaderNodeBackground"), tree.nodes.new("ShaderNodeOutputWorld")
    background.inputs["Strength"].default_value = strength
    tree.links.new(background.outputs[0], output.inputs["Surface"])
    return tree, background


def gradient_world(empty_scene):
    """Red along +X, green along +Y, blue upwards."""
    tree, background = set_world(empty_scene, 2.0)
    coordinates, limit = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeVectorMath")
    limit.operation = "MAXIMUM"
    tree.links.new(coordinates.outputs["Generated"], limit.inputs[0])
    tree.links.new(limit.outputs[0], background.inputs["Color"])


def test_a_plain_world_is_three_numbers(empty_scene):
    add_plane(empty_scene, "plane")
    assert read().sky == ""
    set_world(empty_scene, 2.0)[1].inputs["Color"].default_value = (0.5, 0.25, 0, 1)
    assert read().sky == "1.0,0.5,0.0"
    scene = read(with_sky=False)
    assert scene.sky == "" and "world" in scene.not_carried()[0]


def panorama(path):
    image = bpy.data.images.load(path)
    width, height = image.size
    return np.array(image.pixels[:], np.float32).reshape(height, width, -1)[::-1, :, :3]


def test_any_other_world_is_a_panorama_with_its_middle_along_x(empty_scene, tmp_path):
    add_plane(empty_scene, "plane")
    gradient_world(empty_scene)
    path = read(tmp_path).sky
    assert os.path.basename(path) == "world.exr"
    pixels = panorama(path)
    height, width, _ = pixels.shape
    np.testing.assert_allclose(pixels[height // 2, width // 2], (2, 0, 0), atol=0.05)
    np.testing.assert_allclose(pixels[height // 2, width // 4], (0, 2, 0), atol=0.1)
    np.testing.assert_allclose(pixels[0, width // 3], (0, 0, 2), atol=0.05)


def hdri_world(empty_scene, turn=None):
    """An environment texture of 16 x 8 pixels, all black but for one bright one."""
    tree, background = set_world(empty_scene, 2.0)
    texture = tree.nodes.new("ShaderNodeTexEnvironment")
    image = texture.image = bpy.data.images.new("sky", 16, 8, float_buffer=True)
    values = np.zeros((8, 16, 4), np.float32)
    values[5, 3] = (100, 50, 0, 1)  # rows from the bottom
    image.pixels.foreach_set(values.ravel())
    tree.links.new(texture.outputs[0], background.inputs["Color"])
    if turn is not None:
        mapping, coordinates = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeTexCoord")
        mapping.inputs["Rotation"].default_value[2] = turn
        tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs[0], texture.inputs["Vector"])


def test_an_environment_texture_keeps_its_pixels(empty_scene, tmp_path):
    add_plane(empty_scene, "plane")
    hdri_world(empty_scene)
    pixels = panorama(read(tmp_path).sky)
    assert pixels.shape == (8, 16, 3)
    np.testing.assert_array_equal(pixels[2, 3], (200, 100, 0))
    assert pixels.sum() == 300


def test_a_turned_environment_texture_agrees_with_cycles(empty_scene, tmp_path, monkeypatch):
    add_plane(empty_scene, "plane")
    hdri_world(empty_scene, turn=math.radians(45))
    direct = panorama(read(tmp_path).sky)
    monkeypatch.setattr(world_reader, "_environment_pixels", lambda world: None)
    monkeypatch.setattr(world_reader, "SAMPLES", 64)
    drawn = panorama(read(tmp_path).sky)
    block = drawn.shape[0] // 8
    drawn = drawn.reshape(8, block, 16, block, 3).mean(axis=(1, 3))
    where = np.unravel_index(direct.sum(axis=2).argmax(), (8, 16))
    assert np.unravel_index(drawn.sum(axis=2).argmax(), (8, 16)) == where
    assert drawn.sum() == pytest.approx(direct.sum(), rel=0.02)


def test_the_camera_comes_along(empty_scene):
    add_plane(empty_scene, "plane")
    assert read().camera is None
    camera = look(empty_scene, (0, 0, 5), (0, 0, 0), fov=math.radians(60))
    empty_scene.render.resolution_x, empty_scene.render.resolution_y = 200, 100
    found = read().camera
    assert found.aspect == 2
    assert found.vertical_fov == pytest.approx(2 * math.atan(math.tan(math.radians(30)) / 2), rel=1e-5)
    np.testing.assert_allclose(found.matrix[:3, 3], (0, 0, 5))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 8
    assert read().camera.half_height == pytest.approx(2)
