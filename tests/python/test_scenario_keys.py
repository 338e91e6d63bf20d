"""Keys of a scenario: read, removed, and asked for by name; files that are missing."""

import copy
import errno
import inspect
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import flexsc
import pytest
from conftest import shipped
from flexsc import LogError, Scenario, ScenarioError
from own import Relay


def test_remarks_are_those_of_the_command() -> None:
    quiet = Scenario.example("wheel-scheduled-gain")
    assert quiet.remarks == []
    (remark,) = quiet.with_("body.planar.modes[0].damping", 5.0).remarks
    assert remark.startswith("`body.planar.modes[0].damping` is a ratio")


def test_the_value_of_a_key_is_read(sampled: Scenario) -> None:
    values = sampled.to_dict()
    assert sampled.get("law.relay.k_t") == values["law"]["relay"]["k_t"]
    assert sampled.get("body.planar.modes[2].gain") == values["body"]["planar"]["modes"][2]["gain"]
    assert sampled.get('uncertain."body.planar.angle".uniform') == [-1.5e-3, 1.5e-3]
    assert sampled.get("law") == values["law"]
    # Accepted, and without a value.
    assert sampled.get("epoch") is None
    assert sampled.get("sensor.sampled.rate_noise") is None
    for key, words in {
        "law.relay.kt": r"'law.relay' has no key 'kt'; did you mean 'k_t'\? there are dead_zone",
        "law.atitude.bandwidth": r"'law' has no key 'atitude'; there are relay",
        "epok": "no key 'epok'",
        "body.planar.modes[9].gain": r"no element 9 in 'body.planar.modes': it has 5",
        "law..k_t": "not the path of a key",
        "": "not the path of a key",
    }.items():
        with pytest.raises(KeyError, match=words):
            sampled.get(key)


def test_keys_are_removed(sampled: Scenario) -> None:
    assert sampled.without("uncertain").get("uncertain") is None
    assert sampled.without("law.relay.sides") == sampled
    shorter = sampled.without("body.planar.modes[0]", "body.planar.modes[3]", "estimator", "uncertain")
    modes = sampled.modes["frequency"]
    assert shorter.modes["frequency"].tolist() == modes[[1, 2, 4]].tolist()
    assert shorter.get("estimator") is None
    one = sampled.without('uncertain."body.planar.angle"')
    assert set(sampled.get("uncertain")) - set(one.get("uncertain")) == {"body.planar.angle"}
    with pytest.raises(ScenarioError, match="missing key `k_t`"):
        sampled.without("law.relay.k_t")
    with pytest.raises(ScenarioError, match="missing key `law`"):
        sampled.without("law")
    with pytest.raises(KeyError, match="no key 'epoch'"):
        sampled.without("epoch")


def test_own_parts_stay_when_keys_are_removed(sampled: Scenario) -> None:
    own = sampled.with_parts(law=Relay(5e-4, 1e-4, 4e-5, 1e-6, 0.31))
    assert list(own.without("uncertain").own_parts) == list(own.own_parts) == ["law"]


def test_missing_files_are_missing_files(tmp_path: Path) -> None:
    calls: list[tuple[Callable[[Any], object], type[Exception]]] = [
        (Scenario.load, ScenarioError),
        (flexsc.read_log, LogError),
        (flexsc.read_campaign, ValueError),
        (flexsc.plot.figures, LogError),
    ]
    for call, old in calls:
        for path in (tmp_path / "nowhere.toml", str(tmp_path / "nowhere")):
            with pytest.raises(FileNotFoundError) as raised:
                call(path)
            assert isinstance(raised.value, old)
            assert raised.value.errno == errno.ENOENT
            assert raised.value.filename == str(path)
            assert str(path) in str(raised.value)
            again = pickle.loads(pickle.dumps(raised.value))
            assert (str(again), again.filename) == (str(raised.value), str(path))
    with pytest.raises(ValueError, match="is not a campaign"):
        flexsc.read_campaign(tmp_path)
    with pytest.raises(ScenarioError) as other:
        Scenario.load(tmp_path)
    assert not isinstance(other.value, FileNotFoundError)


def test_simulators_are_not_copied_by_halves(fixed: Scenario) -> None:
    sims = flexsc.Simulators(fixed, 2)
    for copied in (copy.copy, copy.deepcopy):
        with pytest.raises(TypeError, match=r"`sims\[i\]` is a copy of one run"):
            copied(sims)
    assert sims[1].time == 0.0


def test_public_classes_have_public_names() -> None:
    for name in flexsc.__all__:
        thing = getattr(flexsc, name)
        if inspect.isclass(thing):
            places = ("flexsc", "flexsc.parts", "flexsc.structure")
            # Classes of the engine have the name of its module.
            assert thing.__module__ in places or name in (
                "Aim",
                "Effort",
                "Hold",
                "Load",
                "Reading",
                "ThreeAxisEvent",
                "ThreeAxisHold",
            ), name
    assert b"_scenario" not in pickle.dumps(shipped("relay-fixed"))


def test_the_keys_of_a_scenario_are_in_its_signature() -> None:
    parameters = inspect.signature(Scenario).parameters
    assert list(parameters)[:2] == ["values", "name"]
    assert {"duration", "body", "law", "sensor", "uncertain"} <= set(parameters)
    assert set(parameters) - {"values"} == set(flexsc.schema()["properties"])
    assert parameters["law"].annotation == "LawKind"


def test_a_quantity_of_pint_is_refused(fixed: Scenario) -> None:
    class Quantity:
        """A number with a unit as pint has it."""

        def to_base_units(self) -> "Quantity":
            return self

        def tolist(self) -> list[float]:
            raise AttributeError("Magnitude 'float' does not support tolist")

    with pytest.raises(ScenarioError, match=r"`duration`: found a quantity, expected its number in SI units"):
        fixed.with_("duration", Quantity())


@pytest.mark.parametrize("inertia", [[1, 2], [[1, 0, 0], [0, 1, 0]], 3.0])
def test_types_and_ranges_are_told_at_once(inertia: object) -> None:
    wrong = {
        "law.attitude.bandwidth": -1.0,
        "spacecraft.inertia": inertia,
        "sensor[0].gyro.period": -1.0,
        "actuator.wheels.torque": -5.0,
        "estimator.attitude.initial": "none",
    }
    with pytest.raises(ScenarioError) as told:
        shipped("earth-observer").with_(wrong)
    keys = [str(mistake["key"]).partition("[")[0] for mistake in told.value.mistakes]
    assert sorted(keys) == sorted(key.partition("[")[0] for key in wrong)
