"""Evaluates the expressions of a scene (muParser syntax) on numpy arrays."""

import re

import numpy as np

from .failure import USAGE, Failure

_TOKEN = re.compile(
    r"\s*(?:(\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?)|([A-Za-z_]\w*)|(<=|>=|==|!=|&&|\|\||.))"
)


def _bessel_j(order, x):
    # Bessel's integral; the trapezoidal rule on a period converges faster than any power of the spacing.
    points = 64 + 2 * int(np.max(np.abs(x), initial=0.0) + np.max(np.abs(order)))
    angle = np.pi * (np.arange(points) + 0.5) / points
    return np.mean(np.cos(order * angle - np.multiply.outer(x, np.sin(angle))), axis=-1)


_FUNCTIONS = {
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan,
    "atan2": np.arctan2, "sinh": np.sinh, "cosh": np.cosh, "tanh": np.tanh, "asinh": np.arcsinh, "acosh": np.arccosh,
    "atanh": np.arctanh, "exp": np.exp, "ln": np.log, "log": np.log, "log2": np.log2, "log10": np.log10,
    "sqrt": np.sqrt, "abs": np.abs, "sign": np.sign, "rint": np.rint, "besselj": _bessel_j,
    "min": lambda *a: np.minimum.reduce(np.broadcast_arrays(*a)),
    "max": lambda *a: np.maximum.reduce(np.broadcast_arrays(*a)),
    "sum": lambda *a: sum(a), "avg": lambda *a: sum(a) / len(a),
}  # fmt: skip

_BINARY = [
    {"||": lambda a, b: (a != 0) | (b != 0)},
    {"&&": lambda a, b: (a != 0) & (b != 0)},
    {
        "<": np.less,
        ">": np.greater,
        "<=": np.less_equal,
        ">=": np.greater_equal,
        "==": np.equal,
        "!=": np.not_equal,
    },
    {"+": np.add, "-": np.subtract},
    {"*": np.multiply, "/": np.divide},
]


class _Parser:
    def __init__(self, text: str, variables: dict):
        self._text = text
        self._tokens = [match.groups() for match in _TOKEN.finditer(text.strip())]
        self._names = {"pi": np.pi, "_pi": np.pi, "_e": np.e} | variables

    def whole(self):
        value = self._choice()
        if self._tokens:
            self._refuse()
        return value

    def _refuse(self):
        raise Failure(USAGE, f"The expression '{self._text}' of the scene cannot be read.")

    def _take(self, *symbols):
        if self._tokens and self._tokens[0][2] in symbols:
            return self._tokens.pop(0)[2]
        return None

    def _expect(self, symbol):
        if not self._take(symbol):
            self._refuse()

    def _choice(self):
        condition = self._binary(0)
        if not self._take("?"):
            return condition
        yes = self._choice()
        self._expect(":")
        return np.where(np.asarray(condition) != 0, yes, self._choice())

    def _binary(self, level):
        if level == len(_BINARY):
            return self._signed()
        value = self._binary(level + 1)
        while symbol := self._take(*_BINARY[level]):
            value = _BINARY[level][symbol](value, self._binary(level + 1))
        return value

    def _signed(self):
        if self._take("-"):
            return -self._signed()
        if self._take("+"):
            return self._signed()
        base = self._primary()
        return np.power(base, self._signed()) if self._take("^") else base

    def _primary(self):
        if not self._tokens:
            self._refuse()
        if self._take("("):
            value = self._choice()
            self._expect(")")
            return value
        number, name, _ = self._tokens.pop(0)
        if number:
            return float(number)
        if name in _FUNCTIONS and self._take("("):
            arguments = [self._choice()]
            while self._take(","):
                arguments.append(self._choice())
            self._expect(")")
            return _FUNCTIONS[name](*arguments)
        if name not in self._names:
            self._refuse()
        return self._names[name]


def evaluate(text, **variables) -> np.ndarray:
    """Value of an expression, or of a number, at the given variables (arrays that broadcast)."""
    shape = np.broadcast_shapes(*(np.shape(value) for value in variables.values()))
    if not isinstance(text, str):
        return np.full(shape, float(text))
    return np.broadcast_to(np.asarray(_Parser(text, variables).whole(), dtype=float), shape)
