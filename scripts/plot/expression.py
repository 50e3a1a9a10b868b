"""Evaluation of scene expressions (muParser syntax) on numpy arrays."""

import re

import numpy as np

from .failure import USAGE, Failure

_TOKEN = re.compile(
    r"\s*(?:(\d+\.?\d*(?:[eE][+-]?\d+)?|\.\d+(?:[eE][+-]?\d+)?)|([A-Za-z_]\w*)|(<=|>=|==|!=|&&|\|\||.))"
)


def _bessel_j(order, x):
    # Bessel's integral by the trapezoidal rule, which converges geometrically over a period.
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
}

_BINARY = [
    {"||": lambda a, b: (a != 0) | (b != 0)},
    {"&&": lambda a, b: (a != 0) & (b != 0)},
    {"<": np.less, ">": np.greater, "<=": np.less_equal, ">=": np.greater_equal, "==": np.equal, "!=": np.not_equal},
    {"+": np.add, "-": np.subtract},
    {"*": np.multiply, "/": np.divide},
]


class _Parser:
    """Recursive-descent parser that evaluates while it reads."""

    def __init__(self, text: str, variables: dict):
        self._text = text
        self._tokens = [match.groups() for match in _TOKEN.finditer(text.strip())]
        self._names = {"pi": np.pi, "_pi": np.pi, "_e": np.e} | variables

    def evaluate(self):
        value = self._ternary()
        if self._tokens:
            self._fail()
        return value

    def _fail(self):
        raise Failure(USAGE, f"The expression '{self._text}' of the scene cannot be read.")

    def _accept(self, *symbols):
        if self._tokens and self._tokens[0][2] in symbols:
            return self._tokens.pop(0)[2]
        return None

    def _expect(self, symbol):
        if not self._accept(symbol):
            self._fail()

    def _ternary(self):
        condition = self._binary(0)
        if not self._accept("?"):
            return condition
        yes = self._ternary()
        self._expect(":")
        return np.where(np.asarray(condition) != 0, yes, self._ternary())

    def _binary(self, level):
        if level == len(_BINARY):
            return self._unary()
        value = self._binary(level + 1)
        while symbol := self._accept(*_BINARY[level]):
            value = _BINARY[level][symbol](value, self._binary(level + 1))
        return value

    def _unary(self):
        if self._accept("-"):
            return -self._unary()
        if self._accept("+"):
            return self._unary()
        base = self._primary()
        return np.power(base, self._unary()) if self._accept("^") else base

    def _primary(self):
        if not self._tokens:
            self._fail()
        if self._accept("("):
            value = self._ternary()
            self._expect(")")
            return value
        number, name, _ = self._tokens.pop(0)
        if number:
            return float(number)
        if name in _FUNCTIONS and self._accept("("):
            arguments = [self._ternary()]
            while self._accept(","):
                arguments.append(self._ternary())
            self._expect(")")
            return _FUNCTIONS[name](*arguments)
        if name not in self._names:
            self._fail()
        return self._names[name]


def evaluate(text, **variables) -> np.ndarray:
    """Values of an expression (text) or number on arrays that broadcast; raises Failure (USAGE) if invalid."""
    shape = np.broadcast_shapes(*(np.shape(value) for value in variables.values()))
    if not isinstance(text, str):
        return np.full(shape, float(text))
    return np.broadcast_to(np.asarray(_Parser(text, variables).evaluate(), dtype=float), shape)
