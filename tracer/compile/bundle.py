"""A NamedTuple of arrays that kernels take by one pointer.

Numba passes a tuple of arrays from function to function as seven words per array, which costs more than tracing a
ray: a kernel that passed the whole world to its functions ran four times slower. A Bundle is passed as one address,
that of a table with the address and the shape of each array. Kernels read `world.surfaces[k]` as usual, and write
only if it is `writable`.

Kernels are compiled for fixed shapes of rows (three coordinates), so that strides are constants. A field whose rows
differ in shape from scene to scene is named in `ragged`; else each such scene would wait for a compilation.

A field may also be a NamedTuple of functions: `world.formulas.intersect(...)` calls the function directly, since the
type of the Bundle says which one it is.
"""

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple, TypeVar, cast

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.datamodel import models
from numba.core.typing.templates import AttributeTemplate
from numba.extending import NativeValue, infer_getattr, lower_getattr_generic, register_model, typeof_impl, unbox
from numba.np.numpy_support import from_dtype

T = TypeVar("T", bound=tuple)


def bundle(fields: T, writable: bool = False, ragged: tuple[str, ...] = ()) -> T:
    """A Bundle of these fields. It has their names and types, so the type checker takes it for the NamedTuple."""
    return cast(T, Bundle(fields, writable, ragged))


@cache
def array_type(dtype: np.dtype, dimensions: int, writable: bool) -> types.Array:
    """Numba's type of an array. Cached: looking it up takes 0.1 ms, and every click makes a Bundle."""
    return types.Array(from_dtype(dtype), dimensions, "C", readonly=not writable)


class Bundle:
    """The fields of a NamedTuple for kernels: C-contiguous arrays, integers, booleans, tables of functions."""

    def __init__(self, fields: Any, writable: bool, ragged: tuple[str, ...]) -> None:
        self._fields = fields
        self._options = (writable, ragged)
        table: list[int] = []
        entries: list[FieldLayout] = []
        for name, value in fields._asdict().items():
            if isinstance(value, np.ndarray):
                if value.dtype.names:
                    value = value.view(np.ndarray)  # attributes of record arrays are slow
                if not value.flags.c_contiguous:
                    raise TypeError(f"{name} must be C-contiguous")
                kind = array_type(value.dtype, value.ndim, writable)
                tail = (None,) * (value.ndim - 1) if name in ragged else value.shape[1:]
                entries.append(FieldLayout(name, kind, len(table), tail))
                table += [value.ctypes.data, *value.shape]
            elif isinstance(value, tuple):
                kind = FunctionTableType(cast(Any, value).name)
                kind.functions = value
                entries.append(FieldLayout(name, kind, len(table), ()))
            else:
                entries.append(
                    FieldLayout(name, types.boolean if isinstance(value, bool) else types.int64, len(table), ())
                )
                table.append(int(value))
        self._table = np.array(table, np.int64)
        self.address = self._table.ctypes.data
        self.numba_type = bundle_type(tuple(entries))

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle the fields. In another process their addresses differ, so the table is made anew."""
        return (_rebuilt, (self._fields, *self._options))

    def __getattr__(self, name: str) -> Any:
        value = getattr(self._fields, name)
        # With fields as attributes, as in compiled code, so that kernels also run as plain Python.
        return value.view(np.recarray) if isinstance(value, np.ndarray) and value.dtype.names else value


def _rebuilt(fields: Any, writable: bool, ragged: tuple[str, ...]) -> Bundle:
    """Rebuild a Bundle from unpickled arrays. These may lie at any address, and kernels rely on aligned ones."""
    aligned = {
        name: np.require(a, requirements="A") for name, a in fields._asdict().items() if isinstance(a, np.ndarray)
    }
    return Bundle(fields._replace(**aligned), writable, ragged)


class FieldLayout(NamedTuple):
    """The layout of one field, known at compile time."""

    name: str
    type: types.Type
    at: int  # index of its first word in the table: a number, or an array's address and shape
    tail: tuple[int | None, ...]  # the shape without its first number; None: read it from the table


class FunctionTableType(types.Opaque):
    """Numba's type of a NamedTuple of functions, whose field `name` tells it from others.

    In the list of cached kernels it stands without functions, which only compilation needs. Numba keeps one instance of
    equal types, so a type from that list gets its functions when a Bundle has them.
    """

    functions: Any = None

    def __init__(self, name: str) -> None:
        self.table = name
        super().__init__(f"FunctionTable({name})")

    def __reduce__(self) -> tuple[Callable[..., Any], tuple[Any, ...]]:
        return (FunctionTableType, (self.table,))


class BundleType(types.Type):
    """Numba's type of a Bundle: the layout of its table."""

    def __init__(self, entries: tuple[FieldLayout, ...]) -> None:
        self.entries = entries
        super().__init__(f"Bundle({entries})")


@cache
def bundle_type(entries: tuple[FieldLayout, ...]) -> BundleType:
    """Numba's type of a Bundle. Cached, since its name contains the types of all arrays and takes long to build."""
    return BundleType(entries)


class _AddressModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: types.Type) -> None:
        super().__init__(manager, kind, ir.IntType(64))


register_model(BundleType)(_AddressModel)
register_model(FunctionTableType)(models.OpaqueModel)  # reference counting needs a model, though there is no data


@typeof_impl.register(Bundle)
def _typeof(bundle: Bundle, context: Any) -> BundleType:
    return bundle.numba_type


@unbox(BundleType)
def _unbox(kind: BundleType, bundle: Any, c: Any) -> NativeValue:
    number = c.pyapi.object_getattr_string(bundle, "address")
    address = c.pyapi.long_as_longlong(number)
    c.pyapi.decref(number)
    return NativeValue(address, is_error=cgutils.is_not_null(c.builder, c.pyapi.err_occurred()))


@infer_getattr
class _BundleAttributes(AttributeTemplate):
    key = BundleType

    def generic_resolve(self, kind: BundleType, attribute: str) -> types.Type | None:
        return next((entry.type for entry in kind.entries if entry.name == attribute), None)


@infer_getattr
class _FunctionTableAttributes(AttributeTemplate):
    key = FunctionTableType

    def generic_resolve(self, kind: FunctionTableType, attribute: str) -> types.Type:
        return self.context.resolve_value_type(getattr(kind.functions, attribute))


@lower_getattr_generic(FunctionTableType)
def _function(context: Any, builder: Any, kind: FunctionTableType, table: Any, attribute: str) -> Any:
    return context.get_dummy_value()  # a call takes the function from the type


@lower_getattr_generic(BundleType)
def _read(context: Any, builder: Any, kind: BundleType, address: Any, attribute: str) -> Any:
    from numba.np.arrayobj import make_array, populate_array  # imported only where something is compiled

    entry = next(entry for entry in kind.entries if entry.name == attribute)
    if isinstance(entry.type, FunctionTableType):
        return context.get_dummy_value()
    word = ir.IntType(64)
    table = builder.inttoptr(address, word.as_pointer())

    def load(index: int) -> Any:
        value = builder.load(cgutils.gep_inbounds(builder, table, index))
        value.set_metadata("invariant.load", builder.module.add_metadata([]))  # constant: loops load it once
        return value

    first = load(entry.at)
    if not isinstance(entry.type, types.Array):
        return context.cast(builder, first, types.int64, entry.type)
    array = make_array(entry.type)(context, builder)
    size = context.get_abi_sizeof(context.get_data_type(entry.type.dtype))
    shape = [load(entry.at + 1)]
    shape += [load(entry.at + 2 + k) if n is None else word(n) for k, n in enumerate(entry.tail)]
    strides = [word(size)]
    for n in reversed(shape[1:]):
        strides.insert(0, builder.mul(strides[0], n))  # constant where the shape is
    populate_array(
        array,
        data=builder.inttoptr(first, array.data.type),
        shape=shape,
        strides=strides,
        itemsize=word(size),
        meminfo=None,
    )
    return array._getvalue()
