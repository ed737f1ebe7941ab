#!/usr/bin/env python3
"""Writes crystal.ply: a snow crystal of particles on a lattice, for ../point_cloud.toml.

A plate in the plane of x and y, six arms with branches, five layers of particles thick. Each
particle has a position and a volume; mass, velocity and spin come from the scene.
"""
import math
import struct

SPACING = 0.008  # m between neighbours
RADIUS = 0.30    # m, from the centre to the tips
LAYERS = 5

# Bars of one arm along x: from, to (m), half width (m). Branches leave at 60 degrees.
STEM = (0.0, RADIUS, 0.022)
BRANCHES = [(0.11, 0.07), (0.17, 0.10), (0.235, 0.06)]  # where along the stem, how long
BRANCH_WIDTH = 0.016
HUB = 0.065


def distance_to_bar(px, py, ax, ay, bx, by):
    dx, dy = bx - ax, by - ay
    t = max(0.0, min(1.0, ((px - ax) * dx + (py - ay) * dy) / (dx * dx + dy * dy)))
    return math.hypot(px - ax - t * dx, py - ay - t * dy)


def is_inside(x, y):
    if math.hypot(x, y) <= HUB:
        return True
    # Into the sector of one arm, and its upper half.
    angle = math.atan2(y, x)
    turn = round(angle / (math.pi / 3)) * math.pi / 3
    px = x * math.cos(turn) + y * math.sin(turn)
    py = abs(-x * math.sin(turn) + y * math.cos(turn))
    if distance_to_bar(px, py, STEM[0], 0, STEM[1], 0) <= STEM[2]:
        return True
    c, s = math.cos(math.pi / 3), math.sin(math.pi / 3)
    return any(distance_to_bar(px, py, at, 0, at + c * length, s * length) <= BRANCH_WIDTH
               for at, length in BRANCHES)


def main():
    steps = int(RADIUS * 1.2 / SPACING)
    points = [(i * SPACING, j * SPACING, (k - (LAYERS - 1) / 2) * SPACING)
              for j in range(-steps, steps + 1) for i in range(-steps, steps + 1)
              if is_inside(i * SPACING, j * SPACING) for k in range(LAYERS)]
    with open("crystal.ply", "wb") as file:
        file.write(("ply\nformat binary_little_endian 1.0\ncomment a snow crystal, in metres\n"
                    f"element vertex {len(points)}\n"
                    "property float x\nproperty float y\nproperty float z\n"
                    "property float volume\nend_header\n").encode())
        for x, y, z in points:
            file.write(struct.pack("<4f", x, y, z, SPACING ** 3))
    print(len(points), "points")


if __name__ == "__main__":
    main()
