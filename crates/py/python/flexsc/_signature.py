"""Signatures of constructors that take their keywords from annotations, for `help` and notebooks."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from inspect import Signature


class LateSignature:
    """A signature that is made when it is first read: `inspect` takes long to import."""

    def __init__(self, make: Callable[[type[Any]], Signature]) -> None:
        self._make = make

    def __get__(self, instance: object, owner: type[Any]) -> Signature:
        return self._make(owner)


def of_scenario(_: type[object]) -> Signature:
    """Return the signature of `Scenario` with its keys in place of `**keys`."""
    from inspect import Parameter, Signature

    from flexsc.scenario import Keys

    positional = [
        Parameter(
            "values", Parameter.POSITIONAL_OR_KEYWORD, default=None, annotation="Mapping[str, object] | None"
        ),
        Parameter("name", Parameter.POSITIONAL_OR_KEYWORD, default="scenario", annotation="str"),
    ]
    keys = [
        Parameter(
            key, Parameter.KEYWORD_ONLY, default=None, annotation=getattr(kind, "__forward_arg__", kind)
        )
        for key, kind in Keys.__annotations__.items()
    ]
    return Signature([*positional, *keys])
