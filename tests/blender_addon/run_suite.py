#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the add-on's suite in one Blender: run_suite.py BLENDER [pytest arguments].

BLENDER is "debian" for the program `blender`, "window" for the same with a window on a virtual display, or the version
of a bpy module, which is installed from the Python registry under build/blender when it is not there yet. Ends with 77,
loudly, when that Blender cannot be had.
"""

import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
INSIDE = ROOT / "tests" / "blender_addon" / "in_blender.py"
SKIPPED = 77
INSTALL_SECONDS, SUITE_SECONDS, WINDOW_SECONDS = 300, 240, 120


def main():
    wanted, arguments = sys.argv[1], sys.argv[2:]
    if wanted == "window":
        return run_in_window()
    command = debian_command() if wanted == "debian" else module_command(wanted)
    if "--install-only" in arguments:
        return 0
    with tempfile.TemporaryDirectory(prefix="vmap-blender-") as resources:
        return run([*command, *arguments], SUITE_SECONDS, environment_for(resources))


def environment_for(resources):
    """Settings of no user; Debian's Python before any other, because Debian's Blender takes the first one's library."""
    path = os.pathsep.join(["/usr/bin", os.environ.get("PATH", "")])
    return {**os.environ, "PATH": path, "BLENDER_USER_RESOURCES": resources, "PYTHONDONTWRITEBYTECODE": "1"}


def run_in_window():
    blender, display = shutil.which("blender"), shutil.which("xvfb-run")
    if not blender or not display:
        skip("needs the programs blender and xvfb-run")
    with tempfile.TemporaryDirectory(prefix="blender-window-") as folder:
        width, height = (
            (1024, 1200) if "VMAP_PICTURES" in os.environ else (640, 480)
        )  # drawn by software: small is quick
        command = [display, "-a", "-s", f"-screen 0 {width}x{height}x24", blender, "--factory-startup"]
        command += ["--enable-event-simulate", "--window-geometry", "0", "0", str(width), str(height)]
        command += ["--python-exit-code", "1"]
        command += ["--python", ROOT / "tests" / "blender_addon" / "window" / "in_window.py", "--", folder]
        log = Path(folder) / "log"
        environment = {**environment_for(folder), "LIBGL_ALWAYS_SOFTWARE": "1", "TMPDIR": folder}
        with open(log, "w") as output:
            code = run(command, WINDOW_SECONDS, environment, output)
        text = log.read_text(errors="replace")
        print(text)
        # Blender goes on after an error in a panel; it must not go unseen.
        return code or int("Traceback" in text)


def debian_command():
    program = shutil.which("blender")
    if not program:
        skip("the program blender is not installed")
    return [program, "-b", "-t", "2", "--factory-startup", "--python-exit-code", "1", "--python", str(INSIDE), "--"]


def module_command(version):
    python = python_for("3.13" if version >= "5.1" else "3.11")
    folder = ROOT / "build" / "blender" / f"bpy-{version}"
    if not (folder / ".done").exists():
        if not python:
            skip(f"bpy {version} needs a Python that is not installed")
        print(f"installing bpy {version} into {folder} (about 1 GB)", flush=True)
        shutil.rmtree(folder, ignore_errors=True)
        steps = [
            [python, "-m", "venv", folder],
            [folder / "bin" / "pip", "install", "--quiet", "--no-cache-dir", f"bpy=={version}", "pytest"],
        ]
        for step in steps:
            if run(step, INSTALL_SECONDS):
                shutil.rmtree(folder, ignore_errors=True)
                skip(f"bpy {version} could not be installed")
        (folder / ".done").touch()
    return [folder / "bin" / "python", INSIDE]


def python_for(version):
    """A Python of this version: on PATH, or one that pyenv keeps."""
    candidates = [f"/usr/bin/python{version}", shutil.which(f"python{version}")]
    candidates += sorted(map(str, Path.home().glob(f".pyenv/versions/{version}.*/bin/python{version}")))
    for candidate in candidates:
        if (
            candidate
            and os.access(candidate, os.X_OK)
            and subprocess.run([candidate, "--version"], capture_output=True).returncode == 0
        ):
            return candidate
    return None


def run(command, seconds, environment=None, output=None):
    """Exit status; what outlives its time is ended with all that it started."""
    process = subprocess.Popen(
        [str(c) for c in command], env=environment, stdout=output, stderr=output, start_new_session=True
    )
    try:
        return process.wait(seconds)
    except subprocess.TimeoutExpired:
        print(f"run_suite.py: ended after {seconds} s", file=sys.stderr)
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        return 124


def skip(reason):
    print(f"SKIPPED: {reason}", file=sys.stderr)
    sys.exit(SKIPPED)


if __name__ == "__main__":
    if len(sys.argv) < 2 or not re.fullmatch(r"debian|window|\d+\.\d+\.\d+", sys.argv[1]):
        sys.exit(__doc__)
    sys.exit(main())
