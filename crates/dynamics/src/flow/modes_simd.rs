//! Undamped modes of one body in the lanes of the processor, bit-identical to the modes one after another.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]
#![allow(clippy::needless_range_loop, reason = "adaptors of iterators lack the processor's instructions")]

use flexsc_numerics::lanes::{LaneFloat, SimdTask, SimdWidth4};
use flexsc_numerics::trig::FARTHEST;

use crate::ModeState;
use crate::axis_model::AxisMode;
use crate::damping::{DampingRule, Undamped};

/// Number of modes in a group.
const SIDE: usize = SimdWidth4::LANES;

/// Undamped modes in groups of lanes, each rotating about its equilibrium.
#[derive(Clone, Debug)]
pub struct ModesSimd {
    four: SimdWidth4,
    groups: Vec<ModeGroup>,
    /// Highest frequency of the modes (rad/s).
    fastest: f64,
}

/// One group of modes: frequencies (rad/s), and displacements from equilibrium and quadratures (rad) at departure.
#[derive(Clone, Debug, Default)]
struct ModeGroup {
    frequency: [f64; SIDE],
    from: [[f64; SIDE]; 2],
}

impl ModesSimd {
    /// Creates the groups of a body's modes; `None` for fewer than two modes, for damped ones, and without vector
    /// instructions.
    pub fn new(modes: &[AxisMode]) -> Option<Self> {
        if modes.len() < 2 || modes.iter().any(|mode| mode.damping.get() > 0.0) {
            return None;
        }
        let mut groups = vec![ModeGroup::default(); modes.len().div_ceil(SIDE)];
        let mut fastest = 0.0_f64;
        for (index, mode) in modes.iter().enumerate() {
            groups[index / SIDE].frequency[index % SIDE] = mode.frequency.get();
            fastest = fastest.max(mode.frequency.get());
        }
        Some(Self { four: SimdWidth4::vector_only()?, groups, fastest })
    }

    /// Sets the phase of a mode about its equilibrium at departure.
    pub fn set_mode(&mut self, index: usize, from: ModeState) {
        let group = &mut self.groups[index / SIDE];
        group.from[0][index % SIDE] = from.displacement;
        group.from[1][index % SIDE] = from.quadrature;
    }

    /// Returns true if the modes rotate little enough within `h` (s) that lanes and scalar code agree to the bit.
    #[inline]
    pub fn is_valid_for(&self, h: f64) -> bool {
        (self.fastest * h).abs() < FARTHEST
    }

    /// Writes the phases of the modes about their equilibria at `h` seconds after departure.
    pub fn evaluate(&self, h: f64, to: &mut [ModeState]) {
        self.four.run(Rotate { groups: &self.groups, h, to });
    }
}

struct Rotate<'a> {
    groups: &'a [ModeGroup],
    h: f64,
    to: &'a mut [ModeState],
}

impl SimdTask for Rotate<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: LaneFloat>(self, kind: R) {
        let h = kind.splat(self.h);
        for index in 0..self.groups.len() {
            let ModeGroup { frequency, from: [x, y] } = &self.groups[index];
            let [x, y] = Undamped.advance(kind.load(frequency), [kind.load(x), kind.load(y)], h);
            let mut there = [[0.0; SIDE]; 2];
            x.store(&mut there[0]);
            y.store(&mut there[1]);
            let first = SIDE * index;
            for lane in 0..SIDE.min(self.to.len() - first) {
                self.to[first + lane] =
                    ModeState { displacement: there[0][lane], quadrature: there[1][lane] };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::mode::ModeFlow;
    use super::*;
    use flexsc_numerics::quantity::{Finite, Frequency, NonNegative};

    #[test]
    fn modes_side_by_side_are_to_the_bit_where_each_is_alone() {
        let mode = |frequency: f64| {
            let frequency = Frequency::new(frequency).expect("in range");
            AxisMode::at_rest(frequency, Finite::new(0.01).expect("finite"), NonNegative::default())
        };
        for count in [2, 3, 4, 5, 9] {
            let modes: Vec<AxisMode> = (0..count).map(|i| mode(0.44 + 0.31 * f64::from(i))).collect();
            let Some(mut abreast) = ModesSimd::new(&modes) else { return };
            let phase =
                |i: usize| ModeState { displacement: 1e-5 - 3e-6 * i as f64, quadrature: 2e-6 * i as f64 };
            (0..modes.len()).for_each(|i| abreast.set_mode(i, phase(i)));
            let mut there = vec![ModeState::default(); modes.len()];
            for h in [0.0, 1e-9, 0.3, 7.1, 412.7, 2e5] {
                assert!(abreast.is_valid_for(h));
                abreast.evaluate(h, &mut there);
                for (i, mode) in modes.iter().enumerate() {
                    let [xx, xy, yx, yy] = ModeFlow::new(mode).evaluate(h);
                    let ModeState { displacement: x, quadrature: y } = phase(i);
                    let alone = [xx * x + xy * y, yx * x + yy * y];
                    assert_eq!(
                        alone.map(f64::to_bits),
                        [there[i].displacement, there[i].quadrature].map(f64::to_bits)
                    );
                }
            }
            assert!(!abreast.is_valid_for(1e7) && !abreast.is_valid_for(f64::NAN));
        }
    }
}
