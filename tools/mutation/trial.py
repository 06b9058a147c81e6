"""Runs the mutants: each meets the cases that ask for it, quickest first, until one fails."""
import concurrent.futures
import threading

FIRST_BATCH = 1.0  # seconds of cases in the first run of a mutant; each later run may take three times as long


def cases_of(tests):
    """{mutant: [(seconds, program, name, hash of its file)]}, quickest first; cases that fail unchanged are left out."""
    asked = {}
    for key, file in tests.items():
        program = key.split(":")[0]
        for name, case in file["cases"].items():
            if case["passed"]:
                for number in case["asked"]:
                    asked.setdefault(number, []).append((case["seconds"], program, name, file["hash"]))
    return {number: sorted(cases) for number, cases in asked.items()}


def batches(cases, patience):
    """Runs of one program each: short ones first, so that most mutants take a second."""
    room, total, batch = FIRST_BATCH, 0.0, {}
    size = 0.0
    for case in cases:
        if total + case[0] > patience and total > 0:
            break
        if size + case[0] > room and batch:
            yield from batch.values()
            batch, size, room = {}, 0.0, 3 * room
        batch.setdefault(case[1], []).append(case)
        size += case[0]
        total += case[0]
    yield from batch.values()


def try_one(mutant, cases, met, suite, patience):
    """What becomes of a mutant: {state, by, met, left}; `met` are cases that it has survived."""
    new = [c for c in cases if f"{c[1]}:{c[2]}:{c[3]}" not in met]
    verdict = {"state": "survived" if cases else "not covered", "met": list(met)}
    for batch in batches(new, patience):
        result = suite.kills(mutant.number, batch[0][1], [c[2] for c in batch], sum(c[0] for c in batch))
        if result:
            return {"state": result, "by": [c[2] for c in batch][:3]}
        verdict["met"] += [f"{c[1]}:{c[2]}:{c[3]}" for c in batch]
    verdict["left"] = len(cases) - len(verdict["met"])
    return verdict


def try_all(mutants, state, suite, asked, say, save):
    """Tries every mutant that is not killed yet."""
    cases, verdicts, lock = cases_of(state["tests"]), state["verdicts"], threading.Lock()
    again = {str(n) for n in asked.only or ()}
    waiting = [m for m in mutants if (str(m.number) in again if again else
            verdicts.get(str(m.number), {}).get("state") not in ("failed", "timeout"))]
    say(f"{len(waiting)} mutants are tried")

    def one(mutant):
        key = str(mutant.number)
        covering = cases.get(mutant.number, [])
        current = {f"{c[1]}:{c[2]}:{c[3]}" for c in covering}
        met = [] if key in again else [c for c in verdicts.get(key, {}).get("met", []) if c in current]
        verdict = try_one(mutant, covering, met, suite, asked.patience)
        with lock:
            verdicts[key] = verdict
            save()
            say(f"{mutant.number} {mutant.file}:{mutant.line} {verdict['state']}")
    with concurrent.futures.ThreadPoolExecutor(asked.jobs) as pool:
        list(pool.map(one, waiting))
