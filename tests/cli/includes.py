"""Does every source file include, itself or through headers of ours, what it names? Builds with precompiled headers would
not notice. usage: includes.py FOLDER"""
import pathlib
import re
import sys

# What a file names, and the header that it then needs.
NEEDS = [
    (r"Eigen::|\b(Vec|Mat)<", r"<Eigen/|\"kernels/dimension\.hpp\""),
    (r"\.cross\(|\b(Quaterniond|AngleAxisd|Rotation2Dd?)\b", r"<Eigen/(Geometry|Dense)>"),
    (r"\bEigenSolver\b|SelfAdjointEigenSolver", r"<Eigen/(Eigenvalues|Dense)>"),
    (r"\b(Jacobi|BDC)SVD\b", r"<Eigen/(SVD|Dense)>"),
    (r"\.(determinant|fullPivLu|partialPivLu)\(", r"<Eigen/(LU|Dense)>"),
    (r"\bfmt::join\b", r"<fmt/ranges\.h>"),
    (r"\bfmt::", r"<fmt/(format|ranges|core|ostream|chrono)\.h>"),
    (r"\bnlohmann::", r"<nlohmann/json(_fwd)?\.hpp>"),
    (r"\bTEST_CASE\(", r"<doctest/doctest\.h>"),
    (r"\bstd::(sort|stable_sort|min|max|minmax|clamp|find|find_if|find_if_not|any_of|all_of|none_of|count|count_if|copy|fill"
     r"|transform|lower_bound|upper_bound|equal_range|max_element|min_element|reverse|rotate|unique|replace|remove_if|swap_ranges"
     r"|nth_element|partition|equal|mismatch|search|generate|for_each)\(", r"<algorithm>"),
    (r"\bstd::array\b", r"<array>"),
    (r"\bstd::(abs|sqrt|cbrt|pow|exp|log|log10|sin|cos|tan|atan|atan2|floor|ceil|round|lround|trunc|hypot|isfinite|isnan|fmod|erf)\(",
     r"<cmath>|<cstdlib>"),
    (r"\bstd::filesystem\b", r"<filesystem>"),
    (r"\bstd::[io]?fstream\b", r"<fstream>"),
    (r"\bstd::numeric_limits\b", r"<limits>"),
    (r"\bstd::map\b", r"<map>"),
    (r"\bstd::(optional|nullopt)\b", r"<optional>"),
    (r"\bstd::(string|to_string)\b", r"<string>"),
    (r"\bstd::(variant|visit|get_if|holds_alternative|monostate)\b", r"<variant>"),
    (r"\bstd::vector\b", r"<vector>"),
]
# Of tests, whose helpers are precompiled too.
TESTS_NEED = [
    (r"\b(scene_from|scene_file|by_id|bases)\(", r"\"tests/support\.hpp\""),
    (r"\bStep<", r"\"engine/step/step\.hpp\""),
    (r"\b(parse_scene|read_scene)\(", r"\"engine/scene/read_scene\.hpp\""),
]
INCLUDE = re.compile(r"^\s*#\s*include\s+([<\"][^>\"]+[>\"])", re.M)
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/|\"(?:\\.|[^\"\\\n])*\"", re.S)


def reached(path, root, known):
    """All that a file includes, through headers of ours."""
    if path not in known:
        known[path] = set()  # a circle ends here
        found = set()
        for include in INCLUDE.findall(path.read_text()):
            found.add(include)
            for inner in (root / include[1:-1], path.parent / include[1:-1]):
                if include[0] == '"' and inner.is_file():
                    found |= reached(inner, root, known)
        known[path] = found
    return known[path]


def main():
    root = pathlib.Path(sys.argv[1])
    known, wrong, count = {}, 0, 0
    compiled = [[(re.compile(names), re.compile(header)) for names, header in needs] for needs in (NEEDS, TESTS_NEED)]
    for folder in ("bench", "engine", "kernels", "tests", "tools"):
        for path in sorted((root / folder).rglob("*.[ch]pp")):
            count += 1
            text = path.read_text()
            code = COMMENT.sub("", INCLUDE.sub("", text))
            headers = " ".join(reached(path, root, known))
            for names, header in compiled[0] + (compiled[1] if folder == "tests" and path.suffix == ".cpp" else []):
                name = names.search(code)
                if name and not header.search(headers):
                    wrong += 1
                    print(f"{path.relative_to(root)}: names {name.group().rstrip('(<')} and includes no {header.pattern}")
    print(f"{count - wrong if wrong < count else 0} passed, {wrong} failed")
    return 1 if wrong or not count else 0


sys.exit(main())
