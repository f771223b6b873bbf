"""The languages that a reader wants, and the translation of a lesson that is chosen by them.

As gettext does it, the environment says them: LANGUAGE, a list with colons, else LC_ALL, LC_MESSAGES or LANG.
"""

import os
import re
from collections.abc import Sequence
from pathlib import Path

from viewer.base.values import LANGUAGE_CODE

ORIGINAL = "en"  # the language of a lesson.md that has no translation into it
FILE = re.compile(r"lesson\.([^.]+)\.md")


def choose(language: str) -> None:
    """Want this language from now on, before those of the system."""
    os.environ["LANGUAGE"] = ":".join([language, *wanted()])


def wanted() -> list[str]:
    """The codes of the languages that the environment asks for, each with its country, then without."""
    names = ("LC_ALL", "LC_MESSAGES", "LANG")
    said = os.environ.get("LANGUAGE") or next((os.environ[name] for name in names if os.environ.get(name)), "")
    codes = [re.split(r"[.@]", word)[0] for word in said.split(":")]
    known = [code for code in codes if LANGUAGE_CODE.fullmatch(code)]
    return list(dict.fromkeys(one for code in known for one in (code, code.split("_")[0])))


def translations(path: Path) -> dict[str, Path]:
    """The translations beside a lesson.md, by their language."""
    files = sorted(path.parent.glob("lesson.*.md"))
    return {found[1]: file for file in files if (found := FILE.fullmatch(file.name))}


def translation_of(path: Path, languages: Sequence[str]) -> tuple[str, Path] | None:
    """The language and the file of the first translation that there is; None: lesson.md itself is to be read."""
    there = translations(path) if languages else {}
    for language in languages:
        if language in there:
            return language, there[language]
        if language == ORIGINAL:
            break
    return None
