//! Logs: topics as tables, good MCAP, small, and made again from what they hold.

use std::collections::BTreeMap;

use serde_json::Value as Json;

use crate::util::{Dir, end};

#[test]
fn topics_are_exported() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.run("simulate relay-fixed.toml").exits(0);
    let topics = dir.run("export relay-fixed.mcap").printed();
    let topics: Vec<_> = topics.lines().collect();
    assert_eq!(topics, ["/command", "/envelope_mean", "/law", "/log", "/metrics", "/params", "/summary"]);
    let ran = dir
        .run("export relay-fixed.mcap --topic /comand")
        .exits(2)
        .says(&["no topic `/comand`"])
        .says(&topics);
    assert!(ran.out.is_empty());

    let csv = dir.run("export relay-fixed.mcap --topic /command").printed();
    let (header, rows) = csv.split_once('\n').expect("lines");
    assert_eq!(header, "time_s,state,cause,torque_nm,angle_rad,rate_rad_s,gain");
    assert_eq!(rows.lines().count(), 2719);
    for row in rows.lines() {
        let (whole, part) = row.split(',').next().and_then(|time| time.split_once('.')).expect("a time");
        assert!(whole.parse::<u64>().is_ok() && part.len() == 15 && part.parse::<u64>().is_ok(), "{row}");
    }
    dir.run("export relay-fixed.mcap --topic /command -o command.csv").exits(0);
    assert_eq!(dir.text("command.csv"), csv);

    let lines = dir.run("export relay-fixed.mcap --topic /command --format jsonl").printed();
    let rows: Vec<Json> = lines.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!(rows.len(), 2719);
    assert!(rows.iter().all(|row| row["time_s"].is_f64() && row["state"].is_string()));
    dir.run("export relay-fixed.mcap --topic /command -o relay-fixed.toml/x.csv")
        .exits(1)
        .says(&["relay-fixed.toml"]);
}

/// A log is made anew from the scenario that it holds.
#[test]
fn a_log_makes_itself_again() {
    let dir = Dir::with(&["relay-fixed", "relay-adaptive"]);
    for name in ["relay-fixed", "relay-adaptive"] {
        let set = "--set duration=3000 --set epoch=2026-03-20T14:46:00Z --seed 5 --log full";
        dir.run(&format!("simulate {name}.toml -o first {set}")).exits(0);
        let toml = dir.run(&format!("log scenario first/{name}.mcap")).printed();
        assert!(toml.contains("\nepoch = 2026-03-20T14:46:00Z\n"), "{toml}");
        dir.write("again.toml", &toml);
        dir.run("simulate again.toml -o second --log full").exits(0);
        let (first, second) = (format!("first/{name}.mcap"), format!("second/{name}.mcap"));
        assert!(dir.read(&first) == dir.read(&second), "{name} differs");
    }
}

#[test]
fn logs_are_good_mcap() {
    let dir = Dir::with(&["relay-fixed"]);
    let events = ["/command", "/envelope_mean", "/law", "/log", "/metrics", "/params", "/summary"];
    let motion = ["/attitude", "/envelope", "/modes", "/rate"];
    dir.run("simulate relay-fixed.toml -o events --set epoch=2026-03-20T14:46:00Z").exits(0);
    inspect(&dir, "events/relay-fixed.mcap", &events, 1_774_017_960_000_000_000);
    dir.run("simulate relay-fixed.toml -o full --log full --set duration=2000").exits(0);
    inspect(&dir, "full/relay-fixed.mcap", &[&events[..], &motion[..]].concat(), 0);
    let scene = ["/plumes", "/scene", "/tf"];
    let options = "--log scene --set duration=600 --set epoch=2026-03-20T14:46:00Z";
    dir.run(&format!("simulate relay-fixed.toml -o scene {options}")).exits(0);
    let topics = [&events[..], &motion[..], &scene[..]].concat();
    inspect(&dir, "scene/relay-fixed.mcap", &topics, 1_774_017_960_000_000_000);
}

fn inspect(dir: &Dir, log: &str, topics: &[&str], epoch_ns: u64) {
    let bytes = dir.read(log);
    let summary = mcap::Summary::read(&bytes).expect("whole").expect("a summary");
    let statistics = summary.stats.as_ref().expect("statistics");
    assert_eq!(statistics.message_start_time, epoch_ns);
    assert!(summary.chunk_indexes.len() > 1);
    // The chunk of the summary spans no time: a reader that begins at the start needs no row of the end.
    let (last, others) = summary.chunk_indexes.split_last().expect("chunks");
    assert_eq!((last.message_start_time, last.message_end_time), (epoch_ns, epoch_ns));
    assert!(others.windows(2).all(|chunks| chunks[0].message_end_time <= chunks[1].message_start_time));
    for chunk in &summary.chunk_indexes {
        assert!(!chunk.message_index_offsets.is_empty(), "a chunk without a message index");
        assert!(chunk.message_start_time >= statistics.message_start_time);
        assert!(chunk.message_end_time <= statistics.message_end_time);
        let indexed = summary.read_message_indexes(&bytes, chunk).expect("indexes");
        let count: usize = indexed.values().map(Vec::len).sum();
        assert!((1..=2000).contains(&count), "{count} messages in a chunk");
    }
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    let mut last = 0;
    for message in mcap::MessageStream::new(&bytes).expect("a log") {
        let message = message.expect("whole");
        assert_eq!(message.publish_time, message.log_time);
        if message.channel.topic == "/summary" {
            assert_eq!(message.log_time, epoch_ns, "viewers show the metrics from the start");
        } else {
            assert!(message.log_time >= last, "time runs back");
            last = message.log_time;
        }
        *counts.entry(message.channel.topic.clone()).or_default() += 1;
    }
    assert_eq!(counts.values().sum::<usize>() as u64, statistics.message_count);
    let mut topics = topics.to_vec();
    topics.sort_unstable();
    assert_eq!(counts.keys().collect::<Vec<_>>(), topics);
    // What is exported was decoded by the schema that the file carries.
    for (topic, count) in counts {
        let rows = dir.run(&format!("export {log} --topic {topic} --format jsonl")).printed();
        if topic == "/metrics" {
            // A table for people: a line for each metric.
            assert!(rows.lines().count() > 1 && rows.starts_with("{\"name\":"), "{rows}");
            continue;
        }
        assert_eq!(rows.lines().count(), count, "{topic}");
        assert!(rows.starts_with("{\"time_s\":"), "{topic}");
    }
    let attachment = |name: &str| {
        let index = summary.attachment_indexes.iter().find(|a| a.name == name).expect("attached");
        String::from_utf8(mcap::read::attachment(&bytes, index).expect("whole").data.into_owned())
            .expect("text")
    };
    assert_eq!(attachment("scenario.toml"), dir.run(&format!("log scenario {log}")).printed());
    serde_json::from_str::<Json>(&attachment("layout.json")).expect("a layout");
    assert_eq!(end(dir, log)["end"], "complete");
}

#[test]
fn logs_are_small() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.run("simulate relay-fixed.toml -o events").exits(0);
    dir.run("simulate relay-fixed.toml -o full --log full").exits(0);
    let (events, full) = (dir.read("events/relay-fixed.mcap").len(), dir.read("full/relay-fixed.mcap").len());
    assert!(events < 300_000, "{events} bytes of events");
    assert!(full < 40_000_000, "{full} bytes of motion");
}
