//! Files of ephemerides: their rows, and damaged ones.

use super::*;

fn table(text: &str) -> Result<StateTable, String> {
    read(text.as_bytes())
}

fn rows(count: usize) -> String {
    let lines = (0..count).map(|row| format!("{},7e6,{},0\n", 60 * row, 450_000 * row));
    lines.collect::<Vec<_>>().concat()
}

const MESSAGE: &str = "CCSDS_OEM_VERS = 2.0\nCREATION_DATE = 2026-11-24T00:00:00\nORIGINATOR = TEST\n\nMETA_START\n\
    OBJECT_NAME = A\nOBJECT_ID = 2026-001A\nCENTER_NAME = EARTH\nREF_FRAME = TOD\nTIME_SYSTEM = UTC\n\
    START_TIME = 2026-11-24T00:00:00\nSTOP_TIME = 2026-11-24T00:07:00\nMETA_STOP\nCOMMENT states\n";

fn message() -> String {
    let states = (0..8).map(|row| format!("2026-11-24T00:0{row}:00.500 7000.0 {} -1.5 0 7.5 0\n", 450 * row));
    let states = states.collect::<Vec<_>>().concat();
    format!("{MESSAGE}{states}COVARIANCE_START\nEPOCH = 2026-11-24T00:00:00\n1.0\nCOVARIANCE_STOP\n")
}

#[test]
fn tables_have_times_and_positions() {
    for text in [rows(9), format!("t,x,y,z\n{}", rows(9)), format!("# a comment\n\n{}", rows(9))] {
        let found = table(&text).expect("valid");
        assert!(found.rows.len() == 9 && found.epoch_ns.is_none() && found.frame.is_none());
        assert_eq!(found.rows[2], [120.0, 7e6, 9e5, 0.0]);
    }
    let wide = rows(8).lines().map(|line| format!("{line},1,2,3\n")).collect::<Vec<_>>().concat();
    assert_eq!(table(&format!("t,x,y,z,vx,vy,vz\n{wide}")).expect("valid").rows.len(), 8);
}

#[test]
fn messages_have_dates_and_kilometres() {
    let found = table(&message()).expect("valid");
    // date --utc --date=2026-11-24T00:00:00Z +%s: 1795478400.
    let epoch = Some(1_795_478_400_500_000_000);
    assert_eq!((found.epoch_ns, found.frame), (epoch, Some(CelestialFrame::Tod)));
    assert_eq!((found.rows[2], found.lines[2]), ([120.0, 7e6, 9e5, -1500.0], 17));
    let by_day = message().replace("2026-11-24T00:0", "2026-328T00:0");
    assert_eq!(table(&by_day).expect("valid"), found);
    let of_2000 = table(&message().replace("= TOD", "= EME2000")).expect("valid");
    assert_eq!((of_2000.frame, &of_2000.rows), (Some(CelestialFrame::Eme2000), &found.rows));
    let mut read = EphemerisTable { file: Some("a.oem".to_owned()), table: Arc::new(found) };
    assert_eq!(read.rows(epoch.map(|at| at - 30_000_000_000)).expect("valid")[0][0], 30.0);
    assert_eq!(read.rows(None), None);
    assert_eq!(read.place(2), "a.oem: line 17");
    read.inline(read.rows(epoch).expect("valid"));
    assert!(read.file.is_none() && read.rows(None).expect("valid")[1][0] == 60.0);
    assert_eq!(read.place(2), "row 3");
}

#[test]
fn segments_and_repeated_dates_are_joined() {
    let found = table(&message()).expect("valid");
    let last = "2026-11-24T00:07:00.500 7000.0 3150 -1.5 0 7.6 0\n";
    let repeated = table(&format!("{}{last}", message())).expect("valid");
    assert_eq!((&repeated.rows, repeated.burns.as_slice()), (&found.rows, &[27][..]));
    assert_eq!(repeated.velocities[6..], [[0.0, 7500.0, 0.0], [0.0, 7600.0, 0.0]]);
    let metadata = MESSAGE.split_once("META_START").expect("metadata").1.to_lowercase();
    let metadata =
        ["meta_stop", "comment", "object_name", "object_id", "center_name", "ref_frame", "time_system"]
            .into_iter()
            .fold(metadata, |text, key| text.replace(key, &key.to_uppercase()));
    let more = "2026-11-24T00:08:00.500 7000.0 3600 -1.5 0 7.5 0\n";
    let joined = format!("{}META_START{}{last}{more}", message(), metadata.replace("2026-001a", "2026-001A"));
    let joined = table(&joined).expect("valid");
    assert_eq!((joined.rows.len(), joined.rows[8][0], joined.velocities.len()), (9, 480.0, 9));
    // Rows without velocities: none count.
    let without =
        table(&message().replace(" 0 7.5 0\n2026-11-24T00:01", "\n2026-11-24T00:01")).expect("valid");
    assert_eq!((without.velocities.len(), &without.rows), (0, &found.rows));
}

#[test]
fn damaged_files_are_refused_with_their_lines() {
    let refused = |text: &str, words: &str| {
        let error = table(text).expect_err("damaged");
        assert!(error.contains(words), "{error}");
    };
    refused("", "at least 8 rows, got 0");
    refused(&rows(7), "at least 8 rows, got 7");
    refused("a,b,c\n", "line 1: must be a header `t,x,y,z`");
    refused("1,2,3\n", "line 1: must have 4 numbers, got 3");
    refused(&rows(9).replace("180,", "120,"), "line 4: must be at the position of line 3");
    refused(&rows(9).replace("180,", "110,"), "line 4: must have increasing times");
    refused(&rows(9).replace("180,7e6", "180,x"), "line 4: must be a number, got `x`");
    refused(&rows(9).replace("180,7e6", "180,nan"), "line 4: must be a number, got `nan`");
    refused(&rows(9).replace("180,7e6", "180,1e300"), "line 4: must have times");
    refused(&rows(9).replace("180,7e6,1350000,0", "180,0,0,0"), "line 4: must not be the planet's centre");
    refused(&rows(9).replace("180,7e6,1350000,0", "180,7e6"), "line 4: must have 4 numbers, got 2");
    assert!(read(&b"0,1,2,3\n\xff\xfe,1,2\n"[..]).expect_err("damaged").contains("line 2: is not UTF-8"));
    refused(&message().replace("= UTC", "= TAI"), "line 10: must have `TIME_SYSTEM = UTC`, got `TAI`");
    refused(&message().replace("= TOD", "= ITRF2014"), "line 9: must have `REF_FRAME`");
    refused(
        &message().replace("REF_FRAME = TOD\n", ""),
        "line 12: must end metadata that have a `REF_FRAME`",
    );
    refused(&message().replace("= EARTH", "= MARS"), "line 8: must have `CENTER_NAME = EARTH`");
    refused(&message().replace("T00:03", "T25:03"), "line 18: must begin with a date");
    refused(
        &message().replace("2026-11-24T00:03:00.500 7000.0", "2026-11-24T00:03:00.500 7OOO"),
        "line 18: must be a number",
    );
    refused(&message().replace("T00:03", "T00:02"), "line 18: must be at the position of line 17");
    refused(&message().replace("T00:03", "T00:01"), "line 18: must have increasing times");
    refused(&format!("{}META_START\n", message()), "is the file cut?");
    let other = MESSAGE.split_once("META_START").expect("metadata").1.replace("001A", "002A");
    refused(&format!("{}META_START{other}", message()), "of the segment before");
    refused(MESSAGE, "at least 8 rows, got 0");
}
