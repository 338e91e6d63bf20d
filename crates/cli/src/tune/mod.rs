//! `flexsc tune`: the gains of the extra loop that do, and a schedule of the best ones.

mod figures;
mod table;

use flexsc_core::ScenarioError;
use flexsc_core::analysis::sampled_loop::{
    Doubt, Goal, Loop, Region, Robust, Scaling, Search, Window, midpoints, regions, robust,
};
use flexsc_core::law::Pd;
use serde_json::json;

use crate::failure::Failure;
use crate::figure::Drawing;
use crate::grid::{Even, Stepped};
use crate::{print, scenario};

pub use figures::{Tuned, all as figures};

#[derive(clap::Args)]
pub struct Args {
    #[command(flatten)]
    scenario: scenario::Args,
    #[command(flatten)]
    settled: Settled,
    /// Frequencies of the dominant mode (rad/s); left out, 36 from a sixth of its own to four thirds
    #[arg(long, value_name = "LO:HI:N")]
    frequency: Option<Even>,
    /// Gains that are tried
    #[arg(long, value_name = "LO:HI:STEP", default_value = "-2:6:0.05", allow_hyphen_values = true)]
    gain: Stepped,
    /// The longest settling time of the region (s)
    #[arg(long, value_name = "TIME", default_value_t = 200.0)]
    limit: f64,
    /// Instead of the region, the gains that settle soonest with frequencies, modal gains and the actuator's gain off by up
    /// to this part, such as 0.1
    #[arg(long, value_name = "PART")]
    robust: Option<f64>,
    /// By how much more the command may be delayed (s)
    #[arg(long, value_name = "TIME", default_value_t = 0.0, requires = "robust")]
    delay: f64,
    /// By how much every spectral radius shall stay below 1
    #[arg(long, value_name = "PART", default_value_t = 0.0, requires = "robust")]
    margin: f64,
    /// The quantile of the perturbed loops that counts; 1 is the worst
    #[arg(long, value_name = "PART", default_value_t = 1.0, requires = "robust")]
    quantile: f64,
    /// Minimise the integral of time times angle, which is smooth, instead of the settling time
    #[arg(long, requires = "robust")]
    itae: bool,
    /// Print the schedule as `[law.pd.extra]` of a scenario
    #[arg(long, conflicts_with = "json")]
    schedule: bool,
    #[command(flatten)]
    drawing: Drawing,
}

/// What counts as settled, and which modes follow.
#[derive(clap::Args)]
pub struct Settled {
    /// Half width of the band in which the angle has settled (rad); left out, 5 % of the angle at the start
    #[arg(long, value_name = "ANGLE")]
    band: Option<f64>,
    /// How long each loop is watched (s)
    #[arg(long, value_name = "TIME", default_value_t = 2000.0)]
    horizon: f64,
    /// The dominant mode alone changes its frequency, not all by one ratio
    #[arg(long)]
    dominant_alone: bool,
}

impl Settled {
    pub fn scaling(&self) -> Scaling {
        if self.dominant_alone { Scaling::First } else { Scaling::All }
    }

    pub fn window(&self, of: &Loop, name: &str) -> Result<Window, Failure> {
        positive("--horizon", self.horizon)?;
        if let Some(band) = self.band {
            positive("--band", band)?;
        }
        let samples = self.horizon / of.period;
        if samples > 1e7 {
            return Err(Failure::Arguments(format!(
                "--horizon must be at most 1e7 samples, got {samples:e}"
            )));
        }
        Ok(of.window(self.band, self.horizon).map_err(refused(name))?)
    }
}

/// A scenario's loop.
pub fn sampled(scenario: &flexsc_core::Scenario) -> Result<(Loop, &Pd), Failure> {
    Ok(Loop::of(scenario).map_err(refused(&scenario.name))?)
}

fn refused(name: &str) -> impl FnOnce((String, String)) -> ScenarioError + '_ {
    move |(key, why)| ScenarioError::Key { origin: name.to_owned(), key, why }
}

fn positive(name: &str, value: f64) -> Result<(), Failure> {
    let fits = value.is_finite() && value > 0.0;
    if fits {
        Ok(())
    } else {
        Err(Failure::Arguments(format!("{name} must be a positive number, got {value}")))
    }
}

fn part(name: &str, value: f64) -> Result<(), Failure> {
    let fits = (0.0..1.0).contains(&value);
    if fits {
        Ok(())
    } else {
        Err(Failure::Arguments(format!("{name} must be 0 or more and below 1, got {value}")))
    }
}

pub fn run(args: &Args) -> Result<(), Failure> {
    let scenario = args.scenario.load()?;
    let (of, law) = sampled(&scenario)?;
    let (window, scaling) = (args.settled.window(&of, &scenario.name)?, args.settled.scaling());
    positive("--limit", args.limit)?;
    let own = || Even::new(of.frequency() / 6.0, of.frequency() * 4.0 / 3.0, 36);
    let Even(frequencies) = args.frequency.clone().unwrap_or_else(own);
    let Stepped(gains) = args.gain;
    let found = || regions(&of, &frequencies, scaling, gains, window, args.limit);
    let draw = |regions: &[Region], robust: Option<(&[Robust], f64)>| {
        let Some(directory) = &args.drawing.figures else { return Ok(()) };
        let (name, own, limit) = (&scenario.name, law.extra.as_ref(), args.limit);
        figures::save(&Tuned { name, own, gains, limit, regions, robust }, directory, args.drawing.format)
    };
    let Some(off) = args.robust else {
        let found = found();
        draw(&found, None)?;
        let told = || table::tell(&scenario.name, args.limit, gains, &found);
        return out(args, &scenario.name, &midpoints(&found), &json!(found), told);
    };
    part("--robust", off)?;
    part("--margin", args.margin)?;
    if !(args.quantile > 0.0 && args.quantile <= 1.0) {
        let why = format!("--quantile must be above 0 and at most 1, got {}", args.quantile);
        return Err(Failure::Arguments(why));
    }
    if !(args.delay.is_finite() && args.delay >= 0.0) {
        return Err(Failure::Arguments(format!("--delay must be 0 or more, got {}", args.delay)));
    }
    let search = Search {
        gains,
        scaling,
        window,
        doubt: Doubt { frequency: off, modal_gain: off, authority: off, delay: args.delay },
        goal: if args.itae { Goal::Itae } else { Goal::Settling },
        quantile: args.quantile,
        margin: args.margin,
    };
    let gains = robust(&of, &frequencies, search);
    if args.drawing.figures.is_some() {
        draw(&found(), Some((&gains, off)))?;
    }
    let schedule: Vec<_> = gains.iter().filter_map(|r| Some((r.frequency_rad_s, r.gain?))).collect();
    out(args, &scenario.name, &schedule, &json!(gains), || table::tell_robust(&scenario.name, off, &gains))
}

fn out(
    args: &Args,
    name: &str,
    schedule: &[(f64, f64)],
    rows: &serde_json::Value,
    tell: impl FnOnce(),
) -> Result<(), Failure> {
    if args.scenario.json {
        return print(format!("{}\n", json!({"scenario": name, "rows": rows})).as_bytes());
    }
    if args.schedule {
        if schedule.is_empty() {
            return Err(Failure::Arguments(format!("{name}: no gain does at any of these frequencies")));
        }
        let points: Vec<String> = schedule
            .iter()
            .map(|(w, gain)| format!("    {{ frequency = {w:.6}, gain = {gain:.4} }},\n"))
            .collect();
        return print(format!("[law.pd.extra]\nschedule = [\n{}]\n", points.concat()).as_bytes());
    }
    tell();
    Ok(())
}
