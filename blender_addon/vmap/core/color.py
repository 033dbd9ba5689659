# SPDX-License-Identifier: GPL-3.0-or-later
"""The sRGB transfer function (IEC 61966-2-1)."""

import numpy as np


def linear_from_srgb(values):
    """Linear values of sRGB values; both in [0, 1], values outside go on along the same curve."""
    values = np.asarray(values, np.float32)
    curve = ((np.maximum(values, 0.04045) + np.float32(0.055)) / np.float32(1.055)) ** np.float32(2.4)
    return np.where(values <= 0.04045, values / np.float32(12.92), curve).astype(np.float32)


def linear_from_srgb_bytes(values):
    """The same for 8-bit values 0 to 255, by table."""
    table = linear_from_srgb(np.arange(256, dtype=np.float32) / np.float32(255))
    return table[values]


def srgb_bytes_from_linear(values):
    """8-bit sRGB of linear values, clipped to [0, 1]."""
    values = np.clip(np.nan_to_num(np.asarray(values, np.float32)), 0, 1)
    curve = np.float32(1.055) * np.maximum(values, 0.0031308) ** np.float32(1 / 2.4) - np.float32(0.055)
    encoded = np.where(values <= 0.0031308, values * np.float32(12.92), curve)
    return np.rint(encoded * 255).astype(np.uint8)
