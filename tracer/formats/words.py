"""A text file word by word: each number is asked for by what it means, so that a fault can say what is missing."""

import math
from collections.abc import Container
from typing import NamedTuple

from tracer.vector import Vector


class Word(NamedTuple):
    text: str
    line: int  # counted from 1


class Fault(Exception):
    """What is wrong, without the place."""


class Words:
    """The words of a text, read from the front; `#` starts a comment that runs to the end of its line."""

    def __init__(self, text: str) -> None:
        self.words = [
            Word(word, number)
            for number, line in enumerate(text.splitlines(), 1)
            for word in line.partition("#")[0].split()
        ]
        self.at = 0

    def left(self) -> bool:
        return self.at < len(self.words)

    def share(self) -> float:
        """Of the words that have been read."""
        return self.at / len(self.words)

    def take(self) -> Word:
        self.at += 1
        return self.words[self.at - 1]

    def next_in(self, names: Container[str]) -> bool:
        """Whether the next word is one of these."""
        return self.left() and self.words[self.at].text in names

    def number_follows(self) -> bool:
        return self.left() and is_number(self.words[self.at].text)

    def number(self, what: str) -> float:
        """The next word as a finite number. Fault for anything else, which is left to be read again."""
        if not self.left():
            raise Fault(f"{what} must be a number, got the end of the file")
        found = self.words[self.at].text
        if not is_number(found):
            raise Fault(f'{what} must be a number, got "{found}"')
        if not math.isfinite(float(found)):
            raise Fault(f"{what} must be a finite number, got {found}")
        self.at += 1
        return float(found)

    def vector(self, what: str) -> Vector:
        return (self.number(what), self.number(what), self.number(what))

    def skip(self, names: Container[str]) -> None:
        """After a fault, on to one of these names, or on a later line to any word that is no number."""
        here = self.words[self.at - 1].line  # of the last word that was read
        while self.left() and not self.next_in(names):
            word = self.words[self.at]
            if word.line > here and not is_number(word.text):
                return
            self.at += 1


def is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
