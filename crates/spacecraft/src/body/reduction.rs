//! Reduction of a structure to the planar body with its lowest modes.
//!
//! Free modes move the hub: x_n = X_n\[theta\] f_n with the gain J X_n\[theta\]², so that the hub's angle is x_r + sum
//! x_n. Modes of the clamped structure do not: x_n = -(m_n/J) f_n with the gain m_n²/J, and the torque that moves the
//! hub as commanded is J (u - sum x_n'').
//!
//! A torque that acts elsewhere has generalised forces Q on the coordinates, in sum 1 about the axis: it excites a free mode
//! with X_n' Q in place of X_n\[theta\], which is the gain J X_n\[theta\] X_n' Q.

use flexsc_dynamics::axis_model::{AxisMode, AxisModel, AxisOutput, CommandedQuantity};
use flexsc_formats::document::ConfigError;
use flexsc_formats::structure::{HubState, Modes, Structure, TOO_FAR_APART, eigenvalues};
use flexsc_numerics::quantity::{Finite, Frequency, Positive};
use nalgebra::DMatrix;

use super::DampingRatios;
use super::load;
use super::one_axis::HUB_FREE;

/// Part of the largest load on a mode that counts as none.
const UNLOADED: f64 = 1e-9;
/// Highest natural frequency of the modes that are kept by default (rad/s).
const KEPT: f64 = 1e3;
/// Ratio x_n/f_n times sqrt(J) for a mode that a load excites and that does not turn the hub: so small that the mode is lost
/// in the rounding of the hub's angle.
const UNSEEN: f64 = 1e-24;

/// Settings of a modal reduction: damping, number of modes to keep, initial state and outputs.
pub struct ModalReduction<'a> {
    pub drive: CommandedQuantity,
    pub damping: &'a DampingRatios,
    pub damping_matrix: Option<DMatrix<f64>>,
    pub keep: Option<u32>,
    pub angle: Finite,
    pub rate: Finite,
    pub outputs: Vec<ObservedCoordinate>,
    /// Generalised force on each coordinate, if the commanded torque acts elsewhere than on the hub.
    pub load: Option<Vec<f64>>,
}

/// Observed coordinate: its name, its unit, and a weight for each coordinate of the structure.
pub struct ObservedCoordinate {
    pub name: String,
    pub unit: String,
    pub weights: Vec<f64>,
}

impl ModalReduction<'_> {
    /// Computes the planar body with the modes to keep.
    pub fn axis_model(&self, structure: &Structure) -> Result<AxisModel, ConfigError> {
        let mut weights: Vec<_> = self.outputs.iter().map(|output| output.weights.clone()).collect();
        if let Some(damping) = &self.damping_matrix {
            if self.drive == CommandedQuantity::Motion {
                return Err(ConfigError::new("damping_matrix", HUB_FREE));
            }
            // Observe every coordinate, to get the complete shape of each mode.
            let order = damping.nrows();
            let unit = |i: usize| (0..order).map(|j| f64::from(u8::from(i == j))).collect();
            weights.extend((0..order).map(unit));
        }
        weights.extend(self.load.clone());
        let hub = match self.drive {
            CommandedQuantity::Torque => HubState::Free,
            CommandedQuantity::Motion => HubState::Held,
        };
        let solved = structure.modes(hub, &weights)?;
        let up_to = |limit: f64| solved.frequencies.iter().take_while(|w| **w <= limit).count();
        let resolved = up_to(Frequency::LARGEST);
        let count = self.keep.map_or_else(|| up_to(KEPT), |keep| keep as usize);
        if count > resolved {
            let why = format!(
                "must be at most {resolved}, the number of modes up to {:e} rad/s, got {count}",
                Frequency::LARGEST
            );
            return Err(ConfigError::new("keep", why));
        }
        let damping = self.damping.for_modes(count).map_err(|why| ConfigError::new("damping", why))?;
        let inertia = solved.inertia;
        let loads = self.loads(structure, &solved)?;
        // Ratio of the body's modal displacement x_n to the structure's f_n.
        let scale = |n: usize| match (self.drive, solved.participations[n]) {
            (CommandedQuantity::Torque, 0.0) if loads.as_ref().is_some_and(|loads| is_loaded(loads, n)) => {
                UNSEEN / f64::sqrt(inertia)
            }
            (CommandedQuantity::Torque, own) => own,
            (CommandedQuantity::Motion, own) => -own / inertia,
        };
        let mut modes = Vec::with_capacity(count);
        for (n, damping) in damping.into_iter().enumerate() {
            let w = solved.frequencies[n];
            let frequency = Frequency::new(w).ok_or_else(|| {
                let why = format!("gives an elastic mode of {w:e} rad/s, and the lowest accepted has 1e-4");
                ConfigError::new("stiffness", why)
            })?;
            let hub_gain = finite(inertia * scale(n) * scale(n))?;
            let gain = match &loads {
                Some(loads) => finite(inertia * scale(n) * loads[n])?,
                None => hub_gain,
            };
            modes.push(AxisMode { hub_gain, ..AxisMode::at_rest(frequency, gain, damping) });
        }
        let output = |(observed, (rigid, shape)): (&ObservedCoordinate, (&f64, &Vec<f64>))| {
            let weight = |n: usize| {
                // A mode that neither the hub nor the load excites stays at rest.
                if modes[n].hub_gain.get() == 0.0 {
                    Ok(Finite::default())
                } else {
                    finite(shape[n] / scale(n))
                }
            };
            Ok(AxisOutput {
                name: observed.name.clone(),
                unit: observed.unit.clone(),
                rigid: finite(*rigid)?,
                modes: (0..count).map(weight).collect::<Result<_, ConfigError>>()?,
            })
        };
        let observations = solved.rigid.iter().zip(&solved.shapes);
        let outputs =
            self.outputs.iter().zip(observations).map(output).collect::<Result<_, ConfigError>>()?;
        let damping_matrix = match &self.damping_matrix {
            Some(matrix) => {
                let coordinates = &solved.shapes[self.outputs.len()..][..matrix.nrows()];
                coupled(matrix, coordinates, count, &scale)?
            }
            None => Vec::new(),
        };
        let inertia = Positive::new(inertia).ok_or_else(too_large)?;
        Ok(AxisModel {
            inertia,
            angle: self.angle,
            rate: self.rate,
            drive: self.drive,
            damping_matrix,
            modes,
            outputs,
        })
    }
}

impl ModalReduction<'_> {
    /// Returns the load X_n' Q on each mode of unit modal mass, per unit of torque about the axis.
    fn loads(&self, structure: &Structure, solved: &Modes) -> Result<Option<Vec<f64>>, ConfigError> {
        let (Some(forces), Some(own)) = (&self.load, solved.shapes.last()) else { return Ok(None) };
        let torque = load::torque(forces, structure.rotation())?;
        Ok(Some(own.iter().map(|load| load / torque).collect()))
    }
}

/// Returns true if the load on a mode is more than rounding.
fn is_loaded(loads: &[f64], mode: usize) -> bool {
    loads[mode].abs() > UNLOADED * loads.iter().fold(0.0, |most: f64, load| most.max(load.abs()))
}

/// Returns the damping matrix of the kept modes, from the damping matrix of the coordinates and the shapes for unit
/// modal mass: f_n'' has -sum_m X_n' C X_m f_m', and x_n is f_n times `scale(n)`.
fn coupled(
    matrix: &DMatrix<f64>,
    shapes: &[Vec<f64>],
    count: usize,
    scale: &dyn Fn(usize) -> f64,
) -> Result<Vec<Vec<Finite>>, ConfigError> {
    let error_with = |why: String| ConfigError::new("damping_matrix", why);
    let modes = DMatrix::from_fn(shapes.len(), count, |i, n| shapes[i][n]);
    let damping = modes.tr_mul(&(matrix * &modes));
    let largest = damping.amax();
    let symmetric = (&damping + damping.transpose()) * 0.5;
    let lowest = eigenvalues(&symmetric).ok_or_else(too_large)?.first().copied().unwrap_or(0.0);
    if lowest < -1e-9 * largest {
        return Err(error_with(format!("must be positive semidefinite, but excites a mode at {lowest} 1/s")));
    }
    let element = |n: usize, m: usize| {
        if n == m || damping[(n, m)] == 0.0 {
            return finite(damping[(n, m)]);
        }
        if scale(n) != 0.0 && scale(m) != 0.0 {
            return finite(scale(n) * damping[(n, m)] / scale(m));
        }
        if damping[(n, m)].abs() > 1e-9 * largest {
            let still = if scale(n) == 0.0 { n } else { m };
            return Err(error_with(format!(
                "couples mode {still} to the others, but that mode does not act on the hub"
            )));
        }
        Ok(Finite::default())
    };
    (0..count).map(|n| (0..count).map(|m| element(n, m)).collect()).collect()
}

fn finite(value: f64) -> Result<Finite, ConfigError> {
    Finite::new(value).ok_or_else(too_large)
}

fn too_large() -> ConfigError {
    ConfigError::new("mass", TOO_FAR_APART)
}
