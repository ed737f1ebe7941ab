"""Readers of the formats that neve export writes, after their published descriptions and without a
line of neve: each returns a dictionary of arrays, a row per particle."""

import re
import struct
import xml.etree.ElementTree as ElementTree

import numpy as np


def columns_to_arrays(columns):
    """Joins x y z, vx vy vz and F_E_xx ... F_E_zz."""
    arrays = {}
    for name, values in columns.items():
        tensor = re.fullmatch(r"(.+)_([xyz])([xyz])", name)
        if name in ("x", "y", "z"):
            arrays.setdefault("x", {})[name] = values
        elif name in ("vx", "vy", "vz"):
            arrays.setdefault("v", {})[name] = values
        elif tensor:
            arrays.setdefault(tensor[1], {})[tensor[2] + tensor[3]] = values
        else:
            arrays[name] = values
    for name, parts in arrays.items():
        if isinstance(parts, dict):
            stacked = np.stack(list(parts.values()), axis=1)
            arrays[name] = stacked.reshape(-1, 3, 3) if len(parts) == 9 else stacked
    return arrays


def read_ply(path):
    """Vertices, and the triangles and normals of a surface."""
    types = {"float": "<f4", "double": "<f8", "int": "<i4"}
    data = open(path, "rb").read()
    head, body = data.split(b"end_header\n", 1)
    lines = head.decode().splitlines()
    assert lines[0] == "ply" and lines[1] == "format binary_little_endian 1.0", lines[:2]
    count = next(int(l.split()[2]) for l in lines if l.startswith("element vertex "))
    is_number = [l.startswith("property ") and " list " not in l for l in lines]
    fields = [(l.split()[2], types[l.split()[1]]) for l, number in zip(lines, is_number) if number]
    table = np.frombuffer(body, dtype=fields, count=count)
    arrays = columns_to_arrays({name: table[name] for name, _ in fields})
    face_count = [int(l.split()[2]) for l in lines if l.startswith("element face ")]
    faces = np.frombuffer(body, [("size", "u1"), ("corners", "<i4", 3)], offset=table.nbytes)
    assert len(faces) == sum(face_count), (len(faces), face_count)
    if face_count:
        assert "property list uchar int vertex_indices" in lines and (faces["size"] == 3).all()
        arrays["faces"] = faces["corners"]
        arrays["normal"] = np.stack([arrays.pop("n" + axis) for axis in "xyz"], axis=1)
    return arrays


def read_obj(path):
    """Wavefront text: vertices, normals, triangles and points, counted from 0."""
    arrays = {"v": [], "vn": [], "f": [], "p": []}
    for line in open(path):
        word, *rest = line.split()
        if word == "f":
            corners = [tuple(corner.split("/")) for corner in rest]
            assert all(v == n and between == "" for v, between, n in corners)
            rest = [v for v, _, _ in corners]
        if word != "#":
            arrays[word].append(rest)
    vertices = {key: np.array(arrays[key], dtype="f4") for key in ("v", "vn")}
    faces = np.array(arrays["f"], dtype="i4") - 1
    return {**vertices, "f": faces, "p": np.array(arrays["p"], dtype="i4").ravel() - 1}


def read_csv(path):
    with open(path) as file:
        names = file.readline().strip().split(",")
        rows = [line.strip().split(",") for line in file]
    return columns_to_arrays({n: np.array([r[k] for r in rows]) for k, n in enumerate(names)})


def read_vtk(path):
    """PolyData or ImageData with raw appended arrays, and the attributes of the grid; the cells of
    polygons have the prefix "Polys"."""
    types = {"Float32": "<f4", "Float64": "<f8", "Int32": "<i4", "Int64": "<i8"}
    data = open(path, "rb").read()
    mark = data.index(b'<AppendedData encoding="raw">')
    start = data.index(b"_", mark) + 1
    root = ElementTree.fromstring(data[:mark] + b"</VTKFile>")
    arrays = {}
    for part, array in ((part, array) for part in root.iter() for array in part.findall("DataArray")):
        if array.get("format") != "appended":
            arrays[array.get("Name")] = float(array.text)
            continue
        at = start + int(array.get("offset"))
        (size,) = struct.unpack_from("<Q", data, at)
        kind = np.dtype(types[array.get("type")])
        values = np.frombuffer(data, kind, offset=at + 8, count=size // kind.itemsize)
        width = int(array.get("NumberOfComponents"))
        shape = {1: (-1,), 3: (-1, 3), 9: (-1, 3, 3)}[width]
        prefix = "Polys " if part.tag == "Polys" else ""
        arrays[prefix + array.get("Name")] = values.reshape(shape)
    grid = root.find("ImageData")
    if grid is not None:
        for key in ("Origin", "Spacing", "WholeExtent"):
            arrays[key] = np.array([float(word) for word in grid.get(key).split()])
    return arrays


def read_bgeo(path):
    """Classic Houdini geometry of version 5: points and attributes, big endian."""
    data = open(path, "rb").read()
    magic, mark, version, points, prims, *rest = struct.unpack_from(">4scIIIIIIIII", data)
    assert (magic, mark, version, prims) == (b"Bgeo", b"V", 5, 0), (magic, mark, version, prims)
    _, _, attributes, _, _, details = rest
    at = struct.calcsize(">4scIIIIIIIII")

    def definitions(at, count):
        fields = []
        for _ in range(count):
            (length,) = struct.unpack_from(">H", data, at)
            name = data[at + 2:at + 2 + length].decode()
            size, kind = struct.unpack_from(">HI", data, at + 2 + length)
            fields.append((name, {0: ">f4", 1: ">i4", 5: ">f4"}[kind], (size,)))
            at += 8 + length + 4 * size
        return fields, at

    fields, at = definitions(at, attributes)
    table = np.frombuffer(data, [("P", ">f4", (4,))] + fields, count=points, offset=at)
    at += table.nbytes
    fields_of_detail, at = definitions(at, details)
    detail = np.frombuffer(data, fields_of_detail, count=1, offset=at)
    assert data[at + detail.nbytes:] == b"\x00\xff", "the end is not the end"
    assert (table["P"][:, 3] == 1).all()
    arrays = {"x": table["P"][:, :3], "detail": {n: detail[n][0, 0] for n in detail.dtype.names}}
    for name, _, (size,) in fields:
        values = table[name]
        shapes = {1: values[:, 0], 3: values}
        arrays[name] = shapes[size] if size in shapes else values.reshape(-1, 3, 3)
    return arrays


def read_usda(path, prim='def Points "snow"'):
    """The time samples of a prim of a layer, and the metadata of the layer."""
    text = open(path, encoding="utf-8").read()
    head, *prims = re.split(r"(?=^    def )", text, flags=re.MULTILINE)
    text = head + next(p for p in prims if p.startswith("    " + prim))
    assert text.startswith("#usda 1.0\n"), text[:20]
    arrays = {"metadata": dict(re.findall(r"^    (\w+) = (.+)$", text, re.MULTILINE))}
    types = {"float": "f4", "double": "f8", "int": "i4", "int64": "i8", "point3f": "f4",
             "vector3f": "f4", "float3": "f4", "normal3f": "f4"}
    pattern = r"(\w+)\[\] ([\w:]+)\.timeSamples = \{\s+(\S+): \[(.*?)\],\s+\}"
    for kind, name, time, body in re.findall(pattern, text, re.DOTALL):
        words = body.replace("(", " ").replace(")", " ").replace(",", " ").split()
        arrays[name.removeprefix("primvars:")] = np.array(words, dtype=types[kind])
        arrays.setdefault("times", set()).add(float(time))
    for name in ("points", "velocities", "extent", "normals"):
        if name in arrays:
            arrays[name] = arrays[name].reshape(-1, 3)
    count = len(arrays["points"])
    for name, values in arrays.items():
        if isinstance(values, np.ndarray) and values.ndim == 1 and len(values) == 9 * count > 0:
            arrays[name] = values.reshape(-1, 3, 3)
    return arrays
