//! Axes: a range, the unit in which people read it, and ticks at 1-2-5 steps or at powers of ten.

use std::ops::Range;

use flexsc_formats::reader_units::{ReaderUnit, ReaderUnits, known_unit};

use crate::ticks::{Form, SHORT_POWERS, Ticks};

/// Axis of a panel.
#[derive(Clone, Debug)]
pub struct FigureAxis {
    /// Name of the quantity; empty for an axis that another panel names.
    pub name: String,
    /// SI unit of the values; empty for a ratio.
    pub unit: &'static str,
    /// Visible range, in the SI unit.
    pub range: Range<f64>,
    /// Scale of the axis.
    pub scale: Scale,
    /// Unit of the numbers at the ticks, if it does not follow from the size of the values.
    shown_in: Option<ReaderUnit>,
    /// Largest value of the stacked axes that share the unit.
    stacked_size: f64,
    /// Least and largest positive value of a logarithmic axis.
    positive: Range<f64>,
}

/// Scale of an axis.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Proportional to the value.
    Linear,
    /// Proportional to the logarithm: only positive values have a place.
    Logarithmic,
}

/// Maximum number of decades of a logarithmic axis: values far below the largest are rounding errors.
const DECADES: f64 = 8.0;

/// Largest size of a value that an axis shows: twice a larger one can be infinite.
const MOST: f64 = 1e300;

/// Number of values of which one in a hundred may lie below a logarithmic axis, if it is far below the others.
const MANY: usize = 20;
/// Ratio by which the lowest values are far below the others.
const FAR: f64 = 100.0;

/// Maximum ratio of the largest values of axes that share a unit, for axes of one quantity.
const SAME: f64 = 1000.0;
/// Maximum ratio of the largest values of axes that share a unit, for axes of different quantities.
const ALIKE: f64 = 10.0;
/// Names of the three axes of one quantity.
const DIRECTIONS: [&str; 6] = ["roll", "pitch", "yaw", "x", "y", "z"];

impl FigureAxis {
    /// Least size of a range, and of a value on a logarithmic axis: the power of ten of a smaller step can be 0.
    pub const LEAST: f64 = 1e-300;

    /// Creates an axis with exactly the given range, as far as it is within ±1e300.
    pub fn exact(name: &str, unit: &'static str, range: Range<f64>) -> Self {
        let is_finite = range.start.is_finite() && range.end.is_finite();
        let range = range.start.clamp(-MOST, MOST)..range.end.clamp(-MOST, MOST);
        let size = range.start.abs().max(range.end.abs());
        // An axis needs a width, which a single value or an empty range does not have.
        let wide = is_finite && range.end - range.start > (1e-9 * size).max(Self::LEAST);
        let middle = if is_finite { range.start } else { 0.0 };
        let half = if middle.abs() < Self::LEAST { 1.0 } else { 0.05 * middle.abs() };
        let range = if wide { range } else { middle - half..middle + half };
        Self {
            name: name.to_owned(),
            unit,
            range,
            scale: Scale::Linear,
            shown_in: None,
            stacked_size: 0.0,
            positive: 0.0..0.0,
        }
    }

    /// Creates an axis around all values, with a small margin.
    pub fn around(name: &str, unit: &'static str, values: impl IntoIterator<Item = f64>) -> Self {
        let finite = values.into_iter().filter(|value| value.is_finite());
        let (low, high) =
            finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        let margin = 0.06 * (high - low);
        Self::exact(name, unit, low - margin..high + margin)
    }

    /// Creates an axis from zero to the largest value, with a small margin.
    pub fn from_zero(name: &str, unit: &'static str, values: impl IntoIterator<Item = f64>) -> Self {
        let highest = values.into_iter().filter(|value| value.is_finite()).fold(0.0, f64::max);
        Self::exact(name, unit, 0.0..1.06 * highest)
    }

    /// Creates a logarithmic axis of whole decades of the unit for all positive values, with at most eight decades. Of
    /// many values, a hundredth is left out if it is far below the others.
    pub fn decades(name: &str, unit: &'static str, values: impl IntoIterator<Item = f64>) -> Self {
        let mut positive: Vec<f64> =
            values.into_iter().filter(|value| (Self::LEAST..=MOST).contains(value)).collect();
        positive.sort_by(f64::total_cmp);
        let shown = positive.first().zip(positive.last()).map(|(low, high)| {
            let usual = positive[if positive.len() < MANY { 0 } else { positive.len().div_ceil(100) }];
            if usual > FAR * low { usual..*high } else { *low..*high }
        });
        let axis = Self {
            scale: Scale::Logarithmic,
            positive: shown.unwrap_or(0.1..1.0),
            ..Self::exact(name, unit, 0.0..1.0)
        };
        axis.in_whole_decades()
    }

    /// Returns the axis with its numbers in a unit, such as that in which a limit was written.
    #[must_use]
    pub fn in_unit(self, unit: ReaderUnit) -> Self {
        let axis = Self { shown_in: Some(unit), ..self };
        if axis.scale == Scale::Logarithmic { axis.in_whole_decades() } else { axis }
    }

    /// Returns the axis in Hz if its values are angular frequencies.
    #[must_use]
    pub fn in_hertz(self) -> Self {
        if self.unit == "rad/s" { self.in_unit(ReaderUnits::Engineering.frequency()) } else { self }
    }

    /// Returns the axis in rpm if its values are speeds of rotors.
    #[must_use]
    pub fn in_rpm(self) -> Self {
        if self.unit == "rad/s" { self.in_unit(ReaderUnits::Engineering.rotor_speed()) } else { self }
    }

    /// Returns the axis that shows what two axes of one quantity show.
    #[must_use]
    pub fn covering(&self, other: &Self) -> Self {
        let union = |a: &Range<f64>, b: &Range<f64>| a.start.min(b.start)..a.end.max(b.end);
        let axis = Self {
            range: union(&self.range, &other.range),
            positive: union(&self.positive, &other.positive),
            ..self.clone()
        };
        if axis.scale == Scale::Logarithmic { axis.in_whole_decades() } else { axis }
    }

    /// Returns the axis in the unit that another one was given.
    #[must_use]
    pub fn like(self, other: &Self) -> Self {
        other.shown_in.clone().map_or(self.clone(), |unit| self.in_unit(unit))
    }

    /// Returns the axis over another range.
    #[must_use]
    pub fn over(&self, range: Range<f64>) -> Self {
        Self { shown_in: self.shown_in.clone(), ..Self::exact(&self.name, self.unit, range) }
    }

    /// Sets the range of a logarithmic axis to the decades of its unit that hold its values.
    fn in_whole_decades(self) -> Self {
        let unit = self.reader_unit().size();
        let (low, high) = ((self.positive.start / unit).log10(), (self.positive.end / unit).log10());
        // A value at a power of ten may be beside it by rounding.
        let (low, high) = ((low + 1e-9).floor(), (high - 1e-9).ceil());
        let low = low.min(high - 1.0).max(high - DECADES);
        Self { range: unit * 10_f64.powf(low)..unit * 10_f64.powf(high), ..self }
    }

    /// Returns the axes of stacked panels: axes of one unit are shown alike, unless one of them would show too small
    /// numbers.
    pub(crate) fn stacked<'a>(axes: impl IntoIterator<Item = &'a Self>) -> Vec<Self> {
        let mut axes: Vec<Self> = axes.into_iter().cloned().collect();
        let all = axes.clone();
        let direction = |axis: &Self| DIRECTIONS.contains(&axis.name.as_str());
        for axis in &mut axes {
            let near = |other: &&Self| {
                let same = other.name == axis.name || (direction(other) && direction(axis));
                let factor = if same { SAME } else { ALIKE };
                other.unit == axis.unit
                    && other.scale == Scale::Linear
                    && other.size() <= factor * axis.size()
            };
            axis.stacked_size = all.iter().filter(near).map(Self::size).fold(0.0, f64::max);
        }
        axes
    }

    /// Returns the place of a value, in the numbers of [`FigureAxis::extent`]; not finite if it has none.
    pub fn place(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => value,
            Scale::Logarithmic => value.log10(),
        }
    }

    /// Returns the places of the ends of the range.
    pub fn extent(&self) -> Range<f64> {
        self.place(self.range.start)..self.place(self.range.end)
    }

    /// Returns the axis without its name, which another panel shows.
    #[must_use]
    pub fn unnamed(&self) -> Self {
        Self { name: String::new(), ..self.clone() }
    }

    /// Returns the name with the unit of the numbers.
    pub fn label(&self) -> String {
        let unit = self.reader_unit().name;
        if self.name.is_empty() || unit.is_empty() {
            return self.name.clone();
        }
        format!("{} ({unit})", self.name)
    }

    /// Returns the size of the unit of the numbers in the axis' SI unit.
    pub fn factor(&self) -> f64 {
        self.reader_unit().size()
    }

    /// Returns the unit of the numbers.
    pub fn reader_unit(&self) -> ReaderUnit {
        if let Some(unit) = &self.shown_in {
            return unit.clone();
        }
        let largest = match self.scale {
            Scale::Linear => self.size().max(self.stacked_size),
            Scale::Logarithmic => self.positive.end,
        };
        match self.unit {
            "s" if self.scale == Scale::Linear => {
                ReaderUnit::for_time_axis(self.range.end - self.range.start)
            }
            unit => ReaderUnits::Engineering.fitting(largest, unit),
        }
    }

    /// Returns the ticks, about `most` at most.
    pub fn ticks(&self, most: u32) -> Ticks {
        let factor = self.factor();
        if self.scale == Scale::Logarithmic {
            return self.powers(most, factor);
        }
        let (low, high) = (self.range.start / factor, self.range.end / factor);
        let rough = (high - low) / f64::from(most.max(1));
        let power = 10_f64.powf(rough.log10().floor());
        // A tick at an end of the range may exceed it by rounding.
        let ends = |step: f64| ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
        let steps = [0.5, 1.0, 2.0, 5.0, 10.0].map(|nice| nice * power);
        let place = steps.iter().position(|step| *step >= rough).unwrap_or(4);
        // Two ticks are few to read a value.
        let (first, last) = ends(steps[place]);
        let step = if place > 0 && last - first < 2 { steps[place - 1] } else { steps[place] };
        let (first, last) = ends(step);
        // The tolerance allows for rounding in the logarithm of a power of ten.
        let decimals = (-1e-9 - step.log10()).ceil().clamp(0.0, 12.0) as usize;
        let at = (first..=last).map(|i| i as f64 * step * factor).collect();
        Ticks { at, factor, form: Form::Decimal(decimals) }
    }

    /// Returns the ticks of a logarithmic axis: powers of ten of the unit, with 2 and 5 between them if they are few.
    fn powers(&self, most: u32, factor: f64) -> Ticks {
        let power = |value: f64| (value / factor).log10().round() as i32;
        let (first, last) = (power(self.range.start), power(self.range.end));
        let step = (last - first).unsigned_abs().div_ceil(most.max(1)).max(1);
        let is_short = SHORT_POWERS.contains(&first) && SHORT_POWERS.contains(&last);
        let between: &[f64] =
            if is_short && 3 * (last - first).unsigned_abs() <= most { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let powers = (first..=last).rev().step_by(step as usize);
        let all = powers.flat_map(|power| between.iter().rev().map(move |part| part * 10_f64.powi(power)));
        let at = all.map(|value| value * factor).filter(|value| *value <= self.range.end * (1.0 + 1e-9));
        Ticks { at: at.collect(), factor, form: if is_short { Form::Short } else { Form::Power } }
    }

    /// Returns the largest absolute value of the range.
    fn size(&self) -> f64 {
        self.range.start.abs().max(self.range.end.abs())
    }
}

/// Returns the name and the unit of the axis of a quantity: a unit that readers see as it is becomes part of the name.
pub fn name_and_unit(name: &str, unit: &str) -> (String, &'static str) {
    match known_unit(unit) {
        Some(known) => (name.to_owned(), known),
        None if unit.is_empty() => (name.to_owned(), ""),
        None => (format!("{name} ({unit})"), ""),
    }
}

/// Returns the number 1, 2 or 5 times a power of ten that is nearest to a positive value.
pub fn round_to_nice(value: f64) -> f64 {
    let power = 10_f64.powf(value.log10().floor());
    let nice = [1.0, 2.0, 5.0, 10.0].map(|nice| nice * power);
    let distance = |nice: &f64| (nice / value).ln().abs();
    nice.into_iter().min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(axis: &FigureAxis, most: u32) -> Vec<String> {
        let ticks = axis.ticks(most);
        ticks.at.iter().map(|value| ticks.text(*value)).collect()
    }

    #[test]
    fn numbers_are_short() {
        let angle = FigureAxis::exact("angle x", "rad", -6.2e-4..6.2e-4);
        assert_eq!(angle.label(), "angle x (arcsec)");
        assert_eq!(texts(&angle, 7), ["−100", "−50", "0", "50", "100"]);
        let time = FigureAxis::exact("time", "s", 0.0..20_000.0);
        assert_eq!(time.label(), "time (h)");
        assert_eq!(texts(&time, 6), ["0", "1", "2", "3", "4", "5"]);
        assert_eq!(FigureAxis::exact("time", "s", 0.0..7200.0).label(), "time (s)");
        assert_eq!(FigureAxis::exact("time", "s", 0.0..1e6).label(), "time (h)");
        assert_eq!(FigureAxis::exact("pulse", "s", 0.0..0.02).label(), "pulse (ms)");
        let short = FigureAxis::exact("time", "s", 0.0..3.0);
        assert_eq!(texts(&short, 4), ["0", "1", "2", "3"]);
        let late = FigureAxis::exact("time", "s", 19_900.0..20_000.0);
        assert_eq!(late.label(), "time (s)");
        assert_eq!(texts(&late, 2), ["19\u{202f}900", "19\u{202f}950", "20\u{202f}000"]);
        let gain = FigureAxis::exact("k_t", "", 0.305..0.325);
        assert_eq!(gain.label(), "k_t");
        assert_eq!(texts(&gain, 5), ["0.305", "0.310", "0.315", "0.320", "0.325"]);
        let turn = FigureAxis::exact("angle", "rad", -0.1..1.67);
        assert_eq!(
            (turn.label().as_str(), texts(&turn, 4)),
            ("angle (deg)", ["0", "20", "40", "60", "80"].map(str::to_owned).to_vec())
        );
        let propellant = |most: f64| FigureAxis::exact("propellant", "kg", 0.0..most);
        assert_eq!(propellant(0.09).label(), "propellant (g)");
        assert_eq!(texts(&propellant(0.09), 4), ["0", "20", "40", "60", "80"]);
        assert_eq!(propellant(3.7).label(), "propellant (kg)");
        assert_eq!(texts(&propellant(3.7), 4), ["0", "1", "2", "3"]);
        // Two ticks at least.
        assert_eq!(texts(&FigureAxis::exact("x", "m", -45.0..45.0), 4), ["−40", "−20", "0", "20", "40"]);
        let huge = FigureAxis::exact("", "", -2e9..2e9);
        assert_eq!(texts(&huge, 2), ["−2.0e9", "0", "2.0e9"]);
    }

    #[test]
    fn axes_one_below_the_other_have_one_unit() {
        let axis = |most: f64, unit| FigureAxis::exact("angle", unit, -most..most);
        let stacked =
            FigureAxis::stacked(&[axis(3e-3, "rad"), axis(2e-5, "rad"), axis(1e-6, "rad"), axis(1e-5, "m")]);
        let labels: Vec<String> = stacked.iter().map(FigureAxis::label).collect();
        // The third is too small for the first, but not for the second.
        assert_eq!(labels, ["angle (deg)", "angle (deg)", "angle (arcsec)", "angle (µm)"]);
        assert_eq!(texts(&stacked[1], 3), ["−0.001", "0", "0.001"]);
    }

    #[test]
    fn decades_are_whole_and_at_most_eight() {
        let residual = FigureAxis::decades("phi4 left", "m", [3e-5, 0.0, f64::NAN, 4e-2]);
        assert_eq!(residual.label(), "phi4 left (mm)");
        assert_eq!(texts(&residual, 8), ["100", "10", "1", "0.1", "0.01"]);
        assert_eq!(texts(&residual, 2), ["100", "1", "0.01"]);
        // Distances are those of the logarithms, and zero has no place.
        let extent = residual.extent();
        assert!((extent.start + 5.0).abs() < 1e-12 && (extent.end + 1.0).abs() < 1e-12);
        assert!((residual.place(1e-3) + 3.0).abs() < 1e-12);
        assert!(!residual.place(0.0).is_finite() && !residual.place(-1.0).is_finite());
        // Decades of the unit that is shown: 0.3 and 41 arcsec, 2 and 900 deg.
        let arcsec = std::f64::consts::PI / 180.0 / 3600.0;
        let fine = FigureAxis::decades("error", "rad", [0.3 * arcsec, 41.0 * arcsec]);
        assert_eq!(
            (fine.label().as_str(), texts(&fine, 4)),
            ("error (arcsec)", vec!["100".into(), "10".into(), "1".into(), "0.1".into()])
        );
        let degrees = fine.in_unit(ReaderUnits::Engineering.fitting(1.0, "rad"));
        // 41 arcsec are 0.0114 deg, 0.3 arcsec are 0.000083 deg.
        assert_eq!(
            (degrees.label().as_str(), texts(&degrees, 5)),
            ("error (deg)", ["0.1", "0.01", "0.001", "0.0001", "0.00001"].map(str::to_owned).to_vec())
        );
        let hertz = FigureAxis::decades(
            "frequency",
            "rad/s",
            [0.2 * std::f64::consts::TAU, 0.9 * std::f64::consts::TAU],
        )
        .in_hertz();
        assert_eq!(texts(&hertz, 6), ["1", "0.5", "0.2", "0.1"]);
        // The first sample of a hundred does not decide the axis.
        let run = (0..100).map(|i| if i == 0 { 1e-12 } else { 0.3 });
        assert_eq!(FigureAxis::decades("norm", "", run).range, 0.1..1.0);
        let deep = FigureAxis::decades("x", "m", [1e-17, 2e3]).extent();
        assert!((deep.start + 4.0).abs() < 1e-12 && (deep.end - 4.0).abs() < 1e-12);
        for values in [vec![], vec![0.0], vec![1.0], vec![1e300], vec![-3.0, f64::NAN]] {
            let extent = FigureAxis::decades("x", "m", values.clone()).extent();
            assert!((extent.end - extent.start - 1.0).abs() < 1e-9, "{values:?}: {extent:?}");
        }
    }

    #[test]
    fn any_values_make_an_axis() {
        for values in [vec![], vec![f64::NAN], vec![0.0], vec![3.0, 3.0], vec![-1e300, 1e300]] {
            let axis = FigureAxis::around("x", "m", values.clone());
            assert!(axis.range.start < axis.range.end, "{values:?}");
            assert!(axis.ticks(5).at.len() <= 7, "{values:?}");
        }
    }

    /// Returns numbers of all exponents, the subnormal ones included, with both signs, and 0.
    fn all_exponents() -> Vec<f64> {
        let sizes = (0..2047).step_by(23).flat_map(|exponent: u64| {
            [1, 0x000A_0000_0000_0000].map(|mantissa| f64::from_bits(exponent << 52 | mantissa))
        });
        sizes.chain([f64::MAX]).flat_map(|size| [size, -size]).chain([0.0]).collect()
    }

    #[test]
    fn ticks_are_few_and_finite_for_all_exponents_of_both_ends() {
        let numbers = all_exponents();
        for (index, one) in numbers.iter().enumerate() {
            for other in &numbers[index..] {
                let (low, high) = (one.min(*other), one.max(*other));
                for (unit, axis) in [
                    ("m", FigureAxis::exact("x", "m", low..high)),
                    ("s", FigureAxis::exact("x", "s", low..high)),
                    ("kg", FigureAxis::around("x", "kg", [low, high])),
                    ("from zero", FigureAxis::from_zero("x", "rad", [low, high])),
                    ("decades", FigureAxis::decades("x", "m", [low, high])),
                ] {
                    let Range { start, end } = axis.range;
                    assert!(start.is_finite() && end.is_finite() && start < end, "{unit} {low:e} {high:e}");
                    let ticks = axis.ticks(7);
                    let is_finite = ticks.at.iter().all(|value| value.is_finite());
                    assert!(is_finite && ticks.at.len() <= 16, "{unit} {low:e} {high:e} {:?}", ticks.at);
                    ticks.at.iter().for_each(|value| assert!(!ticks.text(*value).is_empty()));
                }
            }
        }
    }

    #[test]
    fn nice_numbers_are_nearest() {
        assert_eq!([3.1, 3.2, 99.96, 220.0, 0.07].map(round_to_nice), [2.0, 5.0, 100.0, 200.0, 0.05]);
    }
}
