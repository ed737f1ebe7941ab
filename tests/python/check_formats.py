"""Compares one moment in every format with the state as neve dump shows it, bit by bit.

    check_formats.py DIR NUMBER DUMP.vtp [z SCALE]
"""

import json
import sys

import numpy as np

from readers import read_bgeo, read_csv, read_ply, read_usda, read_vtk

folder, number, dump_file = sys.argv[1], int(sys.argv[2]), sys.argv[3]
is_z_up, scale = len(sys.argv) > 4, float(sys.argv[5]) if len(sys.argv) > 5 else 1.0
name = f"{folder}/{{0}}/{number:04d}.{{0}}"


def same(a, b, what):
    """Equal bits, in the type of the first; text is read in that type."""
    a = np.asarray(a)
    b = np.asarray(b).astype(a.dtype)
    assert a.shape == b.shape, f"{what}: {a.shape} and {b.shape}"
    assert a.tobytes() == b.tobytes(), f"{what}: {np.count_nonzero(a != b)} of {a.size} differ"


def turned(values, what):
    """The axes of the file, from those of the simulation."""
    turn = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]) if is_z_up else np.eye(3)
    if values.ndim == 2:
        return values @ turn.T * (scale if what in ("x", "v") else 1)
    return turn @ values @ turn.T if values.ndim == 3 else values


# 1. The archive against the state, which the dump has in double.
archive = np.load(name.format("npz"))
dump = read_vtk(dump_file)
attributes = [k for k in archive if k not in ("time", "frame", "fps", "scale", "up")]
assert str(archive["up"]) == ("z" if is_z_up else "y") and archive["scale"] == scale
expected_types = {"id": "i4", "x": "f8", "v": "f4", "F_E": "f4", "J_E": "f8", "age": "f8"}
for what, kind in expected_types.items():
    assert archive[what].dtype == kind, (what, archive[what].dtype)
of_state = [k for k in attributes if k in dump]
assert set(of_state) >= {"id", "x", "v", "m", "V0", "J_P", "F_E", "kirchhoff", "C", "J_E"}, of_state
for what in of_state:
    # + 0 makes a positive zero of a negative one, which turning the axes may leave.
    same(archive[what] + 0, turned(dump[what], what) + 0, f"npz {what} and the state")
assert len(np.unique(archive["x"], axis=0)) == len(archive["x"]) > 100

# 2. What follows from the state.
J = np.linalg.det(dump["F_E"]) * dump["J_P"]
np.testing.assert_allclose(archive["density"], dump["m"] / dump["V0"] / J, rtol=1e-12)
cauchy = turned(dump["kirchhoff"], "") / J[:, None, None]
np.testing.assert_allclose(archive["stress"], cauchy, rtol=1e-12, atol=1e-9)
ball = 4 / 3 * np.pi * (archive["radius"] / scale) ** 3
np.testing.assert_allclose(ball, dump["V0"], rtol=1e-6)
assert (archive["age"] == archive["time"]).all()
assert set(archive["body"]) == {0, 1} and set(archive["material"]) == {0, 1}

# 3. Every other format against the archive.
ply, csv = read_ply(name.format("ply")), read_csv(name.format("csv"))
vtp, bgeo = read_vtk(name.format("vtp")), read_bgeo(name.format("bgeo"))
usda = read_usda(name.format("usda"))
usd_names = {"x": "points", "v": "velocities", "id": "ids", "radius": "widths"}
for what in attributes:
    values = archive[what]
    same(values, ply[what], f"ply {what}")
    same(values, csv[what], f"csv {what}")
    assert ply[what].dtype == values.dtype, what
    in_vtp = vtp["Points" if what == "x" else what]
    assert in_vtp.dtype == values.dtype, what
    same(values, in_vtp, f"vtp {what}")
    # Single precision is all that this format has.
    single = values if values.dtype == "i4" else values.astype("f4")
    same(single, bgeo["pscale" if what == "radius" else what], f"bgeo {what}")
    in_usda = usda[usd_names.get(what, what)]
    wanted = {"x": single, "v": single, "radius": (2 * values).astype("f4")}.get(what, values)
    same(wanted, in_usda, f"usda {what}")
same(archive["m"].astype("f4"), usda["physics:masses"], "usda masses")
assert vtp["TimeValue"] == archive["time"]
assert abs(bgeo["detail"]["time"] - archive["time"]) < 1e-6 and bgeo["detail"]["fps"] == 24
assert usda["times"] == {float(archive["frame"])}, usda["times"]
meta = usda["metadata"]
assert meta["upAxis"] == ('"Z"' if is_z_up else '"Y"') and float(meta["metersPerUnit"]) == 1 / scale
assert float(meta["timeCodesPerSecond"]) == 24
low, high = usda["extent"]
assert (low <= usda["points"]).all() and (usda["points"] <= high).all()

# 4. The grid: its mass is the mass of the snow, its velocity carries the momentum.
grid = read_vtk(name.format("vti"))
low, high = grid["WholeExtent"][::2], grid["WholeExtent"][1::2]
shape = (high - low + 1).astype(int)
assert grid["mass"].size == shape.prod() and (grid["mass"] >= 0).all()
np.testing.assert_allclose(grid["mass"].sum(), archive["m"].sum(dtype="f8"), rtol=1e-5)
momentum = (grid["mass"][:, None] * grid["velocity"]).sum(axis=0)
snow = (archive["m"][:, None].astype("f8") * archive["v"]).sum(axis=0)
np.testing.assert_allclose(momentum, snow, rtol=1e-4, atol=1e-4 * scale)
i, j, k = np.meshgrid(*(np.arange(n) for n in shape), indexing="ij")
places = np.stack([a.transpose(2, 1, 0).ravel() for a in (i, j, k)], 1)
places = grid["Origin"] + places * grid["Spacing"]
centre = (grid["mass"][:, None] * places).sum(axis=0) / grid["mass"].sum()
of_snow = (archive["m"][:, None].astype("f8") * archive["x"]).sum(0) / archive["m"].sum(dtype="f8")
np.testing.assert_allclose(centre, of_snow, atol=1e-4 * scale)

# 5. The list.
listed = json.load(open(f"{folder}/export.json"))
for e in listed["exports"]:
    if e["format"] == "vti":
        continue
    assert [a["name"] for a in e["attributes"]] == attributes, e["attributes"]
    for a in e["attributes"]:
        assert a["type"] == archive[a["name"]].dtype.name, a
        assert a["components"] == archive[a["name"]][0].size, a
print("same")
