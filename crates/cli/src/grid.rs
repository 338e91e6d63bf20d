//! Grids as the command takes them.

use std::str::FromStr;

use flexsc_core::analysis::sampled_loop::Gains;

/// LO:HI:N, so many numbers from the first to the last, evenly apart: each above 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Even(pub Vec<f64>);

/// LO:HI:STEP.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Stepped(pub Gains);

/// The most points of a grid.
const MOST: u32 = 100_000;

impl Even {
    pub fn new(low: f64, high: f64, count: u32) -> Self {
        let steps = f64::from(count.max(2) - 1);
        Self((0..count).map(|i| (low * (steps - f64::from(i)) + high * f64::from(i)) / steps).collect())
    }
}

fn three(text: &str) -> Option<[&str; 3]> {
    let mut parts = text.split(':');
    let three = [parts.next()?, parts.next()?, parts.next()?];
    parts.next().is_none().then_some(three)
}

impl FromStr for Even {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parsed = three(text).and_then(|[low, high, n]| {
            Some((low.parse::<f64>().ok()?, high.parse::<f64>().ok()?, n.parse().ok()?))
        });
        match parsed {
            Some((low, high, count))
                if 0.0 < low && low <= high && high.is_finite() && (1..=MOST).contains(&count) =>
            {
                Ok(Self::new(low, high, count))
            }
            _ => Err(format!("must be LO:HI:N with 0 < LO <= HI and N from 1 to {MOST}, got {text}")),
        }
    }
}

impl FromStr for Stepped {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.parse::<f64>().ok().filter(|number| number.is_finite());
        let parsed =
            three(text).and_then(|[low, high, step]| Some((number(low)?, number(high)?, number(step)?)));
        match parsed {
            Some((low, high, step)) if low <= high && step > 0.0 && (high - low) / step < f64::from(MOST) => {
                Ok(Self(Gains { low, high, step }))
            }
            _ => Err(format!(
                "must be LO:HI:STEP with LO <= HI, STEP > 0 and at most {MOST} steps, got {text}"
            )),
        }
    }
}
