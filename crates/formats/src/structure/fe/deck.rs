//! Deck (.inp) of a CalculiX run: the data about masses that the results omit.

use std::collections::{BTreeMap, BTreeSet};
use std::io::BufRead;

use nalgebra::Vector3;

use super::element::MassRule;
use super::text::{Lines, TextLine, real};

/// Element types: name, number of nodes in the deck, and rule of mass integration (`None` for a point mass). Types with
/// incompatible modes (C3D8I, S4, B31) are excluded, because results do not contain all of their motion.
const TYPES: [(&str, usize, Option<MassRule>); 17] = [
    ("C3D20", 20, Some(MassRule::Full)),
    ("C3D20R", 20, Some(MassRule::Reduced)),
    ("C3D8", 8, Some(MassRule::Full)),
    ("C3D8R", 8, Some(MassRule::Reduced)),
    ("C3D10", 10, Some(MassRule::Full)),
    ("C3D4", 4, Some(MassRule::Full)),
    ("C3D15", 15, Some(MassRule::Full)),
    ("C3D6", 6, Some(MassRule::Full)),
    ("S8", 8, Some(MassRule::Full)),
    ("S8R", 8, Some(MassRule::Reduced)),
    ("S6", 6, Some(MassRule::Full)),
    ("S4R", 4, Some(MassRule::Reduced)),
    ("S3", 3, Some(MassRule::Full)),
    ("B32", 3, Some(MassRule::Full)),
    ("B32R", 3, Some(MassRule::Reduced)),
    ("B31R", 2, Some(MassRule::Reduced)),
    ("MASS", 1, None),
];

/// Sets of point masses have no more members, counted each time that one is looked up: sets may hold each other.
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
    /// Point masses at nodes.
    pub masses: Vec<PointMass>,
    /// Positions of the nodes.
    pub positions: BTreeMap<usize, Vector3<f64>>,
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
}

#[derive(Default)]
struct Reader {
    deck: Deck,
    material: Option<String>,
    /// Elements of type MASS in each set, and names of sets within; `points` holds the elements' nodes and lines.
    members: BTreeMap<String, Vec<Member>>,
    points: BTreeMap<usize, (usize, usize)>,
    /// Masses of sets, with the line of each.
    set_masses: Vec<(String, f64, usize)>,
    /// How many members of sets were looked up.
    members_read: usize,
}

enum Member {
    Element(usize),
    Set(String),
}

/// Reads a deck.
///
/// # Errors
/// The error, with its line.
pub fn read(text: impl BufRead) -> Result<Deck, String> {
    let (mut reader, mut section) = (Reader::default(), At::Elsewhere);
    let mut lines = Lines::new(text);
    let mut keyword = String::new();
    while let Some(line) = lines.next()? {
        let text = line.text.trim();
        if text.is_empty() || text.starts_with("**") {
            continue;
        }
        // A keyword that ends with a comma continues on the next line.
        if text.starts_with('*') || keyword.ends_with(',') {
            keyword.push_str(&line.without_spaces().to_ascii_uppercase());
            if !keyword.ends_with(',') {
                section.is_whole(&line)?;
                section = reader.open(&keyword, &line)?;
                keyword.clear();
            }
            continue;
        }
        reader.read_line(&line, &mut section)?;
    }
    reader.finish()
}

impl At {
    /// Whether the last element has all its nodes before a keyword.
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
            "*INCLUDE" => {
                return Err(format!(
                    "line {number}: must have no *INCLUDE: put what it includes in its place"
                ));
            }
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
            "*SHELLSECTION" if keyword.split(',').any(|word| word == "COMPOSITE") => {
                return Err(format!(
                    "line {number}: must have no COMPOSITE section, whose layers the results do not contain"
                ));
            }
            _ => At::Elsewhere,
        })
    }

    fn read_line(&mut self, line: &TextLine, section: &mut At) -> Result<(), String> {
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
        match section {
            At::Elsewhere => {}
            At::Nodes => {
                let mut position = Vector3::zeros();
                for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                    // Omitted coordinates are 0.
                    position[axis] = if words.len() > axis + 1 { number_at(axis + 1, name)? } else { 0.0 };
                }
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
                if self.deck.rules.contains_key(&element) || self.points.contains_key(&element) {
                    return Err(format!(
                        "line {number}: must have each element once, got element {element} again"
                    ));
                }
                if let Some(rule) = rule {
                    self.deck.rules.insert(element, rule);
                } else {
                    self.points.insert(element, (whole(1, "node")?, number));
                    if let Some(set) = set {
                        self.members.entry(set.clone()).or_default().push(Member::Element(element));
                    }
                }
            }
            At::Set { name, generate: true } => {
                let (first, last) = (whole(0, "first")?, whole(1, "last")?);
                let step = if words.len() > 2 { whole(2, "step")?.max(1) } else { 1 };
                let own: Vec<usize> =
                    self.points.range(first..=last.max(first)).map(|(element, _)| *element).collect();
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
                *section = At::Elsewhere;
            }
            At::Mass { set } => {
                let mass = number_at(0, "mass")?;
                if mass <= 0.0 {
                    return Err(format!("line {number}: `mass` must be positive, got {mass}"));
                }
                self.set_masses.push((set.clone(), mass, number));
                *section = At::Elsewhere;
            }
        }
        Ok(())
    }

    /// Assigns the masses to the nodes of their elements.
    fn finish(mut self) -> Result<Deck, String> {
        let mut weighed: BTreeMap<usize, f64> = BTreeMap::new();
        for (set, mass, line) in &self.set_masses {
            let mut open = vec![set.as_str()];
            let mut names = BTreeSet::new();
            while let Some(name) = open.pop() {
                if !names.insert(name) {
                    continue;
                }
                let members = self
                    .members
                    .get(name)
                    .ok_or_else(|| format!("line {line}: must have a set {name} of elements of type MASS"))?;
                look_up(&mut self.members_read, members.len(), *line)?;
                for member in members {
                    match member {
                        Member::Element(element) => drop(weighed.insert(*element, *mass)),
                        Member::Set(name) => open.push(name),
                    }
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

/// Counts members of sets that are looked up, up to the most.
fn look_up(read: &mut usize, more: usize, line: usize) -> Result<(), String> {
    *read = read.saturating_add(more);
    if *read > MOST_MEMBERS {
        return Err(format!("line {line}: must have at most {MOST_MEMBERS} members of sets of point masses"));
    }
    Ok(())
}
