# SPDX-License-Identifier: GPL-3.0-or-later
"""Ctrl-C and termination: the program ends at once, with its exit code, and every file is as it was."""

import signal
import subprocess
import time
from pathlib import Path

import pytest
from conftest import INTERRUPTED, PROGRAM, TERMINATED, content, scene, succeed

PATIENCE = 3.0  # seconds: a user waits one at most, a machine that does other things besides may need more


def has_begun(process):
    """Whether it has taken the signals over; while its libraries are loaded it dies of them like any program.

    That all signals are blocked says nothing: the C library does so for a moment whenever a thread is made.
    """
    status = Path(f"/proc/{process.pid}/status").read_text()
    blocked = int(status.split("SigBlk:")[1].split()[0], 16)
    return blocked >> (signal.SIGINT - 1) & 1 and not blocked >> (signal.SIGWINCH - 1) & 1


def stopped(arguments, kind, after):
    """Exit code of a run that gets a signal after so many seconds, and how long it took to end; None: it was done."""
    process = subprocess.Popen([PROGRAM, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    while process.poll() is None and not has_begun(process):
        time.sleep(0.002)
    time.sleep(after)
    if process.poll() is not None:
        return None, 0, process.communicate()[1]
    process.send_signal(kind)
    start = time.monotonic()
    _, said = process.communicate(timeout=30)
    return process.returncode, time.monotonic() - start, said


@pytest.mark.parametrize("kind, code", [(signal.SIGINT, INTERRUPTED), (signal.SIGTERM, TERMINATED)])
@pytest.mark.parametrize("after", [0.1, 0.4, 1.0, 2.0])
def test_a_long_job_ends_at_once(folder, kind, code, after):
    (folder / "lit.ply").write_bytes(b"an old result")
    before = content(folder)
    lit = ("light", scene("cornell_box"), "--points", 2_000_000, "--tolerance", "1e-4")
    returned, seconds, said = stopped((*lit, "-o", "lit.ply", "-o", "lit.vdb", "--json", "report.json"), kind, after)
    assert returned == code, said
    assert seconds < PATIENCE
    assert b"error" not in said
    assert content(folder) == before


@pytest.mark.parametrize("after", [0.1, 0.5])
def test_a_long_picture_ends_at_once(folder, after):
    succeed("light", scene("cornell_box"), "--points", 5000, "-o", "lit.ply")
    before = content(folder)
    drawn = ("render", "lit.ply", "--scene", scene("cornell_box"), "--size", "8000x8000", "-o", "a.png", "-o", "a.exr")
    returned, seconds, said = stopped(drawn, signal.SIGINT, after)
    assert returned == INTERRUPTED, said
    assert seconds < PATIENCE
    assert content(folder) == before


def test_a_signal_at_any_moment_leaves_all_outputs_or_none(folder):
    """Also in the moment in which the files are put in place."""
    lit = ("light", scene("furnace_50"), "--points", 5000, "-o", "a.ply", "-o", "b.vdb", "-o", "c.glb")
    start = time.monotonic()
    succeed(*lit)
    whole = time.monotonic() - start
    complete = set(content(folder))
    for i in range(12):
        for path in folder.iterdir():
            path.unlink()
        returned, seconds, said = stopped(lit, signal.SIGINT, whole * i / 12)
        assert seconds < PATIENCE
        left = set(content(folder))
        if returned == INTERRUPTED:
            assert left in (set(), complete), said
        else:
            assert returned in (0, None) and left == complete
