"""A certificate verified: the scene is taken in any of the ways a door does, and read again by the checker alone."""

from __future__ import annotations

import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from dofkit.base.documents import read_document
from dofkit.base.errors import ArgumentError
from dofkit.base.wording import description_of
from dofkit.checker import CheckError, Verification
from dofkit.checker.problem import sha256_of
from dofkit.checker.verification import Verifier, certificate_of
from dofkit.methods.certificates.lowering import document_of_scene
from dofkit.scene.catalog import find
from dofkit.scene.reading import SceneLike, load
from dofkit.scene.scene import Scene

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
    read = certificate_of(_text_of(certificate))
    return Verifier(read["scene"].get("document") if scene is None else _document(scene, read), read).run()


def _document(scene: SceneLike, certificate: Mapping[str, Any]) -> Mapping[str, Any]:
    """The scene's document as it is written where the certificate is of that, else as the checker reads it."""
    with suppress(CheckError, ValueError):
        written: Any = None if isinstance(scene, Scene) else scene
        if written is not None and not isinstance(written, Mapping):
            read = read_document(find(written).data, "scene")
            written = None if read.faults else read.value
        if written is not None and sha256_of(written) == certificate["scene"].get("sha256"):
            return dict(written)
    return document_of_scene(load(scene))


def _text_of(certificate: Given) -> Mapping[str, Any] | str | bytes:
    if isinstance(certificate, Mapping | bytes):
        return certificate
    if isinstance(certificate, os.PathLike) or (isinstance(certificate, str) and certificate.lstrip()[:1] != "{"):
        return Path(certificate).read_bytes()
    if not isinstance(certificate, str):
        raise ArgumentError(f"a certificate is a mapping, a path or JSON, not {description_of(certificate)}")
    return certificate
