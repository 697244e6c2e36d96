"""The formats of models that are read, told by how a file begins."""

from __future__ import annotations

import re
from importlib import import_module
from typing import NamedTuple

from dofkit.base.errors import Fault, SceneError
from dofkit.models.model_document import ModelDocument, ModelFile


class ModelFormat(NamedTuple):
    """A format: how its files begin, and the module whose `read` takes them."""

    title: str
    beginning: re.Pattern[bytes]
    module: str


_BEFORE = rb"(?:\xef\xbb\xbf)?(?:\s|<\?.*?\?>|<!--.*?-->|<!DOCTYPE[^>\[]*(?:\[.*?\]\s*)?>)*"
FORMATS = (
    ModelFormat("MJCF", re.compile(_BEFORE + rb"<mujoco\b", re.DOTALL), "dofkit.models.mjcf"),
    ModelFormat("URDF", re.compile(_BEFORE + rb"<robot\b", re.DOTALL), "dofkit.models.urdf"),
    ModelFormat("SolveSpace", re.compile(rb"\xb1\xb2\xb3SolveSpaceREVa"), "dofkit.models.solvespace"),
)
_BEGINS = re.compile(rb"(?:\xef\xbb\xbf)?\s*<[?!A-Za-z]|\xb1\xb2\xb3SolveSpace")
#: What else begins like XML.
_MARKUP = re.compile(_BEFORE + rb"<([A-Za-z][\w:.-]*)", re.DOTALL)
#: A beginning is looked for in so many bytes.
LOOKED_AT = 200_000


def is_model(data: bytes | str) -> bool:
    """Does a file begin as no scene does: with a tag, or with SolveSpace's letters?"""
    start = data[:LOOKED_AT].encode("utf-8", "replace") if isinstance(data, str) else data[:LOOKED_AT]
    return _BEGINS.match(start) is not None


def format_of(data: bytes | str) -> ModelFormat | None:
    """The format of a file by its beginning; None for a scene. Raises SceneError for XML that is no model."""
    start = (data[:LOOKED_AT].encode("utf-8", "replace") if isinstance(data, str) else data[:LOOKED_AT]).lstrip()
    found = next((one for one in FORMATS if one.beginning.match(start)), None)
    markup = _MARKUP.match(start) if found is None else None
    if markup is not None:
        root = markup[1].decode("utf-8", "replace")
        message = f"an XML file that begins with <{root}> is no model that is read"
        hint = "models begin with <mujoco> (MJCF) or <robot> (URDF)"
        if root in ("mujocoinclude", "config"):
            hint = "this is a part of a model: name the file that includes it"
        raise SceneError((Fault(message, line=1, column=1, hint=hint),))
    return found


def read_model(file: ModelFile) -> ModelDocument:
    """The scene of a model's file. Raises SceneError with what is at fault, each in its line."""
    found = format_of(file.data)
    if found is None:
        raise SceneError((Fault("this is no model", hint=f"those that are read: {_titles()}"),), file.name)
    document: ModelDocument = import_module(found.module).read(file)
    return document


def _titles() -> str:
    return ", ".join(one.title for one in FORMATS)
