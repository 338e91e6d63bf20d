"""Exact, fast and reproducible simulation of attitude control of flexible spacecraft.

A scenario gives a result whose data are columns:

    >>> import flexsc, numpy
    >>> scenario = flexsc.Scenario.example("relay-adaptive")
    >>> result = scenario.simulate()
    >>> round(result.metrics["gain_final"], 4), result.metrics.unit("cycle_period_s")
    (0.3389, 's')
    >>> result["command"]["time_s"].shape == result["command"]["state"].shape
    True
    >>> round(result.at(12.5)["attitude"]["angle_rad"], 9)
    9.298e-06
    >>> table = flexsc.sweep(scenario, "law.relay.k_t", numpy.linspace(0.28, 0.40, 3))
    >>> table["envelope_late_mean_rad"].shape
    (3,)

All numbers are in SI units; the names of columns and metrics end with their units. A run depends only on its
scenario, its seed and its number: its numbers are the same on every machine and on any number of threads.
"""

from __future__ import annotations

import os
from importlib import import_module
from operator import index as _index
from typing import TYPE_CHECKING, Any

from flexsc import _deprecated
from flexsc import _native as engine
from flexsc._analysis import analysis as _analysis
from flexsc._answer import Answer, CampaignAnswer
from flexsc._campaign import campaign, read_campaign, sweep
from flexsc._comparison import Comparison, compare
from flexsc._log import Log
from flexsc._missing import reading as _reading
from flexsc._native import LogError, ScenarioError, SimulationError, __version__
from flexsc._plan import Plan
from flexsc._population import evaluate
from flexsc._quantities import Quantities
from flexsc._requirement import requirement
from flexsc._result import Result, Samples
from flexsc._row import Row
from flexsc._scenario import Scenario
from flexsc._simulator import Simulator, Snapshot
from flexsc._simulators import Simulators
from flexsc._table import Table
from flexsc._topic import Topic
from flexsc._units import Metrics
from flexsc._values import checked as _checked
from flexsc.parts import (
    Actuator,
    Adaptation,
    Aim,
    CompiledDisturbance,
    CompiledGuidance,
    CompiledLaw,
    CompiledThreeAxisLaw,
    DisturbanceModel,
    Effort,
    Estimator,
    Guidance,
    Hold,
    Law,
    Load,
    Reading,
    Sensor,
    ThreeAxisHold,
    ThreeAxisLaw,
)

if TYPE_CHECKING:
    from flexsc import papers, parts, plot, results, scenario, structure
    from flexsc._explore import Explorer, explore
    from flexsc._linear import Linear
    from flexsc._margins import CommonMargins
    from flexsc._noise import WheelLines, WheelSpectrum
    from flexsc._optimisation import Optimum, optimise
    from flexsc._result import Detail
    from flexsc._sensitivity import Sensitivities, sensitivities
    from flexsc._signal import Signal
    from flexsc.results import (
        BudgetLevel,
        IndexBudget,
        LoopMargins,
        MirrorSensitivity,
        NoiseSpectrum,
        OutputBound,
        OutputNoise,
        PointingBudget,
        RequiredContrast,
        SettlingTime,
        StabilityMargins,
        TunedMeasure,
        TunedPlant,
        TunedScenario,
        Witness,
        WorstCase,
    )
    from flexsc.structure import (
        StateSpace,
        Structure,
        appendage_from_craig_bampton,
        appendage_from_matrices,
        appendage_from_nastran,
        from_csv,
        from_nastran,
        from_state_space,
        read_matrices,
    )

__all__ = [
    "Actuator",
    "Adaptation",
    "Aim",
    "Answer",
    "BudgetLevel",
    "CampaignAnswer",
    "CommonMargins",
    "Comparison",
    "CompiledDisturbance",
    "CompiledGuidance",
    "CompiledLaw",
    "CompiledThreeAxisLaw",
    "DisturbanceModel",
    "Effort",
    "Estimator",
    "Explorer",
    "Guidance",
    "Hold",
    "IndexBudget",
    "Law",
    "Linear",
    "Load",
    "Log",
    "LogError",
    "LoopMargins",
    "Metrics",
    "MirrorSensitivity",
    "NoiseSpectrum",
    "Optimum",
    "OutputBound",
    "OutputNoise",
    "Plan",
    "PointingBudget",
    "Quantities",
    "Reading",
    "RequiredContrast",
    "Result",
    "Row",
    "Samples",
    "Scenario",
    "ScenarioError",
    "Sensitivities",
    "Sensor",
    "SettlingTime",
    "Signal",
    "SimulationError",
    "Simulator",
    "Simulators",
    "Snapshot",
    "StabilityMargins",
    "StateSpace",
    "Structure",
    "Table",
    "ThreeAxisHold",
    "ThreeAxisLaw",
    "Topic",
    "TunedMeasure",
    "TunedPlant",
    "TunedScenario",
    "WheelLines",
    "WheelSpectrum",
    "Witness",
    "WorstCase",
    "__version__",
    "appendage_from_craig_bampton",
    "appendage_from_matrices",
    "appendage_from_nastran",
    "campaign",
    "compare",
    "estimate",
    "evaluate",
    "examples",
    "explore",
    "from_csv",
    "from_nastran",
    "from_state_space",
    "metrics",
    "optimise",
    "papers",
    "parts",
    "plot",
    "read_campaign",
    "read_log",
    "read_matrices",
    "requirement",
    "results",
    "scenario",
    "schema",
    "sensitivities",
    "structure",
    "sweep",
    "topics",
]

# What is imported when it is first asked for, so that `import flexsc` stays quick.
_MODULES = ("papers", "parts", "plot", "results", "scenario", "structure")
# Modules that import a package which NumPy does not bring.
_EXTRAS = ("dask", "gym")
_LATER = {
    name: module
    for module, names in {
        "_explore": "Explorer explore",
        "_linear": "Linear",
        "_margins": "CommonMargins",
        "_noise": "WheelLines WheelSpectrum",
        "_optimisation": "Optimum optimise",
        "_sensitivity": "Sensitivities sensitivities",
        "_signal": "Signal",
        "results": "BudgetLevel IndexBudget LoopMargins MirrorSensitivity NoiseSpectrum OutputBound "
        "OutputNoise PointingBudget RequiredContrast SettlingTime StabilityMargins TunedMeasure TunedPlant "
        "TunedScenario Witness WorstCase",
        "structure": "StateSpace Structure appendage_from_craig_bampton appendage_from_matrices "
        "appendage_from_nastran from_csv from_nastran from_state_space read_matrices",
    }.items()
    for name in names.split()
}


# Pickles, `help` and tracebacks name the place where users find a class, not the file of its source.
for _class in (
    Log,
    Metrics,
    Plan,
    Quantities,
    Result,
    Row,
    Samples,
    Scenario,
    Simulator,
    Simulators,
    Snapshot,
    Table,
    Topic,
):
    _class.__module__ = __name__
del _class


# A type checker knows what there is, and would take any name for one of these.
if not TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        if name in _MODULES:
            return import_module(f"flexsc.{name}")
        if name in _LATER:
            return getattr(import_module(f"flexsc.{_LATER[name]}"), name)
        if name in _EXTRAS:
            raise AttributeError(f"module 'flexsc' has no attribute {name!r} before `import flexsc.{name}`")
        return _deprecated.of_module(__name__, name)


def __dir__() -> list[str]:
    return list(__all__)


def estimate(scenario: Scenario, runs: int = 1, log: Detail = "none") -> dict[str, Any]:
    """Return the estimated work of runs before they begin. It is within a factor of about two.

    Args:
        scenario: The scenario to simulate.
        runs: The number of runs of a campaign; 1 for `Scenario.simulate`.
        log: The detail of the log of each run, as in `Scenario.simulate`.

    Returns:
        `seconds`, the time of all runs on one core (s); `steps`, the number of steps of a run that take most
        of it, and `key`, the key that causes them; `memory_bytes`; and `needs_yes`, True if the work exceeds
        10 h on one core, 4 GB of memory or 20 GB of logs, so that `simulate` and `campaign` need `yes=True`.

    >>> import flexsc
    >>> work = flexsc.estimate(flexsc.Scenario.example("relay-sampled"), runs=1000)
    >>> 20.0 < work["seconds"] < 500.0, work["key"], work["steps"], work["needs_yes"]
    (True, 'sensor.sampled.period', 200000.0, False)
    """
    count = _index(runs)
    if count < 1:
        raise ValueError(f"runs must be at least 1, got {runs}")
    values: dict[str, Any] = _analysis("estimate", _checked(scenario), runs=count, log=log)
    return values


def read_log(path: str | os.PathLike[str]) -> Log:
    """Read a log file.

    Raises:
        FileNotFoundError: There is no such file. The error is a `LogError` too.
        LogError: The file cannot be read, or is incomplete or damaged.

    >>> import flexsc, pathlib, tempfile
    >>> run = flexsc.Scenario.example("relay-fixed").with_("duration", 100.0).simulate()
    >>> with tempfile.TemporaryDirectory() as out:
    ...     size = run.to_mcap(pathlib.Path(out) / "run.mcap")
    ...     log = flexsc.read_log(pathlib.Path(out) / "run.mcap")
    >>> log.topics
    ['command', 'law', 'log', 'metrics', 'params', 'summary']
    """
    return Log(_reading(path, engine.Log.open))


def examples() -> dict[str, str]:
    """Return the shipped scenarios: names and subjects. `Scenario.example(name)` reads one.

    >>> import flexsc
    >>> "relay-fixed" in flexsc.examples()
    True
    """
    return {name: str(Scenario.parse(text, name).to_dict()["about"]) for name, text in engine.examples()}


def schema() -> dict[str, Any]:
    """Return the JSON Schema of scenarios.

    >>> import flexsc
    >>> flexsc.schema()["properties"]["duration"]["description"]
    'Simulated time (s).'
    """
    values: dict[str, Any] = _analysis("schema")
    return values


def metrics() -> dict[str, dict[str, str]]:
    """Return the metrics by name: the `unit` (empty for a count, a ratio or a word) and the `doc`.

    >>> import flexsc
    >>> flexsc.metrics()["cycle_period_s"]["unit"]
    's'
    """
    values: dict[str, dict[str, str]] = _analysis("metrics")
    return values


def topics() -> dict[str, dict[str, Any]]:
    """Return the topics of a log by name: the `doc` and the `fields`, each with `name`, `doc` and `kind`.

    >>> import flexsc
    >>> flexsc.topics()["rate"]["fields"][0]
    {'name': 'rate_rad_s', 'doc': 'Rate, elastic part included (rad/s).', 'kind': 'number'}
    """
    values: dict[str, dict[str, Any]] = _analysis("topics")
    return values
