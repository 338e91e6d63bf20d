//! Logs of runs under external commands, with other commands in their `commands.csv`.

use std::fmt::Write as _;
use std::io;

use flexsc_core::Scenario;
use flexsc_core::campaign::{Campaign, CampaignRun, CommandLog};
use flexsc_core::control::law::Command;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{COMMANDS, Detail, LogBytes, RunEnd};
use flexsc_view::with_layout;

use super::records::{self, Record, op};
use super::{Seeds, logs, structures};
use crate::case::Case;
use crate::chance::Chance;
use crate::nasty;

/// Scenarios of the logs, with a period of commands (s): one axis and three.
const RUNS: [(&str, f64); 2] = [("wheel-fixed-gain", 0.5), ("earth-observer", 0.25)];
const DURATION: f64 = 5.0;
const VERBS: &[&str] = &[
    "plot l.mcap -o out --format svg",
    "plot l.mcap -o out --format svg",
    "plot l.mcap --json",
    "export l.mcap -o a.oem --epoch 2026-01-01T00:00:00Z",
    "layout l.mcap -o l.json",
    "log scenario l.mcap",
    "log recover l.mcap -o r.mcap",
];
const QUANTITIES: &[&str] = &["torque", "rate_change", "acceleration", "moment", "force", ""];

/// Logs of commanded runs.
pub fn seeds(seeds: &Seeds) -> io::Result<Vec<Vec<u8>>> {
    let text =
        |name: &str| seeds.scenarios.iter().find(|(shipped, ..)| shipped == name).map(|(_, text, _)| text);
    let logs = RUNS.into_iter().filter_map(|(name, period)| Some(logged(text(name)?, period)));
    logs.collect::<Result<_, _>>().map_err(io::Error::other)
}

fn logged(text: &str, period: f64) -> Result<Vec<u8>, Box<dyn std::error::Error + Send + Sync>> {
    let lines = text.lines().map(|line| {
        if line.starts_with("duration") { format!("duration = {DURATION}") } else { line.to_owned() }
    });
    let scenario = Scenario::parse("s.toml", &lines.collect::<Vec<_>>().join("\n"))?;
    let study = Campaign::new(scenario, "s.toml", None)?;
    let run = CampaignRun::new(study.scenario().clone(), 0);
    let mut commands = CommandLog::default();
    for cycle in 0..(DURATION / period) as u32 {
        let value = 1e-3 * f64::from(cycle % 3);
        commands.push(
            Instant::START + Span::from_seconds(f64::from(cycle) * period),
            [Command::Torque(value); 3],
        );
    }
    let from = with_layout(commands.provenance(&run), &run.scenario, Detail::Full);
    let mut log = LogBytes::new(&from, Detail::Full)?;
    let metrics = commands.simulate(&run, Instant::END, &mut log)?;
    Ok(logs::plain(&log.finish(&metrics, RunEnd::Complete)?)?)
}

pub fn make(logs: &[Vec<u8>], chance: &mut Chance) -> Case {
    let mut records = records::read(&logs[chance.below(logs.len())]);
    let commands =
        records.iter_mut().find(|record| name_and_data(record).is_some_and(|(name, _)| name == COMMANDS));
    if let Some(record) = commands {
        let (_, data) = name_and_data(record).unwrap_or_default();
        let table =
            if chance.percent(50) { table(chance).into_bytes() } else { structures::spoilt(&data, chance) };
        let end = record.body.len() - data.len() - 12;
        record.body.truncate(end);
        record.body.extend((table.len() as u64).to_le_bytes());
        record.body.extend(table);
        record.body.extend([0; 4]);
    }
    Case::new(chance.one(VERBS), vec![("l.mcap".to_owned(), records::seal(&records))])
}

/// The name and the content of an attachment.
fn name_and_data(record: &Record) -> Option<(String, String)> {
    if record.op != op::ATTACHMENT {
        return None;
    }
    let name = records::string(&record.body, 16)?;
    let media = records::string(&record.body, name.end)?;
    let data = record.body.get(media.end + 8..record.body.len() - 4)?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Some((text(&record.body[name]), text(data)))
}

/// A table of commands at any instants, with any values.
fn table(chance: &mut Chance) -> String {
    let has_quantities = chance.percent(60);
    let mut text = "time_whole_s,time_fs,x,y,z".to_owned();
    if has_quantities {
        text += ",x_quantity,y_quantity,z_quantity";
    }
    let (mut second, mut part) = (0_u64, 0_u64);
    for _ in 0..[0, 1, 4, 30, 2000][chance.below(5)] {
        part += 1 + chance.number() % 400_000_000_000_000;
        if chance.percent(4) {
            second = nasty::whole(chance, second);
        }
        if part >= 1_000_000_000_000_000 && chance.percent(98) {
            (second, part) = (second.wrapping_add(1), part % 1_000_000_000_000_000);
        }
        let mut number = || if chance.percent(90) { "1e-4" } else { nasty::number(chance) };
        let values = [number(), number(), number()].join(",");
        let _ = write!(text, "\n{second},{part},{values}");
        if has_quantities {
            let quantity = chance.one(QUANTITIES);
            let _ = write!(text, ",{quantity},{quantity},torque");
        }
    }
    text + "\n"
}
