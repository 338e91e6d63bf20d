//! `flexsc margins`: stability margins of the loop of a scenario.

mod figures;
mod mask;
mod root_locus;

use std::f64::consts::{PI, TAU};
use std::io::Write;

use flexsc_core::analysis::margins::{SignalMargins, StabilityMargins};
use flexsc_core::analysis::open_loop::LoopBreak;
use flexsc_core::analysis::scenario_margins::{MarginsFault, ScenarioMargins};
use flexsc_core::analysis::settling_time::SETTLING_BAND;
use flexsc_core::formats::count::counted;
use flexsc_core::formats::document::ConfigError;
use flexsc_core::worst_case::{MarginKind, MarginSearch, WorstCase, uncertain_box};
use flexsc_core::{Scenario, ScenarioError};
use flexsc_figure::Named;
use serde::Serialize;
use serde_json::{Value as Json, json};

use crate::at_rest::hinted;
use crate::choice::choice;
use crate::error::CliError;
use crate::figure_files::FigureOutput;
use crate::human::{Units, digits};
use crate::number::number_or_none;
use crate::results::{Results, show, with_scenario_name};
use crate::row_table::{Column, column, print_rows};
use crate::stop::stop_requested;
use crate::{say, scenario};
pub use mask::NicholsMask;

/// Number of loops of each search for the least margin.
const WORST_POINTS: usize = 100;

#[derive(clap::Args)]
pub struct MarginsArgs {
    #[command(flatten)]
    pub scenario: scenario::ScenarioArgs,
    /// Point at which each loop is cut open
    #[arg(long = "loop", value_name = "POINT", default_value = "command", value_parser = choice(&LoopBreak::ALL, LoopBreak::name))]
    opened: LoopBreak,
    /// Search for the least of each margin over the uncertain keys too, as `flexsc worst --margin` does
    #[arg(long)]
    worst: bool,
    /// Gain and phase by which each loop may be off at once, such as "6 dB, 30 deg": a mask around -1 in the Nichols chart. The
    /// exit code is 3 if a loop is within it
    #[arg(long, value_name = "GAIN,PHASE")]
    mask: Option<NicholsMask>,
    #[command(flatten)]
    pub drawing: FigureOutput,
}

/// Margins of the loop of a scenario.
pub struct LoopMargins {
    /// Name of the scenario.
    name: String,
    margins: ScenarioMargins,
    /// Least margins over the uncertain keys.
    worst: Vec<(MarginKind, WorstCase)>,
    /// Mask, and the frequency (Hz) at which each loop is first within it.
    masked: Option<(NicholsMask, Vec<Option<f64>>)>,
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
    let margins = ScenarioMargins::from_scenario(scenario, args.opened).map_err(|fault| match fault {
        MarginsFault::Key(fault) => key(fault),
        MarginsFault::Unstable(unstable) => CliError::Arguments(format!("{name}: {unstable}")),
    })?;
    let kinds = MarginKind::ALL.into_iter().filter(|_| args.worst);
    let least = |kind: MarginKind| {
        let search = MarginSearch { kind, opened: args.opened, most_loops: WORST_POINTS };
        let found = search.run(scenario, stop_requested).map_err(|fault| CliError::worst_case(&name, fault));
        found.map(|case| (kind, case))
    };
    let worst = kinds.map(least).collect::<Result<_, CliError>>()?;
    let masked = args.mask.map(|mask| {
        let StabilityMargins { loops, period_s, .. } = &margins.stability;
        let first = |one: &SignalMargins| {
            let lines = figures::locus_lines(std::slice::from_ref(one), *period_s);
            lines.iter().find_map(|line| mask.first_violation(&line.points))
        };
        (mask, loops.iter().map(first).collect())
    });
    Ok(LoopMargins { name, margins, worst, masked, units: args.drawing.choice.units() })
}

pub fn run(args: &MarginsArgs) -> Result<(), CliError> {
    args.drawing.check(&args.scenario.scenario)?;
    let margins = args.scenario.load().and_then(|scenario| results(&scenario, args));
    let margins = margins.map_err(|failure| hinted(failure, "margins", &args.scenario))?;
    show(&margins, Some(&args.drawing), args.scenario.json)?;
    match margins.violations() {
        0 => Ok(()),
        count => Err(CliError::Requirements(format!("{} within the mask", counted(count as u64, "loop")))),
    }
}

/// Smallest margins of each loop.
const MARGINS: [Column<'_>; 11] = [
    column("signal", "loop"),
    column("gain_below", "gain\ndown").gain(),
    column("gain_above", "gain\nup").gain(),
    column("phase_rad", "phase"),
    column("delay_s", "delay"),
    column("modulus.margin", "modulus"),
    column("modulus.frequency_rad_s", "at"),
    column("disk.alpha", "disk"),
    column("disk.frequency_rad_s", "at"),
    column("disk.gains", "gain\nin the disk").gain(),
    column("disk.phase_rad", "phase\nin the disk"),
];

/// Number of these columns before that of a mask.
const BEFORE_MASK: usize = 5;

/// Least margins over the uncertain keys.
const WORST: [Column<'_>; 4] = [
    column("margin", "margin"),
    column("nominal", "nominal").unit_of_row(),
    column("worst", "worst").unit_of_row(),
    column("keys", "keys"),
];

/// Crossings of all loops.
const CROSSINGS: [Column<'_>; 6] = [
    column("loop", "loop"),
    column("crossing", "crossing"),
    column("frequency_rad_s", "frequency"),
    column("phase_rad", "phase"),
    column("delay_s", "delay"),
    column("factor", "gain").gain(),
];

impl LoopMargins {
    /// Returns the margins as `--json` prints them.
    pub fn margins(&self) -> &ScenarioMargins {
        &self.margins
    }

    /// Returns an object without its delay for several samples in a period, where a delay is more than a phase.
    fn row(&self, of: impl Serialize) -> Json {
        let mut row = json!(of);
        if self.margins.stability.samples > 1
            && let Some(fields) = row.as_object_mut()
        {
            fields.remove("delay_s");
        }
        row
    }

    /// Prints the smallest margins of each loop, and of all together.
    fn print_margins(&self) {
        let StabilityMargins { loops, modulus, disk, independent_disk, samples, .. } =
            &self.margins.stability;
        let own = loops.iter().enumerate().map(|(index, one)| {
            let mut row = self.row(one);
            if let Some((_, violations)) = &self.masked {
                row["mask"] = json!(self.mask_verdict(violations[index]));
            }
            // Half a turn is no limit.
            if one.phase_rad.abs() >= PI {
                row["phase_rad"] = Json::Null;
            }
            row
        });
        let mut rows: Vec<Json> = own.collect();
        if rows.len() > 1 {
            rows.push(json!({"signal": "all together", "modulus": modulus, "disk": disk}));
        }
        rows.extend(independent_disk.map(|disk| json!({"signal": "all, independent", "disk": disk})));
        let of_attitude = rows.len();
        rows.extend(self.margins.mirrors.iter().map(|one| json!(one)));
        let (first, rest) = MARGINS.split_at(BEFORE_MASK);
        let mask = [column("mask", "mask")];
        let mask = if self.masked.is_some() { &mask[..] } else { &[] };
        print_rows(&rows, &[first, mask, rest].concat(), self.units);
        if of_attitude > 1 || *samples > 1 {
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

    /// Returns the verdict on a loop that is first within the mask at a frequency (Hz).
    fn mask_verdict(&self, violation: Option<f64>) -> String {
        let (factor, unit) = self.units.frequency();
        let at = |hertz: f64| format!("violated at {} {unit}", digits(hertz * TAU * factor));
        violation.map_or_else(|| "kept".to_owned(), at)
    }

    /// Returns the frequency (Hz) at which each loop is first within the mask; empty without a mask.
    pub fn mask_violations(&self) -> &[Option<f64>] {
        self.masked.as_ref().map_or(&[], |(_, all)| all)
    }

    /// Returns the number of loops within the mask.
    fn violations(&self) -> usize {
        self.mask_violations().iter().flatten().count()
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
        let mut rows = Vec::new();
        for SignalMargins { signal, crossings, .. } in &self.margins.stability.loops {
            let gain =
                crossings.gain.iter().map(|crossing| (crossing.frequency_rad_s, "gain", self.row(crossing)));
            let phase =
                crossings.phase.iter().map(|crossing| (crossing.frequency_rad_s, "phase", json!(crossing)));
            let mut own: Vec<_> = gain.chain(phase).collect();
            own.sort_by(|a, b| a.0.total_cmp(&b.0));
            rows.extend(own.into_iter().map(|(_, kind, mut row)| {
                (row["loop"], row["crossing"]) = (json!(signal), json!(kind));
                row
            }));
        }
        say!("  crossings, with the phase and the delay, or the gain, that the loop tolerates there");
        print_rows(&rows, &CROSSINGS, self.units);
    }

    /// Prints the least margins over the uncertain keys, with the keys where they are attained.
    fn print_worst(&self) {
        let row = |(kind, case): &(MarginKind, WorstCase)| {
            let (scale, unit): (fn(f64) -> f64, &str) = match kind {
                MarginKind::Gain if self.units.has_decibels() => (|factor| 20.0 * factor.log10(), "dB"),
                _ => (|value| value, kind.unit()),
            };
            let keys = case.ranges.keys.iter().zip(case.key_values(case.worst));
            let keys: Vec<String> =
                keys.map(|(own, value)| format!("{} = {}", own.key, digits(value))).collect();
            let mut row = json!({
                "margin": kind.word(),
                "nominal": scale(case.nominal()),
                "worst": scale(case.value()),
                "unit": unit,
                "keys": keys.join(", "),
            });
            if case.is_unstable {
                row["worst"] = json!("unstable");
            }
            row
        };
        let rows: Vec<Json> = self.worst.iter().map(row).collect();
        say!("  least margins that a search of {WORST_POINTS} loops each finds over the uncertain keys");
        print_rows(&rows, &WORST, self.units);
    }
}

impl Results for LoopMargins {
    fn json(&self) -> Vec<Json> {
        let mut margins = json!(self.margins);
        if !self.worst.is_empty() {
            let least = self.worst.iter().map(|(kind, case)| (kind.word().to_owned(), json!(case.report())));
            margins["worst"] = Json::Object(least.collect());
        }
        if let Some((mask, violations)) = &self.masked {
            let NicholsMask { gain_db, phase_deg } = mask;
            let loops = violations.iter().zip(&self.margins.stability.loops);
            let each = loops.map(|(at, one)| json!({"signal": one.signal, "violated_at_hz": at}));
            margins["mask"] = json!({
                "gain_db": gain_db,
                "phase_deg": phase_deg,
                "met": self.violations() == 0,
                "loops": each.collect::<Vec<_>>(),
            });
        }
        vec![with_scenario_name(&self.name, margins)]
    }

    fn figures(&self) -> Vec<Named> {
        let name = &self.name;
        let StabilityMargins { loops, period_s, .. } = &self.margins.stability;
        let mask = self.masked.as_ref().map(|(mask, _)| mask);
        let mut figures = figures::figures(name, loops, *period_s, mask);
        let values = figures::singular_values(name, &self.margins.stability);
        figures.push((format!("{name}-singular-values"), values));
        let locus = root_locus::figure(name, &self.margins.cut, loops);
        figures.extend(locus.map(|figure| (format!("{name}-root-locus"), figure)));
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
