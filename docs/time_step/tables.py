#!/usr/bin/env python3
"""Prints the tables of docs/time_step.md from runs.tsv."""

import statistics
import sys
from collections import defaultdict
from pathlib import Path

COLUMNS = {"steps": 7, "spread": 13, "top": 14, "y": 12, "min J_P": 15, "torn": 18, "kinetic": 20, "elastic": 21}
DIGITS = {"steps": 0, "spread": 4, "top": 3, "y": 4}
DEFAULT = "5e-4"


def text(name, value):
    return f"{value:.{DIGITS.get(name, 3)}f}"


def read(file):
    runs = {}
    for line in Path(file).read_text().splitlines():
        cells = line.split("\t")
        runs[tuple(cells[:6])] = {name: float(cells[k]) for name, k in COLUMNS.items()}
    return runs


def group(runs, snow, n, transfer):
    """Rows of one snow, resolution and transfer, and how far its seeds are apart."""
    rows = sorted(
        (float(key[3]), run) for key, run in runs.items()
        if key[:3] == (snow, n, transfer) and key[4:] == (DEFAULT, "1"))
    for cfl, run in rows:
        value = f"**{cfl:g}**" if cfl == 0.5 else f"{cfl:g}"
        cells = " | ".join(text(name, run[name]) for name in COLUMNS)
        print(f"| {snow}, {transfer.upper()}, R/{n} | {value} | {cells} |")
    seeds = [run for key, run in runs.items() if key[:5] == (snow, n, transfer, "0.5", DEFAULT)]
    if len(seeds) > 1:
        cells = " | ".join(text(name, statistics.stdev(run[name] for run in seeds)) for name in COLUMNS)
        print(f"| between {len(seeds)} seeds | | {cells} |")


def table(runs, title, groups):
    print(f"{title}\n\n| snow, transfer, h | acoustic_cfl | " + " | ".join(COLUMNS) + " |")
    print("| --- " * (len(COLUMNS) + 2) + "|")
    for one in groups:
        group(runs, *one)
    print()


def reference_table(runs):
    found = defaultdict(dict)
    for (snow, n, transfer, cfl, reference, seed), run in runs.items():
        if (snow, n, transfer, seed) == ("dry", "5", "flip", "1"):
            found[reference][float(cfl)] = run
    limits = (0.25, 0.5, 1.0)
    names = [f"{what} at {cfl:g}" for what in ("spread", "kinetic") for cfl in limits]
    print("| flip_reference_dt | " + " | ".join(names) + " |\n" + "| --- " * 7 + "|")
    for reference in ("0", "2e-4", DEFAULT, "1e-3"):
        label = {"0": "0: per step", DEFAULT: f"**{DEFAULT}**"}.get(reference, reference)
        spread = [f"{found[reference][cfl]['spread']:.4f}" for cfl in limits]
        kinetic = [f"{found[reference][cfl]['kinetic']:.3g}" for cfl in limits]
        print(f"| {label} | " + " | ".join(spread + kinetic) + " |")


def main():
    runs = read(sys.argv[1])
    coarse = [("dry", "5", "flip"), ("paper", "5", "flip")]
    fine = [(snow, n, "flip") for n in ("8", "12") for snow in ("dry", "paper")]
    mls = [(snow, n, "mls") for n in ("5", "8") for snow in ("dry", "paper")]
    table(runs, "FLIP at R/5:", coarse)
    table(runs, "Finer grids, FLIP:", fine)
    table(runs, "MLS:", mls)
    reference_table(runs)


main()
