//! Goal of a tuning: the quantity that is made as good as possible, and those that are kept within limits.

use std::str::FromStr;

use flexsc_formats::document::number_in;

/// Quantity that a tuning improves.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum TuningObjective {
    /// Least modulus margin of all plants, which is maximised.
    #[default]
    Margin,
    /// Longest settling time of all plants, which is minimised.
    Settling,
    /// Largest value of all plants of the requirement with this name, which is minimised: the rms of its pointing index, the
    /// value of one over time, or the loss 1 - MTF of the contrast of an image.
    Requirement(String),
}

/// Quantity that a tuning keeps within a limit, for every plant.
#[derive(Clone, Debug, PartialEq)]
pub enum TuningLimit {
    /// Least modulus margin.
    Margin(f64),
    /// Longest settling time (s).
    Settling(f64),
    /// Requirement with this name, at its limit.
    Requirement(String),
}

impl FromStr for TuningObjective {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Ok(match text.trim() {
            "" => {
                return Err(
                    "must be `margin`, `settling`, or the name of a [[requirement]], got an empty text"
                        .to_owned(),
                );
            }
            "margin" => Self::Margin,
            "settling" => Self::Settling,
            name => Self::Requirement(name.to_owned()),
        })
    }
}

impl FromStr for TuningLimit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!("must be `margin>=VALUE`, `settling<=TIME`, or the name of a [[requirement]], got {text}")
        };
        let positive = |number: &str, unit: &str| {
            let value = number_in(number, unit)?;
            if value > 0.0 { Ok(value) } else { Err(wrong()) }
        };
        match (text.split_once(">="), text.split_once("<=")) {
            (Some((name, value)), None) if name.trim() == "margin" => Ok(Self::Margin(positive(value, "")?)),
            (None, Some((name, value))) if name.trim() == "settling" => {
                Ok(Self::Settling(positive(value, "s")?))
            }
            (None, None) if !matches!(text.trim(), "" | "margin" | "settling") => {
                Ok(Self::Requirement(text.trim().to_owned()))
            }
            _ => Err(wrong()),
        }
    }
}

/// Quantity of a plant besides its margins: the smaller, the better.
#[derive(Clone, Debug, PartialEq)]
pub struct TunedMeasure {
    /// Name: `settling`, or that of a requirement.
    pub name: String,
    /// Unit.
    pub unit: &'static str,
    /// Largest value that is accepted for every plant, if there is one.
    pub limit: Option<f64>,
}

/// Goal of a tuning, in the quantities that its plants have.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TuningGoal {
    /// Quantities besides the margins.
    pub measures: Vec<TunedMeasure>,
    /// Index of the quantity that is minimised; `None` to maximise the least modulus margin.
    pub minimised: Option<usize>,
    /// Least modulus margin that every plant keeps.
    pub least_margin: Option<f64>,
    /// Frequency (rad/s) at which the loop gain of the nominal plant stays 1 or more.
    pub bandwidth: Option<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_of_objectives_and_limits() {
        assert_eq!("margin".parse(), Ok(TuningObjective::Margin));
        assert_eq!("jitter".parse(), Ok(TuningObjective::Requirement("jitter".to_owned())));
        assert_eq!("margin >= 0.5".parse(), Ok(TuningLimit::Margin(0.5)));
        assert_eq!("settling<=60".parse(), Ok(TuningLimit::Settling(60.0)));
        assert_eq!("jitter".parse(), Ok(TuningLimit::Requirement("jitter".to_owned())));
        for wrong in [
            "",
            "margin",
            "settling",
            "margin<=1",
            "settling>=3",
            "margin>=-1",
            "settling<=NaN",
            "a<=1",
            "margin>=1<=2",
        ] {
            assert!(wrong.parse::<TuningLimit>().is_err(), "{wrong}");
        }
        assert!(" ".parse::<TuningObjective>().is_err());
    }
}
