"""The command line of tools/mutate."""
import argparse
import hashlib
import json
import os
import pathlib
import sys
import time

from mutation import choose, page, places, trial
from mutation.suite import PROGRAMS, SCRIPTS, Suite
from mutation.tree import Tree

ROOT = pathlib.Path(__file__).resolve().parents[2]
SPARE = 1.35  # so many more are drawn than asked for: some do not compile


def arguments(words):
    """What is asked for."""
    parser = argparse.ArgumentParser(prog="tools/mutate", description="Changes the sources of kernels/ and engine/ in one "
                                     "place at a time, as a slip would, and counts how many of these mutants the tests notice.")
    parser.add_argument("--seed", type=int, nargs="+", default=[1], help="which mutants (default 1); several go into one build")
    parser.add_argument("--count", type=int, default=300, help="how many of each seed that compile (default 300)")
    parser.add_argument("--under", nargs="+", default=list(choose.ROOMS), metavar="PATH", help="folders or files to change")
    parser.add_argument("--also", nargs="+", default=[], metavar="FILE:LINE", help="first of all a mutant of each of these lines")
    parser.add_argument("--list", action="store_true", help="print the mutants that would be tried, and stop")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "build/mutants", help="folder (default build/mutants)")
    parser.add_argument("--resume", action="store_true", help="go on: mutants that are killed stay so, others meet the tests "
                        "that are new or that they have not met")
    parser.add_argument("--patience", type=float, default=30, help="seconds of tests that a mutant must survive (default 30)")
    parser.add_argument("--tests", nargs="+", choices=[*PROGRAMS, *SCRIPTS], metavar="PROGRAM",
                        default=[p for p in (*PROGRAMS, *SCRIPTS) if p != "kernel_tests"],  # which unit_tests hold too
                        help="with these alone, to go on with the others later: " + " ".join([*PROGRAMS, *SCRIPTS]))
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="processes side by side")
    parser.add_argument("--page", type=pathlib.Path, help="write the page there too")
    parser.add_argument("--only", type=int, nargs="+", help="with --resume: these mutants again, whatever became of them")
    return parser.parse_args(words)


def main(words):
    """Builds the mutants, records the tests, tries each mutant, writes the page."""
    asked = arguments(words)
    if asked.list:
        for m in draw(asked, asked.count):
            print(f"{m.number}\t{m.file}:{m.line}\t{m.change.kind}\t{m.change.before} -> {m.change.after}")
        return 0
    out = asked.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    began = time.monotonic()

    def say(text):
        print(f"[{time.monotonic() - began:6.0f} s] {text}", file=sys.stderr, flush=True)
    state = read_state(out, asked)
    tree = Tree(ROOT, out, asked.jobs, state.get("looked_at", False))

    def keep(mutants, looked_at):
        state["mutants"], state["looked_at"] = [as_json(m) for m in mutants], looked_at
        write(out / "state.json", state)
    suite = Suite(tree, out, asked.jobs, asked.tests)
    mutants = tree.build([as_mutant(m) for m in state["mutants"]], suite.targets(), say, keep)
    asked_for = choose.first_of_each(mutants, asked.count)
    state["tests"] = suite.record(state["tests"], say)
    write(out / "state.json", state)
    trial.try_all(asked_for, state, suite, asked, say, lambda: write(out / "state.json", state))
    state["seconds"] += time.monotonic() - began
    write(out / "state.json", state)
    text = page.page(ROOT, asked_for, state, asked)
    for path in filter(None, (out / "mutants.md", asked.page)):
        path.write_text(text)
    print(page.summary(asked_for, state, page.Reasons(ROOT)))
    return 0


def draw(asked, count):
    """The mutants that are asked for, and those of the seeds."""
    return choose.choose(ROOT, asked.seed, count, asked.under, choose.at_places(ROOT, asked.also))


def read_state(out, asked):
    """What is known of these mutants: all of it with --resume, the choice alone without."""
    path = out / "state.json"
    key = [asked.seed, asked.count, asked.under, asked.also, sources_of(ROOT)]
    old = json.loads(path.read_text()) if path.is_file() else None
    if asked.resume:
        if not old or old["key"] != key:
            raise SystemExit("tools/mutate: nothing to go on with: the seed, the count, the folders or the sources differ")
        return old
    drawn = draw(asked, int(asked.count * SPARE))
    return {"key": key, "mutants": [as_json(m) for m in drawn], "tests": {}, "verdicts": {}, "seconds": 0.0}


def sources_of(root):
    """One number for all that can be changed."""
    sums = hashlib.sha256()
    for file in choose.files_below(root, choose.ROOMS):
        sums.update(file.encode() + b"\0" + pathlib.Path(root, file).read_bytes())
    return sums.hexdigest()


def as_json(mutant):
    """A mutant as a list of plain values."""
    c = mutant.change
    return [mutant.number, mutant.file, mutant.line, c.kind, c.begin, c.end, c.before, c.after, c.statement, mutant.seed]


def as_mutant(row):
    """The mutant of such a list."""
    return choose.Mutant(row[0], row[1], row[2], places.Change(*row[3:9]), row[9])


def write(path, state):
    """Writes what is known, whole or not at all."""
    new = path.with_suffix(".new")
    new.write_text(json.dumps(state))
    new.replace(path)
