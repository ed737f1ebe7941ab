"""Reads scan lines of OpenEXR, compressed by ZIP, without the library that wrote them.

The layout is that of "OpenEXR File Layout" at openexr.com. Gives text attributes and channels.
"""

import struct
import zlib

import numpy as np


def read_text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def read_header(data):
    assert data[:4] == b"\x76\x2f\x31\x01", "no OpenEXR file"
    attributes, at = {}, 8
    while data[at]:
        name, at = read_text(data, at)
        kind, at = read_text(data, at)
        (size,) = struct.unpack_from("<i", data, at)
        attributes[name] = (kind, data[at + 4 : at + 4 + size])
        at += 4 + size
    return attributes, at + 1


def read_channels(value):
    channels, at = [], 0
    while value[at]:
        name, at = read_text(value, at)
        (kind,) = struct.unpack_from("<i", value, at)
        channels.append((name, {1: "<f2", 2: "<f4"}[kind]))
        at += 16
    return channels


def undo_zip(block, size):
    if len(block) == size:
        return block
    raw = np.frombuffer(zlib.decompress(block), np.uint8).astype(np.int64)
    raw[1:] -= 128
    raw = np.cumsum(raw).astype(np.uint8)
    out = np.empty(size, np.uint8)
    half = (size + 1) // 2
    out[0::2], out[1::2] = raw[:half], raw[half:]
    return out.tobytes()


def read_exr(path):
    """Returns texts and channels: name to an array of rows, the top one first."""
    data = open(path, "rb").read()
    attributes, at = read_header(data)
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"][1])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    assert attributes["compression"][1] == b"\3", "compressed by something else than ZIP"
    channels = read_channels(attributes["channels"][1])
    planes = {name: np.empty((height, width), kind) for name, kind in channels}
    row_size = sum(width * np.dtype(kind).itemsize for _, kind in channels)
    count = (height + 15) // 16
    for offset in struct.unpack_from(f"<{count}Q", data, at):
        y, size = struct.unpack_from("<2i", data, offset)
        rows = min(16, height - (y - y0))
        block = undo_zip(data[offset + 8 : offset + 8 + size], rows * row_size)
        place = 0
        for row in range(y - y0, y - y0 + rows):
            for name, kind in channels:
                planes[name][row] = np.frombuffer(block, kind, width, place)
                place += width * np.dtype(kind).itemsize
    texts = {k: v.decode() for k, (kind, v) in attributes.items() if kind == "string"}
    matrices = {
        k: np.frombuffer(v, "<f4").reshape(4, 4)
        for k, (kind, v) in attributes.items()
        if kind == "m44f"
    }
    return texts, matrices, planes
