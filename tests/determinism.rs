//! Equal numbers on every machine: fingerprints of runs that use all of the engine's arithmetic.
//!
//! They say that a run repeats to the last bit, not that it is right; `relay.rs`, `cycles.rs` and `events.rs` say that.
//! A change of the engine's arithmetic, or of what a seed draws, changes them: put the new ones here, and say so in the
//! changelog.

use flexsc_core::record::{Column, Log};

use crate::util::Dir;

/// Returns the FNV-1a hash of a text.
fn fingerprint(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// Returns the metrics in one row, each with all of its fields and every digit.
fn metrics(dir: &Dir, log: &str) -> String {
    let columns = Log::open(&dir.path(log)).and_then(|log| log.columns("/metrics")).expect("metrics");
    let Some(Column::Rows(counts, fields)) = columns.get("metrics") else { panic!("no metrics") };
    let time = columns.numbers("time_s").expect("a time")[0];
    let (mut names, mut cells) = (vec!["time_s".to_owned()], vec![format!("{time:e}")]);
    for index in 0..counts[0] as usize {
        for (name, column) in &fields.columns {
            names.push(format!("metrics[{index}].{name}"));
            cells.push(match column {
                Column::Numbers(values) => format!("{:e}", values[index]),
                Column::Counts(values) => values[index].to_string(),
                Column::Texts(values) => values[index].clone(),
                _ => panic!("{name}"),
            });
        }
    }
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(names).and_then(|()| writer.write_record(cells)).expect("memory");
    String::from_utf8(writer.into_inner().expect("memory")).expect("UTF-8")
}

#[test]
fn runs_repeat_to_the_last_bit() {
    // (scenario, topic, fingerprint): undamped with adaptation; coupled modes; damped with noise, quadrature and drawn
    // numbers; wheels with friction, tachometers and an attitude filter; a filter with modes; panels that turn;
    // actuators of several kinds; three axes, whose metrics hold energies and angles to the last bit; with adaptive
    // observers and active damping.
    let runs = [
        ("relay-adaptive", "", "/command", 0x4886_7bcb_5000_12ea),
        ("relay-adaptive", "", "/adaptation", 0xc5d3_fe5a_3b03_bb60),
        ("adaptive-bandwidth", "", "/objective", 0x9746_18b9_1693_643b),
        ("relay-wheel", "", "/command", 0x78a2_8188_0e76_c89e),
        ("relay-sampled", " --runs 5:6", "/command", 0x326e_f6e7_a8ce_d541),
        ("relay-sampled", " --runs 5:6", "/envelope_mean", 0xfcf2_156a_660f_118d),
        ("iss-manoeuvre-off", " --runs 5:6", "/jets", 0x99f5_dadc_162c_aa75),
        ("iss-manoeuvre-off", " --runs 5:6", "/metrics", 0x6831_1d6a_35d6_a3fa),
        ("wheel-friction", " --runs 5:6", "/wheel_events", 0x9f91_46e0_c5ed_dff9),
        ("wheel-friction", " --runs 5:6", "/metrics", 0x38b3_d183_c4d3_d466),
        ("flexible-boom", " --runs 5:6", "/metrics", 0x9e2d_0af4_1e81_1842),
        ("sun-tracking", " --runs 5:6", "/metrics", 0x5ec5_3cac_587c_d488),
        ("wheels-and-jets", "", "/jets", 0x1937_088b_af1d_3d74),
        ("wheels-and-jets", "", "/metrics", 0x0e16_04b7_6e80_7417),
        ("iss-manoeuvre", " --runs 5:6", "/jets", 0xab49_e5c6_fc46_c039),
        ("iss-manoeuvre", " --runs 5:6", "/metrics", 0xe184_5b13_8bc2_d8de),
    ];
    let mut others = Vec::new();
    for (name, runs, topic, expected) in runs {
        let dir = Dir::with(&[name]);
        dir.run(&format!("simulate {name}.toml --log events{runs}")).exits(0);
        let log = if runs.is_empty() { format!("{name}.mcap") } else { format!("{name}-5.mcap") };
        let table = match topic {
            "/metrics" => metrics(&dir, &log),
            _ => dir.run(&format!("export {log} --topic {topic}")).exits(0).prints(&[]),
        };
        let found = fingerprint(&table);
        if found != expected {
            others.push(format!("{name}{runs} {topic}: {found:#018x}"));
        }
    }
    assert!(others.is_empty(), "{others:#?}");
}
