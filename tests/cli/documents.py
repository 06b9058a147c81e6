#!/usr/bin/python3
"""Keeps the Markdown files of the repository true: what they tell a reader to type is typed, and where they point
to is looked up. A file of the sources that they name in backticks exists, and so does one named in a comment of the
sources.

usage: documents.py MPMFAST SOURCE_DIR [--slow] [--only FILE.md]
       documents.py --links FOLDER    of all pages in a folder, such as an installed one, the links alone

A mark is an HTML comment on the line before a fenced block, which a reader of the page does not see:

  <!-- run -->              the shell or Python block is run and must succeed
  <!-- run: exit 2 -->      it must end with this exit code
  <!-- run: short -->       every `mpmfast run` in it ends after a few steps
  <!-- run: slow -->        with --slow only
  <!-- run: needs WORD -->  only where there is the program WORD or the Python module python.WORD; left out elsewhere,
                            which is said
  <!-- not run: REASON -->  a shell block that cannot be run here
  <!-- output -->           each line of the block stands in what the block run last printed; ... stands for anything
  <!-- scene: NAME.yaml --> a whole scene, which `mpmfast check` accepts; with a name the blocks after it find it
  <!-- file: NAME -->       any other file for the blocks after it

Words may be joined: <!-- run: short, needs gnuplot -->. The blocks of one page share a folder with a link to configs/
and run in their order, `mpmfast` and `python3` (Debian's) on the path. Every block in sh must have a mark.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unicodedata

try:
    import yaml
except ImportError:
    if sys.argv[1:2] != ["--links"]:
        print("PyYAML is missing: tools/setup tests")
        sys.exit(77)

SHORT_STEPS = 30
FENCE = re.compile(r"^(\s*)(```+)\s*(\S*)\s*$")
MARK = re.compile(r"^\s*<!--\s*(not run|run|output|scene|file)\s*(?::\s*(.*?))?\s*-->\s*$")
LINK = re.compile(r"!?\[[^\]]*\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)|<img[^>]*\bsrc=\"([^\"]+)\"")
LONGEST = {"README.md": 120}    # lines: what a reader who does not know the project yet takes in at once
NOT_OURS = {"build", "runs", ".git", "node_modules"}
SOURCE_FOLDERS = ("bench", "cmake", "configs", "engine", "kernels", "tests", "tools")
NAMED_FILE = re.compile(r"(?:\.{1,2}/)*[A-Za-z0-9_.+-]+(?:/[A-Za-z0-9_.+-]+)*/?")
INSTALLED, HEADERS = "mpmfast", "engine/library"    # where programs find the headers of the library
CODE = (".cpp", ".hpp", ".py", ".sh", ".in", ".cmake")

failures = []
checks = 0


def expect(holds, place, message):
    """Counts a check and keeps what it found wrong."""
    global checks
    checks += 1
    if not holds:
        failures.append(f"{place}: {message}")
        print(f"{place}: {message}", file=sys.stderr)


class Block:
    """A fenced block of a page with the mark above it."""

    def __init__(self, page, line, language, mark, words, text):
        self.place, self.language, self.mark, self.text = f"{page}:{line}", language, mark, text
        self.words = [word.strip() for word in words.split(",")] if words else []

    def has(self, word):
        return word in self.words

    def after(self, word):
        return [w[len(word) + 1:].strip() for w in self.words if w.startswith(word + " ")]


def read_page(path, name):
    """The blocks of a page, and its lines outside of them with their numbers."""
    blocks, prose, mark, words = [], [], None, ""
    lines = path.read_text(encoding="utf-8").splitlines()
    at = 0

    def drop_mark(line):
        expect(mark is None, f"{name}:{line}", f"a mark ({mark}) without a block after it")

    while at < len(lines):
        fence, found = FENCE.match(lines[at]), MARK.match(lines[at])
        if fence:
            begin, indent, ticks = at, len(fence[1]), fence[2]
            at += 1
            while at < len(lines) and lines[at].strip() != ticks:
                at += 1
            text = "\n".join(line[min(indent, len(line) - len(line.lstrip())):] for line in lines[begin + 1:at])
            blocks.append(Block(name, begin + 1, fence[3], mark, words, text + "\n"))
            mark, words = None, ""
        elif found:
            drop_mark(at)
            mark, words = found[1], found[2] or ""
        elif lines[at].strip():
            drop_mark(at)
            mark, words = None, ""
            prose.append((at + 1, lines[at]))
        at += 1
    drop_mark(at)
    return blocks, prose


def prepare_path(bin_folder, program):
    """mpmfast, a short one for marks that ask for it, and Debian's Python under the name that readers type."""
    for folder, words in (("full", ""), ("short", f"--steps {SHORT_STEPS}")):
        place = bin_folder / folder
        place.mkdir(parents=True)
        wrapper = place / "mpmfast"
        wrapper.write_text("#!/bin/sh\n"
                           f"if [ \"${{1:-}}\" = run ]; then exec '{program}' \"$@\" {words}; fi\n"
                           f"exec '{program}' \"$@\"\n")
        wrapper.chmod(0o755)
        (place / "python3").symlink_to("/usr/bin/python3")


def is_there(word, environment):
    """Is there the program, or the Python module (python.WORD)?"""
    kind, _, name = word.partition(".")
    if kind == "python" and name:
        return subprocess.run(["/usr/bin/python3", "-c", f"import {name}"], capture_output=True,
                              env=environment).returncode == 0
    return shutil.which(word) is not None


def missing_lines(wanted, printed):
    """Lines of `wanted` that no line of `printed` matches."""
    missing = []
    for line in wanted.splitlines():
        if not line.strip() or line.strip() == "...":
            continue
        pattern = ".*".join(re.escape(" ".join(part.split())) for part in line.replace("…", "...").split("..."))
        pattern = re.compile(pattern.replace(r"\ ", r"\s+"))
        if not any(pattern.search(" ".join(text.split())) for text in printed.splitlines()):
            missing.append(line)
    return missing


class Runner:
    """Runs the blocks of one page in a folder of its own."""

    def __init__(self, folder, program, source, slow):
        self.folder, self.program, self.slow = folder, program, slow
        self.bin = folder.with_name(folder.name + ".bin")
        folder.mkdir()
        (folder / "configs").symlink_to(source / "configs")
        prepare_path(self.bin, program)
        # The Python module, where the build has it, lies beside the program.
        self.environment = {**os.environ, "OMP_WAIT_POLICY": "passive",
                            "PYTHONPATH": os.path.join(os.path.dirname(program), "python")}
        self.printed, self.ran, self.left_out = None, 0, []

    def run(self, block):
        for word in block.after("needs"):
            if not is_there(word, self.environment):
                self.left_out.append(f"{block.place}: no {word}")
                self.printed = None
                return
        if block.has("slow") and not self.slow:
            self.printed = None
            return
        path = f"{self.bin / ('short' if block.has('short') else 'full')}:{os.environ['PATH']}"
        command = ["/usr/bin/python3", "-c"] if block.language == "python" else ["bash", "-euo", "pipefail", "-c"]
        done = subprocess.run(command + [block.text], cwd=self.folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="utf-8", errors="replace",
                              env={**self.environment, "PATH": path})
        self.printed = done.stdout
        self.ran += 1
        codes = [int(code) for code in block.after("exit")] or [0]
        tail = "\n".join(done.stdout.splitlines()[-15:])
        expect(done.returncode in codes, block.place, f"exit code {done.returncode}, not {codes[0]}:\n{tail}")

    def write(self, block):
        for name in block.words:
            path = (self.folder / name).resolve()
            inside = self.folder.resolve() in path.parents
            expect(inside, block.place, f"{name} is no file of the page's folder")
            if not inside:
                continue
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(block.text, encoding="utf-8")

    def check_scene(self, block):
        block.words = block.words or ["unnamed_scene.yaml"]
        self.write(block)
        path = self.folder / block.words[0]
        done = subprocess.run([self.program, "check", path.name], cwd=self.folder, capture_output=True, text=True)
        expect(done.returncode == 0, block.place, f"mpmfast check refuses the scene:\n{done.stderr}")

    def do(self, block):
        if block.mark == "run":
            self.run(block)
        elif block.mark == "output" and self.printed is not None:
            missing = missing_lines(block.text, self.printed)
            expect(not missing, block.place, f"not printed: {missing}\nbut:\n{self.printed[-3000:]}")
        elif block.mark == "scene":
            self.check_scene(block)
        elif block.mark == "file":
            self.write(block)
        elif block.language == "sh":
            expect(block.mark == "not run" and any(block.words), block.place,
                   "a shell block without a mark: <!-- run -->, or <!-- not run: REASON -->")


def anchors_of(path):
    """What GitHub makes of the headings of a page."""
    _, prose = read_page(path, path.name)
    anchors = set()
    for _, line in prose:
        heading = re.match(r"^#+\s+(.*?)\s*#*$", line)
        if not heading:
            continue
        text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading[1]).lower()
        kept = [c for c in text if c in " -_" or unicodedata.category(c)[0] in "LN"]
        anchor, number = "".join(kept).replace(" ", "-"), 0
        while (anchor if number == 0 else f"{anchor}-{number}") in anchors:
            number += 1
        anchors.add(anchor if number == 0 else f"{anchor}-{number}")
    return anchors


def check_links(path, name, prose, source):
    """Relative links and pictures exist, inside the folder of the pages, and so do the headings that they name."""
    for number, line in prose:
        line = re.sub(r"`[^`]*`", "", line)
        for found in LINK.finditer(line):
            target = found[1] or found[2]
            if re.match(r"^[a-z][a-z0-9+.-]*:", target):
                continue
            file, _, anchor = target.partition("#")
            there = (path.parent / file).resolve() if file else path
            inside = there == source or source in there.parents
            expect(inside and there.exists(), f"{name}:{number}", f"no such file: {target}")
            if anchor and there.is_file() and there.suffix == ".md":
                expect(anchor in anchors_of(there), f"{name}:{number}", f"no such heading: {target}")


def files_of(source):
    """The paths of all files of the tree, with slashes before them, and of its folders with slashes around them."""
    found = set()
    for folder, folders, names in os.walk(source):
        inside = pathlib.Path(folder).relative_to(source)
        folders[:] = [one for one in folders if one not in NOT_OURS and one != "__pycache__"]
        found |= {f"/{(inside / one).as_posix()}" for one in names}
        found |= {f"/{(inside / one).as_posix()}/" for one in folders}
    return found


def is_named_file(word):
    """Does the word name a file of the sources? It has the ending of code, or begins with a folder of the tree."""
    if not NAMED_FILE.fullmatch(word) or word.startswith(".") or "NAME" in word:
        return False
    return word.endswith(CODE) or "/" in word.rstrip("/") and word.split("/")[0] in SOURCE_FOLDERS


def is_in_tree(word, page, files):
    """Is it there from the root or from a folder above the page? A bare name may stand in any folder, but one of a test
    only on pages about tests and their results."""
    if "/" not in word:
        tests = page.startswith(("tests/", "bench/", "configs/", "CHANGELOG"))
        return any(file.endswith("/" + word) and (tests or not file.startswith("/tests/")) for file in files)
    if word.startswith(f"{INSTALLED}/") and word.endswith(".hpp"):
        word = f"{HEADERS}/{word.partition('/')[2]}"
    folders = ["", *(f"/{folder.as_posix()}" for folder in pathlib.PurePosixPath(page).parents if folder.name)]
    path = "/" + word.rstrip("/")
    return any(folder + path in files or f"{folder}{path}/" in files for folder in folders)


def check_files(name, prose, written, files):
    """Files of the sources that stand in backticks exist, but for those that the page's blocks write."""
    for number, line in prose:
        for text in re.findall(r"`([^`]+)`", line):
            for word in text.split():
                word = word.strip("(),;:\"'")
                if is_named_file(word) and word not in written:
                    expect(is_in_tree(word, name, files), f"{name}:{number}", f"no such file: {word}")


def check_comments(source, files):
    """Paths of files of the tree that stand in comments of the sources exist."""
    for folder in SOURCE_FOLDERS:
        for path in sorted((source / folder).rglob("*")):
            if path.suffix not in (*CODE, ".txt", ".yaml", "") or not path.is_file():
                continue
            for number, line in enumerate(path.read_text(encoding="utf-8", errors="replace").splitlines(), 1):
                comment = re.search(r"(?://|#(?!include))\s(.*)$", line)
                for word in re.findall(r"[\w./+-]+", comment[1]) if comment else ():
                    word = word.rstrip(".")
                    if word.split("/")[0] in SOURCE_FOLDERS and re.search(r"/.*\.\w+$", word):
                        expect(f"/{word}" in files, f"{path.relative_to(source)}:{number}", f"no such file: {word}")


def check_length(path, name):
    """A page of LONGEST has no more lines than stand there."""
    lines = len(path.read_text(encoding="utf-8").splitlines())
    most = LONGEST.get(name, lines)
    expect(lines <= most, name, f"{lines} lines, at most {most}: move what is beyond to tools/manual")


def check_words(name, prose, known):
    """The words in the first column of every table are words that `mpmfast list` prints."""
    for number, line in prose:
        if not line.startswith("|"):
            continue
        for word in re.findall(r"`([^`]*)`", line.split("|")[1]):
            word = re.sub(r"\(.*\)$", "", word.split(":")[-1].strip())
            expect(word in known, f"{name}:{number}", f"'{word}' is no word of `mpmfast list`")


def check_recipes(source, name, prose):
    """In tables of files and what to look for there, `file` exists and holds `words`."""
    for number, line in prose:
        cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)] if line.startswith("| `") else []
        if len(cells) < 4 or "/" not in cells[1] or not re.fullmatch(r"`[^`]+`", cells[1]):
            continue
        path = source / cells[1].strip("`")
        expect(path.is_file(), f"{name}:{number}", f"no such file: {cells[1]}")
        for words in re.findall(r"`([^`]+)`", cells[2]) if path.is_file() else ():
            expect(words in path.read_text(encoding="utf-8"), f"{name}:{number}", f"{cells[1]} holds no '{words}'")


def messages_of(source):
    """All text of the program's sources, literals that continue on the next line joined."""
    text = ""
    for folder in ("engine", "tools"):
        for path in sorted((source / folder).rglob("*.?pp")):
            text += path.read_text(encoding="utf-8")
    return re.sub(r'"\s*\n\s*"', "", text).replace('{:', "{").replace('\\"', '"')


def check_messages(name, prose, sources):
    """Messages in the first column of a table of two, or bold at the start of a line, stand in the sources."""
    for number, line in prose:
        table = line.split("|")[1] if line.startswith("| `") and line.count("|") == 3 else ""
        bold = re.match(r"\*\*(`[^`]+`)\*\*", line)
        for message in re.findall(r"`([^`]+)`", table or (bold[1] if bold else "")):
            for part in message.split("…"):
                expect(part.strip(" )") in sources, f"{name}:{number}", f"no message says '{part}'")


def dotted_keys(yaml_text):
    """Paths of a resolved scene such as contact.normal; lists count from 0."""
    paths = set()

    def visit(value, path):
        paths.add(path)
        items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
        for key, item in items:
            visit(item, f"{path}.{key}" if path else str(key))

    visit(yaml.safe_load(yaml_text), "")
    return paths


def check_keys(name, prose, paths):
    """Dotted keys such as `contact.normal` are keys of a resolved scene."""
    for number, line in prose:
        for key in re.findall(r"`((?:grid|time|method|contact|output)\.[a-z_.]+)(?:[:=][^`]*)?`", line):
            if key.endswith((".yaml", ".csv", ".json", ".pvd", ".vtu", ".hpp", ".cpp", ".md")):
                continue
            expect(key in paths, f"{name}:{number}", f"'{key}' is no key of a scene")


def pages_of(source):
    for path in sorted(source.rglob("*.md")):
        parts = path.relative_to(source).parts
        if not NOT_OURS.intersection(parts) and not any(part.startswith(".") for part in parts):
            yield path, str(path.relative_to(source))


def keys_of_scenes(program, source, folder):
    """Dotted keys of resolved scenes that have every section between them."""
    keys = set()
    for name, setting in (("gap", "grid.cell=10 mm"), ("pair_laws", "output.checkpoint={steps: 9}")):
        done = subprocess.run([program, "run", str(source / "configs" / f"{name}.yaml"), "--steps", "1", "--progress",
                               "none", "--set", setting, "--out", name], cwd=folder, capture_output=True, text=True)
        expect(done.returncode == 0, f"configs/{name}.yaml", done.stderr)
        if done.returncode == 0:
            keys |= dotted_keys((folder / name / "scene.yaml").read_text(encoding="utf-8"))
    return keys


def check_links_of(folder):
    for path, name in pages_of(folder):
        check_links(path, name, read_page(path, name)[1], folder)
    expect(checks > 0, folder, "it has no links")
    print(f"{checks} checks of links, {len(failures)} wrong")
    return 1 if failures else 0


def main():
    if sys.argv[1:2] == ["--links"]:
        return check_links_of(pathlib.Path(sys.argv[2]).resolve())
    options = [word for word in sys.argv[1:] if word.startswith("--")]
    words = [word for word in sys.argv[1:] if not word.startswith("--")]
    only = words.pop() if "--only" in options else ""
    program, source = os.path.abspath(words[0]), pathlib.Path(words[1]).resolve()
    listed = subprocess.run([program, "list"], capture_output=True, text=True).stdout
    known = set(re.findall(r"\w+\+?", listed))
    ran, left_out, files = 0, [], files_of(source)
    with tempfile.TemporaryDirectory(prefix="documents-") as root:
        root = pathlib.Path(root)
        keys = keys_of_scenes(program, source, root)
        checks_of_page = {
            "tools/manual/methods.md": lambda name, prose: check_words(name, prose, known),
            "tools/manual/extending.md": lambda name, prose: check_recipes(source, name, prose),
            "tools/manual/troubleshooting.md": lambda name, prose: check_messages(name, prose, messages_of(source)),
        }
        for index, (path, name) in enumerate(pages_of(source)):
            if only not in name:
                continue
            blocks, prose = read_page(path, name)
            check_links(path, name, prose, source)
            check_files(name, prose, {word for block in blocks for word in block.words}, files)
            check_length(path, name)
            if name.startswith("tools/manual/") or name == "README.md":
                check_keys(name, prose, keys)
            if name in checks_of_page:
                before = checks
                checks_of_page.pop(name)(name, prose)
                expect(checks - before > 20, name, "its tables are not what this test looks for")
            runner = Runner(root / f"page{index}", program, source, "--slow" in options)
            for block in blocks:
                runner.do(block)
            ran += runner.ran
            left_out += runner.left_out
        if not only:
            check_comments(source, files)
            expect(not checks_of_page, "tools/manual", f"pages are missing: {', '.join(checks_of_page)}")
    for what in left_out:
        print(f"left out: {what}")
    print(f"{checks} checks, {ran} blocks run, {len(failures)} wrong")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
