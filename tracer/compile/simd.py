"""SIMD vectors of eight float64. Used to test a ray against the eight child boxes of a BVH node, or eight triangles.

In Python the lanes are an array of eight numbers. Compiled, they are one or two vector registers.
"""

import operator
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core.datamodel import models
from numba.extending import lower_builtin, register_model, type_callable

from tracer.compile.intrinsics import data_pointer, lowering

WIDTH = 8


class LanesType(types.Type):
    def __init__(self) -> None:
        super().__init__("Lanes")


DOUBLES = ir.VectorType(ir.DoubleType(), WIDTH)
FLOATS = ir.VectorType(ir.FloatType(), WIDTH)
LANES = LanesType()


@register_model(LanesType)
class _VectorModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: types.Type) -> None:
        super().__init__(manager, kind, DOUBLES)


def load_lanes(row: Any) -> Any:
    """Load the eight numbers of a row, float32 or float64, as float64."""
    return np.array(row, np.float64)


def broadcast(number: float) -> Any:
    """The same number in every lane."""
    return np.full(WIDTH, number)


def lanes_max(a: Any, b: Any) -> Any:
    """The larger number of each lane: a where a > b, else b. So b where a is NaN."""
    return np.where(a > b, a, b)


def lanes_min(a: Any, b: Any) -> Any:
    return np.where(a < b, a, b)


def mask_less_equal(a: Any, b: Any) -> int:
    """Bit mask of the lanes in which a <= b: bit k for lane k."""
    return sum(1 << k for k in range(WIDTH) if a[k] <= b[k])


def mask_less(a: Any, b: Any) -> int:
    """Bit mask of the lanes in which a < b: bit k for lane k."""
    return sum(1 << k for k in range(WIDTH) if a[k] < b[k])


def store_lanes(a: Any, row: Any) -> None:
    """Store the lanes into a row of eight float64."""
    row[:] = a


def lowest_bit(bits: int) -> int:
    """The index of the lowest bit that is set. At least one must be."""
    return (int(bits) & -int(bits)).bit_length() - 1


@lowering(load_lanes, LANES, types.Array)
def _load_lanes(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    data = data_pointer(context, builder, signature.args[0], arguments[0])
    if signature.args[0].dtype == types.float64:
        return builder.load(builder.bitcast(data, DOUBLES.as_pointer()), align=8)
    return builder.fpext(builder.load(builder.bitcast(data, FLOATS.as_pointer()), align=4), DOUBLES)


def _splat(builder: Any, number: Any) -> Any:
    one = builder.insert_element(ir.Constant(DOUBLES, ir.Undefined), number, ir.IntType(32)(0))
    return builder.shuffle_vector(one, one, ir.Constant(ir.VectorType(ir.IntType(32), WIDTH), [0] * WIDTH))


@lowering(broadcast, LANES, types.float64)
def _broadcast(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return _splat(builder, arguments[0])


def _type_operator(context: Any) -> Any:
    return lambda a, b: LANES if LANES in (a, b) and {a, b} <= {LANES, types.float64} else None


def _lower_operator(name: str) -> Any:
    def lower(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        spread = [
            value if kind == LANES else _splat(builder, value)
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


for _function, _sign in ((lanes_max, ">"), (lanes_min, "<")):
    lowering(_function, LANES, LanesType, LanesType)(_lower_choice(_sign))


def _lower_comparison(sign: str) -> Any:
    def lower(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        bits = builder.bitcast(builder.fcmp_ordered(sign, *arguments), ir.IntType(WIDTH))
        return builder.zext(bits, ir.IntType(64))

    return lower


for _function, _sign in ((mask_less_equal, "<="), (mask_less, "<")):
    lowering(_function, types.int64, LanesType, LanesType)(_lower_comparison(_sign))


@lowering(store_lanes, types.none, LanesType, types.Array)
def _store_lanes(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    data = data_pointer(context, builder, signature.args[1], arguments[1])
    builder.store(arguments[0], builder.bitcast(data, DOUBLES.as_pointer()), align=8)
    return context.get_dummy_value()


@lowering(lowest_bit, types.int64, types.int64)
def _lowest_bit(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return builder.cttz(arguments[0], ir.IntType(1)(1))
