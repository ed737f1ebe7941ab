"""Points and grounds: equal, on a line, far apart, of no numbers, and files that say other than they hold."""
import random
import struct
import zlib

from harness import SCENE

RENDER = "render s.toml --frames 0 --no-movie --quiet --out o"
STEPS = "render s.toml --frames 1 --no-movie --quiet --out o"


def scene(file, more=""):
    return SCENE.replace("shape = { sphere = { center = [0, 0.3, 0], radius = 0.12 } }",
                         f'shape = {{ points = {{ file = "{file}", spacing = 0.02{more} }} }}')


def csv(names, rows):
    return names + "\n" + "\n".join(rows) + "\n"


def attack(attacks):
    rng = random.Random(54)
    dice = lambda: rng.uniform(-0.3, 0.3)
    grid = [f"{i * 0.02},{j * 0.02 + 0.1},{k * 0.02}" for i in range(6) for j in range(6) for k in range(6)]

    def one(name, file, content, command=RENDER, more="", **limits):
        attacks.run(name, {file: content, "s.toml": scene(file, more)}, command, **limits)

    one("300 000 equal points", "p.csv", csv("x,y,z", ["0,0.1,0"] * 300_000))
    one("equal points that move", "p.csv", csv("x,y,z", ["0,0.1,0"] * 20_000), STEPS)
    one("300 000 points on a line", "p.csv", csv("x,y,z", [f"{k * 1e-6},0.1,0" for k in range(300_000)]))
    one("100 000 points 10 m apart", "p.csv", csv("x,y,z", [f"{10 * (k % 47)},{10 * (k // 47 % 47) + 1},{10 * (k // 2209)}" for k in range(100_000)]))
    one("two places 1e6 m apart", "p.csv", csv("x,y,z", ["0,0.1,0"] * 100 + ["1000000,0.1,0"] * 100), STEPS)
    one("two places 1e300 m apart", "p.csv", csv("x,y,z", ["0,0.1,0", "1e300,0.1,0"]))
    one("thinned a billion times", "p.csv", csv("x,y,z", grid), more=", thinning = 1000000000")
    one("spacing of 1e-30", "p.csv", csv("x,y,z", grid), more="", command=RENDER)
    for word in ("nan", "inf", "-inf", "1e999", "1e30", "1e-320", "x", "", "9" * 100_000, "1_000", "0x10", "１"):
        one(f"a place of '{word[:20]}'", "p.csv", csv("x,y,z", grid + [f"{word},0.1,0"]), STEPS)
    for column in ("V0", "mass", "J_P", "stiffness", "threshold", "vx", "C_xx"):
        for value in ("0", "-1", "nan", "1e300", "1e-300", "1e30"):
            names = "x,y,z," + (column if column not in ("vx", "C_xx") else {"vx": "vx,vy,vz", "C_xx": ",".join(f"C_{a}{b}" for a in "xyz" for b in "xyz")}[column])
            width = names.count(",") - 2
            one(f"{column} of {value}", "p.csv", csv(names, [row + f",{value}" * width for row in grid]), STEPS)
    tensor = ",".join(f"F_E_{a}{b}" for a in "xyz" for b in "xyz")
    for name, value in (("nothing", "0," * 8 + "0"), ("a mirror", "-1,0,0,0,1,0,0,0,1"), ("1e20", "1e20,0,0,0,1e20,0,0,0,1e20"),
                        ("no number", "nan," * 8 + "nan"), ("shear", "1,1e6,0,0,1,0,0,0,1")):
        one(f"F_E of {name}", "p.csv", csv("x,y,z," + tensor, [row + "," + value for row in grid]), STEPS)
    one("100 000 columns", "p.csv", csv("x,y,z," + ",".join(f"c{k}" for k in range(100_000)), ["0,0.1,0" + ",1" * 100_000] * 3))
    one("100 000 columns of one name", "p.csv", csv("x,y,z" + ",x" * 100_000, ["0,0.1,0" + ",1" * 100_000]))
    one("a header of 20 MB", "p.csv", "x,y,z," + "c" * 20_000_000 + "\n0,0,0,0\n")
    one("20 MB of blanks", "p.csv", " " * 20_000_000)
    one("20 MB of line ends", "p.csv", "x,y,z\n" + "\r\n" * 10_000_000)
    one("20 MB of quotes", "p.csv", '"' * 20_000_000)
    one("20 MB of comments", "p.csv", "# x y z\n" * 2_500_000 + "0 0 0\n")
    one("zeros", "p.csv", bytes(1_000_000))
    one("escapes in the header", "p.csv", "x,y,z,\x1b]0;x\x07\n\x1b[31m,0,0,0\n")
    one("escapes in a number", "p.csv", "x,y,z\n\x1b[31m,0,0\n")
    one("rows of many lengths", "p.csv", csv("x,y,z", ["0,0.1,0" + ",1" * (k % 7) for k in range(1000)]))

    ply = lambda header, body=b"": ("ply\nformat binary_little_endian 1.0\n" + header + "end_header\n").encode() + body
    xyz = "property float x\nproperty float y\nproperty float z\n"
    one("PLY of 1e18 points", "p.ply", ply("element vertex 1000000000000000000\n" + xyz))
    one("PLY of 200 million points, 1 MB", "p.ply", ply("element vertex 200000000\n" + xyz, bytes(1_000_000)))
    one("PLY of 1e18 lists", "p.ply", ply("element vertex 1\n" + xyz + "property list uint float w\n", bytes(12) + struct.pack("<I", 2**32 - 1)))
    one("PLY of points without size", "p.ply", ply("element nothing 9000000000000000000\nelement vertex 1\n" + xyz, bytes(12)))
    one("PLY of 300 000 lists", "p.ply", ply("element vertex 300000\n" + xyz + "property list uchar float w\n", (bytes(12) + b"\0") * 300_000))
    one("PLY of largest numbers", "p.ply", ply("element vertex 2\n" + xyz.replace("float", "double"), struct.pack("<6d", 1.7e308, 0, 0, -1.7e308, 0, 0)))
    one("a thousand carried columns", "p.csv", csv("x,y,z," + ",".join(f"c{k}" for k in range(1000)), [row + ",1" * 1000 for row in grid]),
        "export s.toml --frames 0 --format csv --carried all --out e")
    grounds(attacks)


def grounds(attacks):
    ground = lambda file, more="": SCENE + f'[[collider]]\nname = "ground"\nshape = {{ terrain = {{ file = "{file}"{more} }} }}\n'
    head = lambda columns, rows, cell="0.1", more="": f"ncols {columns}\nnrows {rows}\nxllcorner 0\nyllcorner 0\ncellsize {cell}\n{more}"
    flat = "\n".join(" ".join("0" for _ in range(20)) for _ in range(20)) + "\n"
    one = lambda name, file, content, command=STEPS, more="": attacks.run(name, {file: content, "s.toml": ground(file, more)}, command)
    one("ground of 1e9 x 1e9 posts", "g.asc", head(10**9, 10**9) + flat)
    one("ground of 1e9 x 1 posts", "g.asc", head(10**9, 1) + flat)
    one("ground of 100 000 x 2 posts", "g.asc", head(100_000, 2) + ("0 " * 100_000 + "\n") * 2)
    one("ground of 2000 x 2000 random posts", "g.asc", head(2000, 2000, "0.01") + "\n".join(" ".join(str((k * 7919 + j * 104729) % 97 / 50) for k in range(2000)) for j in range(2000)))
    for cell in ("0", "-1", "nan", "1e-300", "1e300", "inf"):
        one(f"ground of cells of {cell}", "g.asc", head(20, 20, cell) + flat)
    for word in ("nan", "inf", "1e300", "-1e300", "1e30", "x", "-9999"):
        one(f"ground with a post of {word}", "g.asc", head(20, 20) + flat.replace("0", word, 1))
    one("ground without data", "g.asc", head(20, 20) + flat.replace("0", "-9999"))
    one("ground of spikes", "g.asc", head(20, 20) + "\n".join(" ".join("1000" if (i + j) % 2 else "-1000" for i in range(20)) for j in range(20)))
    one("ground of 10 MB of header", "g.asc", "nothing 1\n" * 1_000_000 + head(20, 20) + flat)
    one("ground of zeros", "g.asc", bytes(1_000_000))
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    png = lambda width, height, depth, data: b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, depth, 0, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(data, 9)) + chunk(b"IEND", b"")
    heights = ", spacing = 0.1, low = 0, high = 1"
    one("ground from a picture of 2e9 posts", "g.png", png(50_000, 50_000, 16, bytes(1000)), more=heights)
    one("ground from a picture of 16384 posts a side", "g.png", png(16384, 16384, 16, bytes(16384 * (2 * 16384 + 1))), more=heights)
    one("ground from a picture of one post", "g.png", png(1, 1, 16, bytes(3)), more=heights)
    one("ground from infinitely low", "g.png", png(4, 4, 16, bytes(36)), more=", spacing = 0.1, low = -1e300, high = 1e300")
