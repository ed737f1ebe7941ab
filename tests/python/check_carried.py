"""Attributes of point files that neve only carries along.

    check_carried.py write           points.ply and points.csv
    check_carried.py check DIR NUMBER
"""

import sys

import numpy as np

from readers import read_bgeo, read_csv, read_ply, read_usda, read_vtk

COUNT, SPACING, THINNING = 512, 0.02, 3


def places(offset):
    k = np.arange(COUNT)
    return SPACING * np.stack([k % 8, k // 8 % 8, k // 64], axis=1) + offset


def tables():
    """The columns of both files, the same at each call."""
    random = np.random.default_rng(1)
    bits = random.integers(0, 2 ** 31, COUNT).astype("u4")
    temperature = (bits & 0xBF7FFFFF).view("f4")  # any finite float
    weight = random.standard_normal(COUNT) * 10.0 ** random.integers(-30, 30, COUNT)
    brush = random.integers(-2 ** 31, 2 ** 31, COUNT).astype("i4")
    mark = random.integers(0, 256, COUNT).astype("u1")
    of_csv = random.standard_normal(COUNT)
    return {"temperature": temperature, "weight": weight, "brush": brush, "mark": mark}, of_csv


def write():
    columns, of_csv = tables()
    fields = [("x", "<f8"), ("y", "<f8"), ("z", "<f8"), ("temperature", "<f4"), ("weight", "<f8"),
              ("brush", "<i4"), ("mark", "u1")]
    names = {"<f8": "double", "<f4": "float", "<i4": "int", "u1": "uchar"}
    table = np.zeros(COUNT, fields)
    table["x"], table["y"], table["z"] = places([0, 0.1, 0]).T
    for name, values in columns.items():
        table[name] = values
    with open("points.ply", "wb") as file:
        head = ["ply", "format binary_little_endian 1.0", f"element vertex {COUNT}"]
        head += [f"property {names[kind]} {name}" for name, kind in fields] + ["end_header", ""]
        file.write("\n".join(head).encode() + table.tobytes())
    with open("points.csv", "w") as file:
        file.write("weight,x,y,z\n")
        for value, place in zip(of_csv, places([0.3, 0.1, 0])):
            file.write(",".join(repr(float(number)) for number in (value, *place)) + "\n")


def same(found, wanted, what):
    assert found.dtype == wanted.dtype, (what, found.dtype, wanted.dtype)
    assert found.tobytes() == wanted.tobytes(), what


def check(folder, number):
    columns, of_csv = tables()
    name = f"{folder}/{{0}}/{number:04d}.{{0}}"
    npz = np.load(name.format("npz"))
    assert (npz["id"] == np.arange(len(npz["id"]))).all()
    balls = int((npz["body"] == 0).sum())
    # Which points of the CSV are left; they fall, and keep their place along x and z.
    kept = [int(np.flatnonzero(of_csv == value)[0]) for value in npz["weight"][balls + COUNT:]]
    assert len(kept) == COUNT // THINNING and kept == sorted(set(kept)) and balls > 20
    way = npz["x"][balls + COUNT:] - places([0.3, 0.1, 0])[kept]
    assert abs(way[:, [0, 2]]).max() < 0.5 * SPACING, abs(way).max(axis=0)
    wanted = {}
    for what, kind in (("temperature", "f4"), ("weight", "f8"), ("brush", "i4"), ("mark", "i4")):
        of_thinned = of_csv[kept] if what == "weight" else np.zeros(len(kept))
        wanted[what] = np.concatenate(
            [np.zeros(balls, kind), columns[what].astype(kind), of_thinned.astype(kind)])
    ply, vtp, csv = (read(name.format(kind)) for read, kind in
                     ((read_ply, "ply"), (read_vtk, "vtp"), (read_csv, "csv")))
    usda, bgeo = read_usda(name.format("usda")), read_bgeo(name.format("bgeo"))
    for what, values in wanted.items():
        for found in (npz, ply, vtp):
            same(np.asarray(found[what]), values, what)
        same(csv[what].astype(values.dtype), values, what + " in csv")
        same(usda[what].astype(values.dtype), values, what + " in usda")
        single = values if values.dtype == "i4" else values.astype("f4")
        same(bgeo[what].astype(single.dtype), single, what + " in bgeo")
    print("same")


if sys.argv[1] == "write":
    write()
else:
    check(sys.argv[2], int(sys.argv[3]))
