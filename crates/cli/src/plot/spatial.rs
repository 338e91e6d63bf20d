//! Figures of a three-axis body: `rates`, `energy`, `position`, `jets`, and of its adaptive observers `tracking` and
//! `damping`, from its repeated run.

use std::path::Path;

use flexsc_core::Simulation;
use flexsc_core::numerics::attitude::AXES;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{
    Accelerations, AttitudeEstimate, Bearings, ChannelState, ControlMomentGyros, DrivesMotion,
    ElasticEstimates, Hinges, Log, Magnetorquers, Orbit, Position, Record, RecordError, Sample,
    ThreeAxisCycle, ThreeAxisMotionSample, Torques, TrackedMode, Tracking, Wheels,
};
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour, steps};

use super::run_events::{RunEvents, unusable};
use super::{time, title};
use crate::error::CliError;

/// Number of marks above which they are small.
const MANY: usize = 100;
/// Fraction of the values about other axes below which values are rounding errors, and drawn at the others' scale.
const ROUNDING: f64 = 1e-9;

/// Data of a repeated run.
#[derive(Default)]
pub struct CycleData {
    all: Vec<(f64, ThreeAxisCycle)>,
    tracking: Vec<(f64, Tracking)>,
    /// Estimates of an attitude filter at each sample.
    pub attitude: Vec<(f64, AttitudeEstimate)>,
    /// Filter estimates of the elastic modes.
    pub elastic: Vec<(f64, ElasticEstimates)>,
    /// States of the wheels, at each period of the log.
    pub wheels: Vec<(f64, Wheels)>,
    /// States of the control moment gyros, at each period of the log.
    pub gimbals: Vec<(f64, ControlMomentGyros)>,
    /// Position on the orbit, at each period of the log.
    pub orbit: Vec<(f64, Orbit)>,
    /// Magnetic moments, at each period of the log.
    pub magnetorquers: Vec<(f64, Magnetorquers)>,
    /// Position of the first point and its velocity, at each period of the log.
    position: Vec<(f64, Position)>,
    /// Readings of the accelerometers.
    pub accelerations: Vec<(f64, Accelerations)>,
    /// States of the wheels' bearings, if any.
    pub bearings: Vec<(f64, Bearings)>,
    /// Torques on the body, except of jets that act alone.
    pub torques: Vec<(f64, Torques)>,
    /// Displacements of the elastic modes (m sqrt(kg)).
    pub modes: Vec<(f64, Vec<f64>)>,
    /// States of the appendages' drives, if any.
    pub drives: Vec<(f64, DrivesMotion)>,
    /// States of the appendages' hinges, if any.
    pub hinges: Vec<(f64, Hinges)>,
}

impl CycleData {
    /// Repeats the run of a log.
    pub fn read(story: &RunEvents, log: &Log, path: &Path) -> Result<Self, CliError> {
        let mut cycles = Self::default();
        // The end of a torn log is rounded, and a cycle may lie on it.
        let end = Span::from_seconds(story.end + 1e-9).min(story.scenario.duration);
        let mut simulation = Simulation::new(&story.scenario, story.run);
        story
            .commanded
            .run_until(&mut simulation, Instant::START + end, &mut cycles)
            .map_err(|source| CliError::Run { name: story.scenario.name.clone(), source })?;
        let jets = log.tables(&["/jets"])?.pop().flatten().unwrap_or_default();
        let logged = jets.numbers("fuel_kg").unwrap_or_default();
        let fired = cycles.all.iter().filter(|(_, cycle)| cycle.pulses > 0);
        if !fired.map(|(_, cycle)| cycle.jets.fuel_kg).take(logged.len()).eq(logged.iter().copied()) {
            let version = log.metadata().get("version").map_or("another", String::as_str);
            let own = env!("CARGO_PKG_VERSION");
            let why = format!("flexsc {own} fires at other times than this log of version {version}");
            return Err(unusable(path, why));
        }
        Ok(cycles)
    }

    pub fn over_time(&self, value_of: impl Fn(&ThreeAxisCycle) -> f64) -> Vec<Point> {
        self.all.iter().map(|(time, cycle)| (*time, value_of(cycle))).collect()
    }
}

impl Record for CycleData {
    fn wants_motion(&self) -> bool {
        true
    }

    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        match sample {
            Sample::Cycle(cycle) => self.all.push((now.seconds(), cycle.clone())),
            Sample::Tracking(tracking) => self.tracking.push((now.seconds(), tracking.clone())),
            Sample::Accelerations(row) => self.accelerations.push((now.seconds(), row.clone())),
            Sample::AttitudeEstimate(row) => self.attitude.push((now.seconds(), row.clone())),
            Sample::ElasticEstimates(row) => self.elastic.push((now.seconds(), row.clone())),
            Sample::SpatialMotion(ThreeAxisMotionSample {
                wheels,
                gimbals,
                orbit,
                magnetorquers,
                position,
                bearings,
                drives,
                hinges,
                torques,
                vibrations,
                ..
            }) => {
                let t = now.seconds();
                self.wheels.extend(wheels.clone().map(|wheels| (t, wheels)));
                self.gimbals.extend(gimbals.iter().map(|gimbals| (t, gimbals.clone())));
                self.orbit.extend(orbit.clone().map(|orbit| (t, orbit)));
                self.magnetorquers.extend(magnetorquers.clone().map(|moments| (t, moments)));
                self.position.extend(position.iter().map(|position| (t, position.clone())));
                self.torques.extend(torques.iter().map(|torques| (t, torques.clone())));
                self.modes.push((t, vibrations.modes.iter().map(|mode| mode.displacement).collect()));
                self.drives.extend(drives.iter().map(|drives| (t, drives.clone())));
                self.hinges.extend(hinges.iter().map(|hinges| (t, hinges.clone())));
                self.bearings.extend(bearings.iter().map(|bearings| (t, bearings.clone())));
            }
            _ => {}
        }
        Ok(())
    }
}

/// Returns a panel for each axis, with lines of given names and colours.
pub fn panels(story: &RunEvents, unit: &'static str, lines: impl Fn(usize) -> Vec<Layer>) -> Vec<Panel> {
    let all = [0, 1, 2].map(lines);
    let values = |layers: &[Layer]| -> Vec<f64> {
        layers.iter().flat_map(|layer| &layer.points).map(|(_, value)| *value).collect()
    };
    let size =
        |layers: &[Layer]| values(layers).into_iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let largest = all.iter().map(|layers| size(layers)).fold(0.0, f64::max);
    let panel = |((axis, name), layers): ((usize, &&str), Vec<Layer>)| {
        let x = time(0.0..story.end);
        let y = if size(&layers) < ROUNDING * largest {
            FigureAxis::around(name, unit, [-largest, largest])
        } else {
            FigureAxis::around(name, unit, values(&layers))
        };
        Panel { x: if axis == 2 { x } else { x.unnamed() }, y, layers, bar: None }
    };
    AXES.iter().enumerate().zip(all).map(panel).collect()
}

/// Returns the figure of the rigid rates, and of the rates with their elastic part, which an ideal gyro would measure.
pub fn rates(story: &RunEvents, cycles: &CycleData) -> Figure {
    let lines = |axis: usize| {
        let measured = cycles.over_time(|c| c.rigid_rate_rad_s[axis] + c.elastic_rate_rad_s[axis]);
        let rigid = cycles.over_time(|c| c.rigid_rate_rad_s[axis]);
        let name = |name| if axis == 0 { name } else { "" };
        vec![
            // If both coincide, the wider line remains visible.
            Layer::new(name("at the gyro, with elastic part"), colour::SKY, LayerShape::Line(2.8), measured),
            Layer::new(name("rigid part"), colour::BLACK, LayerShape::Line(1.0), rigid),
        ]
    };
    Figure { title: title(story, "rates"), panels: panels(story, "rad/s", lines), panel_height: 160 }
}

/// Returns the figure of the position of the first point, and its velocity.
pub fn position(story: &RunEvents, cycles: &CycleData) -> Figure {
    let panel = |x: FigureAxis, name: &str, unit: &'static str, coordinates: [fn(&Position) -> f64; 3]| {
        let line = |(axis, colour): (usize, _)| {
            let points =
                cycles.position.iter().map(|(time, position)| (*time, coordinates[axis](position))).collect();
            Layer::new(["x", "y", "z"][axis], colour, LayerShape::Line(1.2), points)
        };
        let layers: Vec<Layer> =
            [colour::BLUE, colour::ORANGE, colour::GREEN].into_iter().enumerate().map(line).collect();
        let values = layers.iter().flat_map(|layer| &layer.points).map(|(_, value)| *value);
        Panel { x, y: FigureAxis::around(name, unit, values.collect::<Vec<_>>()), layers, bar: None }
    };
    let x = time(0.0..story.end);
    let places: [fn(&Position) -> f64; 3] =
        [|position| position.x_m, |position| position.y_m, |position| position.z_m];
    let rates: [fn(&Position) -> f64; 3] =
        [|position| position.x_m_s, |position| position.y_m_s, |position| position.z_m_s];
    Figure {
        title: title(story, "position in inertial axes"),
        panels: vec![panel(x.unnamed(), "position", "m", places), panel(x, "velocity", "m/s", rates)],
        panel_height: 220,
    }
}

/// Returns the figure of the elastic modes' energy, and of the jets' propellant.
pub fn energy(story: &RunEvents, cycles: &CycleData) -> Figure {
    let elastic = cycles.over_time(|cycle| cycle.elastic_energy_j);
    let fuel = cycles.over_time(|cycle| cycle.jets.fuel_kg);
    let panel = |x: FigureAxis, name: &str, unit: &'static str, points: Vec<Point>| Panel {
        x,
        y: FigureAxis::from_zero(name, unit, points.iter().map(|(_, value)| *value).collect::<Vec<_>>()),
        layers: vec![Layer::new(name, colour::BLUE, LayerShape::Line(1.2), points)],
        bar: None,
    };
    let x = time(0.0..story.end);
    let fires = fuel.iter().any(|(_, used)| used.is_finite());
    let below = if fires { x.unnamed() } else { x.clone() };
    let mut energies = panel(below, "elastic energy", "J", elastic);
    // If both coincide, the wider line remains visible.
    energies.layers[0].shape = LayerShape::Line(3.2);
    energies.layers[0].colour = colour::SKY;
    "all modes".clone_into(&mut energies.layers[0].name);
    let visible = cycles.over_time(|cycle| cycle.visible_energy_j);
    energies.layers.push(Layer::new(
        "modes that move the gyro",
        colour::VERMILLION,
        LayerShape::Line(1.0),
        visible,
    ));
    let mut panels = vec![energies];
    if fires {
        panels.push(panel(x, "propellant", "kg", fuel));
    }
    let subject = if fires { "elastic energy and propellant" } else { "elastic energy" };
    Figure { title: title(story, subject), panels, panel_height: 220 }
}

/// Returns true if a panel of pulses has any.
fn fires(panel: &Panel) -> bool {
    panel.layers.iter().any(|layer| matches!(layer.shape, LayerShape::Area(_)) && !layer.points.is_empty())
}

/// Returns the figure of the jets' firing times in each cycle.
pub fn jets(story: &RunEvents, cycles: &CycleData) -> Figure {
    let on = |cycle: &ThreeAxisCycle, axis: usize| {
        [cycle.jets.roll_on_s, cycle.jets.pitch_on_s, cycle.jets.yaw_on_s][axis]
    };
    let period = cycles.all.get(1).map_or(0.0, |(time, _)| time - cycles.all[0].0);
    let line = |axis: usize| {
        // Outline of each series of cycles with pulses, without points between them.
        let mut points = Vec::new();
        for row in cycles.all.chunk_by(|a, b| (on(&a.1, axis) == 0.0) == (on(&b.1, axis) == 0.0)) {
            let Some((first, _)) = row.first().filter(|(_, cycle)| on(cycle, axis) != 0.0) else { continue };
            let last = row.last().map_or(*first, |(time, _)| time + period);
            points.push((*first, 0.0));
            points.extend(steps(row.iter().map(|(time, cycle)| (*time, on(cycle, axis))), last));
            points.extend([(last, 0.0), (f64::NAN, f64::NAN)]);
        }
        let zero = vec![(0.0, 0.0), (story.end, 0.0)];
        vec![
            Layer::new("", colour::GREY, LayerShape::Line(0.8), zero),
            Layer::new("", colour::VERMILLION, LayerShape::Area(0.35), points.clone()),
            Layer::new("", colour::VERMILLION, LayerShape::Line(0.8), points),
        ]
    };
    // All axes have the same scale; axes without firing jets have no panel.
    let longest = cycles.all.iter().flat_map(|(_, cycle)| (0..3).map(|axis| on(cycle, axis).abs()));
    let longest = 1.1 * longest.fold(0.0, f64::max);
    let mut panels = panels(story, "s", line);
    for panel in &mut panels {
        panel.y = FigureAxis::exact(&panel.y.name, "s", -longest..longest);
    }
    if panels.iter().any(fires) {
        panels.retain(fires);
    }
    if let Some(last) = panels.last_mut() {
        last.x = time(0.0..story.end);
    }
    Figure { title: title(story, "firing time of the jets in each cycle"), panels, panel_height: 160 }
}

/// Returns the figure of the tracked modes' natural frequencies, estimated and true.
pub fn tracking(story: &RunEvents, cycles: &CycleData) -> Figure {
    let ends = |points: Vec<Point>| -> Vec<Point> {
        points.first().into_iter().chain(points.last()).copied().collect()
    };
    let lines = |axis: usize| {
        let count = cycles.tracking.first().map_or(0, |(_, tracking)| tracking.trackers.len());
        let values_of = |mode: usize, value: fn(&TrackedMode) -> f64| -> Vec<Point> {
            let hertz = |tracking: &Tracking| value(&tracking.trackers[mode]) / std::f64::consts::TAU;
            cycles.tracking.iter().map(|(time, tracking)| (*time, hertz(tracking))).collect()
        };
        let own_windows = |mode: &usize| {
            cycles.tracking.first().is_some_and(|(_, t)| t.trackers[*mode].axis == axis as u64)
        };
        let mut layers = Vec::new();
        for mode in (0..count).filter(own_windows) {
            let name = |name| if axis == 0 && layers.is_empty() { name } else { "" };
            let truth = Layer::new(
                name("true"),
                colour::BLACK,
                LayerShape::Dashes,
                ends(values_of(mode, |mode| mode.true_frequency_rad_s)),
            );
            let estimate = Layer::new(
                name("estimated"),
                colour::VERMILLION,
                LayerShape::Line(1.2),
                values_of(mode, |mode| mode.frequency_rad_s),
            );
            layers.extend([estimate, truth]);
        }
        layers
    };
    let mut panels = panels(story, "", lines);
    for panel in &mut panels {
        panel.y.name.push_str(" (Hz)");
    }
    Figure { title: title(story, "natural frequencies of the tracked modes"), panels, panel_height: 180 }
}

/// Returns the figure of the elastic rates that active damping acts on, with its thresholds and its pulses.
pub fn damping(story: &RunEvents, cycles: &CycleData) -> Figure {
    let lines = |axis: usize| {
        let values_of = |value: fn(&ChannelState) -> f64| -> Vec<Point> {
            cycles.tracking.iter().map(|(time, tracking)| (*time, value(&tracking.channels[axis]))).collect()
        };
        let name = |name| if axis == 0 { name } else { "" };
        let fires = |(_, tracking): &&(f64, Tracking)| tracking.channels[axis].damping_on_s != 0.0;
        let fired =
            cycles.tracking.iter().filter(fires).map(|(time, t)| (*time, t.channels[axis].acted_on_rad_s));
        let fired: Vec<Point> = fired.collect();
        let mark = if fired.len() > MANY { LayerShape::Dot } else { LayerShape::Disc };
        vec![
            Layer::new(
                name("predicted elastic rate"),
                colour::SKY,
                LayerShape::Line(1.0),
                values_of(|c| c.acted_on_rad_s),
            ),
            Layer::new(
                name("threshold"),
                colour::BLACK,
                LayerShape::Line(0.8),
                values_of(|c| c.threshold_rad_s),
            ),
            Layer::new("", colour::BLACK, LayerShape::Line(0.8), values_of(|c| -c.threshold_rad_s)),
            Layer::new("fires", colour::VERMILLION, mark, fired),
        ]
    };
    Figure {
        title: title(story, "elastic rates for active damping"),
        panels: panels(story, "rad/s", lines),
        panel_height: 180,
    }
}
