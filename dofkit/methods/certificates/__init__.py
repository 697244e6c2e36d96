"""Certificates: evidence for what a report says is proved, found afterwards in the checker's own reading."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dofkit.base.surface import handed_on

if TYPE_CHECKING:
    from dofkit.methods.certificates.answers import certificates_of
    from dofkit.methods.certificates.motion_evidence import certificate_of_motion
    from dofkit.methods.certificates.verifying import verify

__all__ = ["certificate_of_motion", "certificates_of", "verify"]

#: What is handed on, and where it lives: imported when it is first asked for.
_HOMES = {
    "certificate_of_motion": "dofkit.methods.certificates.motion_evidence",
    "certificates_of": "dofkit.methods.certificates.answers",
    "verify": "dofkit.methods.certificates.verifying",
}


def __getattr__(name: str) -> Any:
    return handed_on(__name__, _HOMES, name)
