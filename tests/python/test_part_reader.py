"""The parts of a scenario, taken out as classes, changed and put back."""

import dataclasses
from collections.abc import Iterator, Mapping
from typing import Any

import flexsc
import pytest
from conftest import SCENARIOS, shipped
from flexsc import Scenario
from flexsc._part import Part
from flexsc.scenario import (
    AttitudeLaw,
    ControlMomentGyros,
    Gyro,
    Mode,
    Planar,
    Relay,
    StarTracker,
    StuckFault,
    Uniform,
    Wheels,
)
from own import Relay as OwnRelay

ALL = sorted(path.stem for path in SCENARIOS.glob("*.toml"))
WORDS = (str, int, float, bool, type(None))


def parts_of(value: Any, at: str, found: dict[str, Part]) -> None:
    """Collects all parts within a value by where they are; a dictionary in place of one is an error."""
    if isinstance(value, Part):
        found[at] = value
        for name, inner in value._given().items():
            parts_of(inner, f"{at}.{name}", found)
    elif isinstance(value, Mapping):
        assert value, at
        # Ranges by the names of signals are numbers.
        assert not any(isinstance(inner, Mapping) for inner in value.values()), at
        for name, inner in value.items():
            parts_of(inner, f"{at}[{name}]", found)
    elif isinstance(value, list):
        for place, inner in enumerate(value):
            parts_of(inner, f"{at}[{place}]", found)
    else:
        assert isinstance(value, WORDS) or at.endswith("epoch"), (at, value)


@pytest.mark.parametrize("name", ALL)
def test_a_scenario_is_equal_when_each_part_is_taken_out_and_put_back(name: str) -> None:
    scenario = shipped(name)
    parts = {key: scenario.part(key) for key in scenario.to_dict()}
    found: dict[str, Part] = {}
    for key, part in parts.items():
        parts_of(part, key, found)
        if isinstance(part, Part) or (isinstance(part, list) and any(isinstance(one, Part) for one in part)):
            back = scenario.with_(key, part)
            assert back == scenario, key
            assert back.part(key) == part
        if isinstance(part, list):
            for place, one in enumerate(part):
                assert scenario.part(f"{key}[{place}]") == one
                assert scenario.with_(f"{key}[{place}]", one) == scenario
    assert len(found) > 2
    whole = Scenario(**parts)
    assert whole == scenario
    assert whole.to_toml() == scenario.to_toml()


def tables(value: Any, at: str) -> Iterator[tuple[str, dict[str, Any]]]:
    """The tables within a value of a scenario, of lists the first one, by their paths."""
    if isinstance(value, dict):
        yield at, value
        for name, inner in value.items():
            yield from tables(inner, f'{at}."{name}"')
    elif isinstance(value, list):
        yield from tables(value[0] if value else None, f"{at}[0]")


@pytest.mark.parametrize("name", ALL)
def test_the_path_of_each_table_leads_to_its_part(name: str) -> None:
    scenario = shipped(name)
    for key, value in scenario.to_dict().items():
        for path, table in tables(value, key):
            part = scenario.part(path)
            if isinstance(part, Part):
                assert table in (part.to_dict(), part._content()), path
            else:
                assert not any(isinstance(one, Mapping) for one in part.values()), path


def test_most_classes_of_parts_are_in_the_shipped_scenarios() -> None:
    found: dict[str, Part] = {}
    for name in ALL:
        for key in shipped(name).to_dict():
            parts_of(shipped(name).part(key), f"{name}.{key}", found)
    there = {
        name
        for name, kind in vars(flexsc.scenario).items()
        if isinstance(kind, type) and issubclass(kind, Part) and kind is not Part
    }
    taken = {type(part).__name__ for part in found.values()}
    assert len(taken) > 0.6 * len(there), sorted(there - taken)


def test_what_was_put_in_comes_out() -> None:
    """Each kind of form: a kind, a list, a table, a word, one value, a name that Python keeps."""
    law = Relay(dead_zone=5e-4, hysteresis=1e-4, strong=4e-5, weak=1e-6, k_t=0.31)
    body = Planar(angle=4.5e-4, modes=[Mode(frequency=0.44, gain=0.0213)])
    spread = {"law.relay.k_t": Uniform([0.3, 0.32])}
    scenario = Scenario(name="mine", duration=60.0, body=body, law=law, uncertain=spread)
    assert scenario.part("uncertain") == spread
    relay = scenario.part("law", Relay)
    assert {name: getattr(relay, name) for name in ("dead_zone", "strong", "k_t")} == {
        "dead_zone": 5e-4,
        "strong": 4e-5,
        "k_t": 0.31,
    }
    assert scenario.part("law.relay") == relay
    assert scenario.part("body.planar.modes[0]", Mode).gain == 0.0213
    assert scenario.part('uncertain."law.relay.k_t".uniform') == Uniform([0.3, 0.32])
    assert scenario.part('uncertain."law.relay.k_t".uniform[1]') == 0.32
    assert scenario.part("duration") == 60.0
    assert scenario.part("name") == "mine"
    assert scenario.part("sensor") == "continuous"
    assert scenario.part("epoch") is None
    fault = StuckFault(from_=10.0, to=20.0)
    observer = shipped("earth-observer")
    gyro = observer.part("sensor[0]", Gyro)
    faulty = observer.with_("sensor[0]", dataclasses.replace(gyro, faults=[fault]))
    back = faulty.part("sensor[0]", Gyro)
    assert back.faults == [fault]
    assert faulty.part("sensor[0].gyro.faults[0].stuck") == fault
    assert faulty.get("sensor[0].gyro.faults[0].stuck.from") == 10.0


def test_parts_are_changed_as_dataclasses() -> None:
    observer = shipped("earth-observer")
    wheels = observer.part("actuator", Wheels)
    limit = observer.get("actuator.wheels.torque")
    assert wheels.torque == limit
    weaker = observer.with_("actuator", dataclasses.replace(wheels, torque=0.5 * limit))
    assert weaker.get("actuator.wheels.torque") == 0.5 * limit
    assert weaker.with_("actuator.wheels.torque", limit) == observer
    tracker = observer.part("sensor[1]", StarTracker)
    moved = observer.with_("sensor[1]", dataclasses.replace(tracker, period=2.0))
    assert moved.get("sensor[1].star_tracker.period") == 2.0
    assert moved.get("sensor[0]") == observer.get("sensor[0]")
    law = observer.part("law", AttitudeLaw)
    assert law.bandwidth is not None
    fast = observer.with_("law", dataclasses.replace(law, bandwidth=2.0 * law.bandwidth))
    assert fast.with_("law.attitude.bandwidth", law.bandwidth) == observer


def test_a_part_of_another_class_is_refused() -> None:
    observer = shipped("earth-observer")
    with pytest.raises(TypeError, match="`actuator` is no ControlMomentGyros, but Wheels"):
        observer.part("actuator", ControlMomentGyros)
    with pytest.raises(TypeError, match="`sensor` is no Gyro, but list"):
        observer.part("sensor", Gyro)
    with pytest.raises(KeyError, match="no key 'actuators'; did you mean 'actuator'"):
        observer.part("actuators")
    with pytest.raises(KeyError, match="no element 7 in 'sensor'"):
        observer.part("sensor[7]")
    own = shipped("relay-fixed").with_parts(law=OwnRelay(5e-4, 1e-4, 4e-5, 1e-6, 0.31))
    with pytest.raises(ValueError, match=r"`law` has a part of your own: `Scenario\.own_parts` has it"):
        own.part("law")
    assert own.part("body", Planar) == shipped("relay-fixed").part("body")
