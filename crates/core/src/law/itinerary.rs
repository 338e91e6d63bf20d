//! The way from target to target: at once, or along a turn with limits.

use nalgebra::Quaternion;

use super::Target;
use crate::document::Fault;
use crate::manoeuvre::{Pose, Profile, Slew};
use crate::quantity::Positive;
use crate::time::Instant;

/// The turns to targets, in the order of their times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Itinerary(Vec<(Instant, Slew)>);

impl Itinerary {
    /// The way to these targets. Before the first the attitude is the inertial one; a turn begins where the one before ended.
    pub fn new(targets: &[Target]) -> Self {
        let mut before = Target::INERTIAL.attitude();
        let turn = |target: &Target| {
            let to = target.attitude();
            let rate_limit = target.rate_limit.map_or(f64::INFINITY, Positive::get);
            let slew = target.acceleration.map_or_else(
                || Slew::at_once(to),
                |acceleration| Slew::new([before, to], acceleration.get(), rate_limit, target.profile),
            );
            before = to;
            (target.begins(), slew)
        };
        Self(targets.iter().map(turn).collect())
    }

    /// Where the body shall be at an instant, and how it shall turn there.
    pub fn at(&self, now: Instant) -> Pose {
        let turn = self.0.iter().rev().find(|(begins, _)| *begins <= now);
        turn.map_or_else(
            || Pose::at_rest(Target::INERTIAL.attitude()),
            |(begins, slew)| slew.at(now.since(*begins).seconds()),
        )
    }

    /// The target that the body is on its way to at an instant.
    pub fn target(&self, now: Instant) -> Quaternion<f64> {
        let turn = self.0.iter().rev().find(|(begins, _)| *begins <= now);
        turn.map_or_else(|| Target::INERTIAL.attitude(), |(_, slew)| slew.to())
    }

    /// When the next target begins after an instant.
    pub fn next(&self, now: Instant) -> Option<Instant> {
        self.0.iter().map(|(begins, _)| *begins).find(|begins| *begins > now)
    }

    /// Whether the reference moves at an instant.
    pub fn moves(&self, now: Instant) -> bool {
        let turn = self.0.iter().rev().find(|(begins, _)| *begins <= now);
        turn.is_some_and(|(begins, slew)| now.since(*begins).seconds() < slew.duration())
    }

    /// The first target that begins before the turn to the one before has ended, or whose limits do not fit: its key, and why.
    pub fn fault(targets: &[Target]) -> Option<Fault> {
        let at = |index: usize, key: &str, why: String| Some(Fault::new(format!("[{index}].{key}"), why));
        for (index, target) in targets.iter().enumerate() {
            if target.rate_limit.is_some() && target.acceleration.is_none() {
                return at(
                    index,
                    "rate_limit",
                    "needs the `acceleration` at which the rate rises".to_owned(),
                );
            }
            if target.profile != Profile::default() && target.acceleration.is_none() {
                return at(index, "profile", "needs the `acceleration` that it shapes".to_owned());
            }
        }
        let way = Self::new(targets);
        for (index, pair) in way.0.windows(2).enumerate() {
            let ends = pair[0].0.seconds() + pair[0].1.duration();
            if pair[1].0.seconds() < ends {
                let why = format!(
                    "must not be before the turn to the one before has ended, {ends:.3} s, got {}",
                    pair[1].0.seconds()
                );
                return at(index + 1, "from", why);
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::Span;

    fn targets(text: &str) -> Vec<Target> {
        #[derive(serde::Deserialize)]
        struct Of {
            target: Vec<Target>,
        }
        toml::from_str::<Of>(text).unwrap().target
    }

    fn at(seconds: f64) -> Instant {
        Instant::START + Span::from_seconds(seconds)
    }

    #[test]
    fn a_target_is_reached_at_once_or_along_a_turn() {
        let two = targets(
            "target = [{ from = 10.0, yaw = 0.5 }, { from = 20.0, yaw = 0.9, acceleration = 2e-3, rate_limit = 0.02 }]",
        );
        assert_eq!(Itinerary::fault(&two), None);
        let way = Itinerary::new(&two);
        let yaw = |seconds: f64| crate::attitude::angles(&way.at(at(seconds)).attitude)[2];
        // 0.02 rad/s after 10 s; 0.4 rad take 30 s.
        for (seconds, exact) in
            [(9.0, 0.0), (10.0, 0.5), (20.0, 0.5), (30.0, 0.6), (35.0, 0.7), (50.0, 0.9), (90.0, 0.9)]
        {
            assert!((yaw(seconds) - exact).abs() < 1e-15, "{seconds} {}", yaw(seconds));
        }
        assert!((way.at(at(25.0)).rate.z - 0.01).abs() < 1e-15);
        assert!((way.at(at(45.0)).acceleration.z + 2e-3).abs() < 1e-15);
        let moving = [9.0, 10.0, 15.0, 20.0, 49.0, 51.0].map(|seconds| way.moves(at(seconds)));
        assert_eq!(moving, [false, false, false, true, true, false]);
    }

    #[test]
    fn targets_that_do_not_fit_are_refused() {
        let fault = |text: &str| Itinerary::fault(&targets(text)).unwrap().to_string();
        let soon = fault(
            "target = [{ from = 0, yaw = 0.4, acceleration = 2e-3, rate_limit = 0.02 }, { from = 29.0 }]",
        );
        assert!(
            soon.starts_with("`[1].from` must not be before the turn to the one before has ended, 30.000 s"),
            "{soon}"
        );
        assert!(
            fault("target = [{ from = 0, yaw = 0.4, rate_limit = 0.02 }]")
                .starts_with("`[0].rate_limit` needs")
        );
        assert!(fault("target = [{ from = 0, profile = \"versine\" }]").starts_with("`[0].profile` needs"));
    }
}
