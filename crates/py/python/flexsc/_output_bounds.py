"""Guaranteed ranges of outputs of the linear body of a scenario."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from flexsc._analysis import analysis
from flexsc._named import Brief
from flexsc._numpy import np, npt
from flexsc._read import read

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from flexsc._scenario import Scenario


@dataclass(frozen=True, eq=False, repr=False)
class Witness(Brief):
    """State at the start and inputs over time that bring an output beyond its limits.

    >>> scenario = flexsc.Scenario.example("bounded-jitter").with_("bound[0].limits", [-5e-6, 5e-6])
    >>> witness = scenario.bound()[0].witness
    >>> abs(witness.simulated / witness.value - 1.0) < 1e-9
    True
    """

    time: float
    """Time (s) at which the output has this value.

    >>> round(witness.time, 2)
    59.98
    """
    value: float
    """Value of the output, in its unit.

    >>> round(witness.value, 9)
    -7.103e-06
    """
    simulated: float
    """Value in a run of the engine from this state under these inputs; NaN if there is no such run.

    >>> round(witness.simulated, 9)
    -7.103e-06
    """
    frequency_factor: float
    """Factor on every natural frequency of the scenario.

    >>> round(witness.frequency_factor, 3)
    1.0
    """
    damping_factor: float
    """Factor on every damping ratio.

    >>> round(witness.damping_factor, 3)
    1.0
    """
    start: npt.NDArray[np.float64]
    """State at the start, of shape (states,), in the order of `linearise().states`.

    >>> witness.start.shape
    (12,)
    """
    inputs: dict[str, tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]]
    """Times (s) from which each value of an input acts, and the values, by the name of the input.

    >>> list(witness.inputs)
    ['torque_roll', 'torque_pitch', 'torque_yaw']
    """
    scenario: Scenario | None
    """The body from this state, under these inputs as disturbances; None if no file can have them.

    >>> witness.scenario.name
    'bounded-jitter-witness'
    """


@dataclass(frozen=True, eq=False, repr=False)
class OutputBound(Brief):
    """Guaranteed range of an output over sets of states, inputs and parameters, and the verdict.

    >>> bound = flexsc.Scenario.example("bounded-jitter").bound()[0]
    >>> bound.output, bound.verdict
    ('roll', 'proved')
    >>> bool((bound.rows["high"] <= bound.range[1]).all())
    True
    """

    output: str
    """Name of the output.

    >>> bound.output
    'roll'
    """
    unit: str
    """Unit of the output.

    >>> bound.unit
    'rad'
    """
    elastic: bool
    """True if the output is without the rigid motion.

    >>> bound.elastic
    True
    """
    limits: tuple[float, float] | None
    """Limits of the claim; None if there are none.

    >>> [round(value, 9) for value in bound.limits]
    [-8e-06, 8e-06]
    """
    until: float
    """End of the interval of time (s).

    >>> round(bound.until, 2)
    60.0
    """
    verdict: Literal["proved", "violated", "undecided", "unlimited"]
    """Outcome; `unlimited` without limits.

    >>> bound.verdict
    'proved'
    """
    range: tuple[float, float]
    """Guaranteed range over the whole interval, rounded outwards.

    >>> [round(value, 9) for value in bound.range]
    [-7.103e-06, 7.064e-06]
    """
    attained: tuple[float, float]
    """Range that is attained by states and inputs that are known.

    >>> [round(value, 9) for value in bound.attained]
    [-7.103e-06, 7.064e-06]
    """
    attained_at: tuple[float, float]
    """Times (s) at which the range is attained.

    >>> [round(value, 2) for value in bound.attained_at]
    [59.98, 59.99]
    """
    safe_until: float
    """Time (s) before which no limit is passed; NaN without limits.

    >>> round(bound.safe_until, 2)
    60.0
    """
    violated_at: float
    """First time (s) at which a limit is passed for a state and inputs of the sets; NaN if none is known.

    >>> bound.violated_at
    nan
    """
    gap: float
    """Largest excess of the guaranteed range over the limits, if the claim is undecided; otherwise NaN.

    >>> bound.gap
    nan
    """
    witness: Witness | None
    """State and inputs that violate the claim the most; None if it is not violated.

    >>> bound.witness is None
    True
    """
    rows: dict[str, npt.NDArray[np.float64]]
    """Range at instants, columns of shape (instants,): `time` (s), `low` and `high`. The output may leave it
    between two instants, but not `range`.

    >>> list(bound.rows)
    ['time', 'low', 'high']
    """

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the guaranteed range over time, with the limits and the points at which it is attained.

        Args:
            ax: The axes; if omitted, those of a new figure.

        Returns:
            The axes: time (s) against the output, in its unit.

        Raises:
            ImportError: Matplotlib is not installed.

        >>> import matplotlib; matplotlib.use("agg")
        >>> bound.plot().get_ylabel()
        'roll, elastic (rad)'
        """
        from flexsc._review_figures import output_range

        return output_range(self, ax)


OutputBound.__module__ = Witness.__module__ = "flexsc"


def output_bounds(scenario: Scenario) -> list[OutputBound]:
    """Return the ranges of all claims of a scenario."""
    return [_bound(each, type(scenario)) for each in analysis("bounds", scenario)]


def _bound(found: dict[str, Any], of: type[Scenario]) -> OutputBound:
    rows = {name: np.array(values, dtype=np.float64) for name, values in found["rows"].items()}
    witness = found["witness"] and _witness(found["witness"], found["witness_scenario"], of)
    signal = found["output"]
    return read(OutputBound, found, output=signal["name"], unit=signal["unit"], rows=rows, witness=witness)


def _witness(found: dict[str, Any], text: str | None, of: type[Scenario]) -> Witness:
    def column(values: list[float]) -> npt.NDArray[np.float64]:
        return np.array(values, dtype=np.float64)

    inputs = {each["name"]: (column(each["times_s"]), column(each["values"])) for each in found["inputs"]}
    return read(Witness, found, inputs=inputs, scenario=None if text is None else of.parse(text))
