"""Reads what neve export wrote with OpenVDB and compares it with other formats of the same moment.

    check_vdb.py DIR NUMBER
"""

import sys

import numpy as np
import pyopenvdb as vdb

from readers import read_ply, read_vtk

folder, number = sys.argv[1], int(sys.argv[2])
path = f"{folder}/vdb/{number:04d}.vdb"
grids, metadata = vdb.readAll(path)
grids = {grid.name: grid for grid in grids}
assert set(grids) == {"mass", "density", "velocity", "surface"}, set(grids)
for name, kind in (("mass", "fog volume"), ("density", "fog volume"), ("surface", "level set")):
    assert str(grids[name].gridClass) == kind, (name, grids[name].gridClass)

# The nodes: the same numbers at the same places as in vti, and nothing else.
vti = read_vtk(f"{folder}/vti/{number:04d}.vti")
assert metadata["time"] == vti["TimeValue"], metadata
x0, x1, y0, y1, z0, z1 = vti["WholeExtent"].astype(int)
shape = (x1 + 1, y1 + 1, z1 + 1)
cell = vti["Spacing"][0]
corner = np.rint(vti["Origin"] / cell).astype(int)
np.testing.assert_allclose(corner * cell, vti["Origin"], atol=1e-9 * cell)


def dense(grid, kind):
    values = np.zeros(shape + kind, dtype="f4")
    grid.copyToArray(values, ijk=tuple(int(c) for c in corner))
    return values


mass = vti["mass"].reshape(shape[::-1]).transpose(2, 1, 0)
velocity = vti["velocity"].reshape(shape[::-1] + (3,)).transpose(2, 1, 0, 3)
assert (mass > 0).sum() > 100
for name in ("mass", "density", "velocity"):
    assert grids[name].activeVoxelCount() == (mass > 0).sum(), name
    np.testing.assert_allclose(grids[name].transform.voxelSize(), cell)
    np.testing.assert_allclose(grids[name].transform.indexToWorld((0, 0, 0)), 0, atol=1e-12)
assert (dense(grids["mass"], ()) == mass.astype("f4")).all()
assert (dense(grids["velocity"], (3,)) == velocity.astype("f4")).all()
units = metadata["units_per_metre"]
density = dense(grids["density"], ())
np.testing.assert_allclose(density, mass / (cell / units) ** 3, rtol=1e-6)

# The level set: 0 on the vertices of the mesh, the mesh's volume inside, distances in between.
surface = grids["surface"]
ply = read_ply(f"{folder}/ply/{number:04d}.ply")
corners = ply["x"][ply["faces"]]
volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6
voxel = surface.transform.voxelSize()[0]
low, high = surface.evalActiveVoxelBoundingBox()
low = np.array(low) - 4
distance = np.zeros(np.array(high) + 5 - low, dtype="f4")
surface.copyToArray(distance, ijk=tuple(int(c) for c in low))
assert abs(surface.background / (3 * voxel) - 1) < 1e-6
assert (np.abs(distance) <= surface.background).all()
inside = (distance < 0).sum() * voxel ** 3
assert abs(inside / volume - 1) < 0.05, (inside, volume)
places = ply["x"][: ply["faces"].max() + 1] / voxel - low
cell_of = np.floor(places).astype(int)
part = places - cell_of
at_vertex = np.zeros(len(places))
for k in range(8):
    step = np.array([k >> 2 & 1, k >> 1 & 1, k & 1])
    weight = np.where(step, part, 1 - part).prod(axis=1)
    at_vertex += weight * distance[tuple((cell_of + step).T)]
assert np.abs(at_vertex).max() < 0.6 * voxel, np.abs(at_vertex).max() / voxel
assert np.abs(at_vertex).mean() < 0.1 * voxel
band = np.abs(distance) < 2.9 * voxel
for axis in range(3):  # no distance changes by more than the way
    assert np.abs(np.diff(distance, axis=axis)).max() < voxel * (1 + 1e-5), axis
# Exact: against every vertex and the middles of all triangles, from which a voxel is no further.
samples = np.concatenate([ply["x"][np.unique(ply["faces"])], corners.mean(axis=1)])
for at in np.argwhere(band)[:: max(1, band.sum() // 300)]:
    nearest = np.linalg.norm((at + low) * voxel - samples, axis=1).min()
    found = abs(distance[tuple(at)])
    assert found <= nearest * (1 + 1e-5) + 1e-9 and nearest < found + voxel, (at, found, nearest)
print("same")
