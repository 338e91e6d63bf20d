//! From a structure to the planar body with its lowest modes.
//!
//! Free modes move the hub: x_n = X_n\[theta\] f_n with the gain J X_n\[theta\]², so that the hub's angle is x_r + sum x_n.
//! Modes of the clamped structure do not: x_n = -(m_n/J) f_n with the gain m_n²/J, so that the torque that moves the hub
//! as commanded is J (u - sum x_n'').

use super::{Damping, Drive, Mode, Output, Planar};
use crate::quantity::{Finite, Frequency, Positive};
use crate::structure::{Fault, Structure, TOO_FAR_APART};

/// What is kept of a structure, and how it starts.
pub struct Reduction<'a> {
    pub drive: Drive,
    pub damping: &'a Damping,
    pub keep: Option<u32>,
    pub angle: Finite,
    pub rate: Finite,
    pub outputs: Vec<Observed>,
}

/// A coordinate that is observed: its name, its unit, and a weight for each coordinate of the structure.
pub struct Observed {
    pub name: String,
    pub unit: String,
    pub weights: Vec<f64>,
}

impl Reduction<'_> {
    /// The planar body.
    pub fn planar(&self, structure: &Structure) -> Result<Planar, Fault> {
        let weights: Vec<_> = self.outputs.iter().map(|output| output.weights.clone()).collect();
        let solved = structure.modes(self.drive, &weights)?;
        let within = |w: &&f64| **w <= Frequency::LARGEST;
        let resolved = solved.frequencies.iter().take_while(within).count();
        let kept = self.keep.map_or(resolved, |keep| keep as usize);
        if kept > resolved {
            let why = format!(
                "must be at most {resolved}, the number of modes up to {:e} rad/s, got {kept}",
                Frequency::LARGEST
            );
            return Err(("keep".to_owned(), why));
        }
        let damping = self.damping.of(kept).map_err(|why| ("damping".to_owned(), why))?;
        let inertia = solved.inertia;
        // What one unit of modal displacement f_n is of the body's x_n.
        let scale = |n: usize| match self.drive {
            Drive::Torque => solved.participations[n],
            Drive::Motion => -solved.participations[n] / inertia,
        };
        let mut modes = Vec::with_capacity(kept);
        for (n, damping) in damping.into_iter().enumerate() {
            let w = solved.frequencies[n];
            let frequency = Frequency::new(w).ok_or_else(|| {
                let why = format!("gives an elastic mode of {w:e} rad/s, and the lowest accepted has 1e-4");
                ("stiffness".to_owned(), why)
            })?;
            let gain = finite(inertia * scale(n) * scale(n))?;
            modes.push(Mode::at_rest(frequency, gain, damping));
        }
        let output = |(observed, (rigid, shape)): (&Observed, (&f64, &Vec<f64>))| {
            let weight = |n: usize| {
                // What the hub cannot excite stays at rest.
                if modes[n].gain.get() == 0.0 { Ok(Finite::default()) } else { finite(shape[n] / scale(n)) }
            };
            Ok(Output {
                name: observed.name.clone(),
                unit: observed.unit.clone(),
                rigid: finite(*rigid)?,
                modes: (0..kept).map(weight).collect::<Result<_, Fault>>()?,
            })
        };
        let seen = solved.rigid.iter().zip(&solved.shapes);
        let outputs = self.outputs.iter().zip(seen).map(output).collect::<Result<_, Fault>>()?;
        let inertia = Positive::new(inertia).ok_or_else(too_large)?;
        Ok(Planar { inertia, angle: self.angle, rate: self.rate, drive: self.drive, modes, outputs })
    }
}

fn finite(value: f64) -> Result<Finite, Fault> {
    Finite::new(value).ok_or_else(too_large)
}

fn too_large() -> Fault {
    ("mass".to_owned(), TOO_FAR_APART.to_owned())
}
