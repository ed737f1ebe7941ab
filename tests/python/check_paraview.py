"""Opens the series that neve export wrote with ParaView and compares every moment with its numpy
archive.

    pvpython check_paraview.py DIR
"""

import glob
import sys

import numpy as np
from paraview import servermanager
from paraview.simple import Contour, PVDReader
from vtkmodules.util.numpy_support import vtk_to_numpy

folder = sys.argv[1]
archives = [np.load(path) for path in sorted(glob.glob(f"{folder}/npz/*.npz"))]
assert len(archives) > 2


def same(found, wanted, what):
    found = vtk_to_numpy(found).reshape(wanted.shape)
    assert found.dtype == wanted.dtype and found.tobytes() == wanted.tobytes(), what


def at_each_time(series):
    """The reader and its data at the time of each archive."""
    reader = PVDReader(FileName=f"{folder}/{series}.pvd")
    assert list(reader.TimestepValues) == [float(a["time"]) for a in archives]
    for archive in archives:
        reader.UpdatePipeline(float(archive["time"]))
        yield reader, servermanager.Fetch(reader), archive


for _, snow, archive in at_each_time("vtp"):
    same(snow.GetPoints().GetData(), archive["x"], "x")
    for name in archive:
        if name not in ("x", "time", "frame", "fps", "scale", "up"):
            same(snow.GetPointData().GetArray(name), archive[name], name)

# The grid, and the contour that docs/pipeline.md draws of it.
for reader, grid, archive in at_each_time("vti"):
    mass = vtk_to_numpy(grid.GetPointData().GetArray("mass"))
    np.testing.assert_allclose(mass.sum(), archive["m"].sum(dtype="f8"), rtol=1e-5)
contour = Contour(Input=reader, ContourBy=["POINTS", "mass"], Isosurfaces=[0.3 * float(mass.max())])
contour.UpdatePipeline(float(archives[-1]["time"]))
assert contour.GetDataInformation().GetNumberOfPoints() > 50
print("same")
