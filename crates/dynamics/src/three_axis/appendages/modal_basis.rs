//! Free modes at one configuration of the drives, in which the state is carried for some time.

use flexsc_numerics::attitude::Vector;
use nalgebra::{DMatrix, DVector, Matrix3};

use super::configuration::Configuration;
use super::{ArticulatedBody, DriveAngles};
use crate::three_axis::body::{FlexibleBody, FreeMode};
use crate::three_axis::free_modes::FreeModes;

/// Free modes at one configuration of the drives.
#[derive(Clone, Debug)]
pub struct ModalBasis {
    /// Inertia at this configuration (kg m²), and centre of mass at the start (m).
    pub inertia: Matrix3<f64>,
    pub first_centre: Vector,
    /// Frequencies W (rad/s), shapes Y and inverse Y⁻¹ = W⁻² Y' O².
    pub frequencies: Vec<f64>,
    pub shapes: DMatrix<f64>,
    pub inverse: DMatrix<f64>,
    /// Hub rotations phi per unit of each mode (rad/(m sqrt(kg))).
    pub rotations: Vec<Vector>,
    /// Changes J1 of the inertia per unit of each mode (sqrt(kg) m).
    moments: Vec<Matrix3<f64>>,
    /// Modal damping matrix Y' D Y (1/s).
    damping: DMatrix<f64>,
    /// Matrix that transforms forces on the free modes of the start into forces on these modes.
    pub from_start: DMatrix<f64>,
    /// Inverse of Y' at the start.
    start: DMatrix<f64>,
}

impl ModalBasis {
    /// Computes the modes at the start of the run, with the drives at their initial angles.
    pub fn initial(of: &ArticulatedBody, angles: &dyn DriveAngles) -> Option<Self> {
        let mut configuration = Configuration::default();
        of.update(|drive| angles.at(drive, 0.0), &[], &mut configuration);
        let free = configuration.free_modes(of)?;
        let start = inverse(of, &free).transpose();
        Some(Self::new(of, &configuration, free, (configuration.centre, start)))
    }

    /// Computes the modes at a time `t` since the start (s), ordered and signed like the modes here.
    pub fn at(&self, of: &ArticulatedBody, angles: &dyn DriveAngles, t: f64) -> Option<Self> {
        let mut configuration = Configuration::default();
        of.update(|drive| angles.at(drive, t), &[], &mut configuration);
        let free = self.reordered(&configuration.free_modes(of)?);
        Some(Self::new(of, &configuration, free, (self.first_centre, self.start.clone())))
    }

    fn new(
        of: &ArticulatedBody,
        configuration: &Configuration,
        free: FreeModes,
        (first_centre, start): (Vector, DMatrix<f64>),
    ) -> Self {
        let inverse = inverse(of, &free);
        let own: Vec<f64> = of.modes().map(|mode| 2.0 * mode.damping * mode.frequency).collect();
        let damped =
            DMatrix::from_fn(own.len(), own.len(), |row, column| own[row] * free.shapes[(row, column)]);
        let moments = (0..own.len()).map(|column| {
            let shape = free.shapes.column(column);
            configuration
                .moments
                .iter()
                .zip(shape.iter())
                .fold(Matrix3::zeros(), |sum: Matrix3<f64>, (moments, part)| sum + moments * *part)
        });
        let damping = free.shapes.tr_mul(&damped);
        Self {
            inertia: configuration.inertia,
            first_centre,
            moments: moments.collect(),
            damping: 0.5 * (&damping + damping.transpose()),
            rotations: (0..own.len()).map(|mode| free.rotation(mode)).collect(),
            from_start: free.shapes.tr_mul(&start),
            inverse,
            frequencies: free.frequencies,
            shapes: free.shapes,
            start,
        }
    }

    /// Reorders modes and flips their signs so that each corresponds to the most similar mode here.
    pub fn reordered(&self, free: &FreeModes) -> FreeModes {
        let order = free.frequencies.len();
        // For the modes of one body, W⁻¹ Y' O² Y W⁻¹ = 1.
        let likeness = &self.inverse * &free.shapes;
        let alike = |here: usize, there: usize| {
            likeness[(here, there)] * self.frequencies[here] / free.frequencies[there]
        };
        let mut pairs: Vec<(usize, usize)> =
            (0..order).flat_map(|here| (0..order).map(move |there| (here, there))).collect();
        pairs.sort_by(|a, b| alike(b.0, b.1).abs().total_cmp(&alike(a.0, a.1).abs()));
        let (mut taken, mut chosen) = (vec![false; order], vec![None; order]);
        for (here, there) in pairs {
            if chosen[here].is_none() && !taken[there] {
                (chosen[here], taken[there]) = (Some(there), true);
            }
        }
        let chosen: Vec<(usize, f64)> = chosen
            .into_iter()
            .enumerate()
            .map(|(here, there)| {
                let there = there.unwrap_or(here);
                (there, if alike(here, there) < 0.0 { -1.0 } else { 1.0 })
            })
            .collect();
        let mut sorted = free.clone();
        for (here, (there, sign)) in chosen.into_iter().enumerate() {
            sorted.frequencies[here] = free.frequencies[there];
            sorted.shapes.set_column(here, &(free.shapes.column(there) * sign));
            sorted.rotations.set_column(here, &(free.rotations.column(there) * sign));
            sorted.translations.set_column(here, &(free.translations.column(there) * sign));
        }
        sorted
    }

    /// Returns the body with its drives fixed at this configuration.
    pub fn flexible(&self) -> FlexibleBody {
        let mode = |(index, frequency): (usize, &f64)| FreeMode {
            frequency: *frequency,
            damping: self.damping[(index, index)] / (2.0 * frequency),
            rotation: self.rotations[index],
            moments: self.moments[index],
        };
        FlexibleBody {
            inertia: self.inertia,
            modes: self.frequencies.iter().enumerate().map(mode).collect(),
            damping: Some(self.damping.clone()),
        }
    }

    /// Returns the clamped displacements eta = Y q.
    pub fn to_clamped(&self, q: &[f64]) -> Vec<f64> {
        (&self.shapes * DVector::from_column_slice(q)).as_slice().to_vec()
    }

    /// Returns the clamped momenta pi for the canonical rates P.
    pub fn to_clamped_momenta(&self, p: &[f64]) -> Vec<f64> {
        self.inverse.tr_mul(&DVector::from_column_slice(p)).as_slice().to_vec()
    }

    /// Returns the free displacements q for eta.
    pub fn to_free(&self, eta: &[f64]) -> Vec<f64> {
        (&self.inverse * DVector::from_column_slice(eta)).as_slice().to_vec()
    }

    /// Returns P for pi, or the forces on the free modes for those on clamped modes.
    pub fn force_to_free(&self, pi: &[f64]) -> Vec<f64> {
        self.shapes.tr_mul(&DVector::from_column_slice(pi)).as_slice().to_vec()
    }

    /// Returns the elastic rotation of the hub from the mean axes for displacements q (rad).
    pub fn hub_rotation(&self, q: &[f64]) -> Vector {
        self.rotations.iter().zip(q).fold(Vector::zeros(), |sum, (rotation, q)| sum + rotation * *q)
    }
}

/// Computes Y⁻¹ = W⁻² Y' O².
pub fn inverse(of: &ArticulatedBody, free: &FreeModes) -> DMatrix<f64> {
    let held: Vec<f64> = of.modes().map(|mode| mode.frequency).collect();
    DMatrix::from_fn(held.len(), held.len(), |row, column| {
        let ratio = held[column] / free.frequencies[row];
        free.shapes[(column, row)] * ratio * ratio
    })
}
