"""Analyses of a scenario: its linear loop, margins, noise, budgets, bounds and tuning."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Literal, cast

from flexsc import _native as engine
from flexsc._scenario_file import ScenarioFile

if TYPE_CHECKING:
    from pathlib import Path

    import numpy.typing as npt

    from flexsc._budget import PointingBudget
    from flexsc._linear import Break, Linear
    from flexsc._loop_margins import StabilityMargins
    from flexsc._noise import NoiseSpectrum
    from flexsc._output_bounds import OutputBound
    from flexsc._scenario import Scenario
    from flexsc._structured_tuning import TunedScenario
    from flexsc._worst_case import Margin, WorstCase


class ScenarioAnalysis(ScenarioFile):
    """The analyses of a scenario."""

    __slots__ = ()

    @property
    def _scenario(self) -> Scenario:
        """The scenario, which is the only class with these analyses."""
        return cast("Scenario", self)

    def linearise(
        self,
        at: float = 0.0,
        *,
        period: float | None = None,
        delay: float | None = None,
        loop: Break | None = None,
    ) -> Linear:
        """Return the scenario's body at rest as a linear model, or its open loop.

        The states are rigid motion and modes. The inputs are the torques of the actuator (N m). The outputs
        are the measured quantities, angles and rates at the sensor with their elastic parts, followed by all
        states. The momentum of the wheels couples the axes; the environment and limits are left out.

        Args:
            at: The time (s) whose natural frequencies are used if they drift.
            period: Sampling period (s), over which inputs are held; None for continuous time.
            delay: The delay of the inputs (s); None for the delay of the scenario's wheel.
            loop: Return the open loop of a linear law (`pd`, `attitude` with its integral and filters,
                `state_space`), with the Kalman filter or attitude filter that the law reads, sampled with the
                law's period (or the shortest with which all parts repeat) and opened at the `command` of the
                law, at the `torque` of the actuator, or at the `measurement` of angles and rates. The signs
                are those of negative feedback: `closed()` closes the loop again.

        >>> flexsc.Scenario.example("relay-fixed").linearise(period=0.5).a.shape
        (6, 6)

        Raises:
            ScenarioError: The body is not a linear system, because it has driven appendages, or the loop is
                not linear: the key, and the reason.
            ValueError: A time is not accepted, or there is no such point.
        """
        from flexsc._linear import Linear

        return Linear.of(engine.linearise(self._native, at, period, delay, loop))

    def margins(self, loop: Break = "command") -> StabilityMargins:
        """Return the stability margins of the scenario's loop, opened at a point: `flexsc margins`.

        Each signal at the break has gain, phase and delay margins at every crossing, a modulus and a disk
        margin, with the loops of the others closed; all signals together have a modulus and a disk margin.

        Args:
            loop: The point: the `command` of the law, the `torque` of the actuator, or the `measurement` of
                angles and rates.

        >>> margins = flexsc.Scenario.example("wheel-fast-mode").margins()
        >>> margins.loops["command"].gain_crossings["frequency"].round(3)[:3]
        array([0.015])

        Raises:
            ScenarioError: The loop is not linear: the key, and the reason.
            ValueError: The closed loop is not stable: its worst pole; or there is no such point.
        """
        from flexsc._loop_margins import stability_margins

        return stability_margins(self._scenario, loop)

    def tune(
        self,
        ranges: Mapping[str, tuple[float, float]],
        *,
        objective: str = "margin",
        keep: Sequence[str] = (),
        loop: Break = "command",
        bandwidth: float | None = None,
        corners: bool = True,
    ) -> TunedScenario:
        """Return the scenario with the best keys for an objective, within limits: `flexsc tune --vary`.

        The worst of all plants counts: the nominal one, and the corners of `[uncertain]`.

        Args:
            ranges: The least and the largest value of each key, such as `{"law.pd.k_d": (10.0, 400.0)}`.
            objective: `"margin"`, the least modulus margin of all signals together, is maximised.
                `"settling"`, the time after a step of the target in which the angles settle within 5 %, is
                minimised, and so is the rms of the pointing index of the `[[requirement]]` of another name.
            keep: Limits that all plants keep: `"margin>=0.5"`, `"settling<=60"` (s), or the name of a
                `[[requirement]]` with its own limit.
            loop: The point at which the loops are opened.
            bandwidth: A frequency (rad/s) at which the loop gain of the nominal plant stays 1 or more.
            corners: Whether there is a plant for each corner of the uncertain keys.

        >>> scenario = flexsc.Scenario.example("earth-observer")
        >>> tuned = scenario.tune({"law.attitude.damping": (0.4, 1.5)}, bandwidth=0.1)
        >>> tuned.least_margin > tuned.least_margin_before
        True

        Raises:
            ScenarioError: A key cannot be tuned, the loop is not linear, or there is no requirement of the
                name: the key, and the reason.
            ValueError: The loop of a plant is not stable with the keys of the scenario, or a text of
                `objective` or `keep` is not one of these.
        """
        from flexsc._structured_tuning import tune

        return tune(self._scenario, ranges, loop, (objective, keep), bandwidth, corners)

    def spectrum(
        self,
        signals: Sequence[str] | None = None,
        window: float | None = None,
        separation: float | None = None,
        speeds: npt.ArrayLike | None = None,
    ) -> NoiseSpectrum:
        """Return the noise of the scenario's loop, exact from its linear model: `flexsc spectrum`.

        The noise is that of the sensors, of their rounding, and of random torques. Limits and steady
        disturbances are left out; the body is about its target at rest.

        Args:
            signals: Names of outputs, such as `roll`, `roll_rate`, `command_roll`, `mode0_displacement` and
                `line_of_sight0_x`; `["all"]` for all of them, None for measured angles and lines of sight.
            window: Length (s) of windows for pointing indices.
            separation: Time (s) from the start of a window to that of the next, for differences of means.
            speeds: Speeds (rad/s) of the wheels for the lines of their imbalance; None for 48 up to their
                largest.

        >>> spectrum = flexsc.Scenario.example("attitude-hold").spectrum(["roll", "command_roll"])
        >>> spectrum.sources
        ('sensor.sampled.noise', 'sensor.sampled.rate_noise')
        >>> spectrum.outputs["command_roll"].unit
        'N m'

        Raises:
            ScenarioError: A part has no linear model: the key, and the reason.
            ValueError: The closed loop is not stable, noise grows without limit, or there is no such output.
        """
        from flexsc._noise import noise_spectrum

        return noise_spectrum(self._scenario, signals, window, separation, speeds)

    def budget(self, runs: int = 20, jobs: int = 0) -> PointingBudget:
        """Return the pointing budget of the scenario's `[[requirement]]` tables: `flexsc budget`.

        Each pointing index has its levels at 68.3, 95.5 and 99.7 %, temporal, ensemble and mixed: by the
        order statistics of a campaign, by convolution of its error sources, and by the rule of k sigma.

        Args:
            runs: Number of runs of the campaign over the noise and the uncertain keys.
            jobs: Number of threads; 0 for one per core.

        >>> budget = flexsc.Scenario.example("slew-wheel-lqg").budget(runs=2)
        >>> [index.unit for index in budget.indices]
        ['rad', 'rad']

        Raises:
            ValueError: The scenario has no requirement on a pointing index, or a run fails.
        """
        from flexsc._budget import pointing_budget

        return pointing_budget(self._scenario, runs, jobs)

    def bound(self) -> list[OutputBound]:
        """Return the guaranteed ranges of the outputs that the scenario's `[[bound]]` names: `flexsc bound`.

        Each is over all states at the start, inputs in time, frequencies and damping ratios of the claim. It
        has the verdict about its limits.

        >>> import flexsc
        >>> [bound.verdict for bound in flexsc.Scenario.example("bounded-jitter").bound()]
        ['proved', 'proved']

        Raises:
            ScenarioError: The scenario has no claims, or its body or a claim is not accepted: the key, and
                the reason.
        """
        from flexsc._output_bounds import output_bounds

        return output_bounds(self._scenario)

    def worst(
        self,
        metric: str | None = None,
        *,
        requirement: str | None = None,
        margin: Margin | None = None,
        loop: Break = "command",
        least: bool = False,
        points: int = 200,
        jobs: int = 0,
    ) -> WorstCase:
        """Return the worst case over the scenario's `[uncertain]` keys: `flexsc worst`.

        Half of the points are spread over the ranges of the keys; searches from the worst of them use the
        others. What is found is a witness: it can be worse, but not better. All runs have the same noise.

        Args:
            metric: A metric, or an element `NAME[i]` of a list of them.
            requirement: A requirement of the scenario, by its name, in place of a metric.
            margin: A stability margin in place of a metric, the least of all loops: `modulus`, `disk`,
                `gain`, `phase` or `delay`.
            loop: The point at which the loops are opened for a margin.
            least: Whether small values of the metric are bad.
            points: Largest number of points, each of which is a run, or a loop of a margin.
            jobs: Number of threads of the runs; 0 for one per core.

        >>> worst = flexsc.Scenario.example("slew-wheel-lqg").worst("settling_time_s", points=10)
        >>> worst.value >= worst.nominal
        True

        Raises:
            ScenarioError: The scenario has no uncertain keys, or no linear loop: the key, and the reason.
            ValueError: There is no such quantity, or it has no value at any point.
        """
        from flexsc._worst_case import worst_case

        return worst_case(self._scenario, metric, requirement, margin, loop, least, points, jobs)

    def report(self, path: str | os.PathLike[str], runs: int = 100, *, force: bool = False) -> bool:
        """Write a page for a design review, and return whether all its verdicts are good: `flexsc report`.

        The page has the spacecraft, margins, noise, one run, claims, budgets, worst cases and a campaign with
        their figures, and the command that repeats each.

        Args:
            path: The page, `FILE.html`.
            runs: Number of runs of the campaign; 0 leaves it out.
            force: Whether a file of other content is replaced.

        >>> import flexsc, pathlib, tempfile
        >>> scenario = flexsc.Scenario.example("attitude-hold").with_("duration", 40.0)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     page = pathlib.Path(folder) / "study.html"
        ...     met = scenario.report(page, runs=0)
        ...     met, page.stat().st_size > 100_000
        (True, True)

        Raises:
            ValueError: The page cannot be written, or the scenario has parts that are written in Python.
        """
        from flexsc._report import report

        return report(self._scenario, path, runs, force)

    def export_c(
        self,
        path: str | os.PathLike[str],
        *,
        name: str | None = None,
        calls: int = 20_000,
        guests: Sequence[Literal["cfs", "fprime"]] = (),
        force: bool = False,
    ) -> list[Path]:
        """Write the control system as C99 for a flight computer, and return its files: `flexsc export-c`.

        The C is translated from the Rust code that runs call. A driver replays the calls of a run and
        compares their outputs by bits: `make check` in the directory.

        Args:
            path: The directory.
            name: Prefix of all names in C; None for the scenario's name.
            calls: Largest number of calls of the run that are recorded as vectors.
            guests: Frameworks of flight software for which the control system is also written: as an app of
                cFS, as a component of F Prime.
            force: Whether files of other content are replaced.

        >>> import flexsc, tempfile
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     files = flexsc.Scenario.example("relay-sampled").export_c(folder, name="relay")
        ...     [file.name for file in files if file.name.startswith("relay")]
        ['relay.c', 'relay.h']

        Raises:
            ValueError: The law has no code for flight, or a file exists with other content.
        """
        from flexsc._flight_code import export_c

        return export_c(self._scenario, path, name, calls, guests, force)
