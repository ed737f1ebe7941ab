"""Opens the stages that neve export wrote with Pixar's USD and compares them with the numpy archives
and the PLY surface of the same moments.

    check_usd.py POINTS SURFACE     folders with npz and usda; ply and usda
"""

import glob
import sys

import numpy as np
from pxr import Usd, UsdGeom, UsdLux

from readers import read_ply

points_folder, surface_folder = sys.argv[1:]


def single(values):
    return np.asarray(values).astype("f4")


def same(found, wanted, what):
    found = np.array(found)
    assert found.shape == wanted.shape and (found == wanted).all(), (what, found.shape, wanted.shape)


stage = Usd.Stage.Open(f"{points_folder}/usda.usda")
archives = [np.load(path) for path in sorted(glob.glob(f"{points_folder}/npz/*.npz"))]
assert len(archives) > 2
scale = float(archives[0]["scale"])
assert UsdGeom.GetStageUpAxis(stage) == str(archives[0]["up"]).upper()
assert abs(UsdGeom.GetStageMetersPerUnit(stage) - 1 / scale) < 1e-9
assert stage.GetTimeCodesPerSecond() == archives[0]["fps"]
snow = UsdGeom.Points(stage.GetPrimAtPath("/neve/snow"))
assert snow
primvars = UsdGeom.PrimvarsAPI(snow)
for archive in archives:
    time = Usd.TimeCode(float(archive["frame"]))
    same(snow.GetPointsAttr().Get(time), single(archive["x"]), "points")
    same(snow.GetVelocitiesAttr().Get(time), single(archive["v"]), "velocities")
    same(snow.GetIdsAttr().Get(time), archive["id"], "ids")
    same(snow.GetWidthsAttr().Get(time), single(2 * archive["radius"]), "widths")
    masses = snow.GetPrim().GetAttribute("physics:masses").Get(time)
    same(masses, single(archive["m"]), "masses")
    for name in ("J_P", "density", "m", "V0"):
        found = primvars.GetPrimvar(name).Get(time)
        assert np.array(found).dtype == archive[name].dtype, name
        same(found, archive[name], name)

# Everything else that the stage has.
start, end = Usd.TimeCode(stage.GetStartTimeCode()), Usd.TimeCode(stage.GetEndTimeCode())
assert start.GetValue() == archives[0]["frame"] and end.GetValue() == archives[-1]["frame"]
meshes = [UsdGeom.Mesh(prim) for prim in stage.GetPrimAtPath("/neve/colliders").GetChildren()]
assert meshes and all(meshes)
for mesh in meshes:
    corners = len(mesh.GetFaceVertexIndicesAttr().Get())
    assert UsdGeom.Mesh.ValidateTopology(
        mesh.GetFaceVertexIndicesAttr().Get(), mesh.GetFaceVertexCountsAttr().Get(),
        len(mesh.GetPointsAttr().Get(end))), mesh.GetPath()
    assert corners == 3 * len(mesh.GetFaceVertexCountsAttr().Get())
    assert mesh.ComputeLocalToWorldTransform(end).GetDeterminant() > 0
# Things that turn keep their size and follow their turn between frames.
blade = UsdGeom.Xformable(stage.GetPrimAtPath("/neve/colliders/blade"))
for quarter in range(4 * int(start.GetValue()), 4 * int(end.GetValue()) + 1):
    pose = np.array(blade.ComputeLocalToWorldTransform(quarter / 4))
    assert abs(np.linalg.det(pose) - 1) < 1e-9, (quarter, pose)
    angle = 38 * quarter / 4 / float(archives[0]["fps"])
    # About z of the scene, which is -y of these files.
    assert abs(pose[0, 0] - np.cos(angle)) < 1e-3 and abs(pose[0, 2] - np.sin(angle)) < 1e-3, (quarter, pose)
sheet = UsdGeom.Mesh(stage.GetPrimAtPath("/neve/colliders/sheet")).GetPointsAttr()
assert len(sheet.GetTimeSamples()) == len(archives)
# One edge rises by 0.1 m a frame. Points are those of the shape, y is up; its transform turns them.
turn = np.array(UsdGeom.Mesh(stage.GetPrimAtPath("/neve/colliders/sheet"))
                .ComputeLocalToWorldTransform(end))[:3, :3]
rise = (np.array(sheet.Get(end)) - np.array(sheet.Get(start))) @ turn
assert abs(rise[:, 2].max() - 0.1 * scale * (end.GetValue() - start.GetValue())) < 1e-4 * scale, rise
assert abs(rise[:, :2]).max() < 1e-4 * scale, rise
camera = UsdGeom.Camera(stage.GetPrimAtPath("/neve/view/camera"))
assert camera and camera.GetCamera(end).focalLength > 0
near, far = camera.GetClippingRangeAttr().Get()
to_camera = np.linalg.inv(np.array(camera.ComputeLocalToWorldTransform(end)))
depth = -(np.c_[archives[-1]["x"], np.ones(len(archives[-1]["x"]))] @ to_camera)[:, 2]
assert 0 < near < depth.min() and depth.max() < far, (near, far, depth.min(), depth.max())
assert UsdLux.DistantLight(stage.GetPrimAtPath("/neve/sun"))
box = UsdGeom.BBoxCache(end, [UsdGeom.Tokens.default_]).ComputeWorldBound(snow.GetPrim())
low, high = np.array(box.ComputeAlignedRange().GetMin()), np.array(box.ComputeAlignedRange().GetMax())
assert (low <= archives[-1]["x"].min(axis=0)).all() and (high >= archives[-1]["x"].max(axis=0)).all()

# A surface: the mesh and the spray of each moment.
stage = Usd.Stage.Open(f"{surface_folder}/usda.usda")
paths = sorted(glob.glob(f"{surface_folder}/ply/*.ply"))
mesh = UsdGeom.Mesh(stage.GetPrimAtPath("/neve/snow"))
spray = UsdGeom.Points(stage.GetPrimAtPath("/neve/spray"))
for path in paths:
    time = Usd.TimeCode(float(path[-8:-4]))
    ply = read_ply(path)
    places, faces = single(ply["x"]), ply["faces"]
    vertices = faces.max() + 1
    same(mesh.GetPointsAttr().Get(time), places[:vertices], "vertices")
    same(mesh.GetNormalsAttr().Get(time), ply["normal"][:vertices], "normals")
    same(mesh.GetFaceVertexIndicesAttr().Get(time), faces.ravel(), "corners")
    assert set(mesh.GetFaceVertexCountsAttr().Get(time)) == {3}
    same(np.array(spray.GetPointsAttr().Get(time)).reshape(-1, 3), places[vertices:], "spray")
    assert UsdGeom.Mesh.ValidateTopology(
        mesh.GetFaceVertexIndicesAttr().Get(time), mesh.GetFaceVertexCountsAttr().Get(time),
        int(vertices))
assert mesh.GetSubdivisionSchemeAttr().Get() == "none"
print("same")
