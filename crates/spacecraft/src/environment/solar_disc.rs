//! Part of the solar disc that a spherical planet leaves in view.
//!
//! On the unit sphere about the body, the discs of the Sun and of the planet are caps of the angular radii a and b whose
//! centres are the angle c apart. Where their edges cross, these angles are the sides of a triangle with the angle A at
//! the Sun, B at the planet, and the excess E; the hidden area is 2 (A (1 - cos a) + B (1 - cos b) - E), that of the disc
//! 2 pi (1 - cos a). The disc is uniformly bright.

use std::f64::consts::PI;

use flexsc_numerics::attitude::Vector;

/// Radius of the Sun (m).
pub(super) const SUN_RADIUS: f64 = 6.957e8;

/// Astronomical unit (m).
pub(super) const ASTRONOMICAL_UNIT: f64 = 1.495_978_707e11;

/// Discs of the Sun and of the planet, as a body sees them.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) struct Discs {
    /// Angular radius of the Sun (rad).
    pub sun: f64,
    /// Angular radius of the planet (rad).
    pub planet: f64,
    /// Angle between their centres (rad).
    pub apart: f64,
}

impl Discs {
    /// Returns the discs seen from a position, with the Sun at `sun` (both from the planet's centre, m) and a planet of
    /// this radius (m).
    pub fn from_position(position: &Vector, sun: &Vector, planet_radius: f64) -> Self {
        let to_sun = sun - position;
        let angular = |radius: f64, distance: f64| libm::asin((radius / distance).min(1.0));
        Self {
            sun: angular(SUN_RADIUS, to_sun.norm()),
            planet: angular(planet_radius, position.norm()),
            apart: libm::atan2(position.cross(&to_sun).norm(), -position.dot(&to_sun)),
        }
    }

    /// Returns the part of the Sun's disc in view, from 0 to 1.
    pub fn part_in_view(&self) -> f64 {
        let Self { sun: a, planet: b, apart: c } = *self;
        if c >= a + b {
            return 1.0;
        }
        if c <= b - a {
            return 0.0;
        }
        // 1 - cos x without cancellation.
        let cap = |radius: f64| {
            let sin = libm::sin(0.5 * radius);
            2.0 * sin * sin
        };
        if c <= a - b {
            return 1.0 - cap(b) / cap(a);
        }
        let half = 0.5 * (a + b + c);
        let beyond = [half - a, half - b, half - c].map(|side| side.max(0.0));
        let [sin_a, sin_b, sin_c] = beyond.map(libm::sin);
        let sin_half = libm::sin(half);
        let angle = |beside: f64, opposite: f64| 2.0 * libm::atan2(f64::sqrt(beside), f64::sqrt(opposite));
        let at_sun = angle(sin_a * sin_c, sin_half * sin_b);
        let at_planet = angle(sin_b * sin_c, sin_half * sin_a);
        let tangents: f64 = beyond.into_iter().map(|side| libm::tan(0.5 * side)).product();
        let excess = 4.0 * libm::atan(f64::sqrt(libm::tan(0.5 * half) * tangents));
        let hidden = (at_sun * cap(a) + at_planet * cap(b) - excess) / (PI * cap(a));
        (1.0 - hidden).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reference with 30 to 40 digits, of the same area by other formulas.
    #[test]
    fn the_part_in_view_is_that_on_the_sphere() {
        let sun = 0.004_650_484_023_614_98;
        #[rustfmt::skip]
        let rows = [
            (1.187_149_810_902_15, [0.018_709_638_622_57, 0.195_630_939_913_6, 0.500_199_172_454_5, 0.804_627_793_600_5, 0.981_323_352_310_6]),
            (0.151_852_163_665_95, [0.018_965_774_445_67, 0.197_620_013_996_6, 0.503_224_483_536_8, 0.806_569_305_837_3, 0.981_568_568_087_5]),
        ];
        for (planet, expected) in rows {
            for (part, expected) in [-0.9, -0.5, 0.0, 0.5, 0.9].into_iter().zip(expected) {
                let found = Discs { sun, planet, apart: planet + part * sun }.part_in_view();
                assert!((found - expected).abs() < 2e-12, "{planet} {part}: {found} {expected}");
            }
        }
        let annular = Discs { sun: 0.004_652, planet: 0.003, apart: 0.001 }.part_in_view();
        assert!((annular - 0.584_124_290_478_18).abs() < 1e-14, "{annular}");
        for (apart, expected) in [(0.146, 0.0), (0.16, 1.0)] {
            assert_eq!(Discs { sun, planet: 0.151, apart }.part_in_view(), expected);
        }
    }

    #[test]
    fn positions_have_the_part_in_view_of_their_angles() {
        let sun = Vector::new(ASTRONOMICAL_UNIT, 0.0, 0.0);
        for (x, y, z, expected) in [
            (-2_600_000.0, 6_368_000.0, 0.0, 0.033_572_006_244_096),
            (-2_570_000.0, 6_380_000.0, 0.0, 0.593_166_103_498_64),
            (-2_560_000.0, 6_390_000.0, 0.0, 0.998_506_286_831_96),
            (-42_000_000.0, 5_000_000.0, 4_000_000.0, 0.578_595_669_022_47),
        ] {
            let found = Discs::from_position(&Vector::new(x, y, z), &sun, 6_378_137.0).part_in_view();
            // Rounding of the angles, 1e-16 of 1 rad, against a disc of 0.0093 rad.
            assert!((found - expected).abs() < 1e-12, "{x}: {found}");
        }
    }

    /// The area is continuous where the edges begin and cease to cross.
    #[test]
    fn the_part_in_view_has_no_steps() {
        for (sun, planet) in [(0.0047, 1.1), (0.0047, 0.003), (0.0047, 0.0047)] {
            for contact in [sun + planet, f64::abs(planet - sun)] {
                let at = |apart| Discs { sun, planet, apart }.part_in_view();
                let [before, after] = [contact - 1e-9, contact + 1e-9].map(at);
                assert!((after - before).abs() < 2e-7, "{sun} {planet}: {before} {after}");
            }
        }
    }
}
