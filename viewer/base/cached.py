"""Values that are computed again only if what they depend on has changed."""

from collections.abc import Callable
from typing import Generic, TypeVar

T = TypeVar("T")


class Changed:
    """Tells whether a key differs from the one before."""

    def __init__(self) -> None:
        self._key: object = self  # differs from every key

    def __call__(self, key: object) -> bool:
        if key == self._key:
            return False
        self._key = key
        return True

    def run(self, key: object, act: Callable[[], object]) -> bool:
        """Run `act` if the key has changed, and return whether it has. If `act` fails, the key counts as not seen."""
        if key == self._key:
            return False
        self._key = self
        act()
        self._key = key
        return True


class Cached(Generic[T]):
    """One value with its key."""

    def __init__(self, release: Callable[[T], object] = lambda value: None) -> None:
        self._changed = Changed()
        self._value: list[T] = []
        self._release = release  # called with a value that is replaced

    def get(self, key: object, make: Callable[[], T]) -> T:
        """The value of this key, made by `make` if the key before was another."""
        self._changed.run(key, lambda: self._replace(make))
        return self._value[0]

    @property
    def last(self) -> T:
        """The value of the last key. IndexError if there is none."""
        return self._value[0]

    def _replace(self, make: Callable[[], T]) -> None:
        self.release()
        self._value.append(make())

    def release(self) -> None:
        """Release the value, if there is one."""
        while self._value:
            self._release(self._value.pop())
