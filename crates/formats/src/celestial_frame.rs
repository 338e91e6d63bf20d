//! Frames of the equator and the equinox, as the messages of the CCSDS name them (\[CCSDS502\]).

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Axes from the planet's centre with z near its pole and x near the equinox.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "UPPERCASE")]
pub enum CelestialFrame {
    /// Mean equator and equinox of 2000.
    Eme2000,
    /// Geocentric celestial reference frame, 0.02 arc seconds from the mean axes of 2000.
    Gcrf,
    /// International celestial reference frame, with the axes of the geocentric one.
    Icrf,
    /// Mean equator and equinox of the date.
    Mod,
    /// True equator and mean equinox of the date, the axes of two-line elements.
    Teme,
    /// True equator and equinox of the date.
    Tod,
}

impl CelestialFrame {
    /// All frames with their names in orbit messages and in attitude messages: the registries are different ones.
    pub const ALL: [(Self, &'static str, &'static str); 6] = [
        (Self::Eme2000, "EME2000", "EME2000"),
        (Self::Gcrf, "GCRF", "GCRF"),
        (Self::Icrf, "ICRF", "ICRF"),
        (Self::Mod, "MOD", "MOD_EARTH"),
        (Self::Teme, "TEME", "TEMEOFDATE"),
        (Self::Tod, "TOD", "TOD_EARTH"),
    ];

    /// Returns the frame of a name in a message, in letters of either case.
    pub fn named(name: &str) -> Option<Self> {
        let is = |other: &str| name.eq_ignore_ascii_case(other);
        if is("J2000") {
            return Some(Self::Eme2000);
        }
        let is_named = |(_, orbit, attitude): &&(Self, &str, &str)| is(orbit) || is(attitude);
        Self::ALL.iter().find(is_named).map(|(frame, ..)| *frame)
    }

    /// Returns the names of the frame in orbit messages and in attitude messages.
    pub fn names(self) -> (&'static str, &'static str) {
        let (_, orbit, attitude) = Self::ALL[self as usize];
        (orbit, attitude)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_frame_is_found_by_its_names() {
        for (frame, orbit, attitude) in CelestialFrame::ALL {
            assert_eq!(frame.names(), (orbit, attitude));
            assert!([orbit, attitude].into_iter().all(|name| CelestialFrame::named(name) == Some(frame)));
        }
        assert_eq!(CelestialFrame::named("ITRF2014"), None);
    }
}
