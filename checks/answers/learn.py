"""Schemas of answers from the answers: `learn.py ANSWERS OUT`, where ANSWERS has a folder of JSON files for each command.

What is always there is required; what may be null says so; an object whose keys are names that somebody gave (of controllers,
of measures) is a map from any key. Numbers that were whole each time are whole."""

import json
import pathlib
import re
import sys

DIALECT = "https://json-schema.org/draft/2020-12/schema"
KEY = re.compile(r"^[a-z][a-z0-9_]*$")
# Objects whose keys are names of measures, of inputs and outputs or of keys, by the key that they stand under.
MAPS = {"null", "absent", "reasons", "domain", "findings", "inputs", "outputs", "rest", "shares"}
# What an answer can have and no answer that is asked for has: a margin that is worst at a later plant, at gains without inputs that are
# known, in a loop that grows there; conditions
# of requirements. By the key that it stands under.
ALSO = {
    "worst_case": [{"plant": {"index": 1, "from_s": 2.5}, "spectral_radius": 1.5}],
    "frozen_gains": [{"kp": 0.5, "ki": 0.5, "kd": 0.5}],
    "conditions": [{"from_s": 0.5, "target_m": 600.0}],
}
# Why numbers are null stands where one is null; it is so in every answer of some commands that are asked for.
SOMETIMES = {"null"}
# What a scenario can have at a path: anything.
ANYTHING = {("paths", "value")}
TYPES = {type(None): "null", bool: "boolean", int: "integer", float: "number", str: "string", list: "array", dict: "object"}


def learned(values, under):
    values = values + ALSO.get(under, [])
    types = {TYPES[type(value)] for value in values}
    # What was never anything else may be anything one day.
    if types == {"null"}:
        return {}
    if "number" in types:
        types.discard("integer")
    schema = {}
    if types:
        ordered = sorted(types - {"null"}) + (["null"] if "null" in types else [])
        schema["type"] = ordered[0] if len(ordered) == 1 else ordered
    items = [item for value in values if isinstance(value, list) for item in value]
    if items:
        schema["items"] = learned(items, under)
    objects = [value for value in values if isinstance(value, dict)]
    if objects:
        schema |= of_objects(objects, under)
    return schema


def of_objects(objects, under):
    keys = sorted({key for value in objects for key in value})
    if under in MAPS or any(not KEY.match(key) for key in keys):
        return {"additionalProperties": learned([it for value in objects for it in value.values()], "")}
    of_key = lambda key: [value[key] for value in objects if key in value]
    below = {key: {} if (under, key) in ANYTHING else learned(of_key(key), key) for key in keys}
    required = [key for key in keys if key not in SOMETIMES and all(key in value for value in objects)]
    return {"properties": below} | ({"required": required} if required else {})


def main():
    answers, out = map(pathlib.Path, sys.argv[1:])
    out.mkdir(parents=True, exist_ok=True)
    for old in out.glob("*.schema.json"):
        old.unlink()
    read = {
        folder.name: [json.loads(file.read_text()) for file in sorted(folder.glob("*.json"))]
        for folder in sorted(it for it in answers.iterdir() if it.is_dir())
    }
    # A run that is flown again is told as any flight is.
    flights = read.get("simulate", []) + [it["simulation"] for it in read.get("campaign-replay", [])]
    # Of each case it is told what is told of a scenario alone.
    certified = read.get("certify", []) + [case for it in read.get("certify-cases", []) for case in it["cases"]]
    for name, values in read.items():
        title = "What every command answers that fails" if name == "error" else f"What `fspid {name.replace('-', ' ')} --format json` answers"
        schema = {"$schema": DIALECT, "title": title} | learned(values, "")
        if name == "campaign-replay":
            schema["properties"]["simulation"] = learned(flights, "")
        if name == "certify-cases":
            of_each = learned([it["controllers"] for it in certified], "controllers")
            schema["properties"]["cases"]["items"]["properties"]["controllers"] = of_each
        versions = {value.get("schema") for value in values}
        if len(versions) == 1 and None not in versions:
            schema["properties"]["schema"] = {"const": versions.pop()}
        (out / f"{name}.schema.json").write_text(json.dumps(schema, indent=1, ensure_ascii=False) + "\n")
        print(f"{name}: of {len(values)} answers")


if __name__ == "__main__":
    main()
