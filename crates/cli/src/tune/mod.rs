//! `flexsc tune`: keys of any linear law for the largest least modulus margin; or admissible gains of the extra loop of
//! a `pd` law, and a schedule of the best ones.

mod figures;
mod structured;
mod tuned;
mod tuning;

use clap::builder::Resettable;
use clap::{ArgGroup, Id};
use flexsc_core::Scenario;
use flexsc_core::analysis::sampled_loop::{ModelUncertainty, RobustGoal, RobustSearch, optimize};

use crate::error::CliError;
use crate::figure_files::FigureOutput;
use crate::grid::{PositiveGrid, SignedGrid, grid_in};
use crate::quantity::in_unit;
use crate::results::{Results, show};
use crate::sampled_loop::{SettlingArgs, positive, sampled};
use crate::{print, scenario};
use tuned::{TuneMethodResults, TuneResults};
use tuning::TuneSetup;

#[derive(clap::Args)]
#[command(
    group(ArgGroup::new("written").args(["figures", "save"]).multiple(true)),
    mut_arg("force", |force| force.requires(Resettable::<Id>::Reset).requires("written"))
)]
pub struct TuneArgs {
    #[command(flatten)]
    pub scenario: scenario::ScenarioArgs,
    #[command(flatten)]
    structured: structured::StructuredArgs,
    #[command(flatten)]
    single_axis: SingleAxisArgs,
    #[command(flatten, next_help_heading = "Text and figures")]
    drawing: FigureOutput,
}

/// Options of the search for gains of the extra loop of a `pd` law about one axis.
#[derive(clap::Args)]
#[command(next_help_heading = "Extra loop of a pd law about one axis, without --vary")]
#[group(skip)]
struct SingleAxisArgs {
    #[command(flatten)]
    settled: SettlingArgs,
    /// Frequencies of the dominant mode (rad/s) [default: 36, from 1/6 to 4/3 of its own]
    #[arg(long, value_name = "LO:HI:COUNT", value_parser = grid_in("rad/s"))]
    frequency: Option<PositiveGrid>,
    /// Gains to try
    #[arg(long, value_name = "LO:HI:COUNT", default_value = "-2:6:161", allow_hyphen_values = true)]
    gain: SignedGrid,
    /// Longest settling time to accept (s)
    #[arg(long, value_name = "TIME", default_value_t = 200.0, value_parser = in_unit("s"))]
    limit: f64,
    /// Find robust gains instead: those that settle fastest with frequencies, modal gains and the actuator gain off by up to
    /// this fraction, such as 0.1
    #[arg(long, value_name = "PART", value_parser = in_unit(""))]
    robust: Option<f64>,
    /// Additional command delay to allow for (s)
    #[arg(long, value_name = "TIME", default_value_t = 0.0, requires = "robust", value_parser = in_unit("s"))]
    delay: f64,
    /// Margin of every spectral radius below 1
    #[arg(long, value_name = "PART", default_value_t = 0.0, requires = "robust", value_parser = in_unit(""))]
    margin: f64,
    /// Quantile of the perturbed loops to optimise; 1 is the worst case
    #[arg(long, value_name = "PART", default_value_t = 1.0, requires = "robust", value_parser = in_unit(""))]
    quantile: f64,
    /// Minimise the integral of time times absolute error instead of the settling time
    #[arg(long, requires = "robust")]
    itae: bool,
    /// Print the schedule as `[law.pd.extra]` of a scenario
    #[arg(long, conflicts_with = "json")]
    schedule: bool,
}

fn part(name: &str, value: f64) -> Result<(), CliError> {
    let fits = (0.0..1.0).contains(&value);
    if fits {
        Ok(())
    } else {
        Err(CliError::Arguments(format!("{name} must be 0 or more and below 1, got {value}")))
    }
}

impl TuneArgs {
    /// Computes the tuning of a scenario's loop over the given gains.
    pub fn results(&self, scenario: &Scenario) -> Result<TuneResults, CliError> {
        let (sampled_loop, law) = sampled(scenario)?;
        let options = &self.single_axis;
        positive("--limit", options.limit)?;
        let own =
            || PositiveGrid::new(sampled_loop.frequency() / 6.0, sampled_loop.frequency() * 4.0 / 3.0, 36);
        let PositiveGrid(frequencies) = options.frequency.clone().unwrap_or_else(own);
        let tuning = TuneSetup {
            name: scenario.name.clone(),
            own: law.extra.clone(),
            window: options.settled.window(&sampled_loop, &scenario.name)?,
            scaling: options.settled.scaling(),
            gains: options.gain.0,
            limit: options.limit,
            sampled_loop,
            frequencies,
        };
        let closed = tuning.frequencies.len() * tuning.gains.values().len();
        let found = match options.robust {
            None => {
                options.settled.check_cost(&tuning.sampled_loop, closed, tuning.sampled_loop.period, 0.0)?;
                TuneMethodResults::Regions(tuning.regions())
            }
            Some(off) => {
                let search = self.search(&tuning, off)?;
                options.settled.check_cost(
                    &tuning.sampled_loop,
                    closed * search.uncertainty.max_loops(),
                    tuning.sampled_loop.period,
                    options.delay,
                )?;
                TuneMethodResults::Robust {
                    off,
                    rows: optimize(&tuning.sampled_loop, &tuning.frequencies, search),
                }
            }
        };
        Ok(TuneResults { tuning, found, units: self.drawing.choice.units() })
    }

    /// Returns the search for gains that are admissible with a relative model error.
    fn search(&self, tuning: &TuneSetup, off: f64) -> Result<RobustSearch, CliError> {
        let options = &self.single_axis;
        part("--robust", off)?;
        part("--margin", options.margin)?;
        if !(options.quantile > 0.0 && options.quantile <= 1.0) {
            let why = format!("--quantile must be above 0 and at most 1, got {}", options.quantile);
            return Err(CliError::Arguments(why));
        }
        if !(options.delay.is_finite() && options.delay >= 0.0) {
            return Err(CliError::Arguments(format!("--delay must be 0 or more, got {}", options.delay)));
        }
        Ok(RobustSearch {
            gains: tuning.gains,
            scaling: tuning.scaling,
            window: tuning.window,
            uncertainty: ModelUncertainty {
                frequency: off,
                modal_gain: off,
                authority: off,
                delay: options.delay,
            },
            goal: if options.itae { RobustGoal::Itae } else { RobustGoal::Settling },
            quantile: options.quantile,
            margin: options.margin,
        })
    }
}

pub fn run(args: &TuneArgs) -> Result<(), CliError> {
    args.drawing.check(&args.scenario.scenario)?;
    if args.structured.is_asked_for() {
        let scenario = args.scenario.load()?;
        let tuned = args.structured.results(&scenario, args.drawing.choice.units())?;
        args.structured.save(&tuned, &args.scenario, args.drawing.force)?;
        return show(&tuned, Some(&args.drawing), args.scenario.json);
    }
    let tuned = args.results(&args.scenario.load()?)?;
    if args.single_axis.schedule {
        // An error here precedes the figures, so that none is drawn without a schedule.
        let schedule = tuned.extra()?;
        args.drawing.save(|| tuned.figures())?;
        return print(schedule.as_bytes());
    }
    show(&tuned, Some(&args.drawing), args.scenario.json)
}
