"""Answers that there is none: no integral, nothing redundant, in six languages."""

from __future__ import annotations

import re
from collections.abc import Collection

from dofkit.homework.answers.prose import FILLING, REASONS, YES, phrases, plain, words

#: The answers that there is none, in small letters and without accents; a dash alone is no answer.
NONE = phrases(
    "none|no|nope|nothing|null|nil|empty|∅|{}|[]|()|there is none|there are none|does not exist|no integral|"
    "not integrable|it does not integrate|does not integrate|doesn't integrate|it is not integrable|"
    "cannot be integrated|can't be integrated|non integrable|non-integrable|nonintegrable|no integrable|no redundant|"
    "no redundancy|not redundant|nothing is redundant|"
    "nothing can be dropped|none can be dropped|no constraint can be dropped|"
    "no integral exists|there is no such relation|none of them|none is redundant|none are redundant|"
    "no redundant constraints|no constraint|no constraints|no redundant constraint|there is no integral|"
    "no finite relation|none exists|no such relation|not possible|not holonomic|nonholonomic|non-holonomic|"
    "it is non-holonomic|it is nonholonomic|non holonomic|"
    "nein|keine|keiner|keines|keins|nichts|nicht integrierbar|ist nicht integrierbar|gibt es nicht|gibt keine|"
    "es gibt keine|es gibt keines|es gibt keins|kein integral|leer|leere menge|keine redundanten|keine redundant|"
    "keine redundante|keine redundanz|keine ist redundant|nichtholonom|nicht holonom|anholonom|existiert nicht|"
    "lasst sich nicht integrieren|nicht moglich|integriert nicht|"
    "non|aucun|aucune|rien|il n'y en a pas|il n'y en a aucune|pas integrable|n'est pas integrable|"
    "ce n'est pas integrable|n'existe pas|pas d'integrale|aucune integrale|vide|aucune redondance|"
    "aucune n'est redondante|elle n'est pas integrable|pas de redondance|non holonome|"
    "ninguno|ninguna|nada|no hay|no existe|no es integrable|vacio|no hay ninguna|no hay ninguno|"
    "ninguna es redundante|no se integra|no se puede integrar|no holonoma|"
    "nessuno|nessuna|niente|non esiste|non e integrabile|non integrabile|non ce ne sono|vuoto|anolonomo|"
    "nao|nenhum|nenhuma|nao ha|nao existe|nao e integravel|nao integravel|vazio"
)
#: What stands between the parts of an answer.
_PARTS = r"[,;:(\n]| - | – | — "
_ANDS = r"\s(?:and|und|et|y|e|but|aber|mais|pero|ma|mas)\s"
#: In a sentence of these words alone one denial says that there is none; two take each other back.
_DENIALS = words("no not none nothing nein nicht kein keine keinen keines keins keiner nichts pas non nao never")
#: In Romance languages these go with a denial, or stand alone.
_WITH_DENIALS = words(
    "aucun aucune rien ni ninguno ninguna ningun nada nessun nessuno nessuna niente nao nenhum nenhuma jamais"
)
_NONES = words(
    "none nothing keine keines keins keiner nichts aucun aucune rien ninguno ninguna nada nessuno nessuna niente "
    "nenhum nenhuma"
)
#: What is denied, by its beginning; a prefix denies it too.
_DENIED = re.compile(
    r"(?P<prefix>non-?|nicht-?|an|un|in)?(?:integr|holonom|olonom|exist|esist|redund|redond|ridond|ueberfluss|uberfluss|superflu|sobra"
    r"|entbehr|relation|beziehung|equation|gleichung|ecuacion|equazion|equac|dropped|weglass|primitive|stammfunktion"
    r"|potential)[a-z]*"
)
_AROUND = words(
    "there here this that these they such any exists has have does do did can be form forme forma differential "
    "differentielle zwangsbedingung bedingung gleichung lasst sich gibt man kann werden hier da admits admet possede "
    "besitzt hat tiene ha posee ce il elle ne si se puede puo pode hay ci vi ha tem of finite finie "
    "sobre constraint liaison relacion relazione relacao di de del della diese dieser die das der to for fur fuer pour "
    "para per esta questa questo bindung exact exakt moglich possible es una uno lo la su sua ihr sein so "
    "vorhanden endliche endlichen vincolo vincoli ligadura restriccion vinculo "
    "ser sein etre essere been unfortunately leider hence also daher donc luego quindi"
)
_EVERY = words("all every each alle jede jeder toutes tous chaque todas todos tutti tutte")
_NEEDED = re.compile(
    r"(?:need|necess|requir|independen|unabhangig|notig|benotigt|notwendig|indispens|independant|indipend)"
)
_CONTRACTED = (
    (re.compile(r"\bn['’]y\b"), " "),
    (re.compile(r"\b(?:l|d|n|c|s|m|t|qu|un|dell|all|nell)['’]"), " "),
    (re.compile(r"\b(?:can't|cannot)\b"), "can not"),
    (re.compile(r"n't\b"), " not"),
)


def says_none(text: str, known: Collection[str] = (), every: bool = False) -> bool:
    """Does a text say that there is none? ``known``: names, which are no words; ``every``: `all are needed` says so."""
    told = plain(REASONS.split(text, maxsplit=1)[0])
    first = plain(re.split(_PARTS, told, maxsplit=1)[0])
    names = {plain(name) for name in known}
    return any(_denies(part, names) or (every and _needs_all(part, names)) for part in (told, first))


def beside_none(text: str) -> list[str]:
    """The parts of a text that says in one of them that there is none; nothing where none says so, reasons left out.

    >>> beside_none("y = C x, not integrable"), beside_none("y = C x"), beside_none("none")
    (['y = C x'], [], [])
    """
    parts = [part.strip(" ()") for part in re.split(rf"{_PARTS}|{_ANDS}", REASONS.split(text, maxsplit=1)[0])]
    denied = [part for part in parts if _denies(plain(part)) and re.search(r"[^\W\d_]", part)]
    return [part for part in parts if part and part not in denied] if denied else []


def affirms(part: str) -> bool:
    """Does a part of an answer say yes, or of what is asked that it is so: `it is integrable`?"""
    found = _tokens(plain(part))
    return plain(part) in YES or (bool(found) and _closed(found) and _denial(found) == 0 and _names_it(found))


def _denies(told: str, names: Collection[str] = ()) -> bool:
    """Does a text in small letters say that there is none, in a known phrase or in words of a closed list?"""
    if told in NONE:
        return True
    found = _tokens(told)
    if not found or not _closed(found) or not _EVERY.isdisjoint(found) or any(w in names for w in found):
        return False
    return _denial(found) == 1 and (_names_it(found) or not _NONES.isdisjoint(found))


def _needs_all(told: str, names: Collection[str]) -> bool:
    """`all are needed`, `alle sind unabhängig`."""
    found = _tokens(told)
    whole = bool(found) and _closed(found) and not _EVERY.isdisjoint(found) and not any(w in names for w in found)
    return whole and _denial(found) == 0 and any(_NEEDED.match(w) for w in found)


def _tokens(told: str) -> list[str]:
    """The words of a text; none where it holds anything else."""
    for pattern, by in _CONTRACTED:
        told = pattern.sub(by, told)
    return [] if re.search(r"[^\w\s'’.,-]|\d|_", told) else re.findall(r"[^\W\d_]+(?:-[^\W\d_]+)*", told)


def _names_it(found: list[str]) -> bool:
    return any(_DENIED.fullmatch(w) for w in found)


def _closed(found: list[str]) -> bool:
    """Are all words of the lists?"""
    known = _DENIALS | _WITH_DENIALS | _AROUND | _EVERY | FILLING
    return all(w in known or _DENIED.fullmatch(w) or _NEEDED.match(w) for w in found)


def _denial(found: list[str]) -> int:
    """How often it is denied."""
    prefixed = sum(1 for w in found if (m := _DENIED.fullmatch(w)) and m["prefix"])
    denied = sum(w in _DENIALS for w in found)
    return prefixed + (denied or int(any(w in _WITH_DENIALS for w in found)))
