#!/usr/bin/env python3
"""A robot picks five hidden targets with real runs instead of an emulator, by neve pick itself.

    docs/pick/real_targets.py NEVE SCENE FOLDER

The robot clicks the tile whose spread, height and mean J_P are nearest to those of the target, and is
content when all three are within 5 %.
"""
import json
import math
import pathlib
import random
import subprocess
import sys

AXES = {
    "material.snow.youngs_modulus": (2e4, 1e6),
    "material.snow.hardening": (2, 20),
    "material.snow.critical_compression": (5e-3, 8e-2),
    "material.snow.critical_stretch": (1e-3, 3e-2),
}
METRICS = ["spread", "height", "mean_J_P"]
COMMON = ["--coarsen", "2", "--frames", "24-24", "--size", "160x90", "-q"]
MOST_ROUNDS = 10


def logs_of(run):
    last = json.loads((run / "run.json").read_text())["frames"][-1]
    return [math.log(last[name]) for name in METRICS]


def play(neve, scene, folder, wanted, seed, common=COMMON):
    """Rounds until the robot is content, or None, and the worst error of the last click."""
    clicks = []
    for count in range(1, MOST_ROUNDS + 1):
        # The round is made with any click; then the right one takes its place.
        listed = folder.with_suffix(".clicks")
        listed.write_text("\n".join(map(str, clicks + [1])) + "\n")
        axes = [part for axis, ends in AXES.items() for part in ("-p", f"{axis}={ends[0]},{ends[1]}")]
        subprocess.run([neve, "pick", scene, *axes, *common, "--seed", str(seed), "--rounds", "99",
                        "--clicks", listed, "--out", folder], check=True, stdin=subprocess.DEVNULL,
                       stdout=subprocess.DEVNULL)
        runs = json.loads((folder / "manifest.json").read_text())["runs"]
        off = []
        for run in runs:
            try:
                own = logs_of(folder / "runs" / run["folder"])
            except (OSError, IndexError, ValueError):
                own = [99] * len(METRICS)  # a run that diverged
            off.append([abs(a - b) for a, b in zip(own, wanted)])
        best = min(range(len(off)), key=lambda k: sum(x * x for x in off[k]))
        clicks.append(best + 1)
        saved = folder / "clicks.txt"
        lines = saved.read_text().splitlines()
        saved.write_text("\n".join(lines[:-1] + [str(best + 1)]) + "\n")
        if max(off[best]) <= math.log(1.05):
            return count, math.expm1(max(off[best]))
    return None, math.expm1(max(off[best]))


def main():
    neve, scene, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    chance = random.Random(2013)
    for target in range(1, 6):
        values = {axis: low * (high / low) ** chance.random() for axis, (low, high) in AXES.items()}
        sets = [part for axis, x in values.items() for part in ("--set", f"{axis}={x:.6g}")]
        out = folder / f"target_{target}"
        subprocess.run([neve, "render", scene, *sets, *COMMON, "--no-movie", "--out", out], check=True)
        rounds, error = play(neve, scene, folder / f"pick_{target}", logs_of(out), target)
        print(f"target {target}: {rounds or 'not found'}{' rounds' if rounds else ''}, "
              f"worst error {100 * error:.1f} %", flush=True)


if __name__ == "__main__":
    main()
