"""Runs a random scene in several ways, and says what is wrong with the answers."""

import json

from program import DIVERGED, GOOD, INVALID, LIMIT, SLOW, UNHEALTHY, gaps
from ways import Ways

# The parameters that `neve check` names where they make a run slow.
REASONS = ("youngs_modulus", "density", "poisson_ratio", "hardening", "J_P", "acoustic_cfl", "cfl", "strain_limit",
           "max_dt", "dt", "particles_per_cell", "solve_tolerance", "cell_size", "spacing", "beta", "velocity",
           "angular_velocity", "keyframes", "rate", "gravity", "on_divergence", "fps", "friction_angle")


def forecast(neve):
    """What check says before: exit code, faults, seconds of the simulation, parameters that make it slow."""
    code, text, errors = neve.run("check", "scene.toml", "--json", seconds=3 * neve.seconds)
    said = json.loads(text) if code in (GOOD, UNHEALTHY) and text else {}
    found = {"checking": round(neve.last, 2), "foreseen": said.get("seconds_range"),
             "steps": said.get("steps_range"), "limit": said.get("dt_limit"),
             "named": [finding["address"] for finding in said.get("findings", [])
                       if finding["address"].split(".")[-1].removeprefix("max_") in REASONS]}
    usual = code in (GOOD, INVALID, LIMIT, UNHEALTHY)
    return code, [] if usual else [f"check ends with {code}: {errors.strip()[-300:]}"], found


def judge(neve, scene):
    """@return what was found: code, seconds, faults, what check foresaw of slow scenes and of some others"""
    draw, ways, faults = scene.draw, Ways(neve, scene), []
    code, _, errors = neve.render("one", "--threads", "1")
    found = {"code": code, "seconds": round(neve.last, 2), "message": errors.strip()[-300:],
             "faults": faults, "beside": ways.seen}
    if code not in (GOOD, INVALID, DIVERGED, LIMIT, SLOW):
        faults.append(f"render ends with {code}: {errors.strip()[-400:]}")
    if code in (SLOW, INVALID, LIMIT) or draw.chance(0.2):
        checked, more, foreseen = forecast(neve)
        found.update(foreseen)
        faults += more
        if (checked == INVALID) != (code == INVALID) and SLOW not in (checked, code) and code != DIVERGED:
            faults.append(f"check ends with {checked}, render with {code}")
    if code == GOOD:
        faults += gaps(neve, "one", scene)
        another = draw.one(ways.resumed, ways.forked, ways.viewed, ways.swept, ways.behind, ways.other)
        for way in (ways.two_threads, another):
            faults += way()
    return found
