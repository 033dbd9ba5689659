# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from core.errors import AddonError
from core.vdb_header import read_vdb_header

vdb = pytest.importorskip("pyopenvdb", reason="SKIPPED: needs Debian's python3-openvdb")


@pytest.fixture
def sample(tmp_path):
    density, irradiance = vdb.FloatGrid(), vdb.Vec3SGrid()
    density.copyFromArray(np.ones((8, 8, 8), np.float32))
    irradiance.copyFromArray(np.ones((8, 8, 8, 3), np.float32))
    density.name, irradiance.name = "density", "irradiance"
    irradiance["up"], irradiance["exposure"] = "z", 0.5
    path = tmp_path / "lit.vdb"
    vdb.write(str(path), [density, irradiance], metadata={"source": "room.glb", "frame": 7, "fine": True})
    return path


def test_names_types_and_metadata(sample):
    file = read_vdb_header(str(sample))
    assert [(g.name, g.type) for g in file.grids] == [
        ("density", "Tree_float_5_4_3"),
        ("irradiance", "Tree_vec3s_5_4_3"),
    ]
    assert file.metadata == {"source": "room.glb", "frame": 7, "fine": True}
    assert file.grid("irradiance").metadata["up"] == "z"
    assert file.grid("irradiance").metadata["exposure"] == 0.5
    assert file.grid("absent") is None and not file.grids[0].holds_points


def test_a_file_without_grids_is_empty(tmp_path):
    vdb.write(str(tmp_path / "none.vdb"), [])
    assert read_vdb_header(str(tmp_path / "none.vdb")).grids == []


def test_truncated_at_every_length_is_an_error(sample, write):
    data = sample.read_bytes()
    for size in [*range(0, 2000), len(data) // 2, len(data) - 1]:
        if size < len(data):
            with pytest.raises(AddonError):
                read_vdb_header(write("cut.vdb", data[:size]))


def test_flipped_bytes_of_the_header_never_crash(sample, write):
    data = sample.read_bytes()
    for position in range(0, 900, 3):
        flipped = bytearray(data)
        flipped[position] ^= 0xFF
        try:
            read_vdb_header(write("flipped.vdb", bytes(flipped)))
        except AddonError as error:
            assert "\n" not in str(error)


@pytest.mark.parametrize("data", [b"", b"ply\n", b" BDV\0\0\0\0\x01\0\0\0"])
def test_foreign_files_are_errors(write, data):
    with pytest.raises(AddonError, match="expected an OpenVDB file"):
        read_vdb_header(write("bad.vdb", data))


def test_missing_file_is_an_error(tmp_path):
    with pytest.raises(AddonError, match="cannot read"):
        read_vdb_header(str(tmp_path / "absent.vdb"))
