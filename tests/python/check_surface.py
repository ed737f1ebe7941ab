"""Checks a surface of neve export: the same closed mesh in every format, spray with the bits of the
state.

    check_surface.py DIR NUMBER PARTICLES.npz [z SCALE]
"""

import sys

import numpy as np

from readers import read_obj, read_ply, read_usda, read_vtk

folder, number, particles_file = sys.argv[1], int(sys.argv[2]), sys.argv[3]
is_z_up, scale = len(sys.argv) > 4, float(sys.argv[5]) if len(sys.argv) > 5 else 1.0
name = f"{folder}/{{0}}/{number:04d}.{{0}}"
state = np.load(particles_file)
ply, vtp, obj = read_ply(name.format("ply")), read_vtk(name.format("vtp")), read_obj(name.format("obj"))
mesh = read_usda(name.format("usda"), 'def Mesh "snow"')
points = read_usda(name.format("usda"), 'def Points "spray"')
faces, x, normal = ply["faces"], ply["x"], ply["normal"]

# 1. Closed and oriented: every edge once in each direction. All vertices before the spray are used.
count = faces.max() + 1
assert len(faces) > 500 and 0 < count < len(x), (len(faces), count, len(x))
assert (np.unique(faces) == np.arange(count)).all()
edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).astype("i8")
there = edges[:, 0] * count + edges[:, 1]
back = edges[:, 1] * count + edges[:, 0]
assert len(np.unique(there)) == len(there), "an edge belongs to two triangles of one direction"
assert (np.sort(there) == np.sort(back)).all(), "an edge belongs to one triangle"

# 2. Normals point outwards, as the triangles do, and are of unit length; spray has none.
a, b, c = (x[faces[:, k]] for k in range(3))
volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
assert volume > 0
np.testing.assert_allclose(np.linalg.norm(normal[:count], axis=1), 1, rtol=1e-5)
assert (normal[count:] == 0).all()
across = np.cross(b - a, c - a)
facing = np.einsum("ij,ij->i", across, normal[faces].sum(axis=1))
assert (facing > 0).mean() > 0.99, (facing > 0).mean()

# 3. The snow in the mesh and the spray are all the particles; spray has the bits of the state.
spray = ply["id"][count:]
index = np.searchsorted(state["id"], spray)
assert (state["id"][index] == spray).all()
turn = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]) if is_z_up else np.eye(3)
for what in ("x", "v"):
    wanted = ((state[what] @ turn.T) * scale)[index].astype(ply[what].dtype)
    assert (wanted == ply[what][count:]).all(), what
assert (state["J_P"][index] == ply["J_P"][count:]).all()
loose = np.isin(state["id"], spray)
assert set(state["body"][loose]) == {1} and set(state["body"][~loose]) == {0}, "the cube is spray"
assert set(ply["material"][:count]) == {0} and set(ply["material"][count:]) == {1}
filled = (state["m"] / 400 * state["J_P"])[~loose].sum(dtype="f8") * scale ** 3
assert abs(volume / filled - 1) < 0.15, (volume, filled)  # 3 (0.8 / 4)^2 is 12 %
low, high = state["v"][~loose].min(axis=0), state["v"][~loose].max(axis=0)
speeds = ply["v"][:count] @ turn / scale
assert (speeds >= low - 1e-3).all() and (speeds <= high + 1e-3).all(), "attributes are means"

# 4. Every format has the same.
assert (vtp["Points"] == x).all() and (vtp["Normals"] == normal).all()
assert (vtp["Polys connectivity"].reshape(-1, 3) == faces).all()
assert (vtp["Polys offsets"] == 3 * np.arange(1, len(faces) + 1)).all()
assert (vtp["connectivity"] == np.arange(count, len(x))).all(), "spray is vertices"
single = x.astype("f4")
assert (obj["v"] == single).all() and (obj["vn"] == normal[:count]).all()
assert (obj["f"] == faces).all() and (obj["p"] == np.arange(count, len(x))).all()
assert (mesh["points"] == single[:count]).all() and (points["points"] == single[count:]).all()
assert (mesh["normals"] == normal[:count]).all()
assert (mesh["faceVertexIndices"].reshape(-1, 3) == faces).all()
assert (mesh["faceVertexCounts"] == 3).all() and len(mesh["faceVertexCounts"]) == len(faces)
for what in ("J_P", "F_E", "id", "material", "v", "density"):
    of_points = points[{"id": "ids", "v": "velocities"}.get(what, what)]
    of_mesh = mesh["velocities" if what == "v" else what]
    assert (vtp[what] == ply[what]).all(), what
    assert (np.concatenate([of_mesh, of_points]) == ply[what]).all(), what
print("same")
