"""The languages that a reader wants, and the translation of a lesson that is chosen by them.

An option says one of them. As gettext does it, the environment says the others: LANGUAGE, a list with colons, else
LC_ALL, LC_MESSAGES or LANG.
"""

import os
import re
from collections.abc import Sequence
from pathlib import Path

from tracer.printable import shown_path
from viewer.base.files import Unusable
from viewer.base.values import LANGUAGE_CODE

ORIGINAL = "en"  # the language of a lesson.md that has no translation into it
FILE = re.compile(r"lesson\.([^.]+)\.md")


def wanted(first: str | None = None) -> list[str]:
    """The codes of the languages that are wanted, each with its country, then without: `first`, then those that the
    environment asks for.
    """
    names = ("LC_ALL", "LC_MESSAGES", "LANG")
    said = os.environ.get("LANGUAGE") or next((os.environ[name] for name in names if os.environ.get(name)), "")
    codes = [re.split(r"[.@]", word)[0] for word in (first or "", *said.split(":"))]
    return list(dict.fromkeys(one for code in codes if LANGUAGE_CODE.fullmatch(code) for one in _with_general(code)))


def _with_general(code: str) -> tuple[str, str]:
    """The code of a language, and the same without its country."""
    return (code, code.split("_")[0])


def translations(path: Path, only: str | None = None) -> dict[str, Path]:
    """The translations beside a lesson.md, by their language: all, or `only` that into one, if there is one."""
    files = sorted(path.parent.glob("lesson.*.md"))
    found = {known[1]: file for file in files if (known := FILE.fullmatch(file.name))}
    return {code: file for code, file in found.items() if only is None or code in _with_general(only)}


def check_language(path: Path, language: str | None) -> None:
    """Unusable if a lesson.md is not there in the language that was asked for."""
    known = (ORIGINAL, *translations(path))
    if language is not None and not set(_with_general(language)) & set(known):
        raise Unusable(f"{shown_path(path)}: --language must be one of {', '.join(known)}, got {language}")


def web_tag(language: str) -> str:
    """The language of a lesson as pages and documents name it (BCP 47); an empty one is that of lesson.md."""
    return (language or ORIGINAL).replace("_", "-")


def translation_of(path: Path, languages: Sequence[str]) -> tuple[str, Path] | None:
    """The language and the file of the first translation that there is; None: lesson.md itself is to be read."""
    there = translations(path) if languages else {}
    for language in languages:
        if language in there:
            return language, there[language]
        if language == ORIGINAL:
            break
    return None
