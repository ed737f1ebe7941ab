"""Draws the passes of an OpenEXR picture of neve side by side: sheet.py FILE.exr SHEET.png.

Three rows: beauty, depth, normal; direct, indirect, shadow; motion, id, collider.
"""

import struct
import sys
import zlib
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "tests/python"))
from read_exr import read_exr  # noqa: E402

SHRINK = 3


def write_png(path, rgb):
    height, width, _ = rgb.shape
    rows = b"".join(b"\0" + row.tobytes() for row in (rgb.clip(0, 1) * 255 + 0.5).astype("u1"))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    parts = [chunk(b"IHDR", header), chunk(b"IDAT", zlib.compress(rows, 9)), chunk(b"IEND", b"")]
    Path(path).write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(parts))


def tone_mapped(c):
    c = 0.8 * c.clip(0)
    return (c * (1 + c / 4.84) / (1 + 0.55 * c)).clip(0, 1) ** (1 / 2.2)


def numbered(numbers):
    """A colour for each number, black for none."""
    mixed = (numbers.astype("i8") + 1) * 2654435761 & 0xFFFFFF
    colors = np.stack([mixed >> 16 & 255, mixed >> 8 & 255, mixed & 255], -1) / 255
    return np.where(numbers[..., None] >= 0, 0.2 + 0.8 * colors, 0)


_, _, planes = read_exr(sys.argv[1])
plane = {name: numbers.astype(float) for name, numbers in planes.items()}


def layer(name, channels="RGB"):
    return np.stack([plane[(name + "." if name else "") + c] for c in channels], -1)


z = plane["depth.Z"]
near, far = np.percentile(z[z < 1e9], [1, 97])
depth = np.where(z < 1e9, 1 - 0.9 * ((z - near) / (far - near)).clip(0, 1), 0)
normal = layer("normal", "XYZ")
u, v = plane["forward.u"], plane["forward.v"]
fastest = np.percentile(np.hypot(u, v), 99.8)
motion = 0.5 + 0.5 * np.stack([u / fastest, v / fastest, 0 * u], -1)
tiles = [
    tone_mapped(layer("")),
    depth[..., None].repeat(3, -1),
    np.where(np.any(normal != 0, -1, keepdims=True), 0.5 + 0.5 * normal, 0),
    tone_mapped(layer("direct")),
    tone_mapped(layer("indirect")),
    layer("shadow").clip(0, 1) ** (1 / 2.2),
    motion,
    numbered(plane["id.Y"]),
    numbered(plane["collider.Y"]),
]
height, width = (size // SHRINK for size in z.shape)
small = [
    t[: height * SHRINK, : width * SHRINK].clip(0, 1).reshape(height, SHRINK, width, SHRINK, 3).mean((1, 3))
    for t in tiles
]
write_png(sys.argv[2], np.concatenate([np.concatenate(small[k : k + 3], 1) for k in (0, 3, 6)]))
