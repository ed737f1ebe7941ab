"""Random valid scenes, from what `neve params --json` says of every parameter.

Lengths are drawn in cells, so that scenes of any size have some thousand particles, and times in the
time to fall a cell. What has no range in the descriptions (which tables there are, where things are,
files) is drawn here; everything else is drawn from its description, near its default or anywhere in
its range, so that a parameter that is new is in the soak without another word.
"""

import json
import math
import random

G = 9.81


def as_toml(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {as_toml(item)}" for key, item in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(as_toml, value)) + "]"
    return json.dumps(value, ensure_ascii=False)


def as_text(scene):
    """Numbers and texts first, then tables, then lists of tables."""
    tables = {key: value for key, value in scene.items() if isinstance(value, dict)}
    lists = {key: value for key, value in scene.items() if isinstance(value, list) and value
             and isinstance(value[0], dict)}
    lines = [f"{key} = {as_toml(value)}" for key, value in scene.items()
             if key not in tables and value != []]
    lines = [line for line in lines if line.split(" = ")[0] not in lists]
    for key, table in tables.items():
        named = table.items() if key == "material" else [(None, table)]
        for name, items in named:
            lines.append(f"\n[{key}.{name}]" if name else f"\n[{key}]")
            lines += [f"{k} = {as_toml(v)}" for k, v in items.items()]
    for key, entries in lists.items():
        for entry in entries:
            lines.append(f"\n[[{key}]]")
            lines += [f"{k} = {as_toml(v)}" for k, v in entry.items()]
    return "\n".join(lines) + "\n"


class Draw:
    """Values of parameters. boldness: the share of values that leave the surroundings of the default."""

    def __init__(self, seed, parameters):
        self.random = random.Random(f"neve soak {seed}")
        self.parameters = parameters
        self.boldness = self.random.choice((0, 0.05, 0.2, 0.5, 1))

    def chance(self, share):
        return self.random.random() < share

    def bold(self):
        return self.chance(self.boldness)

    def one(self, *choices):
        return self.random.choice(choices)

    def within(self, low, high):
        return self.random.uniform(low, high)

    def number(self, parameter, default):
        low = -1e6 if parameter["min"] is None else parameter["min"]
        high = 1e6 if parameter["max"] is None else parameter["max"]
        if default is not None and not self.bold():
            value = default * self.one(0.3, 0.7, 1, 1, 1, 1.4, 3)
        elif self.chance(0.2):
            value = self.one(low, high)
        elif low >= 0 and high >= 1e3 * max(low, 1e-12):
            value = 10 ** self.within(math.log10(max(low, 1e-9 * high)), math.log10(high))
        else:
            value = self.within(low, high)
        value = min(max(value, low), high)
        inside = 1e-6 * min(high - low, 1)
        if parameter.get("min_open") and value == low:
            value += inside
        if parameter.get("max_open") and value == high:
            value -= inside
        if parameter.get("least_above_0") and 0 < value < parameter["least_above_0"]:
            value = parameter["least_above_0"]
        return round(value) if parameter["type"] == "integer" else float(value)

    def value(self, address):
        parameter = self.parameters[address]
        default, kind = parameter.get("default"), parameter["type"]
        if kind == "boolean":
            return self.chance(0.5)
        if kind == "choice":
            return self.random.choice(parameter["choices"])
        if kind == "list of choices":
            count = self.random.randint(1, min(5, len(parameter["choices"])))
            return self.random.sample(parameter["choices"], count)
        if kind in ("number", "integer"):
            return self.number(parameter, default)
        if kind == "vector":
            vector = [self.number(parameter, k or None) if self.bold() else float(k) + self.within(-1, 1)
                      for k in (default or [0, 0, 0])]
            return vector if any(vector) else [0.0, 1.0, 0.0]
        if kind == "range":
            return self.one("auto", [self.within(-5, 0), self.within(1, 1e3)])
        if kind == "size":
            return [self.random.randint(16, 96), self.random.randint(16, 72)]
        return self.one("", "snow", "Névé, 雪", "a" * 70, "{frame} {time}")

    def table(self, prefix, share, without=()):
        """Some of the parameters right below a prefix."""
        names = [address[len(prefix):] for address in self.parameters if address.startswith(prefix)]
        return {name: self.value(prefix + name) for name in names
                if "." not in name and "[" not in name and name not in without and self.chance(share)}


def octahedron(draw, size):
    """Corners and faces of a closed mesh, subdivided once and dented."""
    corners = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    corners = [tuple(size * c * draw.within(0.6, 1) for c in corner) for corner in corners]
    faces = [(a, b, c) if (i + j + k) % 2 == 0 else (a, c, b)
             for i, a in enumerate((1, 2)) for j, b in enumerate((3, 4)) for k, c in enumerate((5, 6))]
    return corners, faces


def obj(corners, faces, moved=(0, 0, 0)):
    lines = ["v " + " ".join(repr(c + m) for c, m in zip(corner, moved)) for corner in corners]
    return "\n".join(lines + ["f %d %d %d" % face for face in faces]) + "\n"


class Scene:
    """A scene and the files that it names."""

    def __init__(self, seed, parameters):
        self.draw = draw = Draw(seed, parameters)
        self.files = {}
        self.h = draw.one(0.02, 0.03, 0.05, 0.1, 10 ** draw.within(-4, 3))
        self.fall = math.sqrt(2 * self.h / G)  # s, to fall a cell
        self.speed = self.h / self.fall * draw.one(0, 1, 3, 10)
        self.frames = draw.random.randint(1, 4)
        self.fps = min(max(1 / (self.fall * draw.one(0.1, 0.3, 1)), 0.01), 1e5)
        self.materials = ["snow"] + ["other"] * draw.chance(0.5)
        self.scene = self.tables()

    def place(self, reach=5, low=1, high=7):
        within = self.draw.within
        return [self.h * within(-reach, reach), self.h * within(low, high), self.h * within(-reach, reach)]

    def file(self, suffix, text):
        name = f"file{len(self.files)}{suffix}"
        self.files[name] = text
        return name

    def shape(self, kind, cells, center):
        draw, h = self.draw, self.h
        size = lambda: h * cells * draw.within(0.4, 1)
        form = draw.one(*(["sphere", "box", "capsule", "cylinder", "cone", "torus", "mesh"] +
                          ["points"] * (kind == "body") + ["mesh_sequence"] * (kind == "collider")))
        table = {"center": center}
        if form == "sphere":
            table["radius"] = size()
        elif form == "box":
            table["size"] = [2 * size(), 2 * size(), 2 * size()]
        elif form == "capsule":
            table = {"a": center, "b": [c + size() for c in center], "radius": 0.6 * size()}
        elif form in ("cylinder", "cone"):
            table.update(radius=size(), height=2 * size())
        elif form == "torus":
            table.update(major_radius=1.5 * size(), minor_radius=0.4 * size())
        elif form == "mesh":
            table["file"] = self.file(".obj", obj(*octahedron(draw, h * cells)))
        elif form == "mesh_sequence":
            mesh = octahedron(draw, h * cells)
            number = len(self.files)
            for k in (1, 2, 3):
                self.files[f"deform{number}_{k}.obj"] = obj(*mesh, [self.draw.within(-h, h)] * 3)
            table.update(files=f"deform{number}_%d.obj", last=3, rate=self.fps)
        elif form == "points":
            rows = [self.place(cells, -cells, cells) for _ in range(draw.random.randint(20, 400))]
            table["file"] = self.file(".csv", "x,y,z\n" + "".join("%r,%r,%r\n" % tuple(row) for row in rows))
            table["spacing"] = 0.5 * h
        if draw.chance(0.4):
            table["rotation"] = [draw.within(-180, 180) for _ in range(3)]
        return {form: table}

    def motion(self):
        draw = self.draw
        table = {"velocity": [self.speed * draw.within(-1, 1) for _ in range(3)]}
        if draw.chance(0.3):
            table["angular_velocity"] = [draw.within(-1, 1) / self.fall for _ in range(3)]
        return table

    def snow(self, kind, number):
        draw = self.draw
        table = {"name": f"{kind}{number}", "material": draw.random.choice(self.materials),
                 "shape": self.shape(kind, draw.within(1, 3.5), self.place()), **self.motion()}
        own = ("name", "material", "velocity", "angular_velocity", "rate", "start", "end")
        table.update(draw.table(f"{kind}.NAME.", 0.3, own))
        if table.get("particles_per_cell", 8) > 30:
            table["particles_per_cell"] = 30.0
        if kind == "emitter" and draw.chance(0.8):
            table["rate"] = 400 * (2 * self.h) ** 2 * max(self.speed, self.h / self.fall) * draw.within(0.1, 2)
            if draw.chance(0.5):
                table["end"] = self.fall * draw.within(0.1, 5)
        return table

    def collider(self, number):
        draw = self.draw
        table = {"name": f"collider{number}", **draw.table("collider.NAME.", 0.3, ("name", "velocity", "angular_velocity"))}
        if number == 0 and draw.chance(0.8):
            table["shape"] = {"plane": {"point": [0, -self.h * draw.within(0, 2), 0],
                                        "normal": [draw.within(-0.5, 0.5), 1, draw.within(-0.5, 0.5)]}}
        else:
            table["shape"] = self.shape("collider", draw.within(1, 4), self.place(6, -3, 3))
        if draw.chance(0.3):
            table.update(self.motion())
        elif draw.chance(0.3) and "mesh_sequence" not in table["shape"]:
            table["keyframes"] = [{"time": self.fall * 3 * k, "position": self.place(6, -3, 3)}
                                  for k in range(draw.random.randint(1, 3))]
        return table

    def camera(self):
        table = self.draw.table("camera.", 0.15, ("eye", "target", "up", "follow", "orbit", "turntable"))
        if self.draw.chance(0.4):
            table.update(eye=self.place(30, 5, 30), target=self.place(2))
        return table

    def view(self, number, bodies):
        draw = self.draw
        table = {"name": f"view{number}", **draw.table("view.NAME.", 0.4, ("name",))}
        for part in ("particles", "smoke", "slice", "plots", "clip"):
            if draw.chance(0.35):
                table[part] = draw.table(f"view.NAME.{part}.", 0.3, ("follow", "point"))
        if draw.chance(0.3):
            table["camera"] = self.camera()
            if draw.chance(0.3):
                table["camera"]["follow"] = draw.random.choice(bodies)
        return table

    def export(self, number):
        table = {"name": f"export{number}",
                 **self.draw.table("export.NAME.", 0.4, ("name", "carried", "bodies", "every", "surface"))}
        if table.get("format") == "obj":
            table["surface"] = True
        return table

    def tables(self):
        draw = self.draw
        solver = draw.table("solver.", 0.25, ("cell_size", "dt", "max_dt", "gravity", "time_step", "bypass"))
        solver["cell_size"] = self.h
        if draw.chance(0.15):
            solver.update(time_step="fixed", dt=min(max(self.fall * draw.within(1e-3, 0.02), 1e-9), 1))
        if draw.chance(0.1):
            solver["bypass"] = draw.value("solver.bypass")
        materials = {}
        for name in self.materials:
            materials[name] = draw.table("material.NAME.", 0.3)
            if draw.chance(0.3):
                materials[name]["variation"] = draw.table("material.NAME.variation.", 0.7)
        bodies = [self.snow("body", k) for k in range(draw.random.randint(1, 3))]
        names = [body["name"] for body in bodies]
        views = [self.view(k, names) for k in range(draw.one(0, 1, 1, 2))]
        sinks = [{"name": "sink", "shape": self.shape("sink", 5, self.place(6, -8, 0)),
                  **draw.table("sink.NAME.", 0.2, ("name",))}] * draw.chance(0.2)
        return {
            "title": draw.value("title"), "frames": self.frames, "fps": self.fps,
            "first_frame": draw.one(0, 0, 1001, -3), "seed": draw.random.randint(0, 2 ** 40),
            "solver": solver, "material": materials, "camera": self.camera(),
            "light": draw.table("light.", 0.2), "burn_in": draw.table("burn_in.", 0.1),
            "output": {"size": draw.value("output.size")}, "body": bodies,
            "emitter": [self.snow("emitter", k) for k in range(draw.one(0, 0, 0, 1, 2))],
            "sink": sinks, "collider": [self.collider(k) for k in range(draw.random.randint(0, 3))],
            "view": views, "export": [self.export(k) for k in range(draw.one(0, 0, 1, 2))],
        }

    def text(self):
        return as_text(self.scene)
