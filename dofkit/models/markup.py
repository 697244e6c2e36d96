"""XML, read with the line of every element, and never more of it than a model needs: no entities, bounded."""

from __future__ import annotations

import re
import xml.sax
from collections.abc import Iterator
from dataclasses import dataclass, field
from xml.sax.handler import ContentHandler
from xml.sax.xmlreader import AttributesImpl, Locator

import defusedxml.sax
from defusedxml.common import DefusedXmlException
from typing_extensions import override

from dofkit.base.errors import Fault, SceneError

#: A longer file is refused; so is one of more elements, or nested deeper.
MOST_BYTES, MOST_ELEMENTS, DEEPEST = 64_000_000, 500_000, 200


@dataclass
class Element:
    """An element: its tag without a prefix (but that of a macro), attributes, line, and what is below it."""

    tag: str
    attributes: dict[str, str]
    line: int
    below: list[Element] = field(default_factory=list)

    def get(self, key: str, otherwise: str = "") -> str:
        """An attribute."""
        return self.attributes.get(key, otherwise)

    def all(self, tag: str) -> Iterator[Element]:
        """The elements right below it of that tag."""
        return (part for part in self.below if part.tag == tag)

    def first(self, tag: str) -> Element | None:
        """The first element right below it of that tag."""
        return next(self.all(tag), None)

    def every(self) -> Iterator[Element]:
        """It and all below it."""
        left = [self]
        while left:
            part = left.pop()
            yield part
            left += reversed(part.below)


class _MarkupReader(ContentHandler):
    """Collects elements with their lines."""

    def __init__(self) -> None:
        super().__init__()
        self.root: Element | None = None
        self._open: list[Element] = []
        self._count = 0
        self._where: Locator | None = None

    @override
    def setDocumentLocator(self, locator: Locator) -> None:
        self._where = locator

    @override
    def startElement(self, name: str, attrs: AttributesImpl) -> None:
        line = (self._where.getLineNumber() if self._where is not None else None) or 1
        self._count += 1
        if self._count > MOST_ELEMENTS or len(self._open) >= DEEPEST:
            what = (
                f"more than {MOST_ELEMENTS} elements"
                if self._count > MOST_ELEMENTS
                else f"nested deeper than {DEEPEST}"
            )
            raise SceneError((Fault(f"the model is {what}", line=line, column=1, hint="split the model"),))
        found = Element(
            name if name.startswith("xacro:") else name.rpartition(":")[2],
            {key: attrs.getValue(key) for key in attrs.getNames()},
            line,
        )
        if self._open:
            self._open[-1].below.append(found)
        elif self.root is None:
            self.root = found
        self._open.append(found)

    @override
    def endElement(self, name: str) -> None:
        self._open.pop()


def read_markup(data: bytes | str, name: str) -> Element:
    """The root element of an XML file. Raises SceneError in its line for what is no XML, or more than is read."""
    raw = data.encode() if isinstance(data, str) else data
    if len(raw) > MOST_BYTES:
        fault = Fault(f"the file is longer than {MOST_BYTES // 10**6} MB", line=1, column=1, hint="split the model")
        raise SceneError((fault,), name)
    reader = _MarkupReader()
    try:
        defusedxml.sax.parseString(raw, reader)
    except DefusedXmlException:
        hint = "write out the text that the entity stands for"
        fault = Fault(
            "entities are not read, because they can expand without bound", line=_entity(raw), column=1, hint=hint
        )
        raise SceneError((fault,), name) from None
    except xml.sax.SAXParseException as error:
        told = (error.getMessage() or "it cannot be read").rstrip(".")
        line, column = error.getLineNumber() or 1, (error.getColumnNumber() or 0) + 1
        raise SceneError(
            (Fault(f"this is not well-formed XML: {told}", line=line, column=column, hint="correct the XML"),), name
        ) from None
    if reader.root is None:
        raise SceneError((Fault("the file is empty", line=1, column=1, hint="write a model"),), name)
    return reader.root


def _entity(raw: bytes) -> int:
    """The line of the first entity that is declared."""
    found = re.search(rb"<!ENTITY|<!DOCTYPE", raw)
    return 1 + raw.count(b"\n", 0, found.start() if found else 0)
