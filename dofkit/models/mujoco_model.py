"""A model compiled by MuJoCo: its bodies, joints, equalities and tendons in the reference configuration.

Only a worker process imports this module, because a compiler in C may crash, hang or use all memory.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import mujoco
import numpy as np

from dofkit.base.wording import first_of

#: Elements that do not affect the motion, and may refer to missing files.
_SHOWN = ("textures", "skins", "sensors", "keys")
#: The mass and inertia of a moving body that has none.
LEAST = 1e-6
#: The largest residual of an equality in the reference, and the most steps of Newton's method towards a reference.
CLOSED, STEPS = 1e-8, 60
#: The index of a weld's torque scale in its data; with 0 it does not fix the orientation.
_TORQUE = 10


class Compiled(NamedTuple):
    """A model with its state in the reference configuration, and notes on what was changed."""

    model: Any
    data: Any
    notes: list[str]


def described_model(source: Mapping[str, Any]) -> dict[str, Any]:
    """Return what a compiled model contains, in values that json can write. ``source``: its ``path``, else ``text``."""
    mujoco.set_mju_user_warning(lambda message: None)
    path = source["path"]
    notes: list[str] = []
    spec = mujoco.MjSpec.from_file(path) if path else mujoco.MjSpec.from_string(source["text"])
    folder = os.path.dirname(os.path.abspath(path)) if path else os.getcwd()
    notes += _without_files(spec, folder)
    _without_looks(spec)
    try:
        model = spec.compile()
    except ValueError:
        spec.compiler.boundmass = spec.compiler.boundinertia = LEAST
        model = spec.compile()
        notes.append("masses: some moving bodies have none that can be read")
    data = mujoco.MjData(model)
    compiled = Compiled(model, data, notes)
    closed = _set_reference(compiled)
    return {
        "closed": closed,
        "bodies": [*_bodies(compiled)],
        "joints": [*_joints(compiled)],
        "equalities": [*_equalities(compiled)],
        "tendons": [*_tendons(compiled)],
        "gravity": [0.0] * 3 if _off(model, "GRAVITY") else _list(model.opt.gravity),
        "springs": bool(np.any(model.jnt_stiffness) or np.any(model.tendon_stiffness)),
        "friction": any(map(np.any, (model.dof_damping, model.dof_frictionloss, model.tendon_damping))),
        "rotors": bool(np.any(model.dof_armature)),
        "lifted": bool(np.any(model.body_gravcomp)),
        "medium": bool(model.opt.density or model.opt.viscosity),
        "actuators": int(model.nu),
        "contacts": bool(model.ngeom and np.any(model.geom_contype | model.geom_conaffinity)),
        "flexible": int(model.nflex),
        "nv": int(model.nv),
        "left": _freedom_by_rank(compiled),
        "notes": notes,
    }


def _without_files(spec: Any, folder: str) -> Iterator[str]:
    """Remove meshes and height fields without files, and their shapes; yield a note about them."""
    lost: dict[str, str] = {}
    below = spec.compiler.meshdir
    for asset in [*spec.meshes, *spec.hfields]:
        if asset.file and not os.path.isfile(os.path.join(folder, below, asset.file)):
            lost[asset.name or os.path.splitext(os.path.basename(asset.file))[0]] = asset.file
            spec.delete(asset)
    if not lost:
        return
    for geom in list(spec.geoms):
        if geom.meshname in lost or geom.hfieldname in lost:
            spec.delete(geom)
    yield f"the shapes of {first_of(lost.values(), 4)}: their files are missing, so their masses are unknown"


def _without_looks(spec: Any) -> None:
    """Remove what is only for display or sensors, and the limit on a simulation's memory."""
    spec.memory = -1
    for material in spec.materials:
        material.textures = [""] * len(material.textures)
    for kind in _SHOWN:
        for asset in list(getattr(spec, kind)):
            spec.delete(asset)


def _set_reference(compiled: Compiled) -> bool:
    """Set the reference configuration, given or moved to satisfy the equalities; return whether they are satisfied."""
    model, data = compiled.model, compiled.data
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_LIMIT
    _place(compiled)
    rows, gap = _equality_rows(compiled)
    if gap.size == 0 or float(np.max(np.abs(gap))) <= CLOSED:
        return True
    started = data.qpos.copy()
    for _ in range(STEPS):
        step = -np.linalg.lstsq(rows, gap, rcond=1e-10)[0]
        mujoco.mj_integratePos(model, data.qpos, step, 1.0)
        _place(compiled)
        rows, gap = _equality_rows(compiled)
        if float(np.max(np.abs(gap))) <= CLOSED * 1e-3:
            break
    if float(np.max(np.abs(gap))) > CLOSED:
        data.qpos[:] = started
        _place(compiled)
        return False
    compiled.notes.append(
        "the given pose: it does not satisfy the equalities, and the reference configuration is a pose near it"
    )
    return True


def _place(compiled: Compiled) -> None:
    """Compute all positions and the residual of every equality; no dynamics."""
    for step in (mujoco.mj_kinematics, mujoco.mj_comPos, mujoco.mj_tendon):
        step(compiled.model, compiled.data)
    mujoco.mj_makeConstraint(compiled.model, compiled.data)


def _equality_rows(compiled: Compiled) -> tuple[Any, Any]:
    """Return the equality rows of the Jacobian, and their residuals."""
    data, nv = compiled.data, compiled.model.nv
    is_equality = data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY
    dense = np.zeros((data.nefc, nv))
    if mujoco.mj_isSparse(compiled.model):
        mujoco.mju_sparse2dense(dense, data.efc_J, data.efc_J_rownnz, data.efc_J_rowadr, data.efc_J_colind)
    else:
        # The array may be longer: room for rows that MuJoCo found to be empty is kept at its end.
        dense = np.reshape(np.ravel(data.efc_J)[: data.nefc * nv], (data.nefc, nv))
    return dense[is_equality], data.efc_pos[is_equality]


def _freedom_by_rank(compiled: Compiled) -> int:
    """Return the freedom by MuJoCo: nv less the rank of the active equality rows."""
    rows, _ = _equality_rows(compiled)
    return int(compiled.model.nv - (np.linalg.matrix_rank(rows, tol=1e-8) if rows.size else 0))


def _off(model: Any, *flags: str) -> bool:
    """Return whether one of these flags is switched off for the model."""
    return any(model.opt.disableflags & getattr(mujoco.mjtDisableBit, f"mjDSBL_{flag}") for flag in flags)


def _list(values: Any) -> list[float]:
    return [float(v) for v in np.asarray(values).ravel()]


def _name(model: Any, kind: str, index: int) -> str:
    return mujoco.mj_id2name(model, getattr(mujoco.mjtObj, f"mjOBJ_{kind}"), index) or ""


def _bodies(compiled: Compiled) -> Iterator[dict[str, Any]]:
    """Yield all bodies as JSON; centre, origin and inertia are in world axes."""
    model, data = compiled.model, compiled.data
    for i in range(model.nbody):
        turn = np.reshape(data.ximat[i], (3, 3))
        yield {
            "name": _name(model, "BODY", i),
            "parent": int(model.body_parentid[i]),
            "static": int(model.body_weldid[i]) == 0,
            "joints": [int(j) for j in range(model.body_jntadr[i], model.body_jntadr[i] + model.body_jntnum[i])],
            "centre": _list(data.xipos[i]),
            "mass": float(model.body_mass[i]),
            "inertia": [_list(row) for row in turn @ np.diag(model.body_inertia[i]) @ turn.T],
        }


def _joints(compiled: Compiled) -> Iterator[dict[str, Any]]:
    """Yield all joints as JSON; ``zero`` and ``reference``: the coordinate at rest and that of the reference pose."""
    model, data = compiled.model, compiled.data
    for i in range(model.njnt):
        kind = ("free", "ball", "slide", "hinge")[int(model.jnt_type[i])]
        at = int(model.jnt_qposadr[i])
        yield {
            "name": _name(model, "JOINT", i),
            "kind": kind,
            "anchor": _list(data.xanchor[i]),
            "axis": _list(data.xaxis[i]),
            "range": _list(model.jnt_range[i]) if model.jnt_limited[i] and kind != "free" else None,
            "zero": float(model.qpos0[at]),
            "reference": float(data.qpos[at]),
        }


def _ends(compiled: Compiled, index: int) -> list[tuple[int, list[float]]]:
    """Return the two points of a connect, or the anchors of a weld: (body, position in the world)."""
    model, data = compiled.model, compiled.data
    first, second = int(model.eq_obj1id[index]), int(model.eq_obj2id[index])
    if model.eq_objtype[index] == mujoco.mjtObj.mjOBJ_SITE:
        return [(int(model.site_bodyid[s]), _list(data.site_xpos[s])) for s in (first, second)]
    weld = model.eq_type[index] == mujoco.mjtEq.mjEQ_WELD
    anchors = (model.eq_data[index, 3:6], model.eq_data[index, :3])
    arms = anchors if weld else anchors[::-1]
    return [
        (b, _list(data.xpos[b] + np.reshape(data.xmat[b], (3, 3)) @ arm))
        for b, arm in zip((first, second), arms, strict=True)
    ]


def _equalities(compiled: Compiled) -> Iterator[dict[str, Any]]:
    """Yield all equality constraints as JSON, with the points or coefficients of their kind."""
    model = compiled.model
    for i in range(model.neq):
        kind = mujoco.mjtEq(model.eq_type[i]).name.removeprefix("mjEQ_").lower()
        equality: dict[str, Any] = {
            "name": _name(model, "EQUALITY", i),
            "kind": kind,
            "active": bool(model.eq_active0[i]) and not _off(model, "EQUALITY", "CONSTRAINT"),
            "of": [int(model.eq_obj1id[i]), int(model.eq_obj2id[i])],
        }
        if kind in ("connect", "weld"):
            equality["ends"] = _ends(compiled, i)
            equality["turning"] = kind == "weld" and bool(model.eq_data[i, _TORQUE])
        elif kind in ("joint", "tendon"):
            equality["polynomial"] = _list(model.eq_data[i, :5])
        yield equality


def _tendons(compiled: Compiled) -> Iterator[dict[str, Any]]:
    """Yield all tendons as JSON; ``path``: the sites, joints and pulleys along a tendon."""
    model, data = compiled.model, compiled.data
    kinds = {int(kind): kind.name.removeprefix("mjWRAP_").lower() for kind in mujoco.mjtWrap.__members__.values()}
    for i in range(model.ntendon):
        path = []
        for k in range(model.tendon_adr[i], model.tendon_adr[i] + model.tendon_num[i]):
            kind, of = kinds[int(model.wrap_type[k])], int(model.wrap_objid[k])
            end = [int(model.site_bodyid[of]), _list(data.site_xpos[of])] if kind == "site" else None
            path.append({"kind": kind, "of": of, "factor": float(model.wrap_prm[k]), "end": end})
        yield {
            "name": _name(model, "TENDON", i) or f"tendon_{i}",
            "path": path,
            "length": float(data.ten_length[i]),
            "zero": float(model.tendon_length0[i]),
            "range": _list(model.tendon_range[i]) if model.tendon_limited[i] else None,
        }
