#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the project's small scenes and expected.json, what is known about each of them.

make_scenes.py [FOLDER]    FOLDER: where to write; by default the folder of this script

Metres, Y up. Lights in W/sr (point, spot), W/m^2 (sun) and W/(m^2 sr) (emission). README.md describes the scenes and
the keys of expected.json. A second run writes the same bytes.
"""

import json
import math
import sys
from pathlib import Path

import numpy as np
from gltf_writer import Gltf, number, numbers
from shapes import box, box_faces, join, prism, quad, room_faces, sphere

WHITE, RED, GREEN = (0.725, 0.71, 0.68), (0.63, 0.065, 0.05), (0.14, 0.45, 0.091)
BLACK, GREY = (0, 0, 0), (0.5, 0.5, 0.5)

# --- closed forms ----------------------------------------------------------------------------------------------------


def point_light_irradiance(position, normal, light_position, intensity):
    """E = I cos / d^2."""
    way = np.subtract(light_position, position)
    distance = np.linalg.norm(way)
    return np.array(intensity) * max(0.0, np.dot(normal, way)) / distance**3


def spot_light_irradiance(position, normal, light_position, target, intensity, cone):
    """The point light's, times the squared ramp in the cosine of KHR_lights_punctual."""
    axis = np.subtract(target, light_position)
    way = np.subtract(position, light_position)
    cosine = np.dot(axis, way) / (np.linalg.norm(axis) * np.linalg.norm(way))
    inner, outer = (math.cos(angle) for angle in cone)
    ramp = min(max((cosine - outer) / (inner - outer), 0), 1)
    return ramp**2 * point_light_irradiance(position, normal, light_position, intensity)


def sun_irradiance(normal, direction, irradiance):
    """E = E0 cos."""
    return np.array(irradiance) * max(0.0, -np.dot(normal, direction) / np.linalg.norm(direction))


class Expectation:
    """What is known about a scene's light. Every entry is optional but the first."""

    def __init__(self, closed):
        self.values = {"closed": closed}

    def at(self, position, normal, irradiance):
        entry = {"position": numbers(position), "normal": numbers(normal), "irradiance": numbers(irradiance)}
        self.values.setdefault("points", []).append(entry)

    def set(self, **values):
        self.values.update(values)


# --- scenes ----------------------------------------------------------------------------------------------------------

# The measured Cornell box (Cornell Program of Computer Graphics), a hundredth of its millimetres, turned about Y so that
# the viewer looks along -Z, centred in x and z, with straight walls. Its front is open.
CORNELL_LOW, CORNELL_HIGH = (-2.78, 0, -2.796), (2.78, 5.488, 2.796)
SHORT_BLOCK, SHORT_HEIGHT = [(130, 65), (82, 225), (240, 272), (290, 114)], 1.65
TALL_BLOCK, TALL_HEIGHT = [(423, 247), (265, 296), (314, 456), (472, 406)], 3.30
LAMP_LOW, LAMP_HIGH, LAMP_DROP = (213, 227), (343, 332), 0.01


def cornell_position(x, z):
    return (2.78 - x / 100, 2.796 - z / 100)


def cornell_room(gltf):
    """Five walls, the lamp a centimetre under the ceiling and the camera; returns the white material."""
    white = gltf.material("white", WHITE)
    red, green = gltf.material("red", RED), gltf.material("green", GREEN)
    lamp = gltf.material("lamp", BLACK, emission=(17, 12, 4))
    walls = room_faces(CORNELL_LOW, CORNELL_HIGH)
    for name, material in dict(floor=white, ceiling=white, back=white, left=red, right=green).items():
        gltf.place(name, walls[name], material)
    (x0, z0), (x1, z1) = cornell_position(*LAMP_HIGH), cornell_position(*LAMP_LOW)
    y = CORNELL_HIGH[1] - LAMP_DROP
    gltf.place("lamp", quad((x0, y, z0), (x1, y, z0), (x1, y, z1), (x0, y, z1)), lamp)
    gltf.camera("camera", (0, 2.73, 10.796), (0, 2.73, 0), 39.3)
    return white


def cornell_block(corners, height):
    return prism([cornell_position(x, z) for x, z in corners], height)


def cornell_empty():
    gltf = Gltf()
    cornell_room(gltf)
    return gltf, Expectation(closed=False)


def cornell_box():
    gltf = Gltf()
    white = cornell_room(gltf)
    gltf.place("short block", cornell_block(SHORT_BLOCK, SHORT_HEIGHT), white)
    gltf.place("tall block", cornell_block(TALL_BLOCK, TALL_HEIGHT), white)
    return gltf, Expectation(closed=False)


def furnace(albedo, emission):
    """Every ray meets the same radiance, so L = Le + rho L and E = pi L: L = Le / (1 - rho)."""
    gltf = Gltf()
    gltf.place("box", box((-1, -1, -1), (1, 1, 1)).flipped(), gltf.material("furnace", albedo, emission))
    gltf.camera("camera", (0.5, 0.4, 0.9), (-0.4, -0.3, -1), 60)
    expectation = Expectation(closed=True)
    radiance = [le / (1 - rho) for le, rho in zip(emission, albedo)]
    expectation.set(radiance_everywhere=numbers(radiance), irradiance_everywhere=numbers(np.multiply(math.pi, radiance)))
    return gltf, expectation


def plates_parallel():
    """Howell's catalogue C-11, unit squares at distance 1: F = 0.199824895698, 0.239456470461 at the centre."""
    gltf = Gltf()
    gltf.place("lamp", quad((0, 0, 1), (1, 0, 1), (1, 0, 0), (0, 0, 0)), gltf.material("lamp", BLACK, (1, 1, 1)))
    gltf.place("receiver", quad((0, 1, 0), (1, 1, 0), (1, 1, 1), (0, 1, 1)), gltf.material("receiver", BLACK))
    gltf.camera("camera", (3, 0.2, 3), (0.5, 0.6, 0.5), 35)
    expectation = Expectation(closed=False)
    expectation.set(mean_irradiance={"receiver": [number(math.pi * 0.199824895698)] * 3, "lamp": [0, 0, 0]})
    expectation.at((0.5, 1, 0.5), (0, -1, 0), [math.pi * 0.239456470461] * 3)
    return gltf, expectation


def plates_perpendicular():
    """Howell's catalogue C-14, unit squares with a common edge: F = 0.200043776075."""
    gltf = Gltf()
    gltf.place("lamp", quad((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)), gltf.material("lamp", BLACK, (1, 1, 1)))
    gltf.place("receiver", quad((0, 0, 1), (1, 0, 1), (1, 0, 0), (0, 0, 0)), gltf.material("receiver", BLACK))
    gltf.camera("camera", (1.6, 1.8, 3), (0.5, 0.3, 0.4), 35)
    expectation = Expectation(closed=False)
    expectation.set(mean_irradiance={"receiver": [number(math.pi * 0.200043776075)] * 3, "lamp": [0, 0, 0]})
    return gltf, expectation


def sphere_room():
    """An open-fronted room with a smooth sphere on a checkered floor."""
    gltf = Gltf()
    checker = gltf.checker_texture([(230, 225, 210), (60, 80, 120)], squares=2, square_size=16)
    white, blue = gltf.material("white", WHITE), gltf.material("blue", (0.2, 0.3, 0.7))
    orange = gltf.material("orange", (0.75, 0.4, 0.12))
    lamp = gltf.material("lamp", BLACK, emission=(12, 11, 9))
    walls = room_faces((-2, 0, -2), (2, 3, 2))
    for name, material in dict(ceiling=white, back=white, left=blue, right=white).items():
        gltf.place(name, walls[name], material)
    floor = quad((-2, 0, 2), (2, 0, 2), (2, 0, -2), (-2, 0, -2), tiles=(4, 4))
    gltf.place("floor", floor, gltf.material("checkered", (1, 1, 1), texture=checker))
    gltf.place("sphere", sphere((0.3, 0.8, -0.4), 0.8, levels=3), orange)
    gltf.place("lamp", quad((-1.5, 2.95, -0.5), (-0.3, 2.95, -0.5), (-0.3, 2.95, 0.7), (-1.5, 2.95, 0.7)), lamp)
    gltf.camera("camera", (0, 1.5, 6.6), (0, 1.4, 0), 36, aspect=4 / 3)
    return gltf, Expectation(closed=False)


def two_rooms():
    """Two closed rooms joined by a door through a wall 20 cm thick; the lamp hangs in the first."""
    gltf = Gltf()
    white, warm = gltf.material("white", WHITE), gltf.material("warm", (0.7, 0.55, 0.4))
    lamp = gltf.material("lamp", BLACK, emission=(25, 24, 20))
    height, depth, wall, door_height, door = 2.5, 1.5, 0.1, 2.0, 0.45
    first = room_faces((-3.1, 0, -depth), (-wall, height, depth))
    second = room_faces((wall, 0, -depth), (3.1, height, depth))
    gltf.place("first room", join([face for name, face in first.items() if name != "right"]), white)
    gltf.place("second room", join([face for name, face in second.items() if name != "left"]), warm)

    def partition(x):
        """The wall around the door at x, seen from +x."""
        return join(
            [
                quad((x, 0, depth), (x, 0, door), (x, height, door), (x, height, depth)),
                quad((x, 0, -door), (x, 0, -depth), (x, height, -depth), (x, height, -door)),
                quad((x, door_height, door), (x, door_height, -door), (x, height, -door), (x, height, door)),
            ]
        )

    gltf.place("partition, first side", partition(-wall).flipped(), white)
    gltf.place("partition, second side", partition(wall), warm)
    frame = room_faces((-wall, 0, -door), (wall, door_height, door))
    gltf.place("door frame", join([frame[name] for name in ("floor", "ceiling", "front", "back")]), white)
    gltf.place("lamp", quad((-2.1, 2.45, -0.5), (-1.1, 2.45, -0.5), (-1.1, 2.45, 0.5), (-2.1, 2.45, 0.5)), lamp)
    gltf.camera("second room", (2.9, 1.5, 1.2), (-0.5, 1.1, -0.4), 55, aspect=4 / 3)
    gltf.camera("first room", (-2.9, 1.5, 1.2), (0.5, 1.1, -0.4), 55, aspect=4 / 3)
    return gltf, Expectation(closed=True)


def floor_with_black_block(gltf):
    """A floor and a block that reflects nothing, so that the floor gets direct light only and E has a closed form."""
    gltf.place("floor", quad((-2, 0, 2), (2, 0, 2), (2, 0, -2), (-2, 0, -2)), gltf.material("floor", (0.8, 0.8, 0.8)))
    gltf.place("block", box((0.4, 0, -0.3), (1, 0.6, 0.3), without=["floor"]), gltf.material("black", BLACK))
    gltf.camera("camera", (-1.5, 3.2, 5), (0, 0.1, 0), 40, aspect=4 / 3)


def point_light():
    gltf = Gltf()
    floor_with_black_block(gltf)
    position, intensity = (0, 2, 0), np.array([10, 8, 6])
    gltf.light("point", intensity / 10, 10, position)
    expectation = Expectation(closed=False)
    for at in [(0, 0, 0), (-1, 0, 0), (-1, 0, -1), (0.3, 0, 1.2), (-1.9, 0, 1.9)]:
        expectation.at(at, (0, 1, 0), point_light_irradiance(at, (0, 1, 0), position, intensity))
    for hidden in [(1.2, 0, 0), (1.35, 0, 0.2)]:
        expectation.at(hidden, (0, 1, 0), (0, 0, 0))
    expectation.at((0.7, 0.6, 0), (0, 1, 0), point_light_irradiance((0.7, 0.6, 0), (0, 1, 0), position, intensity))
    return gltf, expectation


def spot_light(cone):
    gltf = Gltf()
    floor_with_black_block(gltf)
    position, target, intensity = (-1, 2.5, 0.5), (0, 0, 0), np.array([20, 18, 15])
    gltf.light("spot", intensity / 20, 20, position, target, cone)
    expectation = Expectation(closed=False)
    for at in [(0, 0, 0), (-0.5, 0, 0.25), (-1, 0, 0.5), (0.2, 0, 0.8), (-0.3, 0, -0.7), (-1.7, 0, 1.5), (1.8, 0, -1.8)]:
        value = spot_light_irradiance(at, (0, 1, 0), position, target, intensity, cone)
        expectation.at(at, (0, 1, 0), value)
    expectation.at((1.1, 0, -0.2), (0, 1, 0), (0, 0, 0))
    return gltf, expectation


def sun_light():
    """A slope of 30 degrees under a sun, with a black slab that floats over it."""
    gltf = Gltf()
    tilt = math.radians(30)
    along, normal = np.array([0, math.sin(tilt), -math.cos(tilt)]), np.array([0, math.cos(tilt), math.sin(tilt)])
    right = np.array([1, 0, 0])
    corners = [2 * (x * right + y * along) for x, y in [(-1, -1), (1, -1), (1, 1), (-1, 1)]]
    gltf.place("slope", quad(*corners), gltf.material("slope", (0.7, 0.7, 0.7)))
    gltf.place("slab", box((-0.5, 1.4, -0.5), (0.5, 1.5, 0.5)), gltf.material("black", BLACK))
    direction, irradiance = np.array([0.3, -1, -0.2]), np.array([3, 2.7, 2.1])
    gltf.light("directional", irradiance / 3, 3, (0, 0, 0), direction)
    gltf.camera("camera", (-3.5, 3.2, 5.5), (0, 0.3, 0), 40, aspect=4 / 3)
    expectation = Expectation(closed=False)
    value = sun_irradiance(normal, direction, irradiance)
    for x, y in [(-1.5, -1.5), (1.5, 1.5), (1.8, -1), (-1, 1.2)]:
        expectation.at(x * right + y * along, normal, value)
    # Where the ray through the slab's middle meets the slope.
    middle = np.array([0, 1.45, 0])
    shadow = middle - direction * np.dot(middle, normal) / np.dot(direction, normal)
    expectation.at(shadow, normal, (0, 0, 0))
    return gltf, expectation


def thin_wall():
    """Two closed cells side by side with a wall a centimetre thick between them; the second is dark."""
    gltf = Gltf()
    grey = gltf.material("lit cell", GREY)
    wall = 0.005
    first, second = room_faces((-2, 0, -1), (-wall, 2, 1)), room_faces((wall, 0, -1), (2, 2, 1))
    gltf.place("lit cell", join(list(first.values())), grey)
    gltf.place("dark cell", join(list(second.values())), gltf.material("dark cell", GREY))
    lamp = quad((-1.3, 1.9, -0.3), (-0.7, 1.9, -0.3), (-0.7, 1.9, 0.3), (-1.3, 1.9, 0.3))
    gltf.place("lamp", lamp, gltf.material("lamp", BLACK, emission=(10, 10, 10)))
    gltf.camera("camera", (-1.9, 1, 0.9), (0, 0.8, -0.4), 60, aspect=4 / 3)
    expectation = Expectation(closed=True)
    expectation.set(mean_irradiance={"dark cell": [0, 0, 0]})
    expectation.at((wall, 1, 0), (1, 0, 0), (0, 0, 0))
    expectation.at((1, 0, 0), (0, 1, 0), (0, 0, 0))
    return gltf, expectation


def mirrored_instances():
    """One wedge five times: as it is, mirrored, mirrored twice, nested under a turned mirror, and by a sheared matrix.

    All lids lie at the same height and see nothing but the sun.
    """
    gltf = Gltf()
    gltf.place("floor", quad((-3, 0, 3), (3, 0, 3), (3, 0, -3), (-3, 0, -3)), gltf.material("floor", (0.6, 0.6, 0.6)))
    wedge = prism([(-0.5, -0.3), (0.6, 0.1), (-0.4, 0.5)], 0.8)
    mesh = gltf.mesh("wedge", [(wedge, gltf.material("wedge", (0.7, 0.3, 0.2)))])
    gltf.node("as it is", mesh=mesh, translation=[-1.8, 0, -1])
    gltf.node("mirrored", mesh=mesh, translation=[0, 0, -1], scale=[-1, 1, 1])
    gltf.node("mirrored twice", mesh=mesh, translation=[1.8, 0, -1], scale=[-1, 1, -1.5])
    inner = gltf.node("inner", root=False, mesh=mesh, translation=[0, 0, 0.5], scale=[-0.5, 1, 1])
    half = math.sqrt(0.5)
    outer = gltf.node("outer", root=False, children=[inner], rotation=[0, half, 0, half], scale=[1, 1, -1])
    gltf.node("group", children=[outer], translation=[-1.2, 0, 1.2], scale=[1.5, 1, 1])
    sheared = [-1, 0, 0.2, 0, 0, 1, 0, 0, 0.4, 0, 1, 0, 1.2, 0, 1.2, 1]
    gltf.node("sheared mirror", mesh=mesh, matrix=sheared)
    direction, irradiance = np.array([0.5, -1, -0.4]), np.array([3, 3, 3])
    gltf.light("directional", (1, 1, 1), 3, (0, 0, 0), direction)
    gltf.camera("camera", (-2.5, 4.5, 6.5), (0, 0.2, 0), 40, aspect=4 / 3)
    expectation = Expectation(closed=False)
    value = sun_irradiance((0, 1, 0), direction, irradiance)
    for x, z in [(-1.85, -0.9), (0.05, -0.9), (1.85, -1.15), (1.25, 1.3)]:
        expectation.at((x, 0.8, z), (0, 1, 0), value)
    return gltf, expectation


def double_sided_sheet():
    """A sheet in empty space with a light on each side: two sides, two answers, no reflections."""
    gltf = Gltf()
    paper = gltf.material("paper", (0.8, 0.8, 0.8), double_sided=True)
    gltf.place("sheet", quad((-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)), paper)
    lights = [((0, 0, 1.5), np.array([6, 3, 1.5])), ((0.5, 0, -2), np.array([2, 4, 8]))]
    for position, intensity in lights:
        gltf.light("point", intensity / max(intensity), float(max(intensity)), position)
    gltf.camera("front", (1.5, 1.2, 4), (0, 0, 0), 40)
    gltf.camera("back", (1.5, 1.2, -4), (0, 0, 0), 40)
    expectation = Expectation(closed=False)
    for at in [(0, 0, 0), (0.7, -0.6, 0), (-0.9, 0.9, 0)]:
        for side, (position, intensity) in zip((1, -1), lights):
            expectation.at(at, (0, 0, side), point_light_irradiance(at, (0, 0, side), position, intensity))
    return gltf, expectation


def coincident_sheets():
    """A closed room whose lamp lies in the plane of its ceiling and whose block stands with its bottom in the floor's.

    Light vanishes when rounding decides which of two sheets a ray meets: the emitted flux must equal the absorbed one.
    """
    gltf = Gltf()
    grey, lamp = gltf.material("grey", GREY), gltf.material("lamp", BLACK, emission=(10, 10, 10))
    gltf.place("room", box((-1, 0, -1), (1, 2, 1)).flipped(), grey)
    gltf.place("block", box((-0.5, 0, -0.4), (0.1, 0.9, 0.3)), grey)
    gltf.place("lamp", quad((-0.4, 2, -0.4), (0.4, 2, -0.4), (0.4, 2, 0.4), (-0.4, 2, 0.4)), lamp)
    gltf.camera("camera", (0.8, 1.2, 0.9), (-0.4, 0.7, -0.5), 65)
    return gltf, Expectation(closed=True)


SCENES = {
    "cornell_box": cornell_box,
    "cornell_empty": cornell_empty,
    "furnace_50": lambda: furnace((0.5, 0.5, 0.5), (0.5, 0.5, 0.5)),
    "furnace_80": lambda: furnace((0.8, 0.8, 0.8), (0.2, 0.2, 0.2)),
    "furnace_99": lambda: furnace((0.99, 0.99, 0.99), (0.01, 0.01, 0.01)),
    "furnace_color": lambda: furnace((0.2, 0.5, 0.8), (1, 0.5, 0.1)),
    "plates_parallel": plates_parallel,
    "plates_perpendicular": plates_perpendicular,
    "sphere_room": sphere_room,
    "two_rooms": two_rooms,
    "point_light": point_light,
    "spot_light_hard": lambda: spot_light((0.3999, 0.4)),
    "spot_light_soft": lambda: spot_light((0.15, 0.5)),
    "sun_light": sun_light,
    "thin_wall": thin_wall,
    "mirrored_instances": mirrored_instances,
    "double_sided_sheet": double_sided_sheet,
    "coincident_sheets": coincident_sheets,
}


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent
    folder.mkdir(parents=True, exist_ok=True)
    expected = {}
    for name, make in SCENES.items():
        gltf, expectation = make()
        (folder / f"{name}.gltf").write_text(gltf.text(), encoding="utf-8")
        expected[f"{name}.gltf"] = gltf.measure() | expectation.values
    (folder / "expected.json").write_text(json.dumps(expected, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
