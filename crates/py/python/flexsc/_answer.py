"""The answer of a run: what was asked, whether it is met, by how much, and when not."""

from __future__ import annotations

import json
from typing import Any

from flexsc import _native as engine


class Answer:
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
    """Stays in modes, losses of the target, blinding and failures: `kind`, `part`, `from_s`, `to_s`.

    >>> answer.events
    ()
    """

    def __init__(self, native: engine.RunAnswer) -> None:
        self._native = native
        fields = self.to_dict()
        self.verdict, self.verdict_text = fields["verdict"], fields["verdict_text"]
        for name in ("requirements", "warnings", "by_mode", "events"):
            setattr(self, name, tuple(fields.get(name, ())))

    def to_dict(self) -> dict[str, Any]:
        """Return the fields as dictionaries and lists, as `flexsc simulate --json` has them.

        >>> answer.to_dict()["schema"]
        'flexsc-answer-1'
        """
        fields: dict[str, Any] = json.loads(self._native.json())
        return fields

    def text(self, *, all: bool = False) -> str:
        """Return the first screen, or everything that is known.

        Args:
            all: Everything: each event, and lines that the first screen leaves out.

        >>> print(answer.text().splitlines()[2])
          ✓ pointing   1.82 arcsec   at most 7 arcsec   margin 74 %
        """
        return self._native.screen(all)

    def __str__(self) -> str:
        return self.text()

    def __repr__(self) -> str:
        return f"<flexsc.Answer: {self.verdict_text}>"

    def __eq__(self, other: object) -> bool:
        return self.to_dict() == other.to_dict() if isinstance(other, Answer) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._native.json())

    def _repr_html_(self) -> str:
        from html import escape

        return f"<pre>{escape(self.text())}</pre>"


Answer.__module__ = "flexsc"
