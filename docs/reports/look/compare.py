"""Draws states of the shipped scenes in four ways with one camera each: as snow and as particles by neve,
as spheres and as a surface by VTK with its default light. For each state the four pictures lie side by
side in one file, shuffled and without names; a file apart says which is which.

    compare.py OUT [--neve PROGRAM] [--states NAME,NAME] [--size 480x300] [--coarsen N] [--seed N]

Needs numpy, VTK (python3-vtk9) and Xvfb. Writes OUT/sheets/<state>.jpg, OUT/key.json and, for each state,
OUT/<state>/<way>.png. Both programs draw the state that neve exports; the surface is the exported mesh.
"""

import argparse
import json
import os
import random
import re
import subprocess
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[3] / "tests/python"))
from readers import read_ply  # noqa: E402

ROOT = Path(__file__).parents[3]
WAYS = ("neve_snow", "neve_particles", "vtk_points", "vtk_surface")


@dataclass
class State:
    scene: str
    frame: int
    eye: tuple
    target: tuple
    fov: float = 30
    coarsen: float = 1  # of scenes that take minutes


STATES = {
    "drop": State("snowball_drop", 5, (0.62, 0.40, 0.95), (0.05, 0.10, 0)),
    "collision": State("two_snowballs", 7, (0.92, 0.62, 1.12), (0.22, 0.25, 0)),
    "castle": State("castle_hit", 11, (0.95, 0.62, 1.25), (0.10, 0.25, 0), 30, 1.5),
    "plough": State("snowplough", 24, (1.9, 0.9, 1.75), (0.45, 0.05, 0.05), 27, 2),
    "boot": State("boot_print", 33, (0.50, 0.52, 0.62), (0.02, 0.05, 0.02)),
    "rabbit": State("mesh_body", 6, (0.64, 0.46, 1.05), (0.03, 0.13, 0)),
    "slope": State("slope_slide", 14, (0.45, 0.62, 1.05), (0.02, 0.10, 0)),
    "avalanche": State("avalanche_emitter", 34, (1.7, 1.3, 2.1), (0.05, 0.38, 0.05), 30, 1.5),
    "wedge": State("snowball_wedge", 14, (0.62, 0.7, 1.9), (0.02, 0.40, 0), 27),
    "snowman": State("snowman_hit", 16, (-0.55, 0.75, 2.1), (0.02, 0.42, 0), 28, 1.5),
}


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stderr}")


def draw_with_neve(state, options, folder):
    """Both pictures of neve, and the state as arrays for VTK. A run that is there is used again."""
    width, height = options.size
    views = {"snow": "neve_snow", "particles": "neve_particles"}
    bare = ["ground", "colliders"]
    sets = [f"camera={{eye={list(state.eye)}, target={list(state.target)}, fov={state.fov}}}"]
    for view in views:
        sets.append(f"view.{view}.layers={json.dumps(bare + [view])}")
    frames, run_folder = f"{state.frame}-{state.frame}", folder / "run"
    if not (run_folder / "run.json").exists():
        run(options.neve, "render", ROOT / f"scenes/{state.scene}.toml", "--out", run_folder, "--no-movie",
            "--quiet", "--frames", frames, "--checkpoint-every", state.frame, "--view", "particles",
            "--coarsen", options.coarsen or state.coarsen, "--size", "64x40")
    # Just before the state: changes of a camera need a moment at which they are made.
    fps = tomllib.loads(json.loads((run_folder / "run.json").read_text())["scene"]).get("fps", 24)
    for view, way in views.items():
        run(options.neve, "render", run_folder, "--from", f"{state.frame / fps - 1e-6:.8f}s", "--frames", frames,
            "--out", folder / view, "--no-movie", "--quiet", "--checkpoint-every", 0, "--quality", "final",
            "--shutter", 0, "--size", f"{width}x{height}", "--view", view,
            *(word for change in sets if ".layers" not in change or f".{view}." in change
              for word in ("--set", change)))
        (folder / view / view / f"{state.frame:04d}.png").replace(folder / f"{way}.png")
    export = (options.neve, "export", run_folder, "--frames", frames, "--quiet")
    run(*export, "--format", "npz,usda", "--attributes", "x,radius", "--out", folder / "export")
    run(*export, "--format", "ply", "--surface", "--attributes", "x", "--out", folder / "surface")


def numbers(text):
    return np.array(re.findall(r"[-+.\deE]+", text), float)


def value_at(block, name, frame):
    """The value of a property, or its sample nearest to a frame."""
    if fixed := re.search(name + r" = \((.*?)\)", block):
        return numbers(fixed[1])
    samples = re.search(name + r"\.timeSamples = \{(.*?)\n            }", block, re.DOTALL)[1]
    times = {float(time): numbers(value) for time, value in re.findall(r"([-.\d]+): \((.*?)\)", samples)}
    return times[min(times, key=lambda time: abs(time - frame))]


def colliders_of(stage, frame):
    """Places and triangles of the colliders of a stage at a frame."""
    text = stage.read_text(encoding="utf-8")
    for block in re.findall(r"^        def Mesh .*?^        }", text, re.MULTILINE | re.DOTALL):
        corners = numbers(re.search(r"faceVertexIndices = \[(.*?)\]", block)[1]).astype(int).reshape(-1, 3)
        points = numbers(re.search(r"points = \[(.*?)\]$", block, re.MULTILINE)[1]).reshape(-1, 3)
        place, (w, *axis) = (value_at(block, f"xformOp:{name}", frame) for name in ("translate", "orient"))
        across = np.cross(axis, points)
        yield points + 2 * (w * across + np.cross(axis, across)) + place, corners


def poly_data(points, corners=None, normals=None):
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData

    data, places, cells = vtkPolyData(), vtkPoints(), vtkCellArray()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(points, "f4"), deep=True))
    data.SetPoints(places)
    size = 1 if corners is None else 3
    of = np.arange(len(points)).reshape(-1, 1) if corners is None else corners
    rows = np.c_[np.full(len(of), size), of].astype("i8").ravel()
    cells.SetCells(len(of), numpy_to_vtkIdTypeArray(rows, deep=True))
    (data.SetVerts if corners is None else data.SetPolys)(cells)
    if normals is not None:
        data.GetPointData().SetNormals(numpy_to_vtk(np.ascontiguousarray(normals, "f4"), deep=True))
    return data


def actor_of(data, color, radius=None):
    from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper
    from vtkmodules.vtkRenderingOpenGL2 import vtkOpenGLSphereMapper

    mapper = vtkPolyDataMapper() if radius is None else vtkOpenGLSphereMapper()
    if radius is not None:
        mapper.SetRadius(radius)
    mapper.SetInputData(data)
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(color)
    return actor


def draw_with_vtk(state, options, folder):
    particles = np.load(folder / f"export/npz/{state.frame:04d}.npz")
    mesh = read_ply(folder / f"surface/ply/{state.frame:04d}.ply")
    radius = float(np.median(particles["radius"]))
    white = (1, 1, 1)
    is_spray = np.ones(len(mesh["x"]), bool)
    is_spray[mesh["faces"].ravel()] = False
    snow = {"vtk_points": [actor_of(poly_data(particles["x"]), white, radius)],
            "vtk_surface": [actor_of(poly_data(mesh["x"], mesh["faces"], mesh["normal"]), white)]}
    if is_spray.any():
        snow["vtk_surface"].append(actor_of(poly_data(mesh["x"][is_spray]), white, radius))
    solids = [actor_of(poly_data(points, corners), (0.42, 0.44, 0.47))
              for points, corners in colliders_of(folder / "export/usda.usda", state.frame)]
    for way, actors in snow.items():
        write_vtk_picture(actors + solids, state, options.size, folder / f"{way}.png")


def write_vtk_picture(actors, state, size, path):
    from vtkmodules.vtkIOImage import vtkPNGWriter
    from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter

    renderer, window = vtkRenderer(), vtkRenderWindow()
    for actor in actors:
        renderer.AddActor(actor)
    # The background of neve, so that it does not give a picture away.
    renderer.GradientBackgroundOn()
    renderer.SetBackground(0.42, 0.44, 0.48)
    renderer.SetBackground2(0.24, 0.26, 0.30)
    camera = renderer.GetActiveCamera()
    camera.SetPosition(state.eye)
    camera.SetFocalPoint(state.target)
    camera.SetViewUp(0, 1, 0)
    camera.SetViewAngle(state.fov)
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(4)
    window.SetSize(*size)
    window.AddRenderer(renderer)
    renderer.ResetCameraClippingRange()
    window.Render()
    image, writer = vtkWindowToImageFilter(), vtkPNGWriter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    writer.SetInputConnection(image.GetOutputPort())
    writer.SetFileName(str(path))
    writer.Write()


def read_png(path):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOImage import vtkPNGReader

    reader = vtkPNGReader()
    reader.SetFileName(str(path))
    reader.Update()
    width, height, _ = reader.GetOutput().GetDimensions()
    return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars()).reshape(height, width, -1)[::-1, :, :3]


def write_jpeg(rows, path):
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkIOImage import vtkJPEGWriter

    height, width, _ = rows.shape
    image, writer = vtkImageData(), vtkJPEGWriter()
    image.SetDimensions(width, height, 1)
    image.GetPointData().SetScalars(numpy_to_vtk(np.ascontiguousarray(rows[::-1]).reshape(-1, 3), deep=True))
    writer.SetInputData(image)
    writer.SetQuality(88)
    writer.SetFileName(str(path))
    writer.Write()


# Rows of five bits each.
LETTERS = {"A": (14, 17, 17, 31, 17, 17, 17), "B": (30, 17, 17, 30, 17, 17, 30),
           "C": (14, 17, 16, 16, 16, 17, 14), "D": (28, 18, 17, 17, 17, 18, 28)}


def with_letter(picture, letter):
    out = picture.copy()
    bits = np.array([[row >> (4 - column) & 1 for column in range(5)] for row in LETTERS[letter]], bool)
    big = np.pad(bits, 1).repeat(2, 0).repeat(2, 1)
    out[4:4 + big.shape[0], 4:4 + big.shape[1]] = np.where(big, 235, 40)[..., None]
    return out


def lay_side_by_side(name, options, key):
    """The order depends on the seed and the name alone."""
    ways = list(WAYS)
    random.Random(f"{options.seed} {name}").shuffle(ways)
    key[name] = dict(zip(LETTERS, ways))
    pictures = [with_letter(read_png(options.out / name / f"{way}.png"), letter)
                for letter, way in key[name].items()]
    write_jpeg(np.concatenate(pictures, 1), options.out / f"sheets/{name}.jpg")


def start_display():
    """VTK of Debian draws only where there is a display."""
    ours, theirs = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(theirs), "-screen", "0", "1280x1024x24", "-noreset", "-nolisten", "tcp"],
        pass_fds=[theirs], stderr=subprocess.DEVNULL)
    os.close(theirs)
    with os.fdopen(ours) as answer:
        os.environ["DISPLAY"] = ":" + answer.readline().strip()
    return server


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("out", type=Path)
    words.add_argument("--neve", type=Path, default=ROOT / "build/release/neve")
    words.add_argument("--states", type=lambda text: text.split(","), default=list(STATES))
    words.add_argument("--size", type=lambda text: tuple(map(int, text.split("x"))), default=(480, 300))
    words.add_argument("--coarsen", type=float, default=0, help="of all states, for a quick look")
    words.add_argument("--seed", type=int, default=24)
    options = words.parse_args()
    options.out = options.out.resolve()
    (options.out / "sheets").mkdir(parents=True, exist_ok=True)
    key = {}
    for name in options.states:
        folder = options.out / name
        folder.mkdir(exist_ok=True)
        if not all((folder / f"{way}.png").exists() for way in WAYS):
            draw_with_neve(STATES[name], options, folder)
            server = start_display()
            try:
                draw_with_vtk(STATES[name], options, folder)
            finally:
                server.terminate()
                server.wait()
        lay_side_by_side(name, options, key)
        print(name, flush=True)
    (options.out / "key.json").write_text(json.dumps(key, indent=2) + "\n")


main()
