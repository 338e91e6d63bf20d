//! Sums over the modes computed from their states alone, without node values.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::lanes::{LaneFloat, SimdTask};

use super::model::BodyConstants;

/// SIMD task that sums the modes' contributions from their states.
pub(super) struct SumModes<'a> {
    pub model: &'a BodyConstants,
    /// q and P/W of each mode.
    pub states: &'a [[f64; 4]],
}

/// Modal sums: sum phi q (rad), sum phi P (rad/s), and the change of the inertia as xx, yy, zz, yz, zx and xy (kg
/// m²).
pub(super) struct ModalSumsResult {
    pub bent: Vector,
    pub elastic: Vector,
    pub changed: [f64; 6],
}

impl SimdTask for SumModes<'_> {
    type Output = ModalSumsResult;

    #[inline(always)]
    fn run<R: LaneFloat>(self, kind: R) -> ModalSumsResult {
        let Self { model, states } = self;
        let zero = kind.splat(0.0);
        let (mut bent, mut elastic, mut changed) = (zero, zero, [zero; 2]);
        let count = model.filled.len().min(states.len());
        let (filled, states) = (&model.filled[..count], &states[..count]);
        for index in 0..count {
            let (of, [q, p, ..]) = (&filled[index], states[index]);
            let (rotation, [first, second]) = (kind.load(&of.rotation), &of.moments);
            bent = bent + rotation * q;
            elastic = elastic + rotation * (of.frequency * p);
            changed = [changed[0] + kind.load(first) * q, changed[1] + kind.load(second) * q];
        }
        let mut kept = [[0.0; 4]; 4];
        bent.store(&mut kept[0]);
        elastic.store(&mut kept[1]);
        changed[0].store(&mut kept[2]);
        changed[1].store(&mut kept[3]);
        let [bent, elastic, first, second] = kept;
        ModalSumsResult {
            bent: Vector::new(bent[0], bent[1], bent[2]),
            elastic: Vector::new(elastic[0], elastic[1], elastic[2]),
            changed: [first[0], first[1], first[2], first[3], second[0], second[1]],
        }
    }
}
