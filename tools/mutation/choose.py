"""Which mutants a seed gives: the same in every run on the same sources, and nearly the same on those of next month."""
import dataclasses
import hashlib
import math
import pathlib

from mutation import places, tokens

# How often a kind is taken where a file has all of them.
KINDS = {"sign": 3, "comparison": 3, "term": 3, "coefficient": 3, "index": 2, "bound": 2, "min/max": 1, "abs": 1}
ROOMS = ("kernels", "engine")


@dataclasses.dataclass(frozen=True)
class Mutant:
    """A change of a file; its number is what the program is asked for."""

    number: int
    file: str
    line: int
    change: places.Change
    seed: int | None = None  # None: asked for by its line


def code_lines(code):
    """Lines that hold a token."""
    return len({code.count("\n", 0, token.begin) for token in tokens.tokens_of(code)})


def files_below(root, under):
    """The sources below these folders, or these files, in a fixed order."""
    found = set()
    for room in under:
        path = pathlib.Path(root, room)
        found |= {path} if path.is_file() else {f for f in path.rglob("*.[ch]pp")}
    if not found:
        raise SystemExit(f"tools/mutate: no sources below {' '.join(under)}")
    return sorted(str(f.relative_to(root)) for f in found)


def at_places(root, listed):
    """A mutant of each of these places, FILE:LINE: the first of the line, so that a line can be asked for by name."""
    chosen = []
    for place in listed:
        file, line = place.rsplit(":", 1)
        code = pathlib.Path(root, file).read_text()
        found = [c for c in places.changes_of(code) if code.count("\n", 0, c.begin) + 1 == int(line)]
        if not found:
            raise SystemExit(f"tools/mutate: nothing to change in {place}")
        found.sort(key=lambda c: list(KINDS).index(c.kind))
        chosen.append(Mutant(len(chosen) + 1, file, int(line), found[0]))
    return chosen


def lines_of(code, change):
    """The lines that a change stands on, their spaces put right."""
    first, last = code.rfind("\n", 0, change.begin) + 1, code.find("\n", change.end)
    return " ".join(code[first:last if last >= 0 else len(code)].split())


def ranked(file, code, seed):
    """[(rank, change)] of a file: the smaller the rank, the sooner a change is taken. Rank is exponential with the change's
    share as its rate, so that the smallest are a weighted draw without putting back; its random number is of the change and
    its line alone, so that a source that changes elsewhere keeps its mutants."""
    by_kind = {}
    for change in places.changes_of(code):
        by_kind.setdefault(change.kind, []).append(change)
    all_kinds, found, seen = sum(KINDS[kind] for kind in by_kind), [], {}
    for kind, changes in by_kind.items():
        share = code_lines(code) * KINDS[kind] / all_kinds / len(changes)
        for change in changes:
            what = (file, kind, change.before, change.after, lines_of(code, change))
            seen[what] = seen.get(what, 0) + 1
            digest = hashlib.sha256("\0".join((str(seed), *what, str(seen[what]))).encode()).digest()
            uniform = (int.from_bytes(digest[:8], "big") + 0.5) / 2**64
            found.append((-math.log(uniform) / share, change))
    return found


def choose(root, seeds, count, under=ROOMS, first=()):
    """The first `count` mutants of each seed, behind those that are asked for. Files are taken in proportion to their lines of
    code; no two mutants overlap, so that all fit into one build."""
    codes = {file: pathlib.Path(root, file).read_text() for file in files_below(root, under)}
    chosen, taken = list(first), {}
    for m in first:
        taken.setdefault(m.file, []).append((m.change.begin, m.change.end))
    for seed in seeds:
        waiting, found = [], 0
        for file, code in codes.items():
            waiting += [(rank, file, change) for rank, change in ranked(file, code, seed)]
        for _, file, change in sorted(waiting, key=lambda w: w[:2]):
            if found >= count:
                break
            if any(change.begin < end and begin < change.end for begin, end in taken.get(file, ())):
                continue
            taken.setdefault(file, []).append((change.begin, change.end))
            line = codes[file].count("\n", 0, change.begin) + 1
            chosen.append(Mutant(len(chosen) + 1, file, line, change, seed))
            found += 1
    return chosen


def first_of_each(mutants, count):
    """Those that are asked for, and the first `count` of each seed."""
    found = {}
    for m in mutants:
        found.setdefault(m.seed, []).append(m)
    return [m for seed, group in found.items() for m in (group if seed is None else group[:count])]


def room_of(file):
    """The row of the page that a file counts in."""
    for room in ("kernels", "engine/step", "engine/contact"):
        if file.startswith(room + "/"):
            return room
    return "elsewhere"
