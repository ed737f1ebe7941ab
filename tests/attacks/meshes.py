"""Meshes: behind, in and across one another, without volume, of huge and of no numbers, and files that lie."""
import math
import random
import struct

import harness
from harness import SCENE

BOX = ((1, 4, 3, 2), (5, 6, 7, 8), (1, 2, 6, 5), (2, 3, 7, 6), (3, 4, 8, 7), (4, 1, 5, 8))
TETRAHEDRON = ((1, 3, 2), (1, 2, 4), (2, 3, 4), (3, 1, 4))


class Obj:
    """Closed parts, one after the other."""

    def __init__(self):
        self.lines, self.count = [], 0

    def add(self, vertices, faces):
        self.lines += ["v %.17g %.17g %.17g" % tuple(v) for v in vertices]
        self.lines += ["f " + " ".join(str(k + self.count if k > 0 else k) for k in face) for face in faces]
        self.count += len(vertices)
        return self

    def box(self, low, high, turn=lambda v: v):
        (a, b, c), (d, e, f) = low, high
        return self.add([turn(v) for v in ((a, b, c), (d, b, c), (d, e, c), (a, e, c),
                                           (a, b, f), (d, b, f), (d, e, f), (a, e, f))], BOX)

    def text(self):
        return "\n".join(self.lines) + "\n"


def turned(angle, tilt=0.0):
    c, s, d, t = math.cos(angle), math.sin(angle), math.cos(tilt), math.sin(tilt)

    def turn(v):
        x, y, z = c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]
        return x, d * y - t * z, t * y + d * z

    return turn


def ball(obj, radius, rings, center=(0, 0, 0), inward=False):
    around = 2 * rings
    vertices = [(0, radius, 0)]
    for i in range(1, rings):
        for j in range(around):
            p, t = math.pi * i / rings, 2 * math.pi * j / around
            vertices.append((radius * math.sin(p) * math.cos(t), radius * math.cos(p), radius * math.sin(p) * math.sin(t)))
    vertices.append((0, -radius, 0))
    at = lambda i, j: 2 + (i - 1) * around + j % around
    last = 2 + (rings - 1) * around
    faces = []
    for j in range(around):
        faces.append((1, at(1, j + 1), at(1, j)))
        faces += [(at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)) for i in range(1, rings - 1)]
        faces.append((last, at(rings - 1, j), at(rings - 1, j + 1)))
    if inward:
        faces = [face[::-1] for face in faces]
    return obj.add([tuple(v[k] + center[k] for k in range(3)) for v in vertices], faces)


def stl(count, triangles):
    return bytes(80) + struct.pack("<I", count) + b"".join(
        struct.pack("<12fH", 0, 0, 0, *[x for v in t for x in v], 0) for t in triangles)


def ply(header, body=b""):
    return ("ply\nformat binary_little_endian 1.0\n" + header + "end_header\n").encode() + body


def shapes():
    """Name and text of closed and other meshes about 1 m across."""
    rng = random.Random(54)
    dice = lambda: rng.uniform(-1, 1)

    obj = Obj()
    for k in range(800):
        obj.box((-1, -1, k * 1e-3), (1, 1, k * 1e-3 + 5e-4), turned(0.7, 0.6))
    yield "slabs behind one another, tilted", obj.text()
    obj = Obj()
    for k in range(90):
        obj.box((-1, -1, -0.01), (1, 1, 0.01), turned(k * 0.07, k * 0.035))
    yield "plates through one axis", obj.text()
    obj = Obj()
    for k in range(40):
        for axis in range(3):
            low, high = [-1, -1, -1], [1, 1, 1]
            low[axis], high[axis] = -1 + k * 0.05, -1 + k * 0.05 + 0.02
            obj.box(low, high)
    yield "walls across one another", obj.text()
    obj = Obj()
    for k in range(300):
        obj.box((-1, -1, -1), (1, 1, 1), turned(k * 0.013, k * 0.007))
    yield "boxes in one another, turned", obj.text()
    obj = Obj()
    for k in range(150):
        ball(obj, 1 - 0.004 * k, 8, inward=k % 2 == 1)
    yield "balls in one another, in and out", obj.text()
    obj = Obj()
    for k in range(20000):
        obj.add([(dice(), dice(), dice()) for _ in range(4)], TETRAHEDRON)
    yield "20 000 thin solids across one another", obj.text()
    obj = Obj()
    for k in range(2000):
        obj.box((-1, -1, -1), (1, 1, 1))
    yield "2000 boxes at one place", obj.text()
    obj = Obj()
    for k in range(2000):
        e = k * 1e-7
        obj.box((-1 - e, -1 - e, -1 - e), (1 + e, 1 + e, 1 + e))
    yield "2000 boxes nearly at one place", obj.text()
    obj = Obj()
    for k in range(15000):
        c = [dice(), dice(), dice()]
        obj.add([tuple(c[i] + 1e-4 * dice() for i in range(3)) for _ in range(4)], TETRAHEDRON)
    yield "15 000 crumbs apart", obj.text()
    obj = Obj()
    n = 60000
    obj.add([(0, 0, -1), (0, 0, 1)] + [(math.cos(2 * math.pi * k / n), math.sin(2 * math.pi * k / n), 0) for k in range(n)],
            [(1, 2, 3 + k) for k in range(n)])
    yield "60 000 faces at one edge", obj.text()
    obj = Obj()
    obj.add([(0, 1, 0), (0, -1, 0)] + [(math.cos(2 * math.pi * k / n), 0, math.sin(2 * math.pi * k / n)) for k in range(n)],
            [(1, 3 + (k + 1) % n, 3 + k) for k in range(n)] + [(2, 3 + k, 3 + (k + 1) % n) for k in range(n)])
    yield "60 000 faces at one vertex", obj.text()
    obj = Obj()
    obj.box((-1, -1, -1), (1, 1, 1))
    obj.add([(0.5, 0.5, 0.5)] * 50000, [(k + 1, k + 2, k + 3) for k in range(49997)])
    yield "50 000 equal vertices", obj.text()
    obj = Obj()
    obj.box((-1, -1, -1), (1, 1, 1))
    obj.add([(k * 1e-5, 0, 0) for k in range(50000)], [(k + 1, k + 2, k + 3) for k in range(49997)])
    yield "50 000 faces on one line", obj.text()
    obj = Obj()
    obj.box((-1, -1, -1), (1, 1, 1))
    obj.lines += ["f 1 2 3", "f 3 2 1"] * 60000
    yield "one face 120 000 times, from both sides", obj.text()
    obj = Obj()
    obj.box((-1, -1, -1), (1, 1, 1))
    obj.lines += ["f 1 2 3"] * 60000
    yield "one face 60 000 times", obj.text()
    obj = Obj()
    for k in range(40000):
        c = [dice(), dice(), dice()]
        obj.add([tuple(c[i] + 0.1 * dice() for i in range(3)) for _ in range(3)], [(1, 2, 3)])
    yield "40 000 loose faces", obj.text()
    obj = Obj()
    n = 150
    vertices = [(2 * i / n - 1, 0.1 * dice(), 2 * j / n - 1) for j in range(n + 1) for i in range(n + 1)]
    at = lambda i, j: j * (n + 1) + i + 1
    obj.add(vertices, [(at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)) for j in range(n) for i in range(n) if (i + j) % 2])
    yield "a chequered sheet of holes", obj.text()
    obj = Obj()
    for k in range(400):
        a = 2 * math.pi * k / 400
        obj.add([(math.cos(a), math.sin(a), 0), (1e6 * math.cos(a + 1), 1e6 * math.sin(a + 1), 1),
                 (math.cos(a), math.sin(a), 1e-6), (math.cos(a) + 1e-6, math.sin(a), 0)], TETRAHEDRON)
    yield "needles of 1000 km", obj.text()
    n = 3000
    star = [((1 if k % 2 else 0.2) * math.cos(7 * math.pi * k / n), (1 if k % 2 else 0.2) * math.sin(7 * math.pi * k / n)) for k in range(n)]
    yield "a star that winds seven times", Obj().add([(x, y, 0) for x, y in star] + [(x, y, 0.3) for x, y in star],
        [tuple(range(n, 0, -1)), tuple(range(n + 1, 2 * n + 1))] + [(k + 1, (k + 1) % n + 1, (k + 1) % n + 1 + n, k + 1 + n) for k in range(n)]).text()
    n = 20000
    arm = [((0.1 + 0.9 * k / n) * math.cos(60 * k / n), (0.1 + 0.9 * k / n) * math.sin(60 * k / n)) for k in range(n)]
    spiral = arm + [(x * 1.02, y * 1.02) for x, y in reversed(arm)]
    m = len(spiral)
    yield "a spiral of 40 000 corners", Obj().add([(x, y, 0) for x, y in spiral] + [(x, y, 0.3) for x, y in spiral],
        [tuple(range(m, 0, -1)), tuple(range(m + 1, 2 * m + 1))] + [(k + 1, (k + 1) % m + 1, (k + 1) % m + 1 + m, k + 1 + m) for k in range(m)]).text()
    comb = [(k / n, 0.0 if k % 2 else 0.9) for k in range(n)] + [(1, -0.1), (0, -0.1)]
    m = len(comb)
    yield "a comb of 20 000 teeth", Obj().add([(x, y, 0) for x, y in comb] + [(x, y, 0.3) for x, y in comb],
        [tuple(range(m, 0, -1)), tuple(range(m + 1, 2 * m + 1))] + [(k + 1, (k + 1) % m + 1, (k + 1) % m + 1 + m, k + 1 + m) for k in range(m)]).text()
    equal = [(0.3, 0.3)] * 20000 + [(1, 0), (0, 1)]
    m = len(equal)
    yield "a polygon of equal corners", Obj().add([(x, y, 0) for x, y in equal] + [(x, y, 0.3) for x, y in equal],
        [tuple(range(m, 0, -1)), tuple(range(m + 1, 2 * m + 1))] + [(k + 1, (k + 1) % m + 1, (k + 1) % m + 1 + m, k + 1 + m) for k in range(m)]).text()
    for size in (1e30, 1e300, 1e-30, 1e-300, 5e-324):
        yield f"a box of {size:g}", Obj().box((-size, -size, -size), (size, size, size)).text()
    yield "a box far away", Obj().box((1e12, 1e12, 1e12), (1e12 + 1, 1e12 + 1, 1e12 + 1)).text()
    yield "a box and a far vertex", Obj().box((-1, -1, -1), (1, 1, 1)).add([(1e15, 0, 0)], []).text()
    yield "a sheet of 1e-9", Obj().box((-1, -1e-9, -1), (1, 0, 1)).text()
    for word in ("nan", "inf", "-inf", "1e999", "0x1p5", "1,5", ""):
        yield f"a vertex of '{word}'", Obj().box((-1, -1, -1), (1, 1, 1)).text().replace("v -1", "v " + word, 1)
    for face in ("f 1", "f 1 1 1", "f 1 2", "f 0 1 2", "f 99 1 2", "f -99 1 2", "f 9999999999999999999 1 2", "f 1/2/3/4 2 3",
                 "f " + "1 " * 200000, "f 1.5 2 3", "f"):
        yield f"a face '{face[:20]}'", Obj().box((-1, -1, -1), (1, 1, 1)).text() + face + "\n"


def files():
    """Name, name of the file and bytes of files that say other than they hold."""
    box = Obj().box((-1, -1, -1), (1, 1, 1)).text()
    yield "a line of 20 MB", "m.obj", box + "# " + "x" * 20_000_000
    yield "a million groups", "m.obj", "o a\ng b\ns off\n" * 330_000 + box
    yield "a million continued lines", "m.obj", "\\\n" * 1_000_000 + box
    yield "a name with escapes", "m.obj", "o \x1b]0;x\x07\n" + "v \x1b[31m 0 0\n" + box
    yield "a million vertices, no face", "m.obj", "v 0 0 0\n" * 1_000_000
    yield "STL of 4 billion faces", "m.stl", stl(2**32 - 1, [((0, 0, 0), (1, 0, 0), (0, 1, 0))])
    yield "STL of no number", "m.stl", stl(4, [((math.nan, 0, 0), (1, 0, 0), (0, math.inf, 0))] * 4)
    yield "STL of 100 000 equal faces", "m.stl", stl(100_000, [((0, 0, 0), (1, 0, 0), (0, 1, 0))] * 100_000)
    yield "STL of largest floats", "m.stl", stl(4, [((3e38, -3e38, 3e38), (-3e38, 3e38, 3e38), (3e38, 3e38, -3e38))] * 4)
    yield "STL in words without an end", "m.stl", "solid x\n" + "facet normal 0 0 1\nouter loop\n" * 300_000
    xyz = "property float x\nproperty float y\nproperty float z\n"
    yield "PLY of 1e18 vertices", "m.ply", ply(f"element vertex 1000000000000000000\n{xyz}element face 1\nproperty list uchar int vertex_indices\n")
    yield "PLY of -1 vertices", "m.ply", ply(f"element vertex -1\n{xyz}element face 1\nproperty list uchar int vertex_indices\n")
    yield "PLY of a list of 4 billion", "m.ply", ply(f"element vertex 3\n{xyz}element face 1\nproperty list uint int vertex_indices\n", bytes(36) + struct.pack("<I", 2**32 - 1) + bytes(400))
    yield "PLY of 100 000 properties", "m.ply", ply("element vertex 1\n" + "".join(f"property float p{k}\n" for k in range(100_000)) + xyz)
    yield "PLY of 100 000 elements", "m.ply", ply("".join(f"element e{k} 0\nproperty float x\n" for k in range(100_000)) + f"element vertex 1\n{xyz}")
    yield "PLY of elements without size", "m.ply", ply(f"element vertex 3\n{xyz}element nothing 9000000000000000000\nelement face 1\nproperty list uchar int vertex_indices\n", bytes(400))
    yield "PLY of strips of 300 000", "m.ply", ply(f"element vertex 3\n{xyz}element tristrips 1\nproperty list int int vertex_indices\n",
        struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0) + struct.pack("<I", 300_000) + struct.pack("<3i", 0, 1, 2) * 100_000)
    yield "no mesh", "m.obj", b"\x00" * 1_000_000
    yield "nothing", "m.obj", b""


def scene_of(kind, file):
    mesh = f'shape = {{ mesh = {{ file = "{file}", scale = 0.2, center = [0, 0.3, 0] }} }}\n'
    if kind == "body":
        return SCENE.replace('shape = { sphere = { center = [0, 0.3, 0], radius = 0.12 } }\n', mesh)
    if kind == "rigid":
        return SCENE + "[[collider]]\nname = \"mesh\"\ndensity = 700\n" + mesh
    if kind == "cover":
        return SCENE + "[[collider]]\nname = \"mesh\"\n" + mesh + "[[body]]\nname = \"cap\"\nshape = { cover = { on = \"mesh\", depth = 0.1, radius = 0.1 } }\n"
    if kind == "emitter":
        return SCENE + "[[emitter]]\nname = \"mesh\"\nrate = 1\nvelocity = [0, -1, 0]\n" + mesh
    return SCENE + f"[[{kind}]]\nname = \"mesh\"\n" + mesh


# What would look at too many faces for each place.
REFUSED = {("collider", "slabs behind one another, tilted"), ("collider", "60 000 faces at one edge"), ("body", "60 000 faces at one edge"),
           ("rigid", "a spiral of 40 000 corners"),
           ("cover", "60 000 faces at one vertex")}
RENDER = "render s.toml --frames 0 --no-movie --quiet --out o"


def attack(attacks):
    for name, text in shapes():
        for kind in ("collider", "body"):
            codes = {3} if (kind, name) in REFUSED else harness.CODES
            attacks.run(f"{kind}: {name}", {"m.obj": text, "s.toml": scene_of(kind, "m.obj")}, RENDER, codes=codes)
    for name, text in shapes():
        if not any(name.startswith(word) for word in ("slabs", "plates", "boxes", "20 000", "40 000", "15 000", "60 000", "a spiral", "a box of 1e+30", "a sheet")):
            continue
        for kind in ("rigid", "cover", "emitter", "sink"):
            codes = {3} if (kind, name) in REFUSED else harness.CODES
            attacks.run(f"{kind}: {name}", {"m.obj": text, "s.toml": scene_of(kind, "m.obj")}, RENDER, codes=codes)
        attacks.run(f"checked: {name}", {"m.obj": text, "s.toml": scene_of("body", "m.obj")}, "check s.toml --quiet")
    for name, file, content in files():
        attacks.run(name, {file: content, "s.toml": scene_of("collider", file)}, RENDER)
    sequences(attacks)


def sequences(attacks):
    def scene(first, last):
        return SCENE + ('[[collider]]\nname = "cloth"\nshape = { mesh_sequence = { files = "m_%04d.obj", '
                        f'first = {first}, last = {last}, scale = 0.2, center = [0, 0.3, 0] }} }}\n')

    box = lambda *size: Obj().box((-1, -1, -1), size or (1, 1, 1)).text()
    named = lambda texts: {f"m_{k:04d}.obj": text for k, text in enumerate(texts)}
    attacks.run("a sequence of 9999 boxes", {**named([box()] * 9999), "s.toml": scene(0, 9998)}, RENDER)
    attacks.run("a sequence that jumps", {**named([box(1, 1, 10.0**k) for k in range(12)]), "s.toml": scene(0, 11)}, RENDER)
    attacks.run("a sequence that shakes", {**named([box(1, 1, 1 + 50 * (k % 2)) for k in range(40)]), "s.toml": scene(0, 39)}, RENDER)
    attacks.run("a sequence turned inside out", {**named([box(), Obj().box((1, 1, 1), (-1, -1, -1)).text()]), "s.toml": scene(0, 1)}, RENDER)
    attacks.run("a sequence of no number", {**named([box(), box().replace("v -1", "v nan")]), "s.toml": scene(0, 1)}, RENDER)
    attacks.run("a sequence of other faces", {**named([box(), box() + "f 1 2 3\n"]), "s.toml": scene(0, 1)}, RENDER)
    attacks.run("a sequence of 2 billion", {**named([box()]), "s.toml": scene(0, 2_000_000_000)}, RENDER)
    attacks.run("a sequence backwards", {**named([box()]), "s.toml": scene(5, 0)}, RENDER)
    large = ball(Obj(), 1, 120).text()
    attacks.run("a sequence of large balls", {**named([large] * 12), "s.toml": scene(0, 11)}, RENDER)
