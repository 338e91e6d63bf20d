"""Requirements over time as parts of a scenario."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from flexsc.scenario import Requirement


def requirement(holds: str, name: str = "", **keys: Any) -> Requirement:
    """Return a requirement that something holds over time, for the key `requirement` of a scenario.

    Args:
        holds: What holds, such as `"always[60 s, 300 s] pointing_error < 0.1 deg"`; the language is that of
            `[[requirement]]`.
        name: Its name; default: the text.
        keys: Other keys of `[[requirement]]`, such as `mode` or `level`.

    >>> import flexsc
    >>> fine = flexsc.requirement("always[13 s, end] pointing_error < 20 arcsec", "fine")
    >>> scenario = flexsc.Scenario.example("half-turn").with_("requirement", [fine])
    >>> answer = scenario.simulate(log="none").answer
    >>> answer.verdict, 0 < answer.robustness("fine") < 1
    ('met', True)
    """
    from flexsc.scenario import Requirement

    return Requirement(name=name or holds, holds=holds, **keys)
