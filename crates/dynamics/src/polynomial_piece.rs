//! Motion as a sequence of polynomial pieces: Taylor series of all coordinates, each over a time in which they are
//! exact to rounding.
//!
//! The pieces depend on the motion alone, so that results found on them do not depend on other observers.

use flexsc_numerics::polynomial::{Polynomial, Series, TERMS};
use nalgebra::{DMatrix, DVector};

/// Length of a piece in radians of the fastest motion: the truncation error of its series is 1.5^22/22!, 7e-18.
pub const REACH: f64 = 1.5;

/// Taylor series of all coordinates of a body, in the time since the start of a piece (s).
#[derive(Clone, Debug)]
pub struct SeriesExpansion {
    /// Rigid angle, then each mode's displacement; for a chain, the angle of the hub, then of each section (rad).
    pub coordinates: Vec<Series>,
    /// Waveform of the command (N m; rad/s² if the hub's motion is commanded).
    pub command: Series,
}

impl SeriesExpansion {
    /// Creates series of `coordinates` coordinates at rest.
    pub fn new(coordinates: usize) -> Self {
        Self { coordinates: vec![[0.0; TERMS]; coordinates], command: [0.0; TERMS] }
    }
}

/// Observed motion over a piece: polynomials in the elapsed fraction of the piece, from 0 to 1.
#[derive(Clone, Debug)]
pub struct MotionPiece {
    /// Start time of the piece (s).
    pub from: f64,
    /// Length of the piece (s).
    pub length: f64,
    /// Angle of the hub (rad).
    pub angle: Polynomial,
    /// Observed coordinates, each in its own unit.
    pub outputs: Vec<Polynomial>,
    /// Torque of the actuator (N m; rad/s² if the hub's motion is commanded).
    pub applied: Polynomial,
    /// Torque requested by the law (N m).
    pub feedback: f64,
}

/// Taylor expansion of the motion of a linear system z' = A z + b.
#[derive(Clone, Debug)]
pub struct LinearExpansion {
    system: DMatrix<f64>,
    push: DVector<f64>,
    /// Start time of the series (s).
    begins: f64,
    series: Vec<Series>,
    reach: f64,
}

impl LinearExpansion {
    /// Creates the expansion at z; `fastest` bounds the rates of change in the system (rad/s).
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

    /// Expands about the time `h` (s), not before an earlier one; returns the time for which the series are exact
    /// (s).
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

    /// Returns the series of z.
    pub fn series(&self) -> &[Series] {
        &self.series
    }

    /// Computes each term from the previous one.
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
