"""Words and folders: pictures made again, runs drawn again, runs replaced, sweeps refined and promoted, replays."""
import json
import os
import shutil

from harness import SCENE

TINY = SCENE.replace("frames = 1", "frames = 2")
MAKE = "render s.toml --frames 0-1 --no-movie --quiet --out run"
ESCAPE = "\x1b]0;x\x07"


def attack(attacks):
    words(attacks)
    runs(attacks)
    sweeps(attacks)
    replays(attacks)


def words(attacks):
    one = lambda name, *command, **limits: attacks.run(name, {"s.toml": TINY}, list(command), **limits)
    for value in ("0", "-1", "nan", "inf", "1e300", "1e-300", "1", "9" * 100_000, "1e9GiB", "x", "", " ", "1 GiB", "1GiBGiB", "0x10", ESCAPE):
        one(f"room for states {value[:20]!r}", "render", "s.toml", "--frames", "0-1", "--no-movie", "--quiet", "--out", "o", "--states-budget", value)
    for command in ("render", "strip", "card", "sweep", "pick", "compare", "export", "dump", "check", "view", "info", "verify"):
        for word in ("--set", "--frames", "--size", "--out", "--from", "-p", "--refine", "--preset", "--material", "--clicks", "--log"):
            if (command, word) != ("view", "--out"):  # has an odd folder, and waits for a browser
                one(f"{command} {word} of 60 000 characters", command, "s.toml", word, "x=" + "9" * 60_000)
    one("refine of nothing", "sweep", "s.toml", "-p", "seed=1,2", "--refine", "1", "--quiet", "--out", "w")
    for value in ("0", "-1", "1e9", "nan", "x"):
        one(f"refine of {value}", "sweep", "s.toml", "-p", "seed=1,2", "--coarsen", "2", "--refine", value, "--dry-run")
        one(f"refine runs of {value}", "sweep", "s.toml", "-p", "seed=1,2", "--coarsen", "2", "--refine-runs", value, "--dry-run")
    one("refine runs of all numbers", "sweep", "s.toml", "-p", "seed=1,2", "--coarsen", "2", "--refine-runs", "0-4000000000", "--dry-run")
    one("best by no metric", "sweep", "s.toml", "-p", "seed=1,2", "--coarsen", "2", "--refine", "1", "--best", ESCAPE, "--dry-run")
    one("100 000 seeds", "sweep", "s.toml", "-p", "seed=1,2", "--seeds", "100000", "--dry-run")
    one("2 billion seeds", "sweep", "s.toml", "-p", "seed=1,2", "--seeds", "2000000000", "--dry-run")
    for preset in ("none", ESCAPE, "", "x" * 50_000):
        one(f"card of preset {preset[:20]!r}", "card", "--preset", preset, "--quiet", "--out", "c.png")
    one("card of 1000 scenes", "card", *["s.toml"] * 1000, "--quiet", "--out", "c.png")
    one("card of no scene", "card", "/dev/zero", "--quiet", "--out", "c.png")
    one("card written onto its scene", "card", "s.toml", "--preset", "wet", "--quiet", "--out", "s.toml")
    for text in ("1\n" * 500_000, "9" * 1_000_000, "\x00" * 1000, "1 2 3\n", "nan\n", "-1\n", ESCAPE + "\n"):
        attacks.run(f"clicks {text[:8]!r}", {"s.toml": TINY, "c.txt": text},
                    "pick s.toml -p material.snow.hardening=5,20 --clicks c.txt --frames 0-0 --size 64x36 --coarsen 3 --rounds 1 --quiet --out p")


def runs(attacks):
    draw = "render run --view particles --size 120x68 --no-movie --quiet"

    def after(name, change, *commands):
        attacks.run(name, {"s.toml": TINY}, MAKE)
        folder_change(attacks, name, {"s.toml": TINY}, MAKE, change, commands)

    def edit(change):
        def apply(folder):
            file = folder / "run/run.json"
            run = json.loads(file.read_text())
            change(run)
            file.write_text(json.dumps(run))
        return apply

    def damage(pattern, change):
        def apply(folder):
            for file in sorted(f for f in (folder / "run").rglob(pattern) if f.is_file()):
                file.write_bytes(change(file.read_bytes()))
        return apply

    after("a state cut", damage("*", lambda b: b[:len(b) // 2] if not b.startswith((b"\x89PNG", b"{")) else b), draw, "verify run")
    after("a state with one bit more", damage("*", lambda b: b[:-20] + bytes([b[-20] ^ 1]) + b[-19:] if not b.startswith((b"\x89PNG", b"{")) else b), draw, "verify run")
    after("states that are empty", damage("*", lambda b: b"" if not b.startswith((b"\x89PNG", b"{")) else b), draw, "strip run --tiles 2 --out x.png")
    after("states that are folders", lambda f: [(p.unlink(), p.mkdir()) for p in sorted((f / "run/states").rglob("*")) if p.is_file()], draw)
    after("states that are pipes", lambda f: [(p.unlink(), os.mkfifo(p)) for p in sorted((f / "run/states").rglob("*")) if p.is_file()], draw, "verify run")
    after("states that are huge", lambda f: [os.truncate(p, 1 << 40) for p in sorted((f / "run/states").rglob("*")) if p.is_file()], draw, "export run --format csv --out e")
    after("states of /dev/zero", lambda f: [(p.unlink(), p.symlink_to("/dev/zero")) for p in sorted((f / "run/states").rglob("*")) if p.is_file()], draw)
    after("100 000 files of states", lambda f: [(f / f"run/states/{k:06d}-x.ckpt").touch() for k in range(100_000)], draw)
    after("a run of -1 frames", edit(lambda r: r.update(frames=-1)), draw, "compare run run", "verify run")
    after("a run of 10 000 frames", edit(lambda r: r.update(frames=r["frames"] * 5000)), draw, "verify run")
    after("a run without its scene", edit(lambda r: r.pop("scene")), draw, "export run --format csv", "strip run", "card run --out c.png")
    after("a run of another scene", edit(lambda r: r.update(scene="frames = 99999\n" + SCENE.replace("frames = 1", ""))), draw)
    after("a run of escapes", edit(lambda r: r.update(scene=ESCAPE, status=ESCAPE, version=ESCAPE)), draw, "info run")
    after("a run that is a list", lambda f: (f / "run/run.json").write_text("[" * 100_000), draw, "info run", "verify run")
    after("a run that names files above", edit(lambda r: r.update(files={"../../s.toml": "0"})), draw + " --replace", "verify run")
    after("replaced over a person's files", lambda f: [(f / "run/thesis.tex").write_text("x"), (f / "run/particles").mkdir(exist_ok=True), (f / "run/particles/0007.png").write_text("mine")],
          "render s.toml --frames 0 --set seed=9 --no-movie --quiet --out run --replace")
    after("replaced through a link", lambda f: [(f / "mine").mkdir(), (f / "mine/0000.png").write_text("mine"), shutil.rmtree(f / "run/snow"), (f / "run/snow").symlink_to("../mine")],
          "render s.toml --frames 0 --set seed=9 --no-movie --quiet --out run --replace")
    after("replaced where a lock is held by nobody", lambda f: (f / "run/.lock").write_text(ESCAPE), "render s.toml --frames 0 --set seed=9 --no-movie --quiet --out run --replace")
    after("a run from 1e300 s", lambda f: None, "render run --from 1e300s --quiet --out o", "render run --from nan --quiet --out o", "render run --from -5s --quiet --out o",
          "strip run --at 1e300 --out x.png", "strip run --at nan,nan --out x.png", "export run --frames 0-99999999 --format csv --out e", "sweep run --from 99s -p seed=1,2 --out w")


def folder_change(attacks, name, files, make, change, commands):
    """What the commands make of what the first one left, changed."""
    import subprocess

    def before(folder):
        subprocess.run([attacks.program, *make.split()], cwd=folder, capture_output=True)
        change(folder)
    attacks.run(name, files, *commands, before=before)


def sweeps(attacks):
    make = "sweep s.toml -p material.snow.hardening=5,7 --coarsen 2 --frames 0-1 --size 64x36 --quiet --out w"

    def after(name, file, change, *commands):
        def apply(folder):
            path = folder / "w" / file
            value = json.loads(path.read_text())
            change(value)
            path.write_text(json.dumps(value))
        folder_change(attacks, name, {"s.toml": TINY}, make, apply, commands)

    promote = ["sweep", "promote", "w", "0", "--out", "best.toml"]
    after("promoted", "manifest.json", lambda m: None, promote)
    after("promoted: run 2 billion", "manifest.json", lambda m: None, ["sweep", "promote", "w", "2000000000", "--out", "best.toml"], ["sweep", "promote", "w", "-1", "--out", "best.toml"], ["sweep", "promote", "w", ESCAPE])
    after("promoted onto its scene", "manifest.json", lambda m: None, ["sweep", "promote", "w", "0", "--out", "s.toml"])
    for key, value in (("runs", []), ("runs", 5), ("scene", "/etc/passwd"), ("scene", "../" * 5000), ("scene", ESCAPE), ("coarsen", 1e300), ("coarsen", -1), ("title", ESCAPE * 1000)):
        after(f"promoted with {key} = {str(value)[:20]!r}", "manifest.json", lambda m: m.update({key: value}), promote, "sweep collect w", "verify w", make + " --refine 1")
    after("promoted with settings that are a list", "manifest.json", lambda m: m["runs"][0].update(settings=[1]), promote, "sweep collect w")
    after("promoted with a setting of escapes", "manifest.json", lambda m: m["runs"][0].update(settings={"material.snow.hardening": ESCAPE}), promote, "sweep collect w")
    after("refined with a status of another kind", "runs/0000/status.json", lambda s: s.update(state=5, metrics="x"), make + " --refine 1", "sweep collect w")


def replays(attacks):
    def one(name, steps, **limits):
        attacks.run(name, {"s.toml": TINY, "r.json": steps if isinstance(steps, str) else json.dumps(steps)},
                    "view s.toml --replay r.json --out o --size 320x200 --quiet", **limits)
    one("20 000 steps", [{"move": [k % 300, k % 200]} for k in range(20_000)] + [{"quit": True}],
        seconds=60)  # of its author, who is told
    one("a wait of 2 billion frames", [{"wait": 2_000_000_000}])
    one("a click of 2 billion times", [{"click": [5, 5], "times": 2_000_000_000}])
    one("a drag of 2 billion steps", [{"drag": [[5, 5], [9, 9]], "steps": 2_000_000_000}])
    one("a window of 2e9 pixels", [{"resize": [60_000, 60_000]}, {"quit": True}])
    one("words of 900 000 characters", [{"type": "x" * 900_000}, {"quit": True}])
    one("a list of lists", "[" * 200_000)
    one("a wait for what never comes", [{"wait_for": "label nothing", "seconds": 1}])
