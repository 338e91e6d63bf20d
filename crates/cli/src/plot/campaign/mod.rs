//! Figures of a campaign's directory, and its worst runs.

mod curve;
mod distribution;
mod explorer;
mod fan;
mod metric_column;
mod parts;
mod region;
mod scatter;
mod table;
mod text_cells;
mod worst;

use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;

use flexsc_core::campaign::{ColumnCells, MAIN_METRICS, RowMaker};
use flexsc_figure::{Figure, Named};

use super::PlotArgs;
use super::figure_kind::{CampaignFigure, FigureKind, select};
use super::figure_name::FigureName;
use crate::error::CliError;
use crate::figure_files::FigureTarget;
use crate::{out, print, say};
use metric_column::MetricColumn;
use table::CampaignRuns;

/// Largest number of metrics that are drawn if none is named.
const MOST: usize = 4;
/// Number of worst runs that are listed for each metric.
const WORST: usize = 3;

pub fn run(args: &PlotArgs) -> Result<(), CliError> {
    let directory = args.path.as_path();
    if let Some(out) = args.out.as_deref().filter(|out| out::ending(out) == Some("html")) {
        return explore(args, out);
    }
    let target = FigureTarget::new(args.out.as_deref().unwrap_or(directory), args.format, &[], args.force)?;
    let files = files(directory)?;
    let tables = tables(args, &files)?;
    let (asked, topics) = FigureName::split(&args.what);
    if let Some(topic) = topics.first() {
        let path = directory.display();
        return Err(CliError::Arguments(format!("--what: {topic} is for logs, and {path} is a directory")));
    }
    let fans = if asked.is_empty() || asked.contains(&FigureKind::Campaign(CampaignFigure::Fan)) {
        fan::logs(directory, &files, tables.is_empty() || !asked.is_empty())?
    } else {
        BTreeMap::new()
    };
    if tables.is_empty() && fans.is_empty() {
        return Err(CliError::Arguments(format!(
            "{}: no campaign, neither parts nor a table `runs.csv`, and not several logs of one scenario\n\n\
             hint: `flexsc simulate SCENARIO --runs 1000 -o {}` makes one",
            directory.display(),
            directory.display()
        )));
    }
    let mut available: Vec<FigureKind> = tables.iter().flat_map(drawable).collect();
    available.extend((!fans.is_empty()).then_some(FigureKind::Campaign(CampaignFigure::Fan)));
    let all = select(&asked, &available).map_err(|(missing, there)| {
        let path = directory.display();
        CliError::Arguments(format!("{path}: there is no figure `{missing}` for it\n\nhint: it has {there}"))
    })?;
    let mut figures = Vec::new();
    for runs in &tables {
        let metrics = metrics(&args.metric, &args.path, runs)?;
        let natural = natural(runs);
        let wanted = |kind: &&FigureKind| !asked.is_empty() || natural.contains(kind);
        for kind in drawable(runs).iter().filter(|kind| all.contains(kind)).filter(wanted) {
            figures.extend(drawn(*kind, runs, &metrics));
        }
        let listed = if args.json { worst::lines } else { worst::table };
        let worst = args.worst.unwrap_or(WORST);
        if worst > 0 {
            print(listed(runs, directory, &metrics, worst).as_bytes())?;
        }
        if runs.scenario.is_none() && !args.json {
            say!(
                "{}: no scenario.toml beside the table: no run can be repeated from it",
                directory.display()
            );
        }
    }
    for (name, paths) in &fans {
        figures.push((format!("{name}-fan"), fan::figure(name, paths)?));
    }
    if figures.is_empty() {
        return Err(CliError::Arguments(format!(
            "{}: no metric varies from run to run\n\nhint: --metric NAME draws one anyway",
            directory.display()
        )));
    }
    target.save(&args.look.finished(figures)?, args.look.style()?, args.json)
}

/// Returns the campaigns of a directory: those of tables, then those of parts.
fn tables(args: &PlotArgs, files: &[String]) -> Result<Vec<CampaignRuns>, CliError> {
    let mut tables = table::read(&args.path, files, &args.metric)?;
    tables.extend(parts::read(&args.path, files, &args.metric)?);
    Ok(tables)
}

/// Writes the explorer of the campaign in a directory.
fn explore(args: &PlotArgs, out: &Path) -> Result<(), CliError> {
    let directory = args.path.as_path();
    let tables = tables(args, &files(directory)?)?;
    let [runs] = &tables[..] else {
        let why = format!("has {} campaigns, and an explorer shows one", tables.len());
        return Err(CliError::Arguments(format!("{}: {why}", directory.display())));
    };
    let page = explorer::page(runs, directory, args.look.units.units.0)?;
    crate::files::write(out, page.as_bytes(), args.force)?;
    say!("{} ({:.0} kB)", out.display(), page.len() as f64 / 1e3);
    Ok(())
}

/// Returns figures of a campaign from its columns: of one kind, or the default ones.
pub fn column_figures(
    work: &RowMaker,
    column: &dyn Fn(&str) -> Option<ColumnCells>,
    kind: Option<FigureKind>,
    metric: &[String],
) -> Result<Vec<Named>, CliError> {
    let path = Path::new(&work.campaign.scenario().name);
    let read = |names: &[&str]| Ok(names.iter().map(|name| column(name)).collect());
    run_figures(&parts::campaign_runs(work, read, path, metric)?, kind.as_slice(), metric, path)
}

/// Returns the figures of the campaigns in a directory, and of its logs.
pub fn directory_figures(
    directory: &Path,
    kinds: &[FigureKind],
    metric: &[String],
) -> Result<Vec<Named>, CliError> {
    let files = files(directory)?;
    let mut tables = table::read(directory, &files, metric)?;
    tables.extend(parts::read(directory, &files, metric)?);
    let mut figures = Vec::new();
    if kinds.is_empty() || kinds.iter().any(|kind| *kind != FigureKind::Campaign(CampaignFigure::Fan)) {
        for runs in &tables {
            figures.extend(run_figures(runs, kinds, metric, directory)?);
        }
    }
    if kinds.is_empty() || kinds.contains(&FigureKind::Campaign(CampaignFigure::Fan)) {
        for (name, paths) in fan::logs(directory, &files, false)? {
            figures.push((format!("{name}-fan"), fan::figure(&name, &paths)?));
        }
    }
    Ok(figures)
}

fn run_figures(
    runs: &CampaignRuns,
    kinds: &[FigureKind],
    metric: &[String],
    path: &Path,
) -> Result<Vec<Named>, CliError> {
    let (metrics, natural, all) = (metrics(metric, path, runs)?, natural(runs), drawable(runs));
    let kinds = if kinds.is_empty() { &natural } else { kinds };
    if let Some(missing) = kinds.iter().find(|kind| !all.contains(kind)) {
        let names: Vec<_> = all.iter().map(|kind| kind.name()).collect();
        return Err(CliError::Arguments(format!(
            "{}: there is no figure `{}` for it\n\nhint: it has {}",
            path.display(),
            missing.name(),
            names.join(", ")
        )));
    }
    Ok(all.iter().filter(|kind| kinds.contains(kind)).flat_map(|kind| drawn(*kind, runs, &metrics)).collect())
}

/// Returns the sorted names of the files in a directory.
fn files(directory: &Path) -> Result<Vec<String>, CliError> {
    let unread = |error: std::io::Error| CliError::Arguments(format!("{}: {error}", directory.display()));
    let entries =
        std::fs::read_dir(directory).map_err(unread)?.collect::<Result<Vec<_>, _>>().map_err(unread)?;
    let mut names: Vec<String> =
        entries.into_iter().map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    Ok(names)
}

/// Returns the kinds of figures that a table has data for.
fn drawable(runs: &CampaignRuns) -> Vec<FigureKind> {
    let swept = runs.swept().len();
    [
        (FigureKind::Campaign(CampaignFigure::Curve), swept == 1),
        (FigureKind::Campaign(CampaignFigure::Region), swept == 2),
        (FigureKind::Campaign(CampaignFigure::Distribution), true),
        (FigureKind::Campaign(CampaignFigure::Scatter), !scatter::keys(runs).is_empty()),
    ]
    .into_iter()
    .filter_map(|(kind, is)| is.then_some(kind))
    .collect()
}

/// Returns the kinds of figures that are drawn if none is named.
fn natural(runs: &CampaignRuns) -> Vec<FigureKind> {
    let wanted = match runs.swept().len() {
        1 => vec![FigureKind::Campaign(CampaignFigure::Curve)],
        2 => vec![FigureKind::Campaign(CampaignFigure::Region)],
        _ => vec![
            FigureKind::Campaign(CampaignFigure::Distribution),
            FigureKind::Campaign(CampaignFigure::Scatter),
        ],
    };
    let drawable = drawable(runs);
    wanted.into_iter().filter(|kind| drawable.contains(kind)).collect()
}

/// Returns the named metrics, or else the main ones that vary.
fn metrics<'a>(
    requested: &[String],
    path: &Path,
    runs: &'a CampaignRuns,
) -> Result<Vec<&'a MetricColumn>, CliError> {
    let named = |name: &str| runs.metrics.iter().find(|metric| metric.is_named(name));
    if requested.is_empty() {
        // A metric that only repeats a key is left out.
        let is_informative = |metric: &&MetricColumn| {
            metric.varies() && runs.keys.iter().all(|key| key.values != metric.values)
        };
        // Requirements come first.
        let (columns, limited) = runs.requirements();
        let column = |name: &String| runs.metrics.iter().find(|metric| metric.name == *name);
        let required: Vec<_> = columns.iter().filter_map(column).filter(is_informative).collect();
        let most = MOST.max(required.len());
        let others = MAIN_METRICS.into_iter().filter(|name| !limited.iter().any(|limited| limited == name));
        let main: Vec<_> =
            required.into_iter().chain(others.filter_map(named).filter(is_informative)).collect();
        let any = runs.metrics.iter().filter(is_informative);
        let found: Vec<_> = if main.is_empty() { any.collect() } else { main };
        return Ok(found.into_iter().take(most).collect());
    }
    let metric = |name: &String| {
        named(name).ok_or_else(|| {
            let names: Vec<_> = runs.metrics.iter().map(MetricColumn::title).collect();
            let (path, names) = (path.display(), names.join(", "));
            CliError::Arguments(format!(
                "{path}: there is no metric `{name}` that is a number\n\nhint: it has {names}"
            ))
        })
    };
    requested.iter().map(metric).collect()
}

/// Returns the figures of a kind, with their names.
fn drawn(kind: FigureKind, runs: &CampaignRuns, metrics: &[&MetricColumn]) -> Vec<(String, Figure)> {
    let name = |metric: &MetricColumn| format!("{}-{}-{}", runs.name, kind.name(), metric.file_name());
    let each = |figure: &dyn Fn(&MetricColumn) -> Option<Figure>| {
        metrics.iter().filter_map(|metric| Some((name(metric), figure(metric)?))).collect()
    };
    match kind {
        FigureKind::Campaign(CampaignFigure::Distribution) => {
            each(&|metric| Some(distribution::figure(runs, metric)))
        }
        FigureKind::Campaign(CampaignFigure::Scatter) => each(&|metric| Some(scatter::figure(runs, metric))),
        FigureKind::Campaign(CampaignFigure::Region) => each(&|metric| region::figure(runs, metric)),
        FigureKind::Campaign(CampaignFigure::Curve) => {
            let key = runs.swept().into_iter().next().filter(|_| !metrics.is_empty());
            let curve = key.map(|key| curve::figure(runs, metrics, key));
            curve.map(|figure| (format!("{}-{}", runs.name, kind.name()), figure)).into_iter().collect()
        }
        _ => Vec::new(),
    }
}
