"""A certificate verified: the scene is taken in any of the ways a door does, and read again by the checker alone."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from dofkit.base.documents import read_document
from dofkit.base.errors import ArgumentError
from dofkit.base.wording import description_of
from dofkit.checker import Verification
from dofkit.checker import verify as rechecked
from dofkit.expressions.text.characters import SUBSCRIPTS
from dofkit.methods.certificates.lowering import document_of_scene
from dofkit.models.formats import is_model
from dofkit.scene.catalog import find
from dofkit.scene.reading import SceneLike, load
from dofkit.scene.scene import Scene
from dofkit.scene.synonyms import SAID, standard_words

Given = Mapping[str, Any] | str | bytes | os.PathLike[str]


def verify(scene: SceneLike | None, certificate: Given) -> Verification:
    """Return which claims of a certificate hold, by a program that shares nothing with the engines.

    Parameters
    ----------
    scene
        A Scene, a path, a catalog name or a mapping; None for the scene in the certificate.
    certificate
        A mapping, a path, or JSON.

    Returns
    -------
    Verification
        The numbers of claims and of verified claims, the failed ones with the reason, and what is not covered.

    Raises
    ------
    SceneError
        If there is no such scene.
    ArgumentError
        If ``certificate`` is no certificate.
    CheckError
        A ValueError: if the scene or the certificate cannot be read, or belongs to another scene.

    Examples
    --------
    >>> import dofkit
    >>> report = dofkit.classify("four-bar-linkage", certificate=True)
    >>> dofkit.verify("four-bar-linkage", report.certificate).failed
    []
    """
    return rechecked(_written(scene), _text_of(certificate))


def _written(scene: SceneLike | None) -> Mapping[str, Any] | str | None:
    if scene is None:
        return None
    if isinstance(scene, Scene):
        return document_of_scene(scene)
    if isinstance(scene, Mapping):
        return document_of_scene(load(scene)) if _in_other_words(scene) else scene
    source = find(scene)
    if is_model(source.data):
        return document_of_scene(load(scene))
    text = source.data if isinstance(source.data, str) else source.data.decode("utf-8")
    value = read_document(source.data, source.name).value
    return document_of_scene(load(scene)) if _in_other_words(value) else text


def _in_other_words(value: object) -> bool:
    """Whether a document is written in words that the checker does not know: it is given the standard ones then."""
    if not isinstance(value, Mapping):
        return False
    odd = ("°", "deg", *SUBSCRIPTS)
    return standard_words(value).value != value or any(sign in text for text in _texts(value) for sign in odd)


def _texts(value: object) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping):
        yield from (text for key, part in value.items() if key not in SAID for text in _texts(part))
    elif isinstance(value, list | tuple):
        yield from (text for part in value for text in _texts(part))


def _text_of(certificate: Given) -> Mapping[str, Any] | str | bytes:
    if isinstance(certificate, Mapping | bytes):
        return certificate
    if isinstance(certificate, os.PathLike) or (isinstance(certificate, str) and certificate.lstrip()[:1] != "{"):
        return Path(certificate).read_bytes()
    if not isinstance(certificate, str):
        raise ArgumentError(f"a certificate is a mapping, a path or JSON, not {description_of(certificate)}")
    return certificate
