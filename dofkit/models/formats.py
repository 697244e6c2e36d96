"""The formats of models that are read, recognised by how a file begins."""

from __future__ import annotations

import re
from importlib import import_module
from importlib.util import find_spec
from typing import NamedTuple

from dofkit.base.errors import Fault, SceneError
from dofkit.models.model_document import ModelDocument, ModelFile


class ModelFormat(NamedTuple):
    """A format: the tag that its files begin with, the module whose `read` takes them, and the libraries it needs."""

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
#: Roots of files that are only a part of a model.
_PARTS = ("mujocoinclude", "config")
_TAG = re.compile(rb"<([A-Za-z][\w:.-]*)")
#: Declarations, comments and document types, before the first tag.
_PROLOGUE = re.compile(rb"(?:\s++|<\?.*?\?>|<!--.*?-->|<![A-Z][^>\[]*+(?:\[.*?\]\s*+)?>)*+", re.DOTALL)
#: The first tag is searched in so many bytes.
LOOKED_AT = 200_000


def is_model(data: bytes | str) -> bool:
    """Return whether a file begins as no scene does: with a tag, or with SolveSpace's letters."""
    start = _beginning(data)
    return start.startswith((b"<?xml", b"<!", _SKETCH)) or _TAG.match(start) is not None


def is_known_model(data: bytes | str) -> bool:
    """Return whether a file begins as one of the `FORMATS`."""
    return is_model(data) and _first_tag(data) in {form.tag for form in FORMATS}


def format_of(data: bytes | str) -> ModelFormat | None:
    """Return the format of a file; None for a scene. Raises SceneError for XML that is no model."""
    if not is_model(data):
        return None
    tag = _first_tag(data)
    form = next((form for form in FORMATS if form.tag == tag), None)
    if form is None and tag:
        message = f"an XML file that begins with <{tag}> is not a model that dofkit reads"
        hint = "models begin with <mujoco> (MJCF) or <robot> (URDF)"
        if tag in _PARTS:
            hint = "this is a part of a model: give the file that includes it"
        raise SceneError((Fault(message, line=1, column=1, hint=hint),))
    return form


def read_model(file: ModelFile) -> ModelDocument:
    """Return the scene of a model's file. Raises SceneError with all its faults, each in its line."""
    form = format_of(file.data)
    if form is None:
        titles = ", ".join(form.title for form in FORMATS)
        raise SceneError((Fault("this is not a model", hint=f"the formats that are read: {titles}"),), file.name)
    missing = [name for name in form.needs if find_spec(name) is None]
    if missing:
        message = f"{form.title} is read with {' and '.join(missing)}, which is not installed"
        raise SceneError((Fault(message, hint="install it: pip install 'dofkit[models]'"),), file.name)
    document: ModelDocument = import_module(form.module).read(file)
    return document


def _beginning(data: bytes | str) -> bytes:
    start = data[:LOOKED_AT]
    raw = start.encode("utf-8", "replace") if isinstance(start, str) else start
    return raw.removeprefix(b"\xef\xbb\xbf").lstrip()


def _first_tag(data: bytes | str) -> str:
    """Return the first tag after declarations and comments; an empty text where there is none."""
    start = _beginning(data)
    if start.startswith(_SKETCH):
        return "SolveSpace"
    prologue = _PROLOGUE.match(start)
    match = _TAG.match(start, prologue.end() if prologue else 0)
    return "" if match is None else match[1].decode("ascii", "replace")
