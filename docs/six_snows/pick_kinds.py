#!/usr/bin/env python3
"""A robot picks the paper's six kinds of snow on the wedge, by neve pick itself.

    docs/six_snows/pick_kinds.py NEVE SCENE FOLDER [KIND ...]

The robot of docs/pick/real_targets.py clicks the tile that is nearest to a run of the kind, and is content
when spread, height and mean J_P are within 5 %.
"""
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "pick"))
import real_targets

KINDS = ["paper", "lower_hardening", "lower_youngs_modulus", "lower_critical_compression", "lower_critical_stretch",
         "lower_compression_and_stretch"]
COMMON = ["--coarsen", "1.5", "--frames", "24-24", "--size", "160x90", "-q"]


def main():
    neve, scene, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    for kind in sys.argv[4:] or KINDS:
        out = folder / kind
        subprocess.run([neve, "render", scene, "--set", f"material.snow.preset={kind}", *COMMON,
                        "--no-movie", "--out", out], check=True)
        rounds, error = real_targets.play(neve, scene, folder / f"pick_{kind}",
                                          real_targets.logs_of(out), 1 + KINDS.index(kind), COMMON)
        picked = (folder / f"pick_{kind}" / "picked.toml").read_text()
        found = {line.split("=")[0].strip(): line.split("=")[1].strip() for line in picked.splitlines()
                 if "=" in line and any(axis.endswith("." + line.split("=")[0].strip())
                                        for axis in real_targets.AXES)}
        print(f"{kind}: {rounds or 'not found'}{' rounds' if rounds else ''}, "
              f"worst error {100 * error:.1f} %, {found}", flush=True)


main()
