#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes sampling.png: what the two patterns of `vmap sample` look like on a square, and measures them.

Upper row blue noise, lower row stratified. Columns: points; power spectrum of all points (middle: frequency 0);
radial mean of the spectrum from 0 to 4 over the spacing, the line is the value of random points; histogram of the
distance to the nearest neighbour from 0 to 1.2 spacings, the line is at 0.6.
"""
import argparse
import struct
import subprocess
import tempfile
import zlib
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
SIDE = 240  # pixels of a panel
COUNT = 8192
SEEDS = 8


def read_front(path):
    """x y of the points of a PLY file of ours that look along +z: the file's meshes have two sides."""
    data = path.read_bytes()
    header, body = data.split(b"end_header\n", 1)
    sizes = {"float": 4, "uint": 4, "uchar": 1}
    properties = [line.split() for line in header.decode().splitlines() if line.startswith("property")]
    stride = sum(sizes[kind] for _, kind, _ in properties)
    assert [name for _, _, name in properties[:6]] == ["x", "y", "z", "nx", "ny", "nz"]
    rows = np.frombuffer(body, np.uint8).reshape(-1, stride)
    values = rows[:, :24].copy().view("<f4").astype(float)
    return values[values[:, 5] > 0, :2]


def sample_square(vmap, pattern, seed, folder):
    """Points of the unit square."""
    mesh = folder / "square.off"
    mesh.write_text("OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n")
    out = folder / "points.ply"
    subprocess.run(
        [vmap, "sample", mesh, "-o", out, "--points", str(2 * COUNT)]
        + ["--pattern", pattern, "--seed", str(seed), "--quiet"],
        check=True,
    )
    return read_front(out)


def power_spectrum(points, reach):
    """|sum of waves|^2 / count at whole frequencies -reach..reach; a flat spectrum at 1 is white noise."""
    frequencies = np.arange(-reach, reach + 1)
    x = np.exp(-2j * np.pi * np.outer(frequencies, points[:, 0]))
    y = np.exp(-2j * np.pi * np.outer(points[:, 1], frequencies))
    return np.abs(x @ y).T ** 2 / len(points)


def nearest_distances(points):
    """Distance to the nearest other point, in mean spacings."""
    cells = max(int(np.sqrt(len(points)) / 2), 1)
    order = np.lexsort((points[:, 0], np.floor(points[:, 1] * cells)))
    ordered = points[order]
    best = np.full(len(points), np.inf)
    for shift in range(1, 6 * cells):  # neighbours in this order lie at most two rows of cells away
        d = np.hypot(*(ordered[shift:] - ordered[:-shift]).T)
        best[shift:] = np.minimum(best[shift:], d)
        best[:-shift] = np.minimum(best[:-shift], d)
    return best * np.sqrt(len(points))


def panel():
    return np.full((SIDE, SIDE), 255, np.uint8)


def draw_points(points):
    image = panel()
    shown = points[(points < 0.4).all(axis=1)] / 0.4 * (SIDE - 4)
    for x, y in shown.astype(int):
        image[y : y + 3, x : x + 3] = 0
    return image


def draw_bars(values, top, mark_x=None, mark_y=None):
    image = panel()
    for i, value in enumerate(np.interp(np.linspace(0, len(values) - 1, SIDE), np.arange(len(values)), values)):
        height = int(min(value / top, 1) * (SIDE - 1))
        image[SIDE - 1 - height :, i] = 120
    if mark_x is not None:
        image[:, int(mark_x * SIDE)] = 0
    if mark_y is not None:
        image[SIDE - 1 - int(mark_y * SIDE), :] = 0
    return image


def row_of_panels(clouds):
    reach = 4 * int(np.sqrt(COUNT))
    spectrum = np.mean([power_spectrum(points, reach) for points in clouds], axis=0)
    spectrum[reach, reach] = 0
    frequencies = np.arange(-reach, reach + 1)
    radius = np.hypot(*np.meshgrid(frequencies, frequencies))
    bins = (radius * SIDE / reach).astype(int).ravel()
    total = np.bincount(bins, spectrum.ravel(), SIDE)[:SIDE]
    radial = total / np.maximum(np.bincount(bins, minlength=SIDE)[:SIDE], 1)
    nearest = np.concatenate([nearest_distances(points) for points in clouds])
    histogram, _ = np.histogram(nearest, 120, (0, 1.2))
    print(
        f"nearest neighbour: least {nearest.min():.3f}, 1 % {np.quantile(nearest, 0.01):.3f}, "
        f"mean {nearest.mean():.3f} spacings; spectrum below half the spacing's frequency: "
        f"{radial[: SIDE // 8].mean():.4f} of white noise"
    )
    middle = spectrum[reach - 160 : reach + 160, reach - 160 : reach + 160]
    small = middle[np.ix_(*[np.linspace(0, 319, SIDE).astype(int)] * 2)]
    gray = (255 * np.clip(small / 2.5, 0, 1) ** 0.5).astype(np.uint8)
    panels = [draw_points(clouds[0]), gray, draw_bars(radial, 3, mark_y=1 / 3), draw_bars(histogram, histogram.max(), 0.5)]
    gap = np.full((SIDE, 10), 255, np.uint8)
    return np.hstack([part for image in panels for part in (image, gap)][:-1])


def write_png(path, image):
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    height, width = image.shape
    rows = b"".join(b"\0" + row.tobytes() for row in image)
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
        + chunk(b"IDAT", zlib.compress(rows, 9))
        + chunk(b"IEND", b"")
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--vmap", default=HERE.parent.parent / "build/release/bin/vmap")
    parser.add_argument("-o", "--output", type=Path, default=HERE / "sampling.png")
    arguments = parser.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for pattern in ("blue-noise", "stratified"):
            print(pattern, end=": ")
            seeds = range(1, SEEDS + 1)
            rows.append(row_of_panels([sample_square(arguments.vmap, pattern, seed, Path(folder)) for seed in seeds]))
    write_png(arguments.output, np.vstack([rows[0], np.full((10, rows[0].shape[1]), 255, np.uint8), rows[1]]))


if __name__ == "__main__":
    main()
