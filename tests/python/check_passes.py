"""Checks a picture of a ball that flies at a constant velocity: arguments FILE.exr VX VY VZ FPS.

Reads the file without the library that wrote it, and prints "same" where all passes agree.
"""

import sys

import numpy as np
from read_exr import read_exr


def near(a, b, tolerance, what):
    worst = np.max(np.abs(np.asarray(a, float) - b))
    assert worst <= tolerance, f"{what} differs by {worst}"


path, velocity, fps = sys.argv[1], np.array(sys.argv[2:5], float), float(sys.argv[5])
texts, matrices, planes = read_exr(path)
height, width = planes["R"].shape


def vectors(layer):
    return np.stack([planes[f"{layer}.{axis}"] for axis in "XYZ"], -1).astype(float)


def project(places, matrix):
    """Rows of points by a matrix of OpenEXR, divided by the last number."""
    out = np.concatenate([places, np.ones_like(places[..., :1])], -1) @ matrix.astype(float)
    return out[..., :3] / out[..., 3:]


is_snow = planes["id.Y"] >= 0
assert np.count_nonzero(is_snow) > 200, "no snow in the picture"
place = vectors("position")[is_snow]
near(project(place, matrices["worldToCamera"])[:, 2], planes["depth.Z"][is_snow], 1e-4, "depth")
rows, columns = np.nonzero(is_snow)
ndc = project(place, matrices["worldToNDC"])
near(ndc[:, 0] * width, columns + 0.5, 0.01, "column")
near(ndc[:, 1] * height, rows + 0.5, 0.01, "row")
near(np.linalg.norm(vectors("normal")[is_snow], axis=1), 1, 2e-3, "length of normals")
near(vectors("v")[is_snow], velocity, 2e-3, "velocity")
near(planes["speed.Y"][is_snow], np.linalg.norm(velocity), 2e-3, "speed")
for name, sign in [("forward", 1), ("backward", -1)]:
    there = project(place + sign * velocity / fps, matrices["worldToNDC"])
    near(planes[name + ".u"][is_snow], (there[:, 0] - ndc[:, 0]) * width, 0.02, name + ".u")
    near(planes[name + ".v"][is_snow], -(there[:, 1] - ndc[:, 1]) * height, 0.02, name + ".v")
for color in "RGB":
    parts = sum(planes[f"{part}.{color}"].astype(float) for part in ["direct", "indirect", "emission"])
    near(parts, planes[color].astype(float), 3e-3, "sum of the light")
assert np.all(planes["body.Y"][is_snow] == 0) and np.all(planes["body.Y"][~is_snow] == -1)
is_nothing = ~is_snow & (planes["collider.Y"] < 0)
assert np.all(planes["depth.Z"][is_nothing] == np.float32(1e10))
assert texts["neve:bodies"] == "0 ball" and texts["neve:frame"] == "2", texts
print("same")
