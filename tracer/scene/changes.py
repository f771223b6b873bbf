"""Changes to the document of a scene file before it is read: `{"material": {"glass": {"ior": 1.5}}}`.

The keys are those of the file. An entry of a list, such as a material, is named by its `name`; one without a name by
its number in the file from 0, as `#2`.
"""

from collections.abc import Iterable, Mapping
from copy import deepcopy
from typing import Any

from tracer import fields


def overridden(
    document: Mapping[str, Any], changes: Mapping[str, Any], tables: Iterable[str], lists: Iterable[str]
) -> tuple[dict[str, Any], list[str]]:
    """(the document with the changes, faults). `tables` and `lists` are the names of the document's tables and of its
    lists of tables. The values are not checked: the reader of the document does that.
    """
    tables, lists = tuple(tables), tuple(lists)
    changed, faults = deepcopy(dict(document)), []
    for key, change in changes.items():
        if key not in (*tables, *lists):
            faults.append(f'set: unknown key "{key}"{fields.hint(key, (*tables, *lists))}')
        elif not isinstance(change, Mapping):
            faults.append(fields.refusal(f"set: {key}", "a table", change))
        elif key in tables:
            table = changed.setdefault(key, {})
            if isinstance(table, dict):
                table.update(change)
        else:
            faults += _change_list(key, changed.get(key, []), change)
    return changed, faults


def _change_list(key: str, entries: Any, change: Mapping[str, Any]) -> list[str]:
    """Change entries of a list of tables by their names. Returns the faults."""
    faults = []
    known: dict[str, dict] = {}
    for k, entry in enumerate(entries if isinstance(entries, list) else ()):
        if isinstance(entry, dict):
            known.setdefault(str(entry.get("name", f"#{k}")), entry)
    for name, values in change.items():
        if name not in known:
            faults.append(f'set: {key} must be the name of a [[{key}]], got "{name}"{fields.hint(name, known)}')
        elif not isinstance(values, Mapping):
            faults.append(fields.refusal(f'set: {key} "{name}"', "a table", values))
        else:
            known[name].update(values)
    return faults
