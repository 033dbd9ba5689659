#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks the add-on and packs it: package.py [--out FOLDER].

Makes two zip files of one tree: the extension for Blender 4.2 and later, and the add-on for Blender 3.4 to 4.1. The
same bytes on every run. Where a Blender with its extension tool is at hand (--blender, or a bpy module under
build/blender) it validates the extension too.
"""

import argparse
import ast
import re
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = HERE / "vmap"
ROOT = HERE.parent
FIXED_TIME = (1980, 1, 1, 0, 0, 0)
# Blender's own lists, as far as this add-on may want them; its validator does not look.
TAGS = {"3D View", "Geometry Nodes", "Import-Export", "Lighting", "Material", "Node", "Render"}
TEXT = {"name": 64, "tagline": 64, "maintainer": 128}
PERMISSIONS = {"files", "network", "clipboard", "camera", "microphone"}


class Problem(Exception):
    pass


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "blender_addon", help="folder of the zip files")
    parser.add_argument("--blender", type=Path, help="program of Blender 4.2 or later that is to validate, too")
    options = parser.parse_args()
    try:
        for path in package(options.out):
            print(path)
        validate(options.out, options.blender)
    except Problem as problem:
        print(f"package.py: error: {problem}", file=sys.stderr)
        return 1
    return 0


def package(out):
    """Writes both zip files; returns their paths."""
    manifest = check_manifest(tomllib.loads((SOURCE / "blender_manifest.toml").read_text()))
    check_versions(manifest["version"])
    out.mkdir(parents=True, exist_ok=True)
    extension = out / f"vmap-{manifest['version']}.zip"
    legacy = out / f"vmap-{manifest['version']}-blender-3.4.zip"
    write_zip(extension, "")
    write_zip(legacy, "vmap/")
    return extension, legacy


def sources():
    return sorted(p for p in SOURCE.rglob("*") if p.suffix in {".py", ".toml"} and "__pycache__" not in p.parts)


def write_zip(path, prefix):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for source in sources():
            entry = zipfile.ZipInfo(prefix + source.relative_to(SOURCE).as_posix(), FIXED_TIME)
            entry.external_attr = 0o644 << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, source.read_bytes())
        licence = zipfile.ZipInfo(prefix + "LICENSE", FIXED_TIME)
        licence.external_attr = 0o644 << 16
        archive.writestr(licence, (ROOT / "LICENSES" / "GPL-3.0-or-later.txt").read_bytes(), zipfile.ZIP_DEFLATED)


def check_manifest(manifest):
    """The manifest, when it says what an extension has to say."""

    def need(condition, text):
        if not condition:
            raise Problem(f"blender_manifest.toml: {text}")

    need(manifest.get("schema_version") == "1.0.0", 'schema_version; expected "1.0.0"')
    need(re.fullmatch(r"[a-z][a-z0-9_]*", manifest.get("id", "")), "id; expected small letters")
    need(re.fullmatch(r"\d+\.\d+\.\d+", manifest.get("version", "")), "version; expected three numbers")
    need(manifest.get("type") == "add-on", 'type; expected "add-on"')
    need(manifest.get("blender_version_min") == "4.2.0", 'blender_version_min; expected "4.2.0"')
    need(manifest.get("license") == ["SPDX:GPL-3.0-or-later"], "license; expected SPDX:GPL-3.0-or-later")
    need(set(manifest.get("tags", ())) <= TAGS, f"tags; expected some of {', '.join(sorted(TAGS))}")
    for name, limit in TEXT.items():
        text = manifest.get(name, "")
        need(0 < len(text) <= limit and text == text.strip(), f"{name}; expected 1 to {limit} characters")
    need(manifest["tagline"][-1].isalnum() or manifest["tagline"][-1] in ")]}", "tagline; expected no full stop")
    for name, reason in manifest.get("permissions", {}).items():
        need(name in PERMISSIONS and 0 < len(reason) <= 64 and reason[-1].isalnum(), f"permission {name}")
    return manifest


def check_versions(version):
    """One version everywhere: the manifest, bl_info, the program that the add-on wants, and the project."""
    numbers = tuple(int(part) for part in version.split("."))
    project = re.search(r"project\(vmap VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]
    for name, found in (
        ("vmap/__init__.py", constant(SOURCE / "__init__.py", "bl_info")["version"]),
        ("vmap/core/program.py", constant(SOURCE / "core" / "program.py", "VERSION")),
        ("CMakeLists.txt", tuple(int(part) for part in project.split("."))),
    ):
        if found != numbers:
            raise Problem(f"{name}: version {found}; expected {numbers} as in the manifest")


def constant(path, name):
    for statement in ast.parse(path.read_text()).body:
        if isinstance(statement, ast.Assign) and statement.targets[0].id == name:
            return ast.literal_eval(statement.value)
    raise Problem(f"{path.name}: no {name}")


def validate(out, blender=None):
    """Blender's own validator on the extension, where there is one."""
    extension = next(p for p in out.glob("vmap-*.zip") if "blender" not in p.name)
    if blender:
        command = [blender, "--command", "extension", "validate", extension]
    else:
        tools = sorted(
            (ROOT / "build" / "blender").glob("bpy-*/lib/python*/site-packages/**/bl_pkg/cli/blender_ext.py")
        )
        if not tools:
            print("not validated by Blender: no bpy module under build/blender, and no --blender", file=sys.stderr)
            return
        command = [sys.executable, tools[-1], "validate", extension]
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=120)
    if done.returncode:
        raise Problem(f"Blender's validator: {(done.stdout + done.stderr).strip()}")


if __name__ == "__main__":
    sys.exit(main())
