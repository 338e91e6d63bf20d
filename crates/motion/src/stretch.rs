//! A motion stretch by stretch: Taylor series of all coordinates, each over a time in which they are exact to rounding.
//!
//! The stretches depend on the motion alone, so that what is found on them is the same whoever else looks.

use nalgebra::{DMatrix, DVector};

use crate::numerics::polynomial::{Polynomial, Series, TERMS};

/// A stretch is so many radians of the fastest motion long: what its series leave out is 1.5^22/22!, 7e-18.
pub const REACH: f64 = 1.5;

/// The series of all coordinates of a body, in the time since a stretch began (s).
#[derive(Clone, Debug)]
pub struct Expansion {
    /// The rigid angle, then each mode's displacement; of a chain the angle of the hub, then of each section (rad).
    pub coordinates: Vec<Series>,
    /// The waveform of the command (N m; rad/s² where the hub's motion is commanded).
    pub command: Series,
}

impl Expansion {
    /// Of so many coordinates that rest.
    pub fn new(coordinates: usize) -> Self {
        Self { coordinates: vec![[0.0; TERMS]; coordinates], command: [0.0; TERMS] }
    }
}

/// What is observed of a motion over a stretch: polynomials in its part that has passed, from 0 to 1.
#[derive(Clone, Debug)]
pub struct Stretch {
    /// When it begins (s).
    pub from: f64,
    /// How long it is (s).
    pub length: f64,
    /// The hub's angle (rad).
    pub angle: Polynomial,
    /// The observed coordinates, each in its own unit.
    pub outputs: Vec<Polynomial>,
    /// The actuator's torque (N m; rad/s² where the hub's motion is commanded).
    pub applied: Polynomial,
    /// The torque that the law asks for (N m).
    pub feedback: f64,
}

/// The motion of a linear system z' = A z + b.
#[derive(Clone, Debug)]
pub struct Linear {
    system: DMatrix<f64>,
    push: DVector<f64>,
    /// When the series begin (s), and the series of z.
    begins: f64,
    series: Vec<Series>,
    reach: f64,
}

impl Linear {
    /// The system at z, none of whose parts changes faster than this (rad/s).
    pub fn new(system: &DMatrix<f64>, push: DVector<f64>, z: &DVector<f64>, fastest: f64) -> Self {
        let start = |z: &f64| {
            let mut series = [0.0; TERMS];
            series[0] = *z;
            series
        };
        let series = z.iter().map(start).collect();
        let mut linear = Self { system: system.clone(), push, begins: 0.0, series, reach: REACH / fastest };
        linear.fill();
        linear
    }

    /// Expands about a time (s), not before an earlier one; returns how far the series reach (s).
    pub fn expand(&mut self, h: f64) -> f64 {
        if h > self.begins {
            let after = h - self.begins;
            for series in &mut self.series {
                series[0] = series.iter().rev().fold(0.0, |sum, c| sum * after + c);
            }
            self.begins = h;
            self.fill();
        }
        self.reach
    }

    /// The series of z.
    pub fn series(&self) -> &[Series] {
        &self.series
    }

    /// Each term from the one before.
    fn fill(&mut self) {
        let Self { system, push, series, .. } = self;
        for n in 1..TERMS {
            for (i, push) in push.iter().enumerate() {
                let row = system.row(i);
                let sum: f64 = row.iter().zip(series.iter()).map(|(a, z)| a * z[n - 1]).sum();
                series[i][n] = (sum + if n == 1 { *push } else { 0.0 }) / n as f64;
            }
        }
    }
}
