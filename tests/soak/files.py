"""Files that scenes name: meshes, points, heights, pictures."""

import math
import struct
import zlib


def png(width, height, depth, channels, value):
    """value(x, y, channel), 0 to 1"""
    largest, code = 2 ** depth - 1, {8: "B", 16: "H"}[depth]
    row = lambda y: b"\0" + struct.pack(f">{width * channels}{code}", *(
        round(largest * value(x, y, c)) for x in range(width) for c in range(channels)))
    chunk = lambda kind, body: struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    head = struct.pack(">IIBBBBB", width, height, depth, {1: 0, 3: 2, 4: 6}[channels], 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) +
            chunk(b"IDAT", zlib.compress(b"".join(map(row, range(height))))) + chunk(b"IEND", b""))


def plate(draw):
    """A picture behind the snow, with alpha or without."""
    slope = draw.within(0, 1)
    return png(48, 32, draw.one(8, 16), draw.one(3, 4),
               lambda x, y, c: abs(math.sin(0.1 * x + slope * y + c)))


def octahedron(draw, size):
    """Corners and faces of a closed mesh with dents."""
    corners = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    corners = [tuple(size * c * draw.within(0.6, 1) for c in corner) for corner in corners]
    faces = [(a, b, c) if (i + j + k) % 2 == 0 else (a, c, b)
             for i, a in enumerate((1, 2)) for j, b in enumerate((3, 4)) for k, c in enumerate((5, 6))]
    return corners, faces


def obj(corners, faces, moved=(0, 0, 0)):
    lines = ["v " + " ".join(repr(c + m) for c, m in zip(corner, moved)) for corner in corners]
    return "\n".join(lines + ["f %d %d %d" % face for face in faces]) + "\n"


def deforming(draw, size, count):
    """Texts of one mesh whose corners move by some of its size from file to file."""
    corners, faces = octahedron(draw, size)
    for _ in range(count):
        yield obj(corners, faces)
        corners = [tuple(c + 0.15 * size * draw.within(-1, 1) for c in corner) for corner in corners]


def points(draw, places, spacing, speed):
    """@return suffix and text of a file with some of the columns that points may have"""
    columns = ["x", "y", "z"] + ["vx", "vy", "vz"] * draw.chance(0.4)
    columns += [name for name in ("J_P", "V0", "stiffness", "colour") if draw.chance(0.25)]
    values = {"J_P": lambda: draw.within(0.8, 1.3), "V0": lambda: spacing ** 3 * draw.within(0.5, 1.5),
              "stiffness": lambda: draw.within(0.3, 3), "colour": lambda: draw.within(0, 1)}
    rows = [place + [values.get(name, lambda: speed * draw.within(-1, 1))() for name in columns[3:]]
            for place in places]
    if draw.chance(0.5):
        return ".csv", "\n".join([",".join(columns)] + [",".join(map(repr, row)) for row in rows]) + "\n"
    head = ["ply", "format ascii 1.0", f"element vertex {len(rows)}"]
    head += [f"property double {name}" for name in columns] + ["end_header"]
    return ".ply", "\n".join(head + [" ".join(map(repr, row)) for row in rows]) + "\n"


def terrain(draw, h):
    """@return suffix, file, and keys of a terrain of gentle hills, some cells from post to post"""
    columns, rows, spacing = draw.random.randint(8, 24), draw.random.randint(8, 24), h * draw.within(1, 3)
    slope, height, wave = draw.within(-0.5, 0.5), h * draw.within(0, 2), draw.within(0.2, 1)
    at = lambda x, y: slope * spacing * x + height * math.sin(wave * x) * math.cos(wave * y)
    if draw.chance(0.3):
        least = min(at(x, y) for x in range(columns) for y in range(rows))
        span = max(at(x, y) for x in range(columns) for y in range(rows)) - least + h
        keys = {"spacing": spacing, "low": least, "high": least + span}
        return ".png", png(columns, rows, 16, 1, lambda x, y, _: (at(x, y) - least) / span), keys
    corner = f"xllcorner {-spacing * columns / 2!r}\nyllcorner {-spacing * rows / 2!r}"
    head = f"ncols {columns}\nnrows {rows}\n{corner}\ncellsize {spacing!r}\n"
    hole = (0, 0) if draw.chance(0.2) else None
    lines = [" ".join("-9999" if (x, y) == hole else repr(at(x, y)) for x in range(columns)) for y in range(rows)]
    return ".asc", head + "NODATA_value -9999\n" + "\n".join(lines) + "\n", {}
