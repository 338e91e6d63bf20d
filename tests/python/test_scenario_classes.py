"""The classes of a scenario's parts: as the schema has them, and as good as a file."""

import copy
import dataclasses
import inspect
import pickle
import subprocess
import sys
import types
import typing
from collections.abc import Mapping, Sequence
from datetime import datetime, timezone
from typing import Any

import flexsc
import numpy as np
import numpy.typing as npt
import pytest
from conftest import SCENARIOS, class_generator, shipped
from flexsc import Scenario, ScenarioError, scenario
from flexsc._part import Part
from flexsc.scenario import (
    Gyro,
    Manoeuvre,
    Mode,
    Normal,
    Planar,
    Relay,
    SineCommand,
    StuckFault,
    Uniform,
)

ALL = sorted(path.stem for path in SCENARIOS.glob("*.toml"))


def test_the_file_is_what_the_schema_gives() -> None:
    made = class_generator("scenario_classes")
    assert made.FILE.read_text(encoding="utf-8") == made.written(flexsc.schema())


class Builder:
    """Builds the parts of a scenario from its dictionary, by the types of the classes alone."""

    def __init__(self) -> None:
        self.names = {**vars(scenario), "npt": npt}
        self.made: set[str] = set()

    def kinds(self, kind: Any) -> list[Any]:
        """The types that a type may be."""
        if isinstance(kind, str):
            kind = eval(kind, self.names)
        if isinstance(kind, typing.ForwardRef):
            return []
        if typing.get_origin(kind) in (typing.Union, types.UnionType):
            return [inner for one in typing.get_args(kind) for inner in self.kinds(one)]
        return [kind]

    def value(self, kind: Any, given: Any, bare: bool = False) -> Any:
        for one in self.kinds(kind):
            origin = typing.get_origin(one)
            origin = origin if isinstance(origin, type) else None
            if isinstance(one, type) and issubclass(one, Part):
                if one._tag is None or bare:
                    fields = {name.rstrip("_") for name in typing.get_type_hints(one, self.names)}
                    if isinstance(given, dict) and (one._holds_one or fields >= set(given)):
                        return self.part(one, given)
                elif isinstance(given, dict) and list(given) == [one._tag]:
                    return self.part(one, given[one._tag])
            elif origin is not None and issubclass(origin, Sequence) and isinstance(given, list):
                inner = typing.get_args(one)[0]
                return [self.value(inner, item) for item in given]
            elif origin is not None and issubclass(origin, Mapping) and isinstance(given, dict):
                inner = typing.get_args(one)[1]
                return {key: self.value(inner, item) for key, item in given.items()}
        assert not isinstance(given, dict), (kind, given)
        return given

    def part(self, kind: Any, given: Any) -> Any:
        self.made.add(kind.__name__)
        keyed = {name: field.type for name, field in kind.__dataclass_fields__.items() if name[0] != "_"}
        if kind._holds_one:
            return kind(self.value(keyed["value"], given))
        keys = {name.rstrip("_"): name for name in keyed}
        return kind(
            **{
                keys[key]: self.value(keyed[keys[key]], item, key in kind._bare)
                for key, item in given.items()
            }
        )


def test_every_scenario_can_be_built_of_them() -> None:
    builder = Builder()
    keys = typing.get_type_hints(scenario.Keys, {**vars(scenario), "npt": npt})
    for name in ALL:
        values = shipped(name).to_dict()
        built = {key: builder.value(keys[key], value) for key, value in values.items() if key != "name"}
        made = Scenario(name=values["name"], **built)
        assert made == shipped(name), name
        assert hash(made) == hash(shipped(name))
        assert Scenario.parse(made.to_toml()) == made
    # Most of what there is.
    there = {
        name for name, kind in vars(scenario).items() if isinstance(kind, type) and issubclass(kind, Part)
    }
    assert len(builder.made) > 0.6 * len(there), sorted(there - builder.made)


def test_parts_are_values_of_keys() -> None:
    adaptive = shipped("relay-adaptive")
    law = Relay(dead_zone=5e-4, hysteresis=1e-4, strong=4e-5, weak=1e-6, k_t=0.34)
    changed = adaptive.with_({"law": law, "body.planar.modes": [Mode(frequency=0.5, gain=0.02)]})
    assert changed.to_dict()["law"]["relay"]["k_t"] == 0.34
    assert changed.modes["frequency"].tolist() == [0.5]
    noisy = shipped("relay-sampled").with_("uncertain", {"law.relay.k_t": Uniform([0.3, 0.32])})
    assert noisy.to_dict()["uncertain"] == {"law.relay.k_t": {"uniform": [0.3, 0.32]}}
    mixed = Scenario(
        {"body": {"planar": {}}, "law": law}, duration=10.0, epoch=datetime(2026, 3, 1, tzinfo=timezone.utc)
    )
    assert mixed.duration == 10.0
    assert mixed.to_dict()["epoch"].year == 2026
    # A key that is given as a keyword counts.
    assert Scenario(mixed.to_dict(), duration=20.0, name="mine").name == "scenario"


def test_parts_are_immutable_values() -> None:
    law = Relay(dead_zone=5e-4, hysteresis=1e-4, strong=4e-5, weak=1e-6, k_t=0.34)
    assert law == copy.deepcopy(law) == pickle.loads(pickle.dumps(law))
    assert hash(law) == hash(copy.copy(law))
    assert law != Relay(dead_zone=5e-4, hysteresis=1e-4, strong=4e-5, weak=1e-6, k_t=0.33)
    assert repr(law) == "Relay(dead_zone=0.0005, hysteresis=0.0001, strong=4e-05, weak=1e-06, k_t=0.34)"
    with pytest.raises(AttributeError):
        law.k_t = 0.3  # type: ignore[misc]
    with pytest.raises(TypeError):
        Relay(0.3)  # type: ignore[call-arg]
    assert Relay in typing.get_args(scenario.LawKind)


def test_parts_with_lists_and_arrays_compare_and_hash() -> None:
    for noise in ([1e-6, 1e-6, 2e-6], np.array([1e-6, 1e-6, 2e-6])):
        gyro = Gyro(period=0.1, noise=noise, faults=[StuckFault(from_=10.0, to=20.0)])
        assert gyro == Gyro(period=0.1, noise=(1e-6, 1e-6, 2e-6), faults=[StuckFault(from_=10.0, to=20.0)])
        assert gyro != Gyro(period=0.1, noise=(1e-6, 1e-6, 3e-6))
        assert len({gyro, copy.deepcopy(gyro), pickle.loads(pickle.dumps(gyro))}) == 1


def test_parts_are_dataclasses_to_those_who_ask() -> None:
    mode = Mode(frequency=0.5, gain=0.02)
    assert dataclasses.is_dataclass(mode)
    assert dataclasses.replace(mode, gain=0.03) == Mode(frequency=0.5, gain=0.03)
    assert [field.name for field in dataclasses.fields(Uniform)] == ["value"]
    assert dataclasses.asdict(mode)["frequency"] == 0.5
    with pytest.raises(dataclasses.FrozenInstanceError):
        delattr(mode, "gain")
    match Uniform([0.1, 0.2]):
        case Uniform(limits):
            assert limits == [0.1, 0.2]


def test_wrong_keys_of_a_part_are_named() -> None:
    wrong: Any = Mode
    with pytest.raises(TypeError, match=r"Mode has no key 'frequenzy'; did you mean 'frequency'\? there are"):
        wrong(frequenzy=0.5, gain=0.02)
    with pytest.raises(TypeError, match="Mode needs 'frequency'"):
        wrong(gain=0.02)
    with pytest.raises(TypeError, match="Mode takes keywords only: frequency, "):
        wrong(0.5)
    wrong = Uniform
    with pytest.raises(TypeError, match="Uniform got 'value' twice"):
        wrong([0.1, 0.2], value=[0.1, 0.2])


def test_the_keys_of_a_part_are_in_its_signature_and_docstring() -> None:
    parts = [getattr(scenario, name) for name in scenario.__all__]
    classes = [part for part in parts if isinstance(part, type) and issubclass(part, Part)]
    assert len(classes) > 130
    for part in classes:
        parameters = inspect.signature(part).parameters
        assert tuple(parameters) == part._names
        needed = tuple(name for name, given in parameters.items() if given.default is inspect.Parameter.empty)
        assert needed == part._needed
        if not part._holds_one and part._names:
            text = inspect.getdoc(part) or ""
            assert all(f"\n    {name}: " in text for name in part._names), part
    assert "period: Period of its samples (s)." in (inspect.getdoc(scenario.Accelerometer) or "")


def test_no_name_means_two_things() -> None:
    package = {*flexsc.__all__, *flexsc.parts.__all__, *flexsc.structure.__all__, *flexsc.plot.__all__}
    assert package & set(scenario.__all__) == set()
    assert typing.get_args(scenario.LawKind)[0] is Relay


def test_the_classes_are_imported_quickly() -> None:
    code = (
        "import flexsc, sys, time; began = time.process_time(); "
        "import flexsc.scenario; print(time.process_time() - began, 'dataclasses' in sys.modules)"
    )
    times = []
    for _ in range(5):
        done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
        seconds, brings_dataclasses = done.stdout.split()
        assert brings_dataclasses == "False"
        times.append(float(seconds))
    # Also where Python may not keep what it compiled, which takes about 30 ms.
    assert min(times) < (0.02 if not sys.flags.dont_write_bytecode else 0.1)


def test_kinds_have_their_names_where_they_need_one() -> None:
    assert Normal(mean=1.0, sd=0.1).to_dict() == {"normal": {"mean": 1.0, "sd": 0.1}}
    fault = StuckFault(from_=10.0, to=20.0)
    assert fault.to_dict() == {"stuck": {"from": 10.0, "to": 20.0}}
    gyro = Gyro(period=0.1, faults=[fault], noise=np.full(3, 1e-6))
    assert gyro.to_dict()["gyro"]["faults"] == [{"stuck": {"from": 10.0, "to": 20.0}}]
    planned = Manoeuvre(angle=1.0, time=20.0, command=SineCommand(suppress=1), model=Planar(inertia=2.0))
    assert planned.to_dict()["model"] == {"inertia": 2.0}
    assert planned.to_dict()["command"] == {"sine": {"suppress": 1}}


def test_all_mistakes_are_told_with_their_keys() -> None:
    law = Relay(dead_zone=5e-4, hysteresis=1e-4, strong=-4e-5, weak=1e-6, k_t=3.4)
    with pytest.raises(ScenarioError) as raised:
        Scenario(duration=-1.0, body=Planar(), law=law)
    assert {mistake["key"] for mistake in raised.value.mistakes} >= {
        "duration",
        "law.relay.strong",
        "law.relay.k_t",
    }
    with pytest.raises(ScenarioError, match="unknown key `wings`"):
        Scenario(duration=1.0, body=Planar(), law=law, wings=2)  # type: ignore[call-arg]


def test_scenarios_are_keys_of_a_dictionary() -> None:
    fixed = shipped("relay-fixed")
    other = fixed.with_("law.relay.k_t", 0.32)
    counted = {fixed: 1, other: 2}
    assert counted[Scenario(fixed.to_dict())] == 1
    assert counted[copy.copy(other)] == 2
    positive, negative = (fixed.with_("body.planar.rate", zero) for zero in (0.0, -0.0))
    assert positive == negative
    assert hash(positive) == hash(negative)


def test_a_path_may_have_the_name_of_the_kind() -> None:
    observer = flexsc.Scenario.example("earth-observer")
    wheels = scenario.Wheels(arrangement="pyramid", inertia=0.05, torque=0.3, momentum=10.0)
    by_kind = observer.with_("actuator.wheels", wheels)
    assert by_kind == observer.with_("actuator", wheels)
    assert by_kind.get("actuator.wheels.torque") == 0.3
    with pytest.raises(flexsc.ScenarioError, match="actuator"):
        observer.with_("actuator.torque", wheels)
