"""Plain values, and the place of each, from the events of a YAML parser (libyaml, by PyYAML)."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any, TypeAlias

import yaml
from yaml.events import (
    AliasEvent,
    CollectionEndEvent,
    CollectionStartEvent,
    DocumentStartEvent,
    MappingStartEvent,
    ScalarEvent,
)

from dofkit.base.documents.scalars import BadScalarError, joined, plain
from dofkit.base.documents.syntax_faults import fault_of
from dofkit.base.errors import Fault

Path: TypeAlias = tuple[str | int, ...]
#: Where a value begins, and its key (-1: it has none): offsets into the text.
Places: TypeAlias = dict[Path, tuple[int, int]]

#: Deeper nesting is refused.
DEEPEST = 50

#: PyYAML's own parser, a hundred times slower than libyaml, reads no longer text.
MOST_SLOW = 1_000_000
SURROGATE = re.compile(r"\\u[dD][89a-fA-F]")
#: Aliases may add this many values in all.
MOST_ALIASED = 200_000
_CORE = "tag:yaml.org,2002:"
_TAGS = frozenset(_CORE + name for name in ("str", "int", "float", "bool", "null", "map", "seq")) | {"!"}


class UnreadableError(Exception):
    """Reading cannot go on."""


@dataclass
class _Open:
    """A collection that is being filled."""

    value: Any
    path: Path
    anchor: str | None
    size: int = 1
    key: str | None = None
    key_at: int = -1
    skipping: bool = False
    muted: bool = False
    merged: list[tuple[int, Any]] = field(default_factory=list)


def compose(text: str) -> Composer:
    """Return the composed document, with libyaml's parser where PyYAML has it.

    PyYAML's own parser explains an error better and joins the halves of a character that JSON escapes as two, so a text
    with either is read by it unless it is longer than `MOST_SLOW`.
    """
    if not (SURROGATE.search(text) and len(text) <= MOST_SLOW):
        composer = Composer()
        try:
            composer.read(text, getattr(yaml, "CSafeLoader", yaml.SafeLoader))
        except yaml.YAMLError as error:
            composer.faults.append(fault_of(error))
            if len(text) > MOST_SLOW:
                return composer
        else:
            return composer
    composer = Composer()
    try:
        composer.read(text, yaml.SafeLoader)
    except yaml.YAMLError as error:
        composer.faults.append(fault_of(error))
    return composer


class Composer:
    """Composes the one document of a YAML text."""

    def __init__(self) -> None:
        self.value: Any = None
        self.documents = 0
        self.places: Places = {}
        self.faults: list[tuple[int, Fault]] = []
        self._open: list[_Open] = []
        self._anchors: dict[str, tuple[Any, int]] = {}
        self._aliased = 0

    def read(self, text: str, loader: Any) -> Any:
        """Return the value of ``text``; what is wrong with it goes to ``faults``.

        Raises
        ------
        yaml.YAMLError
            The text is not YAML.
        """
        try:
            for event in yaml.parse(text, Loader=loader):
                self._take(event)
        except UnreadableError:
            pass
        return self.value

    def _fault(self, event: Any, message: str, hint: str) -> None:
        self.faults.append((self._at(event), Fault(message, hint=hint)))

    def _at(self, event: Any) -> int:
        return int(event.start_mark.index)

    def _take(self, event: Any) -> None:
        if isinstance(event, ScalarEvent):
            self._scalar(event)
        elif isinstance(event, CollectionStartEvent):
            self._begin(event)
        elif isinstance(event, CollectionEndEvent):
            self._end(event)
        elif isinstance(event, AliasEvent):
            self._alias(event)
        elif isinstance(event, DocumentStartEvent):
            self.documents += 1
            if self.documents > 1:
                self._fault(event, "a second document begins here", "a file contains one document: delete the '---'")
                raise UnreadableError

    def _begin(self, event: CollectionStartEvent) -> None:
        self._tag(event)
        path = self._path(event)
        if path is None:
            self._fault(event, "a key must be a text", "write 'key: value'")
            raise UnreadableError
        if len(self._open) >= DEEPEST:
            self._fault(event, "brackets or lists are nested too deep", f"at most {DEEPEST} levels are read")
            raise UnreadableError
        value: Any = {} if isinstance(event, MappingStartEvent) else []
        muted = bool(self._open) and (self._open[-1].skipping or self._open[-1].muted)
        self._open.append(_Open(value, path, event.anchor, muted=muted))

    def _end(self, event: Any) -> None:
        done = self._open.pop()
        for at, other in done.merged:
            self._merge(done, at, other)
        if done.anchor:
            self._anchors[done.anchor] = (done.value, done.size)
        self._add(done.value, done.size)

    def _merge(self, done: _Open, at: int, other: Any) -> None:
        for part in other if isinstance(other, list) else [other]:
            if not isinstance(part, dict):
                self.faults.append((at, Fault("only a mapping can be merged with <<", hint="write << : *name")))
                return
            for key, value in part.items():
                done.value.setdefault(key, value)

    def _alias(self, event: AliasEvent) -> None:
        name = event.anchor
        if name not in self._anchors:
            opened = any(part.anchor == name for part in self._open)
            message = f"'*{name}' occurs inside the value that it names" if opened else f"nothing is named '&{name}'"
            self._fault(event, message, "put a text that begins with '*' in double quotes")
            raise UnreadableError
        value, size = self._anchors[name]
        self._aliased += size
        if self._aliased > MOST_ALIASED:
            self._fault(event, f"the aliases expand to more than {MOST_ALIASED} values", "write the values out")
            raise UnreadableError
        if self._path(event) is None:
            self._take_key(event, value if isinstance(value, str) else None)
        else:
            self._add(value, size)

    def _scalar(self, event: ScalarEvent) -> None:
        self._tag(event)
        text = joined(event.value)
        if text is None:
            self._fault(event, "an escape denotes half a character", "write the character itself")
            text = ""
        if self._path(event) is None:
            self._take_key(event, text)
            return
        value = self._resolved(event, text)
        if event.anchor:
            self._anchors[event.anchor] = (value, 1)
        self._add(value, 1)

    def _resolved(self, event: ScalarEvent, text: str) -> Any:
        if not event.implicit[0] or (event.tag or "") == _CORE + "str":
            return text
        try:
            return plain(text)
        except BadScalarError as error:
            self._fault(event, error.message, error.hint)
            return 1

    def _path(self, event: Any) -> Path | None:
        """The path of the value that begins with ``event``, its place noted; None where a key must stand."""
        if not self._open:
            self.places[()] = (self._at(event), -1)
            return ()
        top = self._open[-1]
        if isinstance(top.value, list):
            path: Path = (*top.path, len(top.value))
        elif top.key is None:
            return None
        else:
            path = (*top.path, top.key)
        if not (top.skipping or top.muted):
            self.places[path] = (self._at(event), top.key_at)
        return path

    def _take_key(self, event: Any, key: str | None) -> None:
        if key is None:
            self._fault(event, "a key must be a text", "write 'key: value'")
            raise UnreadableError
        top = self._open[-1]
        top.key, top.key_at = key, self._at(event)
        top.skipping = key in top.value
        if top.skipping:
            self.faults.append((top.key_at, twice(key)))

    def _add(self, value: Any, size: int) -> None:
        if not self._open:
            self.value = value
            return
        top = self._open[-1]
        top.size += size
        if isinstance(top.value, list):
            top.value.append(value)
            return
        if top.key == "<<":
            top.merged.append((top.key_at, value))
        elif not top.skipping and top.key is not None:
            top.value[top.key] = value
        top.key, top.skipping = None, False

    def _tag(self, event: Any) -> None:
        if event.tag is None or event.tag in _TAGS:
            return
        shown = event.tag.removeprefix(_CORE)[:60]
        hint = "delete the tag; put a text that begins with '!' in double quotes"
        self._fault(event, f"the tag '{shown}' is not read", hint)


def twice(key: str) -> Fault:
    """Return the fault of a key that is written again in the same mapping."""
    return Fault(f"the key '{key[:60]}' is written twice", hint="keep one of the two")
