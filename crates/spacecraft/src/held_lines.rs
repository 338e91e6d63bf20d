//! Force and torque at a point during a run that are sums of lines, held from step to step: the lines of a machine, and a broadband load by
//! a table of its densities.
//!
//! The band of a table is cut at its rows and into strips between. Each strip has one line, of a random phase, a frequency within it and its
//! power (\[ShinozukaDeodatis91\]): Gaussian in the limit of many strips, with the variance of the table in each run. The frequencies
//! have no common period, so that the load does not repeat.

use std::f64::consts::TAU;
use std::ops::Range;

use flexsc_dynamics::wrench::ForceEffect;
use flexsc_numerics::random::Stream;
use flexsc_numerics::time::Span;

use crate::load_density::LoadDensity;
use crate::load_lines::{LoadHarmonic, LoadLines};

/// Number of strips of equal ratio over the band, beside the cuts at the rows of the table.
const STRIPS: f64 = 1000.0;
/// Product of an exponent and a logarithm below which a power of the frequency integrates like its inverse.
const FLAT: f64 = 1e-12;

/// State of a sum of lines.
#[derive(Clone, Debug)]
pub struct HeldLines {
    /// Effect of a unit of each component.
    units: Vec<ForceEffect>,
    lines: Vec<HeldLine>,
    step: Span,
}

/// Line of all components of a load.
#[derive(Clone, Debug)]
struct HeldLine {
    amplitudes: [f64; 6],
    /// Cosine and sine in the middle of the present step, and of the turn in a step.
    phasor: [f64; 2],
    turn: [f64; 2],
}

impl HeldLine {
    /// Creates a line by its amplitudes, its frequency (Hz) and its phase at the start, held for steps.
    fn new(amplitudes: [f64; 6], hertz: f64, phase: f64, step: Span) -> Self {
        let turn = TAU * hertz * step.seconds();
        // A sine that is held at the middle of each step has less of its amplitude.
        let held = libm::sin(0.5 * turn) / (0.5 * turn);
        let of = |angle: f64| [libm::cos(angle), libm::sin(angle)];
        let amplitudes = amplitudes.map(|amplitude| amplitude / held);
        Self { amplitudes, phasor: of(phase - 0.5 * turn), turn: of(turn) }
    }
}

impl HeldLines {
    /// Creates the load of a density's table at frequencies and phases that are drawn; `unit` has the effect of a unit of each component.
    pub fn of_table(density: &LoadDensity, unit: impl Fn(usize) -> ForceEffect, draws: &mut Stream) -> Self {
        let (factor, step) = (density.correlation_factor(), density.step());
        let strips = strips(density);
        let mut lines = Vec::new();
        for own in (0..6).filter(|place| density.has_part(*place)) {
            for (hertz, powers) in &strips {
                let part = |place: usize| factor[(place, own)] * f64::sqrt(2.0 * powers[place]);
                let amplitudes: [f64; 6] = std::array::from_fn(part);
                if amplitudes != [0.0; 6] {
                    let hertz = hertz.start + (hertz.end - hertz.start) * draws.uniform();
                    lines.push(HeldLine::new(amplitudes, hertz, TAU * draws.uniform(), step));
                }
            }
        }
        Self { units: (0..6).map(unit).collect(), lines, step }
    }

    /// Creates the lines of a machine at a frequency within the tolerance and a phase of the machine, both drawn.
    pub fn of_machine(lines: &LoadLines, unit: impl Fn(usize) -> ForceEffect, draws: &mut Stream) -> Self {
        let [from, to] = lines.range();
        let frequency = from + (to - from) * draws.uniform();
        let (start, step) = (TAU * draws.uniform(), lines.step());
        let line = |harmonic: &LoadHarmonic| {
            let multiple = lines.multiple(harmonic);
            let phase = multiple * start + harmonic.phase.get();
            HeldLine::new(harmonic.amplitudes(), multiple * frequency / TAU, phase, step)
        };
        Self { units: (0..6).map(unit).collect(), lines: lines.harmonics.iter().map(line).collect(), step }
    }

    /// Returns the time for which the load is held.
    pub fn step(&self) -> Span {
        self.step
    }

    /// Goes on by a step.
    pub fn advance(&mut self) {
        for HeldLine { phasor: [cos, sin], turn, .. } in &mut self.lines {
            (*cos, *sin) = (*cos * turn[0] - *sin * turn[1], *cos * turn[1] + *sin * turn[0]);
        }
    }

    /// Returns the components of the load (N, N m).
    fn load(&self) -> [f64; 6] {
        let mut sum = [0.0; 6];
        for line in &self.lines {
            sum.iter_mut().zip(line.amplitudes).for_each(|(sum, own)| *sum += own * line.phasor[0]);
        }
        sum
    }

    /// Returns the effect of the load on the body.
    pub fn effect(&self) -> ForceEffect {
        let mut sum = ForceEffect::default();
        for (unit, size) in self.units.iter().zip(self.load()).filter(|(_, size)| *size != 0.0) {
            sum.add_scaled(unit, size);
        }
        sum
    }
}

/// Returns the strips of a table in which a component has a density (Hz), with the power of each component in it (N², (N m)²).
fn strips(density: &LoadDensity) -> Vec<(Range<f64>, [f64; 6])> {
    let rows = density.table_rows();
    let ends = rows.first().zip(rows.last());
    let band = ends.map_or(1.0, |((first, _), (last, _))| libm::log(last / first));
    let mut found = Vec::new();
    for (from, to) in rows.iter().zip(&rows[1.min(rows.len())..]) {
        let whole = libm::log(to.0 / from.0);
        let count = libm::ceil(STRIPS * whole / band).max(1.0);
        let edge = |place: f64| from.0 * libm::exp(whole * place / count);
        for strip in 0..count as u32 {
            let strip = f64::from(strip);
            let power = |place: usize| {
                let [one, other] = [from, to].map(|row| row.1[place]);
                // Where a density begins or ends, it is zero.
                if one > 0.0 && other > 0.0 {
                    let exponent = libm::log(other / one) / whole + 1.0;
                    let at = one * libm::pow(other / one, strip / count) * edge(strip);
                    let length = whole / count;
                    let flat = (exponent * length).abs() < FLAT;
                    at * if flat { length } else { libm::expm1(exponent * length) / exponent }
                } else {
                    0.0
                }
            };
            let powers: [f64; 6] = std::array::from_fn(power);
            if powers != [0.0; 6] {
                found.push((edge(strip)..edge(strip + 1.0), powers));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use flexsc_numerics::attitude::Vector;
    use flexsc_numerics::random::Seed;

    use super::*;

    fn unit(place: usize) -> ForceEffect {
        let part = |first: usize| Vector::from_fn(|row, _| if row + first == place { 1.0 } else { 0.0 });
        ForceEffect { force: part(0), torque: part(3), ..ForceEffect::default() }
    }

    /// Variances of the components: integrals over frequency, by tests/golden/table_runs.py.
    #[test]
    fn lines_have_the_variance_of_the_table() {
        let density: LoadDensity = serde_json::from_str(
            r#"{"table": [[5, 1e-7, 4e-7, 0, 1e-8, 0, 0], [40, 1e-6, 4e-6, 0, 1.25e-9, 0, 0], [200, 1e-8, 4e-8, 3e-6, 0, 0, 0], [300, 1e-8, 4e-8, 3e-6, 0, 0, 0]],
                "correlation": [[1, 0.6, 0], [0.6, 1, 0], [0, 0, 1]]}"#,
        )
        .expect("a density");
        let expected = [4.015_953_732_622e-5, 1.606_381_493_049e-4, 3e-4, 1.039_720_770_84e-7, 0.0, 0.0];
        for run in 0..3 {
            let mut draws = Seed { scenario: 3, run }.stream("load");
            let mut lines = HeldLines::of_table(&density, unit, &mut draws);
            let step = lines.step().seconds();
            assert!((step * 20.0 * 300.0 - 1.0).abs() < 1e-9, "{step}");
            let held = |line: &HeldLine| {
                let half = 0.5 * libm::atan2(line.turn[1], line.turn[0]);
                libm::sin(half) / half
            };
            let product = |one: usize, other: usize| {
                let of = |line: &HeldLine| {
                    0.5 * line.amplitudes[one] * line.amplitudes[other] * held(line) * held(line)
                };
                lines.lines.iter().map(of).sum::<f64>()
            };
            for (place, expected) in expected.into_iter().enumerate() {
                let found = product(place, place);
                assert!((found - expected).abs() <= 1e-9 * expected, "{place}: {found}");
            }
            let correlation = product(0, 1) / f64::sqrt(expected[0] * expected[1]);
            assert!((correlation - 0.6).abs() < 1e-9, "{correlation}");
            assert_eq!(product(0, 2), 0.0);
            if run > 0 {
                continue;
            }
            // 33 s: 1000 lines of 5 to 300 Hz.
            let mut squares = [0.0; 6];
            let steps = 200_000;
            for _ in 0..steps {
                lines.advance();
                let load = lines.effect();
                let all = load.force.iter().chain(&load.torque);
                squares.iter_mut().zip(all).for_each(|(sum, own)| *sum += own * own / f64::from(steps));
            }
            for (place, expected) in expected.into_iter().enumerate() {
                assert!((squares[place] - expected).abs() <= 0.05 * expected, "{place}: {}", squares[place]);
            }
        }
    }
}
