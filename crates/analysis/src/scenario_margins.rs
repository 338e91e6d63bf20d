//! Margins of the loop of a scenario: those of its signals, and in time the delay that all commands tolerate together and the
//! settling after a step.

use std::f64::consts::TAU;
use std::fmt;

use flexsc_formats::document::ConfigError;
use serde::Serialize;

use super::eigenvalues::eigenvalues;
use super::margins::{ROUNDING, StabilityMargins, UnstableLoop, modulus};
use super::open_loop::{LoopBreak, LoopParts, OpenLoop};
use super::settling_time::SettlingTime;
use flexsc_scenario::Scenario;

/// Number of delays that are tried up to the one at which a crossing has lost its phase.
const DELAYS: usize = 24;
/// Largest delay that is tried, relative to that one.
const LONGEST: usize = 8;
/// Number of halvings of the interval of the delay margin.
const HALVINGS: usize = 60;

/// Margins of the loop of a scenario, cut open at a point.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ScenarioMargins {
    /// Margins of the signals.
    #[serde(flatten)]
    pub stability: StabilityMargins,
    /// Loop, cut open.
    #[serde(skip)]
    pub cut: OpenLoop,
    /// Smallest additional delay of all actuators together that makes the loop unstable (s); none if there is none.
    pub common_delay_s: Option<f64>,
    /// Settling times of each angle after a step of the target about each axis; none if they cannot be computed.
    pub settling: Vec<SettlingTime>,
}

/// Reason why a scenario has no margins.
#[derive(Clone, Debug, PartialEq)]
pub enum MarginsFault {
    /// Part of the scenario that has no linear model.
    Key(ConfigError),
    /// Loop that is not stable.
    Unstable(UnstableLoop),
}

impl fmt::Display for MarginsFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Key(fault) => write!(f, "`{}` {}", fault.key, fault.why),
            Self::Unstable(unstable) => write!(f, "{unstable}"),
        }
    }
}

impl std::error::Error for MarginsFault {}

impl ScenarioMargins {
    /// Computes the margins of a scenario's loop, cut open at a point.
    ///
    /// # Errors
    /// A scenario without a linear loop, and a loop that is not stable.
    pub fn from_scenario(scenario: &Scenario, opened: LoopBreak) -> Result<Self, MarginsFault> {
        let parts = LoopParts::from_scenario(scenario, opened).map_err(MarginsFault::Key)?;
        let cut = OpenLoop::from_parts(&parts).map_err(MarginsFault::Key)?;
        let stability = StabilityMargins::new(&cut).map_err(MarginsFault::Unstable)?;
        let parts = parts.opened_at(LoopBreak::Command);
        let common_delay_s = common_delay(&parts, &stability)?;
        let settling = parts.settling_times().unwrap_or_default();
        Ok(Self { stability, cut, common_delay_s, settling })
    }
}

/// Returns the smallest additional delay (s) of all actuators together that makes a loop unstable.
fn common_delay(parts: &LoopParts<'_>, stability: &StabilityMargins) -> Result<Option<f64>, MarginsFault> {
    if let ([only], 1) = (&stability.loops[..], stability.samples) {
        return Ok(only.delay_s);
    }
    // A delay of each loop alone shows where to search for that of all.
    let lag = |frequency: f64, phase: f64| if phase >= 0.0 { phase } else { phase + TAU } / frequency;
    let crossings = stability.loops.iter().flat_map(|own| &own.crossings.gain);
    let delays = crossings.map(|crossing| lag(crossing.frequency_rad_s, crossing.phase_rad));
    let Some(alone) = delays.filter(|delay| *delay > 0.0).min_by(f64::total_cmp) else { return Ok(None) };
    let first = stability.loops.first().map_or("", |own| &own.signal);
    let is_stable = |delay: f64| -> Result<bool, MarginsFault> {
        let mut late = parts.clone();
        late.actuators.delay += delay;
        let opened = OpenLoop::from_parts(&late).map_err(MarginsFault::Key)?;
        let poles = opened.transfer.sensitivity().and_then(|closed| eigenvalues(&closed.a));
        let unknown = || MarginsFault::Unstable(UnstableLoop::with_unknown_poles(first));
        Ok(poles.ok_or_else(unknown)?.iter().all(|pole| modulus(*pole) <= 1.0 + ROUNDING))
    };
    let step = alone / DELAYS as f64;
    let mut low = 0.0;
    for count in 1..=DELAYS * LONGEST {
        let mut high = count as f64 * step;
        if is_stable(high)? {
            low = high;
            continue;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if middle <= low || middle >= high {
                break;
            }
            if is_stable(middle)? {
                low = middle;
            } else {
                high = middle;
            }
        }
        return Ok(Some(low));
    }
    Ok(None)
}
