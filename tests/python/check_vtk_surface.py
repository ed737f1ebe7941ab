"""Reads a surface that neve export wrote with VTK: a closed mesh in both formats, and its volume.

    check_vtk_surface.py DIR NUMBER
"""

import sys

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkFiltersCore import vtkFeatureEdges, vtkMassProperties, vtkTriangleFilter
from vtkmodules.vtkIOGeometry import vtkOBJReader
from vtkmodules.vtkIOPLY import vtkPLYReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from readers import read_ply

folder, number = sys.argv[1], int(sys.argv[2])


def read(reader, kind):
    reader.SetFileName(f"{folder}/{kind}/{number:04d}.{kind}")
    reader.Update()
    assert reader.GetErrorCode() == 0, kind
    return reader.GetOutput()


ply = read_ply(f"{folder}/ply/{number:04d}.ply")
a, b, c = (ply["x"][ply["faces"][:, k]] for k in range(3))
volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
assert volume > 0 and len(ply["faces"]) > 200
for kind, reader in (("vtp", vtkXMLPolyDataReader()), ("ply", vtkPLYReader()), ("obj", vtkOBJReader())):
    mesh = read(reader, kind)
    corners = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    assert (corners == ply["faces"]).all(), kind
    edges = vtkFeatureEdges()
    edges.SetInputData(mesh)
    edges.BoundaryEdgesOn()
    edges.NonManifoldEdgesOn()
    edges.FeatureEdgesOff()
    edges.ManifoldEdgesOff()
    edges.Update()
    assert edges.GetOutput().GetNumberOfCells() == 0, f"{kind} has holes"
    triangles, mass = vtkTriangleFilter(), vtkMassProperties()
    triangles.SetInputData(mesh)
    triangles.PassVertsOff()
    mass.SetInputConnection(triangles.GetOutputPort())
    mass.Update()
    assert abs(mass.GetVolume() / volume - 1) < 1e-3, (kind, mass.GetVolume(), volume)
    if kind == "vtp":
        normals = vtk_to_numpy(mesh.GetPointData().GetNormals())
        assert normals.tobytes() == np.ascontiguousarray(ply["normal"]).tobytes()
        found = vtk_to_numpy(mesh.GetPointData().GetArray("J_P"))
        assert found.tobytes() == np.ascontiguousarray(ply["J_P"]).tobytes()
print("same")
