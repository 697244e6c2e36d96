"""How exact arithmetic fails: one name for every reason why there is no value, FLINT's own reasons included."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

from flint.utils.flint_exceptions import DomainError

from dofkit.base.errors import NoValueError, PoleError

__all__ = ["NoPointError", "NoValueError", "OutsideDomainError", "PoleError", "TooLargeError", "raising_no_value"]

P = ParamSpec("P")
T = TypeVar("T")


class TooLargeError(NoValueError):
    """The canonical form grew past its bound, or needs a root of a quotient."""

    reason = "a canonical form grew past its bound"


class OutsideDomainError(NoValueError):
    """A function has no real value at the point."""

    reason = "a function has no real value at the point"


class NoPointError(NoValueError):
    """No point was found at this draw (a radicand is no square, a division by zero)."""

    reason = "no point was found"


def raising_no_value(work: Callable[P, T]) -> Callable[P, T]:
    """Return ``work``, whose divisions by zero are PoleErrors, and FLINT's errors about a domain NoValueErrors."""

    @wraps(work)
    def wrapper(*args: P.args, **kwargs: P.kwargs) -> T:
        try:
            return work(*args, **kwargs)
        except NoValueError:
            raise
        except ZeroDivisionError as error:
            raise PoleError(str(error)) from error
        except DomainError as error:
            raise NoValueError(str(error)) from error

    return wrapper
