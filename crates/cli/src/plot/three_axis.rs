//! Figures of a three-axis body: `rates`, `energy`, `position`, `jets`, and of its adaptive observers `tracking` and
//! `damping`.

use flexsc_core::numerics::attitude::AXES;
use flexsc_core::record::{ChannelState, Energy, Jets, Position, Rates, TrackedMode, Tracking};
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour, steps};

use super::cycle_data::{CycleData, RowSource};
use super::figure_spec::{FigureSpec, MotionPart};
use super::run_events::RunEvents;
use super::{time, title};

/// Number of marks above which they are small.
const MANY: usize = 100;

/// Returns a panel for each axis, with lines of given names and colours.
pub fn panels(story: &RunEvents, unit: &'static str, lines: impl Fn(usize) -> Vec<Layer>) -> Vec<Panel> {
    let panel = |(axis, name): (usize, &&str)| {
        let layers = lines(axis);
        let x = time(0.0..story.end);
        let values = layers.iter().flat_map(|layer| &layer.points).map(|(_, value)| *value);
        let y = FigureAxis::around(name, unit, values);
        Panel::new(if axis == 2 { x } else { x.unnamed() }, y, layers)
    };
    AXES.iter().enumerate().map(panel).collect()
}

pub const RATES: FigureSpec = FigureSpec {
    name: "rates",
    contents: "Three axes: rates, rigid and at the gyro",
    rows: &[RowSource::new::<Rates>()],
    motion: MotionPart::Nothing,
    is_in: |story| story.scenario.axis_count() == 3,
    draw: |run| rates(run.story, run.cycles),
};

/// Returns the figure of the rigid rates, and of the rates with their elastic part, which an ideal gyro would measure.
fn rates(story: &RunEvents, cycles: &CycleData) -> Figure {
    let lines = |axis: usize| {
        let measured = cycles.rates(|rigid, elastic| rigid[axis] + elastic[axis]);
        let rigid = cycles.rates(|rigid, _| rigid[axis]);
        let name = |name| if axis == 0 { name } else { "" };
        vec![
            // If both coincide, the wider line remains visible.
            Layer::new(name("at the gyro, with elastic part"), colour::SKY, LayerShape::Line(2.8), measured),
            Layer::new(name("rigid part"), colour::BLACK, LayerShape::Line(1.0), rigid),
        ]
    };
    Figure { title: title(story, "rates"), panels: panels(story, "rad/s", lines), panel_height: 160 }
}

pub const POSITION: FigureSpec = FigureSpec {
    name: "position",
    contents: "Three axes: position and velocity, where jets or forces move the spacecraft",
    rows: &[RowSource::new::<Position>()],
    motion: MotionPart::Nothing,
    is_in: |story| story.scenario.study.translation.is_some(),
    draw: |run| position(run.story, run.cycles),
};

/// Returns the figure of the position of the first point, and its velocity.
fn position(story: &RunEvents, cycles: &CycleData) -> Figure {
    let panel = |x: FigureAxis, name: &str, unit: &'static str, coordinates: [fn(&Position) -> f64; 3]| {
        let line = |(axis, colour): (usize, _)| {
            let points = cycles.rows().map(|(time, position)| (time, coordinates[axis](position))).collect();
            Layer::new(["x", "y", "z"][axis], colour, LayerShape::Line(1.2), points)
        };
        let layers: Vec<Layer> =
            [colour::BLUE, colour::ORANGE, colour::GREEN].into_iter().enumerate().map(line).collect();
        let values = layers.iter().flat_map(|layer| &layer.points).map(|(_, value)| *value);
        let y = FigureAxis::around(name, unit, values);
        Panel::new(x, y, layers)
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

pub const ENERGY: FigureSpec = FigureSpec {
    name: "energy",
    contents: "Three axes: energy of the elastic modes, and propellant",
    rows: &[RowSource::new::<Energy>(), RowSource::new::<Jets>()],
    motion: MotionPart::Nothing,
    is_in: |story| {
        let is_elastic = story.scenario.mode_count() > 0;
        story.scenario.axis_count() == 3 && (is_elastic || story.scenario.study.fires())
    },
    draw: |run| energy(run.story, run.cycles),
};

/// Returns the figure of the elastic modes' energy, and of the jets' propellant.
fn energy(story: &RunEvents, cycles: &CycleData) -> Figure {
    let [elastic, visible] = cycles.elastic_energies();
    let fuel = cycles.fuel(story);
    let panel = |x: FigureAxis, name: &str, unit: &'static str, points: Vec<Point>| {
        let y = FigureAxis::from_zero(name, unit, points.iter().map(|(_, value)| *value));
        Panel::new(x, y, vec![Layer::new(name, colour::BLUE, LayerShape::Line(1.2), points)])
    };
    let x = time(0.0..story.end);
    let fires = fuel.iter().any(|(_, used)| used.is_finite());
    let below = if fires { x.unnamed() } else { x.clone() };
    let mut energies = panel(below, "elastic energy", "J", elastic);
    // If both coincide, the wider line remains visible.
    energies.layers[0].shape = LayerShape::Line(3.2);
    energies.layers[0].colour = colour::SKY;
    "all modes".clone_into(&mut energies.layers[0].name);
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

pub const JETS: FigureSpec = FigureSpec {
    name: "jets",
    contents: "Three axes: firing times of the jets",
    rows: &[RowSource::new::<Jets>()],
    motion: MotionPart::Nothing,
    is_in: |story| story.scenario.study.fires(),
    draw: |run| jets(run.story, run.cycles),
};

/// Returns the figure of the jets' firing times in each cycle.
fn jets(story: &RunEvents, cycles: &CycleData) -> Figure {
    let on = |cycle: &[f64; 3], axis: usize| cycle[axis];
    let (period, all) = cycles.pulses(story);
    let line = |axis: usize| {
        // Outline of each series of cycles with pulses, without points between them.
        let mut points = Vec::new();
        for row in all.chunk_by(|a, b| (on(&a.1, axis) == 0.0) == (on(&b.1, axis) == 0.0)) {
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
    let longest = all.iter().flat_map(|(_, cycle)| (0..3).map(|axis| on(cycle, axis).abs()));
    let longest = 1.1 * longest.fold(0.0, f64::max);
    let mut panels = panels(story, "s", line);
    for panel in &mut panels {
        panel.y = FigureAxis::exact(&format!("{} pulse", panel.y.name), "s", -longest..longest);
    }
    if panels.iter().any(fires) {
        panels.retain(fires);
    }
    if let Some(last) = panels.last_mut() {
        last.x = time(0.0..story.end);
    }
    Figure { title: title(story, "firing time of the jets in each cycle"), panels, panel_height: 160 }
}

pub const TRACKING: FigureSpec = FigureSpec {
    name: "tracking",
    contents: "Three axes: natural frequencies estimated by adaptive observers, and the true ones",
    rows: &[RowSource::new::<Tracking>()],
    motion: MotionPart::Nothing,
    is_in: |story| story.scenario.study.adaptive.is_some() && story.scenario.axis_count() == 3,
    draw: |run| tracking(run.story, run.cycles),
};

/// Returns the figure of the tracked modes' natural frequencies, estimated and true.
fn tracking(story: &RunEvents, cycles: &CycleData) -> Figure {
    let ends = |points: Vec<Point>| -> Vec<Point> {
        points.first().into_iter().chain(points.last()).copied().collect()
    };
    let first = cycles.rows::<Tracking>().next();
    let lines = |axis: usize| {
        let count = first.map_or(0, |(_, tracking)| tracking.trackers.len());
        let values_of = |mode: usize, value: fn(&TrackedMode) -> f64| -> Vec<Point> {
            cycles.rows::<Tracking>().map(|(time, row)| (time, value(&row.trackers[mode]))).collect()
        };
        let mine = |mode: &usize| first.is_some_and(|(_, t)| t.trackers[*mode].axis == axis as u64);
        let mut layers = Vec::new();
        for mode in (0..count).filter(mine) {
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
    let mut panels = panels(story, "rad/s", lines);
    for panel in &mut panels {
        panel.y = panel.y.clone().in_hertz();
    }
    Figure { title: title(story, "natural frequencies of the tracked modes"), panels, panel_height: 180 }
}

pub const DAMPING: FigureSpec = FigureSpec {
    name: "damping",
    contents: "Three axes: elastic rates for active damping, its thresholds and pulses",
    rows: &[RowSource::new::<Tracking>()],
    motion: MotionPart::Nothing,
    is_in: |story| {
        let authorities = &story.scenario.study.authorities;
        story.scenario.axis_count() == 3 && authorities.iter().any(|authority| authority.threshold > 0.0)
    },
    draw: |run| damping(run.story, run.cycles),
};

/// Returns the figure of the elastic rates that active damping acts on, with its thresholds and its pulses.
fn damping(story: &RunEvents, cycles: &CycleData) -> Figure {
    let lines = |axis: usize| {
        let values_of = |value: fn(&ChannelState) -> f64| -> Vec<Point> {
            cycles.rows::<Tracking>().map(|(time, row)| (time, value(&row.channels[axis]))).collect()
        };
        let name = |name| if axis == 0 { name } else { "" };
        let fires = |(_, tracking): &(f64, &Tracking)| tracking.channels[axis].damping_on_s != 0.0;
        let fired = cycles.rows().filter(fires).map(|(time, t)| (time, t.channels[axis].acted_on_rad_s));
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
