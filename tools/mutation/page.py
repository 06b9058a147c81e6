"""The page: scores, and the survivors with the reasons why they change nothing that a test could notice."""
import datetime
import pathlib
import subprocess

from mutation import choose

REASONS = "tests/mutants.txt"
ROWS = ("kernels", "engine/step", "engine/contact", "elsewhere")
KILLED = ("failed", "timeout")


class Reasons:
    """Why mutants that were judged change nothing: a line each, `file :: before :: after :: why`, or with the line's text
    behind the file where others of the file look the same. Numbers of lines move, so none are used."""

    def __init__(self, root):
        self.root, self.found, self.codes = pathlib.Path(root), {}, {}
        path = self.root / REASONS
        for line in path.read_text().splitlines() if path.is_file() else ():
            parts = [part.strip() for part in line.split(" :: ")]
            if len(parts) in (4, 5) and not line.startswith("#"):
                self.found[tuple(parts[:-1])] = parts[-1]

    def get(self, mutant):
        """The reason, or nothing."""
        code = self.codes.get(mutant.file)
        if code is None:
            code = self.codes[mutant.file] = (self.root / mutant.file).read_text()
        of_file = mutant.change.before, mutant.change.after
        of_line = choose.lines_of(code, mutant.change), *of_file
        return self.found.get((mutant.file, *of_line)) or self.found.get((mutant.file, *of_file), "")


def state_of(mutant, state):
    """failed, timeout, survived or not covered; None where it was not tried."""
    return state["verdicts"].get(str(mutant.number), {}).get("state")


def table(head, groups, state, why):
    """Scores of groups of mutants."""
    lines = [f"| {head} | mutants | killed | by time | survived | not covered | change nothing | score | without these |",
             "|---|---|---|---|---|---|---|---|---|"]
    for name, mutants in groups:
        states = [state_of(m, state) for m in mutants]
        killed = sum(s in KILLED for s in states)
        same = sum(s not in KILLED and bool(why.get(m)) for m, s in zip(mutants, states))
        lines.append(f"| {name} | {len(mutants)} | {killed} | {states.count('timeout')} | {states.count('survived')} "
                     f"| {states.count('not covered')} | {same} | {percent(killed, len(mutants))} "
                     f"| {percent(killed, len(mutants) - same)} |")
    return lines


def percent(part, whole):
    """A share as people write it."""
    return f"{100 * part / whole:.0f} %" if whole else "-"


def grouped(mutants, of, order=None):
    """[(name, mutants)] and all of them."""
    names = order or sorted({of(m) for m in mutants})
    groups = [(name, [m for m in mutants if of(m) == name]) for name in names]
    return [g for g in groups if g[1]] + [("all", mutants)]


def tried(mutants, state):
    """The mutants that have a verdict."""
    return [m for m in mutants if state_of(m, state)]


def summary(mutants, state, why):
    """The scores by folder."""
    return "\n".join(table("folder", grouped(tried(mutants, state), lambda m: choose.room_of(m.file), ROWS), state, why))


def page(root, mutants, state, asked):
    """The whole page."""
    why, mutants = Reasons(root), tried(mutants, state)
    cases = [c for file in state["tests"].values() for c in file["cases"].values()]
    failing = [name for file in state["tests"].values() for name, c in file["cases"].items() if not c["passed"]]
    lines = ["# Mutants", "", "Made by `tools/mutate`; [how it works](README.md#mutants).", "",
             f"{datetime.date.today().isoformat()}, commit {commit(root)}, {seeds_of(asked)}, {len(mutants)} mutants below "
             f"{', '.join(f'`{u}`' for u in asked.under)}; {len(cases)} cases; {state['seconds'] / 60:.0f} minutes with "
             f"{asked.jobs} processes. A mutant met the cases that ask for it, quickest first, for {asked.patience:g} s of "
             "their time. Slow cases were not run."]
    if failing:
        lines += ["", "Not used, as they fail in this build without a mutant: " + "; ".join(sorted(failing)) + "."]
    by_seed = [*table("seed", grouped(mutants, lambda m: str(m.seed)), state, why), ""] if len(asked.seed) > 1 else []
    lines += ["", *table("folder", grouped(mutants, lambda m: choose.room_of(m.file), ROWS), state, why),
              "", *by_seed, *table("kind", grouped(mutants, lambda m: m.change.kind), state, why), "",
              "## Survivors", "", "| place | kind | before | after | | why |", "|---|---|---|---|---|---|"]
    for m in sorted(mutants, key=lambda m: (m.file, m.line)):
        verdict = state_of(m, state)
        if verdict not in KILLED:
            lines.append(f"| {m.file}:{m.line} | {m.change.kind} | {quoted(m.change.before)} | {quoted(m.change.after)} "
                         f"| {verdict} | {why.get(m)} |")
    return "\n".join(lines) + "\n"


def seeds_of(asked):
    """Which seeds, in words."""
    return f"seed{'s' if len(asked.seed) > 1 else ''} {', '.join(str(s) for s in asked.seed)}"


def quoted(text):
    """Code in a cell of a table."""
    short = text if len(text) <= 90 else text[:86] + " ..."
    return "`` " + short.replace("|", "\\|") + " ``"


def commit(root):
    """The commit of the sources."""
    done = subprocess.run(["git", "describe", "--always", "--dirty"], cwd=root, capture_output=True, text=True, check=False)
    return done.stdout.strip() or "unknown"
