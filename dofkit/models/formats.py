"""The formats of models, recognised by the first tag or bytes of a file."""

from __future__ import annotations

import re
from importlib import import_module
from importlib.util import find_spec
from typing import NamedTuple

from dofkit.base.errors import Fault, SceneError
from dofkit.models.model_document import ModelDocument, ModelFile


class ModelFormat(NamedTuple):
    """A format: the first tag of its files, the module whose `read` reads them, and the libraries that are needed."""

    title: str
    tag: str
    module: str
    needs: tuple[str, ...] = ()


#: The first bytes of a SolveSpace file, which has no XML; `_first_tag` returns "SolveSpace" for it.
_SKETCH = b"\xb1\xb2\xb3SolveSpaceREVa"
FORMATS = (
    ModelFormat("MJCF", "mujoco", "dofkit.models.mjcf", ("defusedxml", "mujoco")),
    ModelFormat("URDF", "robot", "dofkit.models.urdf", ("defusedxml",)),
    ModelFormat("SolveSpace", "SolveSpace", "dofkit.models.solvespace"),
)
#: The root tags of files that are only a part of a model.
_PARTS = ("mujocoinclude", "config")
_TAG = re.compile(rb"<([A-Za-z][\w:.-]*)")
#: XML declarations, comments and document types before the first tag.
_PROLOGUE = re.compile(rb"(?:\s++|<\?.*?\?>|<!--.*?-->|<![A-Z][^>\[]*+(?:\[.*?\]\s*+)?>)*+", re.DOTALL)
#: The number of bytes in which the first tag is searched.
LOOKED_AT = 200_000


def is_model(data: bytes | str) -> bool:
    """Return whether a file begins with an XML tag or SolveSpace's bytes, as no scene does."""
    start = _beginning(data)
    return start.startswith((b"<?xml", b"<!", _SKETCH)) or _TAG.match(start) is not None


def is_known_model(data: bytes | str) -> bool:
    """Return whether a file is of one of the `FORMATS`."""
    return is_model(data) and _first_tag(data) in {form.tag for form in FORMATS}


def format_of(data: bytes | str) -> ModelFormat | None:
    """Return the format of a file; None if it is not a model. Raises SceneError for XML of no known format."""
    if not is_model(data):
        return None
    tag = _first_tag(data)
    form = next((f for f in FORMATS if f.tag == tag), None)
    if form is None and tag:
        message = f"an XML file that begins with <{tag}> is not a model that dofkit reads"
        hint = "models begin with <mujoco> (MJCF) or <robot> (URDF)"
        if tag in _PARTS:
            hint = "this is a part of a model: give the file that includes it"
        raise SceneError((Fault(message, line=1, column=1, hint=hint),))
    return form


def read_model(file: ModelFile) -> ModelDocument:
    """Return the scene of a model's file. Raises SceneError with all faults and their lines."""
    model_format = format_of(file.data)
    if model_format is None:
        titles = ", ".join(model_format.title for model_format in FORMATS)
        raise SceneError((Fault("this is not a model", hint=f"the formats that are read: {titles}"),), file.name)
    missing = [name for name in model_format.needs if find_spec(name) is None]
    if missing:
        message = f"{model_format.title} is read with {' and '.join(missing)}, which is not installed"
        raise SceneError((Fault(message, hint="install it: pip install 'dofkit[models]'"),), file.name)
    document: ModelDocument = import_module(model_format.module).read(file)
    return document


def _beginning(data: bytes | str) -> bytes:
    start = data[:LOOKED_AT]
    raw = start.encode("utf-8", "replace") if isinstance(start, str) else start
    return raw.removeprefix(b"\xef\xbb\xbf").lstrip()


def _first_tag(data: bytes | str) -> str:
    """Return the first tag after declarations and comments, "SolveSpace" for its files, empty if there is none."""
    start = _beginning(data)
    if start.startswith(_SKETCH):
        return "SolveSpace"
    prologue = _PROLOGUE.match(start)
    match = _TAG.match(start, prologue.end() if prologue else 0)
    return "" if match is None else match[1].decode("ascii", "replace")
