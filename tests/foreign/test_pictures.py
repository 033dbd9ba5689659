# SPDX-License-Identifier: GPL-3.0-or-later
"""The PNG taken apart with the standard library. Blender reads both pictures in test_blender.py."""

import struct
import zlib

import numpy
from conftest import srgb


def chunks(content):
    assert content[:8] == b"\x89PNG\r\n\x1a\n"
    at = 8
    while at < len(content):
        size, kind = struct.unpack(">I4s", content[at : at + 8])
        data = content[at + 8 : at + 8 + size]
        assert struct.unpack(">I", content[at + 8 + size : at + 12 + size])[0] == zlib.crc32(kind + data)
        yield kind, data
        at += 12 + size


def unfiltered(data, width, height):
    """Rows of RGB samples, by the five filters of the specification."""
    stride, rows = 3 * width, [bytearray(3 * width)]
    for y in range(height):
        kind, line = data[y * (stride + 1)], bytearray(data[y * (stride + 1) + 1 : (y + 1) * (stride + 1)])
        above = rows[-1]
        for i in range(stride):
            a, b, c = (line[i - 3] if i > 2 else 0), above[i], (above[i - 3] if i > 2 else 0)
            p = a + b - c
            nearest = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            line[i] = (line[i] + (0, a, b, (a + b) // 2, nearest)[kind]) & 255
        rows.append(line)
    return numpy.array([list(row) for row in rows[1:]]).reshape(height, width, 3)


def test_png_is_srgb_of_exposed_radiance(samples, expected):
    parts = list(chunks((samples / "picture.png").read_bytes()))
    kinds = [kind for kind, _ in parts]
    assert kinds[0] == b"IHDR" and kinds[-1] == b"IEND" and b"sRGB" in kinds
    width, height, depth, color = struct.unpack(">IIBB", parts[0][1][:10])
    assert (width, height, depth, color) == (6, 4, 8, 2)
    pixels = unfiltered(zlib.decompress(b"".join(data for kind, data in parts if kind == b"IDAT")), width, height)
    shown = srgb(expected["picture"] * expected["exposure"]).reshape(height, width, 3) * 255
    assert numpy.abs(pixels - shown).max() <= 0.51
