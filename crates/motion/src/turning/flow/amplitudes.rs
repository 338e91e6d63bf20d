//! The amplitudes of the modes at the start of a step, four modes side by side.

use crate::attitude::Vector;
use crate::lanes::{LaneWork, Real};
use crate::turning::model::Model;
use crate::turning::pace::Amplitude;

/// What the modes of a body are, and what acts on them.
pub(super) struct Amplitudes<'a> {
    pub model: &'a Model,
    /// q and P/W of each.
    pub modes: &'a [[f64; 4]],
    /// Forces beside those of the torque, of none at all or each (N/sqrt(kg)).
    pub forces: &'a [f64],
    /// Gt.
    pub turning: Vector,
    /// The torque that turns the hub, and the same with what the rotation adds (N m).
    pub pushed: Vector,
    pub net: Vector,
    /// What the rotation does by each number of a mode's moments (rad²/s²).
    pub spun: [f64; 6],
    pub found: &'a mut [Amplitude],
}

impl LaneWork for Amplitudes<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self, kind: R) {
        let Self { model, modes, forces, turning, pushed, net, spun, found } = self;
        for group in 0..model.abreast.len() {
            let (of, first) = (&model.abreast[group], 4 * group);
            let (mut q, mut p, mut forced) = ([0.0; 4], [0.0; 4], [0.0; 4]);
            for lane in 0..4 {
                if let Some([displacement, rate, ..]) = modes.get(first + lane) {
                    (q[lane], p[lane]) = (*displacement, *rate);
                }
                if let Some(force) = forces.get(first + lane) {
                    forced[lane] = *force;
                }
            }
            let (q, p, forced) = (kind.load(&q), kind.load(&p), kind.load(&forced));
            let w = kind.load(&of.frequency);
            let held = (of.along(kind, &net) + of.moved(kind, &spun) + forced) / (w * w);
            let speed = (p + of.along(kind, &turning) / w).abs();
            let most = ((of.along(kind, &pushed) + forced).abs() / (w * w)).max(held.abs());
            // At least the displacement, the rate, and what the torque or the rotation bends, each.
            let most = q.abs() + speed + most;
            let swings = most.min((q - held).abs() + speed);
            let mut kept = [[0.0; 4]; 2];
            most.store(&mut kept[0]);
            swings.store(&mut kept[1]);
            for lane in 0..4 {
                if let Some(amplitude) = found.get_mut(first + lane) {
                    *amplitude = Amplitude { most: kept[0][lane], swings: kept[1][lane] };
                }
            }
        }
    }
}
