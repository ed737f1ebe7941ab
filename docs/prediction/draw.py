#!/usr/bin/env python3
"""Draws cases at random: scenes that ship, in cells of 0.024 m and more, with materials, speeds and lumps. The intervals of
neve check --predict were chosen with those of drawn.toml, and counted with those of counted.toml.
  docs/prediction/draw.py drawn 48 52 > docs/prediction/drawn.toml      group, cases, seed
  docs/prediction/draw.py counted 40 53 > docs/prediction/counted.toml
"""

import random
import sys

group, count, seed = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
draw = random.Random(seed)


def log_uniform(low, high):
    return float(f"{low * (high / low) ** draw.random():.3g}")


def uniform(low, high):
    return round(draw.uniform(low, high), 3)


def snow(name):
    words = {"youngs_modulus": log_uniform(4e4, 2e5), "hardening": uniform(3, 11),
             "critical_compression": log_uniform(0.012, 0.05), "critical_stretch": log_uniform(0.003, 0.016)}
    return [f"material.{name}.model=snow"] + [f"material.{name}.{key}={value:g}" for key, value in words.items()]


def clay(name):
    words = {"youngs_modulus": log_uniform(4e4, 1e5), "consolidation_pressure": log_uniform(800, 1e4),
             "cohesion": uniform(0.15, 0.9), "consolidation_hardening": uniform(0.5, 2.5), "min_J_P": 0.44}
    return [f"material.{name}.model=cam_clay"] + [f"material.{name}.{key}={value:g}" for key, value in words.items()]


def lumps(name):
    if draw.random() < 0.5:
        return []
    return [f"material.{name}.variation.thresholds={uniform(0.4, 1.4)}", f"material.{name}.variation.size=0.06"]


def scene(kind):
    name = "packed" if kind == "two_snowballs" else "snow"
    speed = uniform(1.2, 5)
    words = {"snowball_drop": [f"body.ball.velocity=[0.4,{-speed},0]", "body.ball.shape.sphere.center=[0,0.3,0]"],
             "snowball_wedge": [f"body.ball.velocity=[0,{-speed},0]", "body.ball.shape.sphere.center=[0,0.8,0]"],
             "two_snowballs": [f"body.left.velocity=[{speed},1,0]", f"body.right.velocity=[{-speed},1.2,0]",
                               "body.left.shape.sphere.center=[-0.2,0.42,0]",
                               "body.right.shape.sphere.center=[0.2,0.38,0.03]", "body.right.material=packed"],
             "slope_slide": [f"body.block.velocity=[{speed / 2},{-speed / 4},0]"]}[kind]
    last = {"snowball_drop": 9, "snowball_wedge": 12, "two_snowballs": 10, "slope_slide": 16}[kind]
    cell = {"snowball_drop": 0.024, "snowball_wedge": 0.026, "two_snowballs": 0.024, "slope_slide": 0.024}[kind]
    return name, last, [f"solver.cell_size={cell}", "solver.acoustic_cfl=0.85"] + words


print(f"# Made by draw.py.\n\n[{group}]\ncoarsen = [1.5, 2]\npowers  = [[0.5, 0.25, 0.5, 0]]\nseeds = [1]\nmore_seeds = [2]\nfull_seeds = [2]\n")
for number in range(count):
    kind = draw.choice(["snowball_drop", "snowball_wedge", "two_snowballs", "slope_slide"])
    name, last, words = scene(kind)
    material = clay if number % 2 else snow
    words += material(name) + lumps(name)
    print(f'[[{group}.case]]\nname = "{number}: {kind}, {"clay" if number % 2 else "snow"}"\nscene = "scenes/{kind}.toml"\n'
          f"last = {last}\nset = {words!r}".replace("'", '"'))
