r"""Formulas are written once, in the part of LaTeX that is listed here, and this makes plain text of them.

Figures and the window typeset the source. Titles and descriptions take the plain text, like `R = (a + b) / 2` for
`R = \frac{a + b}{2}`. Spaces in the source are spaces of the text; TeX ignores them. `\\` is a place where a long
formula may be broken.
"""

import re
import string
from collections.abc import Iterator
from functools import lru_cache

FUNCTIONS = ("sin", "cos", "tan", "arcsin", "arccos", "arctan", "min", "max", "log", "exp")
GREEK = {
    "alpha": "α", "beta": "β", "gamma": "γ", "delta": "δ", "epsilon": "ε", "eta": "η", "theta": "θ", "kappa": "κ",
    "lambda": "λ", "mu": "μ", "nu": "ν", "pi": "π", "rho": "ρ", "sigma": "σ", "tau": "τ", "phi": "φ", "chi": "χ",
    "psi": "ψ", "omega": "ω", "Gamma": "Γ", "Delta": "Δ", "Theta": "Θ", "Lambda": "Λ", "Sigma": "Σ", "Phi": "Φ",
    "Psi": "Ψ", "Omega": "Ω",
}  # fmt: skip
SIGNS = {
    "cdot": "·", "times": "×", "to": "→", "sum": "Σ", "geq": "≥", "leq": "≤", "approx": "≈", "infty": "∞", "pm": "±",
    "quad": "  ", ",": " ", "left": "", "right": "", "\\": " ",
}  # fmt: skip
STYLES = ("mathbf", "mathrm", "vec")
COMMANDS = (*FUNCTIONS, *GREEK, *SIGNS, *STYLES, "frac", "sqrt")

LETTERS = (
    " " + string.ascii_letters + string.digits + "+-=<>()[]{}_^/|.,:;!'*"
)  # no other has a meaning in TeX's formulas

# Letters of which the fonts have no such form stay as they are: θc, kd.
LOWERED = str.maketrans("0123456789sp", "₀₁₂₃₄₅₆₇₈₉ₛₚ")
RAISED = str.maketrans("0123456789p-", "⁰¹²³⁴⁵⁶⁷⁸⁹ᵖ⁻")

_TOKEN = re.compile(r"\\(?P<command>[A-Za-z]+\s*|.)|(?P<other>\s+|.)", re.DOTALL)


class FormulaError(ValueError):
    """A source that is not in this part of LaTeX, with a message for its author."""


@lru_cache(maxsize=1024)
def plain(source: str) -> str:
    """The formula as plain text. FormulaError for what is not in this part of LaTeX."""
    reader = _Reader(source)
    text = reader.until("")
    return re.sub(r"(?<=\S) {3,}", "  ", text).strip()


def broken(source: str) -> list[str]:
    r"""The lines of a formula that is broken at each `\\`."""
    return [part.strip() for part in source.split(r"\\")]


def left_side(source: str) -> str:
    """The symbol that a formula defines: what stands before the equals sign."""
    return source.partition(" = ")[0]


def joined(source: str) -> str:
    """The formula in one line."""
    return " ".join(broken(source))


class _Reader:
    def __init__(self, source: str) -> None:
        self.source = source
        self.tokens = list(self._split(source))
        self.at = 0

    def _split(self, source: str) -> Iterator[str]:
        """Commands, with their backslash, and single characters."""
        for found in _TOKEN.finditer(source):
            if (command := found["command"]) is None:
                letter = " " if found["other"].isspace() else found["other"]
                if letter not in LETTERS:
                    raise FormulaError(f"formula {source!r}: {letter!r} is not allowed; allowed are {LETTERS}")
                yield letter
                continue
            name = command.strip()
            if name not in COMMANDS:
                raise FormulaError(f"formula {source!r}: \\{name} is not known; known are {', '.join(COMMANDS)}")
            yield f"\\{name}"
            if name in (*GREEK, *SIGNS) and command != name:
                yield " "

    def until(self, end: str) -> str:
        """The text up to the token `end`, which is read as well; "" is the end of the source."""
        found = ""
        while self.at < len(self.tokens):
            if self.tokens[self.at] == end:
                self.at += 1
                return found
            found = self._add(found)
        if end:
            raise FormulaError(f"formula {self.source!r}: a {{ has no }}")
        return found

    def _add(self, found: str) -> str:
        """The text so far with the next atom."""
        token = self.tokens[self.at]
        if token in "_^":
            self.at += 1
            return found + _script(self._argument(), token)
        name = token[1:]
        if token[0] == "\\" and name in FUNCTIONS:
            self.at += 1
            before = " " if found and found[-1] not in " (" else ""
            if self._next() == "\\frac":
                return f"{found}{before}{name}({self._atom()})"
            after = "" if self._next() in ("(", "\\left", "_", "^", " ", "") else " "
            return f"{found}{before}{name}{after}"
        return found + self._atom()

    def _next(self) -> str:
        return self.tokens[self.at] if self.at < len(self.tokens) else ""

    def _argument(self) -> str:
        while self._next() == " ":
            self.at += 1
        return self._atom()

    def _atom(self) -> str:
        """The text of a group, a command with its arguments, or a character."""
        token = self._next()
        self.at += 1
        match token:
            case "":
                raise FormulaError(f"formula {self.source!r}: its end is missing")
            case "_" | "^":
                raise FormulaError(f"formula {self.source!r}: a {token} has nothing before it that it could belong to")
            case "}":
                raise FormulaError(f"formula {self.source!r}: a }} has no {{")
            case "{":
                return self.until("}")
            case "-":
                return "−"
            case r"\frac":
                over, under = self._argument(), self._argument()
                return f"{_grouped(over)} / {_grouped(under)}"
            case r"\sqrt":
                return f"√{_grouped(self._argument())}"
            case _ if token[1:] in STYLES:
                return self._argument()
            case _ if token[0] == "\\":
                return GREEK.get(token[1:]) or SIGNS.get(token[1:], token[1:])
            case _:
                return token


def _script(text: str, token: str) -> str:
    if token == "_":
        return text.translate(LOWERED)
    raised = text.replace("−", "-").translate(RAISED)
    return raised if all(letter in RAISED.values() for letter in map(ord, raised)) else f"^{_grouped(text)}"


def _grouped(text: str) -> str:
    """In parentheses, if it has several parts."""
    return f"({text})" if " " in text or ("(" in text and not text.endswith(")")) else text
