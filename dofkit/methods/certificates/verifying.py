"""The door of the checker for scenes of every kind: `verify`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from dofkit.checker import Verification
from dofkit.checker import verify as verify_document
from dofkit.methods.certificates.lowering import document_of_scene
from dofkit.scene.reading import SceneLike, scene_or_system
from dofkit.scene.scene import Scene


def verify(scene: SceneLike | None, certificate: Mapping[str, Any] | str | bytes) -> Verification:
    """Recheck a certificate of a scene, claim by claim, by a program that shares nothing with `classify`.

    ``scene``: a Scene, a path, a catalog name or a mapping; None: the scene in the certificate. ``certificate``: a
    mapping or its JSON. Returns a Verification: how many ``claims`` there are and how many are ``verified``, what
    ``failed`` and why, and what is ``uncovered``. Raises `dofkit.checker.CheckError` where it cannot be read, or is of
    another scene.

    >>> import dofkit
    >>> certificate = dofkit.classify("four-bar-linkage", certificate=True).certificate
    >>> dofkit.verify("four-bar-linkage", certificate).failed
    []
    """
    if scene is None:
        return verify_document(None, certificate)
    given = scene_or_system(scene)
    return verify_document(document_of_scene(given) if isinstance(given, Scene) else None, certificate)
