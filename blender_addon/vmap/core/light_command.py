# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line of `vmap light`, and what its report says."""

import json
from dataclasses import dataclass, field

from .errors import AddonError, printable


@dataclass
class LightRequest:
    """What to ask of the program. points and spacing: 0 leaves the choice to the program; at most one is set."""

    tolerance: float = 0.01
    points: int = 0
    spacing: float = 0.0  # metres
    sky: str = ""  # "r,g,b" or the path of a panorama


@dataclass
class LightReport:
    points: int = 0
    seconds: float = 0.0
    error_mean: float = None
    warnings: list = field(default_factory=list)


def light_command(program, scene_path, outputs, report_path, progress_path, request):
    """Argument list; throws AddonError when this program lacks what the request needs."""
    command = [program.path, "light", scene_path]
    for output in outputs:
        command += ["-o", output]
    command += ["--json", report_path, "--progress", progress_path, "--light-units", "compat"]
    command += ["--tolerance", repr(float(request.tolerance))]
    if request.points and request.spacing:
        raise AddonError("points and spacing exclude each other")
    if request.points:
        command += ["--points", str(int(request.points))]
    if request.spacing:
        command += ["--spacing", repr(float(request.spacing))]
    if request.sky:
        command += ["--sky", request.sky]
    return command


def read_report(path):
    """LightReport of the program's --json file; what it does not say stays at its default."""
    try:
        with open(path, encoding="utf-8") as file:
            data = json.load(file)
        report = LightReport(int(data["points"]), float(data["seconds"]["total"]))
        report.warnings = [printable(w) for w in data.get("warnings", [])]
        report.error_mean = data.get("error_estimate", {}).get("mean")
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise AddonError(f"the program's report cannot be read: {printable(error)}") from None
    return report
