#!/usr/bin/env python3
"""A robot picks the paper's six kinds of snow on the wedge, by neve pick itself.

    docs/reports/six_snows/pick_kinds.py NEVE SCENE FOLDER [KIND ...]

The robot of docs/pick/real_targets.py clicks the tile that is nearest to a run of the kind, and is content
when spread, height and mean J_P are within 5 %.
"""
import csv
import math
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "pick"))
import real_targets

KINDS = ["paper", "lower_hardening", "lower_youngs_modulus", "lower_critical_compression", "lower_critical_stretch",
         "lower_compression_and_stretch"]
COMMON = ["--coarsen", "1.5", "--frames", "24-24", "--size", "160x90", "-q"]
SEEDS = [1, 2, 3]  # of the particles; how far the last two are from the first is chance


def end_of(neve, scene, out, kind, seed):
    subprocess.run([neve, "render", scene, "--set", f"material.snow.preset={kind}", "--set", f"seed={seed}",
                    *COMMON, "--no-movie", "--out", out], check=True)
    return real_targets.logs_of(out)


def main():
    neve, scene, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    for kind in sys.argv[4:] or KINDS:
        wanted, *others = [end_of(neve, scene, folder / f"{kind}_{seed}", kind, seed) for seed in SEEDS]
        chance = max(abs(a - b) for other in others for a, b in zip(other, wanted))
        rounds, error = real_targets.play(neve, scene, folder / f"pick_{kind}",
                                          wanted, 1 + KINDS.index(kind), COMMON)
        chosen = int((folder / f"pick_{kind}" / "clicks.txt").read_text().split()[-1])
        with open(folder / f"pick_{kind}" / "data.csv") as table:
            row = list(csv.DictReader(table))[chosen - 1]
        found = {axis.split(".")[-1]: row[axis.replace(".", "_")] for axis in real_targets.AXES}
        print(f"{kind}: {rounds or 'not found'}{' rounds' if rounds else ''}, "
              f"worst error {100 * error:.1f} %, {found}; with another seed {100 * math.expm1(chance):.0f} %",
              flush=True)


main()
