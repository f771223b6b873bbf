"""Processor instructions and compiler hints that Python has no syntax for.

Called from Python, these functions compute the same more slowly, or do nothing.
"""

from functools import wraps
from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import lower_builtin, type_callable

CACHE_LINE = 64  # bytes


def data_pointer(context: Any, builder: Any, kind: Any, array: Any) -> Any:
    """Pointer to the first element of an array. Numba's array module is imported only where something is compiled."""
    from numba.np.arrayobj import make_array

    return make_array(kind)(context, builder, array).data


def lowering(function: Any, result: types.Type, *arguments: Any) -> Any:
    """Decorator: calls of `function` with arguments of these types compile to the LLVM IR that the decorated emits."""
    type_callable(function)(lambda context: wraps(function)(lambda *_: result))
    return lower_builtin(function, *arguments)


def noinline() -> None:
    """As a function's first line: never inline it. For code that is large and rarely executed."""


@lowering(noinline, types.none)
def _noinline(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    builder.function.attributes.add("noinline")
    return context.get_dummy_value()


def as_unsigned(number: int) -> int:
    """The same number as an unsigned integer. As an index it skips Python's test for negative indices.

    In the traversal, which waits for each child index, the test would cost a tenth of the time.
    """
    return number


@lowering(as_unsigned, types.uint64, types.Integer)
def _as_unsigned(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return context.cast(builder, arguments[0], signature.args[0], types.uint64)


def prefetch(rows: Any, number: int) -> None:
    """Prefetch a row of an array into the processor's cache."""


@lowering(prefetch, types.none, types.Array, types.Integer)
def _prefetch(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    kind = signature.args[0]
    size, byte, word, short = kind.dtype.size, ir.IntType(8).as_pointer(), ir.IntType(64), ir.IntType(32)
    data = builder.bitcast(data_pointer(context, builder, kind, arguments[0]), byte)
    number = context.cast(builder, arguments[1], signature.args[1], types.int64)
    row = builder.gep(data, [builder.mul(number, word(size))])
    prefetch = builder.module.declare_intrinsic(
        "llvm.prefetch", (byte,), ir.FunctionType(ir.VoidType(), [byte, short, short, short])
    )
    for line in range(0, size, CACHE_LINE):
        # arguments: read, keep, data cache
        builder.call(prefetch, [builder.gep(row, [word(line)]), short(0), short(3), short(1)])
    return context.get_dummy_value()


def reference(record: Any) -> Any:
    """A reference to a record, which a tuple can hold: compiled, its address. The record must outlive it."""
    return record


@lowering(reference, types.int64, types.Record)
def _reference(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    return builder.ptrtoint(arguments[0], ir.IntType(64))


def vector_at(reference: Any, number: int) -> Any:
    """The three numbers of one field of a record whose fields are all vectors of float64."""
    x, y, z = reference[number].tolist()
    return (x, y, z)


@lowering(vector_at, types.UniTuple(types.float64, 3), types.Integer, types.Integer)
def _vector_at(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    first = builder.inttoptr(arguments[0], ir.DoubleType().as_pointer())
    number = context.cast(builder, arguments[1], signature.args[1], types.int64)
    place = builder.mul(number, ir.IntType(64)(3))
    numbers = [builder.load(builder.gep(first, [builder.add(place, ir.IntType(64)(k))])) for k in range(3)]
    return context.make_tuple(builder, signature.return_type, numbers)


SPLIT = 2.0**27 + 1.0


def product_error(a: Any, b: Any, product: Any) -> Any:
    """The exact rounding error a b - product, where product is the rounded a b.

    Compiled, this is one fused multiply-add (IEEE 754, 5.4.1). Python has none before 3.13: there the factors are
    split into halves whose products are exact (Dekker, Numerische Mathematik 18, 1971). Also takes arrays.
    """
    a_high = SPLIT * a - (SPLIT * a - a)
    b_high = SPLIT * b - (SPLIT * b - b)
    a_low, b_low = a - a_high, b - b_high
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low


@lowering(product_error, types.float64, types.float64, types.float64, types.float64)
def _product_error(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    a, b, product = arguments
    return builder.fma(a, b, builder.fneg(product))
