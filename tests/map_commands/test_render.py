# SPDX-License-Identifier: GPL-3.0-or-later
"""vmap render paints maps: what a point sees, umbras, leaves."""

import struct
import zlib

import numpy
import pytest
from conftest import ROOM, refuse, run

FLOOR_AT_THE_BACK = "1.9,0,-2.2"


def read_png(file):
    """Pixels of an 8-bit PNG file without interlacing, as rows of columns of channels."""
    data = file.read_bytes()
    assert data.startswith(b"\x89PNG\r\n\x1a\n")
    at, compressed = 8, b""
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8 : at + 8 + size]
        if kind == b"IHDR":
            width, height, depth, color_type = struct.unpack_from(">IIBB", body)
        compressed += body if kind == b"IDAT" else b""
        at += size + 12
    assert depth == 8
    channels = {2: 3, 6: 4}[color_type]
    raw = numpy.frombuffer(zlib.decompress(compressed), numpy.uint8).reshape(height, 1 + width * channels)
    rows = numpy.zeros((height + 1, width + 1, channels), int)  # with a border of zeros above and to the left
    for y in range(height):
        line = raw[y, 1:].reshape(width, channels).astype(int)
        for x in range(width):
            left, up, corner = rows[y + 1, x], rows[y, x + 1], rows[y, x]
            guess = left + up - corner
            paeth = numpy.where(
                (abs(guess - left) <= abs(guess - up)) & (abs(guess - left) <= abs(guess - corner)),
                left, numpy.where(abs(guess - up) <= abs(guess - corner), up, corner))
            predicted = (0, left, up, (left + up) // 2, paeth)[raw[y, 0]]
            rows[y + 1, x + 1] = (line[x] + predicted) % 256
    return rows[1:, 1:]


def picture(room_map, folder, *options):
    file = folder / "picture.png"
    run("render", room_map, "--size", 48, "-o", file, *options)
    return read_png(file)[:, :, :3]


def is_light(pixel):
    return pixel[0] > 120 and pixel[0] > pixel[2]


def test_visibility_is_light_where_the_point_sees(room_map, tmp_path):
    pixels = picture(room_map, tmp_path, "--show", "visibility", "--from", FLOOR_AT_THE_BACK)
    assert is_light(pixels[4, 24]), "the ceiling"
    assert is_light(pixels[24, 42]), "the wall beside it"
    assert not is_light(pixels[45, 24]), "the floor that it lies in"


def test_umbra_is_light_under_the_lamp_and_dark_behind_the_block(room_map, tmp_path):
    pixels = picture(room_map, tmp_path, "--show", "umbra")
    assert is_light(pixels[20, 24]), "the back wall"
    assert not is_light(pixels[4, 24]), "the ceiling, which the lamp turns its back to"


def test_leaves_have_many_colors(room_map, tmp_path):
    pixels = picture(room_map, tmp_path, "--show", "leaves")
    assert len({tuple(pixel // 8) for row in pixels for pixel in row}) > 100


@pytest.mark.parametrize(("code", "options"), [
    (2, ["--show", "visibility"]), (2, ["--show", "umbra", "--from", "0,0,0"]), (2, ["--show", "shadows"]),
    (2, ["--show", "visibility", "--from", "0,0"]), (2, ["--show", "leaves", "--size", "0"]),
    (3, ["--show", "radiance"])])
def test_pictures_that_cannot_be_drawn_are_refused(room_map, tmp_path, code, options):
    refuse(code, "render", room_map, "-o", tmp_path / "out.png", *options)
    assert not list(tmp_path.iterdir())


def test_only_maps_have_visibility(tmp_path):
    refuse(3, "render", ROOM, "--show", "leaves", "-o", tmp_path / "out.png")
