"""Validates scenes and sweeps with python3-jsonschema, which is not ours.

    read_schema.py SCENE_SCHEMA SWEEP_SCHEMA FILE...

Prints a line for each file: "ok FILE", or "wrong FILE: where and why".
"""
import json
import sys
import tomllib

import jsonschema


def validator_of(path):
    with open(path, encoding="utf-8") as file:
        schema = json.load(file)
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


def main():
    scenes, sweeps = validator_of(sys.argv[1]), validator_of(sys.argv[2])
    for path in sys.argv[3:]:
        with open(path, "rb") as file:
            document = tomllib.load(file)
        validator = sweeps if "sweep" in document else scenes
        errors = list(validator.iter_errors(document))
        if not errors:
            print("ok", path)
        for error in errors:
            where = ".".join(str(word) for word in error.absolute_path)
            print(f"wrong {path}: {where}: {error.message[:120]}")


main()
