# SPDX-License-Identifier: GPL-3.0-or-later
import importlib.util
import tomllib
import zipfile

import pytest
from conftest import ROOT

spec = importlib.util.spec_from_file_location("package", ROOT / "blender_addon" / "package.py")
package = importlib.util.module_from_spec(spec)
spec.loader.exec_module(package)


def manifest():
    return tomllib.loads((ROOT / "blender_addon" / "vmap" / "blender_manifest.toml").read_text())


def test_both_files_hold_the_whole_tree_and_the_licence(tmp_path):
    extension, legacy = package.package(tmp_path)
    names = set(zipfile.ZipFile(extension).namelist())
    assert {"__init__.py", "blender_manifest.toml", "core/ply.py", "shell/panel.py", "LICENSE"} <= names
    assert set(zipfile.ZipFile(legacy).namelist()) == {"vmap/" + name for name in names}
    assert not any("pycache" in name for name in names)


def test_the_same_bytes_on_every_run(tmp_path):
    first, second = (package.package(tmp_path / name)[0].read_bytes() for name in "ab")
    assert first == second


def test_blenders_validator_agrees(tmp_path):
    package.package(tmp_path)
    package.validate(tmp_path)


@pytest.mark.parametrize("key,value", [
    ("schema_version", "2.0.0"), ("id", "V-map"), ("version", "1.0"), ("type", "theme"), ("blender_version_min", "3.4.0"),
    ("license", ["SPDX:MIT"]), ("tags", ["Sculpture"]), ("tagline", "Ends with a full stop."), ("tagline", "x" * 65),
    ("maintainer", ""), ("permissions", {"files": "x" * 65}), ("permissions", {"telepathy": "why not"}),
])  # fmt: skip
def test_a_wrong_manifest_is_named(key, value):
    with pytest.raises(package.Problem, match=key.rstrip("s")):
        package.check_manifest({**manifest(), key: value})


def test_versions_must_agree():
    package.check_versions(manifest()["version"])
    with pytest.raises(package.Problem, match="version"):
        package.check_versions("7.0.0")
