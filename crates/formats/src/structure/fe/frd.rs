//! Shapes (.frd) of a frequency step of CalculiX, as text: nodes, elements, displacements of each mode.
//!
//! Numbers stand in fixed columns and may touch. Sections that are not needed, such as forces and stresses, are
//! skipped.

use std::collections::{BTreeMap, BTreeSet};
use std::io::BufRead;
use std::ops::Range;

use nalgebra::Vector3;

use super::NaturalFrequency;
use super::element::ElementKind;
use super::text::{Lines, TextLine};
use crate::number::real;

/// Columns of a node's number; `WIDE` is the number of columns of each displacement.
const NODE: Range<usize> = 3..13;
const WIDE: usize = 12;

/// Element of the structure.
#[derive(Debug)]
pub struct Element {
    /// Line in the file.
    pub line: usize,
    /// Number of the element.
    pub number: usize,
    /// Kind of the element.
    pub kind: ElementKind,
    /// Number of its material.
    pub material: usize,
    /// Indices of its nodes.
    pub nodes: Vec<usize>,
}

/// Mode: its frequency, and the displacement of each node.
#[derive(Debug)]
pub struct NodalMode {
    /// Natural frequency of the mode.
    pub natural: NaturalFrequency,
    /// Displacements, in the order of positions.
    pub displacements: Vec<Vector3<f64>>,
}

/// Contents of a file.
#[derive(Debug, Default)]
pub struct Frd {
    /// Names of materials in capitals, by their numbers.
    pub materials: BTreeMap<usize, String>,
    /// Indices of nodes, by their numbers.
    pub places: BTreeMap<usize, usize>,
    /// Positions of the nodes.
    pub positions: Vec<Vector3<f64>>,
    /// Elements of the structure.
    pub elements: Vec<Element>,
    /// Their numbers.
    numbers: BTreeSet<usize>,
    /// True if the last element of the file has no mass.
    is_skipped: bool,
    /// Modes with their shapes.
    pub shapes: Vec<NodalMode>,
}

/// Block to which the current lines belong.
#[derive(PartialEq)]
enum At {
    Elsewhere,
    Nodes,
    Elements,
    Displacements,
}

/// Data before the displacements of a mode.
#[derive(Default)]
struct Head {
    generalised_mass: Option<f64>,
    eigenvalue: Option<f64>,
    mode: Option<usize>,
    cycles: Option<(usize, f64)>,
}

/// Reads the shapes of a file, and its elements but for those that are `massless` in the deck.
///
/// # Errors
/// The error, with its line.
pub fn read(text: impl BufRead, massless: &BTreeSet<usize>) -> Result<Frd, String> {
    let (mut frd, mut section, mut head, mut ended) = (Frd::default(), At::Elsewhere, Head::default(), false);
    let mut lines = Lines::new(text);
    while let Some(line) = lines.next()? {
        let start = line.text.get(..line.text.len().min(6)).unwrap_or_default();
        match start.trim_end() {
            " -3" => frd.begin(&mut section, At::Elsewhere, &line)?,
            " 9999" => {
                frd.begin(&mut section, At::Elsewhere, &line)?;
                ended = true;
                break;
            }
            _ if start.starts_with(" -1") || start.starts_with(" -2") => {
                frd.read_line(&line, &section, massless)?;
            }
            _ if start.starts_with(" -4") => {
                let name = line.text.get(5..13).or_else(|| line.text.get(5..)).unwrap_or_default().trim();
                // The block before ends first: its mode has to be whole when another follows.
                frd.begin(&mut section, At::Elsewhere, &line)?;
                section = if name == "DISP" { frd.open(&line, &mut head)? } else { At::Elsewhere };
            }
            "    2C" | "    3C" => {
                let form = line.text.split_whitespace().next_back().unwrap_or_default();
                if form != "1" {
                    let number = line.number;
                    return Err(format!(
                        "line {number}: must be text with wide columns (1), got form {form}"
                    ));
                }
                let next = if start == "    2C" { At::Nodes } else { At::Elements };
                frd.begin(&mut section, next, &line)?;
            }
            "    1U" if line.text.starts_with("    1UMAT") => {
                let name = line.text.get(14..).unwrap_or_default().trim().to_ascii_uppercase();
                let material = line.column(9..14, "material")?.whole()?;
                if let Some(other) =
                    frd.materials.insert(material, name.clone()).filter(|other| *other != name)
                {
                    return Err(format!(
                        "line {}: must name material {material} once, got `{name}` after `{other}`",
                        line.number
                    ));
                }
            }
            "    1P" => head.read_line(&line)?,
            "  100C" => head.cycles = Some((line.number, line.column(12..24, "frequency")?.real()?)),
            _ => {}
        }
    }
    if !ended {
        return Err("must end with a line 9999: is the file cut?".to_owned());
    }
    if frd.shapes.is_empty() {
        return Err(
            "must have displacements of modes: a step `*FREQUENCY` with `*NODE FILE` and `U` writes them"
                .to_owned(),
        );
    }
    Ok(frd)
}

impl Head {
    fn read_line(&mut self, line: &TextLine) -> Result<(), String> {
        let words: Vec<&str> = line.text.split_whitespace().collect();
        let [name, value] = words[..] else { return Ok(()) };
        let number = line.number;
        let wrong = || format!("line {number}: `{name}` must be a finite number, got `{value}`");
        match name {
            "1PGM" => self.generalised_mass = Some(real(value).ok_or_else(wrong)?),
            "1PGK" => self.eigenvalue = Some(real(value).ok_or_else(wrong)?),
            // -1 of a whole structure.
            "1PHID" if value.parse().is_ok_and(|diameter: i64| diameter >= 0) => {
                return Err(format!(
                    "line {number}: has modes of cyclic symmetry, whose shapes are those of a sector: take the whole structure"
                ));
            }
            "1PMODE" => self.mode = Some(value.parse().map_err(|_| wrong())?),
            _ => {}
        }
        Ok(())
    }
}

impl Frd {
    /// Begins the displacements of a mode.
    fn open(&mut self, line: &TextLine, head: &mut Head) -> Result<At, String> {
        let Head { generalised_mass, eigenvalue, mode, cycles } = std::mem::take(head);
        // Displacements of another kind of step have no mode.
        let (Some(mode), Some((number, cycles))) = (mode, cycles) else { return Ok(At::Elsewhere) };
        if self.shapes.last().is_some_and(|last| last.natural.mode >= mode) {
            return Err(format!("line {number}: must have one step `*FREQUENCY`, got mode {mode} again"));
        }
        let (Some(generalised_mass), Some(eigenvalue)) = (generalised_mass, eigenvalue) else {
            return Err(format!("line {number}: must follow lines `1PGM` and `1PGK` of mode {mode}"));
        };
        if self.positions.is_empty() || self.elements.is_empty() {
            return Err(format!("line {}: must follow nodes and elements", line.number));
        }
        let natural = NaturalFrequency {
            line: number,
            mode,
            frequency: f64::sqrt(eigenvalue.max(0.0)),
            generalised_mass,
        };
        let natural = natural.checked(eigenvalue, cycles)?;
        self.shapes.push(NodalMode { natural, displacements: Vec::with_capacity(self.positions.len()) });
        Ok(At::Displacements)
    }

    /// Reads a row of a block.
    fn read_line(&mut self, line: &TextLine, section: &At, massless: &BTreeSet<usize>) -> Result<(), String> {
        let second = line.text.starts_with(" -2");
        let number = line.number;
        match section {
            At::Elsewhere => {}
            At::Nodes => {
                let node = line.column(NODE, "node")?.whole()?;
                if self.places.insert(node, self.positions.len()).is_some() {
                    return Err(format!("line {number}: must have each node once, got node {node} again"));
                }
                self.positions.push(three(line)?);
            }
            At::Elements if second && self.is_skipped => {}
            At::Elements if second => {
                let Some(element) = self.elements.last_mut() else {
                    return Err(format!("line {number}: must follow the line of an element"));
                };
                let mut from = 3;
                while from < line.text.len() {
                    let node = line.column(from..from + 10, "node")?.whole()?;
                    let place = self.places.get(&node).ok_or_else(|| {
                        format!(
                            "line {number}: element {} must have nodes of the file, got {node}",
                            element.number
                        )
                    })?;
                    element.nodes.push(*place);
                    from += 10;
                }
                let (most, found) = (element.kind.count(), element.nodes.len());
                if found > most {
                    return Err(format!(
                        "line {number}: element {} must have {most} nodes, got {found}",
                        element.number
                    ));
                }
            }
            At::Elements => {
                let element = line.column(NODE, "element")?.whole()?;
                self.is_skipped = massless.contains(&element);
                if self.is_skipped {
                    return Ok(());
                }
                let code = line.column(13..18, "type")?.whole()?;
                let kind = ElementKind::from_number(code).ok_or_else(|| {
                    let why = match code {
                        7..=12 => ": write `*NODE FILE, OUTPUT=3D`, which has the solids that shells and beams become",
                        _ => "",
                    };
                    format!("line {number}: `type` must be that of a solid, 1 to 6, got {code}{why}")
                })?;
                self.is_whole()?;
                if !self.numbers.insert(element) {
                    return Err(format!(
                        "line {number}: must have each element once, got element {element} again"
                    ));
                }
                let material = line.column(23..28, "material")?.whole()?;
                self.elements.push(Element {
                    line: number,
                    number: element,
                    kind,
                    material,
                    nodes: Vec::new(),
                });
            }
            At::Displacements => {
                let Some(shape) = self.shapes.last_mut() else { return Ok(()) };
                let node = line.column(NODE, "node")?.whole()?;
                // Nodes are in the order of their positions.
                if self.places.get(&node) != Some(&shape.displacements.len()) {
                    return Err(format!(
                        "line {number}: must have the nodes in the order of their positions, got {node}"
                    ));
                }
                shape.displacements.push(three(line)?);
            }
        }
        Ok(())
    }

    /// Ends the block that the lines before are of, which has to be whole, and begins another.
    fn begin(&self, section: &mut At, next: At, line: &TextLine) -> Result<(), String> {
        let (needed, number) = (self.positions.len(), line.number);
        match (&*section, self.shapes.last()) {
            (At::Elements, _) => self.is_whole()?,
            (At::Displacements, Some(NodalMode { natural, displacements }))
                if displacements.len() != needed =>
            {
                return Err(format!(
                    "line {number}: must follow displacements of all {needed} nodes in mode {}, got {}: ask for `U` of all, \
                     not of a set",
                    natural.mode,
                    displacements.len()
                ));
            }
            _ => {}
        }
        // Shapes and elements refer to the nodes before them.
        if next == At::Nodes && !(self.elements.is_empty() && self.shapes.is_empty()) {
            return Err(format!("line {number}: must have its nodes before elements and displacements"));
        }
        *section = next;
        Ok(())
    }

    /// Checks that the last element has all its nodes.
    fn is_whole(&self) -> Result<(), String> {
        match self.elements.last() {
            Some(Element { line, number, kind, nodes, .. }) if nodes.len() != kind.count() => Err(format!(
                "line {line}: element {number} must have {} nodes, got {}",
                kind.count(),
                nodes.len()
            )),
            _ => Ok(()),
        }
    }
}

/// Reads the three numbers of a node.
fn three(line: &TextLine) -> Result<Vector3<f64>, String> {
    let mut three = Vector3::zeros();
    for (axis, name) in ["D1", "D2", "D3"].into_iter().enumerate() {
        let from = NODE.end + axis * WIDE;
        three[axis] = line.column(from..from + WIDE, name)?.real()?;
    }
    Ok(three)
}
