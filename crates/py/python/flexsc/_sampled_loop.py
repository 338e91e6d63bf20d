"""Analyses of a sampled loop: regions of its extra gain, robust gains, stability maps."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from flexsc._analysis import analysis
from flexsc._numpy import np, npt

if TYPE_CHECKING:
    from flexsc._scenario import Scenario

    Numbers = Sequence[float] | npt.NDArray[np.float64]


def gain_region(
    scenario: Scenario,
    frequencies: Numbers,
    *,
    gains: tuple[float, float, float] = (-2.0, 6.0, 0.05),
    limit: float = 200.0,
    band: float | None = None,
    horizon: float = 2000.0,
    dominant_alone: bool = False,
    yes: bool = False,
) -> dict[str, npt.NDArray[np.float64]]:
    """The gains of the extra loop that are stable and settle in time, at each frequency of the dominant mode.

    Args:
        scenario: A body with a law `pd`.
        frequencies: Frequencies of the dominant mode (rad/s).
        gains: Lowest gain, highest gain, and step.
        limit: The longest settling time (s).
        band: Half width of the settling band of the angle (rad); if omitted, 5 % of the initial angle.
        horizon: Simulated time of each loop (s).
        dominant_alone: Change only the frequency of the dominant mode, instead of all modes by one ratio.
        yes: Run even if the estimate is more than 10 h on one core.

    Returns:
        Columns of shape (frequencies,), NaN where no gain qualifies: `frequency_rad_s`, `gain_min`,
        `gain_max`, `midpoint`, `settling_s` and `spectral_radius` at the midpoint, `settling_without_s` and
        `spectral_radius_without`, without the extra loop.

    Raises:
        ScenarioError: The scenario has no loop of this kind.
        ValueError: A number is out of its range, or `yes` is needed.

    >>> import flexsc
    >>> scenario = flexsc.Scenario.example("wheel-fixed-gain")
    >>> region = flexsc.papers.gain_region(scenario, [0.3], gains=(-2.0, 6.0, 0.5))
    >>> bool(region["gain_min"][0] < region["midpoint"][0] < region["gain_max"][0])
    True
    """
    settled = (band, horizon, dominant_alone, yes)
    options = {"frequencies": _floats(frequencies), "gains": gains, "limit": limit, "settled": settled}
    rows = analysis("gain_region", scenario, **options)
    for row in rows:
        row["gain_min"], row["gain_max"] = row.pop("gain") or (None, None)
    return _columns(rows)


def robust_gains(
    scenario: Scenario,
    frequencies: Numbers,
    *,
    off: float = 0.1,
    delay: float = 0.0,
    itae: bool = False,
    quantile: float = 1.0,
    margin: float = 0.0,
    gains: tuple[float, float, float] = (-2.0, 6.0, 0.05),
    band: float | None = None,
    horizon: float = 2000.0,
    dominant_alone: bool = False,
    yes: bool = False,
) -> dict[str, npt.NDArray[np.float64]]:
    """The gains that settle fastest with an uncertain model, at each frequency of the dominant mode.

    Args:
        scenario: A body with a law `pd`.
        frequencies: Frequencies of the dominant mode (rad/s).
        off: Relative error of the frequencies, the modal gains and the gain of the actuator.
        delay: Additional delay of the command that is allowed for (s).
        itae: Minimise the integral of time times angle instead of the settling time.
        quantile: The quantile of the perturbed loops that is evaluated; 1 is the worst.
        margin: Margin of every spectral radius below 1.
        gains: As for `gain_region`, with `band`, `horizon`, `dominant_alone` and `yes`.

    Returns:
        Columns of shape (frequencies,), NaN where no gain qualifies: `frequency_rad_s`, `gain`, `settling_s`,
        `settling_quantile_s`, `spectral_radius` (the largest), and `settling_without_s`.

    Raises:
        ScenarioError: The scenario has no loop of this kind.
        ValueError: A number is out of its range, or `yes` is needed.

    >>> import flexsc
    >>> scenario = flexsc.Scenario.example("wheel-fixed-gain")
    >>> best = flexsc.papers.robust_gains(scenario, [0.3], off=0.05, gains=(0.0, 3.0, 0.5))
    >>> best["gain"].shape, bool(best["spectral_radius"][0] < 1.0)
    ((1,), True)
    """
    rows = analysis(
        "robust_gains",
        scenario,
        frequencies=_floats(frequencies),
        gains=gains,
        off=off,
        delay=delay,
        itae=itae,
        quantile=quantile,
        margin=margin,
        settled=(band, horizon, dominant_alone, yes),
    )
    return _columns(rows)


def stability_map(
    scenario: Scenario,
    frequencies: Numbers,
    periods: Numbers,
    *,
    gain: float | None = None,
    band: float | None = None,
    horizon: float = 2000.0,
    dominant_alone: bool = False,
    yes: bool = False,
) -> dict[str, npt.NDArray[np.float64]]:
    """Stability and settling as functions of the dominant mode's frequency and the sampling period.

    Args:
        scenario: A body with a law `pd`.
        frequencies: Frequencies of the dominant mode (rad/s).
        periods: Sampling periods (s); a delay of the wheel stays the same fraction of the period.
        gain: Gain of the extra loop; if omitted, the scenario's.
        band: As for `gain_region`, with `horizon`, `dominant_alone` and `yes`.

    Returns:
        Columns of shape (frequencies, periods): `frequency_rad_s`, `period_s`, `spectral_radius`,
        `settling_s` (NaN where the loop does not settle) and `itae_rad_s2`.

    Raises:
        ScenarioError: The scenario has no loop of this kind.
        ValueError: A number is out of its range, or `yes` is needed.

    >>> import flexsc
    >>> scenario = flexsc.Scenario.example("wheel-fixed-gain")
    >>> cells = flexsc.papers.stability_map(scenario, [0.2, 0.3], [0.1, 0.3, 0.5])
    >>> cells["spectral_radius"].shape
    (2, 3)
    """
    settled = (band, horizon, dominant_alone, yes)
    rows, columns = _floats(frequencies), _floats(periods)
    options = {"frequencies": rows, "periods": columns, "gain": gain, "settled": settled}
    cells = analysis("stability_map", scenario, **options)
    return {name: values.reshape(len(rows), len(columns)) for name, values in _columns(cells).items()}


def _floats(values: Numbers) -> list[float]:
    return [float(value) for value in values]


def _columns(rows: list[dict[str, Any]]) -> dict[str, npt.NDArray[np.float64]]:
    names = rows[0] if rows else {}
    return {name: np.array([row[name] for row in rows], dtype=np.float64) for name in names}
