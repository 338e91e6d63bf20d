//! Modes of an appendage from the results of a finite-element program, and the keys for data that such results omit.

use std::path::Path;

use flexsc_formats::document::ConfigError;
use flexsc_formats::foreign_file::read_file;
use flexsc_formats::structure::Shape;
use flexsc_formats::structure::fe::{FileMass, FileMode, FileResults, ResultFormat, StructurePoint};
use flexsc_formats::structure::mode_table::{MOST_MODES, ModeRow};
use flexsc_numerics::quantity::{Finite, Frequency, NonNegative};

use nalgebra::{Matrix3, Vector3};

use super::{Appendage, ClampedMode, CraigBampton};
use crate::body::spatial::NamedPoint;

/// Difference allowed between moments of inertia of the file's structure and of the appendage about the root, of the largest.
const OWN_INERTIA: f64 = 0.3;
/// Relative difference allowed between the masses of the file's structure and of the appendage, for clamped nodes and
/// attached equipment.
const OWN_MASS: f64 = 0.2;

impl Appendage {
    /// Reads the modes, if they are in a file, or copies them from another appendage that was read from the same file.
    ///
    /// # Errors
    /// The key, and the reason or the error in the file.
    pub fn read_modes(&mut self, directory: &Path, others: Option<&Self>) -> Result<(), ConfigError> {
        self.modes.locate(directory);
        if let Some(model) = self.craig_bampton.take() {
            return self.read_reduced(model, directory);
        }
        let file = self.modes.file();
        let Some((file, format)) = file.and_then(|file| Some((file, ResultFormat::from_path(file)?))) else {
            self.no_keys_of_results()?;
            let same = others.filter(|other| (&other.name, &other.points) == (&self.name, &self.points));
            self.modes.read(same.map(|other| &other.modes)).map_err(|why| ConfigError::new("modes", why))?;
            self.name_shapes();
            return Ok(());
        };
        let keys = |options: &Self| {
            (
                options.mass,
                options.centre,
                options.inertia,
                options.keep,
                options.units,
                options.damping.clone(),
                options.points.clone(),
            )
        };
        if let Some(others) =
            others.filter(|others| others.modes.file() == Some(file) && keys(others) == keys(self))
        {
            self.modes = others.modes.clone();
            return Ok(());
        }
        if format == ResultFormat::Flex && self.units.is_some() {
            return Err(ConfigError::new("units", "must be left out: files of 42 are in SI"));
        }
        if self.is_point() {
            let why = "must be given: a structure from a finite-element program is not a point mass";
            return Err(ConfigError::new("inertia", why));
        }
        self.check_keep()?;
        let places = if format.has_shapes() { self.places() } else { Vec::new() };
        let unit = self.units.unwrap_or_default().length();
        let centre = Vector3::from(self.centre.map(Finite::get)) / unit;
        let read = |file: &Path| format.read(file, self.keep, &places, Some(centre.into()));
        let results = read_file(file, &[], "results of Nastran, MYSTRAN, CalculiX and 42", read)
            .map_err(|why| ConfigError::new("modes", why))?;
        let modes = self.clamped_modes_of(&results, |why| {
            ConfigError::new("modes", format!("cannot be used: {}: {why}", file.display()))
        })?;
        self.modes.fill(modes);
        Ok(())
    }

    /// Replaces a Craig-Bampton model by its modes, with their damping.
    fn read_reduced(&mut self, mut model: CraigBampton, directory: &Path) -> Result<(), ConfigError> {
        if self.modes.file().is_some() || !self.modes.is_empty() {
            return Err(ConfigError::new(
                "craig_bampton",
                "must be left out beside `modes`: it has the modes",
            ));
        }
        self.check_keep()?;
        let results = model.results(directory, self.keep).map_err(|fault| fault.within("craig_bampton"))?;
        let modes = self.clamped_modes_of(&results, |why| ConfigError::new("craig_bampton", why))?;
        self.modes.fill(modes);
        // From here on they are modes of a table, which contains this itself.
        (self.keep, self.units, self.damping) = (None, None, None);
        Ok(())
    }

    /// Gives shapes of a table the names of the appendage's points: `tip` of a file that equal appendages share is `north tip` on the
    /// appendage `north`.
    fn name_shapes(&mut self) {
        let is_point = |name: &str| self.points.iter().any(|point| point.name == name);
        let own = |name: &String| {
            Some(format!("{} {name}", self.name)).filter(|own| !is_point(name) && is_point(own))
        };
        if self.modes.file().is_none()
            || !self.modes.iter().flat_map(|mode| mode.shapes.keys()).any(|name| own(name).is_some())
        {
            return;
        }
        let mut modes = self.modes.to_vec();
        for mode in &mut modes {
            let shapes = std::mem::take(&mut mode.shapes).into_iter();
            mode.shapes = shapes.map(|(name, shape)| (own(&name).unwrap_or(name), shape)).collect();
        }
        self.modes.fill(modes);
    }

    /// Keeps the modes inline, and removes the reference to their file.
    pub fn inline_modes(&mut self) {
        self.modes.inline();
        (self.damping, self.keep, self.units) = (None, None, None);
    }

    /// Checks that keys which complete finite-element results are absent without such results.
    fn no_keys_of_results(&self) -> Result<(), ConfigError> {
        let keys = [
            ("damping", self.damping.is_some()),
            ("keep", self.keep.is_some()),
            ("units", self.units.is_some()),
        ];
        keys.iter().find(|(_, is_given)| *is_given).map_or(Ok(()), |(key, _)| {
            if *key == "damping" && self.uniform_plate().is_some() {
                return Err(ConfigError::new(*key, "must be in `plate`, whose mode it damps"));
            }
            let why = "must be left out: it applies to `craig_bampton` and to `modes` from a .f06, .frd, .dat or .flex file, and a table \
                       contains this itself";
            Err(ConfigError::new(*key, why))
        })
    }

    /// Checks the number of modes to keep.
    fn check_keep(&self) -> Result<(), ConfigError> {
        match self.keep.filter(|keep| !(1..=MOST_MODES).contains(keep)) {
            Some(keep) => {
                Err(ConfigError::new("keep", format!("must be 1 to {MOST_MODES} modes, got {keep}")))
            }
            None => Ok(()),
        }
    }

    /// Returns the modes of results in SI units with their damping, once mass properties of the results agree with the appendage's;
    /// `fault` is the error of a mode, with its reason.
    fn clamped_modes_of(
        &self,
        results: &FileResults,
        fault: impl Fn(String) -> ConfigError,
    ) -> Result<Vec<ClampedMode>, ConfigError> {
        if let Some(mass) = &results.mass {
            self.weighs(mass)?;
        }
        let modes = results.modes.iter().zip(self.dampings(&results.modes)?).enumerate();
        let clamped = |(index, (mode, damping)): (usize, (&FileMode, NonNegative))| {
            self.clamped(mode, damping)
                .map_err(|why| fault(format!("mode {} of the lowest: {why}", index + 1)))
        };
        modes.map(clamped).collect()
    }

    /// Returns the appendage's points in the units of the file.
    fn places(&self) -> Vec<StructurePoint> {
        let unit = self.units.unwrap_or_default().length();
        let place = |point: &NamedPoint| StructurePoint {
            name: point.name.clone(),
            at: point.position.map(|part| part.get() / unit),
        };
        self.points.iter().map(place).collect()
    }

    /// Checks that mass, centre of mass and inertia of the file's structure agree with the appendage's.
    fn weighs(&self, structure: &FileMass) -> Result<(), ConfigError> {
        let (units, mass) = (self.units.unwrap_or_default(), self.mass.get());
        let own = structure.mass * units.mass();
        if (own - mass).abs() > OWN_MASS * mass {
            let why = format!(
                "must be that of the structure in the file, {own} kg, to a fifth, got {mass}: are its `units` right? A \
                 CalculiX file leaves out what clamped nodes weigh"
            );
            return Err(ConfigError::new("mass", why));
        }
        let (centre, own_inertia) = (self.centre_of_mass(), self.inertia_tensor());
        let squared = own_inertia.trace() / 2.0 / mass + centre.norm_squared();
        if let Some(moment) = structure.moment {
            let moment = Vector3::from(moment) * (units.mass() * units.length());
            if (moment - centre * mass).norm() > OWN_MASS * mass * f64::sqrt(squared) {
                let [x, y, z]: [f64; 3] = (moment / own).into();
                let clamp = structure.clamp.map_or_else(
                    || {
                        "the results must be about the root: ask the solver for them about its grid"
                            .to_owned()
                    },
                    |[low, high]| {
                        let corner = |at: [f64; 3]| at.map(|part| part * units.length());
                        format!(
                            "nodes at rest are from {:?} to {:?} m of the file",
                            corner(low),
                            corner(high)
                        )
                    },
                );
                let why = format!(
                    "must be that of the structure in the file, [{x:.4}, {y:.4}, {z:.4}] m from its reference point, got {:?}; {clamp}",
                    self.centre.map(Finite::get)
                );
                return Err(ConfigError::new("centre", why));
            }
        }
        let Some(inertia) = structure.inertia else { return Ok(()) };
        let about_root =
            own_inertia + (Matrix3::identity() * centre.norm_squared() - centre * centre.transpose()) * mass;
        let found = inertia.map(|part| part * units.mass() * units.length() * units.length());
        let most = OWN_INERTIA * about_root.diagonal().max();
        let Some(axis) = (0..3).find(|axis| (found[*axis] - about_root[(*axis, *axis)]).abs() > most) else {
            return Ok(());
        };
        let why = format!(
            "must give, with `mass` and `centre`, the moment of inertia of the structure in the file about its reference point, {} kg m² \
             about {}, got {}: is it about the centre of mass, and is the reference point the root?",
            found[axis],
            ["x", "y", "z"][axis],
            about_root[(axis, axis)]
        );
        Err(ConfigError::new("inertia", why))
    }

    /// Returns the damping ratios: those of the scenario if given, else those of the file.
    fn dampings(&self, modes: &[FileMode]) -> Result<Vec<NonNegative>, ConfigError> {
        let count = modes.len();
        match &self.damping {
            Some(damping) => damping.for_modes(count).map_err(|why| ConfigError::new("damping", why)),
            None => modes.iter().map(|mode| mode.damping.and_then(NonNegative::new)).collect::<Option<_>>().ok_or_else(
                || {
                    let why = "must say the damping ratio of the modes, or [one for each], because the file has none; 0 for \
                               none, 0.005 is a common guess";
                    ConfigError::new("damping", why)
                },
            ),
        }
    }

    /// Converts a mode of the file to SI units.
    fn clamped(&self, mode: &FileMode, damping: NonNegative) -> Result<ClampedMode, String> {
        let units = self.units.unwrap_or_default();
        let root = f64::sqrt(units.mass());
        let three = |parts: [f64; 3], unit: f64| -> Result<[Finite; 3], String> {
            let mut three = <[Finite; 3]>::default();
            for (to, part) in three.iter_mut().zip(parts) {
                *to = Finite::new(unit * part).ok_or("its participations must be finite")?;
            }
            Ok(three)
        };
        let frequency = Frequency::new(mode.frequency).ok_or_else(|| {
            let found = mode.frequency;
            format!("must have a natural frequency of 1e-4 to 1e4 rad/s, got {found}: `keep` fewer modes")
        })?;
        let mut clamped = ClampedMode::from_frequency(frequency);
        clamped.damping = damping;
        clamped.translation = three(mode.translation, root)?;
        clamped.rotation = Some(three(mode.rotation, root * units.length())?);
        if let Some([x, y, z]) = mode.moments {
            let unit = root * units.length();
            clamped.moments = Some([three(x, unit)?, three(y, unit)?, three(z, unit)?]);
        }
        for (point, [moved, rotation]) in self.points.iter().zip(&mode.shapes) {
            let shape = Shape {
                translation: three(*moved, 1.0 / root)?,
                rotation: three(*rotation, 1.0 / (root * units.length()))?,
            };
            clamped.shapes.insert(point.name.clone(), shape);
        }
        Ok(clamped)
    }
}
