"""Errors of YAML's syntax, told for the person who wrote the file."""

from __future__ import annotations

import re
from typing import NamedTuple

from yaml import MarkedYAMLError, YAMLError
from yaml.reader import ReaderError

from dofkit.base.errors import Fault

_QUOTE = "put the text in double quotes"


class _Told(NamedTuple):
    pattern: str
    message: str
    hint: str
    at_context: bool = False


_TOLD = (
    _Told(r"found character '\\t'", "there is a tab where YAML allows none", "use spaces to indent and to separate"),
    _Told(r"expected (?:chomping or )?indentation indicator", "in YAML '|' and '>' begin a block of lines",
          "put a text that begins with one in quotes: `- \"|x - y| = 3\"`", True),
    _Told(r"found character '(?P<char>.)'", "a plain text cannot begin with {char}", _QUOTE),
    _Told(r"mapping values are not allowed", "there is a ':' where no key can be",
          "check the indentation; put a text that contains ': ' in double quotes"),
    _Told(r"sequence entries are not allowed", "there is a list entry '- ' where none can be",
          "put the list on the lines below its key"),
    _Told(r"found unexpected end of stream", "a quoted text is never closed", "close the quotes", True),
    _Told(r"expected ',' or '(?P<char>.)', but got '(?P<got>.*)'",
          "line {line}'s bracket needs a ',' or '{char}' before {got}",
          "close the bracket, or put in quotes a text that contains one of , : [ ] {{ }}"),
    _Told(r"expected the node content, but found '(?P<got>.*)'", "a value is needed before {got}",
          "write the value, or delete the extra comma"),
    _Told(r"expected <block end>, but found '(?:\?|<block mapping start>|<scalar>)'",
          "this line does not align with the lines before it", "align it with the entries that it belongs to"),
    _Told(r"expected <block end>, but found '-'", "this list entry does not align with the lines before it",
          "align the '-' with those of its list"),
    _Told(r"expected <block end>, but found '(?P<got>[\]},])'", "one {got} too many", "delete it"),
    _Told(r"expected <block end>", "there is text after a complete value", _QUOTE),
    _Told(r"could not find expected ':'", "a ':' is missing after a key", "write 'key: value'"),
    _Told(r"found unknown escape character '(?P<char>.*)'", "'\\{char}' means nothing in a double-quoted text",
          "write two backslashes, or use single quotes"),
    _Told(r"expected escape sequence", "an escape in a double-quoted text is not complete",
          "write two backslashes, or use single quotes"),
    _Told(r"while scanning (?:an alias|an anchor)", "in YAML a text cannot begin with '*' or '&'", _QUOTE),
    _Told(r"YAML document \(version", "this version of YAML is not read", "delete the %YAML line"),
    _Told(r"undefined tag handle|scanning a tag|parsing a tag", "custom tags are not read",
          "delete the tag; put a text that begins with '!' in double quotes"),
    _Told(r"expected '<document start>'", "there is text after the end of the scene", "a file contains one scene"),
)  # fmt: skip

_NAMES = {"<stream end>": "the end of the file", "?": "the next key", ":": "':'", "<scalar>": "a text"}


def fault_of(error: YAMLError) -> tuple[int, Fault]:
    """The offset and the fault of a syntax error."""
    if isinstance(error, ReaderError):
        return error.position, Fault("a character that YAML does not allow", hint="delete it")
    if not isinstance(error, MarkedYAMLError):
        return 0, Fault("this cannot be read as YAML", hint="check quotes, brackets and indentation")
    said = f"{error.problem} {error.context or ''}"
    row = next((row for row in _TOLD if re.search(row.pattern, said)), None)
    mark = error.problem_mark or error.context_mark
    if row is None:
        fault = Fault(f"this cannot be read as YAML: {error.problem}", hint="check quotes, brackets and indentation")
    else:
        match = re.search(row.pattern, said)
        groups = match.groupdict() if match else {}
        named = {name: _NAMES.get(part or "", f"'{part}'" if name == "got" else part) for name, part in groups.items()}
        named["line"] = str(error.context_mark.line + 1) if error.context_mark else "?"
        fault = Fault(row.message.format(**named), hint=row.hint.format())
        mark = (error.context_mark if row.at_context else None) or mark
    return mark.index if mark else 0, fault
