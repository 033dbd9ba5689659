# SPDX-License-Identifier: GPL-3.0-or-later
"""The OpenVDB files as OpenVDB's own Python module reads them."""

import shutil
import subprocess

import numpy
import pytest
from conftest import z_up

vdb = pytest.importorskip("pyopenvdb", reason="OpenVDB's Python module is missing")


def voxel_of(grid, place):
    return tuple(int(numpy.floor(c + 0.5)) for c in grid.transform.worldToIndex(tuple(place)))


def test_grids_and_metadata(samples, expected):
    density, irradiance = (vdb.read(str(samples / "lit.vdb"), name) for name in ("density", "irradiance"))
    assert density.gridClass == vdb.GridClass.FOG_VOLUME
    assert irradiance.vectorType == vdb.VectorType.INVARIANT
    assert density.creator.startswith("vmap ")
    for grid in (density, irradiance):
        assert grid.metadata["up"] == "z"
        assert grid.metadata["light_units"] == "compat"
        assert grid.metadata["source"] == "floor and wall"
        assert grid.transform.voxelSize() == pytest.approx((expected["voxel_size"],) * 3)
        assert grid.leafCount() > 0


def test_density_is_one_at_the_points_only(samples, expected):
    density = vdb.read(str(samples / "lit.vdb"), "density")
    voxels = {voxel_of(density, place) for place in z_up(expected["positions"])}
    active = {item.min for item in density.iterOnValues()}
    assert all(item.count == 1 and item.value == 1 for item in density.iterOnValues())
    assert active == voxels


def test_irradiance_is_the_mean_at_the_points_and_goes_on_around_them(samples, expected):
    irradiance = vdb.read(str(samples / "lit.vdb"), "irradiance")
    accessor = irradiance.getConstAccessor()
    by_voxel = {}
    for place, value in zip(z_up(expected["positions"]), expected["irradiance"]):
        by_voxel.setdefault(voxel_of(irradiance, place), []).append(value)
    for voxel, values in by_voxel.items():
        assert accessor.getValue(voxel) == pytest.approx(numpy.mean(values, axis=0), rel=1e-6)
        for step in ((2, 0, 0), (0, -2, 0), (0, 0, 2), (2, 2, 2), (-1, 2, 0)):
            assert accessor.isValueOn(tuple(a + b for a, b in zip(voxel, step)))
    # All over the wall's upper edge, far from the bright point, the colour is in the ratio 3 : 2 : 1.
    x, y, z = max(by_voxel, key=lambda v: (v[2], v[0]))
    assert accessor.getValue((x, y, z + 2)) == pytest.approx((6, 4, 2), rel=1e-6)


def test_vdb_print_lists_the_points(samples):
    """The Python module reads no points; the values are compared in the unit tests, by OpenVDB's library."""
    if not shutil.which("vdb_print"):
        pytest.skip("the program vdb_print is missing")
    command = ["vdb_print", "-l", samples / "points.vdb"]
    result = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert result.returncode == 0, result.stderr
    assert "Name: points" in result.stdout
    assert "Type: Tree_ptdataidx32_5_4_3" in result.stdout
    assert "  up: z" in result.stdout


def test_empty_cloud_has_a_leaf(samples):
    assert vdb.read(str(samples / "empty.vdb"), "density").leafCount() == 1
