//! Deck (.inp) of a CalculiX run: the data about masses that the results omit.

use std::collections::{BTreeMap, BTreeSet};
use std::io::BufRead;
use std::path::Path;

use nalgebra::Vector3;

use super::LONGEST;
use super::element::{HollowSection, MassRule};
use super::text::{Lines, TextLine};
use crate::number::real;
use crate::text_file::open_text_up_to;

/// Mass of an element.
#[derive(Copy, Clone)]
enum ElementMass {
    /// Mass of the volume, by a rule of integration.
    Solid(MassRule),
    Point,
    /// None: springs, dashpots, gaps.
    Nothing,
}
use ElementMass::{Nothing, Point, Solid};

/// Element types: name, number of nodes in the deck, and mass. Types with incompatible modes (C3D8I, S4, B31) are excluded, because
/// results do not contain all of their motion.
const TYPES: [(&str, usize, ElementMass); 24] = [
    ("C3D20", 20, Solid(MassRule::Full)),
    ("C3D20R", 20, Solid(MassRule::Reduced)),
    ("C3D8", 8, Solid(MassRule::Full)),
    ("C3D8R", 8, Solid(MassRule::Reduced)),
    ("C3D10", 10, Solid(MassRule::Full)),
    ("C3D4", 4, Solid(MassRule::Full)),
    ("C3D15", 15, Solid(MassRule::Full)),
    ("C3D6", 6, Solid(MassRule::Full)),
    ("S8", 8, Solid(MassRule::Full)),
    ("S8R", 8, Solid(MassRule::Reduced)),
    ("S6", 6, Solid(MassRule::Full)),
    ("S4R", 4, Solid(MassRule::Reduced)),
    ("S3", 3, Solid(MassRule::Full)),
    ("B32", 3, Solid(MassRule::Full)),
    ("B32R", 3, Solid(MassRule::Reduced)),
    ("B31R", 2, Solid(MassRule::Reduced)),
    ("MASS", 1, Point),
    ("SPRINGA", 2, Nothing),
    ("SPRING1", 1, Nothing),
    ("SPRING2", 2, Nothing),
    ("DASHPOTA", 2, Nothing),
    ("GAPUNI", 2, Nothing),
    ("DCOUP3D", 1, Nothing),
    ("D", 3, Nothing),
];

/// Largest number of files that a deck includes.
const MOST_FILES: usize = 100;
/// Largest number of included files within each other.
const DEEPEST: usize = 10;

/// Largest number of members of sets of point masses and beams, counted each time that one is looked up: sets may hold each other.
const MOST_MEMBERS: usize = 10_000_000;

/// Point mass at a node.
#[derive(Debug)]
pub struct PointMass {
    /// Number of the node.
    pub node: usize,
    /// Mass, in the deck's units.
    pub mass: f64,
    /// Line of the element in the deck.
    pub line: usize,
}

/// Mass data of a deck.
#[derive(Debug, Default)]
pub struct Deck {
    /// Densities of materials, by their names in capitals.
    pub densities: BTreeMap<String, f64>,
    /// Rule of mass integration of each element.
    pub rules: BTreeMap<usize, MassRule>,
    /// Wall of each beam with a hollow section.
    pub hollow: BTreeMap<usize, HollowBeam>,
    /// Elements without mass.
    pub massless: BTreeSet<usize>,
    /// Point masses at nodes.
    pub masses: Vec<PointMass>,
    /// Positions of the nodes.
    pub positions: BTreeMap<usize, Vector3<f64>>,
}

/// Beam with a hollow section.
#[derive(Copy, Clone, Debug)]
pub struct HollowBeam {
    /// Nodes at both ends.
    pub ends: [usize; 2],
    /// Section with its wall.
    pub section: HollowSection,
}

/// Keyword to which the current lines belong.
enum At {
    Elsewhere,
    Nodes,
    /// Element lines: number of nodes still missing, type, and set.
    Elements {
        missing: usize,
        kind: usize,
        set: Option<String>,
    },
    Set {
        name: String,
        generate: bool,
    },
    Density,
    Mass {
        set: String,
    },
    /// Hollow section of the beams of a set: true for a pipe.
    Section {
        set: String,
        pipe: bool,
    },
}

#[derive(Default)]
struct Reader {
    deck: Deck,
    material: Option<String>,
    /// Point masses and beams in each set, and names of sets within; `points` holds the elements' nodes and lines.
    members: BTreeMap<String, Vec<Member>>,
    points: BTreeMap<usize, (usize, usize)>,
    /// Nodes at both ends of each beam.
    beams: BTreeMap<usize, [usize; 2]>,
    /// Hollow sections of sets, with the line of each.
    sections: Vec<(String, HollowSection, usize)>,
    /// Number of included files.
    files: usize,
    /// Number of bytes of the lines that were read.
    bytes: u64,
    /// Masses of sets, with the line of each.
    set_masses: Vec<(String, f64, usize)>,
    /// How many members of sets were looked up.
    members_read: usize,
}

enum Member {
    Element(usize),
    Set(String),
}

/// Reads a deck, which includes files relative to `directory`.
///
/// # Errors
/// The error, with its line.
pub fn read(text: impl BufRead, directory: &Path) -> Result<Deck, String> {
    let (mut reader, mut section) = (Reader::default(), At::Elsewhere);
    read_file(&mut reader, &mut section, text, directory, 0)?;
    reader.finish()
}

/// Reads the lines of a deck or of a file that it includes.
fn read_file(
    reader: &mut Reader,
    section: &mut At,
    text: impl BufRead,
    directory: &Path,
    depth: usize,
) -> Result<(), String> {
    let mut lines = Lines::new(text);
    let mut keyword = String::new();
    while let Some(line) = lines.next()? {
        reader.bytes += line.text.len() as u64;
        if reader.bytes > LONGEST {
            return Err(format!("line {}: must have at most {LONGEST} bytes in all files", line.number));
        }
        let text = line.text.trim();
        if text.is_empty() || text.starts_with("**") {
            continue;
        }
        // A keyword that ends with a comma continues on the next line.
        if text.starts_with('*') || keyword.ends_with(',') {
            keyword.push_str(&line.without_spaces().to_ascii_uppercase());
            if keyword.starts_with("*INCLUDE") && !keyword.ends_with(',') {
                keyword.clear();
                section.is_whole(&line)?;
                include(reader, section, &line, directory, depth)?;
            } else if !keyword.ends_with(',') {
                section.is_whole(&line)?;
                *section = reader.open(&keyword, &line)?;
                keyword.clear();
            }
            continue;
        }
        reader.read_line(&line, section)?;
    }
    Ok(())
}

/// Reads the file that a line `*INCLUDE, INPUT=FILE` names.
fn include(
    reader: &mut Reader,
    section: &mut At,
    line: &TextLine,
    directory: &Path,
    depth: usize,
) -> Result<(), String> {
    let number = line.number;
    let name = line.text.split_once('=').map(|(_, name)| name.trim().trim_matches(['"', '\'']));
    let Some(name) = name.filter(|name| !name.is_empty()) else {
        return Err(format!("line {number}: must name a file, as `*INCLUDE, INPUT=mesh.inp`"));
    };
    reader.files += 1;
    if depth == DEEPEST || reader.files > MOST_FILES {
        return Err(format!(
            "line {number}: must include at most {MOST_FILES} files, {DEEPEST} within each other: does one include itself?"
        ));
    }
    let text = open_text_up_to(&directory.join(name), LONGEST)
        .map_err(|why| format!("line {number}: includes {name}: {why}"))?;
    read_file(reader, section, text, directory, depth + 1).map_err(|why| format!("{name}: {why}"))
}

impl At {
    /// Checks that the last element has all its nodes before a keyword.
    fn is_whole(&self, line: &TextLine) -> Result<(), String> {
        match self {
            Self::Elements { missing, kind, .. } if *missing > 0 => {
                let (name, nodes, _) = TYPES[*kind];
                Err(format!(
                    "line {}: must follow the last {missing} of {nodes} nodes of a {name}",
                    line.number
                ))
            }
            _ => Ok(()),
        }
    }
}

/// Returns the value of a parameter of a keyword.
fn parameter(keyword: &str, name: &str) -> Option<String> {
    let value = |word: &str| Some(word.strip_prefix(name)?.strip_prefix('=')?.to_owned());
    keyword.split(',').find_map(value)
}

impl Reader {
    fn open(&mut self, keyword: &str, line: &TextLine) -> Result<At, String> {
        let number = line.number;
        let needed = |name: &str| {
            parameter(keyword, name).ok_or_else(|| format!("line {number}: must have a parameter {name}"))
        };
        Ok(match keyword.split(',').next().unwrap_or_default() {
            "*NODE" => At::Nodes,
            "*ELEMENT" => {
                let name = needed("TYPE")?;
                let kind = TYPES.iter().position(|(known, ..)| *known == name).ok_or_else(|| {
                    let known = TYPES.map(|(name, ..)| name).join(", ");
                    format!("line {number}: `TYPE` must be one of {known}, got {name}")
                })?;
                At::Elements { missing: 0, kind, set: parameter(keyword, "ELSET") }
            }
            "*ELSET" => At::Set {
                name: needed("ELSET")?,
                generate: keyword.split(',').any(|word| word == "GENERATE"),
            },
            "*MATERIAL" => {
                self.material = Some(needed("NAME")?);
                At::Elsewhere
            }
            "*DENSITY" => At::Density,
            "*MASS" => At::Mass { set: needed("ELSET")? },
            "*BEAMSECTION" => match parameter(keyword, "SECTION").as_deref() {
                None | Some("RECT" | "CIRC") => At::Elsewhere,
                Some(hollow @ ("PIPE" | "BOX")) => {
                    At::Section { set: needed("ELSET")?, pipe: hollow == "PIPE" }
                }
                Some(other) => {
                    return Err(format!(
                        "line {number}: `SECTION` must be RECT, CIRC, PIPE or BOX, got {other}: take `modes` from the .dat"
                    ));
                }
            },
            "*SHELLSECTION" if keyword.split(',').any(|word| word == "COMPOSITE") => {
                return Err(format!(
                    "line {number}: must have no COMPOSITE section, whose layers the results do not contain"
                ));
            }
            _ => At::Elsewhere,
        })
    }

    fn read_line(&mut self, line: &TextLine, section_of: &mut At) -> Result<(), String> {
        let number = line.number;
        let words: Vec<&str> = line.text.split(',').map(str::trim).filter(|word| !word.is_empty()).collect();
        let whole = |index: usize, name: &str| -> Result<usize, String> {
            let word = words.get(index).copied().unwrap_or_default();
            word.parse().map_err(|_| format!("line {number}: `{name}` must be a whole number, got `{word}`"))
        };
        let number_at = |index: usize, name: &str| -> Result<f64, String> {
            let word = words.get(index).copied().unwrap_or_default();
            real(word).ok_or_else(|| format!("line {number}: `{name}` must be a finite number, got `{word}`"))
        };
        match section_of {
            At::Elsewhere => {}
            At::Nodes => {
                // Omitted coordinates are 0.
                let part =
                    |at: usize, name: &str| if words.len() > at { number_at(at, name) } else { Ok(0.0) };
                let position = Vector3::new(part(1, "x")?, part(2, "y")?, part(3, "z")?);
                self.deck.positions.insert(whole(0, "node")?, position);
            }
            At::Elements { missing, kind, set } => {
                let (name, nodes, rule) = TYPES[*kind];
                if *missing > 0 {
                    if words.len() > *missing {
                        return Err(format!(
                            "line {number}: must have the last {missing} of {nodes} nodes of a {name}"
                        ));
                    }
                    *missing -= words.len();
                    return Ok(());
                }
                let element = whole(0, "element")?;
                if words.len() > nodes + 1 {
                    return Err(format!(
                        "line {number}: must have {nodes} nodes of a {name}, got {}",
                        words.len() - 1
                    ));
                }
                *missing = nodes + 1 - words.len();
                if self.has(element) {
                    return Err(format!(
                        "line {number}: must have each element once, got element {element} again"
                    ));
                }
                let is_beam = name.starts_with('B') && words.len() == nodes + 1;
                match rule {
                    Solid(rule) => drop(self.deck.rules.insert(element, rule)),
                    Point => drop(self.points.insert(element, (whole(1, "node")?, number))),
                    Nothing => drop(self.deck.massless.insert(element)),
                }
                if is_beam {
                    self.beams.insert(element, [whole(1, "node")?, whole(nodes, "node")?]);
                }
                if let Some(set) = set.as_ref().filter(|_| is_beam || matches!(rule, Point)) {
                    self.members.entry(set.clone()).or_default().push(Member::Element(element));
                }
            }
            At::Set { name, generate: true } => {
                let (first, last) = (whole(0, "first")?, whole(1, "last")?);
                let step = if words.len() > 2 { whole(2, "step")?.max(1) } else { 1 };
                let within = first..=last.max(first);
                let points = self.points.range(within.clone()).map(|(element, _)| *element);
                let own: Vec<usize> =
                    points.chain(self.beams.range(within).map(|(element, _)| *element)).collect();
                look_up(&mut self.members_read, own.len(), number)?;
                let own =
                    own.into_iter().filter(|element| (element - first) % step == 0).map(Member::Element);
                self.members.entry(name.clone()).or_default().extend(own);
            }
            At::Set { name, .. } => {
                let member = |word: &&str| {
                    word.parse().map_or_else(|_| Member::Set(word.to_ascii_uppercase()), Member::Element)
                };
                self.members.entry(name.clone()).or_default().extend(words.iter().map(member));
            }
            At::Density => {
                let density = number_at(0, "density")?;
                if density <= 0.0 {
                    return Err(format!("line {number}: `density` must be positive, got {density}"));
                }
                let Some(name) = &self.material else {
                    return Err(format!("line {number}: must belong to a *MATERIAL"));
                };
                self.deck.densities.insert(name.clone(), density);
                *section_of = At::Elsewhere;
            }
            At::Section { set, pipe } => {
                self.sections.push((set.clone(), hollow_section(line, &words, *pipe)?, number));
                *section_of = At::Elsewhere;
            }
            At::Mass { set } => {
                let mass = number_at(0, "mass")?;
                if mass <= 0.0 {
                    return Err(format!("line {number}: `mass` must be positive, got {mass}"));
                }
                self.set_masses.push((set.clone(), mass, number));
                *section_of = At::Elsewhere;
            }
        }
        Ok(())
    }

    /// Returns true if an element was read.
    fn has(&self, element: usize) -> bool {
        self.deck.rules.contains_key(&element)
            || self.points.contains_key(&element)
            || self.deck.massless.contains(&element)
    }

    /// Returns the point masses and beams of a set that a line names.
    fn elements(&mut self, set: &str, line: usize) -> Result<Vec<usize>, String> {
        let (mut open, mut names, mut found) = (vec![set], BTreeSet::new(), Vec::new());
        while let Some(name) = open.pop() {
            if !names.insert(name) {
                continue;
            }
            let members = self.members.get(name).ok_or_else(|| {
                format!("line {line}: must have a set {name} of beams or of elements of type MASS")
            })?;
            look_up(&mut self.members_read, members.len(), line)?;
            for member in members {
                match member {
                    Member::Element(element) => found.push(*element),
                    Member::Set(name) => open.push(name),
                }
            }
        }
        Ok(found)
    }

    /// Assigns masses to the nodes of their elements, and hollow sections to their beams.
    fn finish(mut self) -> Result<Deck, String> {
        let mut weighed: BTreeMap<usize, f64> = BTreeMap::new();
        for (set, mass, line) in std::mem::take(&mut self.set_masses) {
            weighed.extend(self.elements(&set, line)?.into_iter().map(|element| (element, mass)));
        }
        for (set, section, line) in std::mem::take(&mut self.sections) {
            for element in self.elements(&set, line)? {
                if let Some(ends) = self.beams.get(&element) {
                    self.deck.hollow.insert(element, HollowBeam { ends: *ends, section });
                }
            }
        }
        for (element, (node, line)) in &self.points {
            let mass = *weighed
                .get(element)
                .ok_or_else(|| format!("line {line}: must have a *MASS for the set of element {element}"))?;
            self.deck.masses.push(PointMass { node: *node, mass, line: *line });
        }
        Ok(self.deck)
    }
}

/// Returns the hollow section of a line with its outer sizes and the thickness of its walls.
fn hollow_section(line: &TextLine, words: &[&str], pipe: bool) -> Result<HollowSection, String> {
    let number = line.number;
    // Behind the outer radius of a pipe, and both sides of a box.
    let walls = words.iter().skip(if pipe { 1 } else { 2 }).map(|word| {
        real(word)
            .filter(|wall| *wall > 0.0)
            .ok_or_else(|| format!("line {number}: `thickness` must be a positive number, got `{word}`"))
    });
    let walls: Vec<f64> = walls.collect::<Result<_, _>>()?;
    let Some(wall) = walls.first().copied() else {
        return Err(format!("line {number}: must have the thickness of the wall behind the outer sizes"));
    };
    if walls.iter().any(|other| *other != wall) {
        return Err(format!(
            "line {number}: must have one thickness of all walls, got {}: take `modes` from the .dat",
            line.text.trim()
        ));
    }
    Ok(if pipe { HollowSection::Pipe { wall } } else { HollowSection::Box { wall } })
}

/// Counts members of sets that are looked up, up to the most.
fn look_up(read: &mut usize, more: usize, line: usize) -> Result<(), String> {
    *read = read.saturating_add(more);
    if *read > MOST_MEMBERS {
        return Err(format!(
            "line {line}: must have at most {MOST_MEMBERS} members of sets of point masses and beams"
        ));
    }
    Ok(())
}
