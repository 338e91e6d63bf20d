//! Units that a reader asks for, such as `deg, mN m`, in place of those that fit.

use std::str::FromStr;

use crate::document::{units_ratio, unknown_unit};

/// Units that were asked for.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct ChosenUnits(&'static [&'static str]);

impl ChosenUnits {
    /// Returns the names of the units.
    pub fn names(self) -> &'static [&'static str] {
        self.0
    }

    /// Returns the unit that measures a quantity of an SI unit, with its size, if one was asked for; `usual` is the unit in
    /// which the quantity is read otherwise.
    pub fn measuring(self, unit: &str, usual: &str) -> Option<(&'static str, f64)> {
        let is_alike = |name: &str| {
            // Frequencies, speeds of rotors and other rates have one SI unit, energies and torques one dimension.
            let is_rate =
                unit != "rad/s" || [name, usual].contains(&unit) || Rate::named(name) == Rate::named(usual);
            is_rate && name.contains('J') == unit.contains('J')
        };
        let sized = |name: &&'static str| Some((*name, units_ratio(name, unit)?));
        self.0.iter().filter(|name| is_alike(name)).find_map(sized)
    }
}

/// Kind of an angular rate.
#[derive(PartialEq)]
enum Rate {
    Frequency,
    Rotor,
    Body,
}

impl Rate {
    fn named(name: &str) -> Self {
        match name {
            name if name.contains("Hz") => Self::Frequency,
            name if name.contains("rpm") => Self::Rotor,
            _ => Self::Body,
        }
    }
}

/// Returns the first two units that measure the same quantities.
fn twice(names: &[&'static str]) -> Option<[&'static str; 2]> {
    names.iter().enumerate().find_map(|(place, other)| {
        let is_same = |first: &&&str| {
            units_ratio(first, other).is_some()
                && Rate::named(first) == Rate::named(other)
                && first.contains('J') == other.contains('J')
        };
        Some([*names[..place].iter().find(is_same)?, *other])
    })
}

impl FromStr for ChosenUnits {
    type Err = String;

    /// Reads units that are separated by commas. They are kept for as long as the program runs: it reads them once.
    fn from_str(text: &str) -> Result<Self, String> {
        let text: &'static str = Box::leak(text.to_owned().into_boxed_str());
        let names: Vec<&'static str> =
            text.split(',').map(str::trim).filter(|name| !name.is_empty()).collect();
        match names.iter().find(|name| units_ratio(name, name).is_none()) {
            Some(unknown) => Err(format!("`{unknown}` is not a unit{}", unknown_unit(unknown))),
            None if names.is_empty() => Err("names no unit".to_owned()),
            None => match twice(&names) {
                Some([first, other]) => {
                    Err(format!("`{first}` and `{other}` are units of one quantity: give one of them"))
                }
                None => Ok(Self(Box::leak(names.into_boxed_slice()))),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_is_that_of_what_it_measures() {
        let chosen: ChosenUnits = "deg, mN m,Hz, rpm,mJ, h".parse().expect("units");
        for (unit, usual, name) in [
            ("rad", "arcsec", Some("deg")),
            ("N m", "µN m", Some("mN m")),
            ("rad/s", "Hz", Some("Hz")),
            ("rad/s", "rpm", Some("rpm")),
            ("rad/s", "deg/s", None),
            ("J", "pJ", Some("mJ")),
            ("s", "s", Some("h")),
            ("kg", "kg", None),
        ] {
            assert_eq!(chosen.measuring(unit, usual).map(|(name, _)| name), name, "{unit}");
        }
        assert_eq!(chosen.measuring("J", "J"), Some(("mJ", 1e-3)));
        let si: ChosenUnits = "rad/s".parse().expect("a unit");
        assert_eq!([si.measuring("rad/s", "Hz"), si.measuring("rad/s", "deg/s")], [Some(("rad/s", 1.0)); 2]);
    }

    #[test]
    fn what_is_no_unit_is_refused() {
        for (text, why) in [
            ("deg, arcsecond", "did you mean `arcsec`?"),
            ("deg, bla", "known are"),
            (" ,", "names no unit"),
            ("deg, mN m, arcsec", "`deg` and `arcsec` are units of one quantity"),
        ] {
            assert!(text.parse::<ChosenUnits>().is_err_and(|error| error.contains(why)), "{text}");
        }
    }
}
