"""Signals of parts written in Python: columns of the log, and errors that name the role and the shape."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import flexsc
import numpy as np
import pytest
from flexsc.parts import Demanded, Draws, Event, Known, Setting, Taken, Truth

PLANAR = """
duration = 10.0
log.period = 0.5
[law.open]
[body.planar]
inertia = 100.0
angle = 2e-3
[sensor.sampled]
period = 0.25
"""
SPATIAL = """
duration = 5.0
log.period = 0.5
[law.open]
[body.spatial]
inertia = [[100, 0, 0], [0, 80, 0], [0, 0, 60]]
rate = [1e-3, 2e-3, 3e-3]
[sensor.sampled]
period = 0.25
"""


class Law(flexsc.Law):
    period = 0.25
    signals = {"sum": "rad s"}  # noqa: RUF012
    sum: Any = 0.0

    def decide(self, event: Event) -> flexsc.Hold:
        self.sum += event.angle * 0.25
        return flexsc.Hold(-4.0 * event.angle - 30.0 * event.rate)


class Estimator(flexsc.Estimator):
    signals = {"covariance": ("rad²", 2)}  # noqa: RUF012

    def start(self, known: Known) -> None:
        self.covariance: Any = [1.0, 2.0]

    def take(self, taken: Taken) -> Any:
        self.covariance = [0.5 * value for value in self.covariance]
        return taken.measured


class Sensor(flexsc.Sensor):
    period = 0.25
    signals = {"samples": ""}  # noqa: RUF012

    def start(self, axes: int, draws: Draws) -> None:
        self.samples = 0

    def read(self, truth: Truth) -> flexsc.Reading:
        self.samples += 1
        if truth.angle is None:
            return flexsc.Reading(attitude=truth.attitude)
        return flexsc.Reading(angle=truth.angle)


class Actuator(flexsc.Actuator):
    signals = {"demanded": "N m"}  # noqa: RUF012

    def start(self, settings: list[Setting]) -> None:  # type: ignore[override]
        self.demanded = 0.0

    def command(self, demanded: Demanded) -> list[float]:
        self.demanded = demanded.values[0]
        return demanded.values


def own(text: str = PLANAR, **parts: Any) -> flexsc.Scenario:
    given: dict[str, Any] = {
        "law": Law(),
        "estimator": Estimator(),
        "sensor": Sensor(),
        "actuator": Actuator(),
        **parts,
    }
    return flexsc.Scenario.parse(text, "own").with_parts(**given)


class Sliding(flexsc.Law):
    period = 0.25
    signals = {"mode": str, "s": "rad/s"}  # noqa: RUF012

    def start(self, authority: flexsc.parts.Authority) -> None:
        self.mode: Any = "REACH"
        self.s = 0.0

    def decide(self, event: Event) -> flexsc.Hold:
        self.s = event.rate + 0.2 * event.angle
        self.mode = "SLIDE" if abs(self.s) < 3e-4 else "REACH"
        return flexsc.Hold(-30.0 * self.s)


@pytest.mark.parametrize("text", [PLANAR, SPATIAL])
def test_words_are_columns_of_a_log(tmp_path: Path, text: str) -> None:
    run = own(text, law=Sliding()).simulate(log="full")
    rows = run["own_law"]
    expected = np.where(np.abs(rows["s"]) < 3e-4, "SLIDE", "REACH")
    assert set(expected) == {"REACH", "SLIDE"}
    assert rows["mode"].tolist() == expected.tolist()
    path = tmp_path / "run.mcap"
    run.to_mcap(path)
    log = flexsc.read_log(path)
    assert log["own_law"]["mode"].tolist() == expected.tolist()
    for mode, error in ((3, "the signal mode must be a str, got"), ("a\nb", "a word of at most 64 bytes")):

        class Wrong(Sliding):
            word: Any = mode

            def decide(self, event: Event) -> flexsc.Hold:
                self.mode = self.word
                return flexsc.Hold(0.0)

        with pytest.raises((TypeError, ValueError), match=error):
            own(text, law=Wrong()).simulate(log="full")


def test_signals_are_columns_of_a_log(tmp_path: Path) -> None:
    scenario = own()
    run = scenario.simulate(log="full")
    assert list(run["own_law"]) == ["time_s", "axis", "sum"]
    assert list(run["own_estimator"]) == ["time_s", "covariance0", "covariance1"]
    samples = run["own_sensor"]["samples"]
    np.testing.assert_array_equal(samples, 1.0 + np.floor(run["own_sensor"]["time_s"] / 0.25))
    np.testing.assert_allclose(run["own_estimator"]["covariance1"], 2.0 * 0.5**samples)
    np.testing.assert_allclose(run["own_actuator"]["demanded"], run["torque"]["feedback_nm"])
    # The same in a file, and again: copies begin anew.
    again = scenario.simulate(log="full")
    path = tmp_path / "run.mcap"
    again.to_mcap(path)
    log = flexsc.read_log(path)
    for topic in ("own_law", "own_estimator", "own_sensor", "own_actuator"):
        for column, values in run[topic].items():
            np.testing.assert_array_equal(log[topic][column], values, f"{topic}.{column}")


def test_a_law_about_each_axis_says_which() -> None:
    law = own(SPATIAL, estimator=None).simulate(log="full")["own_law"]
    np.testing.assert_array_equal(law["axis"][:3], [0.0, 1.0, 2.0])
    last = law["sum"][-3:]
    # Of rates of 1, 2 and 3 mrad/s.
    assert 0.0 < last[0] < last[1] < last[2]


@pytest.mark.parametrize(
    ("changes", "error", "why"),
    [
        ({"signals": ["sum"]}, TypeError, "law: signals must map each attribute to its unit"),
        ({"signals": {"sum": 3}}, TypeError, r"law: signals must map.*got sum: 3"),
        ({"signals": {"Sum": ""}}, ValueError, "law: signals: topic `/own_law`, field `Sum`"),
        ({"signals": {"axis": ""}}, ValueError, "field `axis`: is given twice"),
    ],
)
def test_declarations_are_checked(changes: dict[str, Any], error: type[Exception], why: str) -> None:
    law = Law()
    for name, value in changes.items():
        setattr(law, name, value)
    with pytest.raises(error, match=why):
        own(law=law)


def test_values_are_checked() -> None:
    law = Law()
    law.sum = np.zeros(3)
    with pytest.raises(TypeError, match=r"law: the signal sum must be a number, got shape \(3,\)"):
        own(law=law).simulate(log="full")

    class Long(Estimator):
        def take(self, taken: Taken) -> Any:
            self.covariance = np.zeros((2, 2)) if taken.time > 1.0 else [1.0, 2.0, 3.0]
            return taken.measured

    with pytest.raises(
        TypeError, match=r"estimator: the signal covariance must be of shape \(2,\), got shape \(3,\)"
    ):
        own(estimator=Long()).simulate(log="full")

    class Missing(Law):
        signals = {"nowhere": ""}  # noqa: RUF012

    with pytest.raises(AttributeError, match="nowhere"):
        own(law=Missing()).simulate(log="full")
    # Without a full log nothing is read.
    own(law=Missing()).simulate()
    compiled = flexsc.CompiledLaw(12345, period=0.25)
    compiled.signals = {"x": ""}
    with pytest.raises(ValueError, match="a compiled law has no signals"):
        own(law=compiled)


def test_answers_of_another_shape_name_the_role() -> None:
    class Wrong(Estimator):
        returns: Any = None

        def take(self, taken: Taken) -> Any:
            return self.returns

    wrong = Wrong()
    for returns, found in [
        ([0.0, 0.0], r"got shape \(2,\)"),
        (np.zeros((3, 2)), r"got shape \(3, 2\)"),
        (1.0, "got float"),
        ([[0.0, 0.0, 0.0]], r"got shape \(1, 3\)"),
    ]:
        wrong.returns = returns
        with pytest.raises(ValueError, match=rf"estimator: an estimate must be of shape \(1, 2\).*{found}"):
            own(estimator=wrong).simulate()

    class Weak(Actuator):
        def command(self, demanded: Demanded) -> Any:
            return 0.0

    with pytest.raises(
        ValueError, match=r"actuator: command must return finite torques of shape \(1,\).*got float"
    ):
        own(actuator=Weak()).simulate()

    class Silent(flexsc.Law):
        period = 1.0

        def decide(self, event: Event) -> Any:
            return [1.0, 2.0]

    with pytest.raises(TypeError, match=r"law: decide must return a flexsc\.Hold or a .*, got shape \(2,\)"):
        own(law=Silent()).simulate()

    class Blind(Sensor):
        def read(self, truth: Truth) -> Any:
            return 1.0

    with pytest.raises(TypeError, match=r"sensor: read must return a flexsc\.Reading or None, got float"):
        own(sensor=Blind()).simulate()


def test_a_law_that_would_never_be_called_again_is_an_error() -> None:
    class Once(flexsc.Law):
        def __init__(self, **hold: Any) -> None:
            self.hold = hold

        def decide(self, event: Event) -> flexsc.Hold:
            return flexsc.Hold(1e-6, **self.hold)

    with pytest.raises(ValueError, match=r"law has no period and its hold gives no time.*called again"):
        own(law=Once()).simulate()
    for hold in ({"after": 1.0}, {"at_least": 1.0}, {"at_most": -1.0}):
        own(law=Once(**hold)).simulate()
