//! `flexsc margins`: stability margins of the loop of a scenario.

mod figures;

use std::f64::consts::{PI, TAU};
use std::io::Write;

use clap::ValueEnum;
use flexsc_core::analysis::margins::{DiskMargin, PeakMargin, SignalMargins, StabilityMargins};
use flexsc_core::analysis::open_loop::LoopBreak;
use flexsc_core::analysis::scenario_margins::{MarginsFault, ScenarioMargins};
use flexsc_core::analysis::settling_time::SETTLING_BAND;
use flexsc_core::formats::count::counted;
use flexsc_core::formats::document::ConfigError;
use flexsc_core::worst_case::{MarginKind, MarginSearch, WorstCase, uncertain_box};
use flexsc_core::{Scenario, ScenarioError};
use flexsc_figure::Named;
use serde_json::{Value as Json, json};

use crate::error::CliError;
use crate::figure_files::FigureOutput;
use crate::human::{Units, UnitsArgs, columns, digits};
use crate::number::number_or_none;
use crate::results::{Results, show, with_scenario_name};
use crate::stop::stop_requested;
use crate::{say, scenario};

/// Number of loops of each search for the least margin.
const WORST_POINTS: usize = 100;

#[derive(clap::Args)]
pub struct MarginsArgs {
    #[command(flatten)]
    pub scenario: scenario::ScenarioArgs,
    /// Point at which each loop is cut open
    #[arg(long = "loop", value_name = "POINT", default_value = "command")]
    opened: BreakPoint,
    /// Search for the least of each margin over the uncertain keys too, as `flexsc worst --margin` does
    #[arg(long)]
    worst: bool,
    #[command(flatten)]
    units: UnitsArgs,
    #[command(flatten)]
    pub drawing: FigureOutput,
}

/// Point at which a loop is cut open.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum BreakPoint {
    /// Commands of the law
    #[default]
    Command,
    /// Torques of the actuator
    Torque,
    /// Measured angles and rates
    Measurement,
}

impl BreakPoint {
    pub fn loop_break(self) -> LoopBreak {
        match self {
            Self::Command => LoopBreak::Command,
            Self::Torque => LoopBreak::Torque,
            Self::Measurement => LoopBreak::Measurement,
        }
    }
}

/// Margins of the loop of a scenario.
pub struct LoopMargins {
    /// Name of the scenario.
    name: String,
    margins: ScenarioMargins,
    /// Least margins over the uncertain keys.
    worst: Vec<(MarginKind, WorstCase)>,
    units: Units,
}

/// Computes the margins of the loop of a scenario.
pub fn results(scenario: &Scenario, args: &MarginsArgs) -> Result<LoopMargins, CliError> {
    let name = scenario.name.clone();
    let key = |fault: ConfigError| {
        CliError::from(ScenarioError::Key { origin: name.clone(), key: fault.key, why: fault.why })
    };
    if args.worst {
        uncertain_box(scenario).map_err(key)?;
    }
    let margins =
        ScenarioMargins::from_scenario(scenario, args.opened.loop_break()).map_err(|fault| match fault {
            MarginsFault::Key(fault) => key(fault),
            MarginsFault::Unstable(unstable) => CliError::Arguments(format!("{name}: {unstable}")),
        })?;
    let kinds = MarginKind::ALL.into_iter().filter(|_| args.worst);
    let least = |kind: MarginKind| {
        let search = MarginSearch { kind, opened: args.opened.loop_break(), most_loops: WORST_POINTS };
        let found = search.run(scenario, stop_requested).map_err(|fault| CliError::worst_case(&name, fault));
        found.map(|case| (kind, case))
    };
    let worst = kinds.map(least).collect::<Result<_, CliError>>()?;
    Ok(LoopMargins { name, margins, worst, units: args.units.units })
}

pub fn run(args: &MarginsArgs) -> Result<(), CliError> {
    args.drawing.check(&args.scenario.scenario)?;
    show(&results(&args.scenario.load()?, args)?, Some(&args.drawing), args.scenario.json)
}

/// Prints rows of text in columns.
pub fn print_table(rows: &[Vec<String>]) {
    for line in columns(rows, 0) {
        say!("  {line}");
    }
}

pub fn texts(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

impl LoopMargins {
    /// Returns the unit of factors on a gain, and a factor in that unit.
    fn gain(&self, factor: Option<f64>) -> String {
        let text = |factor: f64| match self.units {
            Units::Engineering => digits(20.0 * factor.log10()),
            Units::Si => digits(factor),
        };
        number_or_none(factor.filter(|factor| *factor > 0.0), text)
    }

    fn gain_unit(&self) -> &'static str {
        match self.units {
            Units::Engineering => "dB",
            Units::Si => "",
        }
    }

    /// Returns the factor from rad, and the unit, of phases.
    fn phase(&self) -> (f64, &'static str) {
        match self.units {
            Units::Engineering => (360.0 / TAU, "deg"),
            Units::Si => (1.0, "rad"),
        }
    }

    /// Returns a phase; none if it is half a turn, which is no limit.
    fn phase_text(&self, phase: f64) -> String {
        number_or_none((phase.abs() < PI).then_some(phase), |phase| digits(phase * self.phase().0))
    }

    /// Returns a delay; nothing for several samples in a period, where a delay is more than a phase.
    fn delay(&self, delay: Option<f64>) -> String {
        if self.margins.stability.samples > 1 { String::new() } else { number_or_none(delay, digits) }
    }

    /// Returns the cells of the modulus margin and the disk margin, with their frequencies.
    fn peaks(&self, modulus: &PeakMargin, disk: &DiskMargin) -> Vec<String> {
        let (factor, _) = self.units.frequency();
        vec![
            digits(modulus.margin),
            digits(modulus.frequency_rad_s * factor),
            digits(disk.alpha),
            digits(disk.frequency_rad_s * factor),
            format!("{} to {}", self.gain(Some(disk.gains[0])), self.gain(Some(disk.gains[1]))),
            digits(disk.phase_rad * self.phase().0),
        ]
    }

    /// Prints the smallest margins of each loop, and of all together.
    fn print_margins(&self) {
        let (frequency, gain, phase) = (self.units.frequency().1, self.gain_unit(), self.phase().1);
        let mut rows = vec![
            texts(&[
                "loop", "gain", "gain", "phase", "delay", "modulus", "at", "disk", "at", "gain", "phase",
            ]),
            texts(&["", "down", "up", "", "", "", "", "", "", "in the disk", "in the disk"]),
            texts(&["", gain, gain, phase, "s", "", frequency, "", frequency, gain, phase]),
        ];
        for one in &self.margins.stability.loops {
            let mut row = vec![
                one.signal.clone(),
                self.gain(Some(one.gain_below)),
                self.gain(one.gain_above),
                self.phase_text(one.phase_rad),
                self.delay(one.delay_s),
            ];
            row.extend(self.peaks(&one.modulus, &one.disk));
            rows.push(row);
        }
        if self.margins.stability.loops.len() > 1 {
            let mut row = texts(&["all together", "", "", "", ""]);
            row.extend(self.peaks(&self.margins.stability.modulus, &self.margins.stability.disk));
            rows.push(row);
        }
        if let Some(disk) = &self.margins.stability.independent_disk {
            let mut row = texts(&["all, independent", "", "", "", "", "", ""]);
            row.extend(self.peaks(&self.margins.stability.modulus, disk).into_iter().skip(2));
            rows.push(row);
        }
        print_table(&rows);
        if rows.len() > 4 || self.margins.stability.samples > 1 {
            let delay = number_or_none(self.margins.common_delay_s, |delay| format!("{} s", digits(delay)));
            say!("  delay that all actuators together may add: {delay}");
        }
        if !self.margins.settling.is_empty() {
            say!(
                "  settling within {} % after a step of the target: {}",
                100.0 * SETTLING_BAND,
                self.settling()
            );
        }
    }

    /// Returns the settling time after a step about each axis: the longest of all angles.
    fn settling(&self) -> String {
        let mut axes: Vec<&str> = self.margins.settling.iter().map(|own| own.step).collect();
        axes.dedup();
        let longest = |axis: &str| {
            let own = self.margins.settling.iter().filter(|own| own.step == axis);
            own.map(|own| own.time_s).fold(0.0, f64::max)
        };
        let each = axes.into_iter().map(|axis| {
            let time = Some(longest(axis)).filter(|time| time.is_finite());
            format!("{axis} {}", number_or_none(time, |time| format!("{} s", digits(time))))
        });
        each.collect::<Vec<_>>().join(", ")
    }

    /// Prints the crossings of all loops, by frequency.
    fn print_crossings(&self) {
        let (factor, unit) = self.units.frequency();
        let mut rows = vec![
            texts(&["loop", "crossing", "frequency", "phase", "delay", "gain"]),
            texts(&["", "", unit, self.phase().1, "s", self.gain_unit()]),
        ];
        for one in &self.margins.stability.loops {
            let mut crossings = self.crossings(one);
            crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
            for (frequency, mut cells) in crossings {
                cells.insert(1, digits(frequency * factor));
                cells.insert(0, one.signal.clone());
                rows.push(cells);
            }
        }
        say!("  crossings, with the phase and the delay, or the gain, that the loop tolerates there");
        print_table(&rows);
    }

    /// Prints the least margins over the uncertain keys, with the keys where they are attained.
    fn print_worst(&self) {
        let mut rows = vec![texts(&["margin", "nominal", "worst", "keys"])];
        for (kind, case) in &self.worst {
            let text = |value: f64| match kind {
                MarginKind::Gain => self.gain(Some(value).filter(|value| value.is_finite())),
                MarginKind::Phase => number_or_none(Some(value).filter(|value| value.is_finite()), |phase| {
                    digits(phase * self.phase().0)
                }),
                _ => number_or_none(Some(value).filter(|value| value.is_finite()), digits),
            };
            let worst = if case.is_unstable { "unstable".to_owned() } else { text(case.value()) };
            let keys = case.ranges.keys.iter().zip(case.key_values(case.worst));
            let keys: Vec<String> =
                keys.map(|(own, value)| format!("{} = {}", own.key, digits(value))).collect();
            rows.push(vec![kind.word().to_owned(), text(case.nominal()), worst, keys.join(", ")]);
        }
        say!("  least margins that a search of {WORST_POINTS} loops each finds over the uncertain keys");
        for line in columns(&rows, 1) {
            say!("  {line}");
        }
    }

    /// Returns the crossings of a loop with their frequencies (rad/s): kind, phase, delay and gain.
    fn crossings(&self, one: &SignalMargins) -> Vec<(f64, Vec<String>)> {
        let gain = one.crossings.gain.iter().map(|crossing| {
            let phase = digits(crossing.phase_rad * self.phase().0);
            let delay = self.delay(crossing.delay_s);
            (crossing.frequency_rad_s, vec!["gain".to_owned(), phase, delay, String::new()])
        });
        let phase = one.crossings.phase.iter().map(|crossing| {
            let factor = self.gain(Some(crossing.factor));
            (crossing.frequency_rad_s, vec!["phase".to_owned(), String::new(), String::new(), factor])
        });
        gain.chain(phase).collect()
    }
}

impl Results for LoopMargins {
    fn json(&self) -> Vec<Json> {
        let mut margins = json!(self.margins);
        if !self.worst.is_empty() {
            let least = self.worst.iter().map(|(kind, case)| (kind.word().to_owned(), case.to_json()));
            margins["worst"] = Json::Object(least.collect());
        }
        vec![with_scenario_name(&self.name, margins)]
    }

    fn figures(&self) -> Vec<Named> {
        let name = &self.name;
        let mut figures =
            figures::figures(name, &self.margins.stability.loops, self.margins.stability.period_s);
        let values = figures::singular_values(name, &self.margins.stability);
        figures.push((format!("{name}-singular-values"), values));
        figures.push((format!("{name}-root-locus"), figures::root_locus(name, &self.margins.cut)));
        figures
    }

    fn print(&self) -> Result<(), CliError> {
        let StabilityMargins { spectral_radius, opened, period_s, samples, loops, .. } =
            &self.margins.stability;
        let name = opened.name();
        let samples = match *samples {
            1 => String::new(),
            count => format!(", {}", counted(count, "sample") + " of the law"),
        };
        say!(
            "{}   {} cut open at the {name}, stable: spectral radius {spectral_radius:.6} in {period_s} s{samples}",
            self.name,
            counted(loops.len(), "loop"),
        );
        self.print_margins();
        self.print_crossings();
        if !self.worst.is_empty() {
            self.print_worst();
        }
        Ok(())
    }
}
