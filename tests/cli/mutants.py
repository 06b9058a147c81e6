"""tools/mutate by itself: a seed always gives the same mutants, comments and constants are let alone, and a changed
source is what it says. usage: mutants.py SOURCE_DIR"""
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(sys.argv[1])
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "tools"))
from mutation import choose, page, places, tree  # noqa: E402

SAMPLE = """\
#pragma once
/// The sum a + b of two numbers, 0.5 < 1.
#define HALF (1 + 1)
static_assert(1 + 1 == 2);
inline constexpr double kShare = 0.25 + 0.25;
template <int Dim, class V = std::array<double, Dim + 1>>
double mean(const V& v, const char* says = "a + b", char sign = '-') {
  if constexpr (Dim > 2) return 0.0;
  double sum = -v[0];
  for (int k = 1; k < 3; ++k) sum += v[k] * 2.5;  // and a - b
  const auto half = [&sum](double x) { return x - sum; };
  return sum > 1 && half(sum) < std::max(
      sum, 0.5) ? std::abs(sum - 1.5) : sum;
}
"""
# All that may be changed in it, and into what.
EXPECTED = {
    ("coefficient", "0.0", "0.0"): False,
    ("sign", "a + b", "a - b"): False,
    ("sign", "0.25 + 0.25", "0.25 - 0.25"): False,
    ("comparison", "Dim > 2", "Dim >= 2"): False,
    ("index", "0", "0 + 1"): True,
    ("index", "k", "k - 1"): True,
    ("bound", "3", "3 + 1"): True,
    ("comparison", "k < 3", "k <= 3"): True,
    ("sign", "sum += v[k] * 2.5", "sum -= v[k] * 2.5"): True,
    ("term", "sum += v[k] * 2.5", "{}"): True,
    ("term", "v[k] * 2.5", "v[k]"): True,
    ("coefficient", "2.5", "2.55"): True,
    ("coefficient", "2.5", "5.0"): True,
    ("sign", "x - sum", "x + sum"): True,
    ("comparison", "sum > 1 && half(sum) < std::max( sum, 0.5)", "sum > 1 || half(sum) < std::max( sum, 0.5)"): True,
    ("comparison", "sum > 1", "sum >= 1"): True,
    ("min/max", "std::max( sum, 0.5)", "std::min( sum, 0.5)"): True,
    ("abs", "std::abs(sum - 1.5)", "(sum - 1.5)"): True,
    ("term", "sum - 1.5", "sum"): True,
}

failures = []


def check(holds, what):
    """Notes what does not hold."""
    if not holds:
        failures.append(what)


def check_sample():
    """Places and what they become."""
    changes = places.changes_of(SAMPLE)
    found = {(c.kind, c.before, c.after) for c in changes}
    for change, wanted in EXPECTED.items():
        check((change in found) == wanted, f"{change} {'is missing' if wanted else 'should not be there'}")
    first = SAMPLE.index("  double sum")
    check(all(c.begin >= first for c in changes), "something is changed in comments, constants or a function's head")


def check_switches():
    """Mutants keep the lines of a file, and all that they do not change."""
    changes = [c for c in places.changes_of(SAMPLE) if c.kind in ("min/max", "sign")]
    mutants = []
    for change in changes:
        if all(change.end <= m.change.begin or m.change.end <= change.begin for m in mutants):
            mutants.append(choose.Mutant(len(mutants) + 1, "sample.hpp", 1, change))
    code = tree.switched(SAMPLE, mutants)
    check(code.count("\n") == SAMPLE.count("\n") + 2, "lines are lost or added")
    check(code.startswith('#include "mutation_switch.hpp"\n#line 1\n#pragma once'), "the head is not what it should be")
    check(f"(::mutation::on({mutants[0].number}) ? (void)(sum -= v[k] * 2.5) : (void)(sum += v[k] * 2.5))" in code,
          "the sign of a sum is not behind a switch")
    check(tree.switched(SAMPLE, []) == SAMPLE, "a source without mutants is changed")


def check_seed():
    """The command, twice; another seed gives others."""
    def listed(*seeds):
        return subprocess.run([sys.executable, ROOT / "tools/mutate", "--list", "--seed", *map(str, seeds), "--count", "20",
                               "--under", "kernels/contact"], check=True, capture_output=True, text=True).stdout
    check(listed(7) == listed(7), "a seed does not give the same mutants twice")
    check(listed(7) != listed(8), "two seeds give the same mutants")
    check(len(listed(7).splitlines()) == 20, "not as many as were asked for")
    check(listed(7, 8).startswith(listed(7)), "a second seed changes what the first one gives")
    check(len(listed(7, 8).splitlines()) == 40, "not as many of each seed as were asked for")


def check_first_of_each():
    """Of each seed as many as are asked for, whatever did not compile; all that were asked for by their line."""
    change = places.Change("sign", 0, 1, "a", "b")
    mutants = [choose.Mutant(n, "a.hpp", 1, change, seed) for n, seed in enumerate([None, 5, 5, 5, 6, 6], 1) if n != 2]
    check([m.number for m in choose.first_of_each(mutants, 1)] == [1, 3, 5], "not the first of each seed")


def check_kept():
    """A source that changes in another line keeps the ranks of its mutants' random numbers, so nearly all its mutants."""
    def first(code):
        ordered = sorted(choose.ranked("sample.hpp", code, 3), key=lambda r: r[0])
        return [(c.kind, c.before, c.after) for _, c in ordered[:10]]
    other = SAMPLE.replace("double sum = -v[0]", "double sum = v[0] - v[1]").replace("#pragma once", "#pragma once\n// more")
    kept = len(set(first(SAMPLE)) & set(first(other)))
    check(7 <= kept < 10, f"of ten mutants {kept} are kept where a line changed")


def check_reasons():
    """A reason is found by its file and change, or by the text of its line too."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "tests").mkdir()
        (root / "a.hpp").write_text("int x = 0;\nint y = 0;\n")
        (root / page.REASONS).write_text("a.hpp :: int y = 0; :: 0 :: 1 :: set before\na.hpp :: 2 :: 3 :: of all\n")
        why = page.Reasons(root)
        def reason(begin, before, after):
            return why.get(choose.Mutant(1, "a.hpp", 1, places.Change("coefficient", begin, begin + 1, before, after)))
        check(reason(8, "0", "1") == "", "the reason of another line is taken")
        check(reason(19, "0", "1") == "set before", "a line's reason is not found")
        check(reason(8, "2", "3") == "of all", "a file's reason is not found")


check_sample()
check_switches()
check_kept()
check_reasons()
check_seed()
check_first_of_each()
for failure in failures:
    print("FAILED:", failure)
sys.exit(1 if failures else 0)
