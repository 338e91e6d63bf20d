"""The answer of a run or a campaign: what was asked, whether it is met, by how much, and when not."""

from __future__ import annotations

import json
from typing import Any

from flexsc import _native as engine


class PrintedFields:
    """Fields of the engine, and the text that the command prints of them."""

    def __init__(self, native: engine.RunAnswer) -> None:
        self._native = native

    def to_dict(self) -> dict[str, Any]:
        """Return the fields as dictionaries and lists, as `flexsc simulate --json` has them.

        >>> import flexsc
        >>> answer = flexsc.Scenario.example("half-turn").simulate(log="none").answer
        >>> answer.to_dict()["schema"]
        'flexsc-answer-1'
        """
        fields: dict[str, Any] = json.loads(self._native.json())
        return fields

    def text(self, *, all: bool = False) -> str:
        """Return the first screen, or everything that is known.

        Args:
            all: Everything: each event, and lines that the first screen leaves out.

        >>> import flexsc
        >>> answer = flexsc.Scenario.example("half-turn").simulate(log="none").answer
        >>> print(answer.text().splitlines()[2])
          ✓ pointing   1.82 arcsec   at most 7 arcsec   margin 74 %
        """
        return self._native.screen(all)

    def __str__(self) -> str:
        return self.text()

    def __eq__(self, other: object) -> bool:
        return self.to_dict() == other.to_dict() if isinstance(other, type(self)) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._native.json())

    def _repr_html_(self) -> str:
        from html import escape

        return f"<pre>{escape(self.text())}</pre>"


class _AnswerFields(PrintedFields):
    """Fields that the answers of runs and of campaigns have."""

    verdict: str
    verdict_text: str
    requirements: tuple[dict[str, Any], ...]
    warnings: tuple[dict[str, Any], ...]
    by_mode: tuple[dict[str, Any], ...]

    def __init__(self, native: engine.RunAnswer) -> None:
        super().__init__(native)
        fields = self.to_dict()
        self.verdict, self.verdict_text = fields["verdict"], fields["verdict_text"]
        for name in ("requirements", "warnings", "by_mode"):
            setattr(self, name, tuple(fields.get(name, ())))

    def __repr__(self) -> str:
        return f"<flexsc.{type(self).__name__}: {self.verdict_text}>"


class Answer(_AnswerFields):
    """The answer of a run: its verdict, requirements, warnings, modes of operation and events.

    As text it is the first screen of `flexsc simulate`, in the units of the limits.

    >>> import flexsc
    >>> answer = flexsc.Scenario.example("half-turn").simulate(log="none").answer
    >>> answer.verdict, answer.requirements[0]["text"]["value"], answer.requirements[0]["text"]["limit"]
    ('met', '1.82 arcsec', '7 arcsec')
    """

    verdict: str
    """`failed`, `missed`, `met_but` (a warning says that target, filter or loop is lost), `met`, `goal_met`,
    `goal_missed`, or `not_asked` without a requirement.

    >>> answer.verdict
    'met'
    """
    verdict_text: str
    """The verdict in words.

    >>> answer.verdict_text
    '1 of 1 requirement met'
    """
    requirements: tuple[dict[str, Any], ...]
    """The requirements, missed ones first, then by margin: `id`, `name`, `unit`, `limit` and `value` in SI,
    `margin`, `met`, `largest` with its instant, and the same as `text` in the unit of the limit.

    >>> answer.requirements[0]["met"], round(answer.requirements[0]["margin"], 3)
    (True, 0.74)
    """
    warnings: tuple[dict[str, Any], ...]
    """The warnings, the gravest first: `kind`, `text`, and `mode` where one is concerned.

    >>> answer.warnings
    ()
    """
    by_mode: tuple[dict[str, Any], ...]
    """The modes of operation: `mode`, `visits`, `time_s`, and `error_rad` with `rms`, `median`, `p95`,
    `largest` and `at_s`.

    >>> answer.by_mode
    ()
    """
    events: tuple[dict[str, Any], ...]
    """Stays in modes, actuators at limits, losses of the target, eclipses, blinding and failures: `kind`,
    `part`, `from_s`, `to_s`.

    >>> answer.events
    ()
    """

    def __init__(self, native: engine.RunAnswer) -> None:
        super().__init__(native)
        self.events = tuple(self.to_dict().get("events", ()))

    def robustness(self, name: str) -> float:
        """Return (limit - value)/limit of a requirement: how far it is from failing; negative if it fails.

        Infinity if nothing in the run was to meet it, NaN if the run ends too early or has no value.

        Args:
            name: Name of the requirement.

        >>> round(answer.robustness("pointing"), 3)
        0.74
        """
        for own in self.requirements:
            if own["name"] == name:
                missing = float("inf") if own["decision"] == "not_exercised" else float("nan")
                return float(own.get("margin", missing))
        names = ", ".join(f"`{own['name']}`" for own in self.requirements) or "none"
        raise KeyError(f"no requirement `{name}`; the requirements are {names}")


class CampaignAnswer(_AnswerFields):
    """The answer of a campaign: how many runs meet what is asked, by how much, and what drives it.

    As text it is the first screen of `flexsc simulate --runs`, in the units of the limits.

    >>> import flexsc
    >>> table = flexsc.campaign(flexsc.Scenario.example("half-turn"), runs=20)
    >>> answer = table.answer
    >>> answer.runs, answer.runs_met == int((table["requirement"] == "met").sum())
    (20, True)
    """

    verdict: str
    """`missed`, `met_but` (a warning says that target, filter or loop is lost in some run), `met`,
    `goal_met`, `goal_missed`, or `not_asked` without a requirement.

    >>> answer.verdict
    'missed'
    """
    verdict_text: str
    """The verdict in words.

    >>> answer.verdict_text.startswith("MISSED: ")
    True
    """
    runs: int
    """The number of runs.

    >>> answer.runs
    20
    """
    runs_met: int | None
    """The number of runs that meet all requirements, or the goal; None if nothing is asked.

    >>> 0 < answer.runs_met < 20
    True
    """
    share_interval: tuple[float, float] | None
    """The 95 % interval of the probability that a run meets them (Wilson); None if nothing is asked.

    >>> low, high = answer.share_interval
    >>> low < answer.runs_met / answer.runs < high
    True
    """
    requirements: tuple[dict[str, Any], ...]
    """The requirements, missed ones first, then by margin: `limit`, `median`, `p95`, `worst` with its `run`,
    `margin`, `runs_met`, `share_interval`, the keys it is `driven_by`, and the same as `text`.

    >>> answer.requirements[0]["driven_by"][0]["key"]
    'spacecraft.inertia[2][2]'
    """
    warnings: tuple[dict[str, Any], ...]
    """The warnings, the gravest first: `kind`, `mode`, the number of `runs` with it, `worst_run` and `text`.

    >>> answer.warnings
    ()
    """
    by_mode: tuple[dict[str, Any], ...]
    """The modes of operation: `mode`, the number of `runs` that enter it, `time_s` and `at_limit_s` with
    `median`, `p95` and `largest`, and `runs_lost`, those that lose its target.

    >>> answer.by_mode
    ()
    """

    def __init__(self, native: engine.RunAnswer) -> None:
        super().__init__(native)
        fields = self.to_dict()
        self.runs, self.runs_met = fields["runs"], fields.get("runs_met")
        interval = fields.get("share_interval")
        self.share_interval = None if interval is None else (interval[0], interval[1])


Answer.__module__ = CampaignAnswer.__module__ = "flexsc"
