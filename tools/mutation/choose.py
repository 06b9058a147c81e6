"""Which mutants a seed gives: the same in every run on the same sources."""
import dataclasses
import pathlib
import random

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


def choose(root, seed, count, under=ROOMS, first=()):
    """The first mutants of a seed, behind those that are asked for. Files are taken in proportion to their lines of code;
    no two mutants overlap, so that all fit into one build."""
    draw = random.Random(seed)
    files, weights, changes = [], [], {}
    for file in files_below(root, under):
        code = pathlib.Path(root, file).read_text()
        by_kind = {}
        for change in places.changes_of(code):
            by_kind.setdefault(change.kind, []).append(change)
        if by_kind:
            files.append(file)
            weights.append(code_lines(code))
            changes[file] = (code, by_kind)
    chosen, taken, tries = list(first), {file: [] for file in files}, 0
    for m in first:
        taken.setdefault(m.file, []).append((m.change.begin, m.change.end))
    while files and len(chosen) < count and tries < 50 * count:
        tries += 1
        file = draw.choices(files, weights)[0]
        code, by_kind = changes[file]
        kind = draw.choices(list(by_kind), [KINDS[k] for k in by_kind])[0]
        change = draw.choice(by_kind[kind])
        if any(change.begin < end and begin < change.end for begin, end in taken[file]):
            continue
        taken[file].append((change.begin, change.end))
        chosen.append(Mutant(len(chosen) + 1, file, code.count("\n", 0, change.begin) + 1, change))
    return chosen


def room_of(file):
    """The row of the page that a file counts in."""
    for room in ("kernels", "engine/step", "engine/contact"):
        if file.startswith(room + "/"):
            return room
    return "elsewhere"
