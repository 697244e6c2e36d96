"""A report with its certificate, and a certificate verified: both take a scene in any of the ways a door does."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from dofkit.base.errors import ArgumentError
from dofkit.checker import Verification
from dofkit.checker import verify as rechecked
from dofkit.checker.document import exact_document
from dofkit.methods.certificates.certificate import made
from dofkit.methods.certificates.withdrawal import withdrawn
from dofkit.report import Report
from dofkit.scene.reading import SceneLike, find
from dofkit.scene.scene import Scene


def certified(scene: Scene, report: Report) -> Report:
    """The report with its ``certificate``; what a second program does not confirm is undecided, with a warning."""
    certificate, refused = made(document_of_scene(scene), report)
    for path, why in refused:
        report = withdrawn(report, path, why)
    return report.model_copy(update={"certificate": certificate})


def document_of_scene(scene: Scene) -> Mapping[str, Any]:
    """What a scene's file would say, as the checker reads it."""
    written = scene.model_dump(mode="json", by_alias=True, exclude_unset=True)
    return exact_document(written)


def verify(scene: SceneLike | None, certificate: Mapping[str, Any] | str | bytes | os.PathLike[str]) -> Verification:
    """Recheck every claim of a certificate by a second program, which shares nothing with the engines.

    ``scene``: a Scene, a path, a catalog name or a mapping; None: the scene in the certificate. ``certificate``: a
    mapping, a path, or JSON. Returns how many of how many claims were verified, which failed and why, and what the
    certificate leaves uncovered. Raises `SceneError` where there is no such scene, and ``CheckError``, a ValueError,
    where scene or certificate cannot be read, or the certificate is of another scene.

    >>> import dofkit
    >>> report = dofkit.classify("four-bar-linkage", certificate=True)
    >>> dofkit.verify("four-bar-linkage", report.certificate).failed
    []
    """
    return rechecked(_written(scene), _text_of(certificate))


def _written(scene: SceneLike | None) -> Mapping[str, Any] | str | None:
    if scene is None or isinstance(scene, Mapping):
        return scene if scene is None else exact_document(scene)
    if isinstance(scene, Scene):
        return document_of_scene(scene)
    data = find(scene).data
    return data if isinstance(data, str) else data.decode("utf-8")


def _text_of(certificate: Mapping[str, Any] | str | bytes | os.PathLike[str]) -> Mapping[str, Any] | str | bytes:
    if isinstance(certificate, os.PathLike):
        return Path(certificate).read_bytes()
    if isinstance(certificate, str) and not certificate.lstrip().startswith("{"):
        return Path(certificate).read_bytes()
    if not isinstance(certificate, Mapping | str | bytes):
        raise ArgumentError("a certificate is given as a mapping, a path or a JSON text")
    return certificate
