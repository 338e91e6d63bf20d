"""Noise of the loop of a scenario, and the lines of its wheels over their speed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from flexsc._analysis import analysis
from flexsc._named import Brief
from flexsc._numpy import np, npt
from flexsc.results import NoiseSpectrum

if TYPE_CHECKING:
    from flexsc._scenario import Scenario

    Values = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False, repr=False)
class WheelLines(Brief):
    """Lines of the outputs under one harmonic of one unbalanced wheel, over its speed.

    >>> found = flexsc.Scenario.example("wheel-run-up").spectrum(speeds=[40.0, 93.0]).wheels.harmonics[0]
    >>> found.order, found.frequency.tolist() == [40.0, 93.0], found.amplitude["roll"].shape
    (1.0, True, (2,))
    """

    wheel: int
    """Number of the wheel, from 1.

    >>> found.wheel
    1
    """
    order: float
    """Order of the harmonic: periods per turn.

    >>> round(found.order, 3)
    1.0
    """
    frequency: Values
    """Frequency of the harmonic (rad/s), of shape (speeds,).

    >>> found.frequency.shape
    (2,)
    """
    amplitude: dict[str, Values]
    """Amplitude of each output at that frequency, in its unit, of shape (speeds,).

    >>> list(found.amplitude)
    ['roll', 'pitch', 'yaw', 'line_of_sight0_y', 'line_of_sight0_z']
    """
    alias_frequency: dict[str, Values]
    """Frequency (rad/s) of the largest line that sampling makes of it, of each output, of shape (speeds,).

    >>> list(found.alias_frequency)
    ['roll', 'pitch', 'yaw', 'line_of_sight0_y', 'line_of_sight0_z']
    """
    alias_amplitude: dict[str, Values]
    """Amplitude of that line, in the unit of the output, of shape (speeds,).

    >>> list(found.alias_amplitude)
    ['roll', 'pitch', 'yaw', 'line_of_sight0_y', 'line_of_sight0_z']
    """


@dataclass(frozen=True, eq=False, repr=False)
class WheelSpectrum(Brief):
    """Lines of the imbalance of wheels over their speed.

    >>> wheels = flexsc.Scenario.example("wheel-run-up").spectrum(speeds=[40.0, 93.0]).wheels
    >>> wheels.speed.tolist(), bool(wheels.rms["yaw"][1] > wheels.rms["yaw"][0])
    ([40.0, 93.0], True)
    """

    speed: Values
    """Speeds (rad/s), of shape (speeds,).

    >>> wheels.speed.shape
    (2,)
    """
    rms: dict[str, Values]
    """Rms of each output, of all lines of all wheels, in its unit, of shape (speeds,).

    >>> list(wheels.rms)
    ['roll', 'pitch', 'yaw', 'line_of_sight0_y', 'line_of_sight0_z']
    """
    harmonics: tuple[WheelLines, ...]
    """Lines under each harmonic of each wheel.

    >>> len(wheels.harmonics)
    8
    """
    window: dict[str, dict[str, Values]] | None
    """Rms of these lines over windows that begin at any time, if a window is given: for each output the
    indices of `OutputNoise.window`, each of shape (speeds,).

    >>> over = flexsc.Scenario.example("wheel-run-up").spectrum(window=0.01, speeds=[40.0, 93.0]).wheels
    >>> over.window["yaw"]["rpe_uniform"].shape
    (2,)
    """
    mtf: dict[str, Values] | None
    """Contrast that the noise and these lines leave an image, if a pixel is given, of outputs in rad, each of
    shape (speeds,).

    >>> craft = flexsc.Scenario.example("wheel-run-up")
    >>> craft.spectrum(pixel=1e-3, speeds=[40.0, 93.0]).wheels.mtf["yaw"].shape
    (2,)
    """


WheelSpectrum.__module__ = WheelLines.__module__ = "flexsc"


def noise_spectrum(
    scenario: Scenario,
    signals: Sequence[str] | None,
    window: float | None,
    separation: float | None,
    speeds: npt.ArrayLike | None,
    pixel: float | None,
    smear: float | None,
    diffraction: float | None,
) -> NoiseSpectrum:
    """Return the noise of the loop of a scenario."""
    if separation is not None and window is None:
        raise ValueError("separation needs a window")
    if isinstance(signals, str):
        signals = [signals]
    given = None if speeds is None else np.asarray(speeds, dtype=np.float64).ravel().tolist()
    found = analysis(
        "spectrum",
        scenario,
        signals=list(signals or ()),
        window=window,
        separation=separation,
        pixel=pixel,
        smear=smear,
        diffraction=diffraction,
        speeds=given,
    )
    if "wheels" in found:
        found["wheels"] = _wheels(found["wheels"], [each["output"] for each in found["outputs"]])
    return NoiseSpectrum._read(found)


def _array(values: Sequence[float]) -> Values:
    return np.array(values, dtype=np.float64)


def _indices(window: dict[str, Any]) -> dict[str, float]:
    """The indices over a window, without its times."""
    times = ("window_s", "separation_s")
    return {name: value for name, value in window.items() if name not in times and value is not None}


def _wheels(found: dict[str, Any], names: list[str]) -> WheelSpectrum:
    """The lines over speed, one entry for each harmonic of each wheel."""
    groups: dict[tuple[int, float], list[dict[str, Any]]] = {}
    for line in found["lines"]:
        groups.setdefault((line["wheel"], line["order"]), []).append(line)
    none = {"frequency_rad_s": float("nan"), "amplitude": 0.0}

    def column(lines: list[dict[str, Any]], place: int, alias: bool, key: str) -> Values:
        of = [line["outputs"][place] for line in lines]
        chosen = [(each["aliases"] or [none])[0] if alias else each["direct"] for each in of]
        return _array([each[key] for each in chosen])

    def columns(lines: list[dict[str, Any]], alias: bool, key: str) -> dict[str, Values]:
        return {name: column(lines, place, alias, key) for place, name in enumerate(names)}

    speed = _array(found["speed_rad_s"])
    harmonics = (
        WheelLines(
            wheel=wheel,
            order=order,
            frequency=order * speed,
            amplitude=columns(lines, False, "amplitude"),
            alias_frequency=columns(lines, True, "frequency_rad_s"),
            alias_amplitude=columns(lines, True, "amplitude"),
        )
        for (wheel, order), lines in groups.items()
    )
    rms = {name: _array(values) for name, values in zip(names, found["rms"], strict=True)}
    windows = found.get("windows")
    if windows is not None:
        over_speed = [[_indices(window) for window in each] for each in windows]
        windows = {
            name: {index: _array([window[index] for window in each]) for index in each[0]}
            for name, each in zip(names, over_speed, strict=True)
        }
    over = zip(names, found.get("mtf", ()), strict=False)
    mtf = {name: _array(values) for name, values in over if values} or None
    return WheelSpectrum(speed, rms, tuple(harmonics), windows, mtf)
