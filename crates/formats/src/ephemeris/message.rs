//! Orbit Ephemeris Messages in keyword-value notation: states at dates in UTC, of one object in segments that follow each other.

use super::{Lines, StateTable, line_of, numbers};
use crate::calendar_date::nanoseconds;
use crate::celestial_frame::CelestialFrame;

/// Part of a message.
#[derive(Copy, Clone, PartialEq)]
enum Part {
    Header,
    Metadata,
    Rows,
    Covariance,
}

/// Metadata of a segment.
#[derive(Clone, Default, PartialEq)]
struct Metadata {
    object: String,
    frame: Option<CelestialFrame>,
    utc: bool,
}

/// Reads a message: positions in m, velocities in m/s, and times since the first row.
pub(super) fn read(lines: Lines<'_>) -> Result<StateTable, String> {
    let (mut table, mut part) = (StateTable::default(), Part::Header);
    let (mut metadata, mut before) = (Metadata::default(), None);
    for line in lines {
        let (number, line) = line_of(line)?;
        let line = line.trim();
        if line.is_empty() || line.starts_with("COMMENT") {
            continue;
        }
        let refused = |why: String| Err(format!("line {number}: {why}"));
        part = match (part, line) {
            (Part::Header | Part::Rows, "META_START") => Part::Metadata,
            (Part::Metadata, "META_STOP") => {
                metadata.is_whole().map_err(|why| format!("line {number}: {why}"))?;
                let own = std::mem::take(&mut metadata);
                if before.get_or_insert_with(|| own.clone()) != &own {
                    return refused(
                        "must end the metadata of the object and the frame of the segment before: put others into a file of \
                         their own"
                            .to_owned(),
                    );
                }
                table.frame = own.frame;
                Part::Rows
            }
            (Part::Covariance, "COVARIANCE_STOP") => Part::Rows,
            (Part::Rows, "COVARIANCE_START") => Part::Covariance,
            (Part::Header | Part::Covariance, _) => part,
            (Part::Metadata, _) => {
                let Some((key, value)) = line.split_once('=') else {
                    return refused(format!("must be `KEY = value`, got `{line}`"));
                };
                metadata.read(key.trim(), value.trim()).map_err(|why| format!("line {number}: {why}"))?;
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
                let since = (i128::from(date) - i128::from(*table.epoch_ns.get_or_insert(date))) as f64 / 1e9;
                let three = |from: usize| -> Result<[f64; 3], String> {
                    let [_, x, y, z] = numbers(&["0", fields[from], fields[from + 1], fields[from + 2]])
                        .map_err(|why| format!("line {number}: {why}"))?;
                    Ok([x, y, z].map(|kilometres| kilometres * 1e3))
                };
                let [x, y, z] = three(1)?;
                let velocity = if fields.len() >= 7 { Some(three(4)?) } else { None };
                table.push([since, x, y, z], velocity, number)?;
                part
            }
        };
    }
    if part == Part::Metadata {
        return Err(
            "must have a `META_STOP` and states behind its last `META_START`: is the file cut?".to_owned()
        );
    }
    Ok(table)
}

impl Metadata {
    /// Reads a key.
    fn read(&mut self, key: &str, value: &str) -> Result<(), String> {
        let is = |other: &str| value.eq_ignore_ascii_case(other);
        match key {
            "CENTER_NAME" if !is("earth") => {
                return Err(format!("must have `CENTER_NAME = EARTH`, got `{value}`"));
            }
            "TIME_SYSTEM" if !is("utc") => {
                return Err(format!("must have `TIME_SYSTEM = UTC`, got `{value}`"));
            }
            "TIME_SYSTEM" => self.utc = true,
            "OBJECT_ID" => self.object = value.to_ascii_uppercase(),
            "REF_FRAME" => {
                let why =
                    || format!("must have `REF_FRAME` EME2000, GCRF, ICRF, MOD, TEME or TOD, got `{value}`");
                self.frame = Some(CelestialFrame::named(value).ok_or_else(why)?);
            }
            _ => {}
        }
        Ok(())
    }

    /// Checks that all is there without which the states mean nothing.
    fn is_whole(&self) -> Result<(), String> {
        if self.frame.is_none() {
            return Err("must end metadata that have a `REF_FRAME`".to_owned());
        }
        if !self.utc {
            return Err("must end metadata that have a `TIME_SYSTEM`".to_owned());
        }
        Ok(())
    }
}
