//! Search for the worst point of a box: points spread over it, its corners, and pattern searches from the worst of them.

use std::collections::BTreeMap;

use crate::campaign::{Dimension, MOST_DIMENSIONS, Sampling};

/// Number of points from which pattern searches start.
const STARTS: usize = 3;
/// Distance in parts of a range within which two points are one start.
const APART: f64 = 0.25;
/// Step of a pattern search at its start, in parts of the ranges.
const FIRST_STEP: f64 = 0.25;
/// Step below which a pattern search ends.
const LAST_STEP: f64 = 1e-7;

/// Value at a point.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Assessed {
    /// Number that the search increases; NaN at a point without a value.
    pub badness: f64,
    /// Value of the quantity.
    pub value: f64,
}

/// Point of the box with its value.
#[derive(Clone, Debug, PartialEq)]
pub struct SearchPoint {
    /// Coordinates: parts of the ranges, from 0 to 1.
    pub parts: Vec<f64>,
    /// Value there.
    pub assessed: Assessed,
}

/// Search of a box.
#[derive(Copy, Clone, Debug)]
pub struct BoxSearch {
    /// Number of keys: dimensions of the box.
    pub keys: usize,
    /// Largest number of points that are assessed.
    pub most: usize,
    /// Seed of the points that are spread over the box.
    pub seed: u64,
}

/// Points that were assessed.
struct Assessments<F> {
    assess: F,
    points: Vec<SearchPoint>,
    /// Index of each point, by the bits of its coordinates.
    places: BTreeMap<Vec<u64>, usize>,
}

impl<E, F: FnMut(&[Vec<f64>]) -> Result<Vec<Assessed>, E>> Assessments<F> {
    /// Assesses the new ones of some points together, and returns the worst one's index.
    fn add(&mut self, points: Vec<Vec<f64>>) -> Result<Option<usize>, E> {
        let bits = |parts: &Vec<f64>| -> Vec<u64> { parts.iter().map(|part| part.to_bits()).collect() };
        let mut indices = Vec::with_capacity(points.len());
        let mut new = Vec::new();
        for parts in points {
            let next = self.points.len() + new.len();
            let index = *self.places.entry(bits(&parts)).or_insert(next);
            if index == next {
                new.push(parts);
            }
            indices.push(index);
        }
        let assessed = if new.is_empty() { Vec::new() } else { (self.assess)(&new)? };
        let added = new.into_iter().zip(assessed);
        self.points.extend(added.map(|(parts, assessed)| SearchPoint { parts, assessed }));
        Ok(self.worst_of(indices))
    }

    /// Returns the index of the worst of some points, the first of equal ones.
    fn worst_of(&self, indices: impl IntoIterator<Item = usize>) -> Option<usize> {
        let has_value = |index: &usize| !self.badness(*index).is_nan();
        indices
            .into_iter()
            .filter(has_value)
            .reduce(|worst, other| if self.badness(other) > self.badness(worst) { other } else { worst })
    }

    fn badness(&self, index: usize) -> f64 {
        self.points[index].assessed.badness
    }

    /// Returns the worst points that are apart from each other.
    fn starts(&self) -> Vec<usize> {
        let mut order: Vec<usize> =
            (0..self.points.len()).filter(|index| !self.badness(*index).is_nan()).collect();
        order.sort_by(|a, b| self.badness(*b).total_cmp(&self.badness(*a)).then(a.cmp(b)));
        let mut starts: Vec<usize> = Vec::new();
        for index in order {
            let here = &self.points[index].parts;
            let is_apart = |other: &usize| {
                here.iter().zip(&self.points[*other].parts).any(|(a, b)| (a - b).abs() > APART)
            };
            if starts.iter().all(is_apart) {
                starts.push(index);
            }
            if starts.len() == STARTS {
                break;
            }
        }
        starts
    }
}

impl BoxSearch {
    /// Searches the box from `own` and the worst of `starts`, or of points spread over it without any. Returns all points in the
    /// order in which they were assessed, that of `own` first, and the index of the worst one; none if no point has a value.
    /// `assess` returns the values of some points.
    ///
    /// # Errors
    /// Errors of `assess`.
    pub fn run<E>(
        &self,
        own: Vec<f64>,
        starts: Vec<Vec<f64>>,
        assess: impl FnMut(&[Vec<f64>]) -> Result<Vec<Assessed>, E>,
    ) -> Result<(Vec<SearchPoint>, Option<usize>), E> {
        let mut found = Assessments { assess, points: Vec::new(), places: BTreeMap::new() };
        let mut first = vec![own];
        first.extend(if starts.is_empty() { self.spread() } else { starts });
        found.add(first)?;
        for start in found.starts() {
            self.climb(start, &mut found)?;
        }
        let worst = found.worst_of(0..found.points.len());
        Ok((found.points, worst))
    }

    /// Returns the corners, if they are a quarter of the points at most, and points between, up to half of all.
    fn spread(&self) -> Vec<Vec<f64>> {
        let half = self.most / 2;
        let corners = u32::try_from(self.keys).ok().and_then(|keys| 1_usize.checked_shl(keys));
        let corners = corners.filter(|count| *count <= self.most / 4).unwrap_or(0);
        let corner = |index: usize| (0..self.keys).map(|key| ((index >> key) & 1) as f64).collect();
        let between = half.saturating_sub(corners);
        let sampling = if self.keys <= MOST_DIMENSIONS { Sampling::Sobol } else { Sampling::LatinHypercube };
        let point = |index: usize| {
            let part = |place: usize| {
                let dimension = Dimension { seed: self.seed, name: "worst", place };
                sampling.number(dimension, index as u64, between as u64)
            };
            (0..self.keys).map(part).collect()
        };
        (0..corners).map(corner).chain((0..between).map(point)).collect()
    }

    /// Searches from a point: the worst neighbour along the axes becomes the next point, and where there is none that
    /// is worse, the neighbours move closer.
    fn climb<E, F: FnMut(&[Vec<f64>]) -> Result<Vec<Assessed>, E>>(
        &self,
        start: usize,
        found: &mut Assessments<F>,
    ) -> Result<(), E> {
        // Starts share what is left, so that the first one does not use it all.
        let most = found.points.len() + (self.most - self.most / 2) / STARTS;
        let (mut here, mut step) = (start, FIRST_STEP);
        let mut last: Option<Vec<f64>> = None;
        while step > LAST_STEP && found.points.len() < most.min(self.most) {
            let parts = found.points[here].parts.clone();
            let moved = |key: usize, change: f64| {
                let mut point = parts.clone();
                point[key] = (point[key] + change).clamp(0.0, 1.0);
                point
            };
            let mut neighbours: Vec<Vec<f64>> =
                (0..self.keys).flat_map(|key| [moved(key, step), moved(key, -step)]).collect();
            // The last move once more: ridges are not along the axes.
            if let Some(before) = &last {
                let ahead = parts.iter().zip(before).map(|(now, then)| (2.0 * now - then).clamp(0.0, 1.0));
                neighbours.push(ahead.collect());
            }
            neighbours.retain(|point| *point != parts);
            neighbours.truncate(self.most - found.points.len());
            match found.add(neighbours)? {
                Some(worse) if found.badness(worse) > found.badness(here) => {
                    last = Some(parts);
                    here = worse;
                }
                _ => {
                    step *= 0.5;
                    last = None;
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn search(keys: usize, value: impl Fn(&[f64]) -> f64) -> (Vec<SearchPoint>, SearchPoint) {
        let assess = |points: &[Vec<f64>]| {
            Ok::<_, ()>(
                points
                    .iter()
                    .map(|point| Assessed { badness: value(point), value: value(point) })
                    .collect::<Vec<_>>(),
            )
        };
        let search = BoxSearch { keys, most: 1000, seed: 1 };
        let (points, worst) = search.run(vec![0.5; keys], Vec::new(), assess).expect("no error");
        let worst = points[worst.expect("a value")].clone();
        (points, worst)
    }

    #[test]
    fn the_worst_of_a_smooth_function_is_found_within() {
        let (points, worst) =
            search(3, |x| -(x[0] - 0.3) * (x[0] - 0.3) - 2.0 * (x[1] - x[0]) * (x[1] - x[0]) + x[2]);
        for (found, expected) in worst.parts.iter().zip([0.3, 0.3, 1.0]) {
            assert!((found - expected).abs() < 1e-3, "{worst:?}");
        }
        assert!(points.len() <= 1000 && points[0].parts == [0.5; 3]);
    }

    #[test]
    fn a_search_from_given_points_spreads_none() {
        let assess = |points: &[Vec<f64>]| {
            Ok::<_, ()>(points.iter().map(|x| Assessed { badness: x[0], value: x[0] }).collect::<Vec<_>>())
        };
        let search = BoxSearch { keys: 1, most: 100, seed: 1 };
        let (points, worst) = search.run(vec![0.5], vec![vec![0.875]], assess).expect("no error");
        assert_eq!((&points[1].parts[..], &points[2].parts[..]), (&[0.875][..], &[1.0][..]));
        assert_eq!(worst, Some(2));
    }

    #[test]
    fn points_without_a_value_are_no_worst_ones() {
        let (_, worst) = search(2, |x| if x[0] > 0.5 { f64::NAN } else { x[0] + x[1] });
        assert!((worst.assessed.value - 1.5).abs() < 1e-4, "{worst:?}");
        let nothing =
            |points: &[Vec<f64>]| Ok::<_, ()>(vec![Assessed { badness: f64::NAN, value: 0.0 }; points.len()]);
        let search = BoxSearch { keys: 2, most: 20, seed: 1 };
        assert_eq!(search.run(vec![0.5; 2], Vec::new(), nothing).expect("no error").1, None);
    }

    #[test]
    fn many_keys_are_spread_without_their_corners() {
        let (points, worst) = search(120, |x| x.iter().sum());
        assert!(points.len() <= 1000);
        assert!(worst.assessed.value > 65.0);
    }
}
