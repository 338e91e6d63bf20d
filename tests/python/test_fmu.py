"""FMUs: read, checked and run by FMPy, an importer of others, and equal to the native run."""

import shutil
import zipfile
from collections.abc import Callable, Iterator
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any, Literal

import flexsc
import numpy as np
import pytest
from conftest import shipped
from flexsc._fmi_library import fmi_library

fmpy = pytest.importorskip("fmpy", reason="FMPy imports FMUs: pip install fmpy")

SCENARIOS = ["relay-fixed", "wheel-fixed-gain", "earth-observer", "station-keeping"]
PARTS: list[Literal["loop", "plant"]] = ["loop", "plant"]
Part = Literal["loop", "plant", "controller"]
Exported = Callable[..., str]


def export(directory: Path, name: str, fmi: Literal[2, 3] = 3, part: Part = "loop", **keys: Any) -> str:
    """Exports the FMU of a shipped scenario."""
    path = directory / f"{name}-{fmi}-{part}.fmu"
    shipped(name).with_(keys).export_fmu(path, fmi=fmi, part=part)
    return str(path)


@pytest.fixture(scope="module")
def exported(tmp_path_factory: pytest.TempPathFactory) -> Exported:
    """Returns the path of the FMU of a shipped scenario, which is exported once."""

    @cache
    def exported(name: str, fmi: Literal[2, 3] = 3, part: Part = "loop", **keys: Any) -> str:
        return export(tmp_path_factory.mktemp("fmu"), name, fmi, part, **keys)

    return exported


@pytest.fixture(scope="module", autouse=True)
def names_are_parsed_once() -> Iterator[None]:
    """Lets FMPy parse each name of a variable once: it takes most of the time of a validation."""
    lark: Any = import_module("lark")
    parse = lark.Lark.parse

    @cache
    def parsed(grammar: str, text: str) -> object:
        return parse(grammars[grammar], text)

    def once(self: Any, text: str) -> object:
        grammars[self.source_grammar] = self
        return parsed(self.source_grammar, text)

    grammars: dict[str, Any] = {}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(lark.Lark, "parse", once)
        yield


@pytest.mark.parametrize("name", SCENARIOS)
@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("part", PARTS)
def test_descriptions_are_valid(
    exported: Exported, name: str, fmi: Literal[2, 3], part: Literal["loop", "plant"]
) -> None:
    from fmpy.validation import validate_fmu

    path = exported(name, fmi, part)
    assert validate_fmu(path) == []
    described = fmpy.read_model_description(path)
    names = {variable.name for variable in described.modelVariables}
    assert {"time", "events", "seed", "snap_ns"} < names
    assert described.coSimulation.canGetAndSetFMUstate if fmi == 2 else described.coSimulation.hasEventMode
    for variable in described.modelVariables:
        assert variable.description


def test_units_have_exponents_of_base_units(exported: Exported) -> None:
    described = fmpy.read_model_description(exported("earth-observer"))
    units = {unit.name: unit.baseUnit for unit in described.unitDefinitions}
    torque = units["N m"]
    assert (torque.kg, torque.m, torque.s, torque.rad) == (1, 2, -2, 0)
    assert (units["rad/s"].rad, units["rad/s"].s) == (1, -1)
    assert units["m sqrt(kg)"] is None


def test_a_relay_has_the_switchings_of_the_native_run(exported: Exported) -> None:
    path = exported("relay-fixed", duration=400.0)
    rows = shipped("relay-fixed").with_("duration", 400.0).simulate(log="events")["command"]
    expected = list(zip(rows["time_whole_s"], rows["time_fs"], rows["torque_nm"], strict=True))
    for size in [0.1, 0.37, 1 / 3, 400.0]:
        result = fmpy.simulate_fmu(
            path,
            stop_time=400.0,
            output_interval=size,
            use_event_mode=True,
            early_return_allowed=True,
            output=["switchings", "event_whole_s", "event_fs", "command"],
        )
        # The first row of each number of switchings is that of the event.
        _, first = np.unique(result["switchings"], return_index=True)
        found = [(row["event_whole_s"], row["event_fs"], row["command"]) for row in result[first[1:]]]
        assert found == expected, size


@pytest.mark.parametrize("name", SCENARIOS)
def test_both_versions_and_the_event_mode_have_equal_points(exported: Exported, name: str) -> None:
    state = "state.angle" if "body" in shipped(name).to_dict() else "state.error[1]"
    outputs = [state, "events"]

    def run(fmi: Literal[2, 3], **options: Any) -> dict[float, tuple[float, ...]]:
        path = exported(name, fmi, duration=20.0)
        result = fmpy.simulate_fmu(path, stop_time=20.0, output_interval=0.25, output=outputs, **options)
        return {row["time"]: tuple(row[output] for output in outputs) for row in result}

    second, third = run(2), run(3)
    events = run(3, use_event_mode=True, early_return_allowed=True)
    assert second == third
    assert len(third) == 81
    assert all(events[time] == values for time, values in third.items())


def test_a_plant_takes_commands(exported: Exported) -> None:
    path = exported("wheel-fixed-gain", 3, "plant", duration=20.0)
    dtype = [("time", float), ("disturbance_torque", float)]
    pushed = np.array([(0.0, 0.0), (5.0, 0.0), (5.0, 1e-3), (20.0, 1e-3)], dtype=dtype)
    result = fmpy.simulate_fmu(path, stop_time=20.0, input=pushed, output=["state.rate"], output_interval=1.0)
    free = fmpy.simulate_fmu(path, stop_time=20.0, output=["state.rate"], output_interval=1.0)
    same = result["state.rate"] == free["state.rate"]
    assert same[:6].all()
    assert not same[7:].any()


def test_two_exports_have_equal_bytes(tmp_path: Path) -> None:
    (tmp_path / "again").mkdir()
    for fmi in (2, 3):
        first, second = (export(path, "relay-fixed", fmi) for path in (tmp_path, tmp_path / "again"))
        assert Path(first).read_bytes() == Path(second).read_bytes()
        with zipfile.ZipFile(first) as archive:
            assert {entry.date_time for entry in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}


LAWS = [("wheel-fixed-gain", 0.3), ("earth-observer", 0.25), ("station-keeping", 0.5)]


def slave(path: str, fmi: Literal[2, 3]) -> tuple[Any, dict[str, int]]:
    """An initialized instance of an FMU, with points on a grid of 1 ns, and its references by name."""
    described = fmpy.read_model_description(path)
    references = {variable.name: variable.valueReference for variable in described.modelVariables}
    arguments = {
        "guid": described.guid,
        "unzipDirectory": fmpy.extract(path),
        "modelIdentifier": described.coSimulation.modelIdentifier,
        "instanceName": "part",
    }
    if fmi == 2:
        instance = fmpy.fmi2.FMU2Slave(**arguments)
        instance.instantiate()
        instance.setReal([references["snap_ns"]], [1.0])
        instance.setupExperiment(startTime=0.0)
    else:
        instance = fmpy.fmi3.FMU3Slave(**arguments)
        instance.instantiate()
        instance.enterConfigurationMode()
        instance.setUInt64([references["snap_ns"]], [1])
        instance.exitConfigurationMode()
    instance.enterInitializationMode()
    instance.exitInitializationMode()
    return instance, references


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize(("name", "period"), LAWS)
def test_plant_and_controller_equal_the_closed_loop(
    exported: Exported, name: str, period: float, fmi: Literal[2, 3]
) -> None:
    from fmpy.validation import validate_fmu

    count = 60
    parts: list[Part] = ["plant", "controller", "loop"]
    paths = {part: exported(name, fmi, part) for part in parts}
    # The others are those of the test of descriptions.
    assert validate_fmu(paths["controller"]) == []
    (plant, plant_names), (laws, law_names) = slave(paths["plant"], fmi), slave(paths["controller"], fmi)
    described = fmpy.read_model_description(paths["controller"])
    variables = [of for of in described.modelVariables if of.causality == "input" and of.type != "Clock"]
    inputs = [of.name for of in variables if of.name in plant_names]
    commands = [of.name for of in described.modelVariables if of.name.split("[")[0] == "command"]
    axes = "" if len(commands) == 1 else "[1]"
    read, write = ("getReal", "setReal") if fmi == 2 else ("getFloat64", "setFloat64")

    def copy(source: Any, own: dict[str, int], to: Any, others: dict[str, int], names: list[str]) -> None:
        values = getattr(source, read)([own[variable] for variable in names])
        getattr(to, write)([others[variable] for variable in names], list(values))

    (loop, loop_names), states, expected = slave(paths["loop"], fmi), [], []
    rate = "state.rate" + axes
    for index in range(count):
        now, size = index * period, (index + 1) * period - index * period
        copy(plant, plant_names, laws, law_names, inputs)
        laws.doStep(now, size)
        copy(laws, law_names, plant, plant_names, commands)
        plant.doStep(now, size)
        loop.doStep(now, size)
        states.append(getattr(plant, read)([plant_names[rate]])[0])
        expected.append(getattr(loop, read)([loop_names[rate]])[0])
    for instance in (plant, laws, loop):
        instance.terminate()
        instance.freeInstance()
    assert states == expected


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("text", [b"", b"duration = ", b"\xff\x00", None])
def test_damaged_resources_are_refused(exported: Exported, fmi: Literal[2, 3], text: bytes | None) -> None:
    unpacked = fmpy.extract(exported("relay-fixed", fmi))
    resource = Path(unpacked) / "resources" / "scenario.toml"
    if text is None:
        resource.unlink()
    else:
        resource.write_bytes(text)
    told: list[bytes] = []
    with pytest.raises(Exception, match=r"[Ii]nstanti"):
        fmpy.simulate_fmu(unpacked, stop_time=1.0, logger=lambda *values: told.append(values[-1]))
    assert len(told) == 1
    shutil.rmtree(unpacked)


def test_what_cannot_be_exported_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "x.fmu"
    scenario = flexsc.Scenario.example("relay-fixed")
    with pytest.raises(ValueError, match="controller"):
        scenario.export_fmu(path, part="controller")
    with pytest.raises(ValueError, match="library"):
        scenario.export_fmu(path, library=tmp_path / "absent.so")
    # The library of the package is in an archive; FMUs have it as it is.
    damaged = tmp_path / "damaged.zip"
    damaged.write_bytes(fmi_library().read_bytes()[:1000])
    with pytest.raises(ValueError, match="cannot unpack the library of FMUs"):
        scenario.export_fmu(path, library=damaged)
    with zipfile.ZipFile(fmi_library()) as archive:
        [name] = archive.namelist()
        (tmp_path / name).write_bytes(archive.read(name))
    scenario.export_fmu(tmp_path / "plain.fmu", library=tmp_path / name)
    scenario.export_fmu(tmp_path / "packed.fmu")
    assert (tmp_path / "plain.fmu").read_bytes() == (tmp_path / "packed.fmu").read_bytes()
    assert not path.exists()
