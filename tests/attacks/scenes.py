"""Scenes that ask for what nobody means: curves, bodies that snow moves, dust, holdouts, covers."""
from harness import SCENE

STEPS = "render s.toml --frames 1 --no-movie --quiet --out o"
PLAN = "render s.toml --dry-run --quiet"

RIGID = """
[[collider]]
name = "can"
shape = { box = { center = [0, 0.6, 0], size = [0.1, 0.1, 0.1] } }
"""
# An experiment of a card ends after 8e7 steps of a particle at most: of the stiffest materials all six do, which
# takes 60 s of a processor that others use too. What hangs takes minutes more.
CARD_SECONDS = 120
DUST = "\n[material.snow]\ndust = 0.02\n[dust]\nspeed = 0.01\nstrain_rate = 0.01\n"


def attack(attacks):
    one = lambda name, more, command=STEPS, **limits: attacks.run(name, {"s.toml": SCENE + more}, command, **limits)
    curves(one)
    bodies(one)
    dust(one)
    materials(one)


def curves(one):
    curve = lambda keyframes, parameter="material.snow.hardening", more="": f'\n[[curve]]\nparameter = "{parameter}"\n{more}keyframes = [{keyframes}]\n'
    keys = lambda n: ", ".join(f"{{ time = {k * 1e-3:g}, value = {5 + k % 7} }}" for k in range(n))
    one("curve of 18 000 keyframes", curve(keys(18_000)))
    one("curve of no keyframe", curve(""))
    one("curve at one time", curve("{ time = 0, value = 1 }, { time = 0, value = 9 }"))
    one("curve backwards", curve("{ time = 1, value = 1 }, { time = 0, value = 9 }"))
    for value in ("nan", "inf", "-1e300", "1e300", '"x"', "[1, 2, 3]"):
        one(f"curve to {value}", curve(f"{{ time = 0, value = {value} }}, {{ time = 1, value = 9 }}"))
        one(f"curve at {value}", curve(f"{{ time = {value}, value = 3 }}"))
    one("curve within 1e-300 s", curve("{ time = 0, value = 1 }, { time = 1e-300, value = 9 }"))
    for parameter in ("solver.cell_size", "frames", "material.none.hardening", "body.ball.velocity", "curve.0.keyframes", "output.size",
                      "solver.gravity", "solver.cfl", "solver.max_dt", "x" * 100_000, "material..hardening", "\\u001b]0;x\\u0007"):
        one(f"curve of {parameter[:30]}", curve("{ time = 0, value = 1 }, { time = 1, value = 9 }", parameter))
    one("gravity to 1e30", curve("{ time = 0, vector = [0, -9.81, 0] }, { time = 0.02, vector = [0, 1e30, 0] }", "solver.gravity"))
    one("stiffness to 1e30", curve("{ time = 0, value = 1e5 }, { time = 0.02, value = 1e30 }", "material.snow.youngs_modulus"))
    one("steps to 1e-30 s", curve("{ time = 0, value = 1e-3 }, { time = 0.02, value = 1e-30 }", "solver.max_dt"), codes={3, 5, 8, 0})
    one("two curves of one parameter", curve(keys(2)) + curve(keys(2)))
    one("4000 curves", "".join(curve("{ time = 0, value = 1 }", more=f'name = "c{k}"\n') for k in range(4000)), PLAN)
    one("curves that are checked", curve(keys(3000)) + curve("{ time = 0, vector = [0, -9.81, 0] }", "solver.gravity"), "check s.toml --quiet")


def bodies(one):
    rigid = lambda more: RIGID + more + "\n"
    for key, values in {
        "density": ("0", "-1", "nan", "1e300", "1e-300", "1e30", "1e-30", "1e-6"),
        "mass": ("0", "-1", "inf", "1e300", "1e-300", "1e20", "1e-20"),
        "velocity": ("[1e300, 0, 0]", "[nan, 0, 0]", "[1e6, 0, 0]", "[0, -300, 0]"),
        "angular_velocity": ("[0, 0, 1e300]", "[0, 0, 1e3]"),
        "inertia": ("[0, 0, 0]", "[-1, 1, 1]", "[1, 1, 1e300]", "[1e-30, 1e-30, 1e-30]", "[1, 1, 100]"),
        "hold": ('["x", "x", "x"]', '["x", "y", "z", "turn_x", "turn_y", "turn_z"]', '["w"]', "[" + '"x", ' * 50_000 + "]"),
        "friction": ("1e300", "-1", "nan"),
        "keyframes": ("[{ time = 0 }, { time = 1, position = [1, 1, 1] }]",),
    }.items():
        for value in values:
            one(f"body with {key} = {value[:30]}", rigid(("" if key in ("density", "mass") else "density = 400\n") + f"{key} = {value}"))
    for joint in ("hinge", "ball", "slider", "none", "weld"):
        for more in ("", "joint_point = [1e6, 0, 0]\n", "joint_point = [nan, 0, 0]\n", "joint_axis = [0, 0, 0]\n", "joint_axis = [1e-300, 0, 0]\n",
                     "joint_stiffness = 1e300\n", "joint_stiffness = 1e15\njoint_damping = 1e15\n", "joint_damping = -1\n"):
            one(f"{joint} {more.strip()}", rigid(f'density = 400\njoint = "{joint}"\n{more}'))
    for more in ("spring_place = [1e12, 0, 0]\nspring_stiffness = 1\n", "spring_stiffness = 1e300\n", "spring_stiffness = 1e20\nspring_damping = 1e20\n",
                 "spring_place = [0, 1, 0]\nspring_stiffness = -5\n", "spring_damping = 1e300\n"):
        one(f"spring {more.strip()[:34]}".replace("\n", " "), rigid("density = 400\n" + more))
    for shape in ("plane = { point = [0, 0.5, 0], normal = [0, 1, 0] }", "sphere = { center = [0, 0.6, 0], radius = 1e-9 }", "sphere = { center = [0, 0.6, 0], radius = 1e9 }",
                  "box = { center = [0, 0.6, 0], size = [1e-9, 1, 1] }", "torus = { center = [0, 0.6, 0], major_radius = 0.1, minor_radius = 0.0999999 }",
                  "cylinder = { center = [0, 0.6, 0], radius = 1e-6, height = 1 }", "capsule = { a = [0, 0.6, 0], b = [0, 0.6, 0], radius = 0.1 }"):
        one(f"body of {shape[:36]}", f'\n[[collider]]\nname = "can"\ndensity = 400\nshape = {{ {shape} }}\n')
    many = lambda n, place: "".join(f"\n[[collider]]\ndensity = 300\nshape = {{ box = {{ center = [{place(k)}], size = [0.05, 0.05, 0.05] }} }}\n" for k in range(n))
    one("300 bodies at one place", many(300, lambda k: "0, 2, 0"))
    one("2000 bodies at one place", many(2000, lambda k: "0, 2, 0"))
    one("2000 bodies in a row", many(2000, lambda k: f"{k * 0.06:g}, 2, 0"))
    one("2000 bodies in a heap", many(2000, lambda k: f"{k % 12 * 0.04:g}, {0.1 + k // 144 * 0.04:g}, {k // 12 % 12 * 0.04:g}"))
    one("2000 toruses at one place", "".join("\n[[collider]]\ndensity = 300\nshape = { torus = { center = [0, 2, 0], major_radius = 0.1, minor_radius = 0.02 } }\n" for _ in range(2000)), PLAN)
    one("300 toruses at one place", "".join("\n[[collider]]\ndensity = 300\nshape = { torus = { center = [0, 2, 0], major_radius = 0.1, minor_radius = 0.02 } }\n" for _ in range(300)))
    one("10 000 bodies, planned", many(10_000, lambda k: f"{k * 0.06:g}, 2, 0"), PLAN)
    one("500 bodies, checked", many(500, lambda k: f"{k * 0.06:g}, 2, 0"), "check s.toml --quiet")
    one("a body inside the snow", rigid("density = 400").replace("0.6", "0.3"))
    one("a body that is a holdout", rigid('density = 400\nstyle = "holdout"'))
    one("2000 holdouts", "".join(f'\n[[collider]]\nstyle = "holdout"\nshape = {{ sphere = {{ center = [{k}, 0, 0], radius = 0.4 }} }}\n' for k in range(2000)))
    one("a holdout around the camera", '\n[[collider]]\nstyle = "holdout"\nshape = { sphere = { center = [0, 0, 0], radius = 100 } }\n')


def dust(one):
    for key, values in {
        "particles": ("1e12", "0", "-1", "nan", "1", "2_000_000_000", "100_000_000"),
        "air_cell": ("1e-3", "1e6", "0", "nan", "0.01", "1e300"),
        "life": ("1e-300", "0", "-1", "1e300"),
        "wind": ("[1e30, 0, 0]", "[1e4, 0, 0]", "[nan, 0, 0]", "[1e300, 1e300, 1e300]"),
        "turbulence": ("1e30", "-1", "1e3", "nan"),
        "diffusion": ("1e30", "-1", "1e6"),
        "settling_speed": ("0", "1e30", "1e-300", "-1"),
        "buoyancy": ("1e30", "-1e30"),
        "spray_drag": ("1e30", "-1"),
        "min_J_P": ("0", "1e300", "nan"),
    }.items():
        for value in values:
            one(f"dust with {key} = {value}", DUST + f"{key} = {value}\n")
    for value in ("1e30", "-1", "nan", "1e300"):
        one(f"share of dust {value}", DUST.replace("0.02", value))
    one("dust of snow that bursts", DUST + "\n", "render s.toml --frames 3 --no-movie --quiet --out o --set body.ball.velocity=[0,-100,0]")
    one("dust over two places 1 km apart", DUST + '[[body]]\nname = "far"\nvelocity = [0, -20, 0]\nshape = { sphere = { center = [1000, 0.2, 0], radius = 0.12 } }\n')
    one("exports of dust", DUST + "".join(f'[[export]]\ndust = true\nname = "e{k}"\nformat = "vdb"\n' for k in range(30)))
    one("exports of dust of every format", DUST + "".join(f'[[export]]\ndust = true\nformat = "{k}"\n' for k in ("ply", "vtp", "vdb", "bgeo", "usda", "npz", "csv")))


def materials(one):
    for key, values in {
        "youngs_modulus": ("1e12", "1e-300", "1e300", "nan"),
        "density": ("1e-6", "1e300", "0", "1e-300"),
        "poisson_ratio": ("0.4999999999", "-1", "0.5"),
        "hardening": ("1e300", "1e6", "-1"),
        "dust": ("1e300", "-1"),
        "variation": ("{ density = 1e300 }", "{ size = 1e-300, stiffness = 1 }", "{ youngs_modulus = 1e9, size = 1e-9 }"),
    }.items():
        for value in values:
            one(f"card with {key} = {value}", f"\n[material.snow]\n{key} = {value}\n", "card s.toml --quiet --out c.png", seconds=CARD_SECONDS)
    one("card of 2000 materials", "".join(f"\n[material.m{k}]\nhardening = {k % 9 + 1}\n" for k in range(2000)), "card s.toml --quiet --out c.png", seconds=CARD_SECONDS)
    one("card of a cell of 1e-9", "", "card s.toml --quiet --out c.png --set solver.cell_size=1e-9", seconds=CARD_SECONDS)
    one("card of no gravity", "", "card s.toml --quiet --out c.png --set solver.gravity=[0,0,0]", seconds=CARD_SECONDS)
    one("card of a gravity of 1e30", "", "card s.toml --quiet --out c.png --set solver.gravity=[0,-1e30,0]", seconds=CARD_SECONDS)
    one("card of steps of 1e-30", "", "card s.toml --quiet --out c.png --set solver.max_dt=1e-30", seconds=CARD_SECONDS)
