#!/usr/bin/python3
"""Runs the scenes of configs/ for some steps with two programs and compares what comes of them.

usage: checksums.py OLD NEW [--steps N] [--only REGEX] [--keep DIR]

OLD and NEW are two builds of mpmfast. A scene takes N steps (50), large ones fewer, so that each takes about a second. The
table has `checksum` of run.json, which is the same where all particles are the same bits. Where it differs, the table has
the largest difference of a column of history.csv, over the largest value of that column. Exit status 1 where a scene
differs, 2 where a program refuses a scene. Studies are left out.
"""
import argparse
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile

CONFIGS = pathlib.Path(__file__).resolve().parents[2] / "configs"
FOLDERS = ("", "bench", "hard", "starters")
# Scenes of many particles: their steps over those of the others.
LARGE = {"bench/block-3d.yaml": 0.04, "slanted_crack.yaml": 0.25, "crack_wave.yaml": 0.4, "grains_box.yaml": 0.4,
         "sphere_pair.yaml": 0.4, "bench/block-2d.yaml": 0.5, "bench/block-2d-20fields.yaml": 0.5,
         "bench/block-2d-cpdi.yaml": 0.5, "bench/block-2d-crack.yaml": 0.5}
FAILED = 3    # exit code of a run that ended physically: its results count
QUIET = ("output.frames=0", "output.picture=none", "output.checkpoint=none")


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--steps", type=int, default=50)
    parser.add_argument("--only", default="", help="scenes whose path in configs/ has a match")
    parser.add_argument("--keep", type=pathlib.Path, help="a folder for the output of the runs")
    return parser.parse_args()


def scenes(pattern):
    """The paths of the scenes, by their names in configs/."""
    paths = [path for folder in FOLDERS for path in sorted((CONFIGS / folder).glob("*.yaml"))]
    names = {path.relative_to(CONFIGS).as_posix(): path for path in paths}
    return {name: path for name, path in names.items() if re.search(pattern, name)}


def run(program, scene, steps, folder):
    """The report of a run and the rows of its history."""
    sets = [word for one in QUIET for word in ("--set", one)]
    command = [program, "run", scene, "--steps", str(steps), "--out", folder, "--force", "--progress", "none",
               "--threads", "1", *sets]
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode not in (0, FAILED):
        print(f"checksums: {program} run {scene}: exit {done.returncode}\n{done.stderr}", file=sys.stderr)
        sys.exit(2)
    report = json.loads((folder / "run.json").read_text(encoding="utf-8"))
    with (folder / "history.csv").open(encoding="utf-8", newline="") as file:
        return report, list(csv.DictReader(file))


def largest_difference(old, new):
    """The column that differs most, and by how much; in words where the histories have different shapes."""
    if len(old) != len(new) or list(old[0]) != list(new[0]):
        return "rows or columns differ"
    worst, where = 0.0, ""
    for column in old[0]:
        a, b = ([float(row[column]) for row in rows] for rows in (old, new))
        scale = max(map(abs, a + b))
        share = max(abs(x - y) for x, y in zip(a, b)) / scale if scale > 0 else 0.0
        if not share <= worst:    # also where it is no number
            worst, where = share, column
    return f"{worst:.1e} {where}" if where else "none in history.csv"


def main():
    arguments = read_arguments()
    different, chosen = 0, scenes(arguments.only)
    if not chosen:
        sys.exit(f"checksums: no scene matches {arguments.only}")
    print("| scene | steps | old | new | largest difference |\n|---|---|---|---|---|")
    with tempfile.TemporaryDirectory(prefix="checksums-") as work:
        root = arguments.keep or pathlib.Path(work)
        for name, scene in chosen.items():
            steps = max(1, round(arguments.steps * LARGE.get(name, 1)))
            folders = [root / side / name.removesuffix(".yaml") for side in ("old", "new")]
            old, new = (run(program, scene, steps, folder)
                        for program, folder in zip((arguments.old, arguments.new), folders))
            same = all(old[0][key] == new[0][key] for key in ("checksum", "status", "steps"))
            words = "" if same else largest_difference(old[1], new[1])
            print(f"| {name} | {new[0]['steps']} | {old[0]['checksum']} | {new[0]['checksum']} | {words} |", flush=True)
            different += not same
    print(f"{len(chosen)} scenes, {different} different")
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
