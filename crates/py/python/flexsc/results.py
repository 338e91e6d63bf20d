"""Results of analyses in SI units, as `Scenario.margins` and other methods return them.

Arrays cannot be changed. NaN is a number that does not exist.
"""

# Made by crates/py/result_classes.py: a change here is lost.

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

from flexsc._numpy import np, npt
from flexsc._read import (
    Data,
    array,
    at,
    attributes,
    bounded,
    column,
    columns,
    keyed,
    named,
    number,
    one,
    part,
    parts,
    plain,
    tuple_of,
)
from flexsc._review_figures import (
    BoundFigure,
    BudgetFigure,
    MarginsFigure,
    NoiseFigure,
    TuningFigure,
    WorstFigure,
)

if TYPE_CHECKING:
    from flexsc._noise import WheelSpectrum
    from flexsc._scenario import Scenario

Values: TypeAlias = "npt.NDArray[np.float64]"
"""Numbers that cannot be changed."""
Columns: TypeAlias = "dict[str, npt.NDArray[np.float64]]"
"""Columns of numbers that cannot be changed, by their names."""

__all__ = [
    "BudgetLevel",
    "Columns",
    "IndexBudget",
    "LoopMargins",
    "MirrorSensitivity",
    "NoiseSpectrum",
    "OutputBound",
    "OutputNoise",
    "PointingBudget",
    "RequiredContrast",
    "SettlingTime",
    "StabilityMargins",
    "TunedMeasure",
    "TunedPlant",
    "TunedScenario",
    "Values",
    "Witness",
    "WorstCase",
]


_SOURCE_NUMBERS = attributes(
    bias=("bias", number),
    bias_spread=("bias_spread", number),
    largest_bias=("largest_bias", number),
    amplitudes=("amplitudes", array),
    noise=("noise", number),
)


@dataclass(frozen=True, eq=False, repr=False)
class BudgetLevel(Data):
    """Level of the magnitude of an index at a probability, in three ways.

    >>> budget = flexsc.Scenario.example("slew-wheel-lqg").budget(runs=2)
    >>> level = budget.indices[0].levels[0.955]["mixed"]
    >>> level.campaign > 0.0
    True
    """

    campaign: float = at("campaign", number)
    """Order statistic of the runs; NaN without values."""

    convolution: float = at("convolution", number)
    """Level of the sum of the error sources by convolution. NaN if there is none."""

    rule: float = at("rule", number)
    """Level by the rule of k sigma. NaN if there is none."""


_LEVELS_AT_PROBABILITY = attributes(
    temporal=("temporal", one(BudgetLevel)),
    ensemble=("ensemble", one(BudgetLevel)),
    mixed=("mixed", one(BudgetLevel)),
)


@dataclass(frozen=True, eq=False, repr=False)
class IndexBudget(BudgetFigure, Data):
    """Budget of one pointing index.

    >>> budget = flexsc.Scenario.example("slew-wheel-lqg").budget(runs=2)
    >>> index = budget.indices[0]
    >>> index.name, list(index.levels), list(index.sources)[:2]
    ('arrival', [0.683, 0.955, 0.997], ['bias', 'bias_spread'])
    """

    name: str = at("name", plain)
    """Name of the requirement."""

    description: str = at("description", plain)
    """Index, quantity and window of the requirement."""

    unit: str = at("unit", plain)
    """Unit of the levels and of the limit."""

    limit: float = at("limit", number)
    """Limit of the requirement."""

    sources: dict[str, Any] | None = at("sources", _SOURCE_NUMBERS)
    """Error sources that the runs show; none for an index without sources. `bias`: mean of the bias over
    the runs; `bias_spread`: standard deviation of the bias from run to run; `largest_bias`: largest
    magnitude of the bias; `amplitudes`: rms amplitude of each sine; `noise`: rms of the random part.
    """

    linear_noise: float = at("linear_noise", number)
    """Rms of the index under the noise of the linear loop about its target at rest. NaN if there is none."""

    linear_sources: dict[str, Any] | None = at("linear_sources", _SOURCE_NUMBERS)
    """Error sources of the linear loop under its disturbances; none without such a loop. `bias`: mean of
    the bias over the runs; `bias_spread`: standard deviation of the bias from run to run;
    `largest_bias`: largest magnitude of the bias; `amplitudes`: rms amplitude of each sine; `noise`: rms
    of the random part.
    """

    linear_levels: dict[float, float] | None = at(
        "linear_levels", keyed("level", part("convolution", number))
    )
    """Mixed levels of these sources; none without such a loop."""

    levels: dict[float, dict[str, BudgetLevel]] = at("levels", keyed("level", _LEVELS_AT_PROBABILITY))
    """Levels at each probability, by their interpretation."""


_CONTRAST_COST = attributes(
    alone=("alone", number),
    without=("without", number),
)


@dataclass(frozen=True, eq=False, repr=False)
class RequiredContrast(Data):
    """Contrast of an image that a requirement asks for, at the worst axis of its line of sight and at the
    worst speed of the wheels.

    >>> sharp = {"name": "sharp", "quantity": "mtf", "point": "bench", "spatial_frequency": 1e5, "least": 0.9}
    >>> spectrum = flexsc.Scenario.example("wheel-run-up").with_("requirement", [sharp]).spectrum()
    >>> contrast = spectrum.contrasts["sharp"]
    >>> contrast.met == (contrast.mtf >= 0.9), list(contrast.costs)[0]
    (True, 'actuator.wheels.imbalance')
    """

    name: str = at("name", plain)
    """Name of the requirement."""

    output: str = at("output", plain)
    """Output that moves the image: the line of sight about its worst axis."""

    spatial_frequency: float = at("spatial_frequency", number)
    """Spatial frequency (cycles/rad)."""

    exposure: float = at("exposure_s", number)
    """Length of the exposures (s); none for a long one. NaN if there is none."""

    least: float = at("least", number)
    """Least accepted contrast."""

    mtf: float = at("mtf", number)
    """Contrast (MTF) that the motion leaves."""

    met: bool = at("met", plain)
    """True if the contrast is at least the accepted one."""

    speed: float = at("speed_rad_s", number)
    """Speed of the wheels at which it is least (rad/s), if they have imbalance. NaN if there is none."""

    costs: dict[str, dict[str, float]] = at("costs", keyed("source", _CONTRAST_COST))
    """Sources, that which costs most first."""

    curve: Columns = at("curve", columns(spatial_frequency="spatial_frequency", mtf="mtf"))
    """Contrast over the spatial frequency. `spatial_frequency`: spatial frequency (cycles/rad); `mtf`:
    contrast (MTF).
    """


@dataclass(frozen=True, eq=False, repr=False)
class PointingBudget(Data):
    """Budgets of all pointing indices that a scenario limits, and the verdicts of its requirements.

    >>> budget = flexsc.Scenario.example("slew-wheel-lqg").budget(runs=2)
    >>> budget.runs, len(budget.indices) <= len(budget.requirements)
    (2, True)
    """

    runs: int = at("runs", plain)
    """Number of runs of the campaign."""

    indices: tuple[IndexBudget, ...] = at("budgets", tuple_of(one(IndexBudget)))
    """Budget of each pointing index, in the order of the requirements."""

    contrasts: dict[str, RequiredContrast] = at("contrasts", keyed("name", one(RequiredContrast)))
    """Contrasts of images that requirements ask for, with what each source costs."""

    requirements: tuple[dict[str, Any], ...] = at("requirements", tuple_of(plain))
    """Verdict of each requirement: `name`, `verdict`, `value`, `limit` and the confidence of the campaign.
    """


@dataclass(frozen=True, eq=False, repr=False)
class LoopMargins(Data):
    """Margins of one signal at the break, with the loops of the other signals closed.

    >>> margins = flexsc.Scenario.example("wheel-fast-mode").margins().loops["command"]
    >>> round(margins.gain_above, 2), round(margins.delay, 3), round(margins.modulus, 4)
    (3.03, 80.738, 0.6247)
    """

    signal: str = at("signal", plain)
    """Name of the signal."""

    gain_crossings: Columns = at(
        "gain", columns(frequency="frequency_rad_s", phase="phase_rad", delay="delay_s")
    )
    """Crossings of the unit circle, where the loop gain is 1, in increasing order of frequency.
    `frequency`: frequency (rad/s); `phase`: phase margin (rad), from -pi to pi: positive if the loop may
    lag by it, negative if it may lead; `delay`: delay (s) that uses up the phase; none for several
    samples in a period, where a delay is more than a phase.
    """

    phase_crossings: Columns = at("phase", columns(frequency="frequency_rad_s", factor="factor"))
    """Crossings of the negative real axis, in increasing order of frequency. `frequency`: frequency
    (rad/s); `factor`: gain margin: factor on the loop gain at which the loop is at the limit of
    stability.
    """

    gain_below: float = at("gain_below", number)
    """Largest factor below 1 on the loop gain at which the loop is at the limit of stability; 0 if there is
    none.
    """

    gain_above: float = at("gain_above", bounded)
    """Smallest factor above 1 on the loop gain at which the loop is at the limit of stability. Infinite if
    there is none.
    """

    phase: float = at("phase_rad", number)
    """Smallest phase (rad), of either sign, that makes the loop unstable; pi if there is none."""

    delay: float = at("delay_s", bounded)
    """Smallest delay (s) that makes the loop unstable; it is not computed for several samples of the law in
    a period. Infinite if there is none.
    """

    modulus: float = at("modulus.margin", number)
    """Modulus margin: smallest distance of the loop transfer from -1."""

    modulus_frequency: float = at("modulus.frequency_rad_s", number)
    """Frequency (rad/s) at which it is attained (`modulus`)."""

    disk: float = at("disk.alpha", number)
    """Disk margin alpha: gains of (2 - alpha)/(2 + alpha) to its inverse, and phases up to 2 atan(alpha/2),
    at once.
    """

    disk_frequency: float = at("disk.frequency_rad_s", number)
    """Frequency (rad/s) at which it is attained (`disk`)."""

    disk_gains: tuple[float, float] = at("disk.gains", tuple_of(number))
    """Factors on the loop gain within which the loop is stable (`disk`)."""

    disk_phase: float = at("disk.phase_rad", number)
    """Phase (rad) of either sign up to which the loop is stable (`disk`)."""


@dataclass(frozen=True, eq=False, repr=False)
class SettlingTime(Data):
    """Settling time of an angle after a step about an axis.

    >>> times = flexsc.Scenario.example("attitude-hold").margins().settling_times
    >>> times[0].step, times[0].angle, times[0].time < 100.0
    ('roll', 'roll', True)
    """

    step: str = at("step", plain)
    """Axis of the step: `roll`, `pitch` or `yaw`, and `angle` for a body with one axis."""

    angle: str = at("angle", plain)
    """Axis of the angle, in the same words."""

    time: float = at("time_s", bounded)
    """Time (s) after which the angle stays within 5 % of the step, a bound by the poles of the loop;
    infinite if a part does not decay.
    """


@dataclass(frozen=True, eq=False, repr=False)
class StabilityMargins(MarginsFigure, Data):
    """Margins of a stable loop: of each signal at the break, and of all together.

    >>> margins = flexsc.Scenario.example("attitude-hold").margins("torque")
    >>> list(margins.loops), margins.disk <= min(each.disk for each in margins.loops.values())
    (['torque_roll', 'torque_pitch', 'torque_yaw'], True)
    """

    spectral_radius: float = at("spectral_radius", number)
    """Largest magnitude of a pole of the closed loop."""

    loop: Literal["command", "torque", "measurement"] = at("loop", plain)
    """Point at which the loop is cut open."""

    period: float = at("period_s", number)
    """Period (s) after which the loop repeats."""

    samples: int = at("samples", plain)
    """Samples of the law in a period."""

    loops: dict[str, LoopMargins] = at("loops", keyed("signal", one(LoopMargins)))
    """Margins of each signal at the break, with the loops of the others closed."""

    modulus: float = at("modulus.margin", number)
    """Modulus margin of all signals together: the inverse of the largest gain of the sensitivity."""

    modulus_frequency: float = at("modulus.frequency_rad_s", number)
    """Frequency (rad/s) at which it is attained (`modulus`)."""

    disk: float = at("disk.alpha", number)
    """Disk margin alpha of all signals together, for any perturbation of the matrix of loop gains."""

    disk_frequency: float = at("disk.frequency_rad_s", number)
    """Frequency (rad/s) at which it is attained (`disk`)."""

    disk_gains: tuple[float, float] = at("disk.gains", tuple_of(number))
    """Factors on the loop gain within which the loop is stable (`disk`)."""

    disk_phase: float = at("disk.phase_rad", number)
    """Phase (rad) of either sign up to which the loop is stable (`disk`)."""

    independent_disk: float = at("independent_disk.alpha", number)
    """Disk margin alpha of all signals together, each with a perturbation of its own; it is not computed
    for one signal, nor for several samples of the law in a period.
    """

    independent_disk_frequency: float = at("independent_disk.frequency_rad_s", number)
    """Frequency (rad/s) at which it is attained (`independent_disk`)."""

    independent_disk_gains: tuple[float, float] | None = at("independent_disk.gains", tuple_of(number))
    """Factors on the loop gain within which the loop is stable (`independent_disk`)."""

    independent_disk_phase: float = at("independent_disk.phase_rad", number)
    """Phase (rad) of either sign up to which the loop is stable (`independent_disk`)."""

    delay: float = at("common_delay_s", bounded)
    """Smallest additional delay (s) of all actuators together that makes the loop unstable. Infinite if
    there is none.
    """

    settling_times: tuple[SettlingTime, ...] = at("settling", tuple_of(one(SettlingTime)))
    """Settling times of each angle after a step of the target about each axis; none if they cannot be
    computed.
    """

    mirrors: dict[str, LoopMargins] = at("mirrors", keyed("signal", one(LoopMargins)))
    """Margins of the loops of fine mirrors, cut open at the means of their guidance sensors."""

    frequency: Values = at("singular_values", column("frequency_rad_s"))
    """Frequencies (rad/s) of the singular values, up to pi over the period, which follow the resonances.
    With several samples of the law in a period, the motion at a frequency also has its aliases.
    """

    sensitivity: Values = at("singular_values", column("sensitivity"))
    """Largest singular value of the sensitivity S = (1 + L)^-1."""

    complementary: Values = at("singular_values", column("complementary"))
    """Largest singular value of the complementary sensitivity T = 1 - S."""


_WINDOW_RMS = attributes(
    window=("window_s", number),
    separation=("separation_s", number),
    mpe=("mpe", number),
    rpe_uniform=("rpe_uniform", number),
    rpe_end=("rpe_end", number),
    rpe_middle=("rpe_middle", number),
    smear=("smear", number),
    beyond_smear=("beyond_smear", number),
    pde=("pde", number),
)


_MACHINE_LINES = attributes(
    frequency=("frequency_rad_s", number),
    rms=("rms", number),
    peak=("peak", number),
)


@dataclass(frozen=True, eq=False, repr=False)
class OutputNoise(Data):
    """Noise of an output, in its unit.

    >>> noise = flexsc.Scenario.example("attitude-hold").spectrum().outputs["roll"]
    >>> max(noise.rms_by_source, key=noise.rms_by_source.get), noise.unit
    ('sensor.sampled.rate_noise', 'rad')
    """

    output: str = at("output", plain)
    """Name of the output."""

    unit: str = at("unit", plain)
    """Unit of the output."""

    rms: float = at("rms", number)
    """Rms over time."""

    sample_rms: float = at("sample_rms", number)
    """Rms at the samples of the law."""

    rms_by_source: dict[str, float] = at("rms_by_source", named("sources", number))
    """Rms over time from each source."""

    density: Values = at("density", array)
    """One-sided power spectral density (unit² per Hz): of noise at the samples, of broadband loads of the
    motion itself.
    """

    density_by_source: dict[str, Values] = at("density_by_source", named("sources", array))
    """Density from each source (unit² per Hz)."""

    cumulative_rms: Values = at("cumulative_rms", array)
    """Rms up to each frequency."""

    window: dict[str, float] | None = at("window", _WINDOW_RMS)
    """Indices over windows, if a window is given. `window`: length of the window (s); `separation`: time
    from the start of a window to that of the next (s); `mpe`: mean over the window: mean performance
    error, displacement of an exposure; `rpe_uniform`: output less the mean, at any time of the window:
    relative performance error, jitter of an exposure with its smear; `rpe_end`: output less the mean, at
    the end of the window; `rpe_middle`: output less the mean, in the middle of the window; `smear`:
    straight line through the output, about its mean: smear of an exposure; `beyond_smear`: rest beyond
    mean and straight line; `pde`: difference of the means over two windows: performance drift or
    reproducibility error; none without a separation.
    """

    machines: dict[str, dict[str, float]] | None = at("machines", keyed("source", _MACHINE_LINES))
    """Lines of machines, each at its worst frequency for the output; none without such machines."""

    mtf: float = at("mtf", number)
    """Modulation transfer of the noise at the Nyquist frequency of the pixels, if a pixel is given and the
    output is an angle. NaN if there is none.
    """


_IMAGE_FACTORS = attributes(
    spatial_frequency=("spatial_frequency", number),
    detector=("detector", number),
    diffraction=("diffraction", number),
    smear=("smear", number),
    product=("product", number),
)


_ENERGY_CIRCLE = attributes(
    major_rms=("major_rms_rad", number),
    minor_rms=("minor_rms_rad", number),
    radius_50=("radius_50_rad", number),
    radius_80=("radius_80_rad", number),
    radius_95=("radius_95_rad", number),
)


@dataclass(frozen=True, eq=False, repr=False)
class MirrorSensitivity(Data):
    """Sensitivity of a fine mirror: the motion of a line of sight behind it, relative to that before it,
    without its limits.

    >>> mirror = {"frequency": 1885.0, "damping": 0.6, "period": 0.005, "gain": 0.25}
    >>> craft = flexsc.Scenario.example("wheel-run-up").with_("line_of_sight[0].mirror", mirror)
    >>> found = craft.spectrum(speeds=[40.0]).mirrors[0]
    >>> found.point, bool(found.sensitivity[0] < 0.1), found.peak > 1.0
    ('bench', True, True)
    """

    line: int = at("line", plain)
    """Index of the line of sight."""

    point: str = at("point", plain)
    """Point of the line of sight."""

    spectral_radius: float = at("spectral_radius", number)
    """Largest magnitude of a pole of the mirror's loop over its period."""

    crossing_hz: float = at("crossing_hz", number)
    """Lowest frequency (Hz) from which on the mirror enlarges the motion; none if it does at no frequency.
    NaN if there is none.
    """

    peak: float = at("peak", number)
    """Largest ratio of the motion behind the mirror and before it."""

    peak_hz: float = at("peak_hz", number)
    """Frequency (Hz) of the largest ratio."""

    frequency_hz: Values = at("frequency_hz", array)
    """Frequencies (Hz) up to half the rate of the loop."""

    sensitivity: Values = at("sensitivity", array)
    """Ratio of a sine behind the mirror, at its own frequency, and before it."""


@dataclass(frozen=True, eq=False, repr=False)
class NoiseSpectrum(NoiseFigure, Data):
    """Noise of some outputs of a loop.

    >>> spectrum = flexsc.Scenario.example("attitude-hold").spectrum(["pitch"], window=1.0)
    >>> noise = spectrum.outputs["pitch"]
    >>> noise.window["mpe"] < noise.rms < 1e-4
    True
    """

    spectral_radius: float = at("spectral_radius", number)
    """Largest magnitude of a pole of the closed loop over a period."""

    period: float = at("period_s", number)
    """Period (s) after which the loop repeats."""

    samples: int = at("samples", plain)
    """Samples of the law in a period."""

    nyquist_hz: float = at("nyquist_hz", number)
    """Nyquist frequency of the law (Hz)."""

    sources: tuple[str, ...] = at("sources", tuple_of(plain))
    """Sources of noise: keys of the scenario."""

    frequency_hz: Values = at("frequency_hz", array)
    """Frequencies of the densities (Hz): up to the Nyquist frequency, and as far as broadband loads and
    lines of machines go.
    """

    outputs: dict[str, OutputNoise] = at("outputs", keyed("output", one(OutputNoise)))
    """Noise of each output."""

    image: dict[str, float] | None = at("image", _IMAGE_FACTORS)
    """Further factors of the contrast, if a pixel is given. `spatial_frequency`: spatial frequency
    (cycles/rad); `detector`: contrast of the mean over a pixel; `diffraction`: contrast of a circular
    aperture without a central obscuration, if its diffraction is given; `smear`: contrast under a steady
    rate over the exposure, if one is given: negative where light and dark have changed places;
    `product`: product of these. None if there is none.
    """

    circles: dict[int, dict[str, float]] = at("circles", keyed("line", _ENERGY_CIRCLE))
    """Circles of the energy of an image by noise and broadband loads, for each line of sight, if a pixel is
    given: over the exposures.
    """

    contrasts: dict[str, RequiredContrast] = at("contrasts", keyed("name", one(RequiredContrast)))
    """Contrasts of images that requirements ask for."""

    wheels: WheelSpectrum | None = at("wheels", plain)
    """Lines of the imbalance of the wheels, if they have one. None if there is none."""

    mirrors: dict[int, MirrorSensitivity] = at("mirrors", keyed("line", one(MirrorSensitivity)))
    """Sensitivities of the fine mirrors of lines of sight, over frequency."""


@dataclass(frozen=True, eq=False, repr=False)
class TunedMeasure(Data):
    """Quantity besides the margins that a tuning minimised or limited, with its largest value of all
    plants.

    >>> scenario = flexsc.Scenario.example("attitude-hold")
    >>> ranges = {"law.per_axis.roll.pd.k_d": (100.0, 900.0)}
    >>> measure = scenario.tune(ranges, objective="settling", keep=["margin>=0.5"]).measures["settling"]
    >>> measure.value < measure.before
    True
    """

    name: str = at("name", plain)
    """Name: `settling`, or that of a requirement."""

    unit: str = at("unit", plain)
    """Unit of the values and of the limit."""

    is_objective: bool = at("is_objective", plain)
    """True if it was minimised."""

    before: float = at("before", bounded)
    """Largest value with the keys of the scenario; infinite if it has no bound."""

    value: float = at("after", bounded)
    """Largest value with the tuned keys; infinite if it has no bound."""

    limit: float = at("limit", number)
    """Limit that was to be kept. NaN if there is none."""

    worst_plant: int = at("worst_plant", plain)
    """Index of the plant with the largest value."""


@dataclass(frozen=True, eq=False, repr=False)
class TunedPlant(Data):
    """Margins of a plant before and after tuning.

    >>> tuned = flexsc.Scenario.example("earth-observer").tune({"law.attitude.damping": (0.4, 1.5)})
    >>> plant = tuned.plants[0]
    >>> round(plant.margin_before, 4), round(plant.margin, 4)
    (0.5773, 0.7437)
    """

    values: dict[str, float] = at("values", plain)
    """Values of the uncertain keys at its corner; none for the nominal plant."""

    margin_before: float = at("before.margin", number)
    """Modulus margin of all signals together; 0 if the loop is not stable (with the keys of the scenario).
    """

    frequency_before: float = at("before.frequency_rad_s", number)
    """Frequency (rad/s) at which it is attained; it is often attained at several, of which this is one
    (with the keys of the scenario).
    """

    spectral_radius_before: float = at("before.spectral_radius", number)
    """Largest magnitude of a pole of the closed loop (with the keys of the scenario)."""

    margin: float = at("after.margin", number)
    """Modulus margin of all signals together; 0 if the loop is not stable (with the tuned keys)."""

    frequency: float = at("after.frequency_rad_s", number)
    """Frequency (rad/s) at which it is attained; it is often attained at several, of which this is one
    (with the tuned keys).
    """

    spectral_radius: float = at("after.spectral_radius", number)
    """Largest magnitude of a pole of the closed loop (with the tuned keys)."""


@dataclass(frozen=True, eq=False, repr=False)
class TunedScenario(TuningFigure, Data):
    """Tuned scenario, with the margins of its plants before and after.

    >>> tuned = flexsc.Scenario.example("earth-observer").tune({"law.attitude.damping": (0.4, 1.5)})
    >>> list(tuned.keys), tuned.scenario.tune({"law.attitude.damping": (0.4, 1.5)}).keys == tuned.keys
    (['law.attitude.damping'], True)
    """

    scenario: Scenario = at("scenario", plain)
    """Scenario with the tuned keys."""

    loop: Literal["command", "torque", "measurement"] = at("loop", plain)
    """Point at which the loops are cut open."""

    measures: dict[str, TunedMeasure] = at("measures", keyed("name", one(TunedMeasure)))
    """Quantities besides the margins that were minimised or limited."""

    margin_limit: float = at("margin_limit", number)
    """Least modulus margin that every plant was to keep. NaN if there is none."""

    least_margin_before: float = at("least_margin_before", number)
    """Least modulus margin of all plants with the keys of the scenario."""

    least_margin: float = at("least_margin", number)
    """Least modulus margin of all plants with the tuned keys."""

    bandwidth_gain_before: float = at("bandwidth_gain_before", number)
    """Least loop gain of the nominal plant at the bandwidth, with the keys of the scenario. NaN if there is
    none.
    """

    bandwidth_gain: float = at("bandwidth_gain", number)
    """Least loop gain of the nominal plant at the bandwidth, with the tuned keys. NaN if there is none."""

    steps: int = at("steps", plain)
    """Number of steps of the search."""

    keys_before: dict[str, float] = at("keys", keyed("key", part("before", number)))
    """Value in the scenario that was tuned (`keys`)."""

    keys: dict[str, float] = at("keys", keyed("key", part("after", number)))
    """Value of each tuned key."""

    keys_range: dict[str, tuple[float, float]] = at("keys", keyed("key", part("range", tuple_of(number))))
    """Least and largest value (`keys`)."""

    plants: tuple[TunedPlant, ...] = at("plants", tuple_of(one(TunedPlant)))
    """Plants: the nominal one, then the corners of the uncertain keys."""


@dataclass(frozen=True, eq=False, repr=False)
class WorstCase(WorstFigure, Data):
    """Worst point of the ranges of the uncertain keys that a search found.

    >>> scenario = flexsc.Scenario.example("slew-wheel-lqg")
    >>> worst = scenario.worst(requirement="stability", points=20)
    >>> worst
    WorstCase(quantity='stability', value=2.435e-05, nominal=2.154e-05)
    """

    quantity: str = at("quantity", plain)
    """Name of the metric, the requirement or the margin."""

    unit: str = at("unit", plain)
    """Unit of the values."""

    least: bool = at("least", plain)
    """True if small values are bad."""

    nominal: float = at("nominal", number)
    """Value with the keys of the scenario itself, or as near to them as their ranges are."""

    value: float = at("worst", number)
    """Value at the worst point."""

    keys: dict[str, float] = at("keys", plain)
    """Value of each uncertain key at the worst point."""

    unstable: bool = at("unstable", plain)
    """True if the quantity is a margin and the loop is not stable at the worst point."""

    point_count: int = at("points", plain)
    """Number of points that were assessed."""

    without_value: int = at("without_value", plain)
    """Number of points without a value."""

    ranges: dict[str, tuple[float, float]] = at("ranges", named("keys", tuple_of(number)))
    """Range of each uncertain key."""

    points: Values = at("rows", array)
    """Points that were assessed, one in each row, with the keys as columns."""

    values: Values = at("values", array)
    """Value at each point; NaN at a point without one."""

    scenario: Scenario = at("scenario", plain)
    """Scenario with the keys of the worst point, and without uncertain ones."""


@dataclass(frozen=True, eq=False, repr=False)
class Witness(Data):
    """State at the start and inputs that bring the output to an end of its range.

    >>> scenario = flexsc.Scenario.example("bounded-jitter").with_("bound[0].limits", [-5e-6, 5e-6])
    >>> witness = scenario.bound()[0].witness
    >>> abs(witness.simulated / witness.value - 1.0) < 1e-9
    True
    """

    time: float = at("time_s", number)
    """Time (s) at which the output has this value."""

    value: float = at("value", number)
    """Value of the output, in its unit."""

    simulated: float = at("simulated", number)
    """Value in a run of the engine from this state under these inputs, if a run is possible. NaN if there
    is none.
    """

    frequency_factor: float = at("frequency_factor", number)
    """Factor on every natural frequency of the scenario."""

    damping_factor: float = at("damping_factor", number)
    """Factor on every damping ratio."""

    states: tuple[str, ...] = at("states", tuple_of(plain))
    """Names of the states, in the order of the linear model."""

    start: Values = at("start", array)
    """State at the start, of the states in their order."""

    inputs: dict[str, tuple[Values, Values]] = at(
        "inputs", keyed("name", parts(("times_s", array), ("values", array)))
    )
    """Times (s) from which each value of an input acts, and the values, by the name of the input."""

    scenario: Scenario | None = at("scenario", plain)
    """Scenario of the body from this state, under these inputs as disturbances; none if no file can have
    them.
    """


@dataclass(frozen=True, eq=False, repr=False)
class OutputBound(BoundFigure, Data):
    """Guaranteed range of an output over sets of states, inputs and parameters, and the verdict.

    >>> bound = flexsc.Scenario.example("bounded-jitter").bound()[0]
    >>> bound.output, bound.verdict
    ('roll', 'proved')
    >>> bool((bound.rows["high"] <= bound.range[1]).all())
    True
    """

    output: str = at("output.name", plain)
    """Name of the output."""

    unit: str = at("output.unit", plain)
    """Unit of the signal (`output`)."""

    elastic: bool = at("elastic", plain)
    """True if the output is without the rigid motion."""

    limits: tuple[float, float] | None = at("limits", tuple_of(number))
    """Limits of the claim, in the unit of the output. None if there is none."""

    until: float = at("until_s", number)
    """End of the interval of time (s)."""

    verdict: Literal["proved", "violated", "undecided", "unlimited"] = at("verdict", plain)
    """Outcome; `unlimited` without limits."""

    range: tuple[float, float] = at("range", tuple_of(number))
    """Guaranteed range over the whole interval, rounded outwards."""

    attained: tuple[float, float] = at("attained", tuple_of(number))
    """Range that is attained by states and inputs that are known."""

    attained_at: tuple[float, float] = at("attained_at_s", tuple_of(number))
    """Times (s) at which the range is attained."""

    safe_until: float = at("safe_until_s", number)
    """Time (s) before which no limit is passed: the end of the interval if the claim is proved. NaN if
    there is none.
    """

    violated_at: float = at("violated_at_s", number)
    """First time (s) at which a limit is passed for a state and inputs of the sets. NaN if there is none."""

    gap: float = at("gap", number)
    """Largest excess of the guaranteed range over the limits, if the claim is undecided. NaN if there is
    none.
    """

    witness: Witness | None = at("witness", one(Witness))
    """State and inputs that violate the claim the most. None if there is none."""

    rows: Columns = at("rows", columns(time="time_s", low="low", high="high"))
    """Range at instants. The output may leave it between two instants, but not `range`. `time`: time (s);
    `low`: guaranteed lower bound; `high`: guaranteed upper bound.
    """
