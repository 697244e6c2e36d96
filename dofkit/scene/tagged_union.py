"""Unions whose members are told apart by one key: what is said where it is missing or unknown."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import Any

from pydantic import ValidationError, ValidatorFunctionWrapHandler

from dofkit.scene.fields import fault_at, fault_error, in_words, retold, suggestion


@dataclass(frozen=True)
class TaggedUnion:
    """Members of class ``base``, of which one is ``called`` so, by their ``key``.

    ``known``: what the key may say, and ``names`` what that is called; ``listing`` stands before a list of it,
    ``unknown`` says that {} is none of it; ``otherwise``: what is said, and hinted, of what is no mapping.
    """

    base: type
    called: str
    key: str
    known: Collection[str]
    names: str
    listing: str
    unknown: str
    otherwise: tuple[str, str | None]
    #: The hint for a word that is none of ``known`` (None: it is missing), by the word and the mapping that holds it.
    advise: Callable[[object, Mapping[str, Any]], str | None] = lambda word, entry: None

    def validated(self, value: object, handler: ValidatorFunctionWrapHandler) -> Any:
        """A member, its faults at paths free of the key. Raises as Pydantic's validators do."""
        if isinstance(value, (dict, Mapping)):
            given = value.get(self.key)
            if given is not None and not isinstance(given, str):
                raise fault_at(
                    (self.key,), f"the `{self.key}` is a text, not {in_words(given)}", self.advise(None, value)
                )
            if given is None:
                hint = self.advise(None, value) or self.listing + ", ".join(self.known)
                raise fault_error(f"{self.called} needs its `{self.key}`", hint)
            if given not in self.known:
                hint = self.advise(given, value) or suggestion(given, list(self.known), self.names)
                raise fault_at((self.key,), self.unknown.format(given), hint)
        elif not isinstance(value, self.base):
            raise fault_error(*self.otherwise)
        try:
            return handler(value)
        except ValidationError as error:
            raise retold(error, self.called, (), lambda loc: loc[1:]) from None
