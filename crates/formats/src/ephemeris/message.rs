//! Orbit Ephemeris Messages in keyword-value notation: one segment of states at dates, in UTC.

use super::{Lines, MOST, Rows, StateTable, line_of, numbers};
use crate::celestial_frame::CelestialFrame;

/// Part of a message.
#[derive(Copy, Clone, PartialEq)]
enum Part {
    Header,
    Metadata,
    Rows,
    Covariance,
}

/// Reads a message: positions in m, and times since the first row.
pub(super) fn read(lines: Lines<'_>) -> Result<StateTable, String> {
    let (mut rows, mut row_lines, mut first, mut frame) = (Rows::new(), Vec::new(), None, None);
    let (mut part, mut utc) = (Part::Header, false);
    for line in lines {
        let (number, line) = line_of(line)?;
        let line = line.trim();
        if line.is_empty() || line.starts_with("COMMENT") {
            continue;
        }
        let refused = |why: String| Err(format!("line {number}: {why}"));
        part = match (part, line) {
            (Part::Header, "META_START") => Part::Metadata,
            (_, "META_START") => {
                return refused("begins a second segment: the states must be in one".to_owned());
            }
            (Part::Metadata, "META_STOP") | (Part::Covariance, "COVARIANCE_STOP") => Part::Rows,
            (Part::Rows, "COVARIANCE_START") => Part::Covariance,
            (Part::Header | Part::Covariance, _) => part,
            (Part::Metadata, _) => {
                let Some((key, value)) = line.split_once('=') else {
                    return refused(format!("must be `KEY = value`, got `{line}`"));
                };
                match (key.trim(), value.trim()) {
                    ("CENTER_NAME", center) if !center.eq_ignore_ascii_case("earth") => {
                        return refused(format!("must have `CENTER_NAME = EARTH`, got `{center}`"));
                    }
                    ("TIME_SYSTEM", "UTC") => utc = true,
                    ("TIME_SYSTEM", system) => {
                        return refused(format!("must have `TIME_SYSTEM = UTC`, got `{system}`"));
                    }
                    ("REF_FRAME", name) => {
                        let Some(found) = CelestialFrame::named(name) else {
                            let why = "must have `REF_FRAME` EME2000, GCRF, ICRF, MOD, TEME or TOD";
                            return refused(format!("{why}, got `{name}`"));
                        };
                        frame = Some(found);
                    }
                    _ => {}
                }
                part
            }
            (Part::Rows, _) => {
                let fields: Vec<&str> = line.split_whitespace().collect();
                if fields.len() < 4 {
                    return refused(format!("must have a date and three coordinates (km), got `{line}`"));
                }
                let Some(date) = nanoseconds(fields[0]) else {
                    let why = "must begin with a date from 1970 to 2500, such as 2026-03-20T14:46:00";
                    return refused(format!("{why}, got `{}`", fields[0]));
                };
                let since = (i128::from(date) - i128::from(*first.get_or_insert(date))) as f64 / 1e9;
                let place = ["0", fields[1], fields[2], fields[3]];
                let [_, x, y, z] = numbers(&place).map_err(|why| format!("line {number}: {why}"))?;
                rows.push([since, x * 1e3, y * 1e3, z * 1e3]);
                row_lines.push(number);
                if rows.len() > MOST {
                    return refused(format!("must have at most {MOST} rows"));
                }
                part
            }
        };
    }
    if frame.is_none() {
        return Err("must have a `REF_FRAME`".to_owned());
    }
    if !utc {
        return Err("must have a `TIME_SYSTEM`".to_owned());
    }
    Ok(StateTable { rows, lines: row_lines, epoch_ns: first, frame })
}

/// Returns the nanoseconds after 1970 of a date: `YYYY-MM-DDThh:mm:ss` or `YYYY-DDDThh:mm:ss`, with a fraction if any.
pub(super) fn nanoseconds(text: &str) -> Option<u64> {
    let (date, time) = text.strip_suffix('Z').unwrap_or(text).split_once('T')?;
    let number = |text: &str, digits: usize, range: std::ops::RangeInclusive<i64>| {
        let is_number = text.len() == digits && text.bytes().all(|byte| byte.is_ascii_digit());
        is_number.then(|| text.parse::<i64>().ok()).flatten().filter(|number| range.contains(number))
    };
    let (year, rest) = date.split_once('-')?;
    let year = number(year, 4, 1970..=2499)?;
    let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let before = if let Some((month, day)) = rest.split_once('-') {
        let (month, day) = (number(month, 2, 1..=12)? as usize, number(day, 2, 1..=31)?);
        let lengths = [31, if leap { 29 } else { 28 }, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
        if day > lengths[month - 1] {
            return None;
        }
        lengths[..month - 1].iter().sum::<i64>() + day - 1
    } else {
        number(rest, 3, 1..=if leap { 366 } else { 365 })? - 1
    };
    let past = year - 1;
    let days = 365 * (year - 1970) + past / 4 - past / 100 + past / 400 - 477 + before;
    let mut clock = time.splitn(3, ':');
    let (hour, minute) = (number(clock.next()?, 2, 0..=23)?, number(clock.next()?, 2, 0..=59)?);
    let seconds = clock.next()?;
    let (second, fraction) = seconds.split_once('.').unwrap_or((seconds, ""));
    let second = number(second, 2, 0..=59)?;
    if !fraction.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let digits: String = fraction.chars().chain("000000000".chars()).take(9).collect();
    let total = ((days * 24 + hour) * 60 + minute) * 60 + second;
    Some(u64::try_from(total).ok()? * 1_000_000_000 + digits.parse::<u64>().ok()?)
}
