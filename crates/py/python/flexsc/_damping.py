"""Active damping by a relay of thrusters, and the convergence of its observer."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flexsc import _native as engine
from flexsc._analysis import analysis
from flexsc._numpy import np, npt
from flexsc._sampled_loop import _columns, _floats

if TYPE_CHECKING:
    from collections.abc import Sequence

    from flexsc._sampled_loop import Numbers

WEIGHTS = (0.05, 0.2, 0.15)


def relay_damping(
    frequencies: Numbers,
    acceleration: float,
    *,
    period: float = 0.2,
    delay: float = 0.0,
    on_time: float | None = None,
    damping: float = 0.005,
    amplitude: float = 0.0,
    threshold: float = 0.0,
) -> dict[str, npt.NDArray[np.float64]]:
    """Damping of modes by a relay that acts against their elastic rate.

    Args:
        frequencies: Natural frequencies (rad/s).
        acceleration: Elastic acceleration of a pulse: the rigid one times the influence on the mode (rad/s²).
        period: Sampling period (s); 0 for a continuous relay.
        delay: Delay from a sample to its pulse (s).
        on_time: Duration of a pulse (s); if omitted, the whole period.
        damping: Damping ratio of the modes.
        amplitude: Initial amplitude of the elastic rate (rad/s).
        threshold: Amplitude below which no thruster fires (rad/s).

    Returns:
        Columns of shape (frequencies,), NaN where undefined: `frequency_rad_s`, `phase_factor`,
        `slope_rad_s2`, `delay_limit_s`, `gain_limit_1_s`, `limit_cycle_rate_rad_s`,
        `limit_cycle_frequency_rad_s`, `decay_s` and `thrust_s`, from the amplitude to the threshold.

    Raises:
        ValueError: A number is out of its range.

    >>> import flexsc
    >>> damped = flexsc.papers.relay_damping([0.86, 4.5], 1e-6, delay=0.2, amplitude=1e-4)
    >>> [round(float(factor), 3) for factor in damped["phase_factor"]]
    [0.966, 0.212]
    """
    rows = analysis(
        "relay_damping",
        frequencies=_floats(frequencies),
        acceleration=acceleration,
        period=period,
        delay=delay,
        on_time=period if on_time is None else on_time,
        damping=damping,
        amplitude=amplitude,
        threshold=threshold,
    )
    return _columns(rows)


def observer_region(
    frequency: float,
    elastic: Numbers,
    *,
    rigid: float = 0.05,
    kappa: float = 0.0,
    period: float = 0.2,
    damping: float = 0.005,
) -> dict[str, Any]:
    """The region of convergence of the recurrence observer in the plane of W2 and W3, its regressor frozen.

    Args:
        frequency: Natural frequency of the mode (rad/s).
        elastic: Values of W2.
        rigid: W1.
        kappa: W4 times the absolute value of the elastic rate.
        period: Period of the samples (s).
        damping: Damping ratio of the mode.

    Returns:
        `elastic`, W2; `next_min` and `next_max`, the limits of W3 between which it converges, NaN where it
        does not converge for any; `area`, the area of the whole region.

    Raises:
        ValueError: A number is out of its range.

    >>> import flexsc
    >>> region = flexsc.papers.observer_region(1.26, [0.6, 2.1], kappa=1.5)
    >>> round(region["area"], 2), region["next_min"].shape
    (1.35, (2,))
    """
    observer = ((rigid, 0.0, 0.0), frequency, period, damping)
    found = analysis("observer_region", observer=observer, kappa=kappa, elastic=_floats(elastic))
    rows = [
        {"elastic": w2, "next_min": (edge or [None])[0], "next_max": (edge or [None])[-1]}
        for w2, edge in ((row["elastic"], row["next"]) for row in found["edges"])
    ]
    return {**_columns(rows), "area": found["area"]}


def observer_margin(
    frequency: float,
    kappas: Numbers = (),
    *,
    weights: tuple[float, float, float] = WEIGHTS,
    period: float = 0.2,
    damping: float = 0.005,
) -> dict[str, Any]:
    """The identification rate that the recurrence observer allows, with the oscillation as its regressor.

    Args:
        frequency: Natural frequency of the mode (rad/s).
        kappas: Gains W4 V of the identification, where V is the amplitude of the elastic rate.
        weights: W1, W2 and W3.
        period: Period of the samples (s).
        damping: Damping ratio of the mode.

    Returns:
        `gain_max`, the largest gain at which it converges; `gain_best`, the gain with the fastest
        convergence; `spectral_radius`, the factor of an error from sample to sample at that gain (NaN if no
        gain converges); `radii`, this factor for each of `kappas`.

    Raises:
        ValueError: A number is out of its range.

    >>> import flexsc
    >>> margin = flexsc.papers.observer_margin(1.26, [0.1, 0.2])
    >>> margin["gain_best"] < margin["gain_max"], margin["radii"].shape
    (True, (2,))
    """
    observer = (weights, frequency, period, damping)
    found = analysis("observer_margin", observer=observer, kappas=_floats(kappas))
    names = ("gain_max", "gain_best", "spectral_radius")
    margin = found["margin"] or dict.fromkeys(names, float("nan"))
    return {**margin, "radii": np.array(found["spectral_radius"], dtype=np.float64)}


def identify(
    modes: Sequence[tuple[float, float]],
    off: Numbers = (0.05, 0.1, 0.2, 0.3),
    *,
    influence_off: float = 0.4,
    rate: float = 0.02,
    runs: int = 100,
    cycles: int = 1500,
    seed: int = 1,
    yes: bool = False,
) -> dict[str, Any]:
    """The success rate and convergence time of the gradient observer under random bursts of thrusters.

    The channel is the yaw axis of the station: 2.05e-5 rad/s², cycles of 0.2 s, noise of 2e-6 and a
    resolution of 1e-6 rad/s.

    Args:
        modes: Natural frequency (rad/s) and influence of each mode.
        off: Initial relative errors of the frequencies, up or down.
        influence_off: Relative error of the influences at the start.
        rate: Rate of the identification, eta.
        runs: Number of runs per row.
        cycles: Number of cycles per run.
        seed: Seed.
        yes: Run even if the estimate is more than 10 h on one core.

    Returns:
        Columns of shape (off,), NaN where no run converged: `off`, `runs`, `converged` (to 2 % of each
        frequency), `time_median_s`, `time_longest_s`, `frequency_error` and `influence_error` (medians of the
        final relative errors), and `persistence` of excitation; and `times_s`, for each row the convergence
        times of the runs that converged.

    Raises:
        ValueError: A number is out of its range, or `yes` is needed.

    >>> import flexsc
    >>> found = flexsc.papers.identify([(1.2, 0.5)], [0.1], runs=10)
    >>> found["runs"].tolist(), found["converged"].shape
    ([10.0], (1,))
    """
    pairs = [(float(w), float(influence)) for w, influence in modes]
    options = {"modes": pairs, "influence_off": influence_off, "rate": rate, "yes": yes}
    options |= {"runs": runs, "cycles": cycles, "seed": seed}
    rows = [analysis("identify", off=part, **options) for part in _floats(off)]
    times = [np.array(row.pop("times_s"), dtype=np.float64) for row in rows]
    return {**_columns(rows), "times_s": times}


def persistence(sensitivities: npt.ArrayLike) -> float:
    """Persistence of excitation: how well measurements distinguish the parameters.

    Args:
        sensitivities: Derivatives of the measurement with respect to each parameter, of shape (samples,
            parameters).

    Returns:
        The smallest eigenvalue of their Gram matrix with normalised columns: 1 at best, 0 if a combination of
        parameters is not observable; NaN if a parameter was never excited.

    >>> import flexsc
    >>> flexsc.papers.persistence([[1.0, 0.0], [0.0, 1.0]])
    1.0
    """
    return engine.persistence(np.ascontiguousarray(np.atleast_2d(sensitivities), dtype=np.float64))
