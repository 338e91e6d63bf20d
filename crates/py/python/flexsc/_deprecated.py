"""Names of earlier versions: each works for one more version, with a DeprecationWarning.

Type checkers, `dir` and the documentation have the new names alone.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import wraps
from typing import Any, ParamSpec, TypeVar

C = TypeVar("C", bound=type[Any])
P = ParamSpec("P")
R = TypeVar("R")

_PAPERS = (
    "gain_region identify observer_margin observer_region persistence relay_damping rigid_cycles robust_gains"
    " stability_map"
)
# What each old name is now: members of modules and of classes, and keywords.
RENAMED = {
    **{f"flexsc.{name}": f"flexsc.papers.{name}" for name in _PAPERS.split()},
    "flexsc.Margins": "flexsc.CommonMargins",
    "flexsc.write_scenario": "flexsc.structure.write_scenario",
    "flexsc.scenario.AttitudeTarget": "flexsc.scenario.Target",
    "Linear.margins": "Linear.common_margins",
    "NoiseSpectrum.frequency": "NoiseSpectrum.frequency_hz",
    "NoiseSpectrum.nyquist": "NoiseSpectrum.nyquist_hz",
    "Scenario.parts": "Scenario.own_parts",
    "Table.worst(smallest=)": "Table.worst(least=)",
}


def of_module(module: str, name: str) -> Any:
    """Return what a module has in place of a name.

    Raises:
        AttributeError: It never had the name.
    """
    from importlib import import_module

    new = RENAMED.get(f"{module}.{name}")
    if new is None:
        raise AttributeError(f"module {module!r} has no attribute {name!r}")
    _warn(f"{module}.{name}", new, 4)
    place, _, name = new.rpartition(".")
    return getattr(import_module(place), name)


def with_old_members(kind: C) -> C:
    """Let a class have its old members."""
    name = kind.__name__
    members = {
        old.removeprefix(f"{name}."): new.removeprefix(f"{name}.")
        for old, new in RENAMED.items()
        if old.startswith(f"{name}.") and "(" not in old
    }

    def __getattr__(self: Any, member: str) -> Any:
        if member not in members:
            raise AttributeError(f"{name!r} object has no attribute {member!r}", name=member, obj=self)
        _warn(f"{name}.{member}", f"{name}.{members[member]}")
        return getattr(self, members[member])

    if members:
        kind.__getattr__ = __getattr__
    return kind


def with_old_keywords(function: Callable[P, R]) -> Callable[P, R]:
    """Let a method take its old keywords."""
    called = f"{function.__qualname__}("
    keywords = {
        old.removeprefix(called)[:-2]: new.partition("(")[2][:-2]
        for old, new in RENAMED.items()
        if old.startswith(called)
    }

    @wraps(function)
    def taking(*values: P.args, **given: P.kwargs) -> R:
        for old in keywords.keys() & given:
            _warn(f"{called}{old}=)", f"{called}{keywords[old]}=)")
            given[keywords[old]] = given.pop(old)
        return function(*values, **given)

    return taking


def _warn(old: str, new: str, level: int = 3) -> None:
    """Warn at the line of the user, this many calls above the warning."""
    warnings.warn(f"{old} is now {new}, and will be removed", DeprecationWarning, stacklevel=level)
