#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Blue noise of bench_sampling beside MeshLab's Poisson-disk sampling: same mesh, same number of points, same run.

Needs a build with -DVMAP_BUILD_BENCHMARKS=ON, the models in ../shared/models and the Python package pymeshlab.
MeshLab's time is that of the filter alone; ours includes writing the PLY file.
"""
import argparse
import json
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
COUNT = 200_000  # the larger of bench_sampling's counts takes MeshLab minutes


def our_seconds(program, model):
    """Wall time of sampling and writing, the best of three."""
    name = f"{model}/blue_noise/{COUNT}/real_time"
    command = [program, f"--benchmark_filter={name}$", "--benchmark_repetitions=3", "--benchmark_format=json"]
    runs = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["benchmarks"]
    return min(run["real_time"] for run in runs if run["run_type"] == "iteration") / 1000


def meshlab_seconds(pymeshlab, file):
    """Wall time of the filter, and how many points it made."""
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(file))
    start = time.perf_counter()
    meshes.generate_sampling_poisson_disk(samplenum=COUNT)
    return time.perf_counter() - start, meshes.current_mesh().vertex_number()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=ROOT / "build/release/bin/bench_sampling")
    parser.add_argument("models", nargs="*", default=["armadillo.off", "dragon.obj"])
    arguments = parser.parse_args()
    try:
        import pymeshlab
    except ImportError:
        print("SKIPPED: pymeshlab is not installed (pip install pymeshlab)", file=sys.stderr)
        return 77
    for name in arguments.models:
        file = ROOT.parent / "shared" / "models" / name
        if not file.exists():
            print(f"SKIPPED {name}: {file} is absent", file=sys.stderr)
            continue
        ours = our_seconds(arguments.program, file.stem)
        theirs, made = meshlab_seconds(pymeshlab, file)
        print(
            f"{name}: vmap {COUNT} points in {ours:.3f} s ({COUNT / ours / 1e6:.2f} M/s), "
            f"MeshLab {made} points in {theirs:.3f} s ({made / theirs / 1e6:.3f} M/s), "
            f"ratio {(COUNT / ours) / (made / theirs):.0f}"
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
