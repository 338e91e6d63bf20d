"""Scenarios as files have them: read, written, compared and shown."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from flexsc import _native as engine
from flexsc._missing import reading
from flexsc._named import no_such
from flexsc._signature import LateSignature, of_scenario
from flexsc._values import counted, document, plain

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    from typing_extensions import Self, Unpack

    from flexsc.scenario import Keys


class ScenarioFile:
    """The content of a scenario file."""

    __slots__ = ("_native",)
    _native: engine.Scenario
    if not TYPE_CHECKING:
        # For `help`, and for the completion of keys in notebooks.
        __signature__ = LateSignature(of_scenario)

    def __init__(
        self, values: Mapping[str, object] | None = None, name: str = "scenario", **keys: Unpack[Keys]
    ) -> None:
        if values is not None and not isinstance(values, Mapping):
            hint = "Scenario.load reads a file, Scenario.parse a text"
            raise TypeError(f"a scenario is made of a dict, not of a {type(values).__name__}; {hint}")
        given = {key: value for key, value in keys.items() if value is not None}
        text = document(name, {"name": name, **(values or {}), **given})
        self._native = engine.Scenario.from_values(text, name)

    @classmethod
    def _of(cls, native: engine.Scenario) -> Self:
        scenario = cls.__new__(cls)
        scenario._native = native
        return scenario

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Self:
        """Read a scenario file.

        >>> import flexsc, pathlib, tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     path = pathlib.Path(folder) / "mine.toml"
        ...     length = path.write_text(flexsc.Scenario.example("relay-fixed").to_toml())
        ...     flexsc.Scenario.load(path)
        <flexsc.Scenario relay-fixed: 20000 s, 2 modes, seed 1>

        Raises:
            FileNotFoundError: There is no such file. The error is a `ScenarioError` too.
            ScenarioError: The file cannot be read or is not accepted; the text gives the line, the key and
                the accepted values.
        """
        return cls._of(reading(path, engine.Scenario.load))

    @classmethod
    def parse(cls, text: str, name: str = "scenario") -> Self:
        """Read a scenario from TOML text. `name` is its name if the text has none; it is also used in errors.

        >>> import flexsc
        >>> text = "duration = 60.0\\n[body.planar]\\nangle = 1e-3\\n[law.open]"
        >>> flexsc.Scenario.parse(text, "drifting")
        <flexsc.Scenario drifting: 60 s, 0 modes, seed 0>

        Raises:
            ScenarioError: The text is not accepted.
        """
        return cls._of(engine.Scenario.parse(text, name))

    @classmethod
    def example(cls, name: str) -> Self:
        """Read a shipped scenario by its name, one of `flexsc.examples()`.

        >>> import flexsc
        >>> flexsc.Scenario.example("relay-fixed").duration
        20000.0

        Raises:
            KeyError: There is no scenario of this name.
        """
        examples = dict(engine.examples())
        if name not in examples:
            raise no_such("no example", name, examples)
        return cls.parse(examples[name], name)

    @property
    def name(self) -> str:
        """Name of the study.

        >>> flexsc.Scenario.example("relay-fixed").name
        'relay-fixed'
        """
        return self._native.name

    @property
    def seed(self) -> int:
        """Seed of all randomness.

        >>> flexsc.Scenario.example("relay-fixed").with_("seed", 3).seed
        3
        """
        return self._native.seed

    @property
    def duration(self) -> float:
        """Simulated time (s).

        >>> flexsc.Scenario.example("relay-fixed").duration
        20000.0
        """
        return self._native.duration

    @property
    def remarks(self) -> list[str]:
        """Remarks on values that are accepted and probably not meant, such as a damping ratio above 1.

        The command prints them as notes before a run.

        >>> scenario = flexsc.Scenario.example("wheel-scheduled-gain")
        >>> scenario.with_("body.planar.modes[0].damping", 5.0).remarks[0].partition(" and ")[0]
        '`body.planar.modes[0].damping` is a ratio,'
        """
        return self._native.remarks

    @property
    def modes(self) -> dict[str, npt.NDArray[np.float64]]:
        """The elastic modes, as arrays of shape (modes,).

        For a single-axis body: `frequency` (rad/s), `period` (s), `damping` (ratio), `gain` (response of the
        angle per unit of reduced torque), `excitability`, the gain divided by the squared frequency (s²),
        `effective_inertia`, the gain times the moment of inertia (kg m²), and `free_frequency` and
        `clamped_frequency` (rad/s), with the hub free and with the hub held; NaN where a value does not
        apply.

        For a spatial body: `frequency`, `period` and `damping`, and `influence` of shape (modes, 3): the jump
        of the elastic rate at the gyro per jump of the rigid rate that the jets cause about x, y and z.

        >>> flexsc.Scenario.example("relay-fixed").modes["period"].round(2).tolist()         # s
        [14.28, 8.32]
        """
        from flexsc._modes import modes

        return modes(self._native)

    @property
    def outputs(self) -> dict[str, npt.NDArray[np.float64]]:
        """The observed coordinates by name: their weights on rigid angle and modes, of shape (1 + modes,).

        >>> list(flexsc.Scenario.example("rotation-robust").outputs)
        ['section_1', 'section_2', 'section_3', 'section_4']
        """
        from flexsc._modes import outputs

        return outputs(self._native)

    def to_dict(self) -> dict[str, Any]:
        """The scenario with all its defaults, as a dictionary that `Scenario(...)` accepts.

        >>> import flexsc
        >>> flexsc.Scenario.example("relay-fixed").to_dict()["law"]["relay"]["k_t"]
        0.31
        """
        values: dict[str, Any] = plain(self._native.to_json())
        return values

    def to_toml(self) -> str:
        """The scenario with all its defaults, as TOML.

        >>> import flexsc
        >>> flexsc.Scenario.example("relay-fixed").to_toml().splitlines()[0]
        'name = "relay-fixed"'
        """
        return self._native.to_toml()

    def __eq__(self, other: object) -> bool:
        return self._native == other._native if isinstance(other, ScenarioFile) else NotImplemented

    def __hash__(self) -> int:
        # Two scenarios are equal with zeros of either sign, but differ as texts.
        return hash(self.to_toml().replace("-0.0", "0.0"))

    def __repr__(self) -> str:
        return f"<flexsc.Scenario {self.name}: {self._about()}>"

    def _about(self) -> str:
        return f"{self.duration:g} s, {counted(self._native.mode_count, 'mode')}, seed {self.seed}"

    def _repr_html_(self) -> str:
        from flexsc import _html

        values = self.to_dict()
        figure = engine.modes_figure(self._native)
        text = _html.folded("all keys", _html.pre(self.to_toml()))
        shown = _html.picture(figure) if figure else ""
        return _html.heading(self.name, self._about()) + _html.line(values.get("about", "")) + shown + text
