//! `flexsc tune --vary`: keys of a law that maximise the least modulus margin over the plants of a scenario.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use flexsc_core::analysis::open_loop::LoopBreak;
use flexsc_core::analysis::structured_tuning::{
    KeyChange, LoopSensitivity, ScenarioTuning, TunedScenario, TuningFault, TuningLimit, TuningObjective,
    TuningPoint, TuningReport,
};
use flexsc_core::formats::count::counted;
use flexsc_core::formats::document::{ConfigError, is_number};
use flexsc_core::formats::reader_units::{number, time};
use flexsc_core::scenario::{AssessedRequirement, RequirementSource};
use flexsc_core::{Scenario, ScenarioError};
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Named, Panel, Point, colour};
use serde_json::{Value as Json, json};

use crate::choice::choice;
use crate::error::CliError;
use crate::human::{Units, digits};
use crate::quantity::in_unit;
use crate::results::{Results, with_scenario_name};
use crate::row_table::{Column, column, print_rows};
use crate::scenario::{self, ScenarioArgs};
use crate::{files, out, say};

/// Change of a modulus margin over frequency that the figure shows.
const LEAST_CHANGE: f64 = 0.02;
/// Largest modulus margin that the figure shows.
const SHOWN_MARGIN: f64 = 2.0;
/// Shortfall of the loop gain at the bandwidth that is rounding of the search.
const LEAST_SHORTFALL: f64 = 1e-6;

/// Number of plants of which the text prints the margins.
const PRINTED: usize = 6;

/// Arguments of a search over keys.
#[derive(clap::Args)]
#[command(next_help_heading = "Keys of any linear law, with --vary")]
#[group(skip)]
pub struct StructuredArgs {
    /// Vary a key within a range for the objective, such as law.pd.k_d=10:400; repeat it for several keys
    #[arg(
        long,
        value_name = "KEY=LO:HI",
        conflicts_with_all = ["frequency", "gain", "limit", "robust", "schedule", "band", "horizon", "dominant_alone"]
    )]
    vary: Vec<VariedKey>,
    /// Quantity that is improved over all plants: `margin`, the least modulus margin; `settling`, the time after a step of
    /// the target in which the angles settle within 5 %; or the name of a [[requirement]], the rms of its pointing index
    /// under the noise of the loop, or with `holds` its value in a run
    #[arg(long, value_name = "QUANTITY", default_value = "margin", requires = "vary")]
    objective: TuningObjective,
    /// Limit that all plants keep: `margin>=VALUE`, `settling<=TIME`, or the name of a [[requirement]] with its own
    /// limit; repeat it for several
    #[arg(long, value_name = "LIMIT", requires = "vary")]
    keep: Vec<TuningLimit>,
    /// Point at which the loops are cut open
    #[arg(long = "loop", value_name = "POINT", default_value = "command", requires = "vary", value_parser = choice(&LoopBreak::ALL, LoopBreak::name))]
    opened: LoopBreak,
    /// Frequency (rad/s) at which the loop gain stays 1 or more with the nominal plant
    #[arg(long, value_name = "FREQUENCY", requires = "vary", value_parser = in_unit("rad/s"))]
    bandwidth: Option<f64>,
    /// Leave out the corners of `[uncertain]`: the nominal plant alone
    #[arg(long, requires = "vary")]
    nominal: bool,
    /// Write the tuned scenario to a new file
    #[arg(long, value_name = "FILE", requires = "vary")]
    save: Option<PathBuf>,
}

/// Key with its range.
#[derive(Clone, Debug)]
pub struct VariedKey {
    key: String,
    /// Bounds as they are written, with their units.
    range: [String; 2],
}

impl FromStr for VariedKey {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = text.split_once('=').and_then(|(key, range)| {
            let (low, high) = range.split_once(':')?;
            let is_range = !key.trim().is_empty() && is_number(low) && is_number(high);
            is_range.then(|| Self { key: key.trim().to_owned(), range: [low, high].map(str::to_owned) })
        });
        parsed.ok_or_else(|| format!("must be KEY=LO:HI with LO < HI, got {text}"))
    }
}

impl VariedKey {
    /// Returns the key with its bounds in the unit of the key.
    fn range_in(&self, scenario: &Scenario) -> Result<(String, [f64; 2]), CliError> {
        let Self { key, range: [low, high] } = self;
        scenario.validate_key(key)?;
        let range = [scenario.number_of(key, low)?, scenario.number_of(key, high)?];
        if range[0] < range[1] {
            Ok((key.clone(), range))
        } else {
            let why = format!("must be KEY=LO:HI with LO < HI, got {low}:{high}");
            Err(CliError::Arguments(format!("--vary {key}: {why}")))
        }
    }
}

/// Ratio of settling times from which on a tuned loop is called slower.
const SLOWER: f64 = 1.2;
/// Part of the range of a key within which a value is at an end of it.
const AT_END: f64 = 1e-3;

/// Columns of the tuned keys.
const KEYS: [Column<'_>; 5] = [
    column("key", "key"),
    column("before", "before").unit_of_row(),
    column("after", "after").unit_of_row(),
    column("range.0", "lowest").unit_of_row(),
    column("range.1", "highest").unit_of_row(),
];

/// Columns of the measures besides the margins.
const MEASURES: [Column<'_>; 6] = [
    column("name", ""),
    column("before", "before").unit_of_row(),
    column("after", "after").unit_of_row(),
    column("limit", "limit").unit_of_row(),
    column("kept", ""),
    column("plant", "worst plant"),
];

/// Columns of the plants.
const PLANTS: [Column<'_>; 5] = [
    column("before.margin", "margin before"),
    column("before.frequency_rad_s", "at"),
    column("after.margin", "margin after"),
    column("after.frequency_rad_s", "at"),
    column("plant", "plant"),
];

/// Result of a search over keys.
pub struct StructuredResults {
    name: String,
    /// Scenario before.
    scenario: Scenario,
    found: TunedScenario,
    units: Units,
}

impl StructuredArgs {
    /// Returns true if keys are to be varied.
    pub fn is_asked_for(&self) -> bool {
        !self.vary.is_empty()
    }

    /// Searches for the values of the keys.
    pub fn results(&self, scenario: &Scenario, units: Units) -> Result<StructuredResults, CliError> {
        if let Some(path) = &self.save
            && out::ending(path) != Some("toml")
        {
            return Err(CliError::Arguments(format!("--save {}: must end in .toml", path.display())));
        }
        let tuning = ScenarioTuning {
            keys: self.vary.iter().map(|varied| varied.range_in(scenario)).collect::<Result<_, _>>()?,
            opened: self.opened,
            objective: self.objective.clone(),
            limits: self.keep.clone(),
            bandwidth: self.bandwidth,
            is_nominal: self.nominal,
        };
        let name = scenario.name.clone();
        let found = tuning.run(scenario).map_err(|fault| match fault {
            TuningFault::Key(ConfigError { key, why, .. }) => {
                CliError::from(ScenarioError::Key { origin: name.clone(), key, why })
            }
            fault => CliError::Arguments(format!("{name}: {fault}")),
        })?;
        Ok(StructuredResults { name, scenario: scenario.clone(), found, units })
    }

    /// Writes the tuned scenario, if it is to be, in place of another file if `force`.
    pub fn save(
        &self,
        results: &StructuredResults,
        args: &ScenarioArgs,
        force: bool,
    ) -> Result<(), CliError> {
        let Some(path) = &self.save else { return Ok(()) };
        let whole = results.found.scenario()?.to_toml();
        let text = results.text_with_comments(args)?.unwrap_or(whole);
        if !force && std::fs::read(path).is_ok_and(|content| content != text.as_bytes()) {
            let why = format!(
                "--save {}: already exists, with other content; give another name, or --force to replace it",
                path.display()
            );
            return Err(CliError::Arguments(why));
        }
        files::write(path, text.as_bytes(), true)?;
        say!("{}", path.display());
        Ok(())
    }
}

impl StructuredResults {
    /// Returns the text of the scenario's file with the tuned values in place; `None` where it does not have all of them as
    /// numbers, or is not the whole scenario.
    fn text_with_comments(&self, args: &ScenarioArgs) -> Result<Option<String>, CliError> {
        let is_whole = args.set.is_empty() && args.mode.is_none() && args.scenario != Path::new("-");
        if !is_whole || self.scenario.self_contained().to_toml() != self.scenario.to_toml() {
            return Ok(None);
        }
        let document = scenario::document(&args.scenario)?;
        let keys = self.found.report().keys;
        let values = keys.iter().map(|own| (own.key.as_str(), own.after, self.unit_of(&own.key)));
        Ok(document.text_with_numbers(values))
    }

    /// Returns a name for a plant: the values of its uncertain keys.
    fn plant(&self, index: usize) -> String {
        let each = self.found.loops.plant(index).into_iter();
        let values: Vec<String> = each
            .map(|(key, value)| {
                let unit = self.scenario.reader_unit(key, value.abs(), self.units.0);
                format!("{key} = {}", unit.quantity(value))
            })
            .collect();
        if values.is_empty() { "nominal".to_owned() } else { values.join(", ") }
    }

    /// Returns the plants with the least margins, before or after, and the nominal one.
    fn printed(&self) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.found.tuned.after.plants.len()).collect();
        let least = |plant: &usize| {
            let at = |point: &TuningPoint| point.plants[*plant].margin;
            at(&self.found.tuned.before).min(at(&self.found.tuned.after))
        };
        order.sort_by(|a, b| least(a).total_cmp(&least(b)));
        order.truncate(PRINTED);
        if !order.contains(&0) {
            order.push(0);
        }
        order
    }

    /// Returns the margin over frequency of a plant, with the values of a point.
    fn curve(&self, point: &TuningPoint, plant: usize) -> Vec<Point> {
        let opened = self.found.loops.loop_at(&point.values, plant).ok();
        let sensitivity = opened.as_ref().and_then(LoopSensitivity::new);
        sensitivity.and_then(|sensitivity| sensitivity.margins()).unwrap_or_default()
    }

    /// Prints the measures besides the margins, with their limits and the plants that have the largest values.
    fn print_measures(&self, report: &TuningReport) {
        let mut rows = Vec::new();
        let row = |name: String, of: Json, is_kept: bool, worst: usize| {
            let mut row = of;
            row["name"] = json!(name);
            row["kept"] = json!(if is_kept { "" } else { "not kept" });
            row["plant"] = json!(self.plant(worst));
            row
        };
        if let Some(least) = report.margin_limit {
            let worst = self.found.tuned.after.worst().map_or(0, |worst| worst.plant);
            let (before, after) = (report.least_margin_before, report.least_margin);
            let of = json!({"before": before, "after": after, "limit": least});
            rows.push(row("margin".to_owned(), of, after >= least * (1.0 - LEAST_SHORTFALL), worst));
        }
        for measure in &report.measures {
            let is_index = |own: &&AssessedRequirement| matches!(own.source, RequirementSource::Error(_));
            let mut indices = self.scenario.study.requirements.iter().filter(is_index);
            let rms = if indices.any(|own| own.name == measure.name) {
                " rms"
            } else if self.scenario.study.contrasts.iter().any(|own| own.name == measure.name) {
                " 1 - MTF"
            } else {
                ""
            };
            let is_kept = measure.limit.is_none_or(|limit| measure.after <= limit * (1.0 + LEAST_SHORTFALL));
            rows.push(row(format!("{}{rms}", measure.name), json!(measure), is_kept, measure.worst_plant));
        }
        if !rows.is_empty() {
            print_rows(&rows, &MEASURES, self.units);
        }
    }

    fn unit_of(&self, key: &str) -> &'static str {
        self.scenario.unit_of(key).unwrap_or_default()
    }

    /// Prints what a search for margins alone may have cost, and keys that would go on beyond their ranges.
    fn print_warnings(&self, report: &TuningReport) {
        if !report.measures.iter().any(|measure| measure.name == "settling")
            && let Some([before, after]) = self.found.settling()
        {
            let warning = if after > SLOWER * before { "! " } else { "" };
            say!(
                "  {warning}settling of the nominal plant {} before, {} tuned (--keep 'settling<={} s' limits it)",
                time(before),
                time(after),
                number(before)
            );
        }
        for own in &report.keys {
            let [low, high] = own.range;
            let near = |end: f64| (own.after - end).abs() <= AT_END * (high - low);
            let end = if near(low) { "lowest" } else { "highest" };
            if near(low) || near(high) {
                say!("  ! {} ends at its {end} value: the range decides it, not the goal", own.key);
            }
        }
    }

    fn print_plants(&self, report: &TuningReport) {
        let row = |index: usize| {
            let mut row = json!(report.plants[index]);
            row["plant"] = json!(self.plant(index));
            row
        };
        print_rows(&self.printed().into_iter().map(row).collect::<Vec<_>>(), &PLANTS, self.units);
    }
}

/// Returns the frequency from which on a margin differs from that at the lowest one; none if it does not.
fn first_change(points: &[Point]) -> Option<f64> {
    let first = points.first()?.1;
    points.iter().find(|point| (point.1 - first).abs() > LEAST_CHANGE).map(|point| point.0)
}

impl Results for StructuredResults {
    fn json(&self) -> Vec<Json> {
        vec![with_scenario_name(&self.name, json!(self.found.report()))]
    }

    fn figures(&self) -> Vec<Named> {
        let worst = |point: &TuningPoint| point.worst().map_or(0, |worst| worst.plant);
        let (before, after) = (&self.found.tuned.before, &self.found.tuned.after);
        let mut lines = vec![
            ("nominal, before", colour::GREY, LayerShape::Line(1.4), self.curve(before, 0)),
            ("nominal, tuned", colour::BLUE, LayerShape::Line(1.6), self.curve(after, 0)),
        ];
        if self.found.loops.plants() > 1 {
            let dashes = LayerShape::Dashes;
            lines.push(("worst plant, before", colour::ORANGE, dashes, self.curve(before, worst(before))));
            lines.push(("worst plant, tuned", colour::VERMILLION, dashes, self.curve(after, worst(after))));
        }
        // The loop matters where a margin is within the shown ones.
        let all = || lines.iter().flat_map(|line| &line.3).filter(|point| point.1 <= SHOWN_MARGIN);
        let begins = lines.iter().filter_map(|line| first_change(&line.3)).fold(f64::INFINITY, f64::min);
        let matters = all().map(|point| point.0).filter(|frequency| *frequency >= 0.1 * begins);
        let x = FigureAxis::decades("frequency", "rad/s", matters).in_hertz();
        let y = FigureAxis::from_zero("distance of the loop from -1", "", all().map(|point| point.1));
        let least = self.found.report().margin_limit.map(|least| {
            let ends = vec![(x.range.start, least), (x.range.end, least)];
            Layer::new(&format!("at least {least}"), colour::RED, LayerShape::Line(1.4), ends)
        });
        let layers = lines.into_iter().map(|(name, colour, shape, points)| {
            let points =
                points.into_iter().map(|(x, y)| (x, if y > SHOWN_MARGIN { f64::NAN } else { y })).collect();
            Layer::new(name, colour, shape, points)
        });
        let layers = layers.chain(least).collect();
        let title = format!("{}: modulus margin before and after tuning", self.name);
        vec![(
            format!("{}-tune-margin", self.name),
            Figure { title, panels: vec![Panel::new(x, y, layers)], panel_height: 340 },
        )]
    }

    fn print(&self) -> Result<(), CliError> {
        let report = self.found.report();
        say!(
            "{}   least modulus margin of {}, cut open at the {}: {} before, {} tuned, {}",
            self.name,
            counted(self.found.loops.plants(), "plant"),
            self.found.opened().name(),
            digits(report.least_margin_before),
            digits(report.least_margin),
            counted(report.steps, "step"),
        );
        let row = |own: &KeyChange| {
            let mut row = json!(own);
            row["unit"] = json!(self.unit_of(&own.key));
            row["written"] = json!(self.scenario.written_unit(&own.key));
            row
        };
        print_rows(&report.keys.iter().map(row).collect::<Vec<_>>(), &KEYS, self.units);
        self.print_measures(&report);
        self.print_plants(&report);
        self.print_warnings(&report);
        if let Some(gain) = report.bandwidth_gain {
            let reached = if gain < 1.0 - LEAST_SHORTFALL { ": the bandwidth is not reached" } else { "" };
            say!("  loop gain at the bandwidth {}{reached}", digits(gain));
        }
        Ok(())
    }
}
