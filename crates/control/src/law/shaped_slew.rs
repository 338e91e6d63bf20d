//! The slew to a target that leaves modes at rest: a command planned for them, or a slew with limits through a shaper.

use flexsc_dynamics::axis_model::AxisMode;
use flexsc_dynamics::waveform::Waveform;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::Positive;
use flexsc_spacecraft::manoeuvre::{
    AttitudeMotion, PlannedSlew, RateDecay, RestToRestTask, Slew, SlewProfile, convolve,
};

use super::AttitudeTarget;

impl AttitudeTarget {
    /// Returns true if the slew to the target is planned or shaped for modes.
    pub(super) fn is_shaped(&self) -> bool {
        self.command.is_some() || self.shaper.is_some()
    }

    /// Returns the slew to the target from a motion in its frame, of a body with these modes, and before it the decay of the
    /// rate of that motion, which leaves the same modes at rest; `None` for a motion that is at rest.
    ///
    /// # Errors
    /// A `ConfigError` with the key that does not fit the modes and the reason.
    pub(super) fn slew(
        &self,
        from: &AttitudeMotion,
        modes: &[AxisMode],
    ) -> Result<(Option<PlannedSlew>, PlannedSlew), ConfigError> {
        let acceleration = self.acceleration.map_or(0.0, Positive::get);
        let decay = PlannedSlew::to_rest(from, |rate| {
            self.shape(
                modes,
                |time| RestToRestTask { time, impulse: -rate, travel: -0.5 * rate * time },
                || {
                    let decay = RateDecay::new(from.attitude, &from.rate, acceleration, self.profile);
                    decay.map_or_else(Waveform::default, |decay| decay.command())
                },
            )
        })?;
        let attitudes = [decay.as_ref().map_or(from.attitude, PlannedSlew::to), self.attitude()];
        let turn = PlannedSlew::new(attitudes, |angle| {
            self.shape(
                modes,
                |time| RestToRestTask { time, impulse: 0.0, travel: angle },
                || {
                    let rate_limit = self.rate_limit.map_or(f64::INFINITY, Positive::get);
                    Slew::new(attitudes, acceleration, rate_limit, self.profile).command()
                },
            )
        })?;
        Ok((decay, turn))
    }

    /// Returns the acceleration (rad/s²) of the command for a task in its duration, or else the limited one, through the
    /// shaper.
    fn shape(
        &self,
        modes: &[AxisMode],
        task: impl FnOnce(f64) -> RestToRestTask,
        limited: impl FnOnce() -> Waveform,
    ) -> Result<Waveform, ConfigError> {
        let plan = if let (Some(command), Some(duration)) = (&self.command, self.duration) {
            let planned = command.waveform(&task(duration.get()), &command.zeros(modes)?);
            planned.map_err(|fault| ConfigError::new("duration", fault.why))?.0
        } else {
            limited()
        };
        let Some(shaper) = &self.shaper else { return Ok(plan) };
        Ok(convolve(&plan, &shaper.impulses(modes)?))
    }

    /// Checks the keys of a shaped slew against each other; returns the key and the reason.
    pub(super) fn validate_shape(&self) -> Option<ConfigError> {
        let limits = [
            ("acceleration", self.acceleration.is_some()),
            ("rate_limit", self.rate_limit.is_some()),
            ("profile", self.profile != SlewProfile::default()),
        ];
        match (&self.command, self.duration) {
            (Some(_), None) => Some(ConfigError::new(
                "duration",
                "must be given: it is how long the turn by `command` takes",
            )),
            (None, Some(_)) => Some(ConfigError::new("duration", "needs a `command`, whose duration it is")),
            (Some(_), Some(_)) => limits.iter().find(|(_, is_given)| *is_given).map(|(key, _)| {
                ConfigError::new(
                    *key,
                    "must be left out with a `command`, which is planned for its `duration`",
                )
            }),
            (None, None) => (self.shaper.is_some() && self.acceleration.is_none()).then(|| {
                ConfigError::new(
                    "shaper",
                    "needs the `acceleration` or the `command` of the turn that it shapes",
                )
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexsc_numerics::attitude::Vector;
    use flexsc_numerics::attitude::rotation;
    use flexsc_numerics::quantity::{Finite, Frequency, NonNegative};

    fn modes() -> Vec<AxisMode> {
        let mode = |frequency: f64, damping: f64| {
            let damping = NonNegative::new(damping).expect("a ratio");
            AxisMode::at_rest(Frequency::new(frequency).expect("a frequency"), Finite::default(), damping)
        };
        vec![mode(0.9, 0.005), mode(1.7, 0.01), mode(4.0, 0.0)]
    }

    fn target(keys: &str) -> AttitudeTarget {
        toml::from_str(&format!("from = 0\n{keys}")).unwrap_or_else(|error| panic!("{keys}: {error}"))
    }

    /// Returns the residual of a mode after a slew, relative to that of a pulse with the largest acceleration, by
    /// Simpson's rule over the poses of the slew, independent of waveforms.
    fn residual_amplitude(turn: &PlannedSlew, mode: &AxisMode, axis: Vector) -> f64 {
        let (w, zeta) = (mode.frequency.get(), mode.damping.get());
        let damped = w * f64::sqrt(1.0 - zeta * zeta);
        let end = turn.duration();
        let (mut cosine, mut sine, mut most) = (0.0, 0.0, 0.0_f64);
        let count = 50_000;
        let h = end / f64::from(count);
        // Rates are continuous and end at 0, so the integral of the acceleration is taken by parts.
        let first = turn.at(0.0).rate.dot(&axis) * libm::exp(-zeta * w * end);
        for k in 0..=count {
            let t = h * f64::from(k);
            let weight = if k == 0 || k == count {
                1.0
            } else if k % 2 == 1 {
                4.0
            } else {
                2.0
            };
            let pose = turn.at(t.min(end * (1.0 - 1e-15)));
            let rate = pose.rate.dot(&axis);
            let grown = weight * h / 3.0 * libm::exp(zeta * w * (t - end)) * rate;
            cosine += grown * libm::cos(damped * t);
            sine += grown * libm::sin(damped * t);
            most = most.max(rate.abs());
        }
        let real = first + zeta * w * cosine - damped * sine;
        libm::hypot(real, zeta * w * sine + damped * cosine) / most
    }

    #[test]
    fn chosen_modes_rest_after_the_turn() {
        let axis = Vector::new(1.0, 2.0, 2.0) / 3.0;
        let (from, to) = (rotation(&(axis * -0.8)), AttitudeTarget::INERTIAL.attitude());
        // Tolerances of Simpson's rule for rates with kinks.
        let cases = [
            ("acceleration = 2e-3\nrate_limit = 0.02\nshaper = { zv = { modes = [0] } }", vec![0], 1e-7),
            (
                "acceleration = 2e-3\nrate_limit = 0.02\nprofile = \"versine\"\nshaper = { zvd = { modes = [0, 1] } }",
                vec![0, 1],
                1e-9,
            ),
            ("duration = 60\ncommand = { minimum_peak = { suppress = 2 } }", vec![0, 1], 1e-6),
            ("duration = 60\ncommand = { cosine = { suppress = 3 } }", vec![0, 1, 2], 1e-8),
            (
                "duration = 60\ncommand = { minimum_energy = { suppress = 1 } }\nshaper = { zv = { modes = [2] } }",
                vec![0, 2],
                1e-7,
            ),
        ];
        for (keys, rest, bound) in cases {
            let slew = |from: &AttitudeMotion| {
                target(keys).slew(from, &modes()).unwrap_or_else(|fault| panic!("{keys}: {fault}"))
            };
            let (none, turn) = slew(&AttitudeMotion::at_rest(from));
            assert_eq!(none, None);
            // From a rate, its decay leaves the same modes at rest.
            let rate = Vector::new(-2e-3, 1e-3, 2e-3);
            let (decay, after) = slew(&AttitudeMotion { rate, ..AttitudeMotion::at_rest(from) });
            let decay = decay.expect("a decay");
            assert!(
                (decay.at(0.0).rate - rate).norm() < 1e-18 && (decay.at(0.0).attitude - from).norm() == 0.0
            );
            let end = decay.at(decay.duration() * (1.0 - 1e-12));
            assert!(end.rate.norm() < 1e-13 && (end.attitude - decay.to()).norm() < 1e-13, "{keys}");
            assert!((after.at(0.0).attitude - decay.to()).norm() < 1e-15 && (after.to() - to).norm() < 1e-15);
            for mode in rest {
                let residual = residual_amplitude(&turn, &modes()[mode], axis);
                assert!(residual < bound, "{keys}: mode {mode} keeps {residual:e}");
                let residual = residual_amplitude(&decay, &modes()[mode], rate.normalize());
                assert!(residual < 10.0 * bound, "{keys}: mode {mode} keeps {residual:e} of the decay");
            }
            // The slew ends at its target, at rest, and has a single axis.
            let near_end = turn.at(turn.duration() * (1.0 - 1e-12));
            assert!((near_end.attitude - to).norm() < 1e-12 && near_end.rate.norm() < 1e-11, "{keys}");
            assert!((turn.at(0.4 * turn.duration()).rate.cross(&axis)).norm() < 1e-15);
            assert!(turn.fastest() < 0.05);
        }
        let plain = target("acceleration = 2e-3\nrate_limit = 0.02");
        let (_, plain) = plain.slew(&AttitudeMotion::at_rest(from), &modes()).expect("a turn");
        assert!(residual_amplitude(&plain, &modes()[0], axis) > 1e-2);
        // Without a shaper it is the closed-form slew.
        let slew = Slew::new([from, to], 2e-3, 0.02, SlewProfile::Trapezoid);
        for k in 0..60 {
            let (a, b) = (plain.at(f64::from(k)), slew.at(f64::from(k)));
            assert!((a.attitude - b.attitude).norm() < 1e-14 && (a.rate - b.rate).norm() < 1e-15);
        }
    }

    #[test]
    fn keys_that_do_not_fit_are_refused() {
        let from = AttitudeMotion::at_rest(rotation(&Vector::new(0.0, 0.0, 0.5)));
        let fault = |keys: &str| {
            let target = target(keys);
            let found = target.validate_shape().or_else(|| target.slew(&from, &modes()).err());
            found.unwrap_or_else(|| panic!("{keys}")).to_string()
        };
        let cases = [
            ("duration = 10", "`duration` needs a `command`"),
            ("command = { bang_bang = {} }", "`duration` must be given"),
            (
                "duration = 10\nacceleration = 1\ncommand = { bang_bang = {} }",
                "`acceleration` must be left out with a `command`",
            ),
            ("shaper = { zv = {} }", "`shaper` needs the `acceleration`"),
            ("acceleration = 1\nshaper = { zv = { modes = [3] } }", "`shaper.zv.modes[0]`"),
            ("duration = 10\ncommand = { cosine = { suppress = 4 } }", "`command.cosine.suppress`"),
            ("duration = 1\ncommand = { minimum_peak = { suppress = 3 } }", "`"),
        ];
        for (keys, why) in cases {
            let found = fault(keys);
            assert!(found.starts_with(why), "{keys}: {found}");
        }
    }
}
