//! Pointing indices over windows: variances of means, drifts and differences of means, exact for a loop.
//!
//! Each index is the variance of a linear functional of the output over a window that begins at a sample of the law: it is
//! linear in the states at the start and in the draws since, so that its variance needs no spectrum. For a stationary
//! signal of the density S the indices are integrals of S with the weights of [`WindowWeights`].

use std::cell::RefCell;
use std::collections::BTreeMap;

use flexsc_formats::reader_units::{self, number};
use nalgebra::{DMatrix, RowDVector};

use super::noisy_loop::NoisyLoop;

/// Largest number of periods of the loop in a window.
const MOST_PERIODS: f64 = 1e6;
/// Part of a period by which the end of a window may miss that of the period.
const ROUNDING: f64 = 1e-9;

/// Indices over windows.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct WindowVariances {
    /// Mean square of the output over the window.
    pub total: f64,
    /// Mean performance error: the mean over a window. Of an exposure, the displacement.
    pub mpe: f64,
    /// Relative performance error: the output less the mean over the window, at any time of the window.
    pub rpe_uniform: f64,
    /// Relative performance error at the end of the window.
    pub rpe_end: f64,
    /// Relative performance error in the middle of the window.
    pub rpe_middle: f64,
    /// Smear of an exposure: mean square of the straight line through the output, about its mean.
    pub smear: f64,
    /// Performance drift error, or reproducibility error: difference of the means over two windows; 0 without the distance
    /// of their starts.
    pub pde: f64,
}

impl WindowVariances {
    /// Names and units of the indices: the field names.
    pub const NAMES: [&'static str; 7] =
        ["total", "mpe", "rpe_uniform", "rpe_end", "rpe_middle", "smear", "pde"];

    /// Returns the variances in the order of the names.
    pub fn values(&self) -> [f64; 7] {
        [self.total, self.mpe, self.rpe_uniform, self.rpe_end, self.rpe_middle, self.smear, self.pde]
    }

    /// Returns the variance of the rest of an exposure beyond displacement and smear.
    pub fn beyond_smear(&self) -> f64 {
        (self.rpe_uniform - self.smear).max(0.0)
    }
}

/// Window, and the distance of two windows.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Window {
    /// Length (s).
    pub length: f64,
    /// Time from the start of a window to that of the next (s), for differences of means; none without them.
    pub separation: Option<f64>,
}

/// Linear functional of an output: weights that are straight lines over intervals, and values at times.
#[derive(Default)]
pub(super) struct Functional {
    /// Start, end, and weight at time t: first + second t.
    lines: Vec<([f64; 2], [f64; 2])>,
    /// Times, and weights.
    points: Vec<(f64, f64)>,
}

/// Integrals of an output's row, and of the row times the time, over the period and over parts of it.
pub(super) struct OutputMoments {
    whole: [RowDVector<f64>; 2],
    /// Integrals over parts that were asked for, by the bits of their ends.
    parts: RefCell<BTreeMap<[u64; 2], [RowDVector<f64>; 2]>>,
}

impl Functional {
    /// Returns the mean over an interval, times a factor.
    pub fn mean(from: f64, length: f64, factor: f64) -> Self {
        Self { lines: vec![([from, from + length], [factor / length, 0.0])], points: Vec::new() }
    }

    /// Adds a value at a time.
    pub fn with_point(mut self, time: f64) -> Self {
        self.points.push((time, 1.0));
        self
    }

    /// Returns the functional a time later.
    fn later(&self, delay: f64) -> Self {
        let line = |([from, to], [first, second]): &([f64; 2], [f64; 2])| {
            ([from + delay, to + delay], [first - second * delay, *second])
        };
        let point = |(time, weight): &(f64, f64)| (time + delay, *weight);
        Self { lines: self.lines.iter().map(line).collect(), points: self.points.iter().map(point).collect() }
    }

    /// Returns the latest time.
    fn end(&self) -> f64 {
        let ends = self.lines.iter().map(|([_, to], _)| *to);
        ends.chain(self.points.iter().map(|(time, _)| *time)).fold(0.0, f64::max)
    }
}

impl NoisyLoop {
    /// Returns the indices of an output over a window that begins at a sample of the law, from each source: the mean over
    /// the samples of a period.
    ///
    /// # Errors
    /// A window that is not positive, or longer than a million periods of the loop.
    pub fn window_variances(&self, output: usize, window: Window) -> Result<Vec<WindowVariances>, String> {
        let Window { length, separation } = window;
        self.check_time("window", length)?;
        separation.map_or(Ok(()), |separation| self.check_time("separation", separation))?;
        let mean = || Functional::mean(0.0, length, 1.0);
        // Legendre's polynomial of degree 1 over the window, normalised to a mean square of 1.
        let root = f64::sqrt(3.0) / length;
        let line =
            Functional { lines: vec![([0.0, length], [-root, 2.0 * root / length])], points: Vec::new() };
        let minus_mean = || Functional::mean(0.0, length, -1.0);
        let mut found = vec![WindowVariances::default(); self.sources.len()];
        let moments = self.moments(output, [0.0, self.period]);
        let mut add = |functional: &Functional, set: fn(&mut WindowVariances) -> &mut f64| {
            let variances = self.functional_variances(output, functional, &moments);
            for (index, variance) in found.iter_mut().zip(variances) {
                *set(index) += variance;
            }
        };
        add(&mean(), |index| &mut index.mpe);
        add(&line, |index| &mut index.smear);
        add(&minus_mean().with_point(length), |index| &mut index.rpe_end);
        add(&minus_mean().with_point(0.5 * length), |index| &mut index.rpe_middle);
        if let Some(separation) = separation {
            let mut difference = mean();
            difference.lines.extend(Functional::mean(separation, length, -1.0).lines);
            add(&difference, |index| &mut index.pde);
        }
        for (index, total) in found.iter_mut().zip(self.window_totals(output, length)) {
            index.total = total;
            index.rpe_uniform = (total - index.mpe).max(0.0);
        }
        Ok(found)
    }

    /// Checks that a time of windows is positive, and that the loop has at most a million periods in it.
    pub(super) fn check_time(&self, name: &str, time: f64) -> Result<(), String> {
        if time > 0.0 && time <= MOST_PERIODS * self.period {
            return Ok(());
        }
        let [period, got] = [self.period, time].map(reader_units::time);
        let most = number(MOST_PERIODS);
        Err(format!("{name} must be positive and at most {most} periods of {period}, got {got}"))
    }

    /// Returns the mean variances of an output over a window, from each source.
    fn window_totals(&self, output: usize, length: f64) -> Vec<f64> {
        let mut sums = vec![0.0; self.sources.len()];
        let whole = self.mean_variances(&[output]).remove(0);
        for sample in 0..self.samples {
            let from = sample as f64 * self.sample_period();
            let periods = libm::floor(length / self.period + ROUNDING);
            let rest = (length - periods * self.period).max(0.0);
            let mut own: Vec<f64> = whole.iter().map(|mean| mean * periods * self.period).collect();
            // The rest of the window, which may pass the end of the period.
            for interval in [[from, (from + rest).min(self.period)], [0.0, from + rest - self.period]] {
                if rest > ROUNDING * self.period && interval[1] > interval[0] {
                    self.motion.integrate(&[output], interval, 0.0, |_, weight, rows| {
                        for (sum, variance) in own.iter_mut().zip(&self.variances(rows)[0]) {
                            *sum += weight * variance;
                        }
                    });
                }
            }
            for (sum, own) in sums.iter_mut().zip(own) {
                *sum += own / length / self.samples as f64;
            }
        }
        sums
    }

    /// Returns the integrals of an output over an interval of the period, which is the whole of it, and later over parts of it.
    pub(super) fn moments(&self, output: usize, interval: [f64; 2]) -> OutputMoments {
        OutputMoments { whole: self.integrals(output, interval), parts: RefCell::default() }
    }

    /// Returns the integrals of an output's row, and of the row times the time, over an interval of the period.
    fn integrals(&self, output: usize, interval: [f64; 2]) -> [RowDVector<f64>; 2] {
        let columns = self.a.nrows() + self.drawn_by.len();
        let mut found = [RowDVector::zeros(columns), RowDVector::zeros(columns)];
        self.motion.integrate(&[output], interval, 0.0, |time, weight, rows| {
            found[0] += rows.row(0) * weight;
            found[1] += rows.row(0) * (weight * time);
        });
        found
    }

    /// Returns the variance of a functional that begins at a sample of the law, from each source: the mean over the samples
    /// of a period.
    pub(super) fn functional_variances(
        &self,
        output: usize,
        functional: &Functional,
        moments: &OutputMoments,
    ) -> Vec<f64> {
        let mut sums = vec![0.0; self.sources.len()];
        for sample in 0..self.samples {
            let shifted = functional.later(sample as f64 * self.sample_period());
            for (sum, own) in sums.iter_mut().zip(self.functional_variance(output, &shifted, moments)) {
                *sum += own / self.samples as f64;
            }
        }
        sums
    }

    /// Returns the variance of a functional whose time 0 is the start of a period, from each source.
    fn functional_variance(
        &self,
        output: usize,
        functional: &Functional,
        moments: &OutputMoments,
    ) -> Vec<f64> {
        let order = self.a.nrows();
        let mut sums = vec![0.0; self.sources.len()];
        // The functional from the start of a period on, as a row over the states then.
        let mut ahead = RowDVector::zeros(order);
        let last = libm::floor(functional.end() / self.period + ROUNDING) as usize;
        for period in (0..=last).rev() {
            let row = self.functional_row(output, functional, moments, period);
            let drawn = row.columns_range(order..) + &ahead * &self.g;
            ahead = row.columns_range(..order) + &ahead * &self.a;
            for (draw, source) in self.drawn_by.iter().enumerate() {
                sums[*source] += drawn[draw] * drawn[draw];
            }
        }
        for (sum, covariance) in sums.iter_mut().zip(&self.covariances) {
            *sum += (&ahead * covariance).dot(&ahead);
        }
        sums
    }

    /// Returns the part of a functional in a period, as a row over the states at its start and its draws.
    fn functional_row(
        &self,
        output: usize,
        functional: &Functional,
        moments: &OutputMoments,
        period: usize,
    ) -> RowDVector<f64> {
        let start = period as f64 * self.period;
        let mut row = RowDVector::zeros(moments.whole[0].len());
        for ([from, to], [first, second]) in &functional.lines {
            let inside = [from - start, to - start].map(|end| end.clamp(0.0, self.period));
            if inside[1] - inside[0] <= ROUNDING * self.period {
                continue;
            }
            let own = if inside == [0.0, self.period] {
                moments.whole.clone()
            } else {
                let mut parts = moments.parts.borrow_mut();
                parts
                    .entry(inside.map(f64::to_bits))
                    .or_insert_with(|| self.integrals(output, inside))
                    .clone()
            };
            row += &own[0] * (first + second * start) + &own[1] * *second;
        }
        for (time, weight) in &functional.points {
            let place = libm::floor(time / self.period + ROUNDING) as usize;
            if place == period {
                let rows: DMatrix<f64> = self.motion.rows_at(&[output], (time - start).max(0.0));
                row += rows.row(0) * *weight;
            }
        }
        row
    }
}

/// Weights on the variance of a sine of one frequency, or on a one-sided density: indices over windows of a length.
///
/// With u = w T/2 the mean over a window has the weight j0(u)², the straight line through it 3 j1(u)², the value at its end
/// less the mean 1 + j0(u)² - 2 j0(u) cos u, that in its middle (1 - j0(u))², and the difference of two means that are S
/// apart 2 (1 - cos w S) j0(u)² (\[PittelkauMcKinley16\]).
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct WindowWeights {
    /// Mean over the window; of an exposure, the displacement.
    pub mpe: f64,
    /// Output less the mean, at any time of the window.
    pub rpe_uniform: f64,
    /// Output less the mean, at the end of the window.
    pub rpe_end: f64,
    /// Output less the mean, in the middle of the window.
    pub rpe_middle: f64,
    /// Straight line about its mean.
    pub smear: f64,
    /// Difference of two means; 0 without the distance of their starts.
    pub pde: f64,
}

impl WindowWeights {
    /// Returns the weights at a frequency (rad/s).
    pub fn new(frequency: f64, window: Window) -> Self {
        let u = 0.5 * frequency * window.length;
        let own = j0(u);
        let mean = own * own;
        let difference =
            window.separation.map_or(0.0, |separation| 2.0 * (1.0 - libm::cos(frequency * separation)));
        Self {
            mpe: mean,
            rpe_uniform: 1.0 - mean,
            rpe_end: 1.0 + mean - 2.0 * own * libm::cos(u),
            rpe_middle: (1.0 - own) * (1.0 - own),
            smear: 3.0 * j1(u) * j1(u),
            pde: difference * mean,
        }
    }
}

/// Returns the spherical Bessel function of order 0, sin u/u.
pub(super) fn j0(u: f64) -> f64 {
    if u.abs() < 1e-4 { 1.0 - u * u / 6.0 } else { libm::sin(u) / u }
}

/// Returns the spherical Bessel function of order 1, (sin u/u - cos u)/u.
fn j1(u: f64) -> f64 {
    if u.abs() < 0.02 {
        u / 3.0 * (1.0 - u * u / 10.0 * (1.0 - u * u / 28.0))
    } else {
        (j0(u) - libm::cos(u)) / u
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, dmatrix};

    use super::super::motion::{Motion, OutputRow};
    use super::super::period_rows::Piece;
    use super::*;
    use crate::linear_model::Signal;

    /// Returns a lag of 3 s under a torque that is drawn every `period` (s) and held: nearly a first-order process of
    /// variance 1.
    fn lag(period: f64) -> NoisyLoop {
        let decay = libm::exp(-period / 3.0);
        // Under white noise of the density q held for T, of the variance q/T, with q = 2/3.
        let deviation = f64::sqrt(2.0 / 3.0 / period);
        let a = dmatrix![decay];
        let g = dmatrix![3.0 * (1.0 - decay) * deviation];
        let ticks = (period * 1e15) as i64;
        let piece = Piece {
            from: 0,
            length: ticks,
            body: dmatrix![1.0, 0.0],
            torque: dmatrix![0.0, deviation],
            command: DMatrix::zeros(1, 2),
        };
        let variance = g[(0, 0)] * g[(0, 0)] / (1.0 - decay * decay);
        let row = OutputRow::Body(RowDVector::from_element(1, 1.0));
        NoisyLoop {
            outputs: vec![Signal { name: "angle".to_owned(), unit: "rad".to_owned() }],
            sources: vec!["noise".to_owned()],
            period,
            samples: 1,
            spectral_radius: decay,
            drawn_by: vec![0],
            motion: Motion::new((&dmatrix![-1.0 / 3.0], &dmatrix![1.0]), vec![piece], vec![row]),
            step: ticks,
            frequencies: Vec::new(),
            covariances: vec![dmatrix![variance]],
            a,
            g,
        }
    }

    /// Returns the limit of a value without a time for which draws are held, from its values for 0.1, 0.05 and 0.025 s:
    /// its remainder is of first order in that time, as that of the variance between samples, and of second order.
    fn limit([coarse, middle, fine]: [f64; 3]) -> f64 {
        let (first, second) = (2.0 * middle - coarse, 2.0 * fine - middle);
        (4.0 * second - first) / 3.0
    }

    /// A first-order process by closed forms.
    #[test]
    fn a_first_order_process_has_the_indices_of_its_closed_form() {
        let window = Window { length: 10.0, separation: Some(60.0) };
        let at = |period: f64| {
            let index = lag(period).window_variances(0, window).expect("short")[0];
            [index.mpe, index.rpe_uniform, index.rpe_end, index.rpe_middle, index.pde]
        };
        let found = [0.1, 0.05, 0.025].map(at);
        let expected = [
            0.426_421_318_802_5,
            0.573_578_681_197_5,
            0.847_825_714_810_9,
            0.453_072_042_207_6,
            0.852_842_627_933_8,
        ];
        for (place, exact) in expected.into_iter().enumerate() {
            let found = limit(found.map(|values| values[place]));
            assert!((found / exact - 1.0).abs() < 1e-5, "{place}: {found} {exact}");
        }
    }

    /// A window that is no whole number of periods, against the closed form of the mean.
    #[test]
    fn a_window_of_any_length() {
        let length = 7.31;
        let window = Window { length, separation: None };
        let mean = |period: f64| lag(period).window_variances(0, window).expect("short")[0];
        let x: f64 = length / 3.0;
        let exact = 2.0 * (x - 1.0 + libm::exp(-x)) / (x * x);
        let found = (4.0 * mean(0.05).mpe - mean(0.1).mpe) / 3.0;
        assert!((found / exact - 1.0).abs() < 1e-5, "{found} {exact}");
        let total = limit([0.1, 0.05, 0.025].map(|period| mean(period).total));
        assert!((total - 1.0).abs() < 1e-5, "{total}");
    }
}
