"""The states that copies of a run begin from: those of simulators and snapshots."""

from __future__ import annotations

from collections.abc import Generator, Iterable
from contextlib import ExitStack, contextmanager
from typing import TypeAlias

from flexsc._scenario import Scenario
from flexsc._simulator import Simulator, Snapshot

Source: TypeAlias = Simulator | Snapshot
"""The present state of a simulator, or the state that a snapshot saved."""


def parse_sources(given: object) -> list[Source]:
    """Return one source, or several, as a list.

    Raises:
        TypeError: One is neither a `Simulator` nor a `Snapshot`.
    """
    sources: list[Source] = []
    for one in given if isinstance(given, Iterable) else [given]:
        if not isinstance(one, (Simulator, Snapshot)):
            raise TypeError(f"a state is that of a Simulator or a Snapshot, got {type(one).__name__}")
        sources.append(one)
    return sources


@contextmanager
def held(sources: Iterable[Source]) -> Generator[None]:
    """Keep other threads from advancing the simulators among the sources."""
    with ExitStack() as locks:
        simulators = {id(one): one for one in sources if isinstance(one, Simulator)}
        # In the same order in all threads.
        for _, one in sorted(simulators.items()):
            locks.enter_context(one._lock)
        yield


def check_scenarios(
    sources: Iterable[Source], accepted: list[Scenario], drawn: Iterable[Scenario] = ()
) -> None:
    """Check that each source is of an accepted scenario, or of the first as drawn for the run of the source.

    Raises:
        ValueError: One is of another scenario.
    """
    known = {id(scenario) for scenario in [*accepted, *drawn]}
    for one in sources:
        scenario, first = one.scenario, accepted[0]
        if id(scenario) in known:
            continue
        if scenario not in accepted and first.draw(one.run) != scenario:
            raise ValueError(
                f"{one!r} is of another scenario; accepted are states of {first!r} with its values, or with "
                f"those that `draw({one.run})` sets"
            )
        known.add(id(scenario))
