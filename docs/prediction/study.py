#!/usr/bin/env python3
"""Coarse copies against full runs, for docs/prediction.md: a line in results.csv for each run. Runs that are there are
not made again, so that it can be stopped and started.
  docs/prediction/study.py NEVE GROUP ... [--jobs N]     GROUP: of the .toml files here, in this order
"""

import argparse
import concurrent.futures
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import tomllib

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from results import Results, text  # noqa: E402

here = pathlib.Path(__file__).resolve().parent
root = here.parent.parent
measured = ["broken", "largest", "spread", "height", "mean_J_P", "fragments", "force", "steps", "seconds"]
columns = ["group", "case", "seed", "coarsen", "stretch", "compression", "cohesion", "pressure", "status"] + measured
# Powers of the factor of --coarsen by which a threshold is divided: of critical_stretch, critical_compression,
# cohesion and consolidation_pressure.
untouched = (0, 0, 0, 0)
addresses = ["critical_stretch", "critical_compression", "cohesion", "consolidation_pressure"]
results = Results(here / "results.csv", columns, 8)


def force_of(frame):
    return max((sum(x * x for x in on["force"]) ** 0.5 for on in frame["forces"]), default=0)


def run(neve, case, seed, coarsen, words):
    """The run.json of a run, or nothing where it diverged."""
    with tempfile.TemporaryDirectory() as folder:
        command = [neve, "render", str(root / case["scene"]), "--out", folder + "/out", "--size", "32x32", "--view",
                   "particles", "--no-movie", "--threads", "1", "--quiet", "--checkpoint-every", "0", "--frames",
                   f"0-{case['last']}", "--set", f"seed={seed}"]
        if coarsen > 1:
            command += ["--coarsen", f"{coarsen:g}"]
        for word in words:
            command += ["--set", word]
        ended = subprocess.run(command, capture_output=True, text=True)
        made = pathlib.Path(folder, "out", "run.json")
        if not made.exists():
            raise SystemExit(" ".join(command) + "\n" + ended.stderr)
        return json.loads(made.read_text())


def row_of(made, key):
    row = dict(zip(columns, key))
    row["status"] = made["status"]
    if made["status"] != "ok":
        return row
    first, last = made["frames"][0], made["frames"][-1]
    largest = last["largest_fragment"] / first["largest_fragment"]
    return row | {"largest": largest, "broken": int(largest < 0.99), "spread": last["spread"], "height": last["height"],
                  "mean_J_P": last["mean_J_P"], "fragments": last["fragments"],
                  "force": max(force_of(frame) for frame in made["frames"]),
                  "steps": sum(frame["steps"] or 0 for frame in made["frames"]),
                  "seconds": sum(frame["seconds_sim"] for frame in made["frames"])}


def settings_of(made, powers, coarsen):
    """The thresholds of a full run's materials, divided, without the rule of --coarsen; "ADDRESS=VALUE"."""
    scene = tomllib.loads(made["scene"])
    words = [f"solver.threshold_cell={scene['solver']['cell_size'] * coarsen:.12g}"]
    for name, material in scene["material"].items():
        for key, power in zip(addresses, powers):
            if power and key in material:
                words.append(f"material.{name}.{key}={material[key] / coarsen ** power:.8g}")
    return words


def work(neve, plan_words, group, case, seed, copies, known):
    base = plan_words + case.get("set", [])
    keys = [tuple(map(text, (group, case["name"], seed, float(c), *map(float, powers)))) for c, powers in copies]
    if all(key in known for key in keys):
        return
    full = run(neve, case if keys[0] not in known else case | {"last": 0}, seed, 1, base)
    if keys[0] not in known:
        results.write(row_of(full, keys[0]))
    for key, (coarsen, powers) in zip(keys[1:], copies[1:]):
        if key not in known:
            words = base + settings_of(full, powers, coarsen)
            results.write(row_of(run(neve, case, seed, coarsen, words), key))
    for more in case.get("more_seeds", []):  # of the coarsest copy
        coarsen, powers = copies[-1]
        key = tuple(map(text, (group, case["name"], more, float(coarsen), *map(float, powers))))
        if key not in known:
            results.write(row_of(run(neve, case, more, coarsen, base + settings_of(full, powers, coarsen)), key))


def main():
    words = argparse.ArgumentParser()
    words.add_argument("neve")
    words.add_argument("groups", nargs="+")
    words.add_argument("--jobs", type=int, default=1)
    options = words.parse_args()
    neve = str(pathlib.Path(options.neve).resolve())
    shutil.which(neve) or words.error(f"{neve} is no program")
    groups = {}
    for file in sorted(here.glob("*.toml")):
        groups |= tomllib.loads(file.read_text())
    known = results.known()
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        jobs = []
        for group in options.groups:
            plan = groups[group]
            copies = [(1, untouched)] + [(c, tuple(p)) for c in plan["coarsen"] for p in plan["powers"]]
            source = groups[plan.get("cases_of", group)]
            for case in source["case"]:
                for seed in case.get("seeds", plan.get("seeds", [1])):
                    wanted = source.get("all", {}) | {"more_seeds": plan.get("more_seeds", [])} | case
                    jobs.append(pool.submit(work, neve, plan.get("set", []), group, wanted, seed, copies, known))
                for seed in plan.get("full_seeds", []):  # without copies
                    wanted = source.get("all", {}) | case
                    jobs.append(pool.submit(work, neve, plan.get("set", []), group, wanted, seed, copies[:1], known))
        for job in jobs:
            job.result()


main()
