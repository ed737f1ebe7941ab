#!/usr/bin/env python3
"""Makes the files that a picture names relative to its folder, so that any clone draws it again.

    docs/gallery/portable.py SCENES PNG ...     SCENES: the absolute path of scenes/; the pictures are in docs/NAME/
"""
import pathlib
import struct
import sys
import zlib

SIGNATURE = 8


def portable(data, scenes):
    parts = [data[:SIGNATURE]]
    at = SIGNATURE
    while at < len(data):
        size = struct.unpack(">I", data[at:at + 4])[0]
        kind, body = data[at + 4:at + 8], data[at + 8:at + 8 + size]
        if kind in (b"tEXt", b"iTXt"):
            body = body.replace(scenes.encode(), b"../../scenes")
        parts += [struct.pack(">I", len(body)), kind, body, struct.pack(">I", zlib.crc32(kind + body))]
        at += 12 + size
    return b"".join(parts)


for name in sys.argv[2:]:
    picture = pathlib.Path(name)
    picture.write_bytes(portable(picture.read_bytes(), sys.argv[1]))
