"""Eight numbers side by side, on which the processor works at once: boxes are tested by the eight.

In Python lanes are an array of eight; compiled they are one vector register or two.
"""

import operator
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core.datamodel import models
from numba.extending import lower_builtin, register_model, type_callable

from tracer.compile.intrinsics import data_of

WIDTH = 8


class LanesType(types.Type):
    def __init__(self) -> None:
        super().__init__("Lanes")


VECTOR = ir.VectorType(ir.DoubleType(), WIDTH)
NARROW = ir.VectorType(ir.FloatType(), WIDTH)
LANES = LanesType()


@register_model(LanesType)
class _VectorModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: types.Type) -> None:
        super().__init__(manager, kind, VECTOR)


def lanes(row: Any) -> Any:
    """The eight numbers of a row, float32 or float64, as float64."""
    return np.array(row, np.float64)


def alike(number: float) -> Any:
    """One number in every lane."""
    return np.full(WIDTH, number)


def larger(a: Any, b: Any) -> Any:
    """Lane by lane a where a > b, else b: so b where a is not a number."""
    return np.where(a > b, a, b)


def smaller(a: Any, b: Any) -> Any:
    return np.where(a < b, a, b)


def no_more(a: Any, b: Any) -> int:
    """In which lanes a <= b: bit k for lane k."""
    return sum(1 << k for k in range(WIDTH) if a[k] <= b[k])


def below(a: Any, b: Any) -> int:
    """In which lanes a < b: bit k for lane k."""
    return sum(1 << k for k in range(WIDTH) if a[k] < b[k])


def keep(a: Any, row: Any) -> None:
    """Write the lanes into a row of eight float64."""
    row[:] = a


def first_of(bits: int) -> int:
    """The number of the lowest bit that is set; there must be one."""
    return (int(bits) & -int(bits)).bit_length() - 1


@type_callable(lanes)
def _type_lanes(context: Any) -> Any:
    return lambda row: LANES


@lower_builtin(lanes, types.Array)
def _lower_lanes(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    data = data_of(context, builder, signature.args[0], arguments[0])
    if signature.args[0].dtype == types.float64:
        return builder.load(builder.bitcast(data, VECTOR.as_pointer()), align=8)
    return builder.fpext(builder.load(builder.bitcast(data, NARROW.as_pointer()), align=4), VECTOR)


def _spread(builder: Any, number: Any) -> Any:
    one = builder.insert_element(ir.Constant(VECTOR, ir.Undefined), number, ir.IntType(32)(0))
    return builder.shuffle_vector(one, one, ir.Constant(ir.VectorType(ir.IntType(32), WIDTH), [0] * WIDTH))


@type_callable(alike)
def _type_alike(context: Any) -> Any:
    return lambda number: LANES


@lower_builtin(alike, types.float64)
def _lower_alike(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return _spread(builder, arguments[0])


def _type_operator(context: Any) -> Any:
    return lambda a, b: LANES if LANES in (a, b) and {a, b} <= {LANES, types.float64} else None


def _lower_operator(name: str) -> Any:
    def lower(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        spread = [
            value if kind == LANES else _spread(builder, value)
            for kind, value in zip(signature.args, arguments, strict=True)
        ]
        return getattr(builder, name)(*spread)

    return lower


for _operation, _name in ((operator.sub, "fsub"), (operator.mul, "fmul")):
    type_callable(_operation)(_type_operator)
    lower_builtin(_operation, LanesType, types.float64)(_lower_operator(_name))
    lower_builtin(_operation, LanesType, LanesType)(_lower_operator(_name))


def _lower_choice(sign: str) -> Any:
    def lower(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        a, b = arguments
        return builder.select(builder.fcmp_ordered(sign, a, b), a, b)

    return lower


for _function, _sign in ((larger, ">"), (smaller, "<")):
    type_callable(_function)(lambda context: lambda a, b: LANES)
    lower_builtin(_function, LanesType, LanesType)(_lower_choice(_sign))


def _lower_comparison(sign: str) -> Any:
    def lower(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        bits = builder.bitcast(builder.fcmp_ordered(sign, *arguments), ir.IntType(WIDTH))
        return builder.zext(bits, ir.IntType(64))

    return lower


for _function, _sign in ((no_more, "<="), (below, "<")):
    type_callable(_function)(lambda context: lambda a, b: types.int64)
    lower_builtin(_function, LanesType, LanesType)(_lower_comparison(_sign))


@type_callable(keep)
def _type_keep(context: Any) -> Any:
    return lambda a, row: types.none


@lower_builtin(keep, LanesType, types.Array)
def _lower_keep(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    data = data_of(context, builder, signature.args[1], arguments[1])
    builder.store(arguments[0], builder.bitcast(data, VECTOR.as_pointer()), align=8)
    return context.get_dummy_value()


@type_callable(first_of)
def _type_first_of(context: Any) -> Any:
    return lambda bits: types.int64


@lower_builtin(first_of, types.int64)
def _lower_first_of(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return builder.cttz(arguments[0], ir.IntType(1)(1))
