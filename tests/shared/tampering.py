"""Certificates that are tampered with, scenes that are edited behind their backs, and what is still true then."""

from __future__ import annotations

import copy
import random
import re
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from dofkit.checker import CheckError, Verification, verify
from dofkit.checker.problem import sha256_of
from dofkit.checker.verification import PARTS

#: Where a value stands: keys and places.
Place = tuple[Any, ...]
_NUMBER, _SIGN = re.compile(r"\d+"), re.compile(r"(?<=[\w)\s])[+-](?=[\w(\s])")
ABOUTS = ("reference", "component", "everywhere", None)
#: Claims of which there may be several true ones: what is chosen, not what is so.
CHOICES = ("redundant", "generalized_coordinates", "conflicting", "circuit", "integral", "integrating_factor")


class Tampered(NamedTuple):
    """``kind``: ``claim`` (a value, a path or about is another one) or what was changed of the evidence; ``told``."""

    kind: str
    told: str
    certificate: dict[str, Any]


def leaves(value: Any, place: Place = ()) -> Iterator[tuple[Place, Any]]:
    """Every value that holds no other, with its place."""
    if isinstance(value, dict):
        for key, part in value.items():
            yield from leaves(part, (*place, key))
    elif isinstance(value, list):
        for i, part in enumerate(value):
            yield from leaves(part, (*place, i))
    else:
        yield place, value


def lists(value: Any, place: Place = ()) -> Iterator[tuple[Place, list[Any]]]:
    """Every list with something in it, with its place."""
    if isinstance(value, list) and value:
        yield place, value
    parts = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, part in parts:
        yield from lists(part, (*place, key))


def put(whole: Any, place: Place, value: Any) -> Any:
    """A copy with another value at a place."""
    found = copy.deepcopy(whole)
    at = found
    for key in place[:-1]:
        at = at[key]
    at[place[-1]] = value
    return found


def tampered(certificate: Mapping[str, Any], rng: random.Random) -> Tampered | None:
    """One number, sign, row, name or claim is another one; None where the drawn place has nothing to change."""
    whole = {key: value for key, value in certificate.items() if key in (*PARTS, "claims")}
    kind = rng.choice(("claim", "claim", "number", "sign", "row", "name"))
    change = {"claim": _claim, "number": _number, "sign": _sign, "row": _row, "name": _name}[kind](whole, rng)
    if change is None:
        return None
    place, new, old = change
    changed = put(whole, place, new)
    if changed == whole or new == old:
        return None
    return Tampered(kind, f"{'/'.join(map(str, place))}: {old!r:.120} -> {new!r:.120}", {**certificate, **changed})


Change = tuple[Place, Any, Any]


def other_value(value: Any, rng: random.Random, names: list[str]) -> Any:
    """Another value of a claim."""
    if isinstance(value, bool):
        return not value
    if isinstance(value, int):
        return value + rng.choice((-2, -1, 1, 2))
    if isinstance(value, str):
        return _other_number(value, rng) or f"2*({value})"
    if isinstance(value, list) and value and rng.random() < 0.7:
        i = rng.randrange(len(value))
        return [*value[:i], *rng.choice(([], [other_value(value[i], rng, names)])), *value[i + 1 :]]
    if isinstance(value, list):
        return [*value, rng.choice(names)]
    if isinstance(value, dict) and value:
        key = rng.choice(list(value))
        return {**value, key: other_value(value[key], rng, names)}
    return rng.choice((0, 1, True, False))


def _claim(whole: dict[str, Any], rng: random.Random) -> Change | None:
    if not whole["claims"]:
        return None
    i = rng.randrange(len(whole["claims"]))
    claim, what = whole["claims"][i], rng.choice(("value", "value", "value", "path", "about"))
    owners = [c["path"].split("/")[2] for c in whole["claims"] if c["path"].count("/") > 1]
    if what == "value":
        new = other_value(claim["value"], rng, owners or ["c1"])
    elif what == "about":
        told = [k for k, one in enumerate(whole["claims"]) if "about" in one]
        if not told:
            return None
        i = rng.choice(told)
        claim, new = whole["claims"][i], rng.choice(ABOUTS)
    else:
        new = rng.choice(whole["claims"])["path"]
        if any(other["path"] == new for other in whole["claims"]) and claim["path"].count("/") > 1:
            parts = claim["path"].split("/")
            new = "/".join(
                [*parts[:2], rng.choice(owners), rng.choice((parts[3], "holonomic", "exact", "independent"))]
            )
    return ("claims", i, what), new, claim.get(what)


def _other_number(text: str, rng: random.Random) -> str | None:
    found = list(_NUMBER.finditer(text))
    if not found:
        return None
    one = rng.choice(found)
    digits = str(max(0, int(one[0]) + rng.choice((-1, 1, 2, 7))))
    return text[: one.start()] + digits + text[one.end() :]


def _number(whole: dict[str, Any], rng: random.Random) -> Change | None:
    """Digits of the evidence, in ids too."""
    found = [(p, v) for p, v in leaves(whole) if (isinstance(v, str) and _NUMBER.search(v)) or type(v) is int]
    found = [(p, v) for p, v in found if p[-1] not in ("path", "id") and "value" not in p[2:3]]
    if not found:
        return None
    place, old = rng.choice(found)
    return place, (old + rng.choice((-1, 1)) if isinstance(old, int) else _other_number(old, rng)), old


def _sign(whole: dict[str, Any], rng: random.Random) -> Change | None:
    found = [(p, v) for p, v in leaves(whole) if isinstance(v, str) and p[0] in ("relations", "points", "fields")]
    found += [(p, v) for p, v in leaves(whole["claims"], ("claims",)) if isinstance(v, str) and _NUMBER.search(v)]
    found = [(p, v) for p, v in found if p[-1] not in ("path", "id", "by", "of", "at", "rule", "about") and v != "0"]
    if not found:
        return None
    place, old = rng.choice(found)
    signs = list(_SIGN.finditer(old))
    if signs and rng.random() < 0.7:
        one = rng.choice(signs)
        return place, old[: one.start()] + ("-" if one[0] == "+" else "+") + old[one.end() :], old
    return place, old[1:] if old[:1] == "-" else f"-({old})", old


def _row(whole: dict[str, Any], rng: random.Random) -> Change | None:
    """An entry of a list is dropped, written twice, or put in the place of another."""
    found = [(p, v) for p, v in lists(whole) if len(p) > 1 and p[2:3] != ("value",)]
    if not found:
        return None
    place, old = rng.choice(found)
    i, j = rng.randrange(len(old)), rng.randrange(len(old))
    new = rng.choice((old[:i] + old[i + 1 :], [*old, old[i]], [old[j] if k == i else v for k, v in enumerate(old)]))
    return place, new, old


def _name(whole: dict[str, Any], rng: random.Random) -> Change | None:
    """A name in the place of another."""
    found = [(p, v) for p, v in leaves(whole) if isinstance(v, str) and v.replace(".", "").isidentifier()]
    found = [(p, v) for p, v in found if p[-1] not in ("path", "value")]
    if not found:
        return None
    place, old = rng.choice(found)
    return place, rng.choice(found)[1], old


def asserted(certificate: Mapping[str, Any], found: Verification) -> dict[str, tuple[Any, Any]]:
    """The claims that were verified: path to value and about."""
    failed = {one["path"] for one in found.failed}
    return {
        claim["path"]: (claim["value"], claim.get("about"))
        for claim in certificate["claims"]
        if isinstance(claim.get("path"), str) and claim["path"] not in failed
    }


def accepted(scene: Mapping[str, Any], certificate: Mapping[str, Any]) -> dict[str, tuple[Any, Any]] | None:
    """What a certificate has the checker believe where none of its claims fails; None where one does."""
    try:
        verification = verify(scene, certificate)
    except CheckError:
        return None
    return None if verification.failed else asserted(certificate, verification)


def untrue(claims: Mapping[str, tuple[Any, Any]], report: Mapping[str, Any], *, choices: bool = True) -> list[str]:
    """The claims that are not what the report tells as proved. ``choices``: of what may be chosen only the size."""
    return [told for path, (value, about) in claims.items() if (told := _fault(path, value, about, report, choices))]


def _fault(path: str, value: Any, about: Any, report: Mapping[str, Any], choices: bool) -> str:
    parts = path.split("/")
    owner = parts[2].replace("~1", "/").replace("~0", "~") if len(parts) == 4 else ""
    entry: Any = next((one for one in report["constraints"] if one["name"] == owner), None) if owner else report
    if entry is None or parts[-1] not in entry:
        return f"{path}: nothing of the kind is told"
    verdict = entry["verdicts"].get(parts[-1], {})
    if verdict.get("verdict") != "proved":
        inconsistent = report["consistent"] is False and parts[-1] in ("dof", "velocity_dof")
        return f"{path}: {value}, but it is inconsistent" if inconsistent else ""
    told = entry[parts[-1]]
    about = about if parts[-1] in ("dof", "velocity_dof") else None
    wider = {"everywhere": 2, "component": 1, "reference": 1, None: 0}
    if value == told and type(value) is type(told):
        far = wider.get(about, 0) > wider.get(verdict.get("about"), 2)
        return f"{path}: about {about}, told of {verdict.get('about')}" if far else ""
    if isinstance(value, list) and isinstance(told, list) and sorted(map(str, value)) == sorted(map(str, told)):
        return ""
    if choices and parts[-1] in CHOICES and isinstance(value, str | list) and type(value) is type(told):
        return "" if isinstance(value, str) or len(value) == len(told) else f"{path}: {value}, told {told}"
    return f"{path}: {value}, told {told}"


def edited(document: Mapping[str, Any], rng: random.Random) -> tuple[str, dict[str, Any]] | None:
    """A scene with a constraint dropped or added or a number changed, and what was done."""
    scene = copy.deepcopy(dict(document))
    written = scene.get("constraints") or []
    kind = rng.choice(("dropped", "number", "number", "added", "sign"))
    if kind == "added":
        names = _coordinates(scene)
        if not names:
            return None
        x, y = rng.choice(names), rng.choice(names)
        new = rng.choice(
            (f"{x} = {rng.randrange(3)}", f"{x} + {y} = 1", f"d{x} = {y} d{y}", f"{x}*({x} - 1) = 0", f"{x} = t")
        )
        scene["constraints"] = [*written, new]
        return f"added {new}", scene
    if not written:
        return None
    i = rng.randrange(len(written))
    if kind == "dropped":
        names = [c.get("name") or f"c{k}" if isinstance(c, dict) else f"c{k}" for k, c in enumerate(written, 1)]
        named = [{"type": "equation", "text": c} if isinstance(c, str) else c for c in written]
        named = [{**c, "name": name} for c, name in zip(named, names, strict=True)]
        scene["constraints"] = named[:i] + named[i + 1 :]
        return f"dropped {names[i]}", scene
    return _with_other_number(scene, kind, rng)


def _with_other_number(scene: dict[str, Any], kind: str, rng: random.Random) -> tuple[str, dict[str, Any]] | None:
    keys = ("constraints", "parameters", "configuration", "particles")
    found = [(p, v) for key in keys for p, v in leaves(scene.get(key), (key,)) if p[-1] not in ("name", "type", "on")]
    found = [(p, v) for p, v in found if not isinstance(v, bool) and _NUMBER.search(str(v))]
    if kind == "sign":
        found = [(p, v) for p, v in found if isinstance(v, str) and _SIGN.search(v)]
    if not found:
        return None
    place, old = rng.choice(found)
    if kind == "sign":
        one = rng.choice(list(_SIGN.finditer(old)))
        new: Any = old[: one.start()] + ("-" if one[0] == "+" else "+") + old[one.end() :]
    else:
        new = old + rng.choice((-1, 1, 2)) if isinstance(old, int) else _other_number(str(old), rng)
    return f"{'/'.join(map(str, place))}: {old} -> {new}", put(scene, place, new)


def _coordinates(scene: Mapping[str, Any]) -> list[str]:
    return [name for name in scene.get("coordinates") or () if isinstance(name, str)]


def renewed(certificate: Mapping[str, Any], scene: Mapping[str, Any]) -> dict[str, Any]:
    """The certificate with the hash of another scene, as an attacker would write it."""
    return {**certificate, "scene": {"name": certificate["scene"]["name"], "sha256": sha256_of(scene)}}
