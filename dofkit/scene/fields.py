"""Fields of a scene as a person writes them: exact numbers, texts, and faults that say what to write instead.

Every model of a scene derives from `WrittenModel`: frozen, closed to unknown keys, with Pydantic's messages reworded.
An error of a `pydantic.ValidationError` has ``ctx["hint"]`` if there is a suggestion, and ``loc``, the path of keys and
positions as written.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from functools import lru_cache
from numbers import Integral
from typing import Annotated, Any, Self

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    ModelWrapValidatorHandler,
    PlainSerializer,
    PlainValidator,
    ValidationError,
    ValidatorFunctionWrapHandler,
    WithJsonSchema,
    model_validator,
)
from pydantic_core import InitErrorDetails, PydanticCustomError

from dofkit.base.documents import package_table
from dofkit.base.errors import Fault
from dofkit.base.wording import many, nearest, verb
from dofkit.base.yaml_events import LARGEST_EXPONENT, LONGEST_NUMBER

_LITERAL = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,6})?)(?:\s*/\s*(\d+))?", re.ASCII)
_OURS = "dofkit"


@lru_cache(maxsize=4096)
def meant_key(word: object, keys: tuple[str, ...]) -> str | None:
    """Return the one of ``keys`` that ``word`` most likely means, or None.

    >>> meant_key("members", ("type", "between")), meant_key("lenght", ("between", "length"))
    ('between', 'length')
    """
    words = package_table(__package__, "keys_meant.yaml")
    return next((key for key in keys if word in words.get(key, ())), None) or nearest(word, keys)


def suggestion(word: object, candidates: Sequence[str], what: str) -> str:
    """Return a hint that names the one of ``candidates`` nearest to ``word``, or else lists the ``what``."""
    near = meant_key(word, tuple(candidates)) if what == "keys" else nearest(word, candidates)
    if near is not None:
        return f"did you mean '{near}'?"
    if not candidates:
        return f"there are no {what}"
    listed = ", ".join(list(candidates)[:20]) + (", ..." if len(candidates) > 20 else "")
    return f"the {what} are {listed}"


def fault_error(message: str, hint: str | None = None, **context: Any) -> PydanticCustomError:
    """Return an error for a validator to raise, with ``hint`` and ``context`` in its context."""
    details = {"message": message, **({"hint": hint} if hint else {}), **context}
    return PydanticCustomError(_OURS, "{message}", details)


def faults_of(error: ValidationError) -> tuple[Fault, ...]:
    """Return the faults of a validation error, each with its path as written, column and hint."""
    return tuple(
        Fault(
            detail["msg"],
            tuple(detail["loc"]),
            column=(detail.get("ctx") or {}).get("column"),
            hint=(detail.get("ctx") or {}).get("hint"),
        )
        for detail in error.errors(include_url=False, include_input=False)
    )


def exact(value: object) -> Fraction:
    """Return ``value`` as an exact number; a float by its shortest decimal form. Raises `fault_error` for other values.

    >>> exact(0.1), exact("1e-2"), exact("2/3")
    (Fraction(1, 10), Fraction(1, 100), Fraction(2, 3))
    """
    if isinstance(value, bool):
        raise fault_error(f"a number is needed, not {str(value).lower()}", "write 1 or 0")
    if isinstance(value, Fraction):
        return value
    if isinstance(value, Integral):
        return Fraction(int(value))
    if isinstance(value, float):
        if not math.isfinite(value):
            raise fault_error(f"a finite number is needed, not {value}")
        return Fraction(float.__repr__(value))
    if isinstance(value, Decimal):
        return _from_decimal(value)
    if isinstance(value, str):
        number = _literal(value)
        if number is not None:
            return number
    raise fault_error(f"a number is needed, not {in_words(value)}")


def _from_decimal(value: Decimal) -> Fraction:
    if not value.is_finite():
        raise fault_error(f"a finite number is needed, not {value}")
    if value and abs(value.adjusted()) > LARGEST_EXPONENT:
        raise fault_error(f"the number {value} is too large or too small", f"stay within 1e±{LARGEST_EXPONENT}")
    return Fraction(value)


def _literal(text: str) -> Fraction | None:
    match = _LITERAL.fullmatch(text.strip()) if len(text) <= LONGEST_NUMBER else None
    if match is None or (match[2] and not int(match[2])):
        return None
    return _from_decimal(Decimal(match[1])) / int(match[2] or 1)


def _value(value: object) -> Fraction | str:
    if isinstance(value, str):
        text = value.strip()
        if not text:
            raise fault_error("a number or a text is needed, not an empty text")
        number = _literal(text)
        return value if number is None else number
    if isinstance(value, (list, tuple, dict)):
        raise fault_error(f"a number or a text is needed, not {in_words(value)}")
    return exact(value)


def _text(value: object) -> str:
    if isinstance(value, str):
        if not value.strip():
            raise fault_error("a text is needed, not an empty one")
        return value
    if isinstance(value, (list, tuple, dict)) or value is None:
        raise fault_error(f"a text is needed, not {in_words(value)}")
    return str(exact(value))


def as_written(value: Fraction | str) -> str:
    """Return a value as text: a number with finite decimals as decimals, another as a fraction.

    >>> as_written(Fraction(-1, 4)), as_written(Fraction(1, 3))
    ('-0.25', '1/3')
    """
    return value if isinstance(value, str) else decimal_of(value, 20) or str(value)


def decimal_of(value: Fraction, most: int) -> str | None:
    """Return a number as a decimal with at most ``most`` places, or None if these do not suffice."""
    places = next((k for k in range(most + 1) if 10**k % value.denominator == 0), None)
    return None if places is None else f"{Decimal(f'{int(value * 10**places)}E-{places}'):f}"


def _number_out(value: Fraction | str) -> int | str:
    """Return an integer as int and any other number as a text such as ``1/2``, which reads back exactly."""
    if isinstance(value, str):
        return value
    return int(value) if value.denominator == 1 else str(value)


_NUMBER_OR_TEXT = {"anyOf": [{"type": "number"}, {"type": "string"}]}

#: An exact number.
Number = Annotated[
    Fraction,
    PlainValidator(exact),
    PlainSerializer(_number_out, return_type=int | str, when_used="json"),
    WithJsonSchema(_NUMBER_OR_TEXT),
]
#: An exact number, or text such as ``sqrt(3)/2``.
Value = Annotated[
    Fraction | str,
    PlainValidator(_value),
    PlainSerializer(_number_out, return_type=int | str, when_used="json"),
    WithJsonSchema(_NUMBER_OR_TEXT),
]
#: Mathematics as text; a number is taken as its text.
Text = Annotated[str, PlainValidator(_text), WithJsonSchema(_NUMBER_OR_TEXT)]
#: Components of a point or a direction; their number is checked against the scene's dimension.
Vector = tuple[Value, ...]


def listed(value: object) -> object:
    """Return an empty YAML value (``particles:`` with nothing after it) as an empty list, any other value unchanged."""
    return () if value is None else value


def named(value: object) -> object:
    """Return a plain name as ``{name: ...}``, any other value unchanged."""
    return {"name": value} if isinstance(value, str) else value


Listed = BeforeValidator(listed)


def in_words(value: object) -> str:
    """Return a short description of a value for messages: ``'x'``, ``a list``, ``nothing``."""
    if value is None:
        return "nothing"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f"'{value if len(value) <= 60 else value[:57] + '...'}'"
    if isinstance(value, Mapping):
        return "a mapping"
    if isinstance(value, (list, tuple)):
        return "a list"
    return str(value)[:60]


_NEEDS = {
    "string_type": "a text",
    "string_too_short": "a text",
    "bool_type": "true or false",
    "bool_parsing": "true or false",
    "tuple_type": "a list",
    "list_type": "a list",
    "dict_type": "a mapping",
    "model_type": "a mapping",
    "model_attributes_type": "a mapping",
}


_AS = {"a particle": "a name or a mapping", "a body": "a name or a mapping"}


def _message(detail: Mapping[str, Any], owner: str, keys: Sequence[str]) -> tuple[str, str | None]:
    """Return (message, hint) for an error of Pydantic's in the entry ``owner``, whose allowed keys are ``keys``."""
    kind, place = detail["type"], detail["loc"]
    context = detail.get("ctx") or {}
    if kind == "extra_forbidden":
        return f"unknown key '{place[-1]}' in {owner}", suggestion(place[-1], keys, "keys")
    if kind == "invalid_key":
        return f"a key is a text, not {in_words(place[-1])}", "put it in quotes"
    if kind == "missing":
        if isinstance(place[-1], int):
            return f"{place[-1] + 1} entries are needed here, not {place[-1]}", None
        return f"{owner} needs '{place[-1]}'", None
    if kind == "model_type" and not place:
        return f"{owner} is {_AS.get(owner, 'a mapping')}, not {in_words(detail['input'])}", None
    if kind in _NEEDS:
        return f"{_NEEDS[kind]} is needed, not {in_words(detail['input'])}", None
    if kind == "literal_error":
        choices = re.findall(r"'([^']*)'", str(context["expected"]))
        message = f"{in_words(detail['input'])} is not one of {context['expected']}"
        return message, suggestion(detail["input"], choices, "choices")
    if kind in ("too_short", "too_long"):
        bound = int(context.get("min_length", context.get("max_length", 0)))
        word = "at least" if kind == "too_short" else "at most"
        needed = f"{word} {many(bound, 'entry')} {verb(bound)} needed"
        return f"{needed}, not {context['actual_length']}", None
    return str(detail["msg"]).removeprefix("Value error, "), None


def fault_at(place: tuple[int | str, ...], message: str, hint: str | None = None) -> ValidationError:
    """Return an error with one fault at the path ``place`` in the validated value, for a validator to raise."""
    detail = InitErrorDetails(type=fault_error(message, hint), loc=place, input=None)
    return ValidationError.from_exception_data("scene", [detail])


def retold(
    error: ValidationError,
    owner: str,
    keys: Sequence[str],
    place: Callable[[tuple[int | str, ...]], tuple[int | str, ...]] = lambda loc: loc,
) -> ValidationError:
    """Return the error with Pydantic's messages in dofkit's words; ``place`` maps the path of each fault."""
    details = []
    for detail in error.errors(include_url=False):
        context = dict(detail.get("ctx") or {})
        if detail["type"] != _OURS:
            message, hint = _message(detail, owner, keys)
            context = {"message": message, **({"hint": hint} if hint else {})}
        kind = PydanticCustomError(_OURS, "{message}", context)
        where = tuple(part for part in place(detail["loc"]) if part != "[key]")
        details.append(InitErrorDetails(type=kind, loc=where, input=detail["input"]))
    return ValidationError.from_exception_data(error.title, details)


def untagged(value: object, handler: ValidatorFunctionWrapHandler, called: str = "this entry") -> Any:
    """Validate a member of a tagged union and return it; the paths of its faults do not contain the tag."""
    try:
        return handler(value)
    except ValidationError as error:
        raise retold(error, called, (), lambda loc: loc[1:]) from None


class WrittenModel(BaseModel):
    """The base class of a scene's entries: frozen, no unknown keys; a key without a value counts as absent."""

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)

    @model_validator(mode="wrap")
    @classmethod
    def _retell(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        """Validate without keys of empty value; Pydantic's messages are reworded."""
        if isinstance(data, (dict, Mapping)) and any(value is None for value in data.values()):
            data = {key: value for key, value in data.items() if value is not None or key not in cls.model_fields}
        try:
            return handler(data)
        except ValidationError as error:
            raise retold(error, cls.called(), tuple(cls.model_fields)) from None

    @classmethod
    def called(cls) -> str:
        """Return the name of such an entry in messages: ``a particle``."""
        name = cls.__name__.lower()
        return f"{'an' if name[0] in 'aeiou' else 'a'} {name}"


@dataclass(frozen=True)
class TaggedUnion:
    """Entries of class ``base`` that are distinguished by their ``key``, with the words of messages about them.

    ``called``: an entry, as `a constraint`; ``allowed``: the key's values, ``names`` their plural, ``listing`` the head
    of their list; ``unknown``: the message for another value {}; ``otherwise``: (message, hint) for no mapping.
    """

    base: type
    called: str
    key: str
    allowed: Collection[str]
    names: str
    listing: str
    unknown: str
    otherwise: tuple[str, str | None]
    #: Returns a hint from a value of the key that is not ``allowed`` (None: missing) and the entry, or None.
    advise: Callable[[object, Mapping[str, Any]], str | None] = lambda word, entry: None

    def validated(self, value: object, handler: ValidatorFunctionWrapHandler) -> Any:
        """Return the validated entry. Raises as Pydantic's validators do, with paths that do not contain the key."""
        if isinstance(value, (dict, Mapping)):
            word = value.get(self.key)
            if word is not None and not isinstance(word, str):
                message = f"the `{self.key}` is a text, not {in_words(word)}"
                raise fault_at((self.key,), message, self.advise(None, value))
            if word is None:
                hint = self.advise(None, value) or self.listing + ", ".join(self.allowed)
                raise fault_error(f"{self.called} needs its `{self.key}`", hint)
            if word not in self.allowed:
                hint = self.advise(word, value) or suggestion(word, list(self.allowed), self.names)
                raise fault_at((self.key,), self.unknown.format(word), hint)
        elif not isinstance(value, self.base):
            raise fault_error(*self.otherwise)
        return untagged(value, handler, self.called)
