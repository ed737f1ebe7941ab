"""Values of parameters at random, from what `neve params --json` says of each, and scenes as TOML."""

import json
import math
import random


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

    def live_change(self, names):
        """A live parameter and its new value, as --set takes it. names: of what has names, by table"""
        ranges = [address for address, parameter in self.parameters.items()
                  if parameter["live"] and not any(part in address for part in ("[", ".shape.", ".camera."))
                  and parameter["type"] in ("number", "integer", "boolean", "choice", "vector")
                  and address.split(".")[0] in ("solver", "light", *names)
                  # Springs and dampers are of colliders that have them.
                  and not address.endswith(("_stiffness", "_damping"))
                  and address not in ("solver.dt", "solver.max_dt", "solver.time_step")]
        address = self.random.choice(ranges)
        value = self.value(address)
        table = address.split(".")[0]
        if table in names:
            address = address.replace("NAME", self.random.choice(names[table]), 1)
        return address, value if isinstance(value, str) else as_toml(value)
