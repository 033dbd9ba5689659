# SPDX-License-Identifier: GPL-3.0-or-later
"""What the add-on knows without Blender: files, axes, units and the child process. Nothing here imports bpy."""
