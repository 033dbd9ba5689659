# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes linear pictures as OpenEXR files: scan lines, 32-bit floats, not compressed.

Layout by "OpenEXR File Layout", https://openexr.com/en/latest/OpenEXRFileLayout.html
"""

import struct

import numpy as np

MAGIC, VERSION = 20000630, 2
FLOAT, INCREASING_Y = 2, 0


def write_exr(path, pixels):
    """pixels: (height, width, 3) linear red, green, blue; rows from the top."""
    pixels = np.asarray(pixels, "<f4")
    height, width, _ = pixels.shape
    row_bytes = 3 * 4 * width
    # Each row: its number, its size, then its channels one after the other, in the order of their names.
    rows = np.zeros(height, [("y", "<i4"), ("size", "<i4"), ("data", "<f4", (3, width))])
    rows["y"], rows["size"] = np.arange(height), row_bytes
    rows["data"] = pixels[:, :, ::-1].transpose(0, 2, 1)
    header = _header(width, height)
    first = len(header) + 8 * height
    offsets = first + np.arange(height, dtype="<u8") * rows.dtype.itemsize
    with open(path, "wb") as file:
        file.write(header)
        file.write(offsets.tobytes())
        file.write(rows.tobytes())


def _header(width, height):
    channels = b"".join(name + b"\0" + struct.pack("<iB3xii", FLOAT, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    attributes = [
        (b"channels", b"chlist", channels),
        (b"compression", b"compression", b"\0"),
        (b"dataWindow", b"box2i", box),
        (b"displayWindow", b"box2i", box),
        (b"lineOrder", b"lineOrder", bytes([INCREASING_Y])),
        (b"pixelAspectRatio", b"float", struct.pack("<f", 1)),
        (b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0)),
        (b"screenWindowWidth", b"float", struct.pack("<f", 1)),
    ]
    body = b"".join(
        name + b"\0" + kind + b"\0" + struct.pack("<i", len(data)) + data for name, kind, data in attributes
    )
    return struct.pack("<ii", MAGIC, VERSION) + body + b"\0"
