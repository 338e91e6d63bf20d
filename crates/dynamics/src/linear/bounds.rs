//! Bounds of the second and third derivative of an output for the time to come.

use flexsc_numerics::phasor::{Phasor, abs};
use nalgebra::DVector;

use super::flow::{Cluster, LinearFlow};
use super::segment::{LinearOutput, LinearSegment};

impl LinearFlow {
    /// Updates the bounds from the decay e^(sigma h) of each pole and the residues of the segment. They are valid for
    /// `seen.window` (s).
    pub(super) fn bound(&self, segment: &LinearSegment, output: &mut LinearOutput) {
        let count = self.poles.len();
        output.window = self.window;
        let mut beaten = f64::INFINITY;
        for (j, (curvature, jerk)) in output.curvature.iter_mut().zip(&mut output.jerk).enumerate() {
            (*curvature, *jerk) = (0.0, 0.0);
            let sizes = &segment.sizes[j * count..(j + 1) * count];
            for ((simple, size), moved) in self.poles.iter().zip(sizes).zip(&output.exponentials) {
                let bound = size * moved.1 * simple.growth;
                *curvature += bound;
                *jerk += bound * simple.pole.size;
            }
            for (a, b, apart, window) in &self.beats {
                let term = |k: usize| {
                    let weight = self.poles[k].weight;
                    segment.residues[j * count + k] * output.exponentials[k].0 * weight
                };
                let (s, t) = (term(*a), term(*b));
                let (x, y) = (abs(s), abs(t));
                let together = abs(s + t) + x.min(y) * apart * window;
                if together < x + y {
                    let (p, q) = (self.poles[*a].pole, self.poles[*b].pole);
                    let (u, v) = (x * p.size, y * q.size);
                    let steeper = abs(s * p.lambda + t * q.lambda) + u.min(v) * apart * window;
                    *curvature -= x * self.poles[*a].growth + y * self.poles[*b].growth - together;
                    *jerk -= u * self.poles[*a].growth + v * self.poles[*b].growth - steeper.min(u + v);
                    beaten = beaten.min(*window);
                }
            }
            // Compensates for rounding in the differences.
            *curvature *= 1.0 + 1e-12;
            *jerk *= 1.0 + 1e-12;
        }
        output.window = output.window.min(beaten);
        for (cluster, rates) in self.clusters.iter().zip(&output.rates) {
            output.window = output.window.min(cluster.window);
            for (j, (curvature, jerk)) in output.curvature.iter_mut().zip(&mut output.jerk).enumerate() {
                let [c, d] = cluster.bounds(j, rates);
                *curvature += c;
                *jerk += d;
            }
        }
    }
}

impl Cluster {
    /// Returns bounds of y'' and y''' of an output within its window, from its current rates.
    pub(super) fn bounds(&self, output: usize, rates: &DVector<Phasor>) -> [f64; 2] {
        let factor = self.growth * self.block.weight;
        if rates.len() == 2 {
            let t = &self.block.triangle;
            let decay = -t[(0, 0)].re.max(t[(1, 1)].re);
            let longest =
                if decay > 0.0 { self.window.min(1.0 / (core::f64::consts::E * decay)) } else { self.window };
            let coupled = abs(t[(0, 1)]) * longest;
            let reach = [abs(rates[0]) + coupled * abs(rates[1]), abs(rates[1])];
            [&self.residue, &self.jerk]
                .map(|row| factor * (abs(row[(output, 0)]) * reach[0] + abs(row[(output, 1)]) * reach[1]))
        } else {
            let size = |sum: f64, z: &Phasor| sum + z.norm_sqr();
            let rates = f64::sqrt(rates.iter().fold(0.0, size));
            [&self.residue, &self.jerk]
                .map(|row| factor * rates * f64::sqrt(row.row(output).iter().fold(0.0, size)))
        }
    }
}
