//! Environment on an orbit that depends on time alone: position, magnetic field and Sun, as one row of numbers.

#[cfg(test)]
mod tests;

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time_arcs::{SplitTime, TimeArc};

use super::ground_site::{self, RADIUS};
use super::magnetic_field::PlanetField;
use super::sun::Sunlight;
use super::{OrbitPath, SunPath, density};

/// Number of columns, of which the last is unused: a multiple of the lanes of processors.
pub(super) const COLUMNS: usize = 16;

/// Relative size of the last two Chebyshev coefficients of an arc up to which it is not halved.
const TAIL: f64 = 1e-14;

/// First columns of the vectors.
const POSITION: usize = 0;
const VELOCITY: usize = 3;
const FIELD: usize = 6;
const SUN: usize = 9;
/// Columns of the other numbers.
const PRESSURE: usize = 12;
const HEIGHT: usize = 13;
const BULGE: usize = 14;

/// Environment at an instant; 0 where there is none.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) struct SkyRow(pub [f64; COLUMNS]);

impl SkyRow {
    /// Evaluates the environment at a time since the start, with the height above the ellipsoid of the Earth, or without.
    pub fn new(
        orbit: Option<&OrbitPath>,
        field: Option<&PlanetField>,
        sun: Option<&SunPath>,
        has_height: bool,
        t: SplitTime,
    ) -> Self {
        let mut row = Self([0.0; COLUMNS]);
        let light = sun.map(|sun| sun.light(t));
        if let Some(light) = &light {
            row.set_vector(SUN, &light.direction);
            row.0[PRESSURE] = light.pressure;
        }
        let Some(orbit) = orbit else { return row };
        let [position, velocity] = orbit.state(t);
        row.set_vector(POSITION, &position);
        row.set_vector(VELOCITY, &velocity);
        if let Some(field) = field {
            row.set_vector(FIELD, &field.at(&position, t));
        }
        if has_height {
            row.0[HEIGHT] = ground_site::height(&position);
            row.0[BULGE] = light.map_or(0.0, |light| density::bulge_cosine(&position, &light.direction));
        }
        row
    }

    /// Returns true if an arc need not be halved. Position and field are checked on an orbit by rows only: the length of arcs on
    /// one by Kepler elements has a proof.
    pub fn is_resolved(arc: &TimeArc<COLUMNS>, tail: &[f64; COLUMNS], has_rows: bool) -> bool {
        let middle = Self(*arc.in_middle());
        let largest = |first: usize| tail[first].max(tail[first + 1]).max(tail[first + 2]);
        let is_smooth = tail[HEIGHT] <= TAIL * RADIUS && tail[BULGE] <= TAIL;
        is_smooth
            && (!has_rows
                || (largest(POSITION) <= TAIL * middle.position().norm()
                    && largest(FIELD) <= TAIL * middle.field().norm()))
    }

    fn set_vector(&mut self, first: usize, v: &Vector) {
        self.0[first..first + 3].copy_from_slice(v.as_slice());
    }

    fn vector(&self, first: usize) -> Vector {
        Vector::new(self.0[first], self.0[first + 1], self.0[first + 2])
    }

    /// Returns the position from the planet's centre (m).
    pub fn position(&self) -> Vector {
        self.vector(POSITION)
    }

    /// Returns the velocity (m/s).
    pub fn velocity(&self) -> Vector {
        self.vector(VELOCITY)
    }

    /// Returns the magnetic field (T).
    pub fn field(&self) -> Vector {
        self.vector(FIELD)
    }

    /// Returns the light of the Sun as outside of the planet's shadow.
    pub fn light(&self) -> Sunlight {
        Sunlight { direction: self.vector(SUN), pressure: self.0[PRESSURE] }
    }

    /// Returns the height above the ellipsoid of the Earth (m).
    pub fn height(&self) -> f64 {
        self.0[HEIGHT]
    }

    /// Returns the cosine of the angle from the bulge of the atmosphere.
    pub fn bulge_cosine(&self) -> f64 {
        self.0[BULGE]
    }
}
