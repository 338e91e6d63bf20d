//! Blinding of star trackers by bright bodies: the instants at which the angle of a boresight to a body passes its
//! exclusion angle.
//!
//! The angle changes at most at the rate of the mount plus that of the body's direction. Until the motion can have used up
//! the last known margin, nothing is evaluated. Then the motion up to the next instant of the run is followed on a copy of
//! the plant, in steps that cannot pass over a crossing, and the run stops where the margin changes its sign.

use flexsc_control::sensor::Truth;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::{Instant, Span};
use flexsc_spacecraft::environment::{BrightBody, OrbitEnvironment, to_body};

use super::motion_limits::{MotionLimits, RESERVE, modal_rotation};
use super::plant::Plant;
use flexsc_scenario::Scenario;

/// Shortest step of the search (s): a shorter passage through an exclusion angle may be missed.
const SHORTEST: f64 = 1e-5;

/// A star tracker and a bright body.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct BlindingState {
    /// Index of the star tracker among the sensors.
    pub sensor: usize,
    pub body: BrightBody,
    /// True if the body blinds the star tracker.
    pub is_blinded: bool,
}

/// Exclusion angles of all star trackers of a run.
#[derive(Clone, Debug, Default)]
pub struct Blinding {
    sky: OrbitEnvironment,
    watches: Vec<Watch>,
    limits: MotionLimits,
    /// Next crossing that was found, and the index of its watch.
    next: Option<(Instant, usize)>,
}

/// Angle between a star tracker and a bright body.
#[derive(Copy, Clone, Debug)]
struct Watch {
    state: BlindingState,
    /// Boresight in the axes of the tracker's mount.
    boresight: Vector,
    /// Exclusion angle (rad).
    limit: f64,
    /// Upper bound of the rate of the body's direction (rad/s).
    body_rate: f64,
    /// Norm of the modal rotations at the mount (rad/(m sqrt(kg))).
    modal_rotation: f64,
    /// Lower bound of the distance of the angle from `limit` (rad).
    margin: f64,
}

impl Blinding {
    /// Creates the exclusion angles of a scenario, before its start.
    pub fn new(scenario: &Scenario) -> Self {
        let (Some(model), study) = (scenario.model.three_axis(), &scenario.study) else {
            return Self::default();
        };
        let sky = scenario.orbit_environment();
        let mut watches = Vec::new();
        for (index, boresight, exclusion) in scenario.sensor.exclusions() {
            for (body, limit) in exclusion.limits() {
                watches.push(Watch {
                    state: BlindingState { sensor: index, body, is_blinded: false },
                    boresight,
                    limit,
                    body_rate: sky.angle_rate(body),
                    modal_rotation: study
                        .sensor_points
                        .get(index)
                        .map_or(0.0, |point| modal_rotation(model, point)),
                    margin: 0.0,
                });
            }
        }
        Self { sky, watches, limits: MotionLimits::new(scenario, model), next: None }
    }

    /// Returns true if no star tracker has an exclusion angle.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.watches.is_empty()
    }

    /// Returns true if any body blinds a star tracker.
    pub fn is_blinded(&self, sensor: usize) -> bool {
        self.states().any(|state| state.sensor == sensor && state.is_blinded)
    }

    /// Sets the states at the start, at which the plant is evaluated.
    pub fn begin(&mut self, plant: &Plant) {
        for watch in &mut self.watches {
            watch.state.is_blinded = watch.margin_at(&self.sky, plant, Instant::START) < 0.0;
        }
    }

    /// Iterates over the states of all exclusion angles, in the order of the sensors.
    pub fn states(&self) -> impl Iterator<Item = BlindingState> {
        self.watches.iter().map(|watch| watch.state)
    }

    /// Changes the state that changes at `now`, to which the run has advanced; returns the star tracker.
    #[inline]
    pub fn update(&mut self, now: Instant) -> Option<usize> {
        let (_, index) = self.next.take_if(|(at, _)| *at == now)?;
        let watch = &mut self.watches[index];
        watch.state.is_blinded = !watch.state.is_blinded;
        Some(watch.state.sensor)
    }

    /// Returns the first instant after `now` and up to `until` at which an angle passes its limit while the plant moves on
    /// under the torque of its loads (N m), without that of the environment. The plant is evaluated at `now`.
    pub fn first_crossing(
        &mut self,
        [now, mut until]: [Instant; 2],
        plant: &Plant,
        torque: f64,
    ) -> Option<Instant> {
        self.next = None;
        let h = until.since(now).seconds();
        for index in 0..self.watches.len() {
            let watch = &self.watches[index];
            let rate = self.rate_bound(watch, plant, torque, h) + watch.body_rate;
            let mut margin = watch.margin - rate * h;
            if margin <= 0.0 {
                margin = watch.toward_change(&self.sky, plant, now) - rate * h;
                if margin <= 0.0
                    && let Some(at) = watch.search(&self.sky, now, until, plant, rate)
                {
                    (until, self.next) = (at, Some((at, index)));
                }
            }
            self.watches[index].margin = margin.max(0.0);
        }
        self.next.map(|(at, _)| at)
    }

    /// Returns a bound of the rate (rad/s) at which the mount of a tracker turns within `h` (s) of the plant's state: that
    /// of the body and of its modes, all in phase, and the growth of both under the torques.
    fn rate_bound(&self, watch: &Watch, plant: &Plant, torque: f64, h: f64) -> f64 {
        let rate = Vector::from(plant.truth().rigid_rate).norm();
        let elastic = MotionLimits::elastic_rate(plant, watch.modal_rotation);
        RESERVE * (rate + elastic + self.limits.growth(plant, watch.modal_rotation, torque) * h)
    }
}

impl Watch {
    /// Returns the angle beyond the limit (rad): negative where the body blinds the tracker. The plant is evaluated at `now`.
    fn margin_at(&self, sky: &OrbitEnvironment, plant: &Plant, now: Instant) -> f64 {
        let truth: &Truth = &plant.truth_at_sensor(self.state.sensor);
        let Some(attitude) = truth.orientation.rotated_by(truth.sensor_angles()).attitude() else {
            return f64::INFINITY;
        };
        // Out of the body's axes: the rotation by the conjugate.
        let boresight = to_body(&attitude.conjugate(), &self.boresight);
        sky.angle_to(self.state.body, &boresight, now.seconds()) - self.limit
    }

    /// Returns the angle (rad) by which the state is away from its change: negative beyond it.
    fn toward_change(&self, sky: &OrbitEnvironment, plant: &Plant, now: Instant) -> f64 {
        let margin = self.margin_at(sky, plant, now);
        if self.state.is_blinded { -margin } else { margin }
    }

    /// Returns the first instant after `now`, and at most `until`, at which the angle is beyond its limit; it changes at
    /// most at `rate` (rad/s).
    fn search(
        &self,
        sky: &OrbitEnvironment,
        now: Instant,
        until: Instant,
        plant: &Plant,
        rate: f64,
    ) -> Option<Instant> {
        let mut moving = plant.clone();
        let (mut last, mut margin) = (now, self.toward_change(sky, plant, now));
        loop {
            let step = Span::from_seconds((margin / rate).max(SHORTEST));
            let at = (last + step).min(until);
            margin = self.margin_on_copy(sky, &mut moving, at)?;
            if margin < 0.0 {
                return Some(self.bisect(sky, plant, [last, at]));
            }
            if at == until {
                return None;
            }
            last = at;
        }
    }

    /// Moves a copy of the plant to an instant, and returns the angle by which the state is away from its change there;
    /// `None` where a wheel sticks or lets go before, at which the run stops too.
    fn margin_on_copy(&self, sky: &OrbitEnvironment, plant: &mut Plant, at: Instant) -> Option<f64> {
        let met = plant.advance(at, &mut ()).ok()?;
        if met.is_some_and(|met| met < at) {
            return None;
        }
        plant.evaluate(at).ok()?;
        Some(self.toward_change(sky, plant, at))
    }

    /// Returns the first instant of an interval at which the angle is beyond its limit, as it is at the end.
    fn bisect(&self, sky: &OrbitEnvironment, plant: &Plant, [mut low, mut high]: [Instant; 2]) -> Instant {
        loop {
            let middle = low + Span::from_seconds(0.5 * high.since(low).seconds());
            if middle <= low || middle >= high {
                return high;
            }
            let mut copy = plant.clone();
            match self.margin_on_copy(sky, &mut copy, middle) {
                Some(margin) if margin >= 0.0 => low = middle,
                _ => high = middle,
            }
        }
    }
}
