//! Suggestions for unknown names, and American spellings of keys.

use strsim::damerau_levenshtein;

/// Names used elsewhere, without underscores, with the names of scenarios that they may mean.
const ALIASES: &[(&str, &[&str])] = &[
    ("aop", &["perigee"]),
    ("argumentofperigee", &["perigee"]),
    ("arw", &["angle_random_walk"]),
    ("antiwindup", &["limit"]),
    ("at", &["position"]),
    ("bangbang", &["relay", "bang_bang"]),
    ("biasinstability", &["rate_random_walk"]),
    ("cg", &["centre"]),
    ("cmg", &["control_moment_gyros"]),
    ("cmgs", &["control_moment_gyros"]),
    ("centerofmass", &["centre"]),
    ("centreofmass", &["centre"]),
    ("com", &["centre"]),
    ("controller", &["law"]),
    ("control", &["law"]),
    ("controllaw", &["law"]),
    ("deadband", &["dead_zone"]),
    ("dampingratio", &["damping"]),
    ("dt", &["period"]),
    ("earth", &["limb"]),
    ("earthlimb", &["limb"]),
    ("ekf", &["extended_kalman"]),
    ("filter", &["estimator", "filters", "kalman"]),
    ("flywheel", &["wheel"]),
    ("freq", &["frequency"]),
    ("hinfinity", &["state_space"]),
    ("imu", &["gyro"]),
    ("inc", &["inclination"]),
    ("kd", &["k_d", "damping"]),
    ("kf", &["kalman"]),
    ("kp", &["k_p", "bandwidth"]),
    ("localtime", &["ltan"]),
    ("lqg", &["state_space"]),
    ("lqr", &["state_space"]),
    ("mekf", &["attitude"]),
    ("mltan", &["ltan"]),
    ("mtq", &["magnetorquers"]),
    ("naturalfrequency", &["frequency"]),
    ("observer", &["estimator"]),
    ("omega", &["frequency", "rate"]),
    ("pid", &["attitude", "pd"]),
    ("quaternion", &["attitude"]),
    ("raan", &["node"]),
    ("rategyro", &["gyro"]),
    ("reactionwheel", &["wheels", "wheel"]),
    ("reactionwheels", &["wheels"]),
    ("rrw", &["rate_random_walk"]),
    ("rw", &["wheels"]),
    ("samplerate", &["period"]),
    ("sampletime", &["period"]),
    ("sigma", &["sd", "noise"]),
    ("ss", &["state_space"]),
    ("starsensor", &["star_tracker"]),
    ("std", &["sd"]),
    ("stoptime", &["duration"]),
    ("tend", &["duration"]),
    ("thruster", &["thrusters", "jets"]),
    ("time", &["duration"]),
    ("tfinal", &["duration"]),
    ("torquerods", &["magnetorquers"]),
    ("tracker", &["star_tracker"]),
    ("trueanomaly", &["anomaly"]),
    ("ts", &["period"]),
    ("ukf", &["unscented_kalman"]),
    ("w", &["frequency"]),
    ("zeta", &["damping"]),
];

/// Features that do not exist, with the hint to give instead.
const ABSENT: &[(&str, &str)] = &[
    ("like", "an appendage is written as often as the spacecraft has it; `turned` rotates one"),
    ("mpc", "there is no predictive control; a linear one goes into `state_space`"),
    ("slidingmode", "there is no sliding mode; `relay` and `phase_plane` switch"),
    ("lidar", "there is no lidar"),
    ("gps", "there is no GPS: the orbit is given"),
    ("gnss", "there is no GNSS: the orbit is given"),
    ("slosh", "a pendulum or a sprung mass is an `[[appendage]]` with a mode of its own"),
];

/// American spellings of keys, with the spellings of scenarios.
const SPELLINGS: &[(&str, &str)] = &[("maneuver", "manoeuvre"), ("center", "centre")];

/// Returns a hint for a name that is not among the known ones, if there is one.
pub fn hint(name: &str, known: &[&str]) -> Option<String> {
    let written = plain(name);
    if let Some(nearest) = nearest(&written, known) {
        return Some(format!("did you mean `{nearest}`?"));
    }
    ABSENT.iter().find(|(absent, _)| *absent == written).map(|(_, instead)| (*instead).to_owned())
}

/// Returns the known name that an unknown one was probably meant to be.
pub fn nearest_name<'a>(name: &str, known: &[&'a str]) -> Option<&'a str> {
    nearest(&plain(name), known)
}

/// Returns true if a wrong name is a synonym of a known name, not a misspelling.
pub fn is_other_word(name: &str) -> bool {
    let written = plain(name);
    ALIASES.iter().any(|(alias, _)| *alias == written)
}

fn nearest<'a>(written: &str, known: &[&'a str]) -> Option<&'a str> {
    if written.is_empty() {
        return None;
    }
    let aliases = ALIASES.iter().find(|(alias, _)| *alias == written).map_or(&[][..], |(_, names)| names);
    if let Some(name) = aliases.iter().find_map(|name| known.iter().find(|known| *known == name)) {
        return Some(name);
    }
    // A third of the letters may be wrong; the first of the nearest names counts.
    let most = written.chars().count().div_ceil(3);
    let distance = |name: &&&str| damerau_levenshtein(written, &plain(name));
    // Names of other lengths have larger distances: a name of a million letters is compared with none.
    let alike = known.iter().filter(|name| plain(name).len().abs_diff(written.len()) <= most);
    let near = alike.min_by_key(distance).filter(|name| distance(name) <= most && written.len() > 1);
    let begins = |name: &&&str| {
        written.len() >= 3 && (plain(name).starts_with(written) || written.starts_with(&plain(name)))
    };
    near.or_else(|| known.iter().find(begins)).copied()
}

/// Returns a name reduced to its letters and digits, in lower case.
fn plain(name: &str) -> String {
    name.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect()
}

/// Returns a key in the spelling of scenarios.
pub fn british_spelling(key: &str) -> &str {
    SPELLINGS.iter().find(|(american, _)| *american == key).map_or(key, |(_, british)| british)
}

/// Returns the American spelling of a key, if it differs.
pub fn american_spelling(key: &str) -> Option<&'static str> {
    SPELLINGS.iter().find(|(_, british)| *british == key).map(|(american, _)| *american)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn typos_other_names_and_what_there_is_not() {
        let laws = ["relay", "pd", "attitude", "state_space", "open", "phase_plane"];
        assert_eq!(nearest_name("rely", &laws), Some("relay"));
        assert_eq!(nearest_name("PhasePlane", &laws), Some("phase_plane"));
        assert_eq!(nearest_name("lqg", &laws), Some("state_space"));
        assert_eq!(nearest_name("zzz", &laws), None);
        assert_eq!(nearest_name("kt", &["dead_zone", "k_t"]), Some("k_t"));
        assert_eq!(nearest_name("deadzone", &["dead_zone", "k_t"]), Some("dead_zone"));
        assert_eq!(nearest_name("traker", &["gyro", "star_tracker"]), None);
        assert!(hint("mpc", &laws).is_some_and(|why| why.contains("there is no predictive control")));
        assert_eq!(nearest_name("raan", &["inclination", "node"]), Some("node"));
        assert_eq!(nearest_name("MLTAN", &["altitude", "ltan"]), Some("ltan"));
        for (alias, _) in ALIASES {
            assert_eq!(plain(alias), *alias);
        }
    }
}
