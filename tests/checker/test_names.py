"""Names that the checker reads as scenes do."""

from __future__ import annotations

import dofkit


def test_hyphens_of_particles_and_bodies() -> None:
    """The coordinates of `k-1` are x_k_1 and y_k_1, for the checker too."""
    scene = {
        "dimension": 2,
        "particles": ["k-1", "k-2"],
        "constraints": [{"type": "link", "between": ["k-1", "k-2"], "length": 1}, "y_k_1 = 0"],
    }
    report = dofkit.classify(scene, certificate=True)
    assert report.certificate is not None
    assert report.dof == 2
    found = dofkit.verify(scene, report.certificate)
    assert found.verified > 0
    assert not found.failed
