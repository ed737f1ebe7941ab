#!/usr/bin/env python3
"""Chooses the numbers of the intervals of `neve check --predict` (app/predict/predict.cpp) from the cases of drawn.toml, and
counts over those of counted.toml how many intervals hold and how many verdicts are right. From results.csv.
  docs/prediction/fit.py              prints both; docs/prediction/make writes the second into the page
"""

import collections
import csv
import pathlib
import statistics

here = pathlib.Path(__file__).resolve().parent
keys = {"spread": "spread", "height": "height", "mean_J_P": "mean_J_P", "largest_piece": "largest", "force": "force"}
wanted = 0.85  # of the cases that the numbers are chosen with; a little fewer hold of others
toward, per_difference, per_noise = 0.5, 0.5, 0.5  # as in predict.cpp
shares = {"spread": 0.07, "height": 0.09, "mean_J_P": 0.24, "largest_piece": 0.012, "force": 0.14}  # as in predict.cpp
whole, clearly_whole, clearly_broken, unpacked = 0.99, 0.996, 0.985, 1.05  # as in predict.cpp


class Case:
    def __init__(self, name, rows):
        self.name = name
        self.full = next(r for r in rows if r["coarsen"] == "1")
        self.fine = next(r for r in rows if r["coarsen"] == "1.5")
        self.coarse = [r for r in rows if r["coarsen"] == "2" and r["seed"] in "12"]

    def of(self, metric):
        key = keys[metric]
        return float(self.full[key]), float(self.fine[key]), [float(r[key]) for r in self.coarse]

    def estimate(self, metric, share):
        full, fine, coarse = self.of(metric)
        difference = fine - statistics.mean(coarse)
        expected = fine + toward * difference
        noise = (max(coarse) - min(coarse)) / 2
        return expected, per_difference * abs(difference) + per_noise * noise + share * abs(expected)

    def holds(self, metric, share):
        expected, half = self.estimate(metric, share)
        return abs(self.of(metric)[0] - expected) <= half * (1 + 1e-9)

    def verdict(self):
        pieces = [float(r["largest"]) for r in [self.fine] + self.coarse]
        if all(p < whole for p in pieces) and pieces[0] < clearly_broken:
            return "breaks"
        packed = [float(r["mean_J_P"]) for r in [self.fine] + self.coarse]
        if all(p > clearly_whole for p in pieces) and max(packed) < unpacked:
            return "holds"
        return "undecided"

    def truth(self):
        return "breaks" if float(self.full["largest"]) < whole else "holds"


def cases_of(group):
    rows = collections.defaultdict(list)
    for r in csv.DictReader(open(here / "results.csv")):
        if r["group"] == group and r["status"] == "ok":
            rows[r["case"]].append(r)
    return [Case(name, some) for name, some in rows.items()
            if {r["coarsen"] for r in some} == {"1", "1.5", "2"} and {"1", "2"} <= {r["seed"] for r in some}]


def share_for(cases, metric):
    """The smallest share of the value with which enough intervals hold."""
    needed = []
    for case in cases:
        expected, half = case.estimate(metric, 0)
        needed.append(max(0, abs(case.of(metric)[0] - expected) - half) / max(abs(expected), 1e-12))
    needed.sort()
    return needed[min(len(needed), round(wanted * len(needed))) - 1]


def count(cases):
    """Lines of a table: metric, intervals that hold, half width and error in the median."""
    text = "| | intervals that hold | half width, median | error of the value, median |\n| --- | --- | --- | --- |\n"
    for metric, share in shares.items():
        width, error = [], []
        for case in cases:
            expected, half = case.estimate(metric, share)
            width.append(half / max(abs(expected), 1e-12))
            error.append(abs(expected / case.of(metric)[0] - 1))
        held = sum(case.holds(metric, share) for case in cases)
        text += (f"| {metric.replace('_', ' ')} | {held} of {len(cases)} ({100 * held / len(cases):.0f} %) | "
                 f"{100 * statistics.median(width):.0f} % | {100 * statistics.median(error):.0f} % |\n")
    said = collections.Counter((case.verdict(), case.truth()) for case in cases)
    text += "\n| said | breaks in the full run | holds in the full run |\n| --- | --- | --- |\n"
    for word in ("breaks", "holds", "undecided"):
        text += f"| {word} | {said[word, 'breaks']} | {said[word, 'holds']} |\n"
    return text


def cost(cases):
    return statistics.median(sum(float(r["seconds"]) for r in [c.fine] + c.coarse) / float(c.full["seconds"]) for c in cases)


if __name__ == "__main__":
    drawn, counted = cases_of("drawn"), cases_of("counted")
    for metric in keys:
        print(metric, "share", round(share_for(drawn, metric), 3))
    for some in (drawn, counted):
        if some:
            print(len(some), "cases, seconds of the copies over those of the run:", round(cost(some), 2))
            print(count(some))
