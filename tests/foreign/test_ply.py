# SPDX-License-Identifier: GPL-3.0-or-later
"""The PLY file as two independent readers see it."""

import numpy
import pytest
from conftest import radiance, srgb, z_up


@pytest.fixture
def vertices(samples):
    plyfile = pytest.importorskip("plyfile", reason="the package plyfile is missing")
    return plyfile.PlyData.read(str(samples / "lit.ply"))["vertex"]


def columns(vertices, *names):
    return numpy.stack([vertices[name] for name in names], axis=1)


def test_plyfile_reads_every_property(vertices, expected):
    names = [p.name for p in vertices.properties]
    assert names == (
        "x y z nx ny nz red green blue irradiance_r irradiance_g irradiance_b albedo_r albedo_g albedo_b radius area "
        "face_id material_id emission_r emission_g emission_b"
    ).split()
    exact = lambda values: values.astype(numpy.float32)
    assert (columns(vertices, "x", "y", "z") == exact(z_up(expected["positions"]))).all()
    assert (columns(vertices, "nx", "ny", "nz") == exact(z_up(expected["normals"]))).all()
    for name in ("irradiance", "albedo", "emission"):
        assert (columns(vertices, *(f"{name}_{c}" for c in "rgb")) == exact(expected[name])).all()
    assert (vertices["area"] == exact(expected["areas"])).all()
    assert vertices["radius"] == pytest.approx(numpy.sqrt(expected["areas"] / numpy.pi), rel=1e-6)
    assert (vertices["face_id"] == numpy.arange(len(expected["areas"]))).all()
    assert (vertices["material_id"] == 7).all()


def test_plyfile_reads_types_and_colours(vertices, expected):
    types = {p.name: p.val_dtype for p in vertices.properties}
    assert {types["x"], types["irradiance_r"], types["area"]} == {"f4"}
    assert types["red"] == "u1" and types["face_id"] == "u4"
    shown = srgb(radiance(expected) * expected["exposure"]) * 255
    assert numpy.abs(columns(vertices, "red", "green", "blue") - shown).max() <= 0.51


def test_plyfile_reads_the_comments(samples):
    plyfile = pytest.importorskip("plyfile", reason="the package plyfile is missing")
    comments = plyfile.PlyData.read(str(samples / "lit.ply")).comments
    assert "up z" in comments
    assert "light_units compat punctual 1 directional 1" in comments
    assert "offset 0 0 0" in comments
    assert "exposure 0.5" in comments
    assert "source floor and wall" in comments


def test_trimesh_reads_points_and_colours(samples, expected):
    trimesh = pytest.importorskip("trimesh", reason="the package trimesh is missing")
    cloud = trimesh.load(str(samples / "lit.ply"))
    assert isinstance(cloud, trimesh.PointCloud)
    assert cloud.vertices == pytest.approx(z_up(expected["positions"]), rel=1e-6)
    shown = srgb(radiance(expected) * expected["exposure"]) * 255
    assert numpy.abs(cloud.colors[:, :3] - shown).max() <= 0.51


def test_empty_file_is_read(samples):
    plyfile = pytest.importorskip("plyfile", reason="the package plyfile is missing")
    assert len(plyfile.PlyData.read(str(samples / "empty.ply"))["vertex"].data) == 0
