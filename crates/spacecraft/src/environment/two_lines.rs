//! Two-line elements: the columns of both lines, in which blanks are zeros, with their checksums.

use std::f64::consts::TAU;

use flexsc_formats::calendar_date::days_to;

/// Range of the mean motion (revolutions a day): that of the Moon's orbit is 0.037.
pub(super) const REVOLUTIONS: [f64; 2] = [0.05, 18.0];

/// Length of a line with its checksum, which some sources leave out.
const LENGTH: usize = 69;

/// Columns of both lines that are blank, and those with a decimal point, from 1: they show a character that is missing.
const LAYOUT: [(&[usize], &[usize]); 2] =
    [(&[2, 9, 18, 33, 44, 53, 62, 64], &[24, 35]), (&[2, 8, 17, 26, 34, 43, 52], &[12, 21, 38, 47, 55])];

/// Mean elements of SGP4.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MeanElements {
    /// Epoch (ns after 1970, UTC).
    pub epoch_ns: u64,
    /// Inclination (rad).
    pub inclination: f64,
    /// Right ascension of the ascending node (rad).
    pub node: f64,
    /// Eccentricity.
    pub eccentricity: f64,
    /// Argument of perigee (rad).
    pub perigee: f64,
    /// Mean anomaly (rad).
    pub anomaly: f64,
    /// Mean motion (rad/min).
    pub motion: f64,
    /// Drag coefficient B* (1/radii of the Earth).
    pub drag: f64,
}

/// Reads both lines; returns the index of the line with an error, and the reason.
pub(super) fn parse(lines: &[String; 2]) -> Result<MeanElements, (usize, String)> {
    for (index, line) in lines.iter().enumerate() {
        check(line, index).map_err(|why| (index, why))?;
    }
    let [first, second] = lines;
    if first[2..7] != second[2..7] {
        let why = format!("must be of the satellite of line 1, {}, got {}", &first[2..7], &second[2..7]);
        return Err((1, why));
    }
    if first.as_bytes()[62] == b'4' {
        let why = "must have the type 0 in column 63, got 4: these are elements of SGP4-XP, another theory"
            .to_owned();
        return Err((0, why));
    }
    let number = |index: usize, [from, to]: [usize; 2], prefix: &str| {
        let text = &lines[index][from - 1..to];
        // Digits behind an assumed point are in fixed places, where a blank is a zero.
        let digits = if prefix.is_empty() { text.trim() } else { text }.replace(' ', "0");
        let read = format!("{prefix}{digits}").parse::<f64>().ok().filter(|number| number.is_finite());
        read.ok_or_else(|| {
            let why = format!("must have a number in columns {from} to {to}, got `{}`", text.trim());
            (index, why)
        })
    };
    let within = |value: f64, largest: f64, [from, to]: [usize; 2]| {
        let why = || format!("must have a number from 0 to {largest} in columns {from} to {to}, got {value}");
        let ok = (0.0..=largest).contains(&value);
        ok.then_some(value).ok_or_else(|| (1, why()))
    };
    let angle = |columns: [usize; 2], largest: f64| {
        within(number(1, columns, "")?, largest, columns).map(f64::to_radians)
    };
    let (year, day) = (number(0, [19, 20], "")?, number(0, [21, 32], "")?);
    let revolutions = number(1, [53, 63], "")?;
    let [least, most] = REVOLUTIONS;
    if !(least..most).contains(&revolutions) {
        let why = format!(
            "must have a mean motion from {least} to {most} revolutions a day in columns 53 to 63, got {revolutions}"
        );
        return Err((1, why));
    }
    Ok(MeanElements {
        epoch_ns: epoch(year, day).map_err(|why| (0, why))?,
        inclination: angle([9, 16], 180.0)?,
        node: angle([18, 25], 360.0)?,
        eccentricity: number(1, [27, 33], "0.")?,
        perigee: angle([35, 42], 360.0)?,
        anomaly: angle([44, 51], 360.0)?,
        motion: revolutions * TAU / 1440.0,
        drag: exponential(&first[53..61]).ok_or_else(|| {
            let why = format!("must have B* as ` 12345-4` in columns 54 to 61, got `{}`", &first[53..61]);
            (0, why)
        })?,
    })
}

/// Checks length, characters, number and checksum of a line.
fn check(line: &str, index: usize) -> Result<(), String> {
    if !(LENGTH - 1..=LENGTH).contains(&line.len()) || !line.is_ascii() {
        return Err(format!(
            "must have {LENGTH} characters, or {} without its checksum, got {}",
            LENGTH - 1,
            line.chars().count()
        ));
    }
    if !line.starts_with(if index == 0 { "1 " } else { "2 " }) {
        return Err(format!("must begin with `{} `, got `{}`", index + 1, &line[..2]));
    }
    let Some(found) = line.get(LENGTH - 1..).filter(|found| !found.is_empty()) else {
        // Without a checksum, a character that is missing elsewhere shows in the columns.
        let (blanks, points) = LAYOUT[index];
        let moved = |columns: &[usize], expected: &str| {
            columns
                .iter()
                .find(|column| line[**column - 1..].chars().next() != expected.chars().next())
                .copied()
        };
        let wrong = moved(blanks, " ").map(|column| (column, "a blank"));
        return wrong.or(moved(points, ".").map(|column| (column, "a point"))).map_or(Ok(()), |(column, expected)| {
            Err(format!("must have {expected} in column {column}: {LENGTH} characters, or {} without its checksum", LENGTH - 1))
        });
    };
    // Digits count as they are, minus signs as 1.
    let sum: u32 = line[..LENGTH - 1]
        .chars()
        .map(|character| character.to_digit(10).unwrap_or(u32::from(character == '-')))
        .sum();
    if found == (sum % 10).to_string() {
        Ok(())
    } else {
        Err(format!("must end with its checksum, {}, got {found}", sum % 10))
    }
}

/// Reads a number with an assumed decimal point, as ` 12345-4` for 0.12345e-4; blanks are zeros.
fn exponential(text: &str) -> Option<f64> {
    let (mantissa, exponent) = text.split_at_checked(6)?;
    let (sign, digits) = match mantissa.split_at_checked(1)? {
        ("-", digits) => (-1.0, digits),
        (" " | "+", digits) => (1.0, digits),
        _ => return None,
    };
    let digits = digits.replace(' ', "0");
    if !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let exponent: i32 = exponent.replace(' ', "0").parse().ok()?;
    format!("0.{digits}e{exponent}").parse::<f64>().ok().map(|number| sign * number)
}

/// Returns the epoch (ns after 1970, UTC) of the last two digits of a year and of a day in it, from 1.
fn epoch(year: f64, day: f64) -> Result<u64, String> {
    if !(0.0..=99.0).contains(&year) || year.fract() != 0.0 {
        return Err(format!("must have two digits of a year in columns 19 to 20, got {year}"));
    }
    if !(1.0..367.0).contains(&day) {
        return Err(format!("must have a day of the year in columns 21 to 32, got {day}"));
    }
    // Years from 57 on are those of the 20th century; those before 1970 have no date here.
    let year = if year < 57.0 { 2000 + year as i64 } else { 1900 + year as i64 };
    if year < 1970 {
        return Err(format!("must have an epoch from 1970 on, got the year {year}"));
    }
    // The fraction has eight digits: multiples of 864 microseconds.
    let whole = libm::floor(day);
    let nanoseconds = libm::round((day - whole) * 1e8) * 864_000.0;
    Ok((days_to(year) as u64 + whole as u64 - 1) * 86_400_000_000_000 + nanoseconds as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINES: [&str; 2] = [
        "1 28057U 03049A   06177.78615833  .00000060  00000-0  35940-4 0  1836",
        "2 28057  98.4283 247.6961 0000884  88.1964 271.9322 14.35478080140550",
    ];

    #[test]
    fn columns_are_where_they_are_defined() {
        let found = parse(&LINES.map(str::to_owned)).unwrap();
        // 2006-06-26T18:52:04.079712Z.
        assert_eq!(found.epoch_ns, 1_151_347_924_079_712_000);
        let degrees = [found.inclination, found.node, found.perigee, found.anomaly].map(f64::to_degrees);
        for (found, expected) in degrees.into_iter().zip([98.4283, 247.6961, 88.1964, 271.9322]) {
            assert!((found - expected).abs() < 1e-12);
        }
        assert!(found.eccentricity == 8.84e-5 && found.drag == 3.594e-5);
        assert!((found.motion * 1440.0 / TAU - 14.354_780_80).abs() < 1e-13);
        assert_eq!(exponential("-11606-4"), Some(-1.1606e-5));
        assert_eq!(exponential(" 00000-0"), Some(0.0));
        assert_eq!(exponential(" 12345+1"), Some(1.2345));
    }

    /// As the published code of SGP4 reads them.
    #[test]
    fn blanks_in_fixed_columns_are_zeros() {
        let blank =
            |text: &str| LINES.map(|line| line.replace("0000884", text).replace(" 35940-4", " 3594 -4"));
        let read = |lines: [String; 2]| parse(&lines).unwrap();
        // Blanks and zeros count alike in a checksum.
        let expected = read(LINES.map(str::to_owned));
        assert_eq!(read(blank("    884")), expected);
        assert_eq!(read(blank("00008 4").map(|line| line[..68].to_owned())).eccentricity, 8.04e-5);
        assert_eq!(exponential("        "), Some(0.0));
        let open = LINES.map(|line| line[..68].to_owned());
        assert_eq!(read(open), expected);
    }

    #[test]
    fn damaged_lines_are_refused_with_their_columns() {
        let fault = |index: usize, from: &str, to: &str, checks: bool| {
            let mut lines = LINES.map(str::to_owned);
            assert!(lines[index].contains(from));
            lines[index] = lines[index].replace(from, to);
            if checks && lines[index].len() == LENGTH {
                let sum: u32 =
                    lines[index][..68].chars().map(|c| c.to_digit(10).unwrap_or(u32::from(c == '-'))).sum();
                lines[index].replace_range(68.., &(sum % 10).to_string());
            }
            parse(&lines).map_err(|(line, why)| format!("{line} {why}")).unwrap_err()
        };
        assert!(fault(0, "06177", "06178", false).contains("0 must end with its checksum, 7"));
        assert!(
            fault(1, "98.4283", "98.428", true).contains("1 must have a blank in column 17: 69 characters")
        );
        assert!(fault(1, "14.35478080", "4.35478080", true).contains("a point in column 55"));
        assert!(fault(1, "98.4283", "98.42830", true).contains("got 70"));
        assert!(fault(1, "2 28057", "2 28058", true).contains("satellite of line 1"));
        assert!(fault(1, "98.4283", "nan    ", true).contains("columns 9 to 16, got `nan`"));
        assert!(fault(1, "98.4283", "198.283", true).contains("from 0 to 180"));
        assert!(fault(1, "14.35478080", " 0.03660000", true).contains("from 0.05 to 18 revolutions"));
        assert!(fault(1, "14.35478080", "94.35478080", true).contains("mean motion"));
        assert!(fault(1, "14.35478080", "-4.35478080", true).contains("mean motion"));
        assert!(fault(0, "35940-4 0", "35940-4 4", true).contains("elements of SGP4-XP"));
        assert!(fault(0, " 35940-4", " 3594x-4", true).contains("columns 54 to 61"));
        assert!(fault(0, "06177.78615833", "06977.78615833", true).contains("day of the year"));
        assert!(fault(0, "06177.78615833", "58177.78615833", true).contains("from 1970 on"));
        assert!(fault(0, "1 28057", "3 28057", true).contains("begin with `1 `"));
        assert!(fault(0, "03049A ", "0304é ", true).contains("69 characters"));
        assert!(parse(&[String::new(), String::new()]).unwrap_err().1.contains("got 0"));
    }
}
