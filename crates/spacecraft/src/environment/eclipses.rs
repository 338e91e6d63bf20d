//! Eclipses of the Sun by the planet during a run: the instants at which they begin and end, and the part of the Sun's
//! disc in view.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::{Instant, Span};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::shadow::ShadowRegion;
use super::solar_disc::{ASTRONOMICAL_UNIT, Discs, SUN_RADIUS};
use super::sun::Sunlight;
use super::{OrbitPath, SunPath};

/// Distance from the edge of a shadow, relative to the planet's radius, beyond which the part in view needs no angles.
const CLEAR: f64 = 1e-3;

/// Shape of the planet's shadow.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ShadowShape {
    /// Umbra, penumbra and antumbra of a Sun at its distance: the part of its disc in view scales sunlight and
    /// thermal bending.
    #[default]
    Cone,
    /// Cylinder without a penumbra, as of a Sun at an infinite distance: its steps of sunlight excite modes more.
    Cylinder,
}

/// Intervals of a run in the planet's shadow, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Eclipses {
    /// Intervals in the cylinder or the penumbra.
    pub outer: Vec<[Instant; 2]>,
    /// Instants at which the part in view, or its derivative, is not smooth.
    pub edges: Vec<Instant>,
    /// Intervals between edges in which the part in view varies.
    pub partial: Vec<[Instant; 2]>,
}

impl Eclipses {
    /// Finds the eclipses on an orbit that begin before `duration` (s).
    pub fn new(shape: ShadowShape, orbit: &OrbitPath, sun: &SunPath, duration: f64) -> Self {
        let instant = |seconds: f64| Instant::START + Span::from_seconds(seconds);
        let within = |region: ShadowRegion| -> Vec<[Instant; 2]> {
            let passages = orbit.shadows(region, sun, duration);
            passages.into_iter().map(|passage| passage.map(instant)).collect()
        };
        let (outer, core) = match shape {
            ShadowShape::Cylinder => (within(ShadowRegion::Cylinder), Vec::new()),
            ShadowShape::Cone => (within(ShadowRegion::Penumbra), within(ShadowRegion::Core)),
        };
        let mut edges: Vec<Instant> = outer.iter().chain(&core).flatten().copied().collect();
        edges.sort_unstable();
        edges.dedup();
        let mut partial = Vec::new();
        if shape == ShadowShape::Cone {
            let varies = |[from, to]: [Instant; 2]| {
                let part = part_in_view(orbit, sun, 0.5 * (from.seconds() + to.seconds()));
                part > 0.0 && part < 1.0
            };
            partial.extend(edges.windows(2).map(|pair| [pair[0], pair[1]]).filter(|pair| varies(*pair)));
        }
        Self { outer, edges, partial }
    }

    /// Returns true if a time since the start (s) is in the cylinder or the penumbra.
    pub fn is_within(&self, t: f64) -> bool {
        interval_at(&self.outer, t).is_some()
    }

    /// Returns the rate (rad/s) with which the part in view varies at a time since the start (s): 4 pi/T in an interval of
    /// the length T, in which its derivative is about 4/(pi T) at most.
    pub fn rate(&self, t: f64) -> f64 {
        // Times are rounded to nanoseconds.
        let [from, to] = match interval_at(&self.partial, t + 1e-9) {
            Some(interval) => interval.map(Instant::seconds),
            None => return 0.0,
        };
        4.0 * std::f64::consts::PI / (to - from)
    }
}

/// Returns the interval, of those in order, that contains a time since the start (s).
fn interval_at(intervals: &[[Instant; 2]], t: f64) -> Option<[Instant; 2]> {
    let past = intervals.partition_point(|[from, _]| from.seconds() <= t);
    intervals.get(past.checked_sub(1)?).copied().filter(|[_, to]| t < to.seconds())
}

/// Returns the part of the Sun's disc in view at a time since the start (s), from 0 to 1.
pub(super) fn part_in_view(orbit: &OrbitPath, sun: &SunPath, t: f64) -> f64 {
    let [position, _] = orbit.state(t.into());
    part_at(&position, orbit.planet_radius(), &sun.light(t.into()))
}

/// Returns the part of the Sun's disc in view at a position (m) beside a planet of a radius (m), from 0 to 1.
pub(super) fn part_at(position: &Vector, planet: f64, light: &Sunlight) -> f64 {
    // No shadow reaches the Sun's side of the planet by more than 0.11 of its radius.
    let along = position.dot(&light.direction);
    if along > 0.11 * planet {
        return 1.0;
    }
    // Outside of the penumbra's cone all of the Sun is in view, and within the umbra's nothing of it.
    let distance = ASTRONOMICAL_UNIT / f64::sqrt(light.pressure);
    let across = f64::sqrt((position.norm_squared() - along * along).max(0.0));
    let from_cone = |slant: f64| across * f64::sqrt(1.0 - slant * slant) - planet + slant * along;
    if from_cone((SUN_RADIUS + planet) / distance) > CLEAR * planet {
        return 1.0;
    }
    let slant = (planet - SUN_RADIUS) / distance;
    if from_cone(slant) < -CLEAR * planet {
        return 0.0;
    }
    Discs::from_position(position, &(light.direction * distance), planet).part_in_view()
}
