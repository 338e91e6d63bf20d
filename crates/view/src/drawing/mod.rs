//! Drawing of a spacecraft as SVG, from its scenario: hub and appendages as the boxes of their masses and inertias, wheels,
//! thrusters, and sensors with their boresights.
//!
//! Parallel projection; far faces first. Texts stand in the corners, at the ends of leaders. A bar has the scale, and arrows
//! in a corner the axes of the body.

mod label;
mod projection;
mod solid;

use std::f64::consts::TAU;
use std::fmt::Write;

use flexsc_core::Scenario;
use flexsc_core::control::actuator::Wheels;
use flexsc_core::control::sensor::SensorKind;
use flexsc_core::formats::reader_units::{ReaderUnits, number};
use flexsc_core::numerics::attitude::{Vector, tensor, vector};
use flexsc_core::spacecraft::body::craft::{Appendage, Spacecraft};
use nalgebra::Matrix3;

use label::Label;
use projection::Projection;
use solid::Solid;

/// Size of the picture, and its margins.
const SIZE: [f64; 2] = [640.0, 540.0];
const MARGINS: [f64; 2] = [70.0, 135.0];
/// Half angle of the cone of a boresight without one (rad), largest one that is drawn as a cone, and number of its sides.
const CONE: f64 = 0.35;
const WIDEST: f64 = 1.2;
const SIDES: u32 = 40;
/// Colours of boresights, wheels and thrusters.
const COLOURS: [&str; 3] = ["#8c5b9f", "#b35c00", "#5b6570"];

/// Boresight of a sensor.
struct Boresight {
    direction: Vector,
    half_angle: f64,
    label: [String; 2],
    /// Position of the sensor, if it is on a named point.
    from: Option<Vector>,
}

/// Returns the drawing of a scenario's spacecraft; `None` of a body that is not built from its parts.
pub fn spacecraft_svg(scenario: &Scenario) -> Option<String> {
    let craft = scenario.spacecraft.as_ref()?;
    let solids = solids(scenario)?;
    let (hub, panels) = solids.split_last()?;
    let reach = 0.5 * hub.size.norm();
    let boresights: Vec<Boresight> = scenario
        .sensor
        .iter()
        .enumerate()
        .filter_map(|(index, own)| boresight(scenario, craft, index, own))
        .collect();
    let ends: Vec<[Vector; 2]> = boresights
        .iter()
        .map(|own| {
            let start = own.from.unwrap_or_else(|| hub.surface(&own.direction));
            [start, start + own.direction * (0.85 * reach)]
        })
        .collect();
    let corners: Vec<Vector> =
        solids.iter().flat_map(Solid::corners).chain(ends.iter().map(|own| own[1])).collect();
    let view = Projection::fitting(&corners, SIZE, MARGINS);
    let mut labels = vec![Label::new(
        hub.surface(&(Vector::x() * 0.9 - Vector::z() * 0.3).normalize()),
        format!("hub {}", mass(craft.mass.get())),
        format!("{} × {} × {}, from its inertia", number(hub.size.x), number(hub.size.y), length(hub.size.z)),
    )];
    labels.extend(scenario.appendage.iter().zip(panels).map(|(own, solid)| named(scenario, own, solid)));
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" role=\"img\" \
         aria-label=\"the spacecraft, drawn from the scenario\" font-family=\"Helvetica, Arial, sans-serif\">\n",
        SIZE[0], SIZE[1]
    );
    let cones = |front: bool| -> String {
        let own =
            boresights.iter().zip(&ends).filter(|(own, _)| (own.direction.dot(&view.eye) >= 0.0) == front);
        own.map(|(own, ends)| cone(&view, ends, own.half_angle)).collect()
    };
    svg += &cones(false);
    svg += &solid::drawn(&solids, &view);
    svg += &cones(true);
    for (own, ends) in boresights.iter().zip(&ends) {
        let [first, second] = &own.label;
        labels.push(Label::new(ends[1], first.clone(), second.clone()));
    }
    if let Some((wheels, _)) = scenario.actuator.wheels() {
        svg += &discs(&mut labels, wheels, hub, &view);
    }
    svg += &thrusters(&mut labels, scenario, craft, (&view, reach));
    svg += &label::drawn(&labels, &view);
    svg += &axes_and_scale(&view);
    svg += "</svg>\n";
    Some(svg)
}

/// Face of a model in the body's axes, about the centre of the hub and its appendages.
#[derive(Clone, Debug)]
pub struct ModelFace {
    /// Corners (m).
    pub corners: [[f64; 3]; 4],
    /// Direction out of the box.
    pub normal: [f64; 3],
    /// Red, green and blue, to 255.
    pub colour: [f64; 3],
}

/// Returns the faces of a scenario's spacecraft; `None` of a body that is not built from its parts.
pub fn model_faces(scenario: &Scenario) -> Option<Vec<ModelFace>> {
    let solids = solids(scenario)?;
    let corners: Vec<Vector> = solids.iter().flat_map(Solid::corners).collect();
    let [low, high] = [f64::min as fn(f64, f64) -> f64, f64::max].map(|end| {
        let ends = corners.iter().copied().reduce(|a, b| a.zip_map(&b, end));
        ends.unwrap_or_else(Vector::zeros)
    });
    let middle = 0.5 * (low + high);
    let mut faces = Vec::new();
    for own in &solids {
        faces.extend(own.sides().map(|(corners, normal)| ModelFace {
            corners: corners.map(|corner| (corner - middle).into()),
            normal: normal.into(),
            colour: own.colour(),
        }));
    }
    Some(faces)
}

/// Returns the boxes of the appendages, then that of the hub.
fn solids(scenario: &Scenario) -> Option<Vec<Solid>> {
    let craft = scenario.spacecraft.as_ref()?;
    let centre = vector(&craft.centre);
    let hub = Solid::from_inertia(craft.mass.get(), &tensor(&craft.inertia), centre, &Matrix3::identity());
    Some(scenario.appendage.iter().map(appendage).chain([hub]).collect())
}

fn appendage(own: &Appendage) -> Solid {
    let axes = own.axes(0.0);
    let centre = vector(&own.at) + axes * own.centre_of_mass();
    Solid::from_inertia(own.mass.get(), &own.inertia_tensor(), centre, &axes).with_cells()
}

/// Returns the label of an appendage, at its far end.
fn named(scenario: &Scenario, own: &Appendage, solid: &Solid) -> Label {
    let mut sides: Vec<f64> = solid.size.iter().copied().collect();
    sides.sort_by(|a, b| b.total_cmp(a));
    let craft = scenario.spacecraft.as_ref();
    let factor = craft.map_or(1.0, |craft| craft.frequency_factor(own));
    let first =
        own.clamped_modes().iter().map(|mode| mode.frequency.get() * factor).fold(f64::INFINITY, f64::min);
    let mode = if first.is_finite() {
        format!(", first mode {}", ReaderUnits::Engineering.frequency().quantity(first))
    } else {
        String::new()
    };
    let size = if own.inertia_tensor() == Matrix3::zeros() {
        format!("point mass{mode}")
    } else {
        format!("{} × {}{mode}", number(sides[0]), length(sides[1]))
    };
    Label::new(solid.far_end(&vector(&own.at)), format!("{} {}", own.name, mass(own.mass.get())), size)
}

/// Returns the boresight of a sensor that has one.
fn boresight(
    scenario: &Scenario,
    craft: &Spacecraft,
    index: usize,
    sensor: &SensorKind,
) -> Option<Boresight> {
    let direction = sensor.boresight()?;
    let point = sensor.point().and_then(|name| {
        let points = craft.points.iter();
        points.filter(|point| point.name == name).map(|point| vector(&point.position)).next()
    });
    let from = point.filter(|point| *point != Vector::zeros());
    let excluded = scenario.sensor.exclusions().find(|(place, ..)| *place == index);
    let limits: Vec<(&str, f64)> = excluded
        .iter()
        .flat_map(|(.., own)| own.limits().map(|(body, angle)| (body.name(), angle)))
        .collect();
    let narrowest = limits.iter().map(|(_, angle)| *angle).fold(f64::INFINITY, f64::min);
    let (half_angle, second) = match sensor.field_of_view() {
        Some(field) => {
            let text = format!("sees {} about {}", degrees(field.half_angle), axis_text(&direction));
            (field.half_angle.min(WIDEST), text)
        }
        None if limits.is_empty() => (CONE, format!("boresight {}", axis_text(&direction))),
        None => {
            let each: Vec<String> =
                limits.iter().map(|(body, angle)| format!("{body} {}", degrees(*angle))).collect();
            let half_angle = if narrowest < WIDEST { narrowest } else { CONE };
            (half_angle, format!("excludes {}", each.join(", ")))
        }
    };
    let name = sensor.kind().replace('_', " ");
    Some(Boresight { direction, half_angle, label: [numbered(scenario, sensor, &name), second], from })
}

/// Returns the name of a sensor with its place among those of its kind, if there are several.
fn numbered(scenario: &Scenario, sensor: &SensorKind, name: &str) -> String {
    let alike: Vec<&SensorKind> = scenario.sensor.iter().filter(|own| own.kind() == sensor.kind()).collect();
    match alike.iter().position(|own| std::ptr::eq(*own, sensor)) {
        Some(place) if alike.len() > 1 => format!("{name} {}", place + 1),
        _ => name.to_owned(),
    }
}

/// Returns a direction as a body axis, or by its components.
fn axis_text(direction: &Vector) -> String {
    let axis = direction.iamax();
    let rest = direction.norm_squared() - direction[axis] * direction[axis];
    if rest < 1e-6 {
        return format!("{}{}", if direction[axis] < 0.0 { "-" } else { "+" }, ["x", "y", "z"][axis]);
    }
    format!("[{}]", direction.iter().map(|part| format!("{part:.2}")).collect::<Vec<_>>().join(", "))
}

/// Returns the cone of a boresight.
fn cone(view: &Projection, [start, end]: &[Vector; 2], half_angle: f64) -> String {
    let axis = end - start;
    let side = if axis.x.abs() < 0.9 * axis.norm() { Vector::x() } else { Vector::y() };
    let u = axis.cross(&side).normalize() * axis.norm();
    let v = axis.normalize().cross(&u);
    let (sin, cos) = libm::sincos(half_angle);
    let ring: Vec<Vector> = (0..SIDES)
        .map(|index| {
            let (across, along) = libm::sincos(TAU * f64::from(index) / f64::from(SIDES));
            start + axis * cos + (u * along + v * across) * sin
        })
        .collect();
    // The outline is where the cone turns away from the viewer: the ends of the ring as seen from the tip.
    let [x, y] = view.place(start);
    let centre = view.place(&(start + axis * cos));
    let angle = |point: &Vector| {
        let [px, py] = view.place(point);
        let [a, b] = [[px - x, py - y], [centre[0] - x, centre[1] - y]];
        libm::atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])
    };
    let edge = |sign: f64| ring.iter().max_by(|a, b| (sign * angle(a)).total_cmp(&(sign * angle(b))));
    let colour = COLOURS[0];
    let mut svg = format!(
        "<g stroke=\"{colour}\" fill=\"none\"><path d=\"M{} Z\" fill=\"{colour}\" fill-opacity=\".10\" stroke-dasharray=\"3 2\"/>",
        view.path(&ring)
    );
    for end in [edge(1.0), edge(-1.0)].into_iter().flatten() {
        let _ = write!(svg, "<path d=\"M{}\" stroke-dasharray=\"3 2\"/>", view.path(&[*start, *end]));
    }
    let _ = writeln!(svg, "<path d=\"M{}\" stroke-width=\"1.6\"/></g>", view.path(&[*start, *end]));
    svg
}

/// Returns the wheels as discs within the hub, with hidden lines, and adds their label.
fn discs(labels: &mut Vec<Label>, wheels: &Wheels, hub: &Solid, view: &Projection) -> String {
    let Ok(rotors) = wheels.rotors() else { return String::new() };
    let radius = 0.17 * hub.size.min().max(0.3 * hub.size.max());
    let mut svg =
        format!("<g stroke=\"{0}\" fill=\"{0}\" fill-opacity=\".12\" stroke-dasharray=\"2 2\">", COLOURS[1]);
    let mut end = hub.centre;
    for rotor in &rotors {
        let side = if rotor.axis.x.abs() < 0.9 { Vector::x() } else { Vector::y() };
        let u = rotor.axis.cross(&side).normalize();
        let v = rotor.axis.cross(&u);
        let centre = hub.centre + rotor.axis * (1.5 * radius);
        let rim: Vec<Vector> = (0..SIDES)
            .map(|index| {
                let (sin, cos) = libm::sincos(TAU * f64::from(index) / f64::from(SIDES));
                centre + (u * cos + v * sin) * radius
            })
            .collect();
        let _ = write!(svg, "<path d=\"M{} Z\"/>", view.path(&rim));
        let _ = write!(svg, "<path d=\"M{}\" fill=\"none\"/>", view.path(&[hub.centre, centre]));
        end = if view.place(&centre)[1] < view.place(&end)[1] { centre } else { end };
    }
    svg += "</g>\n";
    let name = match rotors.len() {
        1 => "wheel".to_owned(),
        count => format!("{count} wheels"),
    };
    labels.push(Label::new(end, name, wheel_limits(wheels)));
    svg
}

/// Returns the largest momentum, speed and torque of a wheel in words, those that have limits.
pub fn wheel_limits(wheels: &Wheels) -> String {
    let units = ReaderUnits::Engineering;
    let limits = [
        wheels.momentum.map(|own| units.quantity(own.get(), "N m s")),
        wheels.speed_limit.map(|own| units.rotor_speed().quantity(own.get())),
        wheels.torque.map(|own| units.quantity(own.get(), "N m")),
    ];
    limits.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// Returns the nozzles of the thrusters, and adds their label.
fn thrusters(
    labels: &mut Vec<Label>,
    scenario: &Scenario,
    craft: &Spacecraft,
    (view, reach): (&Projection, f64),
) -> String {
    let Some((jets, _)) = scenario.actuator.jets() else { return String::new() };
    let mut svg = String::new();
    let mut last = None;
    for thruster in &jets.thrusters {
        let own = craft.points.iter().find(|point| point.name == thruster.point);
        let at = own.map_or_else(Vector::zeros, |point| vector(&point.position)) + vector(&thruster.offset);
        let out = at - vector(&thruster.direction).normalize() * (0.18 * reach);
        let _ = write!(
            svg,
            "<path d=\"M{}\" stroke=\"{}\" stroke-width=\"3\" stroke-linecap=\"round\"/>",
            view.path(&[at, out]),
            COLOURS[2]
        );
        last = Some(out);
    }
    if let Some(at) = last {
        let count = jets.thrusters.len();
        labels.push(Label::new(at, format!("{count} thrusters"), "their plumes"));
    }
    svg + "\n"
}

/// Returns the axes of the body and a bar of a round length.
fn axes_and_scale(view: &Projection) -> String {
    let [x, y] = [62.0, SIZE[1] - 52.0];
    let mut svg = String::new();
    let axes = [(Vector::x(), "#c1272d", "x"), (Vector::y(), "#009e73", "y"), (Vector::z(), "#0072b2", "z")];
    for (axis, colour, name) in axes {
        let [dx, dy] = view.direction(&axis);
        let _ = write!(
            svg,
            "<path d=\"M{x},{y} L{:.1},{:.1}\" stroke=\"{colour}\" stroke-width=\"2\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" font-size=\"12\" font-weight=\"bold\" text-anchor=\"middle\" fill=\"{colour}\">{name}</text>",
            x + 34.0 * dx,
            y + 34.0 * dy,
            x + 45.0 * dx,
            y + 45.0 * dy + 4.0
        );
    }
    let decade = libm::pow(10.0, libm::floor(libm::log10(130.0 * view.pixel)));
    let fits = |factor: &f64| factor * decade / view.pixel <= 130.0;
    let long = [5.0, 2.0, 1.0].into_iter().find(fits).unwrap_or(1.0) * decade;
    let (right, wide) = (SIZE[0] - 20.0, long / view.pixel);
    let _ = writeln!(
        svg,
        "<path d=\"M{:.1},{:.1} h{wide:.1} m0,-4 v8 m{:.1},0 v-8\" stroke=\"#1b2733\" stroke-width=\"1.2\" fill=\"none\"/>\
         <text x=\"{:.1}\" y=\"{:.1}\" font-size=\"11\" text-anchor=\"middle\" fill=\"#1b2733\">{}</text>",
        right - wide,
        SIZE[1] - 22.0,
        -wide,
        right - wide / 2.0,
        SIZE[1] - 29.0,
        round_length(long)
    );
    svg
}

fn mass(kilograms: f64) -> String {
    ReaderUnits::Engineering.quantity(kilograms, "kg")
}

fn length(metres: f64) -> String {
    format!("{} m", number(metres))
}

/// Returns a round length without zeros at its end.
fn round_length(metres: f64) -> String {
    if metres < 0.1 { format!("{:.0} mm", 1e3 * metres) } else { format!("{metres} m") }
}

fn degrees(radians: f64) -> String {
    format!("{:.0} deg", radians.to_degrees())
}

/// Returns a text for XML.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_has_the_sides_of_its_inertia() {
        // A box of 3 kg with sides 1, 2 and 3 m: (b² + c²) m/12 and so on.
        let inertia = Matrix3::from_diagonal(&Vector::new(13.0, 10.0, 5.0)) * 0.25;
        let found = Solid::from_inertia(3.0, &inertia, Vector::zeros(), &Matrix3::identity());
        assert!((found.size - Vector::new(1.0, 2.0, 3.0)).norm() < 1e-12, "{}", found.size);
        assert!((found.surface(&Vector::z()) - Vector::new(0.0, 0.0, 1.5)).norm() < 1e-12);
        assert!((found.far_end(&Vector::new(0.0, 0.0, -9.0)) - Vector::new(0.0, 0.0, 1.5)).norm() < 1e-12);
    }

    #[test]
    fn directions_along_an_axis_have_its_name() {
        assert_eq!(axis_text(&Vector::new(0.0, 0.0, -1.0)), "-z");
        assert_eq!(axis_text(&Vector::new(0.8, 0.0, 0.6)), "[0.80, 0.00, 0.60]");
    }
}
