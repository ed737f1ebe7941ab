"""The program under test, and what it leaves in folders."""

import hashlib
import json
import math
import os
import signal
import struct
import subprocess
import time
import zlib

# Exit codes; a run may end well, as a snow that explodes, at a limit, or be too slow to wait for.
GOOD, REFUSED, INVALID, DIVERGED, FAILED_RUNS, LIMIT, UNHEALTHY, INTERRUPTED = 0, 2, 3, 5, 7, 8, 9, 75
SLOW, HANGS = "slow", "hangs"


class Neve:
    def __init__(self, program, folder, seconds):
        self.program, self.folder, self.seconds = program, folder, seconds
        self.environment = {**os.environ, "NO_COLOR": "1"}

    def run(self, *words, seconds=None):
        """@param seconds  of the processor; the other work of a machine does not make a scene slow
        @return exit code, or SLOW where Ctrl-C ended it and HANGS where it did not; output; errors"""
        process = subprocess.Popen([self.program, *words], cwd=self.folder, env=self.environment,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.last = 0  # s, of the processor, to half a second
        limit, told, begin = seconds or self.seconds, None, time.monotonic()
        while True:
            try:
                output, errors = process.communicate(timeout=0.5 if not told else 5)
                break
            except subprocess.TimeoutExpired:
                self.last, waited = self.used(process.pid), time.monotonic() - begin
                if told and waited > told + 60:
                    process.kill()
                elif not told and (self.last > limit or waited > 60 + 20 * limit):
                    told = waited
                    process.send_signal(signal.SIGINT)
        code = process.returncode
        if code == -signal.SIGKILL and told:
            code = HANGS
        elif told and code in (GOOD, INTERRUPTED, 130):
            code = SLOW
        return code, output.decode("utf8", "replace"), errors.decode("utf8", "replace")

    def used(self, process):
        """@return seconds of the processor, of a process and of those that it waited for"""
        try:
            fields = open(f"/proc/{process}/stat").read().rsplit(")", 1)[1].split()
        except OSError:
            return 0
        return sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")

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
    wanted = list(range(scene.first(), scene.last() + 1))
    if run["status"] != "ok" or [frame["frame"] for frame in frames] != wanted:
        yield f"status {run['status']}, frames {[frame['frame'] for frame in frames]}"
    for where, value in numbers(frames):
        if not math.isfinite(value) or abs(value) > 1e30:
            yield f"run.json: {where} is {value}"
    for k, frame in enumerate(frames):
        if abs(frame["time"] - k / scene.fps) > 1e-9 * max(1, frame["time"]):
            yield f"frame {frame['frame']} is at {frame['time']} s"
    if not scene.scene["emitter"] and not scene.scene["sink"]:
        first, last = frames[0], frames[-1]
        if first["particles"] != last["particles"] or abs(last["mass"] - first["mass"]) > 1e-6 * first["mass"]:
            yield f"mass goes from {first['mass']} to {last['mass']}"
    # Without the stage that finds volumes there is no density.
    has_volumes = "volumes" not in scene.scene["solver"].get("bypass", [])
    for place, _, names in os.walk(neve.path(out)):
        for name in names:
            path = os.path.join(place, name)
            if name.endswith(".tmp"):
                yield f"{name} is left"
            if name.endswith(".png") and damage_of_png(path):
                yield f"{name}: {damage_of_png(path)}"
            if has_volumes and name.endswith(".csv") and any(word in open(path, "rb").read().lower() for word in (b",nan", b",inf", b",-inf")):
                yield f"{name} has numbers that are not finite"
