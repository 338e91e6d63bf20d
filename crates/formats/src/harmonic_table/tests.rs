//! Files of coefficients, and rows of a scenario, against their numbers; damaged ones.

use super::*;
use coefficient_file::read;

const WMM: &str = "    2025.0            WMM-2025     11/13/2024\n\
    1  0  -29351.8       0.0       12.0        0.0\n\
    1  1   -1410.8    4545.4        9.7      -21.5\n\
    9999999999999999999999999\n9999999999999999999999999\n";

const SHC: &str = "# a comment\n1 2 3 2 1 2015.0 2025.0\n 2015.0 2020.0 2025.0\n\
    1 0 -29441.46 -29403.41 -29350.0\n1 1 -1501.77 -1451.37 -1410.3\n1 -1 4795.99 4653.35 4545.5\n\
    2 0 -2445.88 -2499.78 -2556.2\n2 1 3012.2 2981.96 2950.9\n2 -1 -2845.41 -2991.72 -3133.6\n\
    2 2 1676.35 1676.85 1648.7\n2 -2 -642.17 -734.62 -814.2\n";

const BLOCKS: &str = "   DGRF2020  2020.00  1  0  0 2020.00 2025.00   -1.0  600.0    DGRF2020   0\n\
    1  0 -29403.41    0.0     0.0    0.0   DGRF2020   1\n1  1  -1451.37 4653.35    0.0    0.0   DGRF2020   2\n   \
    IGRF2025  2025.00  2  1  0 2025.00 2030.00   -1.0  600.0    IGRF2025   3\n\
    1  0 -29350.0     0.0    12.6    0.0   IGRF2025   4\n1  1  -1410.3  4545.5    10.0  -21.5   IGRF2025   5\n\
    2  0  -2556.2     0.0   -11.2    0.0   IGRF2025   6\n2  1   2950.9 -3133.6    -5.3  -27.3   IGRF2025   7\n\
    2  2   1648.7  -814.2    -8.3  -11.1   IGRF2025   8\n";

fn table(text: &str) -> HarmonicTable {
    HarmonicTable { file: None, contents: Arc::new(read(text.as_bytes()).expect("a table")) }
}

/// Checks coefficients against those expected (nT).
fn has(table: &HarmonicTable, degree: usize, year: f64, expected: &[[f64; 2]]) {
    let found = table.coefficients(degree, year);
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
        assert!((found - expected).abs() < 1e-9, "{year}: {found} {expected}");
    }
}

#[test]
fn files_have_their_coefficients_linear_between_years() {
    let wmm = table(WMM);
    assert_eq!((wmm.degree(), wmm.years()), (1, Some([2025.0, 2030.0])));
    has(&wmm, 1, 2025.0, &[[-29_351.8, 0.0], [-1410.8, 4545.4]]);
    has(&wmm, 5, 2027.5, &[[-29_321.8, 0.0], [-1386.55, 4491.65]]);
    let shc = table(SHC);
    assert_eq!((shc.degree(), shc.years()), (2, Some([2015.0, 2025.0])));
    has(&shc, 1, 2020.0, &[[-29_403.41, 0.0], [-1451.37, 4653.35]]);
    has(&shc, 1, 2025.0, &[[-29_350.0, 0.0], [-1410.3, 4545.5]]);
    has(&shc, 1, 2022.5, &[[-29_376.705, 0.0], [-1430.835, 4599.425]]);
    assert!(shc.coefficients(2, 2016.0).len() == 5);
    // Degrees that a block does not have are zero in its year.
    let blocks = table(BLOCKS);
    assert_eq!((blocks.degree(), blocks.years()), (2, Some([2020.0, 2030.0])));
    let first = [[-29_403.41, 0.0], [-1451.37, 4653.35], [0.0; 2], [0.0; 2], [0.0; 2]];
    has(&blocks, 2, 2020.0, &first);
    let rates = [[-29_337.4, 0.0], [-1400.3, 4524.0], [-2567.4, 0.0], [2945.6, -3160.9], [1640.4, -825.3]];
    has(&blocks, 2, 2026.0, &rates);
    // One year holds for all dates.
    let still = table(&SHC.replace("1 2 3 2 1", "1 1 1 1 1").split_once("1 0 -").map_or(
        String::new(),
        |(head, _)| {
            format!("{}1 0 -3e4\n1 1 -1e3\n1 -1 4e3\n", head.replace(" 2015.0 2020.0 2025.0", "2020.0"))
        },
    ));
    assert_eq!(still.years(), None);
    has(&still, 1, 1900.0, &[[-3e4, 0.0], [-1e3, 4e3]]);
}

#[test]
fn rows_of_a_scenario_are_those_of_the_file() {
    #[derive(Deserialize)]
    struct Keys {
        table: HarmonicTable,
    }
    let mut file = HarmonicTable { file: Some("a.shc".to_owned()), ..table(SHC) };
    file.inline(13);
    let text = format!("table = {}", toml::Value::try_from(&file).expect("a value"));
    let again: Keys = crate::document::from_text(&text).expect("rows");
    assert_eq!(again.table, file);
    file = HarmonicTable { file: Some("a.shc".to_owned()), ..table(SHC) };
    file.inline(1);
    assert_eq!((file.degree(), file.contents.rows.len()), (1, 3));
    let refused = |keys: &str, words: &str| {
        let error = crate::document::from_text::<Keys>(keys).err().expect("damaged").to_string();
        assert!(error.contains(words), "{error}");
    };
    refused("table = 5", "the path of a file of coefficients");
    refused(
        "table = [[2020], [[1, 0, 5]]]",
        "`table`: found an array, expected `years` and `rows`, or the path",
    );
    refused("table = { years = [2020] }", "`table`: missing key `rows`");
    refused("table = { years = [2020], row = [] }", "unknown key `row`");
    refused("table = { years = [2020], rows = [[1, 0, 'x']] }", "`table.rows[0][2]`: found string \"x\"");
    refused("table = { years = [2020], rows = [[1, 0, 5], [1, 1, 5]] }", "degree 1 and order -1");
    refused("table = { years = [], rows = [[1, 0]] }", "from 1 to 1000 years, got 0");
    refused("table = { years = [2020], rows = [] }", "coefficients of degree 1, got none");
    refused(
        "table = { years = [2020, 2019], rows = [[1, 0, 5, 5]] }",
        "increasing years, got 2019 after 2020",
    );
    refused("table = { years = [2020], rows = [[1, 0, 5], [1, 0, 6]] }", "row 2: has degree 1 and order 0");
    refused("table = { years = [nan], rows = [[1, 0, 5]] }", "years of up to 1e6");
}

#[test]
fn damaged_files_are_refused_with_their_lines() {
    let refused = |text: &str, words: &str| {
        let error = read(text.as_bytes()).expect_err("damaged");
        assert!(error.contains(words), "{error}");
    };
    refused("", "and is empty");
    refused("999999999999999999999999\n1 0 -29351.8 0 12 0\n", "must end with a line of nines");
    let nines = "9999999999999999999999999\n";
    refused(&format!("{nines}{nines}"), "line 2: must be a row of degree, order, g, h and their rates");
    refused(&format!("2025.0 WMM\n{nines}"), "line 2: must be a row of degree");
    refused(&WMM.replace("9999999999999999999999999\n", ""), "a line of nines");
    refused(&WMM.replace("1  1 ", "1  2 "), "line 3: must have an order from -1 to 1, got 2");
    refused(&WMM.replace("1  1 ", "1 -1 "), "line 3: must have an order from 0 on, got -1");
    refused(&WMM.replace("1  1 ", "0  1 "), "line 3: must have a degree from 1 to 200, got 0");
    refused(
        &WMM.replace("4545.4", "nan"),
        "line 3: must have degree, order, g, h and their rates, got `nan`",
    );
    refused(&WMM.replace("9.7", ""), "line 3: must have degree, order, g, h");
    refused(&WMM.replace("4545.4", "4e12"), "line 3: must have values of up to 1e9 nT");
    refused(&SHC.replace("1 2 3 2 1", "1 2 3 6 1"), "line 2: must be linear between its years");
    refused(&SHC.replace("1 2 3 2 1", "2 2 3 2 1"), "line 2: must begin with degree 1, got 2");
    refused(&SHC.replace("1 2 3 2 1", "1 3 3 2 1"), "must have 15 rows up to degree 3, got 8");
    refused(&SHC.replace("1 2 3 2 1", "1 2 4 2 1"), "line 4: must have 4 years, got 8");
    refused(&SHC.replace("1 2 3 2 1", "1 2 99999 2 1"), "line 2: must have a number of years of up to 1000");
    refused(&SHC.replace("1 2 3 2 1", "1 900 3 2 1"), "line 2: must have a highest degree of up to 200");
    refused(&SHC.replace("2 -2 -642.17", "2 2 -642.17"), "line 11: has degree 2 and order 2 a second time");
    refused(&SHC.replace(" -734.62", ""), "line 11: must have a value for each of 3 years, got 2");
    refused(&SHC.replace("-734.62", "x"), "line 11: must have degree, order and values, got `x`");
    refused(&BLOCKS.replace("2  2   1648.7  -814.2", "3  2   1648.7  -814.2"), "row of degree 2 and order 2");
    refused(
        BLOCKS.split("2  2").next().unwrap_or_default(),
        "line 4: must be followed by 5 rows up to degree 2, got 4",
    );
    refused(&BLOCKS.replace("1  0 -29403", "1  1 -29403"), "line 2: must have degree 1 and order 0");
    assert!(read(&b"2025.0 WMM\n\xff\n"[..]).expect_err("damaged").contains("line 2: is not UTF-8"));
}

#[test]
fn files_of_any_lines_in_any_order_are_read_or_refused() {
    let nines = "9999999999999999999999999";
    let lines: Vec<&str> =
        [WMM, SHC, BLOCKS].into_iter().flat_map(str::lines).chain(["0 0 0", "1 0"]).collect();
    // Every file of up to three of the lines, and each file without each of its lines.
    for first in &lines {
        for second in &lines {
            for third in lines.iter().chain([&"", &nines]) {
                let _ = read(format!("{first}\n{second}\n{third}\n").as_bytes());
            }
        }
    }
    for file in [WMM, SHC, BLOCKS] {
        let count = file.lines().count();
        for (left_out, moved) in (0..count).flat_map(|one| (0..count).map(move |other| (one, other))) {
            let mut kept: Vec<&str> = file.lines().collect();
            let line = kept.remove(left_out);
            let _ = read(kept.join("\n").as_bytes());
            kept.insert(moved, line);
            let _ = read(kept.join("\n").as_bytes());
        }
    }
}
