"""python/neve.py on a small scene. NEVE names the program.

    check_module.py FOLDER_OF_neve.py
"""

import os
import sys
import warnings

import numpy as np

sys.path.insert(0, sys.argv[1])
import neve

# A run: its frames as arrays.
# Of flip: other transfers count the energy of affine velocities as well.
run = neve.render("scene.toml", set={"body.ball.velocity": [0, -3, 0], "solver.transfer": "flip"},
                  flags=["--no-movie"])
assert run.status == "ok" and list(run.frames) == [0, 1, 2, 3, 4], run.status
assert run["max_speed"][0] == 3 and run["momentum"].shape == (5, 3)
assert np.isnan(run["dt_min"][0]) and run["dt_min"][1] > 0
assert np.isnan(run.force("floor")[0, 0]) and np.nanmin(run.force("floor")[:, 1]) < 0
assert neve.Run("out/scene").json == run.json

# Values that not all frames have, and views of which not all frames are drawn.
run.json["frames"][2]["dust"] = {"particles": 7}
run.json["frames"][0]["centre_of_mass"] = [None, None, None]
run.json["view_frames"] = {"smoke": [1, 3]}
assert run["dust"][2]["particles"] == 7 and np.isnan(run["dust"][0])
assert len(run["forces"][0]) == 0 and run["forces"][1][0]["collider"] == "floor"
assert np.isnan(run["centre_of_mass"][0, 1]) and run["centre_of_mass"].dtype == "f8"
assert run.picture(view="smoke").name == "0003.png" and run.picture().name == "0004.png"
run = neve.Run("out/scene")

# A collider that moves by itself.
moved = neve.render("scene.toml", out="out/moved", frames=(0, 2), flags=[
    "--no-movie", "--set", "collider.can={ shape = { sphere = { center = "
    "[0.5, 0.5, 0], radius = 0.1 } }, density = 900, velocity = [1, 0, 0] }"])
can = moved.body("can")
assert can["position"].shape == (3, 3) and list(can["position"][0]) == [0.5, 0.5, 0]
assert can["velocity"][2, 1] < -0.5 and can["centre_of_mass"][2, 0] > 0.55, can

# Words, lists and tables in lists are values, too.
looked = neve.render("scene.toml", out="out/looked", frames=(0, 0), flags=["--no-movie"], set={
    "view.particles.layers": ["ground", "particles"],
    "camera.keyframes": [{"time": 0, "eye": [0, 1, 3], "target": [0, 0, 0]},
                         {"time": 0.1, "eye": [1, 1, 3], "target": [0, 0, 0]}]})
assert "keyframes" in looked.json["scene"] and looked.status == "ok"

# States: of a run, and exports in every format that the module reads, are the same.
names = ["id", "x", "v", "m", "J_P", "F_E"]
state = run.state(3, attributes=names)
assert state.count == run["particles"][3] and state.time == run["time"][3] == 0.125
assert state["F_E"].shape == (state.count, 3, 3) and state["v"].dtype == "f4"
kinetic = 0.5 * (state["m"].astype("f8") * (state["v"].astype("f8") ** 2).sum(axis=1)).sum()
np.testing.assert_allclose(kinetic, run["kinetic_energy"][3], rtol=1e-5)
exports = neve.export(run, "states", formats=["npz", "ply", "csv"], frames=(2, 3), attributes=names)
assert set(exports) == {"npz", "ply", "csv"}
# Frames are one, or a range: others were dropped in silence.
for frames in ("2-3", (2, 3), [2, 3], range(2, 4), np.array([2, 3]), np.arange(2, 4)):
    assert neve._frames(frames) == "2-3", frames
assert neve._frames(3) == neve._frames(np.int64(3)) == "3-3" and neve._frames([0, 1, 2]) == "0-2"
for frames in ([0, 10, 20], range(0, 20, 10), np.array([0, 10, 20]), []):
    try:
        neve._frames(frames)
    except ValueError as error:
        assert "the first and the last" in str(error)
    else:
        raise AssertionError(frames)
assert neve._literal(np.bool_(True)) == "true"
for format, series in exports.items():
    assert len(series) == 2 and list(series.times) == [run["time"][2], 0.125]
    assert series[1].frame == 3 and (series[1].up, series[1].scale) == ("y", 1), format
    for name in names:
        read = series[1][name].astype(state[name].dtype)
        assert read.tobytes() == state[name].tobytes(), (format, name)
at = neve.export("scene.toml", "at", at=[0.01, 0.1])["npz"]
assert [round(s.time, 2) for s in at] == [0.01, 0.1] and at.numbers == [0, 1]
# A state says its frame and its axes, whatever its format.
for format, series in neve.export("scene.toml", "turned", formats=["npz", "ply", "csv"], at=[0.01],
                                  flags=["--up", "z", "--scale", "100"]).items():
    assert abs(series[0].frame - 24 * series[0].time) < 1e-9 and 0.2 < series[0].frame < 0.25, format
    assert (series.up, series.scale) == (series[0].up, series[0].scale) == ("z", 100), format
    assert not any(name.startswith("up_") for name in series[0]), format
alone = neve.read_ply("turned/ply/0000.ply")
assert (alone.up, alone.scale) == ("z", 100) and 0.2 < alone.frame < 0.25, alone.frame
assert neve.read_csv("turned/csv/0000.csv").up == "z"

# A table of one row.
path = os.path.join(os.getcwd(), "one.csv")
with open(path, "w") as file:
    file.write("id,x,y,z\n7,1,2,3\n")
one = neve.read_csv(path)
assert one.count == 1 and list(one["id"]) == [7], one

# A column whose name ends as those of a tensor do, alone.
with open("one.csv", "w") as file:
    file.write("id,x,y,z,tag_xx,rank_xy\n7,1,2,3,4,5\n")
one = neve.read_csv("one.csv")
assert list(one["tag_xx"]) == [4] and list(one["rank_xy"]) == [5], one
# A part of a file.
with open("states/ply/0003.ply", "rb") as file:
    whole = file.read()
with open("half.ply", "wb") as file:
    file.write(whole[:len(whole) // 2])

# What a notebook shows.
png = b"\x89PNG\r\n\x1a\n"
assert run._repr_png_() == run.picture().read_bytes() and run._repr_png_().startswith(png)
assert "<td>max_speed</td>" in run._repr_html_() and "data:image/png;base64," in run._repr_html_()
assert state._repr_png_().startswith(png) and "<th>attribute</th>" in state._repr_html_()
x = np.random.default_rng(1).random((500, 3)) * [1, 1, 0.2]  # wide and deep, and flat on the ground
turned = x[:, [0, 2, 1]]
assert (neve.State({"x": x}, up="z")._repr_png_()
        == neve.State({"x": turned}, up="y")._repr_png_() != neve.State({"x": x})._repr_png_())

# A sweep as a table.
sweep = neve.sweep("scene.toml", "s.cdb", {"material.snow.hardening": [5, 10]}, frames=(0, 2))
assert len(sweep) == 2 and list(sweep["material_snow_hardening"]) == [5, 10]
assert list(sweep["state"]) == ["ok", "ok"] and sweep["height"].dtype == float
assert sweep.run(1)["max_speed"].shape == (3,)
assert sweep._repr_png_().startswith(png) and "<th>run</th>" in sweep._repr_html_()
assert sweep.points is None
# With seeds: the folder of a run has not the number of the run any more.
sweep = neve.sweep("scene.toml", "s.cdb", {"material.snow.hardening": [5, 10]}, frames=(0, 2), seeds=2)
assert list(sweep["seed"]) == [1, 2, 1, 2] and list(sweep.points["ended"]) == [2, 2]
assert np.isclose(sweep.points["spread_mean"][1], sweep["spread"][2:].mean())
assert all(np.isclose(sweep.run(k)["spread"][-1], sweep["spread"][k]) for k in range(4))

# Words of a sweep are one value each, whatever is in them, and come back as they were given.
words = ["1_0", "a,b", "nan", "5", "1e3", "1.10", "1.1", "007", "", "x'y", "[z]1", "=1", " b"]
sweep_of_words = neve.sweep("scene.toml", "words.cdb", {"title": words}, frames=0)
assert list(sweep_of_words["title"]) == words, sweep_of_words["title"]
assert 'title = "a,b"' in sweep_of_words.run(1).json["scene"]
assert neve._axis("a", ['q"r,s']) == 'a="q\\u0022r,s"'
# What is in brackets or quotes is TOML already, and a table is a rule.
assert neve._axis("a", ["[0, 1]", [0, 2], "'b,c'"]) == "a=[0, 1],[0, 2],'b,c'"
assert neve._axis("a", {"linspace": [1, 2], "num": 3}) == "a={ linspace = [1, 2], num = 3 }"
assert np.isnan(neve._column(["-", "2", "nan"])[2]) and neve._column(["1_0", "-"])[1] == "-"

# Answers and mistakes of the program.
assert neve.check("scene.toml", coarsen=2)["particles"] < neve.check("scene.toml")["particles"]
assert any(p["address"] == "material.NAME.hardening" for p in neve.params())
assert neve.info("out/scene")["status"] == "ok"
assert len(neve.call("dump", "scene.toml", "--at", "0,0.1")) == 2
for mistake, code, part in (
    (lambda: neve.render("none.toml"), 3, "none.toml: No such file"),
    (lambda: neve.render("scene.toml", set={"material.snow.hardenin": 1}), 2, "hardening"),
    (lambda: run.state(3, attributes=["JP"]), 2, "J_P"),
    (lambda: neve.call("compare", "out/scene", "out/moved"), 9, "same False"),
    (lambda: neve.call("check", "scene.toml", "--set", "solver.time_step=fixed", "--set",
                       "solver.dt=0.01"), 9, "solver.dt: fixed steps of 0.01 s"),
    (lambda: neve.check("scene.toml", set={"collider.flor": {"friction": 1}}), 2, "flor"),
):
    try:
        mistake()
        raise AssertionError(part)
    except neve.NeveError as error:
        assert error.code == code and part in str(error), (error, error.code)
try:
    neve.export("scene.toml", "grid", formats=["vti"], frames=0)["vti"][0]
    raise AssertionError("read a grid")
except neve.NeveError as error:
    assert "npz" in str(error)
# A check that fails has its reasons, and what failed with an answer has that.
failed = neve.check("scene.toml", set={"solver": {"time_step": "fixed", "dt": 0.01}})
assert failed["findings"][0]["severity"] == "error" and failed["particles"] > 0, failed["findings"]
try:
    neve.call("compare", "out/scene", "out/moved")
except neve.NeveError as error:
    assert error.answer["same"] is False, error.answer
# Outputs go where those of the command line go: into NEVE_OUT, and of a run into the run.
os.environ["NEVE_OUT"] = "elsewhere"
assert str(neve.render("scene.toml", frames=0).folder) == "elsewhere/scene"
diverges = {"solver": {"time_step": "fixed", "dt": 0.02}, "body.ball.velocity": [0, -8, 0]}
with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    diverged = neve.render("scene.toml", set=diverges, flags=["--replace"])
assert diverged.status == "diverged" and str(diverged.folder) == "elsewhere/scene"
assert str(neve.render("out/moved", flags=["--no-movie"]).folder) == "out/moved"
del os.environ["NEVE_OUT"]
# A table with a shape adds the object that the scene lacks, and changes the one that it has.
wall = {"shape": {"plane": {"point": [-1, 0, 0], "normal": [1, 0, 0]}}, "friction": 0.3}
walled = neve.render("scene.toml", out="out/walled", frames=0, set={
    "collider": {"wall": wall, "floor": {"friction": 0.2}},
    "body.ball": {"shape": {"sphere": {"radius": 0.06}}}}).json["scene"]
assert 'name = "wall"' in walled and "center = [0, 0.12, 0], radius = 0.06" in walled, walled
assert "velocity = [0, -2, 0]" in walled and "friction = 0.2" in walled, walled
# A text is one format, and a file that is no list of points says what it is.
assert list(neve.export("scene.toml", "text", formats="npz", frames=0)) == ["npz"]
with open("ascii.ply", "w") as file:
    file.write("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n")
# Settings as tables, as texts, and objects that are removed; warnings of the program are warnings.
assert list(neve._settings({"solver": {"cfl": 0.2}, "seed": 3})) == [("solver.cfl", 0.2), ("seed", 3)]
assert neve._scene_flags(["seed=3"], None, None) == ["--set", "seed=3"]
assert neve._scene_flags({"collider.floor": None}, None, None) == ["--set", "collider.floor=none"]
with warnings.catch_warnings(record=True) as said:
    warnings.simplefilter("always")
    neve.export("scene.toml", "late", frames=9)
assert any("after the last frame" in str(one.message) for one in said), said
# Mistakes in Python.
for mistake, kind, part in (
    (lambda: run.force("flor"), KeyError, "floor"),
    (lambda: neve.Run("out/looked").force("flor"), KeyError, "floor"),
    (lambda: run["energy"], KeyError, "kinetic_energy"),
    (lambda: run.body("floor"), KeyError, "no collider of this run moves by itself"),
    (lambda: moved.body("floor"), KeyError, "can"),
    (lambda: run.state(99), ValueError, "0 to 4"),
    (lambda: run.state("last"), ValueError, "a number from 0 to 4"),
    (lambda: neve.check("scene.toml", coarsn=3), TypeError, "coarsn"),
    (lambda: neve.read_ply("scene.toml"), ValueError, "no PLY file"),
    (lambda: neve.read_ply("ascii.ply"), ValueError, "an ASCII PLY file"),
    (lambda: neve.read_ply("half.ply"), ValueError, "a part of a PLY file"),
    (lambda: neve.export("scene.toml", "mesh", formats="ply", frames=0, flags=["--surface"])
     ["ply"][0], ValueError, "without --surface"),
    (lambda: neve.check("scene.toml", set={"collider.floor": {}}), ValueError, "collider.floor"),
    (lambda: neve.sweep("scene.toml", "none", {"seed": "5,10"}), TypeError, "{'seed': [5, 10]}"),
    (lambda: neve.sweep("scene.toml", "none", {"solver.cfl": 0.2}), TypeError, "are a list"),
    (lambda: neve.render("scene.toml", fast=True), TypeError, 'flags=("--fast",)'),
    (lambda: neve.render("scene.toml", hardening=5), TypeError, "set="),
    (lambda: neve.render({"frames": 4}), TypeError, "a scene is a TOML file"),
    (lambda: neve.Run("s.cdb"), ValueError, "neve.Sweep('s.cdb')"),
    (lambda: sweep["spreed"], KeyError, "did you mean 'spread'"),
):
    try:
        mistake()
        raise AssertionError(part)
    except kind as error:
        assert part in str(error), error
os.environ["NEVE"] = "/none"
try:
    neve.params()
    raise AssertionError("no program")
except FileNotFoundError:
    pass
print("same")
