"""Controller FMUs with sources, compiled: equal to the native run and to its calls of flight code."""

import itertools
import json
import shutil
import struct
import subprocess
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Literal

import pytest
from conftest import shipped

fmpy = pytest.importorskip("fmpy", reason="FMPy imports FMUs: pip install fmpy")

FMI = Literal[2, 3]
FLAGS = ["-std=c99", "-O2", "-shared", "-fPIC", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror"]


class Instance:
    """An instance of an FMU whose variables have names."""

    def __init__(self, path: Path, fmi: FMI, folder: str | None = None) -> None:
        described = fmpy.read_model_description(str(path))
        self.fmi = fmi
        self.variables = {variable.name: variable for variable in described.modelVariables}
        kind = fmpy.fmi2.FMU2Slave if fmi == 2 else fmpy.fmi3.FMU3Slave
        self.slave = kind(
            guid=described.guid,
            unzipDirectory=folder or fmpy.extract(str(path)),
            modelIdentifier=described.coSimulation.modelIdentifier,
            instanceName="part",
        )
        self.slave.instantiate()

    def start(self) -> None:
        if "snap_ns" in self.variables and self.fmi == 3:
            self.slave.enterConfigurationMode()
            self.slave.setUInt64([self.variables["snap_ns"].valueReference], [1])
            self.slave.exitConfigurationMode()
        elif "snap_ns" in self.variables:
            self["snap_ns"] = 1.0
        if self.fmi == 2:
            self.slave.setupExperiment(startTime=0.0)
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()

    def access(self, verb: str, name: str) -> Any:
        is_integer = self.fmi == 3 and self.variables[name].type == "Int64"
        return getattr(self.slave, verb + ("Real" if self.fmi == 2 else "Int64" if is_integer else "Float64"))

    def __getitem__(self, name: str) -> Any:
        return self.access("get", name)([self.variables[name].valueReference])[0]

    def __setitem__(self, name: str, value: Any) -> None:
        self.access("set", name)([self.variables[name].valueReference], [value])

    def named(self, *causalities: str) -> list[str]:
        return [name for name, variable in self.variables.items() if variable.causality in causalities]


def compiled(path: Path, fmi: FMI) -> Instance:
    """An instance of an FMU with sources, compiled by the compiler of this machine."""
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("a C compiler builds the sources: install gcc")
    described = fmpy.read_model_description(str(path))
    [configuration] = described.buildConfigurations
    folder = fmpy.extract(str(path))
    sources = Path(folder) / "sources"
    library = Path(folder) / "binaries" / (fmpy.platform if fmi == 2 else fmpy.platform_tuple)
    library.mkdir(parents=True)
    files = [str(sources / name) for name in configuration.sourceFileSets[0].sourceFiles]
    out = str(library / (configuration.modelIdentifier + fmpy.sharedLibraryExtension))
    subprocess.run([compiler, *FLAGS, "-o", out, *files, "-lm"], check=True)
    return Instance(path, fmi, folder)


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("name", ["earth-observer", "cubesat-day", "relay-fixed", "attitude-hold"])
def test_descriptions_are_valid_and_sources_small(tmp_path: Path, name: str, fmi: FMI) -> None:
    from fmpy.validation import validate_fmu

    path = tmp_path / "x.fmu"
    assert shipped(name).export_fmu(path, fmi=fmi, part="controller", sources=True) < 100_000
    assert validate_fmu(str(path)) == []
    names = zipfile.ZipFile(path).namelist()
    assert not [entry for entry in names if entry.startswith("binaries/")]
    assert ("sources/buildDescription.xml" in names) == (fmi == 3)
    compiled(path, fmi).start()


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize(
    ("name", "period", "count"),
    [("earth-observer", 0.05, 800), ("station-keeping", 0.5, 60), ("wheel-fixed-gain", 0.3, 60)],
)
def test_a_plant_and_sources_equal_the_closed_loop(
    tmp_path: Path, name: str, period: float, count: int, fmi: FMI
) -> None:
    paths = {part: tmp_path / f"{part}.fmu" for part in ("plant", "loop", "controller")}
    shipped(name).export_fmu(paths["plant"], fmi=fmi, part="plant")
    shipped(name).export_fmu(paths["loop"], fmi=fmi)
    shipped(name).export_fmu(paths["controller"], fmi=fmi, part="controller", sources=True)
    plant, loop, laws = (
        Instance(paths["plant"], fmi),
        Instance(paths["loop"], fmi),
        compiled(paths["controller"], fmi),
    )
    inputs = laws.named("input")
    assert set(inputs) <= set(plant.variables)
    commands = [name for name in laws.variables if name.split("[")[0] == "command"]
    rates = [name for name in plant.variables if name.split("[")[0] == "state.rate"]
    for instance in (plant, loop, laws):
        instance.start()
    saved = None
    for index in range(count):
        now, size = index * period, (index + 1) * period - index * period
        for variable in inputs:
            laws[variable] = plant[variable]
        if index == count // 2:
            # A state that is restored, also from its bytes, changes nothing.
            saved = laws.slave.getFMUState() if fmi == 3 else laws.slave.getFMUstate()
            laws.slave.doStep(now, size)
            if fmi == 3:
                laws.slave.setFMUState(laws.slave.deserializeFMUState(laws.slave.serializeFMUState(saved)))
            else:
                laws.slave.setFMUstate(laws.slave.deSerializeFMUstate(laws.slave.serializeFMUstate(saved)))
        laws.slave.doStep(now, size)
        for variable in commands:
            plant[variable] = laws[variable]
        plant.slave.doStep(now, size)
        loop.slave.doStep(now, size)
        assert [plant[rate] for rate in rates] == [loop[rate] for rate in rates], index


SENSORS = ["gyro", "magnetometer", "sun_sensor", "star_tracker"]
# Variables of the readings of `cubesat-day`, by the inputs of its flight code.
READINGS = {
    "gyro_rate": "gyro.rate",
    "magnetometer_vector": "magnetometer.field",
    "magnetometer_reference": "magnetometer.reference",
    "sun_sensor_vector": "sun_sensor.direction",
    "sun_sensor_reference": "sun_sensor.reference",
    "star_tracker_attitude": "star_tracker.attitude",
    "target_attitude": "reference.attitude",
    "reference_angle": "reference.angle",
    "reference_rate": "reference.rate",
    "reference_acceleration": "reference.acceleration",
    "wheel_speed": "wheels.speed",
}
OUTPUTS = {"torque": "command", "field_rate": "estimate.field_rate"}


def calls(folder: Path) -> Iterator[tuple[str, tuple[int, int], dict[str, list[Any]], dict[str, list[Any]]]]:
    """The calls of the run in `vectors.bin`: function, time, inputs and outputs."""
    functions = json.loads((folder / "sat.icd.json").read_text())["functions"]
    words = memoryview((folder / "vectors.bin").read_bytes()).cast("Q")
    at = 2

    def values(channels: list[dict[str, Any]]) -> dict[str, list[Any]]:
        nonlocal at
        found = {}
        for channel in channels:
            own = [words[at + index] for index in range(channel["count"])]
            if channel["type"] == "double":
                own = [struct.unpack("d", struct.pack("Q", word))[0] for word in own]
            found[channel["name"]] = own
            at += channel["count"]
        return found

    while at < len(words):
        function, now = functions[words[at]], (words[at + 1], words[at + 2])
        at += 3
        yield (
            function["function"].removeprefix("sat_"),
            now,
            values(function["inputs"]),
            values(function["outputs"]),
        )


def spread(name: str, values: list[Any]) -> Iterator[tuple[str, Any]]:
    """The variables of an array with their values."""
    for index, value in enumerate(values):
        yield (name if len(values) == 1 else f"{name}[{index + 1}]"), value


def set_inputs(laws: Instance, function: str, now: tuple[int, int], inputs: dict[str, list[Any]]) -> None:
    """Sets what a call of flight code reads; a reading with its time."""
    for name, values in inputs.items():
        sensor = next((own for own in SENSORS if name.startswith(own)), None)
        if sensor is not None and not inputs[f"{sensor}_is_valid"][0]:
            continue
        if name.endswith("_is_valid"):
            laws[f"{sensor}.time_whole_s"], laws[f"{sensor}.time_fs"] = now
        elif name in READINGS:
            is_test = function == "supervise" and name == "target_attitude"
            for variable, value in spread("conditions.attitude" if is_test else READINGS[name], values):
                laws[variable] = value


def test_modes_in_sources_equal_the_calls_of_the_run(tmp_path: Path) -> None:
    # Slow enough to leave `detumble` after a minute.
    scenario = shipped("cubesat-day").with_("spacecraft.rate", [0.002, -0.001, 0.001])
    scenario.export_c(tmp_path / "flight", name="sat", calls=12_000)
    scenario.export_fmu(tmp_path / "x.fmu", part="controller", sources=True)
    laws = compiled(tmp_path / "x.fmu", 3)
    laws.start()
    groups = [
        (now, list(group))
        for now, group in itertools.groupby(calls(tmp_path / "flight"), lambda call: call[1])
    ]
    seconds = [now[0] + now[1] * 1e-15 for now, _ in groups]
    seen, modes = 0, set()
    for (now, group), here, then in zip(groups, seconds, seconds[1:], strict=False):
        for function, _, inputs, _ in group:
            if function not in ("start", "field"):
                set_inputs(laws, function, now, inputs)
        laws.slave.doStep(here, then - here)
        expected: dict[str, Any] = {}
        for function, _, _, outputs in group:
            if function in ("field", "step", "unload"):
                for name, values in outputs.items():
                    expected.update(spread(OUTPUTS.get(name, name), values))
            modes.update(outputs.get("mode", []))
        assert {name: laws[name] for name in expected} == expected, here
        seen += len(expected)
    assert modes == {0, 1, 2}
    assert seen > 10_000


def test_what_cannot_be_exported_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="sources"):
        shipped("earth-observer").export_fmu(tmp_path / "x.fmu", sources=True)
    with pytest.raises(ValueError, match="adaptation"):
        shipped("relay-adaptive").export_fmu(tmp_path / "x.fmu", part="controller", sources=True)
    assert not list(tmp_path.iterdir())
