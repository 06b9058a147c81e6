"""The tests: which mutants each case asks for, and runs of those cases against a mutant."""
import concurrent.futures
import hashlib
import itertools
import os
import pathlib
import resource
import shutil
import subprocess
import time

PROGRAMS = {"kernel_tests": "unit", "unit_tests": "unit", "short_tests": "validation stability", "validation_tests": "validation stability",
            "library_tests": "library"}
# Bash scripts that ask the program, for the readers and the messages; the last to be tried.
SCRIPTS = ("run_cli", "run_mistakes")
MEMORY = 6 << 30
NOT_FOUND = 99  # the exit status that main.cpp gives


class Suite:
    """The cases of a build; a case is a program and a name, or a script."""

    def __init__(self, tree, out, jobs, programs):
        self.tree, self.out, self.jobs, self.programs = tree, out, jobs, programs
        self.counter = itertools.count()

    def targets(self):
        """What must be built."""
        return [p for p in self.programs if p in PROGRAMS] + (["mpmfast"] if set(self.programs) & set(SCRIPTS) else [])

    def files(self):
        """(program, file of tests) of all that is run: slow cases are not."""
        for program in self.targets():
            for folder in PROGRAMS.get(program, "").split():
                for path in sorted((self.tree.tree / "tests" / folder).glob("*.cpp")):
                    if "TEST_CASE" in path.read_text():
                        yield program, path
        for script in filter(self.programs.__contains__, SCRIPTS):
            yield script, self.tree.tree / "tests/cli" / f"{script}.sh"

    def program(self, name):
        """The path of a test program."""
        return str(self.tree.bin / "tests" / name)

    def record(self, known, say):
        """What each case asks for: {file: {hash, cases: {name: {seconds, passed, asked}}}}; files that did not change
        keep what is known of them, but for those that gave no case: their program was not there."""
        recorded, waiting = dict(known), []
        for program, path in self.files():
            key, text = f"{program}:{path.stem}", hashlib.sha256(path.read_bytes()).hexdigest()
            if key in known and known[key]["hash"] == text and known[key]["cases"]:
                recorded[key] = known[key]
            else:
                waiting.append((key, program, path, text))
        say(f"{len(waiting)} files of tests are run")
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            for key, text, cases in pool.map(lambda t: (t[0], t[3], self.record_file(t[1], t[2])), waiting):
                recorded[key] = {"hash": text, "cases": cases}
        return recorded

    def record_file(self, program, path):
        """The cases of one file."""
        with self.place() as place:
            note = place.folder / "record"
            began = time.monotonic()
            command = self.command(program, [f"--source-file=*/{path.name}", "--test-case-exclude=slow:*"])
            done = place.run(command, {"MUTANT": "-1", "MUTANT_RECORD": str(note)}, 1800)
            took = time.monotonic() - began
            lines = [line.split("\t") for line in note.read_text().splitlines()] if note.exists() else []
        if program in SCRIPTS:
            asked = sorted({int(n) for line in lines for n in line[3].split()})
            return {program: {"seconds": took, "passed": done == 0, "asked": asked}}
        first = set()
        cases = {}
        for name, seconds, passed, asked in lines:
            numbers = {int(n) for n in asked.split()}
            if name in ("begin", "end"):
                first |= numbers if name == "begin" else set()
                continue
            cases[name] = {"seconds": float(seconds), "passed": passed == "1", "asked": sorted(numbers | first)}
        return cases

    def command(self, program, words):
        """How a program or script is run."""
        if program in SCRIPTS:
            return ["bash", f"{self.tree.tree}/tests/cli/{program}.sh", str(self.tree.bin / "mpmfast"), str(self.tree.tree)]
        return [self.program(program), *words]

    def place(self):
        """A folder of its own for a run."""
        return Place(self.out / "runs" / str(next(self.counter)))

    def kills(self, number, program, names, seconds):
        """Does this mutant fail one of these cases? "failed", "timeout" or ""."""
        with self.place() as place:
            environment = {"MUTANT": str(number)}
            command = self.command(program, ["--abort-after=1"])
            if program not in SCRIPTS:
                cases = place.folder / "cases"
                cases.write_text("".join(name + "\n" for name in names))
                environment["MUTANT_CASES"] = str(cases)
            code = place.run(command, environment, 10 + 6 * seconds)
            if code is None:  # a busy machine, or a loop without end?
                code = place.run(command, environment, 10 * (10 + 6 * seconds))
        if code == NOT_FOUND:
            raise SystemExit(f"tools/mutate: {program} does not know all of: {'; '.join(names)}")
        return {0: "", None: "timeout"}.get(code, "failed")


class Place:
    """A folder for the files of one run, which leaves nothing."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)

    def __enter__(self):
        shutil.rmtree(self.folder, ignore_errors=True)
        (self.folder / "tmp").mkdir(parents=True)
        return self

    def __exit__(self, *_):
        shutil.rmtree(self.folder, ignore_errors=True)

    def run(self, command, environment, seconds):
        """The exit status; None if it took longer."""
        def limit():
            os.setsid()
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        environment = dict(os.environ, OMP_NUM_THREADS="1", OMP_WAIT_POLICY="passive", TMPDIR=str(self.folder / "tmp"),
                           **environment)
        with open(self.folder / "output", "wb") as output:
            with subprocess.Popen(command, env=environment, cwd=self.folder, stdout=output, stderr=output,
                                  preexec_fn=limit) as process:
                try:
                    return process.wait(seconds)
                except subprocess.TimeoutExpired:
                    os.killpg(process.pid, 9)
                    process.wait()
                    return None
