"""XML, read with the line of every element, within limits and without entities."""

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

#: The most bytes, elements and levels of nesting of a file; larger files are refused.
MOST_BYTES, MOST_ELEMENTS, DEEPEST = 64_000_000, 500_000, 200


@dataclass
class Element:
    """An XML element: tag without a prefix (except of a macro), attributes, line, and child elements (``below``)."""

    tag: str
    attributes: dict[str, str]
    line: int
    below: list[Element] = field(default_factory=list)

    def get(self, key: str, otherwise: str = "") -> str:
        """Return an attribute, ``otherwise`` if it is missing."""
        return self.attributes.get(key, otherwise)

    def all(self, tag: str) -> Iterator[Element]:
        """Yield the child elements with this tag."""
        return (part for part in self.below if part.tag == tag)

    def first(self, tag: str) -> Element | None:
        """Return the first child element with this tag, or None."""
        return next(self.all(tag), None)

    def every(self) -> Iterator[Element]:
        """Yield this element and all its descendants, in the order of the file."""
        stack = [self]
        while stack:
            part = stack.pop()
            yield part
            stack += reversed(part.below)


class _MarkupReader(ContentHandler):
    """Collects elements with their lines below ``document``, whose only child is the root."""

    def __init__(self) -> None:
        super().__init__()
        self.document = Element("", {}, 1)
        self._open = [self.document]
        self._count = 0
        self._locator: Locator | None = None

    @override
    def setDocumentLocator(self, locator: Locator) -> None:
        self._locator = locator

    @override
    def startElement(self, name: str, attrs: AttributesImpl) -> None:
        line = (self._locator.getLineNumber() if self._locator is not None else None) or 1
        self._count += 1
        if self._count > MOST_ELEMENTS or len(self._open) > DEEPEST:
            many = self._count > MOST_ELEMENTS
            what = f"has more than {MOST_ELEMENTS} elements" if many else f"is nested deeper than {DEEPEST}"
            raise SceneError((Fault(f"the model {what}", line=line, column=1, hint="split the model"),))
        tag = name if name.startswith("xacro:") else name.rpartition(":")[2]
        self._open[-1].below.append(Element(tag, {key: attrs.getValue(key) for key in attrs.getNames()}, line))
        self._open.append(self._open[-1].below[-1])

    @override
    def endElement(self, name: str) -> None:
        self._open.pop()


def read_markup(data: bytes | str, name: str) -> Element:
    """Return the root element of an XML file.

    Raises SceneError with the line for malformed XML, entities, or a file beyond the limits.
    """
    raw = data.encode() if isinstance(data, str) else data
    line, column = 1, 1
    reader = _MarkupReader()
    try:
        if len(raw) <= MOST_BYTES:
            defusedxml.sax.parseString(raw, reader)
            if reader.document.below:
                return reader.document.below[0]
            message, hint = "the file is empty", "write a model"
        else:
            message, hint = f"the file is longer than {MOST_BYTES // 10**6} MB", "split the model"
    except DefusedXmlException:
        entity = re.search(rb"<!ENTITY|<!DOCTYPE", raw)
        line += raw.count(b"\n", 0, entity.start() if entity else 0)
        message = "entities are not read, because they can expand without bound"
        hint = "write out the text that the entity stands for"
    except xml.sax.SAXParseException as error:
        line, column = error.getLineNumber() or 1, (error.getColumnNumber() or 0) + 1
        message = f"this is not well-formed XML: {(error.getMessage() or 'it cannot be read').rstrip('.')}"
        hint = "correct the XML"
    raise SceneError((Fault(message, line=line, column=column, hint=hint),), name)
