"""Stability margins of the loop of a scenario, at every crossing."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, nan
from typing import TYPE_CHECKING, Any

from flexsc._analysis import analysis
from flexsc._named import Brief
from flexsc._numpy import np, npt
from flexsc._read import read

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from flexsc._linear import Break
    from flexsc._scenario import Scenario


@dataclass(frozen=True, eq=False, repr=False)
class LoopMargins(Brief):
    """Margins of one signal of a loop, with the loops of the other signals closed, or of all together.

    >>> margins = flexsc.Scenario.example("wheel-fast-mode").margins().loops["command"]
    >>> round(margins.gain_above, 2), round(margins.delay, 3), round(margins.modulus, 4)
    (3.03, 80.738, 0.6247)
    """

    gain_crossings: dict[str, npt.NDArray[np.float64]]
    """Where the loop gain is 1, columns of shape (crossings,): `frequency` (rad/s), `phase` (rad), the phase
    margin from -pi to pi, negative for a lead; `delay` (s), NaN for several samples in a period.

    >>> list(margins.gain_crossings)
    ['frequency', 'phase', 'delay']
    """
    phase_crossings: dict[str, npt.NDArray[np.float64]]
    """Where the loop transfer is real and negative, columns of shape (crossings,): `frequency` (rad/s) and
    `factor`, the gain margin.

    >>> list(margins.phase_crossings)
    ['frequency', 'factor']
    """
    gain_below: float
    """Largest factor below 1 on the loop gain at which the loop is at the limit of stability; 0 if there is
    none.

    >>> margins.gain_below
    0.0
    """
    gain_above: float
    """Smallest factor above 1 at which the loop is at the limit of stability; infinite if there is none.

    >>> round(margins.gain_above, 2)
    3.03
    """
    phase: float
    """Smallest phase (rad), of either sign, that makes the loop unstable; pi if there is none.

    >>> round(margins.phase, 4)
    1.1734
    """
    delay: float
    """Smallest delay (s) that makes the loop unstable; infinite if there is none, NaN for several samples of
    the law in a period.

    >>> round(margins.delay, 4)
    80.7384
    """
    modulus: float
    """Modulus margin: smallest distance of the loop transfer from -1.

    >>> round(margins.modulus, 4)
    0.6247
    """
    modulus_frequency: float
    """Frequency (rad/s) at which the modulus margin is attained.

    >>> round(margins.modulus_frequency, 5)
    0.53401
    """
    disk: float
    """Disk margin alpha: gains of (2 - alpha)/(2 + alpha) to its inverse, and phases up to 2 atan(alpha/2),
    at once.

    >>> round(margins.disk, 4)
    0.8977
    """
    disk_frequency: float
    """Frequency (rad/s) at which the disk margin is attained.

    >>> round(margins.disk_frequency, 5)
    0.53395
    """


@dataclass(frozen=True, eq=False, repr=False)
class StabilityMargins(Brief):
    """Margins of a stable loop: of each signal at the break, and of all together.

    >>> margins = flexsc.Scenario.example("attitude-hold").margins("torque")
    >>> list(margins.loops), margins.disk <= min(each.disk for each in margins.loops.values())
    (['torque_roll', 'torque_pitch', 'torque_yaw'], True)
    """

    loop: Break
    """The point at which the loop is opened.

    >>> margins.loop
    'torque'
    """
    period: float
    """Period (s) after which the loop repeats.

    >>> round(margins.period, 4)
    0.2
    """
    samples: int
    """Samples of the law in a period.

    >>> margins.samples
    1
    """
    spectral_radius: float
    """Largest magnitude of a pole of the closed loop.

    >>> round(margins.spectral_radius, 4)
    0.9986
    """
    loops: dict[str, LoopMargins]
    """Margins of each signal at the break, with the loops of the others closed.

    >>> list(margins.loops)
    ['torque_roll', 'torque_pitch', 'torque_yaw']
    """
    modulus: float
    """Modulus margin of all signals together: the inverse of the largest gain of the sensitivity.

    >>> round(margins.modulus, 4)
    0.9596
    """
    modulus_frequency: float
    """Frequency (rad/s) at which the modulus margin is attained.

    >>> round(margins.modulus_frequency, 3)
    2.841
    """
    disk: float
    """Disk margin alpha of all signals together, for errors of the loops that are coupled in any way.

    >>> round(margins.disk, 3)
    1.114
    """
    disk_frequency: float
    """Frequency (rad/s) at which the disk margin is attained.

    >>> round(margins.disk_frequency, 4)
    0.2117
    """
    independent_disk: float
    """Disk margin alpha of all signals together, for an error of each loop that is independent of the others.

    It is NaN for one signal, and for several samples of the law in a period.

    >>> margins.disk <= margins.independent_disk <= min(each.disk for each in margins.loops.values())
    True
    """
    frequency: npt.NDArray[np.float64]
    """Frequencies (rad/s) of the singular values, up to pi / `period`, which follow the resonances.

    With several samples of the law in a period, the motion at a frequency also has its aliases.

    >>> bool((margins.frequency[1:] > margins.frequency[:-1]).all())
    True
    """
    sensitivity: npt.NDArray[np.float64]
    """Largest singular value of the sensitivity S = (1 + L)^-1 of all signals together at each frequency.

    >>> bool(margins.sensitivity.max() <= 1.0001 / margins.modulus)
    True
    """
    complementary: npt.NDArray[np.float64]
    """Largest singular value of the complementary sensitivity T = 1 - S at each frequency.

    >>> margins.complementary.shape == margins.frequency.shape
    True
    """
    delay: float
    """Smallest additional delay (s) of all actuators that makes the loop unstable; infinite without one.

    >>> margins.delay > 0.5
    True
    """
    settling: dict[str, float]
    """Time (s) in which all angles settle within 5 % after a step of the target about each axis.

    It is the time at which the sum of the terms of all poles falls below the band, which the true time does
    not exceed at the samples, and infinite if a term does not decay.

    >>> list(margins.settling), max(margins.settling.values()) < 100.0
    (['roll', 'pitch', 'yaw'], True)
    """

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the largest singular values of sensitivity and complementary sensitivity over frequency.

        Args:
            ax: The axes; if omitted, those of a new figure.

        Returns:
            The axes: frequency (rad/s) against the largest singular value (dB). A point marks the largest
            one of S, the inverse of the modulus margin.

        Raises:
            ImportError: Matplotlib is not installed.

        >>> import matplotlib; matplotlib.use("agg")
        >>> margins.plot().get_xlabel()
        'frequency (rad/s)'
        """
        from flexsc._review_figures import singular_values

        return singular_values(self, ax)


StabilityMargins.__module__ = LoopMargins.__module__ = "flexsc"


def stability_margins(scenario: Scenario, loop: Break) -> StabilityMargins:
    """Return the margins of the loop of a scenario, opened at a point."""
    found = analysis("margins", scenario, opened=loop)
    several = found["samples"] > 1
    singular = {name: np.array(values) for name, values in found["singular_values"].items()}
    return read(
        StabilityMargins,
        found,
        loops={each["signal"]: _loop(each, several) for each in found["loops"]},
        delay=inf if found["common_delay_s"] is None else found["common_delay_s"],
        settling=_settling(found["settling"]),
        independent_disk=(found["independent_disk"] or {"alpha": nan})["alpha"],
        **singular,
        **_peaks(found),
    )


def _settling(rows: list[dict[str, Any]]) -> dict[str, float]:
    """The longest settling time of all angles after a step about each axis."""
    longest: dict[str, float] = {}
    for row in rows:
        time = inf if row["time_s"] is None else row["time_s"]
        longest[row["step"]] = max(time, longest.get(row["step"], 0.0))
    return longest


def _loop(found: dict[str, Any], several: bool) -> LoopMargins:
    """The margins of one signal; infinite or NaN where a number does not exist."""
    gain = {"frequency": "frequency_rad_s", "phase": "phase_rad", "delay": "delay_s"}
    phase = {"frequency": "frequency_rad_s", "factor": "factor"}
    return read(
        LoopMargins,
        found,
        gain_crossings=_columns(found["gain"], gain),
        phase_crossings=_columns(found["phase"], phase),
        gain_above=inf if found["gain_above"] is None else found["gain_above"],
        phase=found["phase_rad"],
        delay=(nan if several else inf) if found["delay_s"] is None else found["delay_s"],
        **_peaks(found),
    )


def _peaks(found: dict[str, Any]) -> dict[str, float]:
    return {
        "modulus": found["modulus"]["margin"],
        "modulus_frequency": found["modulus"]["frequency_rad_s"],
        "disk": found["disk"]["alpha"],
        "disk_frequency": found["disk"]["frequency_rad_s"],
    }


def _columns(rows: list[dict[str, Any]], keys: dict[str, str]) -> dict[str, npt.NDArray[np.float64]]:
    return {name: np.array([row[key] for row in rows], dtype=np.float64) for name, key in keys.items()}
