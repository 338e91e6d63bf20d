//! Undamped modes of one body in the lanes of the processor, bit-identical to the modes one after another.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]
#![allow(clippy::needless_range_loop, reason = "adaptors of iterators lack the processor's instructions")]

use crate::body::Mode;
use crate::lanes::{Four, LaneWork, Real};
use crate::motion::Phase;
use crate::motion::damping::{Damping, Undamped};
use crate::numerics::trig::FARTHEST;

/// Number of modes in a group.
const SIDE: usize = Four::LANES;

/// Undamped modes in groups of lanes, each rotating about its equilibrium.
#[derive(Clone, Debug)]
pub struct Abreast {
    four: Four,
    groups: Vec<Group>,
    /// Highest frequency of the modes (rad/s).
    fastest: f64,
}

/// One group of modes: frequencies (rad/s), and displacements from equilibrium and quadratures (rad) at departure.
#[derive(Clone, Debug, Default)]
struct Group {
    frequency: [f64; SIDE],
    from: [[f64; SIDE]; 2],
}

impl Abreast {
    /// Creates the groups of a body's modes; `None` for fewer than two modes, for damped ones, and without vector
    /// instructions.
    pub fn new(modes: &[Mode]) -> Option<Self> {
        if modes.len() < 2 || modes.iter().any(|mode| mode.damping.get() > 0.0) {
            return None;
        }
        let mut groups = vec![Group::default(); modes.len().div_ceil(SIDE)];
        let mut fastest = 0.0_f64;
        for (index, mode) in modes.iter().enumerate() {
            groups[index / SIDE].frequency[index % SIDE] = mode.frequency.get();
            fastest = fastest.max(mode.frequency.get());
        }
        Some(Self { four: Four::wide()?, groups, fastest })
    }

    /// Sets the phase of a mode about its equilibrium at departure.
    pub fn depart(&mut self, index: usize, from: Phase) {
        let group = &mut self.groups[index / SIDE];
        group.from[0][index % SIDE] = from.displacement;
        group.from[1][index % SIDE] = from.quadrature;
    }

    /// Returns true if the modes rotate little enough within `h` (s) that lanes and scalar code agree to the bit.
    #[inline]
    pub fn reaches(&self, h: f64) -> bool {
        (self.fastest * h).abs() < FARTHEST
    }

    /// Writes the phases of the modes about their equilibria at `h` seconds after departure.
    pub fn turn(&self, h: f64, to: &mut [Phase]) {
        self.four.run(Turn { groups: &self.groups, h, to });
    }
}

struct Turn<'a> {
    groups: &'a [Group],
    h: f64,
    to: &'a mut [Phase],
}

impl LaneWork for Turn<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self, kind: R) {
        let h = kind.of(self.h);
        for index in 0..self.groups.len() {
            let Group { frequency, from: [x, y] } = &self.groups[index];
            let [x, y] = Undamped.go(kind.load(frequency), [kind.load(x), kind.load(y)], h);
            let mut there = [[0.0; SIDE]; 2];
            x.store(&mut there[0]);
            y.store(&mut there[1]);
            let first = SIDE * index;
            for lane in 0..SIDE.min(self.to.len() - first) {
                self.to[first + lane] = Phase { displacement: there[0][lane], quadrature: there[1][lane] };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::mode::ModeFlow;
    use super::*;

    #[test]
    fn modes_side_by_side_are_to_the_bit_where_each_is_alone() {
        let mode = |frequency: f64| -> Mode {
            serde_json::from_str(&format!(r#"{{"frequency":{frequency},"gain":0.01}}"#)).expect("a mode")
        };
        for count in [2, 3, 4, 5, 9] {
            let modes: Vec<Mode> = (0..count).map(|i| mode(0.44 + 0.31 * f64::from(i))).collect();
            let Some(mut abreast) = Abreast::new(&modes) else { return };
            let phase =
                |i: usize| Phase { displacement: 1e-5 - 3e-6 * i as f64, quadrature: 2e-6 * i as f64 };
            (0..modes.len()).for_each(|i| abreast.depart(i, phase(i)));
            let mut there = vec![Phase::default(); modes.len()];
            for h in [0.0, 1e-9, 0.3, 7.1, 412.7, 2e5] {
                assert!(abreast.reaches(h));
                abreast.turn(h, &mut there);
                for (i, mode) in modes.iter().enumerate() {
                    let [xx, xy, yx, yy] = ModeFlow::new(mode).turn(h);
                    let Phase { displacement: x, quadrature: y } = phase(i);
                    let alone = [xx * x + xy * y, yx * x + yy * y];
                    assert_eq!(
                        alone.map(f64::to_bits),
                        [there[i].displacement, there[i].quadrature].map(f64::to_bits)
                    );
                }
            }
            assert!(!abreast.reaches(1e7) && !abreast.reaches(f64::NAN));
        }
    }
}
