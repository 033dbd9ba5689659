# SPDX-License-Identifier: GPL-3.0-or-later
"""Points without normals, areas, colours or light."""

import json
import math
import struct

from conftest import UNSUPPORTED, USAGE, error_lines, succeed, vmap


def sphere(count=2000):
    """Points of a sphere of radius 1, evenly spread along a spiral."""
    golden = math.pi * (3 - math.sqrt(5))
    points = []
    for i in range(count):
        z = 1 - (2 * i + 1) / count
        r = math.sqrt(1 - z * z)
        points.append((r * math.cos(golden * i), r * math.sin(golden * i), z))
    return points


def write_ply(path, points, colours=None):
    header = "ply\nformat ascii 1.0\nelement vertex %d\n" % len(points)
    header += "".join(f"property float {axis}\n" for axis in "xyz")
    if colours:
        header += "".join(f"property uchar {name}\n" for name in ("red", "green", "blue"))
    rows = [" ".join(map(str, p + (colours[i] if colours else ()))) for i, p in enumerate(points)]
    path.write_text(header + "end_header\n" + "\n".join(rows) + "\n")
    return path


def light(folder, file, *options):
    done = succeed("light", file, "-o", folder / "lit.ply", "--json", folder / "report.json", *options)
    return json.loads((folder / "report.json").read_text()), done.stderr.decode()


def test_a_scan_is_lit_from_outside(folder):
    scan = write_ply(folder / "scan.ply", sphere())
    report, said = light(folder, scan, "--light", "point:0,0,4:100")
    assert abs(report["area"] / (4 * math.pi) - 1) < 0.02
    assert "no normals" in said and "outward" in said and "no colours: albedo 0.8" in said
    # What reaches the sphere is what goes through the circle that it covers of the sky: 1 - cos of its half angle.
    expected = 100 * 2 * math.pi * (1 - math.sqrt(1 - 1 / 16)) / (4 * math.pi)
    assert abs(report["mean_irradiance"] / expected - 1) < 0.03


def test_a_light_inside_turns_the_points_inward(folder):
    scan = write_ply(folder / "scan.ply", sphere())
    report, said = light(folder, scan, "--light", "point:0,0,0:1")
    assert "surround a light" in said
    assert report["mean_irradiance"] > 1


def test_lights_are_in_the_axes_of_the_file(folder):
    """PLY files are Z up: a light above shines on the points that are high in z."""
    scan = write_ply(folder / "scan.ply", sphere())
    light(folder, scan, "--light", "sun:0,0,-1:1", "--quiet")
    succeed("export", folder / "lit.ply", "-o", folder / "lit.pov")
    lit = (folder / "lit.ply").read_bytes()
    assert b"comment up z" in lit
    body = lit[lit.index(b"end_header\n") + 11 :]
    count = int(lit[: lit.index(b"end_header")].split(b"element vertex ")[1].split()[0])
    size = len(body) // count
    high = [struct.unpack_from("<f", body, i * size + 8)[0] > 0.5 for i in range(count)]
    offset = 6 * 4 + 3
    shine = [struct.unpack_from("<f", body, i * size + offset)[0] for i in range(count)]
    lit_high = [e > 0.4 for e, up in zip(shine, high) if up]
    assert sum(lit_high) > 0.99 * len(lit_high) > 0


def test_orientation_is_the_users_choice(folder):
    scan = write_ply(folder / "scan.ply", sphere())
    outward, _ = light(folder, scan, "--light", "point:0,0,4:1", "--orient", "outward")
    for options in (["--orient", "inward"], ["--viewpoint", "0,0,0"]):
        report, _ = light(folder, scan, "--light", "point:0,0,4:1", *options)
        assert report["mean_irradiance"] < 1e-6 * outward["mean_irradiance"]
    assert vmap("light", scan, "-o", "x.ply", "--orient", "inward", "--viewpoint", "0,0,0").returncode == USAGE
    assert vmap("sample", scan, "-o", "x.ply", "--viewpoint", "0,0").returncode == USAGE


def test_every_command_takes_raw_points(folder):
    scan = write_ply(folder / "scan.ply", sphere(), [(255, 0, 0)] * 2000)
    assert json.loads(succeed("info", scan, "--json").stdout)["points"] == 2000
    succeed("sample", scan, "-o", folder / "points.ply")
    succeed("render", scan, "--show", "normals", "-o", folder / "normals.png", "--size", 32)
    succeed("export", scan, "-o", folder / "scan.pov")
    done = vmap("render", scan, "-o", folder / "light.png")
    assert done.returncode == UNSUPPORTED and "no lit points" in error_lines(done)[0]


def test_what_is_no_surface_is_refused(folder):
    for name, points in {
        "one": [(1, 2, 3)],
        "two": [(1, 2, 3), (4, 5, 6)],
        "line": [(i, 2 * i, -i) for i in range(50)],
        "same": [(1, 2, 3)] * 50,
    }.items():
        file = write_ply(folder / f"{name}.ply", points)
        done = vmap("sample", file, "-o", folder / "out.ply")
        assert done.returncode == UNSUPPORTED
        assert len(error_lines(done)) == 1 and f"{name}.ply" in error_lines(done)[0]
        assert not (folder / "out.ply").exists()


def test_numbers_that_are_none_are_refused(folder):
    file = folder / "nan.xyz"
    file.write_text("0 0 0\n1 0 0\nnan 1 0\n")
    assert vmap("sample", file, "-o", folder / "out.ply").returncode == 4
