# SPDX-License-Identifier: GPL-3.0-or-later
"""Small files for the tests: lit points as PLY and glTF, in every layout that a user may bring."""

import json
import struct

import numpy as np

FORMATS = {"<": "binary_little_endian", ">": "binary_big_endian", "": "ascii"}
TYPES = {"f4": "float", "f8": "double", "u1": "uchar", "u2": "ushort", "u4": "uint"}

OUR_COLUMNS = [
    *((n, "f4") for n in ("x", "y", "z", "nx", "ny", "nz")),
    *((n, "u1") for n in ("red", "green", "blue")),
    *((f"{v}_{c}", "f4") for v in ("irradiance", "albedo") for c in "rgb"),
    ("radius", "f4"), ("area", "f4"), ("face_id", "u4"), ("material_id", "u4"),
]  # fmt: skip


def ply_bytes(rows, order="<", comments=(), before="", before_data=b"", element="vertex"):
    """A PLY file of a structured array; before: header lines of an element ahead of the vertices."""
    header = f"ply\nformat {FORMATS[order]} 1.0\n" + "".join(f"comment {c}\n" for c in comments) + before
    header += f"element {element} {len(rows)}\n"
    for name in rows.dtype.names:
        header += f"property {TYPES[rows.dtype[name].str[1:]]} {name}\n"
    header += "end_header\n"
    if order:
        swapped = rows.astype([(n, order + rows.dtype[n].str[1:]) for n in rows.dtype.names])
        return header.encode() + before_data + swapped.tobytes()
    text = "\n".join(" ".join(repr(v.item()) for v in row) for row in rows)
    return header.encode() + before_data + text.encode() + b"\n"


def our_rows(positions, normals=None, irradiance=1.0, albedo=0.5, radius=0.01):
    """Rows as the program writes them."""
    positions = np.asarray(positions, np.float32).reshape(-1, 3)
    rows = np.zeros(len(positions), OUR_COLUMNS)
    for axis, name in enumerate("xyz"):
        rows[name] = positions[:, axis]
        rows["n" + name] = (0, 0, 1)[axis] if normals is None else np.asarray(normals)[:, axis]
    for axis, channel in enumerate("rgb"):
        rows[f"irradiance_{channel}"] = np.broadcast_to(irradiance, (len(rows), 3))[:, axis]
        rows[f"albedo_{channel}"] = np.broadcast_to(albedo, (len(rows), 3))[:, axis]
    rows["radius"] = radius
    rows["area"] = np.pi * np.square(rows["radius"])
    rows["face_id"] = np.arange(len(rows))
    return rows


def our_ply(positions, offset=(0, 0, 0), up="z", exposure=1, order="<", **values):
    comments = [
        f"up {up}", "light_units compat punctual 1 directional 1",
        f"offset {offset[0]!r} {offset[1]!r} {offset[2]!r}", f"exposure {exposure}", "vmap 0.1.0", "source room.glb",
    ]  # fmt: skip
    return ply_bytes(our_rows(positions, **values), order, comments)


def glb_bytes(document, binary=b""):
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    size = 12 + 8 + len(text) + (8 + len(binary) if binary else 0)
    data = struct.pack("<4sII", b"glTF", 2, size) + struct.pack("<I4s", len(text), b"JSON") + text
    return data + (struct.pack("<I4s", len(binary), b"BIN\0") + binary if binary else b"")


def points_document(attributes, node=None, extras=None, uri=None, mode=0):
    """glTF document and its buffer; attributes: name -> (n, 3) or (n, 4) float32."""
    views, accessors, names, binary = [], [], {}, b""
    for name, array in attributes.items():
        data = np.asarray(array, np.float32)
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": data.nbytes})
        accessor = {"bufferView": len(views) - 1, "componentType": 5126, "count": len(data)}
        accessors.append({**accessor, "type": f"VEC{data.shape[1]}"})
        names[name] = len(accessors) - 1
        binary += data.tobytes()
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, **(node or {})}],
        "meshes": [{"primitives": [{"mode": mode, "attributes": names}], "extras": extras or {}}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(binary), **({"uri": uri} if uri else {})}],
    }
    return document, binary


def grid_positions(side, size=1.0):
    """side x side points in the middle of the cells of a square of this size around the origin, z = 0."""
    steps = (np.arange(side) + 0.5) / side * size - size / 2
    x, y = np.meshgrid(steps, steps)
    return np.stack([x.ravel(), y.ravel(), np.zeros(side * side)], axis=1).astype(np.float32)
