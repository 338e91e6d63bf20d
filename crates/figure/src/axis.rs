//! Axes: a range, its unit with a prefix that keeps numbers short, and ticks at 1-2-5 steps or at powers of ten.

use std::ops::Range;

/// Axis of a panel.
#[derive(Clone, Debug)]
pub struct FigureAxis {
    /// Name of the quantity; empty for an axis that another panel names.
    pub name: String,
    /// Unit of the values; empty for a ratio.
    pub unit: &'static str,
    /// Visible range, in the unit.
    pub range: Range<f64>,
    /// Scale of the axis.
    pub scale: Scale,
    /// Largest value of the stacked axes that share the prefix.
    stacked_size: f64,
}

/// Scale of an axis.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Proportional to the value.
    Linear,
    /// Proportional to the logarithm: only positive values have a place.
    Logarithmic,
}

/// Ticks of an axis.
#[derive(Clone, Debug)]
pub struct Ticks {
    /// Values of the ticks, in the axis' unit.
    pub at: Vec<f64>,
    form: Form,
}

/// Format of the ticks.
#[derive(Copy, Clone, Debug)]
enum Form {
    /// Decimal numbers in a prefixed unit, which is `factor` times the axis' own.
    Decimal { factor: f64, decimals: usize },
    /// Powers of ten.
    Power,
}

/// Maximum number of decades of a logarithmic axis: values far below the largest are rounding errors.
const DECADES: f64 = 8.0;

/// Largest size of a value that an axis shows: twice a larger one can be infinite.
const MOST: f64 = 1e300;

/// Maximum ratio of the largest values of axes that share a prefix, for axes of one quantity.
const SAME: f64 = 1000.0;
/// Maximum ratio of the largest values of axes that share a prefix, for axes of different quantities.
const ALIKE: f64 = 10.0;
/// Names of the three axes of one quantity.
const DIRECTIONS: [&str; 6] = ["roll", "pitch", "yaw", "x", "y", "z"];

/// Units of a long time: the longest range (s) that each shows, its name and its length (s).
const TIMES: [(f64, &str, f64); 4] =
    [(2500.0, "s", 1.0), (10_800.0, "min", 60.0), (345_600.0, "h", 3600.0), (f64::INFINITY, "d", 86_400.0)];

/// SI prefixes, from the smallest.
const PREFIXES: [(&str, i32); 7] = [("p", -12), ("n", -9), ("µ", -6), ("m", -3), ("", 0), ("k", 3), ("M", 6)];

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
        Self { name: name.to_owned(), unit, range, scale: Scale::Linear, stacked_size: 0.0 }
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

    /// Creates a logarithmic axis of whole decades for all positive values, with at most eight decades.
    pub fn decades(name: &str, unit: &'static str, values: impl IntoIterator<Item = f64>) -> Self {
        let positive = values.into_iter().filter(|value| (Self::LEAST..=MOST).contains(value));
        let (low, high) = positive.fold((f64::INFINITY, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
        let (low, high) = if high > 0.0 { (low.log10().floor(), high.log10().ceil()) } else { (-1.0, 0.0) };
        let low = low.min(high - 1.0).max(high - DECADES);
        let range = 10_f64.powf(low)..10_f64.powf(high);
        Self { name: name.to_owned(), unit, range, scale: Scale::Logarithmic, stacked_size: 0.0 }
    }

    /// Returns the axes of stacked panels: axes of one unit share a prefix, unless one of them would show too small
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

    /// Returns the name with the prefixed unit.
    pub fn label(&self) -> String {
        match (self.name.as_str(), self.unit) {
            ("", _) | (_, "") => self.name.clone(),
            // Special case: the kilogram already has a prefix.
            (name, "kg") => match self.prefix().0 {
                "M" => format!("{name} (t)"),
                prefix => format!("{name} ({prefix}g)"),
            },
            (name, "s") if self.long().is_some() => {
                format!("{name} ({})", self.long().map_or("s", |unit| unit.0))
            }
            (name, unit) => format!("{name} ({}{unit})", self.prefix().0),
        }
    }

    /// Returns the size of the prefixed unit in the axis' own unit.
    pub fn factor(&self) -> f64 {
        self.long().map_or_else(|| 10_f64.powi(self.prefix().1 - self.exponent_of_unit()), |unit| unit.1)
    }

    /// The name and the length (s) of the unit of a time that has no prefix.
    fn long(&self) -> Option<(&'static str, f64)> {
        let shown = self.range.end - self.range.start;
        let (_, name, length) = TIMES.into_iter().find(|(most, ..)| shown <= *most)?;
        (self.unit == "s" && self.scale == Scale::Linear && shown >= 2.5).then_some((name, length))
    }

    /// Returns the ticks, about `most` at most.
    pub fn ticks(&self, most: u32) -> Ticks {
        if self.scale == Scale::Logarithmic {
            let Range { start, end } = self.extent();
            let (first, last) = (start.round() as i32, end.round() as i32);
            let step = (last - first).unsigned_abs().div_ceil(most.max(1)).max(1);
            let positions = (first..=last).rev().step_by(step as usize).map(|power| 10_f64.powi(power));
            return Ticks { at: positions.collect(), form: Form::Power };
        }
        let factor = self.factor();
        let (low, high) = (self.range.start / factor, self.range.end / factor);
        let rough = (high - low) / f64::from(most.max(1));
        let power = 10_f64.powf(rough.log10().floor());
        // A tick at an end of the range may exceed it by rounding.
        let ends = |step: f64| ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
        let steps = [0.5, 1.0, 2.0, 5.0, 10.0].map(|nice| nice * power);
        let place = steps.iter().position(|step| *step >= rough).unwrap_or(4);
        // At least two ticks are needed to read a value.
        let (first, last) = ends(steps[place]);
        let step = if place > 0 && last - first < 1 { steps[place - 1] } else { steps[place] };
        let (first, last) = ends(step);
        // The tolerance allows for rounding in the logarithm of a power of ten.
        let decimals = (-1e-9 - step.log10()).ceil().clamp(0.0, 12.0) as usize;
        Ticks {
            at: (first..=last).map(|i| i as f64 * step * factor).collect(),
            form: Form::Decimal { factor, decimals },
        }
    }

    /// Returns the largest absolute value of the range.
    fn size(&self) -> f64 {
        self.range.start.abs().max(self.range.end.abs())
    }

    fn prefix(&self) -> (&'static str, i32) {
        if self.unit.is_empty() || self.scale == Scale::Logarithmic {
            return ("", self.exponent_of_unit());
        }
        let size = self.size().max(self.stacked_size) * 10_f64.powi(self.exponent_of_unit());
        let half = (self.range.end - self.range.start) / 2.0;
        // A short time has the prefix of its length, however late it is.
        let measure = if self.unit == "s" { half } else { size };
        let fits = |(_, power): &&(&str, i32)| (1.25..1250.0).contains(&(measure / 10_f64.powi(*power)));
        PREFIXES.iter().find(fits).copied().unwrap_or(("", self.exponent_of_unit()))
    }

    /// Returns the power of ten of the prefix that the unit itself contains.
    fn exponent_of_unit(&self) -> i32 {
        if self.unit == "kg" { 3 } else { 0 }
    }
}

impl Ticks {
    /// Returns the text of a tick.
    pub fn text(&self, value: f64) -> String {
        let Form::Decimal { factor, decimals } = self.form else {
            return format!("10{}", superscript(value.log10().round() as i32));
        };
        let value = value / factor;
        let plain = decimals <= 6 && value.abs() < 1e7;
        let text = if plain { format!("{value:.decimals$}") } else { format!("{value:.1e}") };
        let zero = text.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.' | 'e'));
        if zero { "0".to_owned() } else { text.replace('-', "−") }
    }
}

/// Formats an integer as a superscript.
fn superscript(number: i32) -> String {
    let raised = |character: char| match character {
        '-' => '⁻',
        digit => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit.to_digit(10).unwrap_or(0) as usize],
    };
    number.to_string().chars().map(raised).collect()
}

/// Returns the name and the unit of the axis of a quantity: prefixes are for SI units, so that any other unit is part
/// of the name.
pub fn name_and_unit(name: &str, unit: &str) -> (String, &'static str) {
    if unit == "rad" { (name.to_owned(), "rad") } else { (format!("{name} ({unit})"), "") }
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
        assert_eq!(angle.label(), "angle x (µrad)");
        assert_eq!(texts(&angle, 7), ["−600", "−400", "−200", "0", "200", "400", "600"]);
        let time = FigureAxis::exact("time", "s", 0.0..20_000.0);
        assert_eq!(time.label(), "time (h)");
        assert_eq!(texts(&time, 6), ["0", "1", "2", "3", "4", "5"]);
        let minutes = FigureAxis::exact("time", "s", 0.0..4000.0);
        assert_eq!((minutes.label().as_str(), minutes.factor()), ("time (min)", 60.0));
        assert_eq!(texts(&minutes, 4), ["0", "20", "40", "60"]);
        assert_eq!(FigureAxis::exact("time", "s", 0.0..2500.0).label(), "time (s)");
        assert_eq!(FigureAxis::exact("time", "s", 0.0..1e6).label(), "time (d)");
        assert_eq!(FigureAxis::exact("pulse", "s", 0.0..0.02).label(), "pulse (ms)");
        let short = FigureAxis::exact("time", "s", 0.0..3.0);
        assert_eq!(texts(&short, 4), ["0", "1", "2", "3"]);
        let late = FigureAxis::exact("time", "s", 19_900.0..20_000.0);
        assert_eq!(late.label(), "time (s)");
        assert_eq!(texts(&late, 2), ["19900", "19950", "20000"]);
        let gain = FigureAxis::exact("k_t", "", 0.305..0.325);
        assert_eq!(gain.label(), "k_t");
        assert_eq!(texts(&gain, 5), ["0.305", "0.310", "0.315", "0.320", "0.325"]);
        let turn = FigureAxis::exact("angle", "rad", -0.1..1.67);
        assert_eq!(
            (turn.label().as_str(), texts(&turn, 4)),
            ("angle (rad)", ["0", "0.5", "1.0", "1.5"].map(str::to_owned).to_vec())
        );
        let propellant = |most: f64| FigureAxis::exact("propellant", "kg", 0.0..most);
        assert_eq!(propellant(0.19).label(), "propellant (g)");
        assert_eq!(texts(&propellant(0.19), 4), ["0", "50", "100", "150"]);
        assert_eq!(propellant(3.7).label(), "propellant (kg)");
        assert_eq!(texts(&propellant(3.7), 4), ["0", "1", "2", "3"]);
        assert_eq!(propellant(4200.0).label(), "propellant (t)");
        // Two ticks at least.
        assert_eq!(texts(&FigureAxis::exact("x", "m", -45.0..45.0), 4), ["−40", "−20", "0", "20", "40"]);
        let huge = FigureAxis::exact("", "", -2e9..2e9);
        assert_eq!(texts(&huge, 2), ["−2.0e9", "0", "2.0e9"]);
    }

    #[test]
    fn axes_one_below_the_other_have_one_prefix() {
        let axis = |most: f64, unit| FigureAxis::exact("angle", unit, -most..most);
        let stacked =
            FigureAxis::stacked(&[axis(3e-3, "rad"), axis(2e-5, "rad"), axis(1e-6, "rad"), axis(1e-5, "m")]);
        let labels: Vec<String> = stacked.iter().map(FigureAxis::label).collect();
        // The third is too small for the first, but not for the second.
        assert_eq!(labels, ["angle (mrad)", "angle (mrad)", "angle (µrad)", "angle (µm)"]);
        assert_eq!(texts(&stacked[1], 3), ["−0.02", "0", "0.02"]);
    }

    #[test]
    fn decades_are_whole_and_at_most_eight() {
        let residual = FigureAxis::decades("phi4 left", "rad", [3e-5, 0.0, f64::NAN, 4e-2]);
        assert_eq!(residual.label(), "phi4 left (rad)");
        assert_eq!(texts(&residual, 8), ["10⁻¹", "10⁻²", "10⁻³", "10⁻⁴", "10⁻⁵"]);
        assert_eq!(texts(&residual, 2), ["10⁻¹", "10⁻³", "10⁻⁵"]);
        // Distances are those of the logarithms, and zero has no place.
        let extent = residual.extent();
        assert!((extent.start + 5.0).abs() < 1e-12 && (extent.end + 1.0).abs() < 1e-12);
        assert!((residual.place(1e-3) + 3.0).abs() < 1e-12);
        assert!(!residual.place(0.0).is_finite() && !residual.place(-1.0).is_finite());
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
