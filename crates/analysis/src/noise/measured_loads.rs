//! Loads at points of the body, and the measured paths that take the place of the model.
//!
//! Between the rows of its table a path is interpolated on logarithmic scales, with the phase along the shorter arc. Outside its table the
//! model is left.

use std::f64::consts::FRAC_1_SQRT_2;

use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_dynamics::wrench::ForceEffect;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::inverse::inverse_3x3;
use flexsc_scenario::{MeasuredPath, Scenario};
use nalgebra::{Complex, DVector, Matrix3};

use super::output::diagonal;
use super::spectral_line::LoadColumn;
use crate::linear_model::Signal;
use crate::margins::frequency_response::{modulus, unit_circle};

/// Largest number of peaks of a path around which integrals have breaks.
const MOST_PEAKS: usize = 200;
/// Half width of the end of a table, relative to its frequency.
const END: f64 = 1e-6;

/// Force along and torque about x, y and z at a point of the body.
#[derive(Clone, Debug, PartialEq)]
pub struct VibrationLoad {
    /// Name of the point.
    pub point: String,
    /// Components: the number, of the force along x, y and z and then of the torque, and the column of the rates of the body's states.
    pub parts: Vec<VibrationPart>,
}

/// Component of a load.
#[derive(Clone, Debug, PartialEq)]
pub struct VibrationPart {
    /// Number: the force along x, y and z, and then the torque.
    pub number: usize,
    /// Complex amplitude (N, N m).
    pub amplitude: Complex<f64>,
    /// Column of the rates of the body's states under a unit.
    unit: DVector<f64>,
}

impl VibrationLoad {
    /// Creates a load at a point of a body by the complex amplitudes of its components (N, N m).
    pub fn new(body: &ThreeAxisModel, point: &str, amplitudes: [Complex<f64>; 6]) -> Self {
        let given = (0..6).filter(|number| amplitudes[*number] != Complex::ZERO);
        let part = |number: usize| VibrationPart {
            number,
            amplitude: amplitudes[number],
            unit: unit_column(body, point, number),
        };
        Self { point: point.to_owned(), parts: given.map(part).collect() }
    }

    /// Creates the load of a unit torque about an axis, with the column of the rates of the body's states.
    pub(super) fn of_torque(axis: usize, unit: DVector<f64>) -> Self {
        let part = VibrationPart { number: 3 + axis, amplitude: Complex::ONE, unit };
        Self { point: String::new(), parts: vec![part] }
    }

    /// Returns the column of the rates of the body's states.
    pub(super) fn column(&self) -> LoadColumn {
        let mut sum = LoadColumn::zeros(self.parts.first().map_or(0, |part| part.unit.len()));
        self.parts.iter().for_each(|part| sum += part.column());
        sum
    }
}

impl VibrationPart {
    /// Returns the column of the rates of the body's states.
    pub(super) fn column(&self) -> LoadColumn {
        self.unit.map(Complex::from) * self.amplitude
    }
}

/// Returns the column of the rates of a body's states under a unit of a component of a load at a point.
fn unit_column(body: &ThreeAxisModel, point: &str, number: usize) -> DVector<f64> {
    let unit = ForceEffect::unit(body, point, number);
    let inverse = inverse_3x3(body.inertia).unwrap_or_else(Matrix3::identity);
    let mut column = DVector::zeros(6 + 2 * body.modes.len());
    column.rows_mut(3, 3).copy_from(&(inverse * unit.torque));
    for mode in 0..body.modes.len() {
        column[7 + 2 * mode] = unit.forces.get(mode).copied().unwrap_or(0.0);
    }
    column
}

/// Measured response of an output to a component of a load.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredPart {
    /// Place of the output.
    pub output: usize,
    /// Number of the load, and of its component.
    pub load: (usize, usize),
    /// Name of the output whose model it replaces, and the part that it has in the output.
    pub replaced: (String, f64),
    /// Frequencies (rad/s) and responses at the amplitude of the component.
    rows: Vec<(f64, Complex<f64>)>,
}

impl MeasuredPart {
    /// Returns the measured components of loads for outputs with these names.
    pub fn all(scenario: &Scenario, outputs: &[&Signal], loads: &[VibrationLoad]) -> Vec<Self> {
        let mut found = Vec::new();
        for (output, signal) in outputs.iter().enumerate() {
            for (path, replaced) in paths(scenario, &signal.name) {
                for (load, own) in loads.iter().enumerate().filter(|(_, own)| own.point == path.point) {
                    let parts = own.parts.iter().enumerate().filter(|(_, part)| part.number == path.part());
                    for (number, part) in parts {
                        let response = |(frequency, [re, im]): (f64, [f64; 2])| {
                            (frequency, Complex::new(re, im) * part.amplitude)
                        };
                        let rows = path.responses().into_iter().map(response).collect();
                        found.push(Self { output, load: (load, number), replaced: replaced.clone(), rows });
                    }
                }
            }
        }
        found
    }

    /// Returns the response at a frequency (rad/s); `None` outside the table.
    pub fn at(&self, frequency: f64) -> Option<Complex<f64>> {
        let next = self.rows.partition_point(|row| row.0 < frequency);
        let (after, after_value) = *self.rows.get(next)?;
        if after <= frequency {
            return Some(after_value);
        }
        let (before, before_value) = self.rows[next.checked_sub(1)?];
        let part = libm::log(frequency / before) / libm::log(after / before);
        let [one, other] = [before_value, after_value].map(modulus);
        if one <= 0.0 || other <= 0.0 {
            return Some(before_value * (1.0 - part) + after_value * part);
        }
        let ratio = after_value / before_value;
        let turned = unit_circle(part * libm::atan2(ratio.im, ratio.re));
        Some(before_value * turned * libm::pow(other / one, part))
    }

    /// Returns the ends and the peaks of the response: frequency and half width (rad/s).
    pub fn resonances(&self) -> Vec<[f64; 2]> {
        let sizes: Vec<f64> = self.rows.iter().map(|(_, value)| modulus(*value)).collect();
        let frequency = |place: usize| self.rows[place].0;
        let is_top = |place: &usize| sizes[*place] > sizes[place - 1] && sizes[*place] >= sizes[place + 1];
        let width = |place: usize| {
            let is_low = |own: &usize| sizes[*own] < FRAC_1_SQRT_2 * sizes[place];
            let is_higher = |own: &usize| sizes[*own] > sizes[place];
            let below = (0..place).rev().find(|own| is_low(own) || is_higher(own));
            let above = (place + 1..sizes.len()).find(|own| is_low(own) || is_higher(own));
            let (below, above) = (below.filter(is_low)?, above.filter(is_low)?);
            Some(0.5 * (frequency(above) - frequency(below)))
        };
        let tops = (1..sizes.len().max(1) - 1).filter(is_top);
        let mut tops: Vec<(usize, f64)> = tops.filter_map(|place| Some((place, width(place)?))).collect();
        tops.sort_by(|a, b| sizes[b.0].total_cmp(&sizes[a.0]));
        tops.truncate(MOST_PEAKS);
        let ends = [self.rows.first(), self.rows.last()].into_iter().flatten();
        let ends = ends.map(|(frequency, _)| [*frequency, END * frequency]);
        ends.chain(tops.into_iter().map(|(place, width)| [frequency(place), width])).collect()
    }
}

/// Returns the measured paths of an output of a line of sight, each with the output about the path's axis that it replaces, and the part
/// that it has in the output: about an axis or between two, behind or before a mirror, or of the mirror.
fn paths<'a>(scenario: &'a Scenario, output: &str) -> Vec<(&'a MeasuredPath, (String, f64))> {
    let rest = output.strip_prefix("line_of_sight").or_else(|| output.strip_prefix("mirror"));
    let Some((line, about)) = rest.and_then(|rest| rest.split_once('_')) else { return Vec::new() };
    let Some(sight) = line.parse::<usize>().ok().and_then(|line| scenario.line_of_sight.get(line)) else {
        return Vec::new();
    };
    let about = about.strip_suffix("_before_mirror").unwrap_or(about);
    let direction: Vector = if about.len() == 1 { axis(about) } else { diagonal(about) };
    let path = |own: &'a MeasuredPath| {
        let part = direction[own.about as usize];
        (part != 0.0).then(|| (own, (format!("line_of_sight{line}_{}", own.about.letter()), part)))
    };
    sight.measured.iter().filter_map(path).collect()
}

fn axis(name: &str) -> Vector {
    let part = |axis: &str| if name == axis { 1.0 } else { 0.0 };
    Vector::new(part("x"), part("y"), part("z"))
}
