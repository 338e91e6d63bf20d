//! Angles that grow with time, reduced to a turn without loss: after a year they are as exact as after a second.

use std::f64::consts::TAU;

use flexsc_numerics::time_arcs::SplitTime;

/// Difference of a turn from the number nearest to it (rad).
const TURN_REST: f64 = 2.449_293_598_294_706_4e-16;

/// Angle that grows at a constant rate.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) struct Phase {
    /// Angle at the start (rad).
    pub start: f64,
    /// Rate (rad/s), and the difference of the exact one from it.
    pub rate: [f64; 2],
}

impl Phase {
    /// Returns the angle (rad) at a time since the start: in the arc's middle within half of a turn of 0.
    pub fn at(&self, t: SplitTime) -> f64 {
        let [rate, more] = self.rate;
        let [grown, lost] = product(rate, t.middle);
        let turns = libm::round((self.start + grown) / TAU);
        let [whole, rest] = product(turns, TAU);
        let left = (lost - rest - turns * TURN_REST) + more * t.middle;
        ((grown - whole) + self.start) + (left + rate * t.offset)
    }
}

/// Returns the product of two numbers, and what its rounding takes away.
pub(super) fn product(a: f64, b: f64) -> [f64; 2] {
    let rounded = a * b;
    [rounded, a.mul_add(b, -rounded)]
}

/// Returns the remainder of the product of two numbers by a period, between minus and plus half of it.
pub(super) fn remainder_of_product(a: f64, b: f64, period: f64) -> f64 {
    let [rounded, lost] = product(a, b);
    // The remainder of a number is exact.
    libm::remainder(rounded, period) + lost
}

#[cfg(test)]
mod tests {
    use super::*;

    /// References with 50 digits (mpmath).
    #[test]
    fn angles_are_as_exact_after_a_year_as_after_a_second() {
        for (rate, t, exact) in [
            (1.1e-3, 1.0, 2.501_1),
            (1.1e-3, 31_536_000.25, 2.634_194_061_505_150_7),
            (7.292_115e-5, 86_400.0, 2.517_202_052_820_413_4),
        ] {
            let phase = Phase { start: 2.5, rate: [rate, 0.0] };
            let found = phase.at(t.into());
            assert!((found - exact).abs() < 1e-15, "{t}: {:e}", found - exact);
            let later = phase.at(SplitTime { middle: t - 64.0, offset: 64.0 });
            assert!(libm::remainder(later - exact, TAU).abs() < 1e-15, "{t}");
        }
        // 8640184812866 times 9920.75, less 27 periods.
        let found = remainder_of_product(8_640_184_812_866.0, 9920.75, 3_155_760e9);
        assert!(found == 511_593_482_240_369.5, "{found}");
    }
}
