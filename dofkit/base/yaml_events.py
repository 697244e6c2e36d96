"""Plain exact values with their locations, from the events of PyYAML's parser; scalars are those of YAML 1.2."""

from __future__ import annotations

import re
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from importlib.resources import files
from typing import Any, NamedTuple, NoReturn, TypeAlias

import yaml
from yaml.events import (
    AliasEvent,
    CollectionEndEvent,
    CollectionStartEvent,
    DocumentStartEvent,
    MappingStartEvent,
    ScalarEvent,
)
from yaml.reader import ReaderError

from dofkit.base.errors import Fault, TextError

Path: TypeAlias = tuple[str | int, ...]
#: {path: (offset of the value, offset of its key or -1)}, offsets into the text.
Places: TypeAlias = dict[Path, tuple[int, int]]
Scalar: TypeAlias = bool | int | Decimal | str | None

#: Deeper nesting is refused.
DEEPEST = 50
#: The longest text for PyYAML's own parser, which is a hundred times slower than libyaml.
MOST_SLOW = 1_000_000
#: Aliases may add this many values in all.
MOST_ALIASED = 200_000
#: A number is refused beyond this power of ten, up or down, and beyond this many characters.
LARGEST_EXPONENT = 1000
LONGEST_NUMBER = 400
SURROGATE = re.compile(r"\\u[dD][89a-fA-F]")
_CORE = "tag:yaml.org,2002:"
_TAGS = frozenset(_CORE + name for name in ("str", "int", "float", "bool", "null", "map", "seq")) | {"!"}
_WORDS: dict[str, Scalar] = {
    "": None, "~": None, "null": None, "Null": None, "NULL": None,
    "true": True, "True": True, "TRUE": True, "false": False, "False": False, "FALSE": False,
}  # fmt: skip
_NUMBER = re.compile(r"[-+]?(?:(?P<int>[0-9]+)|(?:\.[0-9]+|[0-9]+\.?[0-9]*)(?:[eE](?P<exp>[-+]?[0-9]+))?)", re.ASCII)
_OTHER_BASE = re.compile(r"0o(?P<octal>[0-7]+)|0x(?P<hex>[0-9a-fA-F]+)", re.ASCII)
_NOT_FINITE = re.compile(r"[-+]?(?:\.inf|\.Inf|\.INF|Infinity)|\.nan|\.NaN|\.NAN|NaN")
_NUMERIC_START = frozenset("0123456789+-.IN")


class UnreadableError(Exception):
    """Raised after a fault that ends the reading of a document."""


def plain(text: str) -> Scalar:
    """Return the value of an unquoted scalar by the core schema of YAML 1.2; a decimal is never a float.

    >>> plain("1e-6"), plain("017"), plain("0o17"), plain("on"), plain("~"), plain("1_000")
    (Decimal('0.000001'), 17, 15, 'on', None, '1_000')
    """
    if text in _WORDS:
        return _WORDS[text]
    if text[0] not in _NUMERIC_START:
        return text
    if _NOT_FINITE.fullmatch(text):
        raise TextError(f"a finite number is needed, not {text}", hint="if it is meant as a name, put it in quotes")
    match, other = _NUMBER.fullmatch(text), _OTHER_BASE.fullmatch(text)
    if match is None and other is None:
        return text
    short = text if len(text) <= 24 else text[:20] + "..."
    if len(text) > LONGEST_NUMBER:
        message = f"the number {short} has {len(text)} characters"
        raise TextError(message, hint=f"write a number in at most {LONGEST_NUMBER} characters")
    if match is None:
        return int(text, 0)
    if match["int"]:
        return int(text)
    if abs(int(match["exp"] or "0")) <= LARGEST_EXPONENT:
        value = Decimal(text)
        if not value or abs(value.adjusted()) <= LARGEST_EXPONENT:
            return value
    raise TextError(f"the number {short} is too large or too small", hint=f"stay within 1e±{LARGEST_EXPONENT}")


def _whole_characters(text: str) -> str | None:
    """Return a text with surrogate pairs (JSON's escapes) joined to characters; None for a lone surrogate."""
    if text.isascii() or not any("\ud800" <= char <= "\udfff" for char in text):
        return text
    try:
        return text.encode("utf-16", "surrogatepass").decode("utf-16")
    except UnicodeDecodeError:
        return None


@dataclass
class _Collection:
    """A list or mapping that is being read; a repeated key's value (``skipping``, inside ``muted``) is not located."""

    value: Any
    path: Path
    anchor: str | None
    size: int = 1
    key: str | None = None
    key_at: int = -1
    skipping: bool = False
    muted: bool = False


class ComposedText:
    """The value of a YAML text, the location of everything in it, and its faults with their offsets."""

    def __init__(self, text: str, loader: Any) -> None:
        self.value: Any = None
        self._text = text
        self.places: Places = {}
        self.faults: list[tuple[int, Fault]] = []
        self._documents = 0
        self._stack: list[_Collection] = []
        self._anchors: dict[str, tuple[Any, int]] = {}
        self._aliased = 0
        self.is_yaml = True
        try:
            for event in yaml.parse(text, Loader=loader):
                self._take(event)
        except UnreadableError:
            pass
        except yaml.YAMLError as error:
            self.faults.append(syntax_fault(error))
            self.is_yaml = False

    def _fault(self, event: Any, message: str, hint: str | None) -> None:
        self.faults.append((event.start_mark.index, Fault(message, hint=hint)))

    def _give_up(self, event: Any, message: str, hint: str) -> NoReturn:
        self._fault(event, message, hint)
        raise UnreadableError

    def _take(self, event: Any) -> None:
        """Process one event of PyYAML's parser."""
        if isinstance(event, ScalarEvent):
            self._scalar(event)
        elif isinstance(event, CollectionStartEvent):
            self._begin(event)
        elif isinstance(event, CollectionEndEvent):
            self._end()
        elif isinstance(event, AliasEvent):
            self._alias(event)
        elif isinstance(event, DocumentStartEvent):
            self._documents += 1
            if self._documents > 1:
                self._give_up(event, "a second document begins here", "a file contains one document: delete the '---'")

    def _begin(self, event: CollectionStartEvent) -> None:
        self._check_tag(event)
        path = self._path(event)
        if path is None:
            self._give_up(event, "a key must be a text", "write 'key: value'")
        if len(self._stack) >= DEEPEST:
            self._give_up(event, "brackets or lists are nested too deep", f"at most {DEEPEST} levels are read")
        value: Any = {} if isinstance(event, MappingStartEvent) else []
        muted = bool(self._stack) and (self._stack[-1].skipping or self._stack[-1].muted)
        self._stack.append(_Collection(value, path, event.anchor, muted=muted))

    def _end(self) -> None:
        done = self._stack.pop()
        if done.anchor:
            self._anchors[done.anchor] = (done.value, done.size)
        self._add(done.value, done.size)

    def _alias(self, event: AliasEvent) -> None:
        """Add the value that an alias names, or take it as a key."""
        name = str(event.anchor)
        if name not in self._anchors:
            inside = any(part.anchor == name for part in self._stack)
            message = f"'*{name}' occurs inside the value that it names" if inside else f"nothing is named '&{name}'"
            self._give_up(event, message, "put a text that begins with '*' in double quotes")
        value, size = self._anchors[name]
        self._aliased += size
        if self._aliased > MOST_ALIASED:
            self._give_up(event, f"the aliases expand to more than {MOST_ALIASED} values", "write the values out")
        if self._path(event) is None:
            self._take_key(event, value if isinstance(value, str) else None)
        else:
            self._add(value, size)

    def _scalar(self, event: Any) -> None:
        """Add the value of a scalar, or take its text as a key; an invalid number is recorded as a fault."""
        self._check_tag(event)
        text = _whole_characters(event.value)
        if text is None:
            self._fault(event, "an escape denotes half a character", "write the character itself")
            text = ""
        if self._path(event) is None:
            self._take_key(event, text)
            return
        value: Scalar = text
        if event.implicit[0] and (event.tag or "") != _CORE + "str":
            try:
                value = plain(text)
                start, end = event.start_mark, event.end_mark
                entry = start.line < end.line and self._text.startswith("- ", start.index - 2)
                hyphen = rf"[\r\n] {{0,{start.column - 1}}}- |[=<>][^=<>\r\n]*[\r\n]+ *- [^=<>\r\n]*[=<>]"
                if entry and re.search(hyphen, self._text[start.index : end.index]):
                    hint = "write it below the '- ' of the entry before, or put the whole text in double quotes"
                    raise TextError("this text continues in a line that begins with a hyphen", hint=hint)
            except TextError as error:
                self._fault(event, error.message, error.hint)
                value = 1
        if event.anchor:
            self._anchors[event.anchor] = (value, 1)
        self._add(value, 1)

    def _path(self, event: Any) -> Path | None:
        """Return the path of the value that begins with ``event``, and note its location; None for a key."""
        if not self._stack:
            self.places[()] = (event.start_mark.index, -1)
            return ()
        top = self._stack[-1]
        if isinstance(top.value, list):
            path: Path = (*top.path, len(top.value))
        elif top.key is None:
            return None
        else:
            path = (*top.path, top.key)
        if not (top.skipping or top.muted):
            self.places[path] = (event.start_mark.index, top.key_at)
        return path

    def _take_key(self, event: Any, key: str | None) -> None:
        if key is None:
            self._give_up(event, "a key must be a text", "write 'key: value'")
        top = self._stack[-1]
        top.key, top.key_at = key, event.start_mark.index
        if re.fullmatch(r",\d", self._text[max(0, top.key_at - 1) : top.key_at + 1]):
            self._fault(event, f"the comma before '{key}' begins another entry", "write decimals with a point")
        if key == "<<":
            self._fault(event, "the merge key '<<' is not read", "write the keys out")
        top.skipping = key in top.value
        if top.skipping:
            self._fault(event, f"the key '{key[:60]}' is written twice", "keep one of the two")

    def _add(self, value: Any, size: int) -> None:
        """Add a complete value to the innermost collection, or make it the document."""
        if not self._stack:
            self.value = value
            return
        top = self._stack[-1]
        top.size += size
        if isinstance(top.value, list):
            top.value.append(value)
            return
        if not top.skipping and top.key is not None:
            top.value[top.key] = value
        top.key, top.skipping = None, False

    def _check_tag(self, event: Any) -> None:
        if event.tag is not None and event.tag not in _TAGS:
            hint = "delete the tag; put a text that begins with '!' in double quotes"
            self._fault(event, f"the tag '{event.tag.removeprefix(_CORE)[:60]}' is not read", hint)


def compose(text: str) -> ComposedText:
    """Return the composed text, read by libyaml if PyYAML has it.

    PyYAML's own parser has better error messages and joins surrogate pairs, so a text with an error or a surrogate is
    read by this parser unless it is longer than `MOST_SLOW`.
    """
    short = len(text) <= MOST_SLOW
    if not (short and SURROGATE.search(text)):
        composed = ComposedText(text, getattr(yaml, "CSafeLoader", yaml.SafeLoader))
        if composed.is_yaml or not short:
            return composed
    return ComposedText(text, yaml.SafeLoader)


class _SyntaxError(NamedTuple):
    """A row of `syntax_faults.yaml`: a pattern of PyYAML's message, and dofkit's message and hint."""

    pattern: str
    message: str
    hint: str
    at_context: bool = False


@cache
def _syntax_errors() -> list[_SyntaxError]:
    rows = yaml.safe_load(files(__package__).joinpath("syntax_faults.yaml").read_bytes())
    return [_SyntaxError(**row) for row in rows]


_NAMES = {"<stream end>": "the end of the file", "?": "the next key", ":": "':'", "<scalar>": "a text"}


def syntax_fault(error: yaml.YAMLError) -> tuple[int, Fault]:
    """Return (offset, fault) of a syntax error."""
    if isinstance(error, ReaderError):
        return error.position, Fault("a character that YAML does not allow", hint="delete it")
    if not isinstance(error, yaml.MarkedYAMLError):
        return 0, Fault(_syntax_errors()[-1].message, hint=_syntax_errors()[-1].hint)
    words = f"{error.problem} {error.context or ''}"
    row, match = next((row, match) for row in _syntax_errors() if (match := re.search(row.pattern, words)))
    named = {
        name: _NAMES.get(part or "", f"'{part}'" if name == "got" else part) for name, part in match.groupdict().items()
    }
    named["line"] = str(error.context_mark.line + 1) if error.context_mark else "?"
    message = row.message.format(**named) + ("" if row.pattern else f": {error.problem}")
    mark = (error.context_mark if row.at_context else None) or error.problem_mark or error.context_mark
    return mark.index if mark else 0, Fault(message, hint=row.hint.format())
