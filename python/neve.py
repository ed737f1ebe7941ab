"""neve from Python: run scenes, read runs, states and sweeps as numpy arrays.

Needs numpy and the program; imports nothing else and has no binding of the library. The program is
`neve` of the environment variable NEVE, else that of this checkout or installation, else that in
PATH. Runs, states and sweeps show themselves in a notebook.

    import neve
    run = neve.render("scenes/snowball_drop.toml", coarsen=2)
    print(run["max_speed"])                  # one value per frame
    state = run.state(24)                    # arrays of all particles
    print(state["J_P"].min(), state.time)

docs/python.md has recipes.
"""

import base64
import csv
import difflib
import html
import json
import operator
import os
import pathlib
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import warnings
import zlib

import numpy as np


class NeveError(RuntimeError):
    """The program refused or failed: `code` is its exit code (docs/output.md), `where` and
    `hint` are the place and the advice of its message, `answer` is what it printed as JSON."""

    def __init__(self, message, code, where="", hint="", answer=None):
        text = f"{message}; {hint}" if hint and hint not in message else message
        super().__init__(f"{where}: {text}" if where and where not in text else text)
        self.code, self.where, self.hint, self.answer = code, where, hint, answer


def program():
    """Path of the program. The one that NEVE names is taken as it is."""
    if "NEVE" in os.environ:
        return os.environ["NEVE"]
    here = pathlib.Path(__file__).resolve().parent
    # The launcher of a checkout, share/neve/python beside bin, and the folder of an environment.
    for place in (here.parent / "neve", here.parents[min(2, len(here.parents) - 1)] / "bin" / "neve",
                  pathlib.Path(sys.prefix) / "bin" / "neve"):
        if place.is_file() and os.access(place, os.X_OK):
            return str(place)
    found = shutil.which("neve")
    if not found:
        raise FileNotFoundError("no program neve in PATH; set the environment variable NEVE to it")
    return found


def _end_of(child):
    """Waits for a program. After Ctrl-C it ends as in a terminal, with its movie and a checkpoint;
    a second one ends it at once. @return what it said, stdout and stderr"""
    try:
        return child.communicate()
    except KeyboardInterrupt:
        try:
            child.communicate(timeout=1)
        except subprocess.TimeoutExpired:
            # A terminal has asked the program too, a notebook may have asked Python alone. This one
            # asks who was not asked yet, and nobody twice.
            child.send_signal(signal.SIGHUP)
            child.communicate()
        raise
    finally:
        if child.poll() is None:
            child.kill()
            child.wait()


def _why(code, answer, lines):
    """Why the program ended with an exit code, in words. @param lines  of stderr"""
    if code < 0:
        return f"the program was ended by {signal.Signals(-code).name}"
    if "error" in answer:
        return answer["error"]
    said = [line.removeprefix("neve: ").removeprefix("error: ") for line in lines
            if line.startswith("neve: ") and not line.startswith("neve: warning: ")]
    if said:
        return "; ".join(said).replace("--resume", 'flags=("--resume",)')
    found = [one for name in ("findings", "flaws") for one in answer.get(name, ())
             if one.get("severity", "error") == "error"]
    if found:
        return "; ".join(f"{one.get('address') or one.get('file')}: {one['what']}"
                         + (f"; {one['hint']}" if one.get("hint") else "") for one in found)
    short = [f"{name} {value}" for name, value in answer.items()
             if isinstance(value, (bool, int, float, str))]
    return f"exit code {code}: {', '.join(short or lines[-1:]) or 'it said nothing'}"


def _call(arguments, results=(0,), level=3):
    """@param level  of the caller that a warning names"""
    child = subprocess.Popen([program(), *map(str, arguments), "--json"], text=True,
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    stdout, stderr = _end_of(child)
    try:
        answer = json.loads(stdout)
    except ValueError:
        answer = {}
    lines = stderr.strip().splitlines()
    if child.returncode in results:
        for line in lines:
            if line.startswith("neve: warning: "):
                warnings.warn(line.removeprefix("neve: warning: "), stacklevel=level)
        return answer
    error = answer if isinstance(answer, dict) else {}
    raise NeveError(_why(child.returncode, error, lines), child.returncode, error.get("where", ""),
                    error.get("hint", ""), answer)


def call(*arguments, results=(0,)):
    """Runs the program with --json and returns its answer, as in call("check", "scene.toml").

    Exit codes other than those in `results` raise NeveError, whose `answer` is the same."""
    return _call(arguments, results)


def _quoted(text):
    """A text of TOML without a quote inside, at which lists of values would be split."""
    return '"' + "\\u0022".join(json.dumps(part, ensure_ascii=False)[1:-1]
                                for part in text.split('"')) + '"'


def _literal(value, is_inside=False):
    """A value as --set takes it; inside of lists and tables words need quotes."""
    if value is None:
        return "none"
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple, np.ndarray)):
        return "[" + ", ".join(_literal(v, True) for v in value) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {_literal(v, True)}" for key, v in value.items()) + " }"
    if isinstance(value, str) and is_inside:
        return _quoted(value)
    return repr(value) if isinstance(value, (int, float)) else str(value)


def _value_of_axis(value):
    """One of a list of values: words that commas or brackets would split have quotes. What is in
    quotes or brackets already is TOML, as in --set."""
    if not isinstance(value, str) or re.fullmatch(r"""\[.*\]|\{.*\}|"[^"]*"|'[^']*'""", value):
        return _literal(value)
    is_plain = value == value.strip() and value and not re.search(r"""[][{}"',\n]""", value)
    return value if is_plain else _quoted(value)


def _axis(address, values):
    """Values as -p takes them: a list, or a rule such as {"linspace": [5, 20], "num": 4}."""
    if isinstance(values, dict):
        return f"{address}={_literal(values)}"
    if isinstance(values, str) or not np.iterable(values):
        raise TypeError(f"values of {address} are a list, as in {{{address!r}: [5, 10]}}, not "
                        f"{values!r}; a parameter that all runs share goes into set")
    return f"{address}=" + ",".join(map(_value_of_axis, values))


def _settings(table, start="", whole=()):
    """Addresses and values of a table, also of tables in it: {"solver": {"cfl": 0.2}} is
    {"solver.cfl": 0.2}. @param whole  addresses of tables that are values"""
    for key, value in table.items():
        address = f"{start}{key}"
        if isinstance(value, dict) and not value:
            raise ValueError(f"set has an empty table for {address}, which changes nothing; None "
                             "takes an object away")
        if isinstance(value, dict) and address not in whole:
            yield from _settings(value, f"{address}.", whole)
        else:
            yield address, value


def _objects(table, start=""):
    """Addresses of bodies, emitters, sinks and colliders that a table has with their shapes."""
    for key, value in table.items():
        if isinstance(value, dict):
            if "shape" in value:
                yield f"{start}{key}"
            yield from _objects(value, f"{start}{key}.")


def _refuse(function, others):
    """Words that are flags of the program, or parameters of a scene."""
    for name, value in others.items():
        raise TypeError(
            f"{function}() has no argument {name!r}; a parameter goes into set, as in "
            f'set={{"material.snow.hardening": 5}}, and a flag of the program into flags, as in '
            f"flags=(\"--{name.replace('_', '-')}\",)")


def _scene(scene):
    if not isinstance(scene, (str, os.PathLike)):
        raise TypeError(f"a scene is a TOML file, the folder of a run or a picture, not a "
                        f"{type(scene).__name__}; set changes its parameters")
    return scene


def _scene_flags(set, coarsen, threads, whole=()):
    if isinstance(set, str):
        set = [set]
    settings = [f"{address}={_literal(value)}" for address, value in _settings(set, whole=whole)] \
        if isinstance(set, dict) else [str(text) for text in set or ()]
    flags = [word for text in settings for word in ("--set", text)]
    if coarsen is not None:
        flags += ["--coarsen", coarsen]
    if threads is not None:
        flags += ["--threads", threads]
    return flags


def _lacks(address):
    """What the program says where a scene has no collider.NAME."""
    kind, _, name = address.partition(".")
    return f'there is no {kind} "{name}"'


def _call_scene(command, scene, rest, set, coarsen, threads, results=(0,)):
    """Calls a command on a scene. A table in `set` changes the object of its name, and adds it
    where the scene has none and the table has a shape."""
    added = []
    while True:
        flags = _scene_flags(set, coarsen, threads, added)
        try:
            return _call([command, scene, *flags, *rest], results, 4)
        except NeveError as error:
            lacking = [address for address in _objects(set if isinstance(set, dict) else {})
                       if address not in added and _lacks(address) in str(error)]
            if not lacking:
                raise
            added += lacking


def _frames(frames):
    """"3-9" of (3, 9), "3-9" or range(3, 10), "3-3" of 3."""
    if isinstance(frames, str):
        return frames
    numbers = [operator.index(number) for number in np.atleast_1d(frames)]
    is_pair = len(numbers) == 2 and not isinstance(frames, range)
    if not numbers or not (is_pair or numbers == list(range(numbers[0], numbers[-1] + 1))):
        raise ValueError(f"frames are one, or the first and the last of a range, not {frames!r}")
    return f"{numbers[0]}-{numbers[-1]}"


def _number(value):
    """None of JSON is not a number, also as a component of a vector."""
    if isinstance(value, list):
        return [_number(component) for component in value]
    return np.nan if value is None else value


def _table_html(rows, head=()):
    """Rows of texts and numbers as a table for a notebook."""
    def line(tag, row):
        return "".join(f"<{tag}>{html.escape(str(cell))}</{tag}>" for cell in row)
    body = "".join(f"<tr>{line('td', row)}</tr>" for row in rows)
    top = f"<tr>{line('th', head)}</tr>" if head else ""
    return f"<table>{top}{body}</table>"


def _png_html(png):
    if not png:
        return ""
    return f'<img style="max-width: 100%" src="data:image/png;base64,{base64.b64encode(png).decode()}">'


def _grey_png(values):
    """A PNG of one channel. @param values  0 to 255, the upper row first"""
    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))
    height, width = values.shape
    rows = np.zeros((height, width + 1), dtype="u1")  # each begins with its filter, none
    rows[:, 1:] = values
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(rows.tobytes())) + chunk(b"IEND", b""))


class State(dict):
    """Particles at one time: arrays by attribute, a row per particle. `time` is in seconds, `frame`
    is the number of the frame, with a fraction between two. Places and velocities are as in the
    file: the axis `up`, "y" or "z", points up, and a metre has `scale` units."""

    def __init__(self, arrays, time=np.nan, frame=np.nan, up="y", scale=1):
        super().__init__(arrays)
        self.time, self.frame = float(time), float(frame)
        self.up, self.scale = str(up), float(scale)

    @property
    def count(self):
        return len(self["x"])

    def _repr_png_(self):
        """The snow from the front, brighter where more of it lies behind a pixel."""
        if not len(self.get("x", ())):
            return None
        height = "xyz".index(self.up)
        x, y = self["x"][:, 0].astype("f8"), self["x"][:, height].astype("f8")
        across = max(np.ptp(x), np.ptp(y), 1e-9)
        size = int(np.clip(np.sqrt(len(x) / 2), 12, 400))  # cells with some particles each
        middle = [(a.min() + a.max()) / 2 for a in (x, y)]
        edges = [(m - 0.55 * across, m + 0.55 * across) for m in middle]
        mass = np.histogram2d(y, x, size, edges[::-1], weights=self.get("m"))[0][::-1]
        grey = (255 * np.sqrt(mass / mass.max())).astype("u1")
        zoom = max(1, 320 // size)
        return _grey_png(grey.repeat(zoom, axis=0).repeat(zoom, axis=1))

    def _repr_html_(self):
        rows = [(name, " x ".join(map(str, np.shape(a))), f"{np.min(a):.4g}", f"{np.mean(a):.4g}",
                 f"{np.max(a):.4g}") for name, a in self.items() if np.size(a)]
        head = ("attribute", "shape", "min", "mean", "max")
        return (f"<p>{self.count} particles at {self.time:.4g} s</p>" + _png_html(self._repr_png_())
                + _table_html(rows, head))


def read_npz(path):
    """A state that neve export wrote as npz."""
    with np.load(path) as archive:
        arrays = {name: archive[name] for name in archive.files}
    about = {name: arrays.pop(name) for name in ("time", "frame", "fps", "scale", "up")}
    return State(arrays, about["time"], about["frame"], about["up"], about["scale"])


def _joined(table):
    """x y z, vx vy vz and F_E_xx ... F_E_zz as arrays."""
    names = list(table.dtype.names)
    arrays = {}
    for what, parts in (("x", ["x", "y", "z"]), ("v", ["vx", "vy", "vz"])):
        if all(part in names for part in parts):
            arrays[what] = np.stack([table[part] for part in parts], axis=1)
            names = [name for name in names if name not in parts]
    for name in names:
        tensor = name[:-3]
        parts = [f"{tensor}_{a}{b}" for a in "xyz" for b in "xyz"]
        if name not in parts or not all(part in names for part in parts):
            arrays[name] = table[name]
        elif name == parts[0]:
            arrays[tensor] = np.stack([table[part] for part in parts], axis=1).reshape(-1, 3, 3)
    return arrays


def read_ply(path):
    """The points of a binary PLY file without lists, as neve export writes it."""
    with open(path, "rb") as file:
        if file.read(3) != b"ply":
            raise ValueError(f"{path}: no PLY file: it does not begin with \"ply\"")
    types = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4",
             "float": "f4", "double": "f8"}
    with open(path, "rb") as file:
        fields, count, order, about = [], 0, "<", {}
        for line in iter(file.readline, b""):
            words = line.decode("ascii", "replace").split()
            if words[:1] == ["end_header"]:
                break
            if words[:2] == ["format", "ascii"]:
                raise ValueError(f"{path}: an ASCII PLY file; expected a binary one, as neve export "
                                 "writes it")
            if words[:2] == ["property", "list"]:
                raise ValueError(f"{path}: a mesh, with lists of corners; expected points, as neve "
                                 "export writes them without --surface")
            if words[:1] == ["format"]:
                order = {"binary_little_endian": "<", "binary_big_endian": ">"}[words[1]]
            elif words[:2] == ["element", "vertex"]:
                count = int(words[2])
            elif words[:1] == ["property"]:
                fields.append((words[2], order + types[words[1]]))
            elif words[:2] == ["comment", "time"]:  # "comment time 0.125 s, frame 3"
                about["time"], about["frame"] = float(words[2]), float(words[5])
            elif words[:2] == ["comment", "up"]:  # "comment up y, units per metre 1"
                about["up"], about["scale"] = words[2].rstrip(","), float(words[6])
        table = np.fromfile(file, fields, count)
    if len(table) < count:
        raise ValueError(f"{path}: a part of a PLY file: its header promises {count} points, and "
                         f"there are {len(table)}")
    return State(_joined(table), **about)


def read_csv(path):
    """A state that neve export wrote as csv. Numbers are double; .astype("f4") makes the bits of
    a run in single precision of them, as the other formats have them."""
    rows = np.genfromtxt(path, delimiter=",", names=True, deletechars="")
    arrays = _joined(np.atleast_1d(rows))  # one row alone has no dimension
    about = {}
    for up in "yz":
        scale = arrays.pop(f"up_{up}_units_per_metre", ())
        if len(scale):
            about = {"up": up, "scale": scale[0]}
    return State(arrays, **about)


_readers = {"npz": read_npz, "ply": read_ply, "csv": read_csv}


class Export:
    """Files of one export in the order of their times: `times`, and states by index. `numbers` are
    those in the names of the files; `up` and `scale` are those of its states."""

    def __init__(self, folder, listed):
        self.folder, self.format = pathlib.Path(folder), listed["format"]
        self.attributes, self.up, self.scale = (listed[key] for key in ("attributes", "up", "scale"))
        self.files = [self.folder / file["file"] for file in listed["files"]]
        self.numbers = [file["number"] for file in listed["files"]]
        self.times = np.array([_number(file["time"]) for file in listed["files"]])
        # Of exports of earlier builds the number of the file.
        self.frames = np.array([_number(file.get("frame", file["number"])) for file in listed["files"]],
                               dtype=float)

    def __len__(self):
        return len(self.files)

    def __getitem__(self, index):
        if self.format not in _readers:
            raise NeveError(f"no reader of {self.format} here; expected npz, ply or csv", 2)
        state = _readers[self.format](self.files[index])
        state.time, state.frame = float(self.times[index]), float(self.frames[index])
        return state

    def __iter__(self):
        return (self[index] for index in range(len(self)))


def _exports_in(folder, listed):
    return {e["name"]: Export(folder, e) for e in listed.get("exports", [])}


class Run:
    """The folder of a run: run.json as `json`, its frames as arrays by name."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        if (self.folder / "data.csv").is_file() and not (self.folder / "run.json").is_file():
            raise ValueError(f"{self.folder} is the folder of a sweep: neve.Sweep({str(folder)!r})")
        with open(self.folder / "run.json", encoding="utf-8") as file:
            self.json = json.load(file)

    @property
    def status(self):
        return self.json["status"]

    @property
    def frames(self):
        """Numbers of the frames."""
        return np.array([frame["frame"] for frame in self.json["frames"]])

    @property
    def exports(self):
        """Exports of [[export]], by name."""
        return _exports_in(self.folder, self.json)

    def __getitem__(self, name):
        """A value of every frame, as in run["kinetic_energy"]: a number, a vector, text, or tables."""
        known = sorted(set().union(*self.json["frames"])) if self.json["frames"] else [name]
        if name not in known:
            raise KeyError(f"frames have no {name!r}; expected one of {', '.join(known)}")
        values = [_number(frame.get(name)) for frame in self.json["frames"]]
        # Of "dust" a frame has a table, of "forces" and "bodies" a list of them.
        if not any(isinstance(value[0] if value and isinstance(value, list) else value, dict)
                   for value in values):
            return np.array(values)
        rows = np.empty(len(values), dtype=object)
        for k, value in enumerate(values):
            rows[k] = value
        return rows

    def force(self, collider):
        """Force of the snow on a collider in every frame, N; not a number where there was no step."""
        rows = []
        # Frames without a step have no forces, and colliders may come during the run.
        named = re.findall(r'^\[\[collider\]\]\nname = "(.*)"', self.json["scene"], re.MULTILINE)
        known = sorted({f["collider"] for frame in self.json["frames"] for f in frame["forces"]}
                       | set(named))
        if collider not in known:
            raise KeyError(f"there is no collider {collider!r}; expected one of {', '.join(known)}"
                           if known else "the run has no colliders")
        for frame in self.json["frames"]:
            found = [f["force"] for f in frame["forces"] if f["collider"] == collider]
            rows.append(found[0] if found else [np.nan] * 3)
        return np.array(rows, dtype=float)

    def body(self, collider):
        """How a collider that moves by itself moves: position and rotation (degrees) as a keyframe
        has them, centre_of_mass, velocity, angular_velocity; a row a frame, not a number where it
        does not exist."""
        bodies = [{b["collider"]: b for b in frame.get("bodies", [])} for frame in self.json["frames"]]
        known = sorted(set().union(*bodies))
        if collider not in known:
            raise KeyError(f"no body {collider!r} moves by itself; expected one of {', '.join(known)}"
                           if known else "no collider of this run moves by itself")
        names = ("position", "rotation", "centre_of_mass", "velocity", "angular_velocity")
        return {name: np.array([[_number(x) for x in frame[collider][name]] if collider in frame
                                else [np.nan] * 3 for frame in bodies], dtype=float)
                for name in names}

    def picture(self, frame=None, view=None):
        """Path of a picture: of a frame, or of the last one; of a view, or of the first one."""
        view = view or self.json["views"][0]
        if frame is None:
            # A view may have been drawn of some frames alone.
            frame = (self.json.get("view_frames", {}).get(view) or self.frames)[-1]
        return self.folder / view / f"{int(frame):04d}.png"

    def _repr_png_(self):
        file = self.picture() if len(self.frames) and self.json["views"] else None
        return file.read_bytes() if file and file.is_file() else None

    def _repr_html_(self):
        rows = [("folder", self.folder), ("status", self.status), ("frames", len(self.frames))]
        if len(self.frames):
            last = self.json["frames"][-1]
            rows += [(name, last[name]) for name in ("frame", "time", "particles", "max_speed")]
        rows += [("warning", text) for text in self.json.get("warnings", [])]
        return _png_html(self._repr_png_()) + _table_html(rows)

    def state(self, frame, attributes=("id", "x", "v", "m", "V0", "J_P", "density", "radius")):
        """The particles at a frame: as the run kept them, or simulated from the nearest state before it."""
        first = self.json.get("first_number", 0)
        last = int(self.frames[-1]) if len(self.frames) else first
        if not isinstance(frame, (int, np.integer)):
            raise ValueError(
                f"a state is that of a frame, a number from {first} to {last}, not {frame!r}")
        if not first <= frame <= last:
            raise ValueError(f"there is no frame {frame}: the run has {first} to {last}")
        with tempfile.TemporaryDirectory() as folder:
            states = export(self.folder, folder, frames=frame, attributes=attributes)
            return states["npz"][0]


def render(scene, out=None, set=None, frames=None, coarsen=None, threads=None, flags=(), **others):
    """Simulates and draws a scene, into the folder `out`, else where the command line does: out/NAME
    (NEVE_OUT/NAME), or the run itself where `scene` is the folder of a run. `set` has parameters by
    address, as in {"material.snow.hardening": 5}, as tables in tables, or as texts of --set; None
    removes an object, and a table with a shape adds the one that the scene lacks. `flags` are passed
    on as they are. A run that diverges is returned, with the status "diverged". What the program
    warns of is a warning."""
    _refuse("render", others)
    words = [*flags]
    if out is not None:
        words += ["--out", out]
    if frames is not None:
        words += ["--frames", _frames(frames)]
    answer = _call_scene("render", _scene(scene), words, set, coarsen, threads, results=(0, 5))
    # A run that diverged names its folder in its advice.
    return Run(answer.get("out") or answer["hint"].partition("diverged_*.png are in ")[2])


def export(source, out, formats=("npz",), frames=None, at=None, attributes=None, set=None,
           coarsen=None, threads=None, flags=()):
    """Writes the particles of a scene, of a run (a Run or its folder) or of a picture into a folder,
    in one simulation. @return exports by format"""
    source = source.folder if isinstance(source, Run) else source
    formats = [formats] if isinstance(formats, str) else formats
    words = ["--out", out, "--format", ",".join(formats), *flags]
    if frames is not None:
        words += ["--frames", _frames(frames)]
    if at is not None:
        words += ["--at", ",".join(repr(float(time)) for time in np.atleast_1d(at))]
    if attributes is not None:
        names = [attributes] if isinstance(attributes, str) else attributes
        words += ["--attributes", ",".join(names)]
    return _exports_in(out, _call_scene("export", source, words, set, coarsen, threads))


class Sweep:
    """The folder of a sweep: data.csv as arrays by column, and its runs. With seeds, `points` has
    points.csv in the same way: mean, min and max of each metric at each point."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.table = _table(self.folder / "data.csv")
        self.columns = list(self.table)
        points = self.folder / "points.csv"
        self.points = _table(points) if points.is_file() else None

    def __len__(self):
        return len(self.table["run"])

    def __getitem__(self, column):
        """A column: numbers where all of it is, else text; "-" is not a number."""
        if column not in self.table:
            near = difflib.get_close_matches(str(column), self.columns, 1)
            raise KeyError(f"there is no column {column!r}; " +
                           (f"did you mean {near[0]!r}?" if near else
                            f"expected one of {', '.join(self.columns)}"))
        return self.table[column]

    def _repr_png_(self):
        file = self.folder / "sheet.png"
        return file.read_bytes() if file.is_file() else None

    def _repr_html_(self):
        rows = list(zip(*self.table.values()))
        return _png_html(self._repr_png_()) + _table_html(rows, self.columns)

    def run(self, index):
        """The run of a row."""
        # Its folder has another number where the sweep has grown.
        return Run(self.folder / pathlib.Path(self["FILE_scene"][index]).parent)


def _table(path):
    with open(path, newline="", encoding="utf-8") as file:
        head, *rows = list(csv.reader(file))
    return {name: _column([row[k] for row in rows]) for k, name in enumerate(head)}


_number_of_table = re.compile(
    r"[-+]?(([0-9]+\.?[0-9]*|\.[0-9]+)(e[-+]?[0-9]+)?|inf|infinity|nan)", re.IGNORECASE)


def _column(words):
    if all(word in ("", "-") or _number_of_table.fullmatch(word) for word in words):
        return np.array([np.nan if word in ("", "-") else float(word) for word in words])
    return np.array([_text_of_cell(word) for word in words])


def _text_of_cell(word):
    """Texts that a reader may take for a number or a formula, and empty ones, have quotes."""
    inside = word[1:-1]
    is_marked = len(word) > 1 and word[0] == word[-1] == "'" and \
        (not inside or inside[0] in "=@+-\t\r" or _number_of_table.fullmatch(inside))
    return inside if is_marked else word


def sweep(file, out, parameters=None, set=None, frames=None, coarsen=None, threads=None, seeds=None,
          flags=()):
    """Runs a sweep file, or a scene with many values: `parameters` has lists by address, as in
    {"material.snow.hardening": [5, 10]}, or rules, as in {"linspace": [5, 20], "num": 4}; `seeds` is
    the number of runs of each point. Failed runs are rows of the table."""
    words = ["--out", out, *flags]
    for address, values in (parameters or {}).items():
        words += ["-p", _axis(address, values)]
    if frames is not None:
        words += ["--frames", _frames(frames)]
    if seeds is not None:
        words += ["--seeds", str(int(seeds))]
    _call_scene("sweep", file, words, set, coarsen, threads, results=(0, 7))
    return Sweep(out)


def check(scene, set=None, coarsen=None):
    """The forecast of neve check: particles, memory_bytes, dt_limits, warnings ... A scene that
    fails the check has it too, with the reason in its `findings`."""
    return _call_scene("check", scene, (), set, coarsen, None, results=(0, 9))


def info(path):
    """The record of a picture or of a run."""
    return _call(["info", path])


def params():
    """Every parameter: address, type, unit, min, max, default, help."""
    return _call(["params"])
