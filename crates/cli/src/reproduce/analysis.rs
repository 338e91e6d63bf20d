//! The analyses behind commands of a page: what `plan`, `tune`, `map` and `damping` work on.

use flexsc_core::Scenario;
use flexsc_core::analysis::damping::{Convergence, Relay, Study};
use flexsc_core::analysis::sampled_loop::{
    Cell, Doubt, Gains, Goal, Loop, Region, Robust, Scaling, Search, Window, map, regions, robust,
};
use flexsc_core::law::Pd;
use flexsc_core::manoeuvre::{Manoeuvre, Plan};
use flexsc_core::quantity::Positive;

use super::command::Command;
use crate::failure::Failure;
use crate::grid::{Even, Stepped};
use crate::tune;

/// What `flexsc tune` finds.
pub struct Tuned {
    pub gains: Gains,
    pub limit: f64,
    pub regions: Vec<Region>,
    pub robust: Option<Vec<Robust>>,
}

impl Command {
    /// The manoeuvre of a scenario, and its plan.
    pub fn planned<'a>(&self, scenario: &'a Scenario) -> Result<(&'a Manoeuvre, Plan), Failure> {
        let (Some(manoeuvre), Some(plan)) = (&scenario.manoeuvre, &scenario.plan) else {
            return Err(self.failure("no manoeuvre"));
        };
        let plan = match self.peak()? {
            None => plan.clone(),
            peak => Manoeuvre { time: None, peak_torque: peak, ..manoeuvre.clone() }
                .plan(scenario.planned_for())
                .map_err(|(key, why)| self.failure(&format!("{key} {why}")))?,
        };
        Ok((manoeuvre, plan))
    }

    /// The peak torque that is asked for.
    pub fn peak(&self) -> Result<Option<Positive>, Failure> {
        let peak = self.one::<f64>("peak_torque");
        peak.map(|peak| Positive::new(peak).ok_or_else(|| self.failure("--peak-torque"))).transpose()
    }

    /// The gains of the extra loop.
    pub fn tuned(&self, scenario: &Scenario) -> Result<Tuned, Failure> {
        let (of, _) = tune::sampled(scenario)?;
        let window = self.window(&of, scenario)?;
        let own = Even::new(of.frequency() / 6.0, of.frequency() * 4.0 / 3.0, 36);
        let Even(frequencies) = self.one("frequency").unwrap_or(own);
        let Stepped(gains) = self.one("gain").ok_or_else(|| self.failure("--gain"))?;
        let limit = self.one("limit").unwrap_or(200.0);
        let found = regions(&of, &frequencies, self.scaling(), gains, window, limit);
        let robust = self.one::<f64>("robust").map(|off| {
            let search = Search {
                gains,
                scaling: self.scaling(),
                window,
                doubt: Doubt {
                    frequency: off,
                    modal_gain: off,
                    authority: off,
                    delay: self.one("delay").unwrap_or(0.0),
                },
                goal: Goal::Settling,
                quantile: self.one("quantile").unwrap_or(1.0),
                margin: self.one("margin").unwrap_or(0.0),
            };
            robust(&of, &frequencies, search)
        });
        Ok(Tuned { gains, limit, regions: found, robust })
    }

    /// The cells of a map.
    pub fn cells(&self, scenario: &Scenario) -> Result<Vec<Cell>, Failure> {
        let (of, law): (Loop, &Pd) = tune::sampled(scenario)?;
        let window = self.window(&of, scenario)?;
        let missing = || self.failure("--frequency and --period");
        let Even(frequencies) = self.one("frequency").ok_or_else(missing)?;
        let Even(periods) = self.one("period").ok_or_else(missing)?;
        let gain = |frequency: f64| self.one("gain").unwrap_or_else(|| law.extra_gain(frequency));
        Ok(map(&of, &frequencies, &periods, self.scaling(), gain, window))
    }

    fn scaling(&self) -> Scaling {
        if self.is_given("dominant_alone") { Scaling::First } else { Scaling::All }
    }

    fn window(&self, of: &Loop, scenario: &Scenario) -> Result<Window, Failure> {
        let window = of.window(self.one("band"), self.one("horizon").unwrap_or(2000.0));
        window.map_err(|(key, why)| self.failure(&format!("{}: {key} {why}", scenario.name)))
    }

    /// The relay of thrusters, and the frequencies of modes (rad/s).
    pub fn relay(&self) -> Result<(Study, Vec<f64>), Failure> {
        let number = |name: &str| self.one::<f64>(name).unwrap_or(0.0);
        let period = number("period");
        let on_time = self.one("on_time").unwrap_or(period);
        let study = Study {
            relay: Relay { period, delay: number("delay"), on_time },
            damping: number("damping"),
            acceleration: number("acceleration"),
            amplitude: number("amplitude"),
            threshold: number("threshold"),
        };
        if let Some((name, why)) = study.inconsistency() {
            return Err(self.failure(&format!("--{name} {why}")));
        }
        let Even(frequencies) = self.one("frequency").ok_or_else(|| self.failure("--frequency"))?;
        Ok((study, frequencies))
    }

    /// The recurrence observer, and the gains of its regions.
    pub fn observer(&self) -> Result<(Convergence, Vec<f64>), Failure> {
        let wrong = || self.failure("an observer has --frequency and the --weights W1,W2,W3");
        let weights = <[f64; 3]>::try_from(self.many("weights")).map_err(|_| wrong())?;
        let [frequency, damping, period] =
            ["frequency", "damping", "period"].map(|name| self.one(name).unwrap_or(f64::NAN));
        let of = Convergence { frequency, damping, period, weights };
        if of.inconsistency().is_some() { Err(wrong()) } else { Ok((of, self.many("kappa"))) }
    }
}
