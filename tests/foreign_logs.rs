//! Logs of other programs, and malformed ones: each gives a table or one clear error, within bounds of memory and time.

use std::fmt::Write as _;

use crate::foreign::*;
use crate::util::{Dir, Ran};

/// Checks that every reader of logs refuses a file with one error.
#[track_caller]
fn refused(ran: Ran, words: &[&str]) {
    let ran = ran.exits(2).says(words);
    assert!(ran.err.starts_with("error: a.mcap: ") && !ran.err.contains("panicked"), "{}", ran.err);
    assert!(ran.out.is_empty());
}

const READERS: [&str; 4] =
    ["export a.mcap --topic /a", "plot a.mcap", "layout a.mcap", "log scenario a.mcap"];

/// Logs of other programs become tables, type by type.
#[test]
fn every_type_of_a_foreign_schema_is_read() {
    let inner = message("Point", &[field("x", 1, DOUBLE, "", false), field("y", 2, DOUBLE, "", false)]);
    let colours = [("RED", 0_u8), ("BLUE", 7)]
        .map(|(name, number)| block(2, [block(1, name), small(2, number)].concat()));
    let colours = block(5, [block(1, "Colour"), colours.concat()].concat());
    let entry = block(
        3,
        [
            block(1, "TagsEntry"),
            field("key", 1, STRING, "", false),
            field("value", 2, INT64, "", false),
            block(7, small(7, 1)),
        ]
        .concat(),
    );
    let all = message(
        "All",
        &[
            field("signed", 1, INT64, "", false),
            field("zigzag", 2, SINT32, "", false),
            field("count", 3, UINT64, "", false),
            field("name", 4, STRING, "", false),
            field("image", 5, BYTES, "", false),
            field("at", 6, MESSAGE, ".a.Point", false),
            field("points", 7, MESSAGE, ".a.Point", true),
            field("numbers", 8, INT64, "", true),
            field("tags", 9, MESSAGE, ".a.All.TagsEntry", true),
            field("colour", 10, ENUM, ".a.Colour", false),
            entry,
        ],
    );
    let double = |number: u8, value: f64| [&[number << 3 | 1][..], &value.to_le_bytes()].concat();
    let minus_one = [&[1 << 3][..], &[0xff; 9], &[1]].concat();
    let first = [
        minus_one,
        small(2, 5),
        [&[3 << 3][..], &[0xff; 9], &[1]].concat(),
        block(4, "grün"),
        block(5, [0; 300]),
        block(6, double(1, 0.5)),
        // The same message in two parts is one.
        block(6, double(2, -2.0)),
        block(7, double(1, 1.0)),
        block(7, double(2, 4.0)),
        // A list in one block, and in single fields.
        block(8, [1, 2]),
        small(8, 3),
        block(9, [block(1, "b"), small(2, 9)].concat()),
        small(10, 7),
        // A field that the schema does not know, and a group.
        small(15, 1),
        vec![14 << 3 | 3, 1 << 3, 1, 14 << 3 | 4],
    ];
    let second = small(10, 3);
    let dir =
        Dir::holding("a.mcap", log("a.All", &schema(&[inner, colours, all]), &[first.concat(), second]));
    let csv = dir.run("export a.mcap --topic /a").printed();
    let expected = "time_s,signed,zigzag,count,name,image.length,at.x,at.y,points[0].x,points[0].y,points[1].x,points[1].y,\
                    numbers[0],numbers[1],numbers[2],tags[0].key,tags[0].value,colour\n\
                    0e0,-1,-3,18446744073709551615,grün,300,5e-1,-2e0,1e0,0e0,0e0,4e0,1,2,3,b,9,BLUE\n\
                    1e0,0,0,0,,0,0e0,0e0,,,,,,,,,,\n";
    assert_eq!(csv, expected);
    let lines = dir.run("export a.mcap --topic /a --format jsonl").printed();
    assert_eq!(lines.lines().count(), 2);
    for reader in &READERS[1..] {
        refused(
            dir.run(reader),
            &["contains no scenario, so it is not a log of flexsc", "`flexsc export` reads any MCAP log"],
        );
    }
}

/// Schemas that no table can be made of are refused with the field that is to blame.
#[test]
#[cfg(target_os = "linux")]
fn schemas_without_bounds_are_refused() {
    let recursive = schema(&[message("Node", &[field("next", 1, MESSAGE, ".a.Node", false)])]);
    let through_a_map = {
        let entry = block(
            3,
            [
                block(1, "FieldsEntry"),
                field("key", 1, STRING, "", false),
                field("value", 2, MESSAGE, ".a.Value", false),
                block(7, small(7, 1)),
            ]
            .concat(),
        );
        let of = message("Struct", &[field("fields", 1, MESSAGE, ".a.Struct.FieldsEntry", true), entry]);
        let value = message(
            "Value",
            &[field("number", 1, DOUBLE, "", false), field("inner", 2, MESSAGE, ".a.Struct", false)],
        );
        schema(&[of, value])
    };
    // Each message has ten of the next: 10^30 columns, or none at all and as many places to look.
    let wide = |leaf: &[Vec<u8>]| {
        let level = |n: usize| {
            let fields: Vec<_> = (0..10)
                .map(|i| field(&format!("f{i}"), i + 1, MESSAGE, &format!(".a.M{}", n + 1), false))
                .collect();
            message(&format!("M{n}"), &fields)
        };
        let levels: Vec<_> = (0..30).map(level).chain([message("M30", leaf)]).collect();
        schema(&levels)
    };
    let deep: Vec<_> = (0..3000)
        .map(|n| message(&format!("M{n}"), &[field("f", 1, MESSAGE, &format!(".a.M{}", n + 1), false)]))
        .chain([message("M3000", &[])])
        .collect();
    let nested = (0..300)
        .fold(Vec::new(), |inner, n| block(if n == 299 { 4 } else { 3 }, [block(1, "N"), inner].concat()));
    let cases: [(&str, Vec<u8>, &[&str]); 8] = [
        ("a.Node", recursive, &["topic `/a`", "field `next` is a `a.Node` within itself"]),
        (
            "a.Struct",
            through_a_map,
            &["topic `/a`", "field `fields.value.inner` is a `a.Struct` within itself"],
        ),
        ("a.M0", wide(&[field("x", 1, DOUBLE, "", false)]), &["topic `/a`", "more than 4096 fields"]),
        ("a.M0", wide(&[]), &["topic `/a`", "more than 4096 fields"]),
        ("a.M0", schema(&deep), &["topic `/a`", "is more than 32 messages deep"]),
        ("a.N", schema(&[nested]), &["topic `/a`", "its schema: "]),
        ("a.None", schema(&[message("M", &[])]), &["topic `/a`", "no message `a.None` in its schema"]),
        (
            "a.M",
            vec![0xff; 2_000_000],
            &["topic `/a`", "its schema has 2000000 bytes, and at most 1048576 are read"],
        ),
    ];
    for (name, schema, words) in cases {
        let dir = Dir::holding("a.mcap", log(name, &schema, &[Vec::new()]));
        refused(dir.run_bounded("export a.mcap --topic /a"), words);
        // The topic is refused, and not the log.
        assert_eq!(dir.run_bounded("export a.mcap").printed(), "/a\n");
    }
    let dir = Dir::holding("a.mcap", log_in("cdr", "geometry_msgs/Point", b"float64 x", &[vec![0; 12]]));
    refused(dir.run("export a.mcap --topic /a"), &["only protobuf messages are read", "`cdr`", "`ros2msg`"]);
}

/// Messages that are not what their schema says.
#[test]
#[cfg(target_os = "linux")]
fn messages_that_lie_are_refused() {
    let of = schema(&[
        message(
            "M",
            &[
                field("x", 1, DOUBLE, "", false),
                field("name", 2, STRING, "", false),
                field("list", 3, MESSAGE, ".a.E", true),
            ],
        ),
        message("E", &[]),
    ]);
    let cases: [(&str, Vec<u8>, &str); 5] = [
        (
            "a number for a double",
            small(1, 5),
            "field 1 of a message is not of the type that its schema says",
        ),
        ("no text", block(2, [0xff]), "a text in it is not UTF-8"),
        ("a text of 4 GB", vec![2 << 3 | 2, 0xff, 0xff, 0xff, 0xff, 0x0f], "a message ends within a field"),
        ("a group without end", vec![9 << 3 | 3], "a message ends within a field"),
        ("groups in groups", vec![9 << 3 | 3; 1_000_000], "a message ends within a field"),
    ];
    for (what, bytes, why) in cases {
        let dir = Dir::holding("a.mcap", log("a.M", &of, &[bytes]));
        let ran = dir.run_bounded("export a.mcap --topic /a");
        assert!(ran.err.contains(why), "{what}: {}", ran.err);
        refused(ran, &["topic `/a` cannot be decoded"]);
    }
    // Two bytes a row within the row: a row of a million, and one without.
    let many = block(3, []).repeat(1_000_000);
    let dir = Dir::holding("a.mcap", log("a.M", &of, &[many.clone(), Vec::new()]));
    dir.run_bounded("export a.mcap --topic /a -o a.csv").exits(0);
    let points = schema(&[message("M", &[field("list", 1, DOUBLE, "", true)])]);
    let wide = block(1, [0_u8; 8].repeat(100_000));
    let rows: Vec<_> = std::iter::once(wide).chain((0..10_000).map(|_| Vec::new())).collect();
    let dir = Dir::holding("a.mcap", log("a.M", &points, &rows));
    refused(
        dir.run_bounded("export a.mcap --topic /a"),
        &["`list` has up to 100000 values in one of 10001 rows", "no table holds that"],
    );
}

/// Offsets and lengths of a file that point beyond it, or claim gigabytes.
#[test]
#[cfg(target_os = "linux")]
fn offsets_and_lengths_that_lie_are_harmless() {
    let of = schema(&[message("M", &[field("x", 1, DOUBLE, "", false)])]);
    let good = log("a.M", &of, &[Vec::new()]);
    let body = &good[..good.len() - end(&[0; 20]).len()];
    let with = |more: &[u8], footer: &[u8]| {
        [body, &record(15, &[&[0; 4]]), more, &record(2, &[footer]), &MAGIC].concat()
    };
    let far = u64::MAX.to_le_bytes();
    let metadata_index = record(13, &[&far, &far, &text("flexsc.run")]);
    let attachment_index = record(10, &[&far, &far, &[0; 24], &text("scenario.toml"), &text("")]);
    let chunk_index = record(8, &[&[0; 16], &far, &far, &text(""), &far, &text("zstd"), &far, &far]);
    let start = (body.len() as u64 + 13).to_le_bytes();
    let summary = [&start[..], &[0; 12]].concat();
    // The summary's contents are not read.
    for index in [metadata_index, attachment_index, chunk_index] {
        let dir = Dir::holding("a.mcap", with(&index, &summary));
        assert_eq!(dir.run_bounded("export a.mcap --topic /a").printed(), "time_s,x\n0e0,0e0\n");
        for reader in &READERS[1..] {
            refused(dir.run_bounded(reader), &["contains no scenario"]);
        }
    }
    for footer in [[&far[..], &far, &[0; 4]].concat(), vec![0xff; 3]] {
        let dir = Dir::holding("a.mcap", with(&[], &footer));
        assert_eq!(dir.run_bounded("export a.mcap").printed(), "/a\n");
    }
    let long = 0xffff_fff0_u32.to_le_bytes();
    let lies: [(&str, Vec<u8>); 8] = [
        ("a record of 2^64 - 1 bytes", [&[5][..], &far].concat()),
        ("a record of 4 GB", [&[12][..], &0xffff_ffff_u64.to_le_bytes()].concat()),
        ("a name of 4 GB", record(12, &[&long, b"flexsc"])),
        ("a map of 4 GB", record(12, &[&text("flexsc.run"), &long])),
        ("a key of 4 GB", record(12, &[&text("flexsc.run"), &text(long)])),
        ("a topic of 4 GB", record(4, &[&[1, 0, 1, 0], &long])),
        (
            "an attachment of 2^64 - 1 bytes",
            record(9, &[&[0; 16], &text("scenario.toml"), &text(""), &far, &[0; 4]]),
        ),
        (
            "an attachment without its checksum",
            record(9, &[&[0; 16], &text("scenario.toml"), &text(""), &[0; 8]]),
        ),
    ];
    for (what, lie) in lies {
        let dir = Dir::holding("a.mcap", [body, &lie, &end(&[0; 20])].concat());
        for reader in READERS {
            let ran = dir.run_bounded(reader);
            assert!(ran.err.contains("not a readable MCAP log"), "{what}: {reader}: {}", ran.err);
            refused(ran, &[]);
        }
        let saved = dir.run_bounded("log recover a.mcap -o b.mcap --json").exits(0).json();
        assert_eq!(saved["messages"], 1, "{what}");
    }
}

/// Chunks that unpack to far more than they are, or claim to.
#[test]
#[cfg(target_os = "linux")]
fn chunks_that_unpack_to_gigabytes_are_refused() {
    let of = schema(&[message("M", &[field("x", 1, DOUBLE, "", false)])]);
    let good = log("a.M", &of, &[]);
    let body = &good[..good.len() - end(&[0; 20]).len()];
    // Creates a frame of zstd with run-length blocks, each of which repeats one byte.
    let frame = |blocks: usize| {
        let block = |last: u32| [&(last | 1 << 1 | (128 << 10) << 3).to_le_bytes()[..3], &[0]].concat();
        let more = block(0).repeat(blocks - 1);
        [&[0x28, 0xb5, 0x2f, 0xfd, 0x00, 0x38][..], &more, &block(1)].concat()
    };
    let chunk = |compression: &str, size: u64, crc: u32, data: &[u8]| {
        let length = (data.len() as u64).to_le_bytes();
        record(6, &[&[0; 16], &size.to_le_bytes(), &crc.to_le_bytes(), &text(compression), &length, data])
    };
    let size = 16_000 * (128_u64 << 10);
    let bomb = frame(16_000);
    let cases = [
        chunk("zstd", u64::MAX, 1, &bomb),
        chunk("zstd", size, 1, &bomb),
        chunk("zstd", size, 0, &bomb),
        chunk("zstd", 200 << 20, 1, &[]),
        chunk("", u64::MAX, 5, b"hello"),
        chunk("lz4", 5, 0, b"hello"),
        // A small chunk many times over.
        chunk("zstd", 120 * (128 << 10), 0, &frame(120)).repeat(5000),
    ];
    for (case, chunk) in cases.into_iter().enumerate() {
        let dir = Dir::holding("a.mcap", [body, &chunk, &end(&[0; 20])].concat());
        let ran = dir.run_bounded("export a.mcap --topic /a");
        assert!(ran.err.contains("not a readable MCAP log"), "{case}: {:?} {}", ran.code, ran.err);
        refused(ran, &[]);
        dir.run_bounded("log recover a.mcap -o b.mcap").exits(0);
    }
}

/// A path that is no regular file is not read: it may never end.
#[test]
#[cfg(target_os = "linux")]
fn pipes_and_devices_are_no_logs() {
    let dir = Dir::new();
    let made = std::process::Command::new("mkfifo").arg(dir.path("pipe")).status();
    assert!(made.expect("mkfifo starts").success());
    for file in ["pipe", "/dev/zero"] {
        for command in
            ["export FILE", "plot FILE", "layout FILE", "log scenario FILE", "log recover FILE -o b.mcap"]
        {
            let ran = dir.run_bounded(&command.replace("FILE", file)).exits(2);
            assert_eq!(ran.err, format!("error: {file}: not a file\n"), "{command}");
        }
    }
    let mut torn = String::new();
    let _ = write!(torn, "{}", "x".repeat(100));
    dir.write("a.mcap", torn);
    refused(dir.run("export a.mcap"), &["not a readable MCAP log"]);
    dir.write("a.mcap", &MAGIC[..]);
    refused(dir.run("export a.mcap"), &["the log is torn"]);
}

/// Topics of other programs do not reach the terminal as they are.
#[test]
fn control_characters_of_topics_are_escaped() {
    let of = schema(&[message("M", &[field("x", 1, DOUBLE, "", false)])]);
    let mut bytes = log("a.M", &of, &[Vec::new()]);
    let topic = text("/a");
    let at = bytes.windows(topic.len()).position(|window| window == topic).expect("the topic");
    bytes[at + topic.len() - 1] = 0x1b;
    let dir = Dir::holding("a.mcap", bytes);
    assert_eq!(dir.run("export a.mcap").printed(), "/\\u{1b}\n");
}
