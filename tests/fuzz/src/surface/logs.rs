//! Logs: short runs, with other schemas, messages, records and bytes; and the tables of campaigns.

use std::io::{self, Cursor};

use flexsc_core::Scenario;
use flexsc_core::campaign::{Campaign, CampaignRun};
use flexsc_core::record::{Detail, LogBytes, RunEnd};
use flexsc_view::scene::Scene;
use flexsc_view::with_layout;
use prost::Message as _;
use prost_types::field_descriptor_proto::{Label, Type};
use prost_types::{
    DescriptorProto, FieldDescriptorProto, FileDescriptorProto, FileDescriptorSet, MessageOptions,
};

use super::records::{self, Record, op};
use super::{Seeds, scenarios, wire};
use crate::case::Case;
use crate::chance::Chance;
use crate::{mutate, nasty};

/// Scenarios of the logs, with their settings and details.
const RUNS: &[(&str, &str, Detail)] = &[
    ("relay-adaptive", "40.0", Detail::Full),
    ("rotation-sine", "1.0", Detail::Full),
    ("wheel-ekf", "2.0", Detail::Scene),
    ("iss-ringdown", "2.0", Detail::Scene),
    ("relay-fixed", "30.0", Detail::Events),
];
const TOPICS: &[&str] = &[
    "/attitude",
    "/command",
    "/metrics",
    "/params",
    "/tf",
    "/scene",
    "/torque",
    "/estimate",
    "/x",
    "/pointing",
    "/vibrations",
    "/modes",
];
/// Files of a whole run.
const HANDED_OVER: &[&str] = &["a.aem", "a.oem", "a.glb", "a.bin"];
const TABLE: &str = "run,seed,law.relay.k_t,settled,peak_torque_nm,settling_time_s,why\n\
    0,7,0.31,true,1.5,58.09,\n1,8,0.312,false,1.25,,\n2,9,0.309,true,1e-3,50.0,\n";

/// Logs of short runs, not compressed; of one also as it is written.
pub fn seeds(seeds: &Seeds) -> io::Result<Vec<Vec<u8>>> {
    let mut logs = Vec::new();
    for (name, duration, detail) in RUNS {
        let Some((_, text, _)) = seeds.scenarios.iter().find(|(n, ..)| n == name) else { continue };
        let text = text.lines().map(|line| {
            if line.starts_with("duration") { format!("duration = {duration}") } else { line.to_owned() }
        });
        let text = text.collect::<Vec<_>>().join("\n");
        let log = logged(&text, *detail).map_err(io::Error::other)?;
        logs.push(plain(&log).map_err(io::Error::other)?);
        if logs.len() == 1 {
            logs.push(log);
        }
    }
    Ok(logs)
}

fn logged(text: &str, detail: Detail) -> Result<Vec<u8>, Box<dyn std::error::Error + Send + Sync>> {
    let scenario = Scenario::parse("s.toml", text)?;
    let study = Campaign::new(scenario, "s.toml", None)?;
    let run = CampaignRun::new(study.scenario().clone(), 0);
    let from = with_layout(Campaign::provenance(&run), &run.scenario, detail);
    let mut log = LogBytes::new(&from, detail)?;
    let metrics = Campaign::simulate(&run, (&mut log, Scene::for_detail(&run.scenario, detail)))?;
    Ok(log.finish(&metrics, RunEnd::Complete)?)
}

/// Returns a log without compression.
pub fn plain(log: &[u8]) -> mcap::McapResult<Vec<u8>> {
    let options = mcap::WriteOptions::new().compression(None).chunk_size(Some(1 << 14)).library("flexsc");
    let mut writer = mcap::Writer::with_options(Cursor::new(Vec::new()), options)?;
    let summary = mcap::Summary::read(log)?.unwrap_or_default();
    for index in &summary.attachment_indexes {
        writer.attach(&mcap::read::attachment(log, index)?)?;
    }
    for index in &summary.metadata_indexes {
        writer.write_metadata(&mcap::read::metadata(log, index)?)?;
    }
    // A few of each topic are as good as all.
    let mut count = std::collections::BTreeMap::new();
    for message in mcap::MessageStream::new(log)? {
        let message = message?;
        let seen = count.entry(message.channel.topic.clone()).or_insert(0);
        *seen += 1;
        if *seen <= 12 {
            writer.write(&message)?;
        }
    }
    writer.finish()?;
    Ok(writer.into_inner().into_inner())
}

pub fn make(logs: &[Vec<u8>], seeds: &Seeds, chance: &mut Chance) -> Case {
    if chance.percent(8) {
        return campaign(seeds, chance);
    }
    let topic = chance.one(TOPICS);
    let command = match chance.below(20) {
        0..5 => format!("export l.mcap --topic {topic}"),
        5 => format!("export l.mcap --topic {topic} --format jsonl -o t.jsonl"),
        6 => "export l.mcap".to_owned(),
        7..10 => "plot l.mcap -o out --format svg".to_owned(),
        10 => "plot l.mcap -o out --json".to_owned(),
        11 => "layout l.mcap -o l.json".to_owned(),
        12 => "log scenario l.mcap".to_owned(),
        13 => "log recover l.mcap --json".to_owned(),
        14..16 => "log recover l.mcap -o r.mcap".to_owned(),
        _ => format!("export l.mcap --epoch 2026-01-01T00:00:00Z -o {}", chance.one(HANDED_OVER)),
    };
    Case::new(&command, vec![("l.mcap".to_owned(), log(logs, seeds, topic, chance))])
}

/// The directory of a campaign.
fn campaign(seeds: &Seeds, chance: &mut Chance) -> Case {
    let mut table = TABLE.to_owned();
    for _ in 0..chance.times() {
        mutate::number(&mut table, chance);
    }
    let mut table = table.into_bytes();
    if chance.percent(60) {
        mutate::bytes(&mut table, chance);
    }
    let scenario = if chance.percent(50) {
        scenarios::text(seeds, chance)
    } else {
        seeds.scenarios[chance.below(seeds.scenarios.len())].1.clone().into_bytes()
    };
    let name = chance.one(&["runs.csv", "runs-0-3.csv"]);
    let files = vec![(format!("c/{name}"), table), ("c/scenario.toml".to_owned(), scenario)];
    Case::new(
        chance.one(&[
            "plot c -o out --format svg",
            "plot c --json --worst 2",
            "plot c -o f.svg --metrics settling_time_s",
        ]),
        files,
    )
}

/// A log that is no longer right.
fn log(logs: &[Vec<u8>], seeds: &Seeds, topic: &str, chance: &mut Chance) -> Vec<u8> {
    let mut bytes = logs[chance.below(logs.len())].clone();
    if chance.percent(85) {
        let mut records = records::read(&bytes);
        for _ in 0..chance.times() {
            change(&mut records, seeds, topic, chance);
        }
        bytes = records::seal(&records);
    }
    match chance.below(10) {
        // Checksums are removed, so that changed bytes are read.
        0 | 1 => {
            let mut records = records::read(&bytes);
            let offsets: Vec<_> = (0..records.len())
                .filter(|i| records[*i].op >= op::CHUNK_INDEX || records[*i].op == op::FOOTER)
                .collect();
            let which = chance.below(offsets.len());
            if let Some(index) = offsets.get(which) {
                overwrite(&mut records[*index].body, chance);
            }
            bytes = unsealed(&records);
        }
        2 => mutate::bytes(&mut bytes, chance),
        _ => {}
    }
    bytes
}

/// The file of records as they are: offsets lie.
fn unsealed(records: &[Record]) -> Vec<u8> {
    let mut bytes = records::seal(records);
    let whole = records::read(&bytes);
    // Written over in place, where lengths agree.
    let mut at = mcap::MAGIC.len();
    for (record, sealed) in records.iter().zip(&whole) {
        let length = records::number(&bytes, at + 1).unwrap_or(0) as usize;
        at += 9;
        if record.op >= op::CHUNK_INDEX || record.op == op::FOOTER {
            let same = record.body.len() == sealed.body.len();
            if same && let Some(place) = bytes.get_mut(at..at + length) {
                place.copy_from_slice(&record.body);
            }
        }
        at += length;
    }
    bytes
}

/// A number somewhere in a record.
fn overwrite(body: &mut [u8], chance: &mut Chance) {
    let (at, width) = (chance.below(body.len()), [2, 4, 8, 8][chance.below(4)]);
    // Most fields begin at a multiple of their width.
    let at = if chance.percent(60) { at / width * width } else { at };
    let value = nasty::whole(chance, records::number(body, at).unwrap_or(0)).to_le_bytes();
    for (byte, new) in body.iter_mut().skip(at).zip(&value[..width]) {
        *byte = *new;
    }
}

fn change(records: &mut Vec<Record>, seeds: &Seeds, topic: &str, chance: &mut Chance) {
    if records.is_empty() {
        return;
    }
    let index = chance.below(records.len());
    if !records[index].within.is_empty() && chance.percent(85) {
        return change(&mut records[index].within, seeds, topic, chance);
    }
    // Half of the time, a schema or a message.
    let wanted: Vec<_> =
        (0..records.len()).filter(|i| matches!(records[*i].op, op::SCHEMA | op::MESSAGE)).collect();
    let schemas: Vec<_> = wanted.iter().copied().filter(|i| records[*i].op == op::SCHEMA).collect();
    let index = match chance.below(8) {
        0..4 if !schemas.is_empty() => schemas[chance.below(schemas.len())],
        4 | 5 if !wanted.is_empty() => wanted[chance.below(wanted.len())],
        _ => index,
    };
    match chance.below(12) {
        0 => drop(records.remove(index)),
        1 => {
            let again = records[index].clone();
            records.insert(chance.below(records.len()), again);
        }
        2 => {
            let other = chance.below(records.len());
            records.swap(index, other);
        }
        3 => overwrite(&mut records[index].body, chance),
        4 => records[index].op = chance.below(17) as u8,
        _ => inside(&mut records[index], seeds, topic, chance),
    }
}

/// Changes what a record holds, by what it is.
fn inside(record: &mut Record, seeds: &Seeds, topic: &str, chance: &mut Chance) {
    let body = &mut record.body;
    match record.op {
        op::SCHEMA => {
            let Some(name) = records::string(body, 2) else { return };
            let Some(encoding) = records::string(body, name.end) else { return };
            let Some(data) = records::string(body, encoding.end) else { return };
            let mut schema = body[data.clone()].to_vec();
            if chance.percent(25) {
                schema = odd_schema(&String::from_utf8_lossy(&body[name]), chance);
            }
            if chance.percent(80) {
                wire::change(&mut schema, chance);
            }
            body.truncate(encoding.end);
            body.extend((schema.len() as u32).to_le_bytes());
            body.extend(schema);
        }
        op::MESSAGE if body.len() >= 22 => {
            let mut data = body.split_off(22);
            wire::change(&mut data, chance);
            body.extend(data);
        }
        op::CHANNEL => {
            let Some(name) = records::string(body, 4) else { return };
            let rest = body.split_off(name.end);
            let new = if chance.percent(50) { topic.to_owned() } else { nasty::leaf(chance) };
            body.truncate(4);
            body.extend((new.len() as u32).to_le_bytes());
            body.extend(new.into_bytes());
            body.extend(rest);
        }
        op::ATTACHMENT => {
            let Some(name) = records::string(body, 16) else { return };
            let Some(media) = records::string(body, name.end) else { return };
            let data = if &body[name] == b"scenario.toml" && chance.percent(70) {
                scenarios::text(seeds, chance)
            } else {
                let mut data = body.get(media.end + 8..body.len() - 4).unwrap_or_default().to_vec();
                mutate::bytes(&mut data, chance);
                data
            };
            body.truncate(media.end);
            body.extend((data.len() as u64).to_le_bytes());
            body.extend(data);
            body.extend([0; 4]);
        }
        _ => mutate::bytes(body, chance),
    }
}

/// A schema of a kind that our logs do not have: messages within themselves, maps, every type of number, and deep ones.
fn odd_schema(name: &str, chance: &mut Chance) -> Vec<u8> {
    let (package, short) = name.rsplit_once('.').unwrap_or(("", name));
    let full =
        |name: &str| if package.is_empty() { format!(".{name}") } else { format!(".{package}.{name}") };
    let field =
        |name: &str, number: i32, kind: Type, repeated: bool, of: Option<String>| FieldDescriptorProto {
            name: Some(name.to_owned()),
            number: Some(number),
            label: Some(if repeated { Label::Repeated } else { Label::Optional } as i32),
            r#type: Some(kind as i32),
            type_name: of,
            ..Default::default()
        };
    let count = [1, 3, 30, 300][chance.below(4)];
    let kinds = [
        Type::Double,
        Type::Float,
        Type::Int64,
        Type::Uint64,
        Type::Int32,
        Type::Fixed64,
        Type::Bool,
        Type::String,
        Type::Bytes,
        Type::Sint64,
    ];
    let mut message = DescriptorProto { name: Some(short.to_owned()), ..Default::default() };
    for number in 1..=count {
        let repeated = chance.percent(30);
        let new = match chance.below(4) {
            0 => field(&format!("f{number}"), number, Type::Message, repeated, Some(full(short))),
            1 => field(
                &format!("f{number}"),
                number,
                Type::Message,
                true,
                Some(format!("{}.Entry", full(short))),
            ),
            2 => field(
                &format!("f{number}"),
                number,
                Type::Message,
                repeated,
                Some(full(&format!("M{}", chance.below(20)))),
            ),
            _ => field(&format!("f{number}"), number, kinds[chance.below(kinds.len())], repeated, None),
        };
        message.field.push(new);
    }
    message.nested_type.push(DescriptorProto {
        name: Some("Entry".to_owned()),
        field: vec![
            field("key", 1, Type::String, false, None),
            field("value", 2, Type::Message, false, Some(full(short))),
        ],
        options: Some(MessageOptions { map_entry: Some(chance.percent(80)), ..Default::default() }),
        ..Default::default()
    });
    let mut file = FileDescriptorProto {
        name: Some("odd.proto".to_owned()),
        package: Some(package.to_owned()),
        syntax: Some(chance.one(&["proto3", "proto2"]).to_owned()),
        message_type: vec![message],
        ..Default::default()
    };
    // Each holds several of the next: a small schema with very many leaves.
    let width = [1, 2, 10][chance.below(3)];
    for level in 0..20 {
        let next = if level < 19 { full(&format!("M{}", level + 1)) } else { full("M0") };
        let leaf = level == 19 && chance.percent(70);
        let inner = (1..=width).map(|n| {
            let (kind, of) = if leaf { (Type::Double, None) } else { (Type::Message, Some(next.clone())) };
            field(&format!("f{n}"), n, kind, false, of)
        });
        file.message_type.push(DescriptorProto {
            name: Some(format!("M{level}")),
            field: inner.collect(),
            ..Default::default()
        });
    }
    FileDescriptorSet { file: vec![file] }.encode_to_vec()
}
