"""A text file word by word: each number is asked for by what it means, so that a fault can say what is missing."""

import math
from collections.abc import Container
from typing import NamedTuple

from tracer.formulas.vector import Vector


class Word(NamedTuple):
    text: str
    line: int  # counted from 1


class Fault(Exception):
    """What is wrong, without the file; `line` where it is another one than the entity's."""

    def __init__(self, text: str, line: int | None = None) -> None:
        super().__init__(text)
        self.line = line


class Words:
    """The words of a text, read from the front; `#` starts a comment that runs to the end of its line.

    `names` are the words that begin something: where one stands in a number's place, the number is missing.
    """

    def __init__(self, text: str, names: Container[str]) -> None:
        self.names = names
        self.texts: list[str] = []
        self.lines: list[int] = []  # of each
        for number, line in enumerate(text.splitlines(), 1):
            words = line.partition("#")[0].split()
            self.texts += words
            self.lines += [number] * len(words)
        self.at = 0

    def left(self) -> bool:
        return self.at < len(self.texts)

    def share(self) -> float:
        """Of the words that have been read."""
        return self.at / len(self.texts)

    def take(self) -> Word:
        self.at += 1
        return Word(self.texts[self.at - 1], self.lines[self.at - 1])

    def next_in(self, names: Container[str]) -> bool:
        """Whether the next word is one of these."""
        return self.left() and self.texts[self.at] in names

    def number_follows(self) -> bool:
        return self.left() and is_number(self.texts[self.at])

    def number(self, what: str) -> float:
        """The next word as a finite number. Fault for anything else, which is left to be read again."""
        if not self.left():
            raise Fault(f"{what} must be a number, got the end of the file", self.lines[-1])
        found = self.texts[self.at]
        try:
            value = float(found)
        except ValueError:
            missing = found in self.names
            raise Fault(f'{what} must be a number, got "{found}"', self.lines[self.at - missing]) from None
        if not math.isfinite(value):
            raise Fault(f"{what} must be a finite number, got {found}", self.lines[self.at])
        self.at += 1
        return value

    def vector(self, what: str) -> Vector:
        return (self.number(what), self.number(what), self.number(what))

    def skip(self) -> None:
        """After a fault, on to the next name, or on a later line to any word that is no number."""
        here = self.lines[self.at - 1]  # of the last word that was read
        while self.left() and not self.next_in(self.names):
            if self.lines[self.at] > here and not is_number(self.texts[self.at]):
                return
            self.at += 1


def is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
