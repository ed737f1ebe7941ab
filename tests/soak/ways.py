"""Other ways through a scene whose run is in the folder `one`: each says what is wrong with the answers."""

import json
import os
import re

import files
from draw import as_toml
from program import DIVERGED, FAILED_RUNS, GOOD, HANGS, INVALID, LIMIT, REFUSED, SLOW, UNHEALTHY, differences, gaps, report

# How a command may end that does something else with a scene that runs; changes may not fit together.
USUAL = (GOOD, REFUSED, INVALID, DIVERGED, FAILED_RUNS, LIMIT, UNHEALTHY, SLOW)


class Ways:
    def __init__(self, neve, scene):
        self.neve, self.scene, self.draw = neve, scene, scene.draw
        self.seen = []  # commands and exit codes

    def run(self, *words):
        """@return exit code; a fault where a command ends as none should"""
        code, _, errors = self.neve.run(*words, seconds=2 * self.neve.seconds)
        self.seen.append([" ".join(words), code, errors.strip()[-200:] if code else ""])
        return code, [] if code in USUAL else [f"{' '.join(words)} ends with {code}: {errors.strip()[-300:]}"]

    def moment(self):
        """A time at which runs may fork, as text."""
        frames = self.scene.last() - self.scene.first()
        share = self.draw.one(0, 0.3, 0.7)
        if self.scene.scene["solver"].get("on_divergence") == "retry":  # only whole frames are final
            share = int(share * frames) / frames
        return repr(share * self.scene.duration())

    def changes(self):
        for _ in range(self.draw.random.randint(1, 3)):
            address, value = self.scene.live_change()
            yield from ("--set", f"{address}={value}")

    def two_threads(self):
        code, faults = self.run("render", "scene.toml", "--out", "two", "--no-movie", "--quiet", "--threads", "2")
        yield from faults
        if code == GOOD:
            yield from differences(self.neve, "one", "two")

    def resumed(self):
        first, last = self.scene.first(), self.scene.last()
        middle = self.draw.random.randint(first, last - 1)
        words = ("render", "scene.toml", "--out", "resumed", "--no-movie", "--quiet")
        for more in (("--threads", "1", "--frames", f"{first}-{middle}"), ("--threads", "2", "--frames", f"{first}-{last}", "--resume")):
            code, faults = self.run(*words, *more)
            yield from faults
            if code != GOOD:
                return
        yield from differences(self.neve, "one", "resumed")

    def forked(self):
        """Parameters that change during a run: the same bits with two threads, and from the last picture."""
        words = ("render", "one", "--from", self.moment(), *self.changes(),
                 "--no-movie", "--quiet")
        code, faults = self.run(*words, "--out", "forked", "--threads", "1")
        yield from faults
        if code != GOOD:
            return
        code, faults = self.run(*words, "--out", "forked2", "--threads", "2")
        yield from faults or ([] if code in (GOOD, SLOW) else [f"with two threads the fork ends with {code}"])
        if code == GOOD:
            yield from differences(self.neve, "forked", "forked2")
        yield from self.again("forked", report(self.neve, "forked")["frames"][-1]["state_hash"])

    def again(self, folder, state_hash):
        """The run of a picture of the last frame in a folder ends in the same state."""
        for name in sorted(os.listdir(self.neve.path(folder))):
            picture = os.path.join(folder, name, "%04d.png" % self.scene.last())
            if os.path.exists(self.neve.path(picture)):
                yield from self.same_state(picture, state_hash)
                return

    def same_state(self, picture, state_hash):
        code, faults = self.run("render", picture, "--yes", "--out", "again", "--no-movie", "--quiet", "--threads", "1")
        yield from faults or ([] if code in (GOOD, SLOW) else [f"{picture} made again ends with {code}: {self.seen[-1][2]}"])
        if code == GOOD and report(self.neve, "again")["frames"][-1]["state_hash"] != state_hash:
            yield f"{picture} made again is another state"

    def viewed(self):
        """A session in which parameters are changed; its picture is made again."""
        script = [{"click": "Frame"}, {"wait_for": f"simulation frame {self.scene.first() + 1}"}]
        for address, value in (self.scene.live_change() for _ in range(2)):
            if re.fullmatch(r"-?[\d.e+-]+", value) and address.startswith("material.snow."):
                script += [{"click": address, "ctrl": True}, {"key": "a", "ctrl": True}, {"type": value}, {"key": "enter"}, {"wait": 3}]
        script += [{"click": "Run"}, {"wait": 20}, {"click": "Pause"}, {"wait": 5}] * self.draw.chance(0.3)
        script += [{"click": "Frame"}, {"wait": 30}, {"key": "p"}, {"wait": 60}, {"quit": True}]
        with open(self.neve.path("script.json"), "w") as file:
            json.dump(script, file)
        code, faults = self.run("view", "scene.toml", "--replay", "script.json", "--out", "viewed", "--size", "700x500", "--quiet")
        yield from faults
        # The session may end while a picture waits for the end of its frame.
        saved = code == GOOD and os.path.isdir(self.neve.path("viewed"))
        pictures = [name for name in os.listdir(self.neve.path("viewed")) if name.endswith(".png")] if saved else []
        if pictures:
            picture = "viewed/" + pictures[0]
            code, text, _ = self.neve.run("info", picture, "--json")
            if code == GOOD:
                yield from self.same_state(picture, json.loads(text)["state_hash"])

    def swept(self):
        """A sweep of several axes, by each method."""
        draw = self.draw
        axes = dict(self.scene.live_change() for _ in range(draw.random.randint(1, 3)))
        axes["material.snow.youngs_modulus"] = "1.4e5"
        method = draw.one("grid", "zip", "random", "lhs", "sobol", "morris")
        quoted = lambda value: value if re.match(r"[\[\d-]|true|false", value) else json.dumps(value)
        lines = ["[sweep]", 'scene = "scene.toml"', f'method = "{method}"', "[axis]"]
        if method not in ("grid", "zip"):
            lines.insert(3, f"samples = {2 if method == 'morris' else 3}")
        for address, value in axes.items():
            other = draw.value(re.sub(r"^(material|collider|view)\.[^.]+", r"\1.NAME", address))
            other = other if isinstance(other, str) else as_toml(other)
            lines.append(f'"{address}" = [{quoted(value)}, {quoted(other)}]')
        with open(self.neve.path("sweep.toml"), "w") as file:
            file.write("\n".join([*lines, "[limits]", f"timeout = {self.neve.seconds}"]) + "\n")
        fork = ("--fork", self.moment()) * draw.chance(0.4)
        yield from self.run("sweep", "sweep.toml", *fork, "--size", "64x48", "--out", "swept", "--quiet",
                            *("--seeds", "2") * (not fork and draw.chance(0.2)))[1]

    def behind(self):
        """Plates, one or one a frame, and passes."""
        if self.draw.chance(0.5):
            named, names = "plate.png", ["plate.png"]
        else:
            named = "plate_%04d.png"
            names = [named % number for number in range(self.scene.first(), self.scene.last() + 1)]
        for name in names:
            with open(self.neve.path(name), "wb") as file:
                file.write(files.plate(self.draw))
        yield from self.run("render", "scene.toml", "--plate", named, "--size", "48x32", *("--passes", "all") * self.draw.chance(0.3),
                            "--out", "plates", "--no-movie", "--quiet")[1]
        if self.seen[-1][1] == GOOD:
            yield from gaps(self.neve, "plates", self.scene)

    def other_commands(self):
        end, one = self.scene.duration(), self.draw.one
        return [
            ("check", "scene.toml", "--coarsen", "1.5"),
            ("export", "one", "--format", "ply,vtp,bgeo,usda,npz,csv,vdb", "--out", "exported"),
            ("export", "scene.toml", "--format", "usda,obj", "--surface", "--out", "surfaces", "--quiet"),
            ("strip", "one", "--tiles", "3", "--width", "300", "--out", "strip.png"),
            ("compare", "one", "one", "--out", "compared"),
            ("dump", "scene.toml", "--at", repr(end * self.draw.within(0, 1)), "--json"),
            ("render", "scene.toml", "--passes", "all", "--out", "passes", "--no-movie", "--quiet"),
            ("render", "scene.toml", "--quality", "final", "--out", "final", "--no-movie", "--quiet"),
            ("render", "scene.toml", "--view", one("snow", "smoke", "slice"), "--out", "seen", "--no-movie", "--quiet"),
            ("render", "scene.toml", "--fast", "--validate", "--out", "fast", "--no-movie", "--quiet"),
            ("render", "scene.toml", "--coarsen", "1.7", "--out", "coarse", "--no-movie", "--quiet"),
            ("render", "scene.toml", "--keep-states", "--checkpoint-every", "1", "--out", "kept", "--no-movie", "--quiet"),
        ]

    def other(self):
        yield from self.run(*self.draw.random.choice(self.other_commands()))[1]
