//! Validity of MYSTRAN's participation factors: they require that the forces at the clamp act at one grid.
//!
//! The rotation columns sum the moments at clamped grids without the arms of the forces there. With one clamped grid
//! they are correct about that grid; with several the file does not contain the arms.

use std::collections::BTreeMap;

use super::text::TextLine;
use super::{FileMode, NaturalFrequency};

/// Ratio of a grid's force or moment to the largest one above which the grid counts as clamped.
const CLAMPED: f64 = 1e-6;
/// Relative tolerance between factors and forces, of a mode's largest.
const AGREEMENT: f64 = 1e-4;

/// Forces and moments at the clamp, mode by mode.
#[derive(Default)]
pub struct Reactions {
    modes: BTreeMap<usize, Vec<(usize, [f64; 6])>>,
}

impl Reactions {
    /// Reads a row `grid, system, three forces, three moments`.
    ///
    /// # Errors
    /// Fields that are not of this form.
    pub fn read_line(&mut self, mode: usize, line: &TextLine) -> Result<(), String> {
        let fields = line.fields(["GRID", "COORD", "T1", "T2", "T3", "R1", "R2", "R3"])?;
        self.modes.entry(mode).or_default().push((fields.whole(0)?, fields.six(2)?));
        Ok(())
    }

    /// Checks that only one grid is clamped, and that its forces agree with the participations of the modes.
    ///
    /// # Errors
    /// No forces, several grids, or other forces.
    pub fn confirm(&self, natural: &[NaturalFrequency], modes: &[FileMode]) -> Result<(), String> {
        let mut grids: BTreeMap<usize, [f64; 2]> = BTreeMap::new();
        for (natural, mode) in natural.iter().zip(modes) {
            let Some(rows) = self.modes.get(&natural.mode) else {
                return Err(format!(
                    "must have the forces at the clamp in mode {}: ask for `SPCFORCES = ALL`, as they alone tell whether \
                     MYSTRAN's factors in rotation are right",
                    natural.mode
                ));
            };
            let scale = -1.0 / (natural.frequency * natural.frequency * f64::sqrt(natural.generalised_mass));
            let mut sum = [0.0; 6];
            for (grid, forces) in rows {
                let forces = forces.map(|force| scale * force);
                sum.iter_mut().zip(forces).for_each(|(sum, force)| *sum += force);
                let most = grids.entry(*grid).or_default();
                *most = [most[0].max(largest(&forces[..3])), most[1].max(largest(&forces[3..]))];
            }
            let parts = [mode.translation, mode.rotation].concat();
            for kind in [0..3, 3..6] {
                let bound = AGREEMENT * largest(&parts[kind.clone()]).max(largest(&sum[kind.clone()]));
                if let Some(index) =
                    kind.into_iter().find(|index| (parts[*index] - sum[*index]).abs() > bound)
                {
                    let (axis, is, follows) =
                        (["T1", "T2", "T3", "R1", "R2", "R3"][index], parts[index], sum[index]);
                    return Err(format!(
                        "must have the same participation of mode {} from its factor {axis}, {is}, and from the forces at \
                         the clamp, {follows}",
                        natural.mode
                    ));
                }
            }
        }
        let most = |kind: usize| grids.values().fold(0.0, |most: f64, grid| most.max(grid[kind]));
        let bounds = [CLAMPED * most(0), CLAMPED * most(1)];
        let clamped: Vec<_> = grids
            .iter()
            .filter(|(_, most)| most[0] > bounds[0] || most[1] > bounds[1])
            .map(|(grid, _)| grid)
            .collect();
        if let [first, second, ..] = clamped[..] {
            return Err(format!(
                "must have one clamped grid, and has {} (first {first}, {second}): MYSTRAN leaves the arms of forces out \
                 of its factors in rotation; clamp one grid at the root, and tie the others to it by an RBE2",
                clamped.len()
            ));
        }
        Ok(())
    }
}

fn largest(parts: &[f64]) -> f64 {
    parts.iter().fold(0.0, |most: f64, part| most.max(part.abs()))
}
