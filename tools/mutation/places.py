"""Where a file can be changed, and into what: each kind of mutant is a function that yields changes."""
import dataclasses

from mutation import tokens as t

FLIPPED = {"+": "-", "-": "+", "<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "&&": "||", "||": "&&"}
SWAPPED = {"min": "max", "max": "min", "larger": "smaller", "smaller": "larger"}
# Numbers beyond these guard against round-off or stand for infinity: no coefficients.
SMALLEST, LARGEST = 1e-5, 1e5


@dataclasses.dataclass(frozen=True)
class Change:
    """What stands from `begin` to `end` of a file becomes `after`."""

    kind: str
    begin: int
    end: int
    before: str
    after: str
    statement: bool = False  # an assignment: what it gives is not used


class Source:
    """A file and its tokens."""

    def __init__(self, code):
        self.code, self.tokens = code, t.tokens_of(code)
        self.conditions, self.subscripts = set(), set()
        for index, token in enumerate(self.tokens):
            if token.text == "for" and self.tokens[index + 1].twin:
                self.conditions |= self.condition_of(index + 1)
            if token.text == "[" and token.twin and not token.barred:
                self.subscripts |= set(range(index, token.twin))

    def condition_of(self, bracket):
        """The indices between the two `;` of a loop's head."""
        borders = []
        index = bracket + 1
        while index < self.tokens[bracket].twin:
            if self.tokens[index].text == ";":
                borders.append(index)
            opens = self.tokens[index].text in t.OPENING and self.tokens[index].twin
            index = self.tokens[index].twin if opens else index + 1
        return set(range(*borders)) if len(borders) == 2 else set()

    def text(self, first, last):
        """What stands between two tokens, both included, on one line and without comments."""
        words = [self.tokens[first].text]
        for a, b in zip(self.tokens[first:last], self.tokens[first + 1:last + 1]):
            words += [" " if a.end < b.begin else "", b.text]
        return "".join(words)

    def change(self, kind, first, last, after, statement=False):
        """A change of what stands between two tokens."""
        return Change(kind, self.tokens[first].begin, self.tokens[last].end, self.text(first, last), after, statement)

    def operands(self, index):
        """First and last token of the two sides of a binary operator, or None."""
        left, right = t.left_operand(self.tokens, index), t.right_operand(self.tokens, index)
        if left is None or right is None or any(k.barred and k.text in ("constexpr", "operator")
                                               for k in self.tokens[left:right + 1]):
            return None
        return left, right


def changes_of(code):
    """All changes of a file, in its order."""
    source = Source(code)
    found = []
    for index, token in enumerate(source.tokens):
        if not token.barred:
            for kind in (operators, assignments, subscripts, numbers, calls):
                found += kind(source, index)
    return found


def operators(source, index):
    """Signs, comparisons, dropped terms and factors, bounds of loops."""
    token = source.tokens[index]
    sides = source.operands(index) if token.binary else None
    if sides is None:
        return
    left, right = sides
    a, b = source.text(left, index - 1), source.text(index + 1, right)
    if token.text in FLIPPED:
        kind = "sign" if token.text in "+-" else "comparison"
        yield source.change(kind, left, right, f"{a} {FLIPPED[token.text]} {b}")
    if token.text in ("+", "-", "*", "/"):
        yield source.change("term", left, right, a)
    if token.text in ("+", "*"):
        yield source.change("term", left, right, b)
    if index in source.conditions and token.text in ("<", "<=", ">", ">="):
        for shift in ("+ 1", "- 1"):
            yield source.change("bound", index + 1, right, f"{b} {shift}")


def assignments(source, index):
    """`a += b` becomes `a -= b`, or nothing."""
    token = source.tokens[index]
    if token.text not in ("+=", "-=", "*=", "/=") or index in source.conditions:
        return
    tokens = source.tokens
    left = index - 1
    while left > 0 and tokens[left - 1].text not in (";", "{", "}", ")", ",", "else", "(") or (
            tokens[left].text in (")", "]")):
        left = tokens[left].twin if tokens[left].text in (")", "]") and tokens[left].twin else left - 1
        if left > 0 and tokens[left - 1].text == ")" and tokens[left - 1].end == tokens[left].begin:
            left -= 1
    right = t.right_operand(tokens, index)
    if right is None or tokens[left - 1].text in (",", "(") or tokens[right + 1].text != ";":
        return
    a, b = source.text(left, index - 1), source.text(index + 1, right)
    if token.text in ("+=", "-="):
        yield source.change("sign", left, right, f"{a} {FLIPPED[token.text[0]]}= {b}", statement=True)
    yield source.change("term", left, right, "{}", statement=True)


def subscripts(source, index):
    """An element becomes its neighbour."""
    token = source.tokens[index]
    if token.text == "[" and token.twin and token.twin > index + 1:
        inner = source.text(index + 1, token.twin - 1)
        if any(k.text == "?" or k.binary and t.PRECEDENCE[k.text] > t.PRECEDENCE["+"]
               for k in source.tokens[index + 1:token.twin]):
            inner = f"({inner})"
        for shift in ("+ 1", "- 1"):
            yield source.change("index", index + 1, token.twin - 1, f"{inner} {shift}")


def numbers(source, index):
    """Coefficients change by two per cent or double, whole numbers by one."""
    token = source.tokens[index]
    if token.kind != "number" or index in source.subscripts or token.text[:2] in ("0x", "0X"):
        return
    if any(c in token.text for c in ".eE") and "'" not in token.text:
        bare = token.text.rstrip("fF")
        if SMALLEST <= float(bare) <= LARGEST:
            suffix = token.text[len(bare):]
            for factor in (1.02, 2):
                other = f"{float(bare) * factor:.12g}"
                yield source.change("coefficient", index, index, other + ("" if set(other) & set(".e") else ".0") + suffix)
    elif token.text.isdigit() and float(token.text) <= LARGEST:
        value = int(token.text)
        for other in {value + 1, max(value - 1, 0)} - {value}:
            yield source.change("coefficient", index, index, str(other))


def calls(source, index):
    """min and max swapped; abs dropped."""
    tokens = source.tokens
    token = tokens[index]
    if token.kind != "word" or token.text not in SWAPPED and token.text not in ("abs", "magnitude"):
        return
    first = index - 2 if tokens[index - 1].text == "::" else index
    bracket = index + 1
    if tokens[bracket].text == "<" and tokens[bracket].twin:
        bracket = tokens[bracket].twin + 1
    if tokens[bracket].text != "(" or not tokens[bracket].twin or tokens[index - 1].text in (".", "->"):
        return
    if tokens[first - 1].kind == "word" and tokens[first - 1].text not in t.STATEMENTS:
        return  # the head of a function of that name
    last = tokens[bracket].twin
    if token.text in SWAPPED:
        rest = source.text(index + 1, last)
        scope = "std::" if first < index else ""
        yield source.change("min/max", first, last, scope + SWAPPED[token.text] + rest)
    else:
        yield source.change("abs", first, last, source.text(bracket, last))
