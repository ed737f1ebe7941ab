"""Random valid scenes, from what `neve params --json` says of every parameter.

Lengths are drawn in cells, so that scenes of any size have some hundred particles, and times in the
time to fall a cell. What has no range in the descriptions (which tables there are, where things are,
files) is drawn here; everything else is drawn from its description, near its default or anywhere in
its range, so that a parameter that is new is in the soak without another word.
"""

import math

import files
from draw import Draw, as_text

G = 9.81
# Of a collider that moves by itself.
BODY = ("density", "mass", "inertia", "hold", "joint", "joint_point", "joint_axis", "joint_stiffness",
        "joint_damping", "spring_place", "spring_stiffness", "spring_damping", "restitution")


class Scene:
    """A scene and the files that it names."""

    def __init__(self, seed, parameters):
        self.draw = draw = Draw(seed, parameters)
        self.files = {}
        self.h = draw.one(0.02, 0.03, 0.05, 0.1, 10 ** draw.within(-4, 3))
        self.fall = math.sqrt(2 * self.h / G)  # s, to fall a cell
        self.speed = self.h / self.fall * draw.one(0, 1, 3, 10)
        self.frames = draw.random.randint(1, 3)
        self.handles = draw.one(0, 0, 0, 1)
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
            corners, faces = files.octahedron(draw, h * cells)
            is_open = kind != "collider" and draw.chance(0.2)
            table["file"] = self.file(".obj", files.obj(corners, faces[is_open:]))
            table["fill"] = draw.one("auto", "winding", *["closed", "even_odd"] * (not is_open))
        elif form == "mesh_sequence":
            number, last = len(self.files), draw.random.randint(2, 4)
            for k, text in enumerate(files.deforming(draw, h * cells, last)):
                self.files[f"deform{number}_{k + 1}.obj"] = text
            table.update(files=f"deform{number}_%d.obj", last=last, rate=self.fps * draw.one(0.3, 1, 2),
                         start=draw.one(0, 1 / self.fps))
        elif form == "points":
            spacing = 0.5 * h
            places = [self.place(cells, -cells, cells) for _ in range(draw.random.randint(20, 200))]
            table["file"] = self.file(*files.points(draw, places, spacing, self.speed))
            table.update(spacing=spacing, thinning=draw.one(1, 1, 2.5))
        if draw.chance(0.4):
            table["rotation"] = [draw.within(-180, 180) for _ in range(3)]
        return {form: table}

    def cover(self, terrain):
        """Snow on a terrain."""
        draw, h = self.draw, self.h
        table = {"on": terrain, "depth": h * draw.within(0.7, 3), "center": [h * draw.within(-1, 1), 0, h * draw.within(-1, 1)]}
        if draw.chance(0.5):
            table["radius"] = h * draw.within(1, 2)
        else:
            table.update(width=h * draw.within(1, 3), length=h * draw.within(1, 3))
        return {"cover": table}

    def motion(self):
        draw = self.draw
        table = {"velocity": [self.speed * draw.within(-1, 1) for _ in range(3)]}
        if draw.chance(0.3):
            table["angular_velocity"] = [draw.within(-1, 1) / self.fall for _ in range(3)]
        return table

    def material(self):
        draw = self.draw
        table = draw.table("material.NAME.", 0.3)
        if draw.chance(0.6):
            table["model"] = draw.one("snow", "cam_clay", "sand")
        if draw.chance(0.3):
            table["variation"] = draw.table("material.NAME.variation.", 0.7)
            # No particle may be allowed to be compressed to nothing.
            table["critical_compression"] = min(0.04, table.get("critical_compression", 1))
        return table

    def snow(self, kind, number, colliders=()):
        draw = self.draw
        terrains = [collider["name"] for collider in colliders if "terrain" in collider["shape"]]
        if terrains and kind == "body" and draw.chance(0.7):
            shape = self.cover(terrains[0])
        else:
            shape = self.shape(kind, draw.within(0.8, 2.5), self.place())
        table = {"name": f"{kind}{number}", "material": draw.random.choice(self.materials), "shape": shape, **self.motion()}
        own = ("name", "material", "velocity", "angular_velocity", "rate", "start", "end")
        table.update(draw.table(f"{kind}.NAME.", 0.3, own))
        if table.get("particles_per_cell", 8) > 20:
            table["particles_per_cell"] = 20.0
        if kind == "emitter":
            table["start"] = self.fall * draw.one(0, 0, draw.within(0, 1))
            if draw.chance(0.8):
                table["rate"] = min(1e9, 400 * (2 * self.h) ** 2 * max(self.speed, self.h / self.fall) * draw.within(0.1, 2))
            if "rate" in table and draw.chance(0.5):
                table["end"] = table["start"] + self.fall * draw.within(0.1, 5)
        return table

    def collider(self, number):
        draw = self.draw
        table = {"name": f"collider{number}", **draw.table("collider.NAME.", 0.3, ("name", "velocity", "angular_velocity", *BODY))}
        if number == 0 and draw.chance(0.2):
            suffix, content, keys = files.terrain(draw, self.h)
            table["shape"] = {"terrain": {"file": self.file(suffix, content), **keys}}
            return table
        if number == 0 and draw.chance(0.8):
            table["shape"] = {"plane": {"point": [0, -self.h * draw.within(0, 2), 0],
                                        "normal": [draw.within(-0.5, 0.5), 1, draw.within(-0.5, 0.5)]}}
        else:
            table["shape"] = self.shape("collider", draw.within(1, 4), self.place(6, -3, 3))
        if draw.chance(0.3):
            table.update(self.motion())
        elif draw.chance(0.3):
            table["keyframes"] = [{"time": self.fall * 3 * k, "position": self.place(6, -3, 3),
                                   "rotation": [draw.within(-40, 40) for _ in range(3)]}
                                  for k in range(draw.random.randint(1, 3))]
        return table

    def let_move(self, colliders, solver):
        """Some colliders become bodies that move by themselves."""
        draw = self.draw
        if solver.get("contact_at") == "nodes":
            return
        for collider in colliders:
            if collider["shape"].keys() & {"plane", "terrain", "mesh_sequence"} or draw.chance(0.5):
                continue
            collider.pop("keyframes", None)
            collider["density"] = 10 ** draw.within(0, 4)
            if draw.chance(0.3):
                collider["hold"] = draw.value("collider.NAME.hold")
            collider["joint"] = joint = draw.one("none", "none", "ball", "hinge", "slider")
            if joint != "none":
                collider.update(joint_point=self.place(6, -3, 3), joint_axis=[draw.within(-1, 1), draw.within(-1, 1), 1])
            weight = collider["density"] * (3 * self.h) ** 3 * G
            if joint in ("hinge", "slider") and draw.chance(0.5):
                collider.update(joint_stiffness=weight * draw.within(0, 10), joint_damping=weight * draw.within(0, 1))
            if draw.chance(0.2):
                collider.update(spring_place=self.place(), spring_stiffness=min(weight / self.h * draw.within(0, 10), 1e15))

    def camera(self, bodies):
        draw = self.draw
        table = draw.table("camera.", 0.15, ("eye", "target", "up", "follow", "orbit", "turntable"))
        if draw.chance(0.4):
            table.update(eye=self.place(30, 5, 30), target=self.place(2))
        motion = draw.one(None, None, None, "orbit", "turntable", "keyframes", "follow")
        if motion in ("orbit", "turntable"):
            table[motion] = {"orbit": 90, "turntable": 10 * self.fall}[motion] * draw.within(0.1, 3)
        elif motion == "keyframes":
            table["keyframes"] = [{"time": self.fall * k, "eye": self.place(30, 5, 30), "target": self.place(2)}
                                  for k in range(draw.random.randint(1, 3))]
        elif motion == "follow":
            table["follow"] = draw.random.choice(bodies)
        return table

    def view(self, number, bodies):
        draw = self.draw
        table = {"name": f"view{number}", **draw.table("view.NAME.", 0.4, ("name",))}
        for part in ("particles", "smoke", "slice", "plots", "clip"):
            if draw.chance(0.35):
                table[part] = draw.table(f"view.NAME.{part}.", 0.3, ("follow", "point"))
        if draw.chance(0.3):
            table["camera"] = self.camera(bodies)
        return table

    def export(self, number, emitters):
        table = {"name": f"export{number}",
                 **self.draw.table("export.NAME.", 0.4, ("name", "carried", "bodies", "every", "surface"))}
        if table.get("format") == "obj":
            table["surface"] = True
        if len(emitters) > 1:  # the state does not say from which of them a particle comes
            table["attributes"] = [name for name in table.get("attributes", ["id"]) if name not in ("body", "age")]
        return table

    def solver(self):
        draw = self.draw
        table = draw.table("solver.", 0.25, ("cell_size", "dt", "max_dt", "gravity", "time_step", "bypass"))
        table["cell_size"] = self.h
        if draw.chance(0.15):
            table.update(time_step="fixed", dt=min(max(self.fall * draw.within(1e-3, 0.02), 1e-9), 1))
        if draw.chance(0.1):
            table["bypass"] = draw.value("solver.bypass")
        return table

    def tables(self):
        draw = self.draw
        colliders = [self.collider(k) for k in range(draw.random.randint(0, 3))]
        bodies = [self.snow("body", k, colliders) for k in range(draw.one(1, 1, 2, 3))]
        names = [body["name"] for body in bodies]
        views = [self.view(k, names) for k in range(draw.one(0, 1, 1, 2))]
        mosaic = {"name": "all", "views": [view["name"] for view in views], "columns": draw.one(0, 1, 2), "width": draw.random.randint(64, 300)}
        emitters = [self.snow("emitter", k) for k in range(draw.one(0, 0, 0, 1, 2))]
        sinks = [{"name": "sink", "shape": self.shape("sink", 5, self.place(6, -8, 0)),
                  **draw.table("sink.NAME.", 0.2, ("name",))}] * draw.chance(0.2)
        scene = {
            "title": draw.value("title"), "frames": self.frames, "fps": self.fps,
            "first_frame": draw.one(0, 0, 1001, -3), "handles": self.handles, "seed": draw.random.randint(0, 2 ** 40),
            "solver": self.solver(), "material": {name: self.material() for name in self.materials},
            "camera": self.camera(names), "light": draw.table("light.", 0.2),
            "shot": draw.table("shot.", 0.1, ("time_code",)), "burn_in": draw.table("burn_in.", 0.1),
            "output": {"size": draw.value("output.size")}, "body": bodies,
            "emitter": emitters,
            "sink": sinks, "collider": colliders, "view": views, "mosaic": [mosaic] * (len(views) > 1),
            "export": [self.export(k, emitters) for k in range(draw.one(0, 0, 1, 2))],
        }
        self.let_move(colliders, scene["solver"])
        return scene

    def first(self):
        return self.scene["first_frame"] - self.handles

    def last(self):
        return self.scene["first_frame"] + self.frames + self.handles

    def duration(self):
        return (self.last() - self.first()) / self.fps

    def live_change(self):
        names = {key: [item["name"] for item in self.scene[key]] for key in ("collider", "view") if self.scene[key]}
        return self.draw.live_change({"material": self.materials, **names})

    def text(self):
        return as_text(self.scene)
