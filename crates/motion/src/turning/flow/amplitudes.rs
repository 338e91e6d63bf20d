//! The amplitudes of the modes at the start of a step, four modes side by side.

use crate::attitude::Vector;
use crate::lanes::{LaneWork, Real};
use crate::turning::model::{Abreast, Model};
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
            let Abreast { frequency, moments: [xx, yy, zz, yz, zx, xy], .. } = of;
            let w = kind.load(frequency);
            let [a, b, c, d, e, f] = spun;
            let moved = (kind.load(xx) * a + kind.load(yy) * b + kind.load(zz) * c)
                + (kind.load(yz) * d + kind.load(zx) * e + kind.load(xy) * f);
            let held = (along(kind, of, &net) + moved + forced) / (w * w);
            let speed = (p + along(kind, of, &turning) / w).abs();
            let most = ((along(kind, of, &pushed) + forced).abs() / (w * w)).max(held.abs());
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

/// The products of the modes' rotations with a vector.
#[inline(always)]
fn along<R: Real>(kind: R, of: &Abreast, v: &Vector) -> R {
    let [x, y, z] = &of.rotation;
    kind.load(x) * v.x + kind.load(y) * v.y + kind.load(z) * v.z
}
