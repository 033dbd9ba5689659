# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes 8-bit PNG pictures (ISO/IEC 15948)."""

import struct
import zlib

import numpy as np


def png_bytes(pixels):
    """pixels: (height, width, 3 or 4) uint8, rows from the top."""
    height, width, channels = pixels.shape
    kind = {3: 2, 4: 6}[channels]
    rows = np.zeros((height, 1 + width * channels), np.uint8)  # each row begins with its filter, 0: none
    rows[:, 1:] = pixels.reshape(height, -1)

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    header = struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)
    data = zlib.compress(rows.tobytes(), 3)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", data) + chunk(b"IEND", b"")
