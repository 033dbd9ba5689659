# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the suite inside Blender or with the bpy module: in_blender.py [pytest arguments].

Ends the process itself: Blender may crash or hang while it quits.
"""

import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]


def main():
    sys.path[:0] = [str(ROOT / "blender_addon"), str(HERE)]
    import bpy  # noqa: F401  # before anything that it may disturb
    import pytest

    arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    if not any("blender/" in a for a in arguments):
        arguments.append(str(HERE / "blender"))
    options = ["-p", "no:cacheprovider", "-q", "--rootdir", str(HERE), "-o", "filterwarnings=ignore:.*use_nodes"]
    return pytest.main([*options, *arguments])


if __name__ == "__main__":
    code = 1
    try:
        code = int(main())
    except BaseException:
        import traceback

        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)
