//! Checks for data that no spacecraft can have, each with its key: modes that carry more mass than the appendage has,
//! lengths in other units.

use flexsc_formats::document::ConfigError;
use flexsc_formats::document::key::bare_or_quoted;
use flexsc_formats::structure::eigenvalues;
use flexsc_formats::structure::mode_table::MOST_MODES;
use flexsc_numerics::attitude::{Vector, asymmetry, impossible_moments, tensor, vector};
use flexsc_numerics::quantity::{Frequency, shortest};
use nalgebra::{DMatrix, Matrix3, Matrix6, SymmetricEigen, Vector6};

use super::appendage::Appendage;
use super::clamped::{ClampedMode, antisymmetric_part};
use super::mass::point_mass_inertia;
use super::spacecraft::Spacecraft;
use crate::body::spatial::NamedPoint;

/// Largest dimension of a part (m): a larger number is not in metres.
const LARGEST: f64 = 1000.0;
/// Tolerance by which rounded participations may exceed the appendage's mass or inertia, relative to it.
const ROUNDING: f64 = 1e-3;
/// Relative tolerance within which redundant parts of a tensor and of first moments must agree.
const AGREEMENT: f64 = 1e-4;
/// Ratio of squared participations to the appendage's mass or inertia above which they are in other units.
const OTHER_UNITS: f64 = 100.0;

/// Checks the parts of a spacecraft, each alone and against the others.
///
/// # Errors
/// The faulty key, and the reason.
pub fn validate(spacecraft: &Spacecraft, appendages: &[Appendage]) -> Result<(), ConfigError> {
    hub(spacecraft).map_err(|fault| fault.within("spacecraft"))?;
    let hub_points = spacecraft.hub_points();
    let mut points: Vec<&str> = Vec::new();
    distinct(&hub_points, &mut points).map_err(|fault| fault.within("spacecraft"))?;
    let mut modes = 0;
    for (index, appendage) in appendages.iter().enumerate() {
        let within = |fault: ConfigError| fault.within(&format!("appendage[{index}]"));
        if appendages[..index].iter().any(|other| other.name == appendage.name) {
            let why = format!("must differ from the other names, got `{}` again", appendage.name);
            return Err(within(ConfigError::new("name", why)));
        }
        modes += appendage.clamped_modes().len();
        if modes > MOST_MODES {
            let why =
                format!("brings the number of modes to {modes}, and at most {MOST_MODES} are supported");
            return Err(within(ConfigError::new("modes", why)));
        }
        distinct(&appendage.points, &mut points).map_err(within)?;
        appendage_itself(appendage).map_err(within)?;
        scaled_frequencies(spacecraft, appendage).map_err(|fault| match appendage.frequency_factor {
            Some(_) => within(fault),
            None => fault.within("spacecraft"),
        })?;
    }
    Ok(())
}

fn hub(spacecraft: &Spacecraft) -> Result<(), ConfigError> {
    if let Some(fault) = spacecraft.initial_motion().fault() {
        return Err(fault);
    }
    let inertia = tensor(&spacecraft.inertia);
    if let Some(why) = asymmetry(&inertia) {
        return Err(ConfigError::new("inertia", why));
    }
    if inertia.cholesky().is_none() {
        return Err(ConfigError::new("inertia", "must be positive definite"));
    }
    if let Some(why) = impossible_moments(&inertia) {
        return Err(ConfigError::new("inertia", why));
    }
    looks_like_metres("centre", vector(&spacecraft.centre).norm())?;
    extent(&inertia, spacecraft.mass.get())?;
    for (index, point) in spacecraft.points.iter().enumerate() {
        looks_like_metres(&format!("points[{index}].position"), vector(&point.position).norm())?;
    }
    Ok(())
}

fn appendage_itself(appendage: &Appendage) -> Result<(), ConfigError> {
    let inertia = appendage.inertia_tensor();
    if let Some(why) = asymmetry(&inertia) {
        return Err(ConfigError::new("inertia", why));
    }
    let moments = inertia.symmetric_eigenvalues();
    let (least, most) = (moments.min(), moments.max());
    if least < -1e-9 * most.abs() || most < 0.0 {
        return Err(ConfigError::new(
            "inertia",
            format!("must have no negative moment, got one of {least} kg m²"),
        ));
    }
    looks_like_metres("at", vector(&appendage.at).norm())?;
    looks_like_metres("centre", appendage.centre_of_mass().norm())?;
    extent(&inertia, appendage.mass.get())?;
    appendage.turned.check().map_err(|fault| fault.within("turned"))?;
    if let Some(drive) = &appendage.drive {
        drive.validate().map_err(|fault| fault.within("drive"))?;
    }
    appendage.check_hinge()?;
    appendage.check_mount()?;
    appendage.check_plate()?;
    for (index, point) in appendage.points.iter().enumerate() {
        looks_like_metres(&format!("points[{index}].position"), vector(&point.position).norm())?;
    }
    for (index, mode) in appendage.modes.iter().enumerate() {
        mode_itself(appendage, mode).map_err(|fault| fault.within(&format!("modes[{index}]")))?;
    }
    residual(appendage)
}

/// Checks that the factor on an appendage's natural frequencies leaves them in the range that is computed.
fn scaled_frequencies(spacecraft: &Spacecraft, appendage: &Appendage) -> Result<(), ConfigError> {
    let factor = spacecraft.frequency_factor(appendage);
    let clamped = appendage.clamped_modes();
    let mut scaled = clamped.iter().map(|mode| mode.frequency.get() * factor);
    let Some(outside) = scaled.find(|frequency| Frequency::new(*frequency).is_none()) else { return Ok(()) };
    let why = format!(
        "must leave natural frequencies of {} to {} rad/s, got one of {} rad/s",
        Frequency::SMALLEST,
        Frequency::LARGEST,
        shortest(outside)
    );
    Err(ConfigError::new("frequency_factor", why))
}

fn looks_like_metres(key: &str, length: f64) -> Result<(), ConfigError> {
    if length <= LARGEST {
        return Ok(());
    }
    Err(ConfigError::new(key, format!("must be within {LARGEST} m, got {length} m: is it in mm?")))
}

/// Checks that the radius of gyration is a plausible length in metres.
fn extent(inertia: &Matrix3<f64>, mass: f64) -> Result<(), ConfigError> {
    let radius = f64::sqrt(0.5 * inertia.trace() / mass);
    if radius <= LARGEST {
        return Ok(());
    }
    let why = format!(
        "must be that of a body within {LARGEST} m: with this mass its radius of gyration is {radius} m; is it in kg mm²?"
    );
    Err(ConfigError::new("inertia", why))
}

fn distinct<'a>(points: &'a [NamedPoint], known: &mut Vec<&'a str>) -> Result<(), ConfigError> {
    for (index, point) in points.iter().enumerate() {
        if known.contains(&point.name.as_str()) {
            let why = format!("must differ from the other names, got `{}` again", point.name);
            return Err(ConfigError::new(format!("points[{index}].name"), why));
        }
        known.push(&point.name);
    }
    Ok(())
}

fn mode_itself(appendage: &Appendage, mode: &ClampedMode) -> Result<(), ConfigError> {
    if let (Some(rotation), Some(moments)) = (&mode.rotation, mode.moments()) {
        let (stated, follows) = (vector(rotation), antisymmetric_part(&moments));
        if (stated - follows).norm() > AGREEMENT * moments.norm() {
            let follows: Vec<_> = follows.iter().map(|part| format!("{part:.6}")).collect();
            let why = format!("must be that of the first moments, [{}], or left out", follows.join(", "));
            return Err(ConfigError::new("rotation", why));
        }
    } else if mode.rotation.is_some() && appendage.is_point() {
        let why = "must be left out: without `inertia` the appendage is a point mass, of which it follows";
        return Err(ConfigError::new("rotation", why));
    }
    if let Some(along) = &mode.along {
        if !appendage.is_point() {
            let why = "applies only to a point mass, which swings as a whole: an appendage with `inertia` has a `translation`";
            return Err(ConfigError::new("along", why));
        }
        if vector(&mode.translation) != Vector::zeros() {
            return Err(ConfigError::new("along", "replaces `translation`: give only one of them"));
        }
        let length = vector(along).norm();
        if !(length > 0.0 && length.is_finite()) {
            return Err(ConfigError::new(
                "along",
                format!("must be a direction, got one of length {length}"),
            ));
        }
    }
    let is_on_appendage = |name: &String| appendage.points.iter().any(|point| point.name == *name);
    if let Some(name) = mode.shapes.keys().find(|name| !is_on_appendage(name)) {
        let key = format!("shapes.{}", bare_or_quoted(name));
        return Err(ConfigError::new(key, "must be at one of the appendage's `points`"));
    }
    if let Some(point) = appendage.points.iter().find(|point| !mode.shapes.contains_key(&point.name)) {
        let why = format!("must have a shape at each point, and `{}` is missing", point.name);
        return Err(ConfigError::new("shapes", why));
    }
    Ok(())
}

/// Checks that the modes leave the appendage a positive semidefinite mass matrix: that of the six rigid motions minus
/// the part carried by the modes.
///
/// The matrix is taken about the centre of mass and in principal axes, each divided by the appendage's own value, so
/// that the rounding tolerance does not depend on units or on the distance of the root.
fn residual(appendage: &Appendage) -> Result<(), ConfigError> {
    let (mass, centre) = (appendage.mass.get(), appendage.centre_of_mass());
    let inertia = appendage.inertia_tensor();
    let about_root = inertia + point_mass_inertia(mass, &centre);
    let own = SymmetricEigen::new(inertia);
    let rounded = AGREEMENT * (mass * centre.norm_squared() + 0.5 * inertia.trace());
    let scales = own.eigenvalues.map(|moment| {
        let scale = f64::sqrt(moment.max(rounded));
        if scale > 0.0 { scale } else { 1.0 }
    });
    let mut remaining = Matrix6::identity();
    for axis in 0..3 {
        remaining[(3 + axis, 3 + axis)] = own.eigenvalues[axis].max(0.0) / (scales[axis] * scales[axis]);
    }
    let clamped = appendage.clamped_modes();
    let modes = clamped.iter().zip(appendage.participations());
    for (index, (mode, (t, r))) in modes.enumerate() {
        let error_at = |key: &str, why: String| Err(ConfigError::new(format!("modes[{index}]{key}"), why));
        let effective = t.norm_squared();
        if effective > mass * (1.0 + ROUNDING) {
            let hint = if effective > OTHER_UNITS * mass {
                ": is the mode mass-normalised, in kg and m?"
            } else {
                ""
            };
            let why = format!(
                "must carry no more than the appendage: its effective mass is {effective} kg, the appendage's mass {mass} kg{hint}"
            );
            return error_at(".translation", why);
        }
        let carried = r.norm_squared();
        let available = if carried > 0.0 { (r.transpose() * about_root * r).x / carried } else { 0.0 };
        if carried > available * (1.0 + ROUNDING) {
            let hint = if carried > OTHER_UNITS * available { ": is it in sqrt(kg) mm?" } else { "" };
            let key = if mode.moments.is_some() { ".moments" } else { ".rotation" };
            let why = format!(
                "must carry no more than the appendage: its effective inertia about its axis is {carried} kg m², the \
                 appendage's, about the root, {available} kg m²{hint}"
            );
            return error_at(key, why);
        }
        let about_centre: Vector = own.eigenvectors.tr_mul(&(r - centre.cross(&t)));
        let mut row = Vector6::zeros();
        row.fixed_rows_mut::<3>(0).copy_from(&(t / f64::sqrt(mass)));
        row.fixed_rows_mut::<3>(3).copy_from(&about_centre.component_div(&scales));
        remaining -= row * row.transpose();
        if !remaining.iter().all(|element| element.is_finite()) {
            return error_at("", "must have numbers of a size that can be computed with".to_owned());
        }
        let least = remaining.symmetric_eigenvalues().min();
        if least < -ROUNDING {
            let (with, before) = if index == 0 { ("", "") } else { ("with the modes before ", ", together") };
            let why = format!(
                "must leave the appendage mass and inertia: {with}it carries {:.4} of what the appendage has in some motion \
                 of its root{before}; is one of `translation`, `rotation`, `centre` about another point, or in other units?",
                1.0 - least
            );
            return error_at("", why);
        }
    }
    Ok(())
}

/// Checks that the hub's residual inertia is positive definite: its inertia less that of the modes and of the rotors
/// about their axes.
///
/// # Errors
/// The key of the hub's inertia, and the least moment left.
pub fn validate_hub_inertia(residual: &Matrix3<f64>, whole: &Matrix3<f64>) -> Result<(), ConfigError> {
    let matrix = DMatrix::from_iterator(3, 3, residual.iter().copied());
    let least = eigenvalues(&matrix).and_then(|values| values.first().copied()).unwrap_or(f64::NAN);
    if least > 1e-6 * whole.norm() {
        return Ok(());
    }
    let why = format!(
        "must leave the hub inertia of its own: less what the modes carry and wheels spin with, {least} kg m² are left \
         about some axis"
    );
    Err(ConfigError::new("spacecraft.inertia", why))
}
