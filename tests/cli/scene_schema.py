"""The schema against scenes: those that run must be valid, broken ones refused where a schema can know.

usage: scene_schema.py MPMFAST SOURCE_DIR; exit 77 where a module is missing.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

try:
    import jsonschema
    import yaml
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

# What a schema cannot see: places and sizes against each other, names, files, and what YAML itself hides.
BEYOND_A_SCHEMA = {
    "axisymmetric",  # the sign of one component, in one space
    "bitmap_is_no_png",
    "crack_without_glue",
    "crossed_polygon",
    "duplicate_key",  # the last one wins before the schema sees it
    "leading_zero",  # 010 is 8 by then
    "merge_key",  # merged by then
    "missing_surface",
    "not_a_number",  # .nan is a number, to Python
    "only_rigid_bodies",
    "out_of_range",
    "piston_sideways",
    "plane_stress_metal",
    "rigid_shares_field",
    "ring_inside_out",
    "surface_is_no_stl",
    "truncated_surface",
}
# Scalars that hold an expression, and what a scene may start from: valid wherever the reader meets them.
GOOD_PIECES = [
    ("grid", {"size": ["${2 * w}", "20 mm"], "cell": "${w / 10}"}),
    ("time", {"end": "${t} us", "cfl": "${c}"}),
    ("variables", {"w": "5 mm", "n": 3}),
    ("include", ["a.yaml", "b.yaml"]),
    ("contact", {"law": "${law}", "friction": "${mu}"}),
    ("output", {"frames": "${n}", "overlap": "${yes}"}),
    ("thickness", "2 cm"),
    ("gravity", [0, "-9.81 m/s^2"]),
    ("time", {"end": "1/2 \u00b5s"}),
]
BAD_PIECES = [
    ("grid", {"size": ["1 m", "1 m"], "cell": "1 GPa"}),
    ("time", {"end": "0 s"}),
    ("time", {"end": "-1 us"}),
    ("time", {"end": "1 us", "cfl": 1.01}),
    ("time", {"end": "1 us", "clf": 0.5}),
    ("contact", {"law": "coulomb", "reach": 0.1}),
    ("contact", {"law": "viscous", "film": "1 mm"}),
    ("contact", {"normal": "specified"}),
    ("method", {"update": "xpic(21)"}),
    ("bodies", []),
    ("materials", {"steel": {"model": "rigid", "young": "1 GPa"}}),
    ("materials", {"steel": {"model": "neo_hookean", "density": 1, "bulk": 1, "young": 1}}),
    ("boundaries", {"left": {"wall": "held", "direction": "x"}}),
    ("boundaries", {"left": {"wall": "held", "piston": 1}}),
]

failures = 0


def fail(text):
    global failures
    failures += 1
    print(f"FAILED: {text}")


def faults(validator, scene):
    return [f"{'.'.join(map(str, e.absolute_path))}: {e.message[:200]}" for e in validator.iter_errors(scene)]


def check_scenes(validator, source):
    count = 0
    for folder in (".", "hard", "bench"):
        for file in sorted((source / "configs" / folder).glob("*.yaml")):
            count += 1
            for fault in faults(validator, yaml.safe_load(file.read_text())):
                fail(f"{file.name}: {fault}")
    if count < 30:
        fail(f"only {count} scenes")


def check_broken(validator, source):
    accepted = set()
    for file in sorted((source / "tests/cli/broken").glob("*.yaml")):
        try:
            scene = yaml.safe_load(file.read_text())
        except yaml.YAMLError:
            continue
        if validator.is_valid(scene):
            accepted.add(file.stem)
    for name in sorted(accepted ^ BEYOND_A_SCHEMA):
        fail(f"{name} is {'accepted' if name in accepted else 'refused'} by the schema: change the list, or mend it")


def check_pieces(validator, source):
    good = yaml.safe_load((source / "configs/spheres.yaml").read_text())
    good = {**good, **{"space": "plane_strain"}}
    for key, value in GOOD_PIECES:
        for fault in faults(validator, {**good, key: value}):
            fail(f"{key}: {value}: {fault}")
    for key, value in BAD_PIECES:
        if validator.is_valid({**good, key: value}):
            fail(f"{key}: {value} is accepted")
    if faults(validator, {"include": "base.yaml", "time": {"end": "1 s"}}):
        fail("a scene that starts from another must not state all")


def check_page(program, source):
    """The fragments of the reference page, together, are a scene."""
    text = (source / "tools/manual/scene.md").read_text()
    fragments = [part.split("```")[0] for part in text.split("```yaml\n")[1:]]
    if len(fragments) < 10:
        fail(f"only {len(fragments)} fragments on the page")
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(folder) / "page.yaml"
        scene.write_text("".join(fragments))
        result = subprocess.run([program, "check", scene], capture_output=True, text=True)
        if result.returncode != 0:
            fail(f"the fragments of the page are no scene:\n{result.stderr}")


def main():
    program, source = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    schema = json.loads(subprocess.run([program, "schema"], capture_output=True, check=True).stdout)
    jsonschema.Draft7Validator.check_schema(schema)
    validator = jsonschema.Draft7Validator(schema)
    check_scenes(validator, source)
    check_broken(validator, source)
    check_pieces(validator, source)
    check_page(program, source)
    print(f"{failures} failures")
    return failures > 0


if __name__ == "__main__":
    sys.exit(main())
