"""What an edit changes of what pages show, by key."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, cast

import msgspec

from deodar_studio.messages.to_page import KeyedDifference


def difference(before: Mapping[str, Any], after: Mapping[str, Any]) -> KeyedDifference:
    """Return what changed between two objects; what is equal in both is left out."""
    removed = [key for key in before if key not in after]
    changed: dict[str, Any] = {}
    inside: dict[str, KeyedDifference] = {}
    for key, value in after.items():
        if key not in before:
            changed[key] = value
        elif before[key] is not value and before[key] != value:
            part = _part(before[key], value)
            if part is None:
                changed[key] = value
            else:
                inside[key] = part
    return KeyedDifference(removed=removed, changed=changed, inside=inside)


def _part(before: Any, after: Any) -> KeyedDifference | None:
    """Return the difference of two values; None if the second one replaces the first."""
    if isinstance(before, list) and isinstance(after, list):
        return _in_list(cast("list[Any]", before), cast("list[Any]", after))
    if isinstance(before, msgspec.Struct) and type(before) is type(after):
        return difference(msgspec.structs.asdict(before), msgspec.structs.asdict(after))
    if isinstance(before, dict) and isinstance(after, dict):
        return difference(cast("dict[str, Any]", before), cast("dict[str, Any]", after))
    return None


def _in_list(before: Sequence[Any], after: Sequence[Any]) -> KeyedDifference | None:
    """Return the difference of two lists of structs; None if entries are equal or changed their order."""
    if not all(isinstance(entry, msgspec.Struct) for entry in (*before, *after)):
        return None
    old = {_key(entry): (str(k), entry) for k, entry in enumerate(before)}
    new = {_key(entry): (str(k), entry) for k, entry in enumerate(after)}
    if (len(old), len(new)) != (len(before), len(after)):
        return None
    if [key for key in old if key in new] != [key for key in new if key in old]:
        return None
    removed = [k for key, (k, _) in old.items() if key not in new]
    changed = {k: entry for key, (k, entry) in new.items() if key not in old}
    inside: dict[str, KeyedDifference] = {}
    for key, (k, entry) in old.items():
        if key in new and entry is not new[key][1] and entry != new[key][1]:
            part = _part(entry, new[key][1])
            if part is None:
                return None
            inside[k] = part
    return KeyedDifference(removed=removed, changed=changed, inside=inside)


def _key(entry: msgspec.Struct) -> object:
    """Return the key of an entry of a list: its id, or all of it."""
    return getattr(entry, "id", None) or msgspec.json.encode(entry)
