#!/usr/bin/env python3
"""Prints the table of runs that the robot of tests/app/pick_robot_test.cpp sees: places of the runs
in the unit cube, and their metrics. The runs are those of runs.toml:

    neve sweep docs/pick/runs.toml --coarsen 2 --size 160x90 --out RUNS
    docs/pick/table.py RUNS > docs/pick/runs.csv
"""
import json
import math
import pathlib
import sys

AXES = {
    "material.snow.youngs_modulus": lambda x: math.log(x / 2e4) / math.log(1e6 / 2e4),
    "material.snow.hardening": lambda x: (x - 2) / 18,
    "material.snow.critical_compression": lambda x: math.log(x / 5e-3) / math.log(8e-2 / 5e-3),
    "material.snow.critical_stretch": lambda x: math.log(x / 1e-3) / math.log(3e-2 / 1e-3),
}
METRICS = ["spread", "height", "mean_J_P"]

folder = pathlib.Path(sys.argv[1])
print(",".join(["u_" + axis.split(".")[-1] for axis in AXES] + METRICS))
for run in json.loads((folder / "manifest.json").read_text())["runs"]:
    made = folder / "runs" / run["folder"]
    if json.loads((made / "status.json").read_text())["state"] != "ok":
        continue
    last = json.loads((made / "run.json").read_text())["frames"][-1]
    settings = dict(run["settings"])
    places = [AXES[axis](float(settings[axis])) for axis in AXES]
    print(",".join(f"{x:.5g}" for x in places + [last[name] for name in METRICS]))
