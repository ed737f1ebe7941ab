"""Runs a random scene in several ways, and says what is wrong with the answers."""

import hashlib
import json
import math
import os
import signal
import struct
import subprocess
import time
import zlib

# A run may end well, as a snow that explodes, or at a limit.
GOOD, INVALID, DIVERGED, LIMIT, UNHEALTHY, INTERRUPTED = 0, 3, 5, 8, 9, 75
SLOW, HANGS = "slow", "hangs"


class Neve:
    def __init__(self, program, folder, seconds):
        self.program, self.folder, self.seconds = program, folder, seconds
        self.environment = {**os.environ, "NO_COLOR": "1"}

    def run(self, *words, seconds=None):
        """@return exit code, or SLOW where Ctrl-C ended it and HANGS where it did not; output; errors"""
        process = subprocess.Popen([self.program, *words], cwd=self.folder, env=self.environment,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        code = None
        for limit, tell in ((seconds or self.seconds, signal.SIGINT), (30, signal.SIGKILL), (30, None)):
            try:
                output, errors = process.communicate(timeout=limit)
                break
            except subprocess.TimeoutExpired:
                code = SLOW if tell == signal.SIGINT else HANGS
                process.send_signal(tell)
        if code is None or (code == SLOW and process.returncode not in (GOOD, INTERRUPTED, 130)):
            code = process.returncode
        return code, output.decode("utf8", "replace"), errors.decode("utf8", "replace")

    def render(self, out, *words):
        return self.run("render", "scene.toml", "--out", out, "--no-movie", "--quiet", *words)

    def path(self, *parts):
        return os.path.join(self.folder, *parts)


def numbers(value, where=""):
    if isinstance(value, dict):
        for key, item in value.items():
            yield from numbers(item, f"{where}.{key}")
    elif isinstance(value, list):
        for item in value:
            yield from numbers(item, where + "[]")
    elif isinstance(value, float):
        yield where, value


def damage_of_png(path):
    data, pixels, at = open(path, "rb").read(), b"", 8
    while at < len(data):
        size, = struct.unpack_from(">I", data, at)
        kind, body = data[at + 4:at + 8], data[at + 8:at + 8 + size]
        if struct.unpack_from(">I", data, at + 8 + size)[0] != zlib.crc32(kind + body):
            return "a checksum is wrong"
        if kind == b"IHDR":
            width, height, depth, colour = struct.unpack_from(">IIBB", body)
        pixels += body if kind == b"IDAT" else b""
        at += 12 + size
    row = 1 + width * {0: 1, 2: 3, 4: 2, 6: 4}[colour] * depth // 8
    return "" if len(zlib.decompress(pixels)) == row * height else "pixels are missing"


def contents(folder):
    """Hashes of what has to be the same bits: pictures and exports."""
    found = {}
    for place, _, names in os.walk(folder):
        for name in names:
            if name.endswith((".png", ".ply", ".vtp", ".vti", ".vdb", ".bgeo", ".usda", ".npz", ".csv", ".obj")):
                path = os.path.join(place, name)
                found[os.path.relpath(path, folder)] = hashlib.sha1(open(path, "rb").read()).hexdigest()
    return found


def report(neve, out):
    with open(neve.path(out, "run.json")) as file:
        return json.load(file)


def differences(neve, one, other):
    a, b = report(neve, one)["frames"], report(neve, other)["frames"]
    hashes = [[frame["state_hash"] for frame in frames] for frames in (a, b)]
    if hashes[0] != hashes[1]:
        yield f"{other}: other state hashes than {one}"
    a, b = contents(neve.path(one)), contents(neve.path(other))
    for name in sorted(a.keys() | b.keys()):
        if a.get(name) != b.get(name):
            yield f"{other}: {name} is not the {name} of {one}"


def gaps(neve, out, scene):
    """What is missing or wrong in a folder that a run calls whole."""
    code, _, errors = neve.run("verify", out, seconds=60)
    if code != GOOD:
        yield f"verify ends with {code}: {errors.strip()[-200:]}"
    run = report(neve, out)
    frames = run["frames"]
    wanted = [scene["first_frame"] + k for k in range(scene["frames"] + 1)]
    if run["status"] != "ok" or [frame["frame"] for frame in frames] != wanted:
        yield f"status {run['status']}, frames {[frame['frame'] for frame in frames]}"
    for where, value in numbers(frames):
        if not math.isfinite(value) or abs(value) > 1e30:
            yield f"run.json: {where} is {value}"
    for k, frame in enumerate(frames):
        if abs(frame["time"] - k / scene["fps"]) > 1e-9 * max(1, frame["time"]):
            yield f"frame {frame['frame']} is at {frame['time']} s"
    if not scene["emitter"] and not scene["sink"]:
        first, last = frames[0], frames[-1]
        if first["particles"] != last["particles"] or abs(last["mass"] - first["mass"]) > 1e-6 * first["mass"]:
            yield f"mass goes from {first['mass']} to {last['mass']}"
    for place, _, names in os.walk(neve.path(out)):
        for name in names:
            path = os.path.join(place, name)
            if name.endswith(".tmp"):
                yield f"{name} is left"
            if name.endswith(".png") and damage_of_png(path):
                yield f"{name}: {damage_of_png(path)}"
            if name.endswith(".csv") and any(word in open(path, "rb").read().lower() for word in (b",nan", b",inf", b",-inf")):
                yield f"{name} has numbers that are not finite"


def other_commands(draw, end):
    change = f"material.snow.youngs_modulus={draw.one('1e4', '3e5')}"
    return [
        ("check", "scene.toml", "--coarsen", "1.5"),
        ("export", "one", "--format", "ply,vtp,bgeo,usda,npz,csv,vdb", "--out", "exported"),
        ("export", "scene.toml", "--format", "usda,obj", "--surface", "--out", "surfaces", "--quiet"),
        ("strip", "one", "--tiles", "3", "--width", "300", "--out", "strip.png"),
        ("compare", "one", "two", "--out", "compared"),
        ("render", "one", "--from", repr(end * draw.one(0, 0.3, 0.7)), "--set", change, "--out", "forked", "--no-movie", "--quiet"),
        ("dump", "scene.toml", "--at", repr(end * draw.within(0, 1)), "--json"),
        ("render", "scene.toml", "--passes", "all", "--out", "passes", "--no-movie", "--quiet"),
        ("render", "scene.toml", "--quality", "final", "--out", "final", "--no-movie", "--quiet"),
        ("render", "scene.toml", "--view", draw.one("snow", "smoke", "slice"), "--out", "seen", "--no-movie", "--quiet"),
        ("render", "scene.toml", "--fast", "--validate", "--out", "fast", "--no-movie", "--quiet"),
        ("sweep", "scene.toml", "-p", "material.snow.youngs_modulus=1e4,3e5", "--size", "64x48", "--out", "swept", "--quiet"),
        ("sweep", "scene.toml", "--fork", repr(end * 0.4), "-p", "material.snow.youngs_modulus=1e4,3e5", "--size", "64x48", "--out", "branches", "--quiet"),
    ]


def judge(neve, scene, draw):
    """@return what was found: code, seconds, faults, what check foresaw"""
    faults = []
    begin = time.monotonic()
    checked, text, errors = neve.run("check", "scene.toml", "--json", seconds=60)
    foreseen = json.loads(text) if checked in (GOOD, UNHEALTHY) and text else {}
    if checked not in (GOOD, INVALID, LIMIT, UNHEALTHY):
        faults.append(f"check ends with {checked}: {errors.strip()[-300:]}")
    checking, begin = time.monotonic() - begin, time.monotonic()
    code, _, errors = neve.render("one", "--threads", "1")
    found = {"code": code, "seconds": round(time.monotonic() - begin, 2), "checking": round(checking, 2),
             "foreseen": foreseen.get("seconds_range"), "limit": foreseen.get("dt_limit"),
             "advice": [item if isinstance(item, str) else item.get("message", item.get("text", ""))
                        for item in foreseen.get("warnings", []) + foreseen.get("findings", [])],
             "message": errors.strip()[-300:], "faults": faults}
    if (checked == INVALID) != (code == INVALID) and code not in (SLOW, DIVERGED):
        faults.append(f"check ends with {checked}, render with {code}")
    if code not in (GOOD, INVALID, DIVERGED, LIMIT, SLOW):
        faults.append(f"render ends with {code}: {errors.strip()[-400:]}")
    if code == GOOD:
        faults += gaps(neve, "one", scene)
    if code in (GOOD, DIVERGED):
        again, _, errors = neve.render("two", "--threads", "2")
        if again == code:
            faults += differences(neve, "one", "two")
        elif again != SLOW:
            faults.append(f"2 threads end with {again}, 1 with {code}: {errors.strip()[-200:]}")
    if code == GOOD and scene["frames"] > 1:
        first, last = scene["first_frame"], scene["first_frame"] + scene["frames"]
        middle = draw.random.randint(first, last - 1)
        codes = [neve.render("resumed", "--threads", "1", "--frames", f"{first}-{middle}")[0],
                 neve.render("resumed", "--threads", "2", "--frames", f"{first}-{last}", "--resume")[0]]
        if codes == [GOOD, GOOD]:
            faults += differences(neve, "one", "resumed")
        elif SLOW not in codes:
            faults.append(f"frames to {middle} and the rest, resumed, end with {codes}")
    if code == GOOD:
        for words in draw.random.sample(other_commands(draw, scene["frames"] / scene["fps"]), 2):
            code, _, errors = neve.run(*words, seconds=4 * neve.seconds)
            if code == HANGS or code == 1 or (code != SLOW and (code < 0 or code >= 128)):
                faults.append(f"{' '.join(words)} ends with {code}: {errors.strip()[-300:]}")
    return found
