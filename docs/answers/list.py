"""The mistakes of docs/answers.md: files beside scene.toml, and the commands that meet them."""

BASE = "scene.toml"


def edit(old, new):
    """A change to one line of base.toml, checked."""
    return {"old": old, "new": new, "arguments": ["check", "scene.toml"]}


def text(new):
    """Another scene file altogether."""
    return {"text": new, "arguments": ["check", "scene.toml"]}


def command(*arguments, **files):
    return {"arguments": list(arguments), "files": files.get("files", {})}


SCENES = [
    # Syntax.
    edit("cell_size = 0.04", "cell_size = 0,04"),
    edit("cell_size = 0.04", "cell_size 0.04"),
    edit("cell_size = 0.04", "cell_size = "),
    edit("cell_size = 0.04", "cell_size = 0.04 m"),
    edit("cell_size = 0.04", "cell_size = \"0.04\""),
    edit("cell_size = 0.04", "cell_size = 4cm"),
    edit("[solver]", "[solver"),
    edit("name = \"ball\"", "name = ball"),
    edit("name = \"ball\"", "name = \"ball"),
    edit("gravity = [0, -9.81, 0]", "gravity = (0, -9.81, 0)"),
    edit("gravity = [0, -9.81, 0]", "gravity = [0, -9.81]"),
    edit("gravity = [0, -9.81, 0]", "gravity = -9.81"),
    edit("frames = 4", "frames = 4\nframes = 5"),
    edit("frames = 4", "// four frames\nframes = 4"),
    text(""),
    text("frames = 4\n"),
    # Names of keys and tables.
    edit("cell_size = 0.04", "cell_sise = 0.04"),
    edit("cell_size = 0.04", "dx = 0.04"),
    edit("cell_size = 0.04", "resolution = 64"),
    edit("[solver]", "[solver]\nbounds = [1, 1, 1]"),
    edit("youngs_modulus = 1.4e5", "E = 1.4e5"),
    edit("youngs_modulus = 1.4e5", "youngs_modulos = 1.4e5"),
    edit("youngs_modulus = 1.4e5", "nu = 0.2"),
    edit("youngs_modulus = 1.4e5", "stickiness = 2"),
    edit("critical_compression = 0.025", "theta_c = 0.025"),
    edit("density = 400", "rho = 400"),
    edit("hardening = 10", "xi = 10"),
    edit("[[body]]", "[body]"),
    edit("[[body]]", "[[bodies]]"),
    edit("[material.snow]", "[[material]]"),
    edit("[material.snow]", "[material]"),
    edit("[material.snow]", "[snow]"),
    edit("[[collider]]", "[[obstacle]]"),
    edit("frames = 4", "frame = 4"),
    edit("frames = 4", "duration = 4"),
    edit("frames = 4", "cell_size = 0.04\nframes = 4"),
    edit("size = [160, 90]", "resolution = [160, 90]"),
    edit("velocity = [0, -2, 0]", "friction = 0.3"),
    edit("velocity = [0, -2, 0]", "colour = \"white\""),
    # Values.
    edit("cell_size = 0.04", "cell_size = 0"),
    edit("cell_size = 0.04", "cell_size = -0.04"),
    edit("cell_size = 0.04", "cell_size = nan"),
    edit("cell_size = 0.04", "cell_size = 40"),
    edit("cell_size = 0.04", "cell_size = 0.0001"),
    edit("frames = 4", "frames = 4.5"),
    edit("frames = 4", "frames = -1"),
    edit("frames = 4", "frames = \"four\""),
    edit("frames = 4", "frames = 1000000000"),
    edit("frames = 4", "fps = 0\nframes = 4"),
    edit("youngs_modulus = 1.4e5", "youngs_modulus = 140"),
    edit("youngs_modulus = 1.4e5", "youngs_modulus = -1"),
    edit("density = 400", "density = 0.4"),
    edit("density = 400", "density = 0"),
    edit("density = 400", "poisson_ratio = 0.6"),
    edit("critical_compression = 0.025", "critical_compression = 2.5"),
    edit("hardening = 10", "hardening = 1000"),
    edit("hardening = 10", "preset = \"sticky\""),
    edit("hardening = 10", "preset = \"wett\""),
    edit("hardening = 10", "model = \"elastic\""),
    edit("cell_size = 0.04", "cell_size = 0.04\ntransfer = \"pic\""),
    edit("cell_size = 0.04", "cell_size = 0.04\ntransfer = \"apics\""),
    edit("cell_size = 0.04", "cell_size = 0.04\nkernel = \"linear\""),
    edit("cell_size = 0.04", "cell_size = 0.04\nflip_ratio = 95"),
    edit("cell_size = 0.04", "cell_size = 0.04\ntime_step = 1e-4"),
    edit("cell_size = 0.04", "cell_size = 0.04\ntime_step = \"fixed\"\ndt = 0.01"),
    edit("cell_size = 0.04", "cell_size = 0.04\nbeta = 2"),
    edit("cell_size = 0.04", "cell_size = 0.04\nprecision = \"half\""),
    # Shapes and objects.
    edit("radius = 0.08", "radius = 0"),
    edit(", radius = 0.08", ""),
    edit("sphere = { center = [0, 0.12, 0], radius = 0.08 }", "sphere = {}"),
    edit("sphere = { center", "ball = { center"),
    edit("sphere = { center = [0, 0.12, 0], radius = 0.08 }", "plane = {}"),
    edit("sphere = { center = [0, 0.12, 0], radius = 0.08 }",
         "cube = { center = [0, 0.12, 0], size = [1, 1, 1] }"),
    edit("shape = { sphere = { center = [0, 0.12, 0], radius = 0.08 } }",
         "sphere = { center = [0, 0.12, 0], radius = 0.08 }"),
    edit("shape = { sphere = { center = [0, 0.12, 0], radius = 0.08 } }", ""),
    edit("center = [0, 0.12, 0]", "position = [0, 0.12, 0]"),
    edit("center = [0, 0.12, 0], radius = 0.08", "center = [0, 30, 0], radius = 15"),
    edit("radius = 0.08", "radius = 0.02"),
    edit("center = [0, 0.12, 0]", "center = [0, -0.5, 0]"),
    edit("plane = { point = [0, 0, 0], normal = [0, 1, 0] }",
         "box = { center = [9, 0, 0], size = [1, 1, 1] }"),
    edit("normal = [0, 1, 0]", "normal = [0, 0, 0]"),
    edit("normal = [0, 1, 0]", "normal = [0, -1, 0]"),
    edit("plane = { point = [0, 0, 0], normal = [0, 1, 0] }", "mesh = { file = \"stairs.obj\" }"),
    {**edit("plane = { point = [0, 0, 0], normal = [0, 1, 0] }", "mesh = { file = \"stairs.fbx\" }"),
     "files": {"stairs.fbx": "Kaydara FBX Binary\n"}},
    {**edit("plane = { point = [0, 0, 0], normal = [0, 1, 0] }", "mesh = { file = \"stairs.obj\" }"),
     "files": {"stairs.obj": "# no faces\nv 0 0 0\n"}},
    edit("[[collider]]\nname = \"floor\"\nshape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }\n",
         ""),
    edit("name = \"floor\"", "name = \"the floor\""),
    edit("name = \"floor\"", "name = \"floor\"\ncontact = \"stick\""),
    edit("name = \"floor\"", "name = \"floor\"\nfriction = -1"),
    edit("name = \"ball\"", "name = \"ball\"\nmaterial = \"ice\""),
    edit("gravity = [0, -9.81, 0]", "gravity = [0, 9.81, 0]"),
    edit("gravity = [0, -9.81, 0]", "gravity = [0, 0, -9.81]"),
    edit("velocity = [0, -2, 0]", "velocity = [0, -200, 0]"),
    # Views.
    edit("name = \"main\"", "name = \"main view\""),
    edit("layers = [\"ground\", \"particles\", \"caption\"]", "layers = [\"ground\", \"snow\"]"),
    edit("layers = [\"ground\", \"particles\", \"caption\"]", "layers = \"particles\""),
    edit("[output]", "camera = { eye = [0, 1, 2] }\n[output]"),
    edit("[output]", "camera = { position = [0, 1, 2], look_at = [0, 0, 0] }\n[output]"),
    edit("[output]", "particles = { color_by = \"velocity\" }\n[output]"),
    edit("size = [160, 90]", "size = [0, 0]"),
]

COMMANDS = [
    command("render", "scen.toml"),
    command("rendr", "scene.toml"),
    command("render", "scene.toml", "--quality", "high"),
    command("render", "scene.toml", "--frame", "3"),
    command("render", "scene.toml", "--frames", "9-2"),
    command("render", "scene.toml", "--size", "1920"),
    command("render", "scene.toml", "--view", "top"),
    command("render", "scene.toml", "--set", "hardening=5"),
    command("render", "scene.toml", "--set", "material.snow.hardening:5"),
    command("render", "scene.toml", "--set=", "--dry-run"),
    command("render", "scene.toml", "--set", "--dry-run"),
    command("render", "scene.toml", "--set", "body.bull.velocity=[0,0,0]"),
    command("render", "scene.toml", "--set", "body.egg=3"),
    command("render", "scene.toml", "--set", "body.ball=none"),
    command("render", "scene.toml", "--coarsen", "0.5"),
    command("render", "scene.toml", "--threads", "-1"),
    command("render", "nowhere/scene.toml"),
    command("render", "."),
    command("dump", "scene.toml", "--format", "csv"),
    command("dump", "scene.toml", "--at", "0.1", "--at", "0.2"),
    command("dump", "scene.toml", "--at", "0.1", "--field", "velocity"),
    command("dump", "scene.toml", "--at", "0.1", "--stage", "forces"),
    command("dump", "scene.toml", "--at", "-1"),
    command("export", "scene.toml", "--format", "fbx"),
    command("compare", "a.png", "b.png"),
    command("info", "nowhere.png"),
    command("params", "stickyness"),
]

SWEEP = '[sweep]\nscene = "scene.toml"\n[axis]\n"material.snow.hardening" = [5, 10]\n'


def sweep(old, new):
    assert old in SWEEP, old
    return command("sweep", "sweep.toml", "--dry-run", files={"sweep.toml": SWEEP.replace(old, new)})


OTHERS = [
    command("render", "sweep.toml", files={"sweep.toml": SWEEP}),
    sweep("hardening", "hardning"),
    sweep("[5, 10]", "[]"),
    sweep("[5, 10]", "[5, \"ten\"]"),
    sweep("[5, 10]", "5"),
    sweep("[5, 10]", "{ logspace = [5, 10] }"),
    sweep("[sweep]\nscene = \"scene.toml\"\n", ""),
    sweep("scene.toml", "snowball.toml"),
    sweep("scene = \"scene.toml\"\n", ""),
    sweep("[sweep]\n", "[sweep]\nmethod = \"random\"\n"),
    sweep("[axis]", "[[axis]]"),
    command("sweep", "scene.toml"),
    command("sweep", "scene.toml", "-p", "hardening=5,10", "--dry-run"),
    command("sweep", "scene.toml", "-p", "material.snow.hardening", "--dry-run"),
    command("sweep", "scene.toml", "-p", "material.snow.hardening=5", "--dry-run"),
    command("sweep", "scene.toml", "-p", "material.snow.hardening=-5,10", "--dry-run"),
    command("sweep", "scene.toml", "-p", "seed=1,2", "--only", "99", "--dry-run"),
    command("sweep", "scene.toml", "-p", "seed=1,2", "--engine", "sge", "--dry-run"),
    command("sweep", "scene.toml", "-p", "seed=1,2", "--shard", "3/2", "--dry-run"),
    command("sweep", "collect", "nowhere"),
    command("check", "points.toml", files={
        "points.toml": '[[body]]\nshape = { points = { file = "none.csv", spacing = 0.1 } }\n'}),
    command("check", "points.toml", files={
        "points.toml": '[[body]]\nshape = { points = { file = "p.csv", spacing = 0.1 } }\n',
        "p.csv": "a,b,c\n1,2,3\n"}),
    command("check", "points.toml", files={
        "points.toml": '[[body]]\nshape = { points = { file = "p.csv", spacing = 0.1 } }\n',
        "p.csv": "x,y,z\n1,2\n"}),
    command("check", "points.toml", files={
        "points.toml": '[[body]]\nshape = { points = { file = "p.csv" } }\n',
        "p.csv": "x,y,z\n1,2,3\n2,3,4\n"}),
    command("check", "points.toml", files={
        "points.toml": '[[body]]\nshape = { points = { file = "p.csv", spacing = 0.1 } }\n',
        "p.csv": ""}),
    command("check", "mesh.toml", files={
        "mesh.toml": '[[body]]\nshape = { mesh = { file = "m.obj" } }\n',
        "m.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"}),
    command("view", "scene.toml", "--replay", "none.json"),
    command("view", "scene.toml", "--replay", "clicks.json", files={"clicks.json": '[{"clik": "Run"}]'}),
    command("view", "scene.toml", "--replay", "clicks.json", files={"clicks.json": '{"click": "Run"}'}),
    command("view", "scene.toml", "--replay", "clicks.json", files={"clicks.json": '[{"wait": "long"}]'}),
    command("view", "scene.toml", "--web", "--port", "8080"),
    command("view", "scene.toml", "--web", "--listen", "127.0.0.1:99999"),
    command("view", "scene.toml", "--web", "--window"),
    command("render", "picture.png", files={"picture.png": "not a picture\n"}),
    command("view", "picture.png", files={"picture.png": "not a picture\n"}),
    command("sweep", "scene.toml", "-p", "no_such=1,2", "-p", "seed=1,2", "--dry-run"),
]
