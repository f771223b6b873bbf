"""Reads a text file word by word. The caller names each number that it reads, so that an error can say which one is
missing.
"""

import math
from collections.abc import Container
from typing import NamedTuple

from tracer.formats.source import Fault, lines_of
from tracer.formulas.vector import Vector


class Word(NamedTuple):
    text: str
    line: int  # counted from 1


class Words:
    """The words of a text. A comment goes from `#` to the end of its line.

    `names` are the words that begin an entity. If one is found in place of a number, the number is missing.
    """

    def __init__(self, text: str, names: Container[str]) -> None:
        self.names = names
        self.texts: list[str] = []
        self.lines: list[int] = []  # of each word
        for number, line in enumerate(lines_of(text), 1):
            words = line.partition("#")[0].split()
            self.texts += words
            self.lines += [number] * len(words)
        self.at = 0

    def left(self) -> bool:
        return self.at < len(self.texts)

    def share(self) -> float:
        """The share of the words that have been read."""
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
        """Read a finite number. Raises Fault for any other word, which remains the next one."""
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
        try:
            x, y, z = map(float, self.texts[self.at : self.at + 3])
        except ValueError:
            return (self.number(what), self.number(what), self.number(what))  # raises Fault
        if math.isfinite(x) and math.isfinite(y) and math.isfinite(z):
            self.at += 3
            return (x, y, z)
        return (self.number(what), self.number(what), self.number(what))

    def skip(self) -> None:
        """After a fault, skip to the next name, or to a word on a later line that is not a number."""
        here = self.lines[self.at - 1]  # the line of the last word that was read
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
