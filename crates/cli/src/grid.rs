//! Grids in command-line arguments.

use std::str::FromStr;

use flexsc_core::analysis::sampled_loop::Gains;

use crate::quantity::in_unit;

/// LO:HI:COUNT: `COUNT` evenly spaced numbers from the first to the last, each above 0.
#[derive(Clone, Debug, PartialEq)]
pub struct PositiveGrid(pub Vec<f64>);

/// LO:HI:COUNT: evenly spaced gains of any sign.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SignedGrid(pub Gains);

/// Largest number of points of a grid.
const MOST: u32 = 100_000;

impl PositiveGrid {
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

/// Returns the parser of a grid whose numbers have this unit.
pub fn grid_in(
    unit: &'static str,
) -> impl Fn(&str) -> Result<PositiveGrid, String> + Clone + Send + Sync + 'static {
    move |text| {
        let form = || format!("must be LO:HI:COUNT with 0 < LO <= HI and COUNT from 1 to {MOST}, got {text}");
        let [low, high, count] = three(text).ok_or_else(form)?;
        let (low, high) = (in_unit(unit)(low)?, in_unit(unit)(high)?);
        let count = count.trim().parse::<u32>().ok().filter(|count| (1..=MOST).contains(count));
        let count = count.filter(|_| 0.0 < low && low <= high).ok_or_else(form)?;
        Ok(PositiveGrid::new(low, high, count))
    }
}

impl FromStr for SignedGrid {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.parse::<f64>().ok().filter(|number| number.is_finite());
        let parsed = three(text)
            .and_then(|[low, high, count]| Some((number(low)?, number(high)?, count.parse::<u32>().ok()?)));
        match parsed {
            Some((low, high, 1)) if low == high => Ok(Self(Gains { low, high, step: 1.0 })),
            Some((low, high, count)) if low < high && (2..=MOST).contains(&count) => {
                Ok(Self(Gains { low, high, step: (high - low) / f64::from(count - 1) }))
            }
            _ => Err(format!(
                "must be LO:HI:COUNT with LO < HI and COUNT from 2 to {MOST}, such as -2:6:161, got {text}"
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_count_of_gains_is_that_of_the_gains_tried() {
        for (text, count, last) in [("-2:6:161", 161, 6.0), ("-1:2:13", 13, 2.0), ("0:1:50001", 50_001, 1.0)]
        {
            let SignedGrid(gains) = text.parse().expect(text);
            let values = gains.values();
            assert_eq!(values.len(), count, "{text}");
            assert!((values[count - 1] - last).abs() < 1e-12, "{text}");
        }
        assert_eq!("-2:6:161".parse(), Ok(SignedGrid(Gains { low: -2.0, high: 6.0, step: 0.05 })));
        assert_eq!("3:3:1".parse::<SignedGrid>().map(|SignedGrid(gains)| gains.values()), Ok(vec![3.0]));
        for text in ["-2:6:0.05", "6:-2:5", "1:2", "1:2:1", "0:inf:3", "0:1:0"] {
            assert!(text.parse::<SignedGrid>().is_err_and(|why| why.contains("LO:HI:COUNT")), "{text}");
        }
    }
}
