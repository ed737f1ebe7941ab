#!/usr/bin/env python3
"""The paper's snow beside cam clay, for docs/models.md: presets in five scenes, a line in results.csv for each run. Runs
that are there are not made again, so that it can be stopped and started.
  docs/models/study.py NEVE [--jobs N] [--full]     --full: some runs at full resolution too
"""

import argparse
import concurrent.futures
import json
import pathlib
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from results import Results  # noqa: E402

here = pathlib.Path(__file__).resolve().parent
root = here.parent.parent
scenes = {"snowball_drop": 14, "snowball_wedge": 20, "two_snowballs": 14, "slope_slide": 34, "castle_hit": 16}
kinds = ["paper", "lower_youngs_modulus", "powder", "wet", "packed", "icy"]
# The others mean for cam clay what paper means.
presets = {"snow": kinds + ["lower_hardening", "lower_critical_compression", "lower_critical_stretch",
                            "lower_compression_and_stretch"], "cam_clay": kinds + ["quick"]}
columns = ["scene", "preset", "model", "lumps", "coarsen", "seed", "status", "spread", "height", "mean_J_P", "fragments",
           "largest", "powder", "crumbs", "frames", "steps", "work", "seconds"]
results = Results(here / "results.csv", columns, 6)


def text_of(scene, preset, model, lumps):
    """A shipped scene with all its snow of one kind."""
    text = (root / "scenes" / f"{scene}.toml").read_text()
    names = re.findall(r"^\[material\.(\w+)\]", text, re.M) or ["snow"]
    text = re.sub(r"^\[material\.\w+\][^\[]*(?=^\[)", "", text, flags=re.M)
    for name in names:
        text += f'\n[material.{name}]\npreset = "{preset}"\nmodel = "{model}"\n'
        if float(lumps):
            text += f"variation = {{ thresholds = {lumps}, size = 0.06 }}\n"
    return text


def row_of(made, key):
    row = dict(zip(columns, key)) | {"status": made["status"]}
    frames = [frame for frame in made["frames"] if frame["steps"] is not None]
    if made["status"] != "ok":
        return row
    last = frames[-1]
    return row | {name: last[name] for name in ("spread", "height", "mean_J_P", "fragments", "powder", "crumbs")} | {
        "largest": last["largest_fragment"], "frames": sum(frame["steps"] > 0 for frame in frames),
        "steps": sum(frame["steps"] for frame in frames), "seconds": sum(frame["seconds_sim"] for frame in frames),
        "work": sum(frame["steps"] * frame["particles"] for frame in frames)}


def run(neve, key):
    scene, preset, model, lumps, coarsen, seed = key
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder, "scene.toml")
        file.write_text(text_of(scene, preset, model, lumps))
        command = [neve, "render", str(file), "--out", folder + "/out", "--size", "32x32", "--view", "particles",
                   "--no-movie", "--threads", "1", "--quiet", "--checkpoint-every", "0", "--no-keep-states", "--frames",
                   f"0-{scenes[scene]}", "--set", f"seed={seed}"]
        if scene == "castle_hit":
            command += ["--set", "solver.cell_size=0.03"]
        if float(coarsen) > 1:
            command += ["--coarsen", coarsen]
        ended = subprocess.run(command, capture_output=True, text=True)
        made = pathlib.Path(folder, "out", "run.json")
        if not made.exists():
            raise SystemExit(" ".join(command) + "\n" + ended.stderr)
        return row_of(json.loads(made.read_text()), key)


def main():
    words = argparse.ArgumentParser()
    words.add_argument("neve")
    words.add_argument("--jobs", type=int, default=1)
    words.add_argument("--full", action="store_true")
    options = words.parse_args()
    neve = str(pathlib.Path(options.neve).resolve())
    def every(lumps, coarsen, seed, only=None):
        return [(scene, preset, model, lumps, coarsen, seed) for scene in scenes for model in presets
                for preset in presets[model] if not only or preset in only]

    keys = every("0", "2", "1") + every("0", "1.5", "1")
    if options.full:
        keys += every("0", "1", "1", ["paper", "powder", "packed", "quick"])
    keys += every("1.2", "1.5", "1") + every("0", "2", "2") + every("0", "2", "3")
    known = results.known()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for row in pool.map(lambda key: run(neve, key), [key for key in keys if key not in known]):
            results.write(row)


main()
