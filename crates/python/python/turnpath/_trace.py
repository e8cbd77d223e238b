"""Traces a function of x and y into the steps of a formula.

The function is called once, with numbers that write down what is done to them. numpy's functions
arrive at them through ``__array_ufunc__``. What a formula cannot do raises a ``TraceError`` that says
why: a branch on x or y, a call that wants a plain number, a function that formulas do not have.
"""

from __future__ import annotations

import math
import operator
from typing import Any, Callable, Mapping, Union

import numpy as np

from ._errors import TraceError

Step = tuple[str, list[int], float]
Operand = Union["TraceNumber", int, float]

# numpy's functions, and the steps of formulas.
_TWO = {
    np.add: "sum",
    np.subtract: "difference",
    np.multiply: "product",
    np.true_divide: "quotient",
    np.arctan2: "atan2",
    np.hypot: "hypot",
    np.minimum: "min",
    np.maximum: "max",
    np.fmin: "min",
    np.fmax: "max",
}
_ONE = {
    np.negative: "negative",
    np.sqrt: "sqrt",
    np.absolute: "abs",
    np.fabs: "abs",
    np.exp: "exp",
    np.log: "ln",
    np.sin: "sin",
    np.cos: "cos",
    np.tan: "tan",
    np.arcsin: "asin",
    np.arccos: "acos",
    np.arctan: "atan",
    np.sinh: "sinh",
    np.cosh: "cosh",
    np.tanh: "tanh",
}
# Steps whose values have the same bits on every machine: numpy rounds each of them correctly.
_ROUNDED = frozenset(("sum", "difference", "product", "quotient", "negative", "sqrt", "abs", "min", "max"))
# The value of a step whose operands are plain numbers.
_VALUES: dict[str, Callable[..., float]] = {
    **{step: function for function, step in _TWO.items()},
    **{step: function for function, step in _ONE.items()},
}


class Tracer:
    """The steps so far. Equal steps stand once."""

    def __init__(self) -> None:
        self.steps: list[Step] = []
        self.numbers: dict[tuple[str, tuple[int, ...], str], int] = {}
        #: Whether the formula is all that the function does: no plain number was taken out of it and
        #: worked on outside, or decided something, with bits that numpy gives on this machine alone.
        self.exact = True
        #: The numbers of steps whose values numpy worked out with functions that differ.
        self.inexact: set[int] = set()

    def step(self, name: str, operands: tuple[TraceNumber, ...] = (), number: float = 0.0) -> TraceNumber:
        """A step of this name on these operands."""
        ids = tuple(operand.id for operand in operands)
        key = (name, ids, float(number).hex())
        if key not in self.numbers:
            self.numbers[key] = len(self.steps)
            if not self.inexact.isdisjoint(ids) or (ids and name not in _ROUNDED):
                self.inexact.add(len(self.steps))
            self.steps.append((name, list(ids), float(number)))
        return TraceNumber(self, self.numbers[key], self._value(name, operands, number))

    def number(self, value: float) -> TraceNumber:
        """A plain number."""
        if not math.isfinite(value):
            raise TraceError(f"the number {value} stands in no formula")
        return self.step("number", (), float(value))

    @staticmethod
    def _value(name: str, operands: tuple[TraceNumber, ...], number: float) -> float | None:
        """What a step is where it does not depend on x and y."""
        if name == "number":
            return number
        values = [operand.value for operand in operands]
        if not values or None in values:
            return None
        with np.errstate(all="ignore"):
            if name == "power":
                return float(np.power(values[0], number))
            return float(_VALUES[name](*values))


class TraceNumber:
    """A number that writes down what is done to it."""

    __slots__ = ("id", "tracer", "value")
    # No hash: equal numbers may be different steps.
    __hash__ = None  # type: ignore[assignment]

    def __init__(self, tracer: Tracer, id: int, value: float | None) -> None:
        self.tracer = tracer
        self.id = id
        self.value = value

    def _operand(self, other: Any) -> TraceNumber:
        if isinstance(other, TraceNumber):
            return other
        if isinstance(other, np.ndarray) and other.ndim > 0:
            raise TraceError("it uses an array; write the sum or the polynomial term by term")
        if isinstance(other, (int, float, np.number)) and not isinstance(other, complex):
            return self.tracer.number(float(other))
        if isinstance(other, np.ndarray):
            return self.tracer.number(float(other))
        raise TraceError(f"it uses {type(other).__name__}, which stands in no formula")

    def _two(self, name: str, a: Any, b: Any) -> TraceNumber:
        return self.tracer.step(name, (self._operand(a), self._operand(b)))

    def __add__(self, other: Any) -> TraceNumber:
        return self._two("sum", self, other)

    def __radd__(self, other: Any) -> TraceNumber:
        return self._two("sum", other, self)

    def __sub__(self, other: Any) -> TraceNumber:
        return self._two("difference", self, other)

    def __rsub__(self, other: Any) -> TraceNumber:
        return self._two("difference", other, self)

    def __mul__(self, other: Any) -> TraceNumber:
        return self._two("product", self, other)

    def __rmul__(self, other: Any) -> TraceNumber:
        return self._two("product", other, self)

    def __truediv__(self, other: Any) -> TraceNumber:
        return self._two("quotient", self, other)

    def __rtruediv__(self, other: Any) -> TraceNumber:
        return self._two("quotient", other, self)

    def __neg__(self) -> TraceNumber:
        return self.tracer.step("negative", (self,))

    def __pos__(self) -> TraceNumber:
        return self

    def __abs__(self) -> TraceNumber:
        return self.tracer.step("abs", (self,))

    def __pow__(self, other: Any) -> TraceNumber:
        exponent = other.value if isinstance(other, TraceNumber) else other
        if exponent is None:
            base_log = self.tracer.step("ln", (self,))
            return self.tracer.step("exp", (base_log * other,))
        if isinstance(exponent, (int, float, np.number)):
            if isinstance(other, TraceNumber):
                other._decide()
            return self.tracer.step("power", (self,), float(exponent))
        raise TraceError(f"it raises to {type(exponent).__name__}, which is no number")

    def __rpow__(self, other: Any) -> TraceNumber:
        return self.tracer.step("exp", (self * self._operand(other)._one("ln"),))

    def _one(self, name: str) -> TraceNumber:
        return self.tracer.step(name, (self,))

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **kwargs: Any) -> TraceNumber:
        if method != "__call__" or kwargs:
            raise TraceError(f"it calls numpy.{ufunc.__name__}.{method} with {sorted(kwargs)}")
        operands = tuple(self._operand(one) for one in inputs)
        if ufunc in _TWO:
            return self.tracer.step(_TWO[ufunc], operands)
        if ufunc in _ONE:
            return self.tracer.step(_ONE[ufunc], operands)
        if ufunc in _MADE:
            return _MADE[ufunc](*operands)
        raise TraceError(f"formulas have no numpy.{ufunc.__name__}")

    def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> TraceNumber:
        raise TraceError(f"formulas have no numpy.{function.__name__}")

    def __array__(self, *_: Any, **__: Any) -> Any:
        raise TraceError("it makes an array of x and y")

    def _plain(self, what: str, help: str) -> float:
        """The value of what does not depend on x and y; a branch on a parameter is allowed."""
        if self.value is None:
            raise TraceError(f"{what}; {help}")
        self._decide()
        return self.value

    def _decide(self) -> None:
        """Its value leaves the formula: it is an exponent, or decides a branch."""
        if self.id in self.tracer.inexact:
            self.tracer.exact = False

    def __float__(self) -> float:
        value = self._plain(
            "it makes a plain number of x or y", "write numpy.sin(x) for math.sin(x), and so on"
        )
        self.tracer.exact = False
        return value

    def __int__(self) -> int:
        return int(float(self))

    def __index__(self) -> int:
        raise TraceError("it counts with x or y, or with a parameter that is no int")

    def __bool__(self) -> bool:
        return bool(self._plain("it branches on x or y", "a formula has no branches"))

    def _compared(self, other: Any, how: Callable[[float, float], bool]) -> bool:
        other = self._operand(other)
        text = "it compares x or y", "a formula has no branches, but numpy.minimum and maximum"
        return how(self._plain(*text), other._plain(*text))

    def __lt__(self, other: Any) -> bool:
        return self._compared(other, operator.lt)

    def __le__(self, other: Any) -> bool:
        return self._compared(other, operator.le)

    def __gt__(self, other: Any) -> bool:
        return self._compared(other, operator.gt)

    def __ge__(self, other: Any) -> bool:
        return self._compared(other, operator.ge)

    def __eq__(self, other: Any) -> bool:
        return self._compared(other, operator.eq)

    def __ne__(self, other: Any) -> bool:
        return self._compared(other, operator.ne)


_MADE: dict[np.ufunc, Callable[..., TraceNumber]] = {
    np.square: lambda a: a**2,
    np.reciprocal: lambda a: 1.0 / a,
    np.power: lambda a, b: a**b,
    np.float_power: lambda a, b: a**b,
    np.positive: lambda a: a,
    np.degrees: lambda a: a * (180.0 / math.pi),
    np.rad2deg: lambda a: a * (180.0 / math.pi),
    np.radians: lambda a: a * (math.pi / 180.0),
    np.deg2rad: lambda a: a * (math.pi / 180.0),
}


def trace(
    function: Callable[..., Any], arguments: Mapping[str, Any]
) -> tuple[list[Step], bool]:
    """The steps of ``function(x, y, **arguments)``, the height last, and whether they hold all of it.

    Parameters that are floats are a part of the trace, so that what numpy does to them is worked out
    by the formula, with the same bits on every machine.

    Raises:
        TraceError: when the function is no formula.
    """
    tracer = Tracer()
    x, y = tracer.step("x"), tracer.step("y")
    numbers = {
        name: tracer.number(value) if type(value) is float else value
        for name, value in arguments.items()
    }
    try:
        height = function(x, y, **numbers)
    except TraceError:
        raise
    except Exception as error:
        raise TraceError(f"it raises {type(error).__name__} without arrays: {error}") from error
    height = x._operand(height)
    zero = tracer.number(0.0)
    # The last step is the height.
    return [*tracer.steps, ("sum", [height.id, zero.id], 0.0)], tracer.exact
