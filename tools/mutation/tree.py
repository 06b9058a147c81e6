"""The copy of the sources that holds all mutants at once, each behind a switch, and its build. Mutants that do not
compile are found by the compiler's messages and left out."""
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess

HERE = pathlib.Path(__file__).parent
# Assertions of the libraries stand for what the sanitizers find in the ordinary tests.
FLAGS = "-O2 -g0 -D_GLIBCXX_ASSERTIONS -Werror=vla -fmax-errors=0"
# Objects whose sources instantiate what kernels/ and engine/ have in headers.
LOOKED_AT = re.compile(r" -o engine/\S*/(mpmfast_step|mpmfast_contact|mpmfast_conditions)\.dir/")
PLACE = re.compile(r"^(/[^\s:]+|\.\.?/[^\s:]+):(\d+):(?:\d+:)?")


class Tree:
    """The copy in `out/tree` and its build in `out/bin`."""

    def __init__(self, root, out, jobs, looked_at=False):
        self.looked_at = looked_at
        self.root, self.tree, self.bin, self.jobs = pathlib.Path(root), out / "tree", out / "bin", jobs
        self.log = out / "build.log"
        # The commit would be asked for, and each new one would build much again.
        self.environment = dict(os.environ, GIT_CEILING_DIRECTORIES=str(out))

    def copy(self):
        """All files that git knows or would take, except the sources that hold mutants."""
        listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=self.root,
                                check=True, capture_output=True).stdout.decode().split("\0")
        for name in filter(None, listed):
            source = self.root / name
            if source.is_file() and not re.match(r"(kernels|engine)/.*\.[ch]pp$", name):
                put(self.tree / name, source.read_bytes(), source.stat().st_mode)
        put(self.tree / "mutation_switch.hpp", (HERE / "switch.hpp").read_bytes())
        put(self.tree / "tests/main.cpp", self.test_main())

    def test_main(self):
        """The main function of the tests, with what else that file of theirs holds."""
        own = (self.root / "tests/main.cpp").read_text().replace("DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN", "MAIN_IS_BELOW")
        return ((HERE / "main.cpp").read_text() + "\n" + own).encode()

    def write_sources(self, mutants):
        """The sources with these mutants in them; files that stay the same keep their time."""
        by_file = {}
        for mutant in mutants:
            by_file.setdefault(mutant.file, []).append(mutant)
        for room in ("kernels", "engine"):
            for path in (self.root / room).rglob("*.[ch]pp"):
                name = str(path.relative_to(self.root))
                put(self.tree / name, switched(path.read_text(), by_file.get(name, [])).encode())

    def configure(self):
        """Configures the build, once."""
        self.run(["cmake", "-S", self.tree, "-B", self.bin, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=None",
                  f"-DCMAKE_CXX_FLAGS={FLAGS}", "-DMPMFAST_PRECOMPILE=ON", "-DMPMFAST_UNITY=ON", "-DMPMFAST_BENCH=OFF"], check=True)

    def run(self, command, check=False):
        """Runs a command of the build; its output goes to the log, and is returned."""
        done = subprocess.run([str(c) for c in command], env=self.environment, text=True, errors="replace",
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        with open(self.log, "a", encoding="utf-8") as log:
            log.write(done.stdout)
        if check and done.returncode:
            raise SystemExit(f"tools/mutate: {command[0]} failed: see {self.log}")
        return done

    def build(self, mutants, targets, say, keep):
        """Builds the tests with all mutants that compile, and returns these; keep(mutants, whether all headers were looked
        at) where some are left out."""
        self.copy()
        self.write_sources(mutants)
        self.configure()
        commands = [c for c in json.loads((self.bin / "compile_commands.json").read_text()) if LOOKED_AT.search(c["command"])]
        if self.looked_at:
            commands = []
        self.run(["ninja", "-C", self.bin, "-j", self.jobs, "engine/CMakeFiles/mpmfast_quantities.dir/cmake_pch.hxx.gch"])
        while commands:  # headers with templates: each that changes later has them built again
            say(f"{len(mutants)} mutants: {len(commands)} files are looked at")
            commands, output = self.broken(commands)
            if commands:
                mutants = self.without_broken(mutants, output, say)
                keep(mutants, False)
        keep(mutants, True)
        while True:
            say(f"{len(mutants)} mutants: building")
            done = self.run(["ninja", "-C", self.bin, "-j", self.jobs, "-k", "0", *targets])
            if done.returncode == 0:
                return mutants
            mutants = self.without_broken(mutants, done.stdout, say)
            keep(mutants, True)

    def broken(self, commands):
        """Those of the compiler's commands that fail, and what they say."""
        def check(command):
            words = shlex.split(command["command"])
            at = words.index("-o")
            words[at:at + 2] = ["-fsyntax-only"]
            return subprocess.run(words, cwd=command["directory"], capture_output=True, text=True, errors="replace",
                                  check=False)
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            results = list(pool.map(check, commands))
        bad = [(c, r.stderr) for c, r in zip(commands, results) if r.returncode]
        with open(self.log, "a", encoding="utf-8") as log:
            log.writelines(text for _, text in bad)
        return [c for c, _ in bad], "".join(text for _, text in bad)

    def without_broken(self, mutants, output, say):
        """The mutants but those that the messages point to, in sources that were written again."""
        guilty = self.guilty(mutants, output)
        if not guilty:
            raise SystemExit(f"tools/mutate: the build fails for no mutant's sake: see {self.log}")
        say(f"{len(guilty)} mutants do not compile")
        left = [m for m in mutants if m.number not in guilty]
        self.write_sources(left)
        return left

    def guilty(self, mutants, output):
        """Numbers of the mutants at the places of errors; where there is none, at those that an error's text names."""
        spans = {}
        for m in mutants:
            last = m.line + self.lines_of(m)
            spans.setdefault(str(self.tree / m.file), []).append((m.line, last, m.number))
        found, around = set(), []
        def at(place):
            return {n for first, last, n in spans.get(place[0], []) if first <= place[1] <= last}
        pending = None
        for line in output.splitlines() + ["/end:1:1: error: end"]:
            place = PLACE.match(line)
            place = (os.path.normpath(place.group(1)), int(place.group(2))) if place else None
            if ": In " in line or " In file included" in line:
                around = []
            if place and ": error:" in line:
                found |= pending or set()
                pending = at(place)
                if not pending:
                    pending = next((at(p) for p in around if at(p)), set())
            elif place and pending is not None and not pending:
                pending = at(place)
            if place and "required from" in line:
                around.append(place)
        return found

    def lines_of(self, mutant):
        """How many more lines a mutant's place has."""
        code = (self.root / mutant.file).read_text()
        return code.count("\n", mutant.change.begin, mutant.change.end)


def put(path, content, mode=None):
    """Writes a file if that changes it."""
    if path.is_file() and path.read_bytes() == content:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)
    if mode is not None:
        path.chmod(mode & 0o777)


def switched(code, mutants):
    """A source with its mutants behind their switches; lines keep their numbers."""
    if not mutants:
        return code
    parts, end = ['#include "mutation_switch.hpp"\n#line 1\n'], 0
    for m in sorted(mutants, key=lambda m: m.change.begin):
        before, after = code[m.change.begin:m.change.end], m.change.after
        asked = f"(::mutation::on({m.number}) ? "
        if m.change.statement:
            after = "(void)0" if after == "{}" else f"(void)({after})"
            guarded = f"{asked}{after} : (void)({before}))"
        else:
            guarded = f"{asked}::mutation::plain({after}) : ::mutation::plain({before}))"
        parts += [code[end:m.change.begin], guarded]
        end = m.change.end
    return "".join(parts + [code[end:]])
