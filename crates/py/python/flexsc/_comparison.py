"""Two answers side by side: of scenarios, runs, logs or campaigns."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from flexsc import _native as engine
from flexsc._answer import PrintedFields
from flexsc._campaign import read_campaign
from flexsc._log import Log
from flexsc._missing import reading
from flexsc._result import Result
from flexsc._scenario import Scenario
from flexsc._table import Table

if TYPE_CHECKING:
    from typing import TypeAlias

    Side: TypeAlias = "Scenario | Result | Log | Table | str | os.PathLike[str]"


class Comparison(PrintedFields):
    """Two answers side by side, as `flexsc compare` prints them.

    >>> import flexsc
    >>> scenario = flexsc.Scenario.example("half-turn")
    >>> both = flexsc.compare(scenario, scenario.with_("reference.pointing.rms", "1 arcsec"))
    >>> [answer["verdict"] for answer in both.answers]
    ['met', 'missed']
    """

    names: tuple[str, str]
    """The names of the two sides.

    >>> both.names
    ('half-turn', 'half-turn')
    """
    keys: tuple[dict[str, Any], ...]
    """The keys in which the scenarios differ, defaults included: `key`, and `texts` of both sides.

    >>> both.keys[0]["key"], both.keys[0]["texts"]
    ('reference.pointing.rms', ['7.00 arcsec', '1 arcsec'])
    """
    answers: tuple[dict[str, Any], dict[str, Any]]
    """The fields of both answers: see `Answer` and `CampaignAnswer`.

    >>> both.answers[1]["requirements"][0]["met"]
    False
    """

    def __init__(self, native: engine.RunAnswer) -> None:
        super().__init__(native)
        fields = self.to_dict()
        self.names = (fields["names"][0], fields["names"][1])
        self.keys = tuple(fields["keys"])
        self.answers = (fields["answers"][0], fields["answers"][1])

    def __repr__(self) -> str:
        return f"<flexsc.Comparison: {' and '.join(self.names)}>"


def compare(a: Side, b: Side) -> Comparison:
    """Compare two scenarios, runs, logs or campaigns: the keys that differ, and both answers.

    Args:
        a: A scenario, which is simulated, a result, a log, or the table of a campaign; or the path of one.
        b: The other one; a campaign beside a campaign.

    Raises:
        ValueError: One is a campaign, and the other is not, or a log has no scenario.

    >>> import flexsc
    >>> run = flexsc.Scenario.example("half-turn").simulate(log="none")
    >>> flexsc.compare(run, run).keys
    ()
    """
    (name_a, scenario_a, answer_a), (name_b, scenario_b, answer_b) = _side(a), _side(b)
    return Comparison(engine.compare((name_a, name_b), (scenario_a, scenario_b), (answer_a, answer_b)))


def _side(side: Side) -> tuple[str, engine.Scenario, engine.RunAnswer]:
    """Return the name, the scenario and the answer of a side."""
    if isinstance(side, str | os.PathLike):
        name = os.fspath(side)
        return (name, *_side(_read(name))[1:])
    if isinstance(side, Scenario):
        side = side.simulate(log="none")
    if isinstance(side, Log):
        scenario, answer = engine.log_answer(side._native)
        return scenario.name, scenario, answer
    answer = side.answer._native
    if answer.copied and isinstance(side, Result):
        # A copy has texts alone; the run is repeated.
        answer = side.scenario.simulate(run=side.run, log="none").answer._native
    return side.scenario.name, side.scenario._native, answer


def _read(path: str) -> Scenario | Log | Table:
    if os.path.isdir(path):
        return read_campaign(path)
    return Log(reading(path, engine.Log.open)) if path.endswith(".mcap") else Scenario.load(path)


Comparison.__module__ = "flexsc"
