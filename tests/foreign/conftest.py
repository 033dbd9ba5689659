# SPDX-License-Identifier: GPL-3.0-or-later
"""What the files should hold, in the axes of the format under test."""

import json
import os
from pathlib import Path

import numpy
import pytest

SKIPPED = 77


@pytest.fixture(scope="session")
def samples():
    return Path(os.environ["VMAP_SAMPLES"])


@pytest.fixture(scope="session")
def expected(samples):
    content = json.loads((samples / "expected.json").read_text())
    return {key: numpy.array(value, dtype=numpy.float64) for key, value in content.items()}


def z_up(vectors):
    """glTF's (x, y, z) is Blender's (x, -z, y)."""
    return numpy.stack([vectors[:, 0], -vectors[:, 2], vectors[:, 1]], axis=1)


def srgb(linear):
    linear = numpy.clip(linear, 0, 1)
    return numpy.where(linear <= 0.0031308, linear * 12.92, 1.055 * linear ** (1 / 2.4) - 0.055)


def radiance(expected):
    return expected["emission"] + expected["albedo"] * expected["irradiance"] / numpy.pi


def pytest_sessionfinish(session, exitstatus):
    """A run in which everything was skipped is a skipped test."""
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    if exitstatus == 0 and reporter.stats.get("skipped") and not reporter.stats.get("passed"):
        session.exitstatus = SKIPPED
