//! Linear loop of a fine mirror: what it leaves of a sine of the line of sight, and its margins.
//!
//! The guidance sensor gives the mean m of the error x - y over each period T, and n periods later the command of the mirror
//! follows: `u[k+n+1] = u[k+n] + g m[k]`. Under x = exp(j w t), with z = exp(j w T), the command is U z^k with U = g M/(z^n (z - 1) +
//! g p), where M is the mean of exp(j w s) over a period, psi(s) the angle of the mirror at the time s of a period in which
//! the command is z^k, and p its mean. The error z^k (exp(j w s) - U psi(s)) has the line S = 1 - U mean(exp(-j w s) psi(s)) at w, and
//! aliases at w + 2 pi k/T.

use std::f64::consts::TAU;

use flexsc_numerics::scalar_search::{maximum, root};
use nalgebra::{Complex, DMatrix, Matrix2, Vector2};
use schemars::JsonSchema;
use serde::Serialize;

use crate::eigenvalues::eigenvalues;
use crate::linear_model::Signal;
use crate::margins::frequency_response::{modulus, unit_circle};
use crate::margins::{StabilityMargins, UnstableLoop, frequency_grid};
use crate::open_loop::{LoopBreak, OpenLoop, TransferMatrices};
use flexsc_scenario::{FineMirror, Scenario};

/// Angle (rad) up to which a mean over a period is a series.
const SMALL: f64 = 1e-3;

/// Loop of a fine mirror about one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct MirrorLoop {
    mirror: FineMirror,
    /// Period (s).
    pub period: f64,
    /// Rates of the mirror's angle beside its command, and their motion over a period.
    rates: Matrix2<f64>,
    flow: Matrix2<f64>,
}

/// Answer of a mirror's loop to a sine of the line of sight of one frequency.
#[derive(Clone, Debug)]
pub struct MirrorAnswer<'a> {
    within: &'a MirrorLoop,
    /// Frequency (rad/s).
    frequency: f64,
    /// Amplitude of the command.
    command: Complex<f64>,
    /// Angle and rate at the start of a period, less the command, for a command of 1.
    start: Vector2<Complex<f64>>,
}

/// Sensitivity of a fine mirror: the motion of a line of sight behind it, relative to that before it, without its limits.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct MirrorSensitivity {
    /// Index of the line of sight.
    pub line: usize,
    /// Point of the line of sight.
    pub point: String,
    /// Largest magnitude of a pole of the mirror's loop over its period.
    pub spectral_radius: f64,
    /// Lowest frequency (Hz) from which on the mirror enlarges the motion; none if it does at no frequency.
    pub crossing_hz: Option<f64>,
    /// Largest ratio of the motion behind the mirror and before it.
    pub peak: f64,
    /// Frequency (Hz) of the largest ratio.
    pub peak_hz: f64,
    /// Frequencies (Hz) up to half the rate of the loop.
    pub frequency_hz: Vec<f64>,
    /// Ratio of a sine behind the mirror, at its own frequency, and before it.
    pub sensitivity: Vec<f64>,
}

/// Returns the fine mirrors of a scenario with the indices of their lines of sight.
pub fn mirrors(scenario: &Scenario) -> impl Iterator<Item = (usize, FineMirror)> {
    scenario.line_of_sight.iter().enumerate().filter_map(|(index, line)| Some((index, line.mirror?)))
}

/// Returns the mean of exp(j angle s) over s from 0 to 1.
fn mean_turn(angle: f64) -> Complex<f64> {
    if angle.abs() < SMALL {
        return Complex::new(1.0 - angle * angle / 6.0, 0.5 * angle * (1.0 - angle * angle / 12.0));
    }
    (unit_circle(angle) - 1.0) / Complex::new(0.0, angle)
}

fn complex(matrix: &Matrix2<f64>) -> Matrix2<Complex<f64>> {
    matrix.map(|entry| Complex::new(entry, 0.0))
}

impl MirrorLoop {
    /// Creates the loop of a mirror.
    pub fn new(mirror: FineMirror) -> Self {
        let (frequency, damping) = (mirror.frequency.get(), mirror.damping.get());
        let period = mirror.period.seconds();
        let rates = Matrix2::new(0.0, 1.0, -frequency * frequency, -2.0 * damping * frequency);
        let flow = mirror.flow(period).fixed_view::<2, 2>(0, 0).into_owned();
        Self { mirror, period, rates, flow }
    }

    /// Returns the mean over a period of exp(-j w s) times the angle less the command, that begins at `start`.
    fn mean_beside(&self, w: f64, start: &Vector2<Complex<f64>>) -> Complex<f64> {
        let turned = complex(&self.rates) - Matrix2::from_diagonal_element(Complex::new(0.0, w));
        let change = (complex(&self.flow) * unit_circle(-w * self.period)) * start - start;
        // The mirror is damped: no turn is one of its rates.
        let integral = turned.try_inverse().map_or_else(Vector2::zeros, |inverse| inverse * change);
        integral[0] / self.period
    }

    /// Returns the answer to a sine of the line of sight of a frequency (rad/s), and of either sign.
    pub fn answer(&self, frequency: f64) -> MirrorAnswer<'_> {
        let z = unit_circle(frequency * self.period);
        let one = Vector2::new(Complex::new(1.0, 0.0), Complex::ZERO);
        // At the start of a period the angle is (z - flow)^-1 (1 - flow) of the command.
        let shifted = Matrix2::from_diagonal_element(z) - complex(&self.flow);
        let settled = one - complex(&self.flow) * one;
        let angle = shifted.try_inverse().map_or_else(Vector2::zeros, |inverse| inverse * settled);
        let start = angle - one;
        let mean = self.mean_beside(0.0, &start) + 1.0;
        let gain = self.mirror.gain.get();
        let waited = (0..self.mirror.computing_periods).fold(z - 1.0, |product, _| product * z);
        let command = mean_turn(frequency * self.period) * gain / (waited + mean * gain);
        MirrorAnswer { within: self, frequency, command, start }
    }

    /// Returns the loop of the line of sight with this index, cut open at the means of the guidance sensor.
    pub fn open_loop(&self, line: usize) -> OpenLoop {
        let name = format!("mirror{line}");
        let flow = self.mirror.flow(self.period);
        let (waiting, gain) = (self.mirror.computing_periods, self.mirror.gain.get());
        let size = 3 + waiting;
        let (mut a, mut b) = (DMatrix::zeros(size, size), DMatrix::zeros(size, 1));
        a.view_mut((0, 0), (3, 3)).copy_from(&flow.fixed_view::<3, 3>(0, 0));
        // The means wait, the latest first.
        (1..waiting).for_each(|place| a[(3 + place, 2 + place)] = 1.0);
        if waiting == 0 {
            b[(2, 0)] = gain;
        } else {
            a[(2, 2 + waiting)] = gain;
            b[(3, 0)] = 1.0;
        }
        let mut c = DMatrix::zeros(1, size);
        (0..3).for_each(|place| c[(0, place)] = flow[(3, place)] / self.period);
        let signal = |name: String, unit: &str| Signal { name, unit: unit.to_owned() };
        let own = [("angle", "rad"), ("rate", "rad/s"), ("command", "rad")];
        let own = own.map(|(state, unit)| signal(format!("{name}_{state}"), unit));
        let means = (0..waiting).map(|place| signal(format!("{name}_mean{place}"), "rad"));
        OpenLoop {
            transfer: TransferMatrices { a, b, c, d: DMatrix::zeros(1, 1) },
            states: own.into_iter().chain(means).collect(),
            signals: vec![signal(name.clone(), "rad")],
            opened: LoopBreak::Measurement,
            period: self.period,
            samples: 1,
        }
    }

    /// Returns the poles of the closed loop over a period; none if they cannot be computed.
    fn poles(&self) -> Vec<Complex<f64>> {
        let closed = self.open_loop(0).transfer.sensitivity();
        closed.and_then(|closed| eigenvalues(&closed.a)).unwrap_or_default()
    }

    /// Returns the largest magnitude of a pole of the closed loop; infinite if the poles cannot be computed.
    pub fn spectral_radius(&self) -> f64 {
        self.poles().into_iter().map(modulus).reduce(f64::max).unwrap_or(f64::INFINITY)
    }
}

impl MirrorAnswer<'_> {
    /// Returns the amplitude of the mirror's angle at the frequency w + 2 pi k/T.
    pub fn mirror(&self, k: i32) -> Complex<f64> {
        let w = self.alias(k);
        // The command has a mean of its own at the frequencies that differ from those of the samples.
        let held = mean_turn(-w * self.within.period);
        self.command * (held + self.within.mean_beside(w, &self.start))
    }

    /// Returns the amplitude of the error behind the mirror at the frequency w + 2 pi k/T.
    pub fn error(&self, k: i32) -> Complex<f64> {
        let own = if k == 0 { 1.0 } else { 0.0 };
        -self.mirror(k) + own
    }

    /// Returns the frequency w + 2 pi k/T (rad/s).
    pub fn alias(&self, k: i32) -> f64 {
        self.frequency + TAU * f64::from(k) / self.within.period
    }
}

impl MirrorSensitivity {
    /// Computes what the mirror of a line of sight leaves.
    fn new((line, mirror): (usize, FineMirror), point: &str) -> Self {
        let within = MirrorLoop::new(mirror);
        let left = |angle: f64| modulus(within.answer(angle / within.period).error(0));
        let angles = frequency_grid(&within.poles(), &[]);
        let sensitivity: Vec<f64> = angles.iter().map(|angle| left(*angle)).collect();
        let hertz = |angle: f64| angle / (TAU * within.period);
        let place = (0..angles.len()).max_by(|a, b| sensitivity[*a].total_cmp(&sensitivity[*b])).unwrap_or(0);
        let (low, high) = (place.saturating_sub(1), (place + 1).min(angles.len() - 1));
        let found = maximum(left, angles[low], angles[high]);
        let (angle, peak) =
            if found.1 > sensitivity[place] { found } else { (angles[place], sensitivity[place]) };
        let rises =
            (1..angles.len()).find(|place| sensitivity[*place - 1] < 1.0 && sensitivity[*place] >= 1.0);
        let crossing = rises.map(|place| root(|angle| left(angle) - 1.0, angles[place - 1], angles[place]));
        Self {
            line,
            point: point.to_owned(),
            spectral_radius: within.spectral_radius(),
            crossing_hz: crossing.map(hertz),
            peak,
            peak_hz: hertz(angle),
            frequency_hz: angles.into_iter().map(hertz).collect(),
            sensitivity,
        }
    }

    /// Computes what each mirror of a scenario leaves.
    pub fn all(scenario: &Scenario) -> Vec<Self> {
        mirrors(scenario).map(|own| Self::new(own, &scenario.line_of_sight[own.0].point)).collect()
    }
}

/// Computes the margins of the loop of each mirror of a scenario, by its line of sight.
///
/// # Errors
/// A loop that is not stable.
pub fn mirror_margins(scenario: &Scenario) -> Result<Vec<StabilityMargins>, UnstableLoop> {
    let margins = |(line, mirror)| StabilityMargins::new(&MirrorLoop::new(mirror).open_loop(line));
    mirrors(scenario).map(margins).collect()
}

#[cfg(test)]
mod tests {
    use flexsc_numerics::quantity::{Frequency, NonNegative, Positive};
    use flexsc_numerics::time::Span;

    use super::*;

    /// Mirror of 300 Hz, damped by 0.6, with a loop of 1 kHz. Source of all numbers: `tests/golden/fine_mirror.py`.
    fn bench() -> MirrorLoop {
        let positive = |value: f64| Positive::new(value).expect("positive");
        MirrorLoop::new(FineMirror {
            frequency: Frequency::new(TAU * 300.0).expect("a frequency"),
            damping: positive(0.6),
            period: Span::from_seconds(1e-3),
            gain: positive(0.25),
            computing_periods: 1,
            noise: NonNegative::new(2e-8).expect("a size"),
            stroke: None,
            rate: None,
        })
    }

    #[test]
    fn a_sine_is_left_as_by_quadrature() {
        let bench = bench();
        assert!((bench.spectral_radius() - 0.702_175_186_800_462_6).abs() < 1e-12);
        for (hertz, exact) in [
            (1.0, 0.025_133_253_152),
            (22.0, 0.557_250_440_112),
            (50.0, 1.249_749_242_517),
            (98.112_21, 1.641_212_396_5),
            (150.0, 1.281_665_656_719),
        ] {
            let found = modulus(bench.answer(TAU * hertz).error(0));
            assert!((found - exact).abs() < 1e-11, "{hertz} Hz: {found} {exact}");
        }
        // A steady error is taken away.
        assert!(modulus(bench.answer(0.0).error(0)) < 1e-14);
    }

    /// The root mean square of the error over all times, beside that of the sine, is that of all of its lines.
    #[test]
    fn the_aliases_carry_the_rest_of_the_error() {
        let bench = bench();
        for (hertz, exact) in [(22.0, 0.557_258_092_310_4), (300.0, 0.916_987_995_887_6)] {
            let answer = bench.answer(TAU * hertz);
            let sum: f64 = (-400..=400).map(|k| answer.error(k).norm_sqr()).sum();
            assert!((sum.sqrt() - exact).abs() < 1e-9, "{hertz} Hz: {} {exact}", sum.sqrt());
        }
    }

    #[test]
    fn the_margins_are_those_of_the_closed_loop() {
        let bench = bench();
        let margins = StabilityMargins::new(&bench.open_loop(0)).expect("stable");
        assert!((margins.spectral_radius - bench.spectral_radius()).abs() < 1e-12);
        let limit = margins.loops[0].gain_above.expect("a limit");
        let at = |factor: f64| {
            let gain = Positive::new(0.25 * limit * factor).expect("positive");
            MirrorLoop::new(FineMirror { gain, ..bench.mirror }).spectral_radius()
        };
        assert!(at(1.0 - 1e-6) < 1.0 && at(1.0 + 1e-6) > 1.0);
        // A steady mean is U = 1, whatever waits.
        for computing_periods in [0, 3] {
            let other = MirrorLoop::new(FineMirror { computing_periods, ..bench.mirror });
            assert!(modulus(other.answer(0.0).error(0)) < 1e-14);
            assert!(
                (other.spectral_radius()
                    - StabilityMargins::new(&other.open_loop(0)).expect("stable").spectral_radius)
                    .abs()
                    < 1e-14
            );
        }
    }

    #[test]
    fn a_mirror_enlarges_what_is_faster_than_its_crossing() {
        let found = MirrorSensitivity::new((0, bench().mirror), "detector");
        assert!((found.crossing_hz.expect("a crossing") - 39.395_544_78).abs() < 1e-7, "{found:?}");
        assert!(
            found.peak > 1.641_212_396_5
                && found.frequency_hz.last().is_some_and(|last| (last - 500.0).abs() < 1e-9)
        );
    }
}
