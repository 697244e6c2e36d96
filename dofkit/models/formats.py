"""The formats of models that are read, told by how a file begins."""

from __future__ import annotations

import re
from importlib import import_module
from importlib.util import find_spec
from typing import NamedTuple

from dofkit.base.errors import Fault, SceneError
from dofkit.models.model_document import ModelDocument, ModelFile


class ModelFormat(NamedTuple):
    """A format: the tag that its files begin with, the module whose `read` takes them, and what that ``needs``."""

    title: str
    tag: str
    module: str
    needs: tuple[str, ...] = ()


#: The letters before a SolveSpace sketch stand for its tag.
_SKETCH = b"\xb1\xb2\xb3SolveSpaceREVa"
FORMATS = (
    ModelFormat("MJCF", "mujoco", "dofkit.models.mjcf", ("defusedxml", "mujoco")),
    ModelFormat("URDF", "robot", "dofkit.models.urdf", ("defusedxml",)),
    ModelFormat("SolveSpace", "SolveSpace", "dofkit.models.solvespace"),
)
#: Roots of what is only a part of a model.
_PARTS = ("mujocoinclude", "config")
_TAG = re.compile(rb"<([A-Za-z][\w:.-]*)")
#: What may stand before the first tag: how it begins and ends.
_BEFORE = ((b"<?", b"?>"), (b"<!--", b"-->"), (b"<!", b">"))
#: A beginning is looked for in so many bytes.
LOOKED_AT = 200_000


def is_model(data: bytes | str) -> bool:
    """Does a file begin as no scene does: with a tag, or with SolveSpace's letters?"""
    start = _beginning(data)
    return start.startswith((b"<?xml", b"<!", _SKETCH)) or _TAG.match(start) is not None


def is_known_model(data: bytes | str) -> bool:
    """Does a file begin as one of the `FORMATS`?"""
    return is_model(data) and _first_tag(_beginning(data)) in {one.tag for one in FORMATS}


def format_of(data: bytes | str) -> ModelFormat | None:
    """The format of a file by its beginning; None for a scene. Raises SceneError for XML that is no model."""
    if not is_model(data):
        return None
    tag = _first_tag(_beginning(data))
    found = next((one for one in FORMATS if one.tag == tag), None)
    if found is None and tag:
        message = f"an XML file that begins with <{tag}> is not a model that dofkit reads"
        hint = "models begin with <mujoco> (MJCF) or <robot> (URDF)"
        if tag in _PARTS:
            hint = "this is a part of a model: give the file that includes it"
        raise SceneError((Fault(message, line=1, column=1, hint=hint),))
    return found


def read_model(file: ModelFile) -> ModelDocument:
    """The scene of a model's file. Raises SceneError with what is at fault, each in its line."""
    found = format_of(file.data)
    if found is None:
        titles = ", ".join(one.title for one in FORMATS)
        raise SceneError((Fault("this is not a model", hint=f"the formats that are read: {titles}"),), file.name)
    missing = [name for name in found.needs if find_spec(name) is None]
    if missing:
        message = f"{found.title} is read with {' and '.join(missing)}, which is not installed"
        raise SceneError((Fault(message, hint="install it: pip install 'dofkit[models]'"),), file.name)
    document: ModelDocument = import_module(found.module).read(file)
    return document


def _beginning(data: bytes | str) -> bytes:
    start = data[:LOOKED_AT]
    raw = start.encode("utf-8", "replace") if isinstance(start, str) else start
    return raw.removeprefix(b"\xef\xbb\xbf").lstrip()


def _first_tag(start: bytes) -> str:
    """The first tag after declarations and comments; empty where none is found."""
    if start.startswith(_SKETCH):
        return "SolveSpace"
    at = 0
    while True:
        at += len(start[at:]) - len(start[at:].lstrip())
        pair = next((pair for pair in _BEFORE if start.startswith(pair[0], at)), None)
        if pair is None:
            match = _TAG.match(start, at)
            return "" if match is None else match[1].decode("ascii", "replace")
        end = start.find(pair[1], at)
        if pair[0] == b"<!" and 0 <= start.find(b"[", at) < end:
            end = start.find(b">", start.find(b"]", at))
        if end < 0:
            return ""
        at = end + len(pair[1])
