"""A NamedTuple of arrays that kernels take by one pointer.

Numba hands a tuple of arrays from function to function as seven words an array, which costs more than a ray: a kernel
calling its parts with the whole world ran four times slower. A Bundle is one address, of a table with each array's
address and shape. Kernels read `world.surfaces[k]` as ever; they can write to it only where it is made `writable`.

Kernels are compiled for the shapes of rows (three coordinates), so that strides are constants; where they differ from
scene to scene the field is named in `ragged`, for no scene is to be waited for.
"""

from functools import cache
from typing import Any, NamedTuple

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.datamodel import models
from numba.core.typing.templates import AttributeTemplate
from numba.extending import NativeValue, infer_getattr, lower_getattr_generic, register_model, typeof_impl, unbox
from numba.np.numpy_support import from_dtype


@cache
def array_type(dtype: np.dtype, dimensions: int, writable: bool) -> types.Array:
    """Numba's name for it. Found once: that takes a tenth of a millisecond, and every click makes a Bundle."""
    return types.Array(from_dtype(dtype), dimensions, "C", readonly=not writable)


class Bundle:
    """The arrays of a NamedTuple (C-contiguous) and its numbers (whole, or true and false), for Python as they were."""

    def __init__(self, fields: NamedTuple, writable: bool = False, ragged: tuple[str, ...] = ()) -> None:
        self._fields = fields
        self._options = (writable, ragged)
        table: list[int] = []
        entries: list[FieldLayout] = []
        for name, value in fields._asdict().items():
            if isinstance(value, np.ndarray):
                if not value.flags.c_contiguous:
                    raise TypeError(f"{name} must be C-contiguous")
                kind = array_type(value.dtype, value.ndim, writable)
                tail = (None,) * (value.ndim - 1) if name in ragged else value.shape[1:]
                entries.append(FieldLayout(name, kind, len(table), tail))
                table += [value.ctypes.data, *value.shape]
            else:
                entries.append(
                    FieldLayout(name, types.boolean if isinstance(value, bool) else types.int64, len(table), ())
                )
                table.append(int(value))
        self._table = np.array(table, np.int64)
        self.address = self._table.ctypes.data
        self.numba_type = bundle_type(tuple(entries))

    def __reduce__(self) -> tuple[Any, ...]:
        """In another process it has other addresses: it is made anew, of what it was made of."""
        return (_rebuilt, (self._fields, *self._options))

    def __getattr__(self, name: str) -> Any:
        value = getattr(self._fields, name)
        # With its fields as attributes, as compiled code has them: so kernels run as plain Python too.
        return value.view(np.recarray) if isinstance(value, np.ndarray) and value.dtype.names else value


def _rebuilt(fields: NamedTuple, writable: bool, ragged: tuple[str, ...]) -> Bundle:
    """A Bundle of arrays that came over a wire: they lie at any address, and kernels count on aligned ones."""
    aligned = {
        name: np.require(a, requirements="A") for name, a in fields._asdict().items() if isinstance(a, np.ndarray)
    }
    return Bundle(fields._replace(**aligned), writable, ragged)


class FieldLayout(NamedTuple):
    """What a kernel has to know of one field."""

    name: str
    type: types.Type
    at: int  # its first word in the table: a number, or an array's address and shape
    tail: tuple[int | None, ...]  # the shape but for its first number; None: to be read from the table


class BundleType(types.Type):
    def __init__(self, entries: tuple[FieldLayout, ...]) -> None:
        self.entries = entries
        super().__init__(f"Bundle({entries})")


@cache
def bundle_type(entries: tuple[FieldLayout, ...]) -> BundleType:
    """Found once, too: its name has those of all arrays in it."""
    return BundleType(entries)


class _AddressModel(models.PrimitiveModel):
    def __init__(self, manager: Any, kind: types.Type) -> None:
        super().__init__(manager, kind, ir.IntType(64))


register_model(BundleType)(_AddressModel)


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


@lower_getattr_generic(BundleType)
def _read(context: Any, builder: Any, kind: BundleType, address: Any, attribute: str) -> Any:
    from numba.np.arrayobj import make_array, populate_array  # loaded only where something is compiled

    entry = next(entry for entry in kind.entries if entry.name == attribute)
    word = ir.IntType(64)
    table = builder.inttoptr(address, word.as_pointer())

    def load(index: int) -> Any:
        value = builder.load(cgutils.gep_inbounds(builder, table, index))
        value.set_metadata("invariant.load", builder.module.add_metadata([]))  # so that loops load it once
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
        strides.insert(0, builder.mul(strides[0], n))  # of constants the compiler makes a constant
    populate_array(
        array,
        data=builder.inttoptr(first, array.data.type),
        shape=shape,
        strides=strides,
        itemsize=word(size),
        meminfo=None,
    )
    return array._getvalue()
