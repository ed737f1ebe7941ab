"""Reads what neve export wrote with VTK, the library behind ParaView, and compares it with the numpy
archive of the same moment, bit by bit.

    check_vtk.py DIR NUMBER
"""

import sys
import xml.etree.ElementTree as ElementTree

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkIOXML import vtkXMLImageDataReader, vtkXMLPolyDataReader

folder, number = sys.argv[1], int(sys.argv[2])
name = f"{folder}/{{0}}/{number:04d}.{{0}}"
archive = np.load(name.format("npz"))
attributes = [k for k in archive if k not in ("time", "frame", "fps", "scale", "up")]


def read(reader, path):
    reader.SetFileName(path)
    reader.Update()
    assert reader.GetErrorCode() == 0, path
    return reader.GetOutput()


def same(a, b, what):
    b = vtk_to_numpy(b).reshape(a.shape)
    assert a.dtype == b.dtype and a.tobytes() == b.tobytes(), f"{what} differs"


# Particles.
snow = read(vtkXMLPolyDataReader(), name.format("vtp"))
count = len(archive["x"])
assert snow.GetNumberOfPoints() == snow.GetNumberOfVerts() == count
same(archive["x"], snow.GetPoints().GetData(), "x")
for what in attributes:
    if what != "x":
        same(archive[what], snow.GetPointData().GetArray(what), what)
assert snow.GetFieldData().GetArray("TimeValue").GetValue(0) == archive["time"]

# The grid: every node at its place. The nearest node of most particles has mass.
grid = read(vtkXMLImageDataReader(), name.format("vti"))
mass = vtk_to_numpy(grid.GetPointData().GetArray("mass"))
np.testing.assert_allclose(mass.sum(), archive["m"].sum(dtype="f8"), rtol=1e-5)
nearest = [grid.FindPoint(*x) for x in archive["x"]]
assert min(nearest) >= 0 and (mass[nearest] > 0).all()
assert vtk_to_numpy(grid.GetPointData().GetArray("velocity")).shape == (len(mass), 3)

# PLY: places, which this reader has in single precision.
ply = read(vtkPLYReader(), name.format("ply"))
assert ply.GetNumberOfPoints() == count
np.testing.assert_array_equal(vtk_to_numpy(ply.GetPoints().GetData()), archive["x"].astype("f4"))

# The series name every file, with its time.
for series in ("vtp", "vti"):
    sets = ElementTree.parse(f"{folder}/{series}.pvd").getroot().find("Collection")
    times = [float(s.get("timestep")) for s in sets]
    assert times == sorted(set(times)) and times[number] == archive["time"], times
    reader = {"vtp": vtkXMLPolyDataReader, "vti": vtkXMLImageDataReader}[series]
    for s in sets:
        assert read(reader(), f"{folder}/{s.get('file')}").GetNumberOfPoints() > 0
print("same")
