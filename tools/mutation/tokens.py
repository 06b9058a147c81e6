"""C++ as tokens, for code that clang-format has been over: it sets blanks around every binary operator and none
around the brackets of templates, so that the two are told apart by them."""
import re

TOKEN = re.compile(r"""
    (?P<skip>//[^\n]*(?:\\\n[^\n]*)*|/\*.*?\*/|^[ \t]*\#(?:[^\n]*\\\n)*[^\n]*)
  | (?P<text>(?:u8|[uUL])?R"(?P<mark>[^ ()\\\t\n]*)\(.*?\)(?P=mark)"|(?:u8|[uUL])?"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])+')
  | (?P<number>(?:0[xX][0-9a-fA-F']+|(?:[0-9][0-9']*)?\.?[0-9][0-9']*\.?(?:[eE][+-]?[0-9]+)?)[a-zA-Z]*)
  | (?P<word>[A-Za-z_]\w*)
  | (?P<sign><<=|<=>|\.\.\.|->\*|::|->|\+\+|--|<<|<=|>=|==|!=|&&|\|\||[-+*/%&|^]=|[-+*/%&|^~!=<>?:;,.(){}\[\]])
""", re.X | re.S | re.M)

# How tightly binary operators bind; a larger number binds less.
PRECEDENCE = {"*": 5, "/": 5, "%": 5, "+": 6, "-": 6, "<<": 7, ">>": 7, "<=>": 8, "<": 9, ">": 9, "<=": 9, ">=": 9,
              "==": 10, "!=": 10, "&": 11, "^": 12, "|": 13, "&&": 14, "||": 15}
ASSIGNS = {"=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<="}
# Where an expression ends on either side.
BORDERS = {";", ",", "?", ":"} | ASSIGNS
STATEMENTS = {"return", "throw", "case", "else", "do", "goto", "co_return", "new", "delete"}
# The parentheses behind these hold no expression of the running program.
UNEVALUATED = {"static_assert", "alignas", "noexcept", "decltype", "sizeof", "requires", "__attribute__", "operator"}
OPENING = {"(": ")", "[": "]", "{": "}"}


class Token:
    """A piece of a file: its kind, its text, where it begins and ends."""

    __slots__ = ("kind", "text", "begin", "end", "binary", "twin", "barred")

    def __init__(self, kind, text, begin, end):
        self.kind, self.text, self.begin, self.end = kind, text, begin, end
        self.binary = False  # an operator between two operands
        self.twin = None     # of a bracket: the index of its other half
        self.barred = False  # nothing is to be changed here

    def __repr__(self):
        return self.text


def tokens_of(code):
    """The tokens of a file without comments, preprocessor lines and blanks, brackets matched, operators told from
    signs, and what no running program evaluates barred."""
    tokens = []
    for match in TOKEN.finditer(code):
        if match.lastgroup != "skip" and not match.group("skip"):
            kind = next(k for k in ("text", "number", "word", "sign") if match.group(k) is not None)
            tokens.append(Token(kind, match.group(), match.start(), match.end()))
    for token in tokens:
        token.binary = token.kind == "sign" and token.text in PRECEDENCE and is_spaced(code, token)
    tokens = join_shifts(tokens, code)
    match_brackets(tokens)
    bar(tokens)
    return tokens


def is_spaced(code, token):
    """Blanks on both sides?"""
    return token.begin > 0 and code[token.begin - 1].isspace() and token.end < len(code) and code[token.end].isspace()


def join_shifts(tokens, code):
    """`>>` was read as two tokens, which templates need: those of a shift become one."""
    joined = []
    for token in tokens:
        last = joined[-1] if joined else None
        if token.text == ">" and last and last.text == ">" and last.end == token.begin:
            both = Token("sign", ">>", last.begin, token.end)
            if is_spaced(code, both):
                both.binary = True
                joined[-1] = both
                continue
        joined.append(token)
    return joined


def match_brackets(tokens):
    """Sets `twin` of brackets, those of templates too."""
    stack = []
    for index, token in enumerate(tokens):
        if token.kind != "sign":
            continue
        opens_template = token.text == "<" and index > 0 and (
            tokens[index - 1].text == "template" or (not token.binary and tokens[index - 1].text != "operator"))
        if opens_template or token.text in OPENING:
            token.binary = False
            stack.append(index)
        elif token.text == ">" and not token.binary and stack and tokens[stack[-1]].text == "<":
            pair(tokens, stack.pop(), index)
        elif token.text in OPENING.values():
            while stack and OPENING.get(tokens[stack[-1]].text) != token.text:
                stack.pop()
            if stack:
                pair(tokens, stack.pop(), index)


def pair(tokens, opening, closing):
    """Two brackets that belong together."""
    tokens[opening].twin, tokens[closing].twin = closing, opening


def is_subscript(tokens, index):
    """Is this `[` behind something that has elements, rather than before what a lambda captures, or in a
    declaration, `double m[3]`, `V (&w)[2]`?"""
    before = tokens[index - 1] if index else None
    if before is None or before.end != tokens[index].begin or not (before.kind == "word" or before.text in (")", "]")):
        return False
    if before.text == "]" and before.twin is not None:
        return is_subscript(tokens, before.twin)
    if before.text == ")" and before.twin is not None:
        return tokens[before.twin + 1].text != "&"
    named = tokens[index - 2] if index > 1 else None
    return named is None or not (named.kind == "word" and named.text not in STATEMENTS
                                 or named.text == ">" and named.twin is not None)


def bar(tokens):
    """Bars template arguments, constants, what is not evaluated, captures, attributes, enumerations and aliases."""
    for index, token in enumerate(tokens):
        after = tokens[index + 1] if index + 1 < len(tokens) else None
        end = None
        if token.text == "<" and token.twin is not None and not token.binary:
            end = token.twin
        elif token.text == "[" and token.twin is not None and not is_subscript(tokens, index):
            end = token.twin
        elif token.text in UNEVALUATED and after is not None and after.twin is not None:
            end = after.twin
        elif token.text == "operator":
            end = index + 1
        elif token.text == "constexpr":
            end = constant_end(tokens, index)
        elif token.text in ("enum", "using", "typedef"):
            end = statement_end(tokens, index)
        if end is not None:
            for k in range(index, end + 1):
                tokens[k].barred = True


def statement_end(tokens, index):
    """The `;` that ends the statement which begins here."""
    while index < len(tokens) - 1 and tokens[index].text != ";":
        index = tokens[index].twin if tokens[index].text in OPENING and tokens[index].twin else index + 1
    return index


def constant_end(tokens, index):
    """The last token of a constant, of a condition of the compiler, or of the head of a function."""
    if tokens[index - 1].text == "if":
        return tokens[index + 1].twin
    while index < len(tokens) - 1 and tokens[index].text not in (";", "="):
        if tokens[index].text == "(" and tokens[index].twin:
            return tokens[index].twin
        if tokens[index].text == "{":
            return tokens[index].twin or index
        index = tokens[index].twin if tokens[index].text == "<" and tokens[index].twin else index + 1
    return statement_end(tokens, index)


def is_initialiser(tokens, brace):
    """Does this `{` begin the value of a type, `Vec{1, 2}`, rather than a block?"""
    before = tokens[brace - 1]
    return before.end == tokens[brace].begin and (before.kind == "word" or before.text == ">")


def left_operand(tokens, operator):
    """The index of the first token of what stands left of a binary operator; None where that cannot be told."""
    limit = PRECEDENCE[tokens[operator].text]
    index, right = operator - 1, None
    while index >= 0:
        token = tokens[index]
        if token.text in BORDERS or token.text in STATEMENTS or token.text in OPENING:
            break
        if token.binary and PRECEDENCE[token.text] > limit:
            break
        start = index
        if token.text in (")", "]", "}") or (token.text == ">" and token.twin is not None):
            if token.twin is None or (token.text == "}" and not is_initialiser(tokens, token.twin)):
                break
            start = token.twin
        if right is not None and apart(tokens, index, right):
            break
        right, index = start, start - 1
    return right


def apart(tokens, left, right):
    """Do two operands stand side by side, as behind the condition of an `if`?"""
    a, b = tokens[left], tokens[right]
    ends = a.kind in ("word", "number", "text") or a.text in (")", "]", "}") or (a.text == ">" and a.twin is not None)
    begins = b.kind in ("word", "number", "text") or (b.kind == "sign" and b.text in ("!", "~", "-", "*", "&", "++", "--")
                                                     and not b.binary)
    return ends and begins or (a.end != b.begin and b.text == "(" and ends)


def right_operand(tokens, operator):
    """The index of the last token of what stands right of a binary operator or an assignment."""
    limit = PRECEDENCE.get(tokens[operator].text, 99)
    index, last = operator + 1, None
    while index < len(tokens):
        token = tokens[index]
        if token.text in (")", "]", "}", ";", ",") or (token.text in ("?", ":") and limit < 99) or token.text in ASSIGNS:
            break
        if token.text == ">" and token.twin is not None and token.twin < operator:
            break
        if token.binary and PRECEDENCE[token.text] >= limit:
            break
        if token.text == "{" and not (is_initialiser(tokens, index) or limit == 99):
            break
        if (token.text in OPENING or token.text == "<") and token.twin is not None:
            index = token.twin
        last, index = index, index + 1
    return last
