"""Row types: one class gives a structured numpy dtype, and tells the type checker which fields a row has.

class LightRow(Row):
    position: Float3
    distant: Bool

LIGHT = dtype_of(LightRow)
lights = as_rows(np.zeros(2, LIGHT), LightRow)
lights[0].position[0]
"""

from typing import TYPE_CHECKING, Annotated, Any, Generic, TypeVar, get_type_hints, overload

import numpy as np

R = TypeVar("R")


class Row:
    """Base of row types. The annotations name the fields, in the order of the dtype."""


Numbers = np.ndarray  # an array of numbers

Float = Annotated[float, np.float64]
Float3 = Annotated[Numbers, np.float64, 3]
Int32 = Annotated[int, np.int32]
Int64 = Annotated[int, np.int64]
Bool = Annotated[bool, np.bool_]

if TYPE_CHECKING:

    class Rows(np.ndarray, Generic[R]):
        """An array of rows: a number gives a row, a name a column."""

        @overload  # type: ignore[override]
        def __getitem__(self, index: int) -> R: ...
        @overload
        def __getitem__(self, index: str) -> np.ndarray: ...
        @overload
        def __getitem__(self, index: slice) -> "Rows[R]": ...
        @overload
        def __getitem__(self, index: tuple[int, ...]) -> R: ...
        def __getitem__(self, index: Any) -> Any: ...

else:
    Rows = np.ndarray


def dtype_of(row: type[Row]) -> np.dtype:
    """The structured dtype of a row type, aligned as in C."""
    hints = get_type_hints(row, include_extras=True)
    return np.dtype([(name, *hint.__metadata__) for name, hint in hints.items()], align=True)


def zero_rows(count: int, dtype: np.dtype, kind: type[R]) -> Rows[R]:
    """Rows of zeros for a bundle, which shows the fields of a row as attributes. Cheaper than `as_rows`."""
    return np.zeros(count, dtype)  # type: ignore[return-value]


def as_rows(array: Any, kind: type[R]) -> Rows[R]:
    """A structured array as rows of its type. The fields of a row are attributes, as in compiled code."""
    return array.view(np.recarray)
