//! `flexsc worst`: the worst case of requirements, a metric, lines of wheels or a stability margin over the uncertain keys.

mod campaign_starts;
mod figures;

use std::io::Write;
use std::path::{Path, PathBuf};

use flexsc_core::Scenario;
use flexsc_core::analysis::noise::{WheelOutput, Window};
use flexsc_core::analysis::open_loop::LoopBreak;
use flexsc_core::campaign::{Campaign, Design};
use flexsc_core::formats::count::counted;
use flexsc_core::scenario::ContrastRequirement;
use flexsc_core::uncertain::UncertainKey;
use flexsc_core::worst_case::{
    ContrastSearch, LineSearch, MarginKind, MarginSearch, MetricSearch, RunQuantity, WorstCase,
};
use flexsc_figure::Named;
use serde_json::{Value as Json, json};

use crate::bound::{self, OutputBounds};
use crate::campaign::part_files;
use crate::choice::choice;
use crate::confirm_cost::CostConfirmation;
use crate::error::CliError;
use crate::human::{Units, digits};
use crate::number_table::NumberTable;
use crate::quantity::in_unit;
use crate::required_limit::RequiredLimit;
use crate::result_files::ResultOutput;
use crate::results::{Results, print_lines, with_scenario_name};
use crate::row_table::{Column, column, print_rows};
use crate::stop::{stop_flag, stop_requested};
use crate::{files, say, scenario};

#[derive(clap::Args)]
pub struct WorstArgs {
    #[command(flatten)]
    pub scenario: scenario::ScenarioArgs,
    /// Metric, or element NAME[i] of a list [default: all requirements of the scenario]
    #[arg(long, value_name = "NAME", conflicts_with_all = ["requirement", "margin", "signal"])]
    metric: Option<String>,
    /// Requirement of the scenario
    #[arg(long, value_name = "NAME", conflicts_with_all = ["margin", "signal"])]
    requirement: Option<String>,
    /// Output of the linear loop, as of `spectrum`, such as line_of_sight0_x: its rms under the imbalance of the wheels at their worst
    /// speed
    #[arg(long, value_name = "NAME", conflicts_with_all = ["margin", "campaign"])]
    signal: Option<String>,
    /// Length of windows within which the signal moves against its mean (s), such as an exposure time [default: all of its motion]
    #[arg(long, value_name = "TIME", requires = "signal", value_parser = in_unit("s"))]
    window: Option<f64>,
    /// Stability margin, the least of all loops
    #[arg(long, value_name = "MARGIN", value_parser = choice(&MarginKind::ALL, MarginKind::word))]
    margin: Option<MarginKind>,
    /// Point at which the loops are cut open
    #[arg(long = "loop", value_name = "POINT", default_value = "command", requires = "margin", value_parser = choice(&LoopBreak::ALL, LoopBreak::name))]
    opened: LoopBreak,
    /// Search for the smallest value of the metric instead of the largest
    #[arg(long, requires = "metric")]
    least: bool,
    /// Largest number of points that are assessed, each by a run or a loop
    #[arg(long, default_value_t = 200, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    points: u32,
    /// Directory of a campaign of the scenario, from whose worst runs the search starts [default: points spread over the ranges]
    #[arg(long, value_name = "DIR", conflicts_with = "margin")]
    campaign: Option<PathBuf>,
    #[command(flatten)]
    runs: scenario::RunArgs,
    #[command(flatten)]
    output: ResultOutput,
    #[command(flatten)]
    consent: CostConfirmation,
}

/// Columns of the uncertain keys.
const KEYS: [Column<'_>; 5] = [
    column("key", "key"),
    column("nominal", "nominal").unit_of_row(),
    column("worst", "worst").unit_of_row(),
    column("range.0", "lowest").unit_of_row(),
    column("range.1", "highest").unit_of_row(),
];

/// Worst cases of a scenario.
pub struct WorstCases {
    name: String,
    cases: Vec<(WorstCase, Option<RequiredLimit>)>,
    /// Guaranteed ranges of the claims of the scenario, if it has any.
    bounds: Option<OutputBounds>,
    units: Units,
}

pub fn run(args: &WorstArgs) -> Result<(), CliError> {
    let inputs = [args.scenario.scenario.as_path()];
    let witness = args.output.scenario_file(&inputs)?;
    let target = if witness.is_some() { None } else { args.output.target(&inputs)? };
    let scenario = scenario::load(&args.scenario.scenario, &args.scenario.set, args.runs.seed)?;
    let scenario = args.scenario.in_mode(scenario)?;
    if witness.is_some() && args.quantities(&scenario)?.len() + args.asked(&scenario).count() > 1 {
        let why = "-o: a witness is of one quantity; give --requirement, --metric or --margin";
        return Err(CliError::Arguments(why.to_owned()));
    }
    let worst = results(&scenario, args)?;
    if let Some(path) = witness {
        worst.write_witness(&path, args.output.force)?;
    }
    if let Some(target) = target {
        target.save(&worst)?;
    }
    if args.scenario.json {
        print_lines(&worst.json())?;
    } else {
        worst.print()?;
    }
    worst.require_met()
}

/// Searches for the worst cases.
pub fn results(scenario: &Scenario, args: &WorstArgs) -> Result<WorstCases, CliError> {
    let name = scenario.name.clone();
    let most = args.points as usize;
    let of_loop = match (args.margin, &args.signal) {
        (Some(kind), _) => {
            let search = MarginSearch { kind, opened: args.opened, most_loops: most };
            Some(search.run(scenario, stop_requested))
        }
        (None, Some(signal)) => {
            let window = args.window.map(|length| Window { length, separation: None });
            let output = WheelOutput { name: signal.clone(), window };
            Some(LineSearch { output, most_loops: most }.run(scenario, stop_requested))
        }
        (None, None) => None,
    };
    if let Some(case) = of_loop {
        let cases = vec![(case.map_err(|error| CliError::worst_case(&name, error))?, None)];
        return Ok(WorstCases { name, cases, bounds: None, units: args.output.choice.units() });
    }
    let (quantities, mut cases) = (args.quantities(scenario)?, args.contrasts(scenario)?);
    if quantities.is_empty() {
        return Ok(WorstCases {
            name,
            cases,
            bounds: args.claims(scenario)?,
            units: args.output.choice.units(),
        });
    }
    let origin = args.scenario.scenario.display().to_string();
    let campaign = Campaign::from_design(scenario.clone(), &origin, Design::default())?;
    let made = args.campaign.as_deref().map(|path| part_files::open(&campaign, path)).transpose()?;
    let runs = u64::from(args.points) * quantities.len() as u64;
    let cost = campaign.cost(runs, None).map_err(|why| CliError::Arguments(format!("--points: {why}")))?;
    args.consent.check(&cost)?;
    for quantity in quantities {
        let requirement = match &quantity {
            RunQuantity::Requirement(wanted) => {
                let all = scenario.study.requirements.iter();
                all.clone().find(|requirement| requirement.name == *wanted).map(RequiredLimit::new)
            }
            RunQuantity::Metric(_) => None,
        };
        let starts = made
            .as_ref()
            .map(|made| campaign_starts::worst_runs(made, scenario, &quantity, args.least))
            .transpose()?;
        let search = MetricSearch {
            starts: starts.unwrap_or_default(),
            quantity,
            is_least: args.least,
            most_runs: most,
            threads: usize::from(args.runs.threads()),
        };
        let work = |run: &flexsc_core::campaign::CampaignRun, selection: &flexsc_core::metrics::Selection| {
            Ok(Campaign::simulate_metrics(run, selection, stop_flag())?)
        };
        let case = search
            .run(scenario, &origin, work, stop_requested)
            .map_err(|error| CliError::worst_case(&name, error))?;
        cases.push((case, requirement));
    }
    let bounds = args.claims(scenario)?;
    Ok(WorstCases { name, cases, bounds, units: args.output.choice.units() })
}

impl WorstArgs {
    /// Returns the quantities of runs that are searched.
    fn quantities(&self, scenario: &Scenario) -> Result<Vec<RunQuantity>, CliError> {
        if let Some(name) = &self.metric {
            return Ok(vec![RunQuantity::Metric(name.clone())]);
        }
        let contrasts = &scenario.study.contrasts;
        if let Some(name) = &self.requirement {
            let is_of_run = contrasts.iter().all(|own| own.name != *name);
            return Ok(is_of_run.then(|| RunQuantity::Requirement(name.clone())).into_iter().collect());
        }
        if self.margin.is_some() || self.signal.is_some() {
            return Ok(Vec::new());
        }
        let all = &scenario.study.requirements;
        if all.is_empty() && contrasts.is_empty() && scenario.written.bound.is_empty() {
            return Err(CliError::Arguments(format!(
                "{}: has no [[requirement]] and no [[bound]]\n\nhint: `--metric NAME` or `--margin MARGIN` gives the quantity; \
                 `flexsc schema --metrics` lists the metrics",
                scenario.name
            )));
        }
        Ok(all.iter().map(|requirement| RunQuantity::Requirement(requirement.name.clone())).collect())
    }
}

impl WorstArgs {
    /// Returns the requirements on the contrast of an image whose worst case is asked for.
    fn asked<'a>(&'a self, scenario: &'a Scenario) -> impl Iterator<Item = &'a ContrastRequirement> {
        let is_of_run = self.metric.is_some() || self.margin.is_some() || self.signal.is_some();
        let all = if is_of_run { &[][..] } else { &scenario.study.contrasts[..] };
        all.iter().filter(|own| self.requirement.as_ref().is_none_or(|name| *name == own.name))
    }

    /// Returns the worst cases of the contrasts of images that are asked for.
    fn contrasts(&self, scenario: &Scenario) -> Result<Vec<(WorstCase, Option<RequiredLimit>)>, CliError> {
        self.asked(scenario)
            .map(|own| {
                let search = ContrastSearch { requirement: own.clone(), most_loops: self.points as usize };
                let found = search.run(scenario, stop_requested);
                let case = found.map_err(|error| CliError::worst_case(&scenario.name, error))?;
                Ok((case, Some(RequiredLimit::from_contrast(own))))
            })
            .collect()
    }

    /// Returns the guaranteed ranges of the claims of a scenario, which stand beside its requirements.
    fn claims(&self, scenario: &Scenario) -> Result<Option<OutputBounds>, CliError> {
        let stands =
            !scenario.written.bound.is_empty() && self.metric.is_none() && self.requirement.is_none();
        stands.then(|| bound::claims(scenario, self.output.choice.units())).transpose()
    }
}

impl WorstCases {
    fn write_witness(&self, path: &Path, force: bool) -> Result<(), CliError> {
        let Some((case, _)) = self.cases.first() else { return Ok(()) };
        files::write(path, case.witness.self_contained().to_toml().as_bytes(), force)?;
        say!("{}: the worst case of {}", path.display(), case.quantity);
        Ok(())
    }

    /// Fails if a requirement is not met at its worst point, or a claim is not proved.
    fn require_met(&self) -> Result<(), CliError> {
        let (mut all, mut missed) = (0, Vec::new());
        for (case, requirement) in &self.cases {
            let Some(requirement) = requirement else { continue };
            all += 1;
            if !requirement.is_met(case.value()) {
                missed.push(case.quantity.as_str());
            }
        }
        if missed.is_empty() {
            return self.bounds.as_ref().map_or(Ok(()), OutputBounds::require_proved);
        }
        let (count, all) = (missed.len(), counted(all, "requirement"));
        let names = missed.join(", ");
        Err(CliError::Requirements(format!(
            "{}: {count} of {all} not met in the worst case: {names}",
            self.name
        )))
    }

    fn print_case(&self, case: &WorstCase, requirement: Option<&RequiredLimit>) {
        let values = [case.nominal(), case.value()];
        let limit = requirement.map(|requirement| requirement.limit);
        let finite: Vec<f64> =
            values.iter().copied().chain(limit).filter(|value| value.is_finite()).collect();
        let (factor, unit) = self.units.common(&finite, &case.unit);
        let text = |value: f64| {
            if value.is_nan() {
                "no value".to_owned()
            } else {
                format!("{} {unit}", digits(value * factor)).trim_end().to_owned()
            }
        };
        let judged = requirement.map_or_else(String::new, |requirement| {
            let word = if requirement.is_met(case.value()) { "met" } else { "missed" };
            format!(", {} {}: {word}", requirement.bound(), text(requirement.limit))
        });
        let unstable = if case.is_unstable { ", where the loop is not stable" } else { "" };
        say!(
            "  {}   nominal {}, worst {}{unstable}{judged}",
            case.quantity,
            text(values[0]),
            text(values[1])
        );
        let keys = case.ranges.keys.iter().zip(case.key_values(case.worst));
        let row = |(own, value): (&UncertainKey, f64)| {
            json!({
                "key": own.key, "nominal": own.nominal_number(), "worst": value, "range": own.limits(),
                "unit": case.witness.unit_of(&own.key),
                "written": case.witness.written_unit(&own.key),
            })
        };
        print_rows(&keys.map(row).collect::<Vec<_>>(), &KEYS, self.units);
        if case.failed > 0 {
            let why =
                case.first_failure.as_ref().map_or_else(String::new, |why| format!("; the first: {why}"));
            say!("  {} without a value{why}", counted(case.failed, "point"));
        }
    }
}

impl Results for WorstCases {
    fn json(&self) -> Vec<Json> {
        let case = |(case, requirement): &(WorstCase, Option<RequiredLimit>)| {
            let mut object = json!(case.report());
            if let Some(requirement) = requirement {
                object["limit"] = json!(requirement.limit);
                object["met"] = json!(requirement.is_met(case.value()));
            }
            object
        };
        let cases: Vec<Json> = self.cases.iter().map(case).collect();
        let mut object = json!({ "cases": cases });
        if let Some(bounds) = &self.bounds {
            object["bounds"] = bounds.claims_json();
        }
        vec![with_scenario_name(&self.name, object)]
    }

    fn figures(&self) -> Vec<Named> {
        let each = self.cases.iter().enumerate();
        each.map(|(index, (case, requirement))| {
            let number = if index == 0 { String::new() } else { format!("-{}", index + 1) };
            let name = format!("{}-worst{number}", self.name);
            (name, figures::figure(&self.name, case, requirement.as_ref()))
        })
        .collect()
    }

    fn table(&self) -> Option<NumberTable> {
        let (first, _) = self.cases.first()?;
        let keys = first.ranges.keys.iter().map(|own| own.key.clone());
        let columns = ["case", "point", "value"].map(str::to_owned).into_iter().chain(keys).collect();
        let rows = self.cases.iter().enumerate().flat_map(|(number, (case, _))| {
            (0..case.points.len()).map(move |point| {
                let value = case.points[point].assessed.value;
                let head =
                    [Some(number as f64), Some(point as f64), Some(value).filter(|value| value.is_finite())];
                head.into_iter().chain(case.key_values(point).into_iter().map(Some)).collect()
            })
        });
        Some(NumberTable { columns, rows: rows.collect() })
    }

    fn print(&self) -> Result<(), CliError> {
        let points: usize = self.cases.iter().map(|(case, _)| case.points.len()).sum();
        if let Some((first, _)) = self.cases.first() {
            say!(
                "{}   worst of {} over {}",
                self.name,
                counted(points, "point"),
                counted(first.ranges.keys.len(), "uncertain key"),
            );
        }
        for (case, requirement) in &self.cases {
            self.print_case(case, requirement.as_ref());
        }
        if let Some(bounds) = &self.bounds {
            say!("{}   guaranteed ranges of [[bound]], in which no law acts", self.name);
            bounds.print_claims();
        }
        Ok(())
    }
}
