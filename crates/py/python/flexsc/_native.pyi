"""The engine, as `flexsc` calls it. Not for users: what is here may change at any time."""

import os
from collections.abc import Sequence
from typing import Any, Final, TypeAlias, final

import numpy as np
import numpy.typing as npt

__all__ = [
    "Directory",
    "Log",
    "LogError",
    "Scenario",
    "ScenarioError",
    "SimulationError",
    "Work",
    "__version__",
    "examples",
    "gain_regions_json",
    "identify_json",
    "main",
    "metrics_json",
    "observer_margin_json",
    "observer_region_json",
    "persistence",
    "plan_json",
    "plan_torque",
    "relay_damping_json",
    "rigid_cycles_json",
    "rivals_json",
    "robust_gains_json",
    "schema_json",
    "simulate",
    "stability_map_json",
    "to_mcap",
    "topics_json",
    "write",
]

__version__: Final[str]

_Column: TypeAlias = (
    npt.NDArray[np.float64]
    | npt.NDArray[np.int64]
    | npt.NDArray[np.uint64]
    | list[str]
    | tuple[npt.NDArray[np.uint8], list[str]]
    | tuple[npt.NDArray[np.uint32], dict[str, _Column]]
)

_Summary: TypeAlias = tuple[str, str, int, float, float, list[tuple[float, float]]]

class ScenarioError(ValueError):
    """A scenario, or a key of it, that is not accepted."""

    mistakes: list[dict[str, Any]]

class SimulationError(RuntimeError):
    """A simulation that cannot go on."""

class LogError(OSError):
    """A log that cannot be read or written."""

@final
class Scenario:
    @staticmethod
    def load(path: str | os.PathLike[str]) -> Scenario: ...
    @staticmethod
    def parse(text: str, name: str) -> Scenario: ...
    @staticmethod
    def from_values(text: str, name: str) -> Scenario: ...
    def with_keys(self, keys: Sequence[tuple[str, str]]) -> Scenario: ...
    def draw(self, run: int) -> Scenario: ...
    @property
    def name(self) -> str: ...
    @property
    def seed(self) -> int: ...
    @property
    def duration(self) -> float: ...
    @property
    def mode_count(self) -> int: ...
    @property
    def spatial(self) -> bool: ...
    def modes_json(self) -> str: ...
    def to_toml(self) -> str: ...
    def to_json(self) -> str: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    __hash__ = None  # type: ignore[assignment]

@final
class Work:
    @staticmethod
    def of(
        scenario: Scenario,
        runs: tuple[int, int],
        grids: list[tuple[str, list[float]]],
        sampling: str,
        replicas: int,
        metrics: list[str] | None,
        part_s: float | None,
        yes: bool,
    ) -> Work: ...
    @staticmethod
    def parse(manifest: str) -> Work: ...
    def difference(self, there: Work) -> str | None: ...
    @property
    def manifest(self) -> str: ...
    @property
    def hash(self) -> str: ...
    @property
    def runs(self) -> tuple[int, int]: ...
    @property
    def keys(self) -> list[str]: ...
    @property
    def names(self) -> list[str]: ...
    @property
    def scenario(self) -> Scenario: ...
    def missing(self, files: list[str]) -> list[tuple[int, int]]: ...
    def make(self, runs: tuple[int, int], jobs: int) -> tuple[dict[str, Any], list[_Summary]]: ...
    def part(self, runs: tuple[int, int], jobs: int) -> tuple[str, bytes]: ...

@final
class Directory:
    @staticmethod
    def create(path: str | os.PathLike[str], work: Work, force: bool) -> Directory: ...
    @staticmethod
    def open(path: str | os.PathLike[str]) -> Directory: ...
    @property
    def work(self) -> Work: ...
    def missing(self) -> list[tuple[int, int]]: ...
    def write_part(self, runs: tuple[int, int], jobs: int) -> str: ...
    def column(self, name: str) -> Any: ...
    def statistics(self) -> list[_Summary]: ...

@final
class Log:
    @staticmethod
    def open(path: str | os.PathLike[str]) -> Log: ...
    @property
    def topics(self) -> list[str]: ...
    @property
    def metadata(self) -> dict[str, str]: ...
    @property
    def scenario(self) -> str | None: ...
    def columns(self, topic: str) -> dict[str, _Column]: ...

def simulate(
    scenario: Scenario, run: int, log: str, yes: bool
) -> tuple[dict[str, Any], dict[str, dict[str, _Column]]]: ...
def to_mcap(scenario: Scenario, run: int, log: str, path: str | os.PathLike[str]) -> int: ...
def rigid_cycles_json(scenario: Scenario) -> str: ...
def plan_json(scenario: Scenario, band: float) -> str: ...
def plan_torque(scenario: Scenario, times: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]: ...
def rivals_json(scenario: Scenario, band: float, peak_torque: float | None) -> str: ...
def gain_regions_json(
    scenario: Scenario,
    frequencies: Sequence[float],
    gains: tuple[float, float, float],
    limit: float,
    settled: tuple[float | None, float, bool, bool],
) -> str: ...
def robust_gains_json(
    scenario: Scenario,
    frequencies: Sequence[float],
    gains: tuple[float, float, float],
    off: tuple[float, float],
    goal: tuple[bool, float, float],
    settled: tuple[float | None, float, bool, bool],
) -> str: ...
def stability_map_json(
    scenario: Scenario,
    frequencies: Sequence[float],
    periods: Sequence[float],
    gain: float | None,
    settled: tuple[float | None, float, bool, bool],
) -> str: ...
def relay_damping_json(
    frequencies: Sequence[float],
    relay: tuple[float, float, float],
    mode: tuple[float, float],
    amplitudes: tuple[float, float],
) -> str: ...
def observer_region_json(
    observer: tuple[tuple[float, float, float], float, float, float], kappa: float, elastic: Sequence[float]
) -> str: ...
def observer_margin_json(
    observer: tuple[tuple[float, float, float], float, float, float], kappas: Sequence[float]
) -> str: ...
def identify_json(
    modes: Sequence[tuple[float, float]],
    off: tuple[float, float],
    rate: float,
    extent: tuple[int, int, int],
    yes: bool,
) -> str: ...
def persistence(sensitivities: npt.NDArray[np.float64]) -> float: ...
def write(path: str | os.PathLike[str], text: str) -> None: ...
def examples() -> list[tuple[str, str]]: ...
def schema_json() -> str: ...
def metrics_json() -> str: ...
def topics_json() -> str: ...
def main(args: Sequence[str]) -> int: ...
