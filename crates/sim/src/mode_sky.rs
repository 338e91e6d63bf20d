//! Sky of the modes of operation: quantities that are known before a run, by orbit, Sun and faults, and the instants at which
//! they pass numbers.

use flexsc_control::interval::Interval;
use flexsc_control::operation::{ModeQuantity, ModeTarget};
use flexsc_numerics::time::{Instant, Span};
use flexsc_spacecraft::environment::{GroundSite, OrbitEnvironment, OrbitPath};

use flexsc_scenario::Scenario;

/// Shortest step of the search (s): a shorter excursion beyond a number may be missed.
const SHORTEST: f64 = 1e-4;

/// Sky with the ground site of each mode.
#[derive(Clone, Debug, Default)]
pub struct ModeSky {
    sky: OrbitEnvironment,
    sites: Vec<Option<GroundSite>>,
    /// Fault of the run by its index, with the intervals of its failures.
    fault: Option<(usize, Vec<Interval>)>,
    /// Times (s), in order, at which a shadow or a failure of the fault begins or ends.
    edges: Vec<f64>,
}

impl ModeSky {
    /// Creates the sky of a scenario; an empty one without modes and requirements.
    pub fn new(scenario: &Scenario) -> Self {
        if scenario.mode.is_empty() && scenario.requirement.is_empty() {
            return Self::default();
        }
        let site = |target: &Option<ModeTarget>| target.as_ref().and_then(ModeTarget::site);
        let sky = scenario.orbit_environment();
        let fault = scenario.fault_of_run().map(|(index, fault)| (index, fault.intervals().collect()));
        let intervals = fault.iter().flat_map(|(_, intervals): &(usize, Vec<Interval>)| intervals);
        let of_fault = intervals.flat_map(|own| [Some(own.start()), own.end()]).flatten();
        let mut edges: Vec<f64> = sky.shadow_edges().chain(of_fault).map(Instant::seconds).collect();
        edges.sort_by(f64::total_cmp);
        Self { sky, edges, fault, sites: scenario.mode.iter().map(|mode| site(&mode.target)).collect() }
    }

    /// Returns the times (s) between two others at which a shadow or a failure of the fault begins or ends.
    pub fn edges(&self, from: f64, to: f64) -> &[f64] {
        let first = self.edges.partition_point(|edge| *edge <= from);
        let count = self.edges[first..].partition_point(|edge| *edge < to);
        &self.edges[first..first + count]
    }

    /// Returns true if a fault is that of the run.
    pub fn has_fault(&self, index: usize) -> bool {
        self.fault.as_ref().is_some_and(|(own, _)| *own == index)
    }

    /// Returns true if a quantity stays as it is at a time (s) until the next edge.
    pub fn is_steady(&self, quantity: ModeQuantity, t: f64) -> bool {
        match quantity {
            ModeQuantity::Fault(_) => true,
            ModeQuantity::TrueSunlight => self.sky.light_rate(t) == 0.0,
            _ => false,
        }
    }

    /// Returns a quantity of the sky in its unit at a time since the start (s); NaN of any other quantity.
    pub fn value(&self, quantity: ModeQuantity, t: f64) -> f64 {
        match quantity {
            ModeQuantity::Sunlight | ModeQuantity::TrueSunlight => self.sky.part_in_view(t),
            ModeQuantity::Elevation(mode) | ModeQuantity::TrueElevation(mode) => {
                self.elevation(mode, t).unwrap_or(f64::NAN)
            }
            ModeQuantity::Fault(index) => {
                let now = Instant::START + Span::from_seconds(t);
                let acts = |(own, intervals): &(usize, Vec<Interval>)| {
                    *own == index && intervals.iter().any(|interval| interval.contains(now))
                };
                f64::from(u8::from(self.fault.as_ref().is_some_and(acts)))
            }
            _ => f64::NAN,
        }
    }

    /// Returns the elevation (rad) above the horizon of the site of a mode.
    fn elevation(&self, mode: usize, t: f64) -> Option<f64> {
        let site = self.sites.get(mode)?.as_ref()?;
        Some(site.elevation(&self.sky.position(t)?.position, self.sky.greenwich(), t))
    }

    /// Returns the instants of a run at which a quantity passes a number, each the first instant of the new order.
    pub fn crossings(&self, quantity: ModeQuantity, limit: f64) -> Vec<Instant> {
        let end = self.sky.duration();
        let order = |t: f64| self.value(quantity, t).partial_cmp(&limit);
        let (mut t, mut last, mut found) = (0.0, order(0.0), Vec::new());
        while t < end {
            let next = (t + self.steady_time(quantity, t, limit).max(SHORTEST)).min(end);
            let here = order(next);
            if here != last {
                found.push(first_change(&order, [t, next]));
            }
            (t, last) = (next, here);
        }
        found
    }

    /// Returns a time (s) within which a quantity does not reach a number, or 0.
    fn steady_time(&self, quantity: ModeQuantity, t: f64, limit: f64) -> f64 {
        let off = (self.value(quantity, t) - limit).abs();
        match quantity {
            ModeQuantity::TrueSunlight => {
                let rate = self.sky.light_rate(t);
                if rate > 0.0 {
                    return off / rate;
                }
                let edge = self.sky.shadow_edges().map(Instant::seconds).find(|edge| *edge > t);
                edge.map_or(f64::INFINITY, |edge| edge - t)
            }
            ModeQuantity::TrueElevation(mode) => {
                let site = self.sites.get(mode).and_then(Option::as_ref);
                let Some((site, place)) = site.zip(self.sky.position(t)) else { return f64::INFINITY };
                let speed = self.sky.orbit().map_or(0.0, OrbitPath::largest_speed);
                site.steady_time(&place.position, self.sky.greenwich(), t, [speed, off])
            }
            _ => f64::INFINITY,
        }
    }
}

/// Returns the first instant of an interval (s) at which the order is that of its end.
fn first_change<T: PartialEq>(order: &dyn Fn(f64) -> T, ends: [f64; 2]) -> Instant {
    let [mut low, mut high] = ends.map(|t| Instant::START + Span::from_seconds(t));
    let there = order(high.seconds());
    loop {
        let middle = low + Span::from_seconds(0.5 * high.since(low).seconds());
        if middle <= low || middle >= high {
            return high;
        }
        if order(middle.seconds()) == there {
            high = middle;
        } else {
            low = middle;
        }
    }
}
