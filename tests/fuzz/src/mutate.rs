//! Mutations of trees and of bytes.

use crate::chance::Chance;
use crate::nasty;
use crate::node::Node;

/// Largest size of a grown tree (nodes): repeated growth would fill the memory.
const MOST_GROWN: usize = 100_000;

/// Changes a tree in one place; `others` are trees to take parts from.
pub fn tree(node: &mut Node, others: &[Node], chance: &mut Chance) {
    let count = node.count();
    let path = &node.path(chance.below(count));
    let other = &node.path(chance.below(count));
    match chance.below(14) {
        0..4 => put(node, path, Node::Leaf(nasty::leaf(chance))),
        4..6 => scale(node, path, chance),
        6 => remove(node, path),
        7 => {
            // Two places change theirs.
            let (a, b) = (node.at(path).cloned(), node.at(other).cloned());
            if let (Some(a), Some(b)) = (a, b) {
                put(node, path, b);
                put(node, other, a);
            }
        }
        8 => rename(node, path, chance),
        9 => grow(node, path, chance),
        10 => nest(node, path, chance),
        _ => graft(node, others, chance),
    }
}

fn put(node: &mut Node, path: &[usize], value: Node) {
    if let Some(place) = node.at(path) {
        *place = value;
    }
}

/// Multiplies a number by a power of ten, or changes its sign.
fn scale(node: &mut Node, path: &[usize], chance: &mut Chance) {
    let Some(Node::Leaf(text)) = node.at(path) else { return };
    let Ok(number) = text.parse::<f64>() else { return };
    *text = match chance.below(8) {
        0 => format!("{:e}", -number),
        1 => format!("{:e}", number * (1.0 + 2e-16)),
        2 => format!("{}", number as i64),
        _ => format!("{:e}", number * 10_f64.powi(chance.below(25) as i32 - 12)),
    };
}

fn remove(node: &mut Node, path: &[usize]) {
    let Some((place, above)) = path.split_last() else { return };
    match node.at(above) {
        Some(Node::Array(of)) => drop(of.remove(*place)),
        Some(Node::Table(of)) => drop(of.remove(*place)),
        _ => {}
    }
}

fn rename(node: &mut Node, path: &[usize], chance: &mut Chance) {
    let Some((place, above)) = path.split_last() else { return };
    let Some(Node::Table(of)) = node.at(above) else { return };
    let names: Vec<String> = of.iter().map(|(key, _)| key.clone()).collect();
    of[*place].0 = match chance.below(3) {
        0 => names[chance.below(names.len())].clone(),
        1 => format!("{}s", names[*place]),
        _ => chance.one(&["", "x", "a.b", "\u{e9}", "name", "modes"]).to_owned(),
    };
}

/// Repeats the elements of an array many times.
fn grow(node: &mut Node, path: &[usize], chance: &mut Chance) {
    if let Some(Node::Array(of)) = node.at(path)
        && let Some(last) = of.last().cloned()
    {
        let times = [1, 1, 2, 5, 12, 40, 300][chance.below(7)];
        let times = times.min(MOST_GROWN / last.count());
        of.extend(std::iter::repeat_n(last, times));
    }
}

fn nest(node: &mut Node, path: &[usize], chance: &mut Chance) {
    if let Some(place) = node.at(path) {
        let levels = [1, 1, 2, 8, 60, 130, 2000][chance.below(7)];
        let mut inner = place.clone();
        for _ in 0..levels {
            inner = if chance.percent(50) {
                Node::Array(vec![inner])
            } else {
                Node::Table(vec![("a".to_owned(), inner)])
            };
        }
        *place = inner;
    }
}

/// Copies a part of another tree to the key that it has there.
fn graft(node: &mut Node, others: &[Node], chance: &mut Chance) {
    let Some(other) = others.get(chance.below(others.len())) else { return };
    let mut other = other.clone();
    let mut here = node;
    // Descends by equal keys in both trees, for a random depth.
    while let Node::Table(of) = &mut other {
        if of.is_empty() {
            return;
        }
        let (key, value) = of.swap_remove(chance.below(of.len()));
        here = here.key(&key);
        other = value;
        if chance.percent(40) {
            break;
        }
    }
    *here = other;
}

/// Changes bytes in one place.
pub fn bytes(data: &mut Vec<u8>, chance: &mut Chance) {
    let place = chance.below(data.len() + 1);
    let size = chance.below(10);
    let length = 1 + chance.below(1 << size);
    let end = data.len().min(place + length);
    match chance.below(9) {
        0 | 1 => {
            if let Some(byte) = data.get_mut(place) {
                *byte ^= 1 << chance.below(8);
            }
        }
        2 => {
            if let Some(byte) = data.get_mut(place) {
                *byte = [0, 0xff, 0x7f, 0x80, b'\n', b'"', b'[', b'{', b',', b' '][chance.below(10)];
            }
        }
        3 => drop(data.drain(place..end)),
        4 => {
            let part = data[place..end].to_vec();
            data.splice(place..place, part);
        }
        5 => data.truncate(place),
        6 => {
            let width = [2, 4, 8][chance.below(3)];
            let value = nasty::whole(chance, place as u64).to_le_bytes();
            for (byte, new) in data.iter_mut().skip(place).zip(&value[..width]) {
                *byte = *new;
            }
        }
        7 => {
            let token =
                chance.one(&["[", "{a=", "(", "\"", "\\", "-", "e", "9", ",", "\n", "\u{feff}", "\0"]);
            let times = [1, 1, 3, 40, 1000, 100_000][chance.below(6)];
            data.splice(place..place, token.repeat(times).into_bytes());
        }
        _ => {
            let from = chance.below(data.len() + 1);
            let part = data[from..data.len().min(from + length)].to_vec();
            data.splice(place..end, part);
        }
    }
}

/// Replaces a number in a text by another one.
pub fn number(text: &mut String, chance: &mut Chance) {
    let is_part = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+' | 'e' | 'E');
    let mut numbers = Vec::new();
    let mut start = None;
    for (place, c) in text.char_indices().chain([(text.len(), ' ')]) {
        match (start, is_part(c)) {
            (None, true) => start = Some(place),
            (Some(from), false) => {
                if text[from..place].contains(|c: char| c.is_ascii_digit()) {
                    numbers.push(from..place);
                }
                start = None;
            }
            _ => {}
        }
    }
    if let Some(range) = numbers.get(chance.below(numbers.len())) {
        text.replace_range(range.clone(), nasty::number(chance));
    }
}

/// Changes the lines of a text in one place: repeats, removes, moves or swaps some, or changes a field of one.
pub fn lines(text: &mut String, chance: &mut Chance) {
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    if lines.is_empty() {
        return;
    }
    let (place, other) = (chance.below(lines.len()), chance.below(lines.len()));
    // A line, or a block of them.
    let length = [1, 1, 1, 2, 5, 20, 100][chance.below(7)];
    let block = place..lines.len().min(place + length);
    match chance.below(8) {
        0 | 1 => {
            let again = lines[block.clone()].to_vec();
            let to = if chance.percent(70) { block.end } else { other };
            drop(lines.splice(to..to, again));
        }
        2 => drop(lines.drain(block)),
        3 => {
            let moved: Vec<_> = lines.drain(block).collect();
            let to = other.min(lines.len());
            drop(lines.splice(to..to, moved));
        }
        4 => lines.swap(place, other),
        5 => {
            let next = (place + 1) % lines.len();
            lines.swap(place, next);
        }
        _ => {
            let from = lines[other].clone();
            field(&mut lines[place], &from, chance);
        }
    }
    *text = lines.join("\n") + "\n";
}

/// Puts another field in the place of one, over the same columns if it fits: of the same line, of another, or a nasty number.
fn field(line: &mut String, other: &str, chance: &mut Chance) {
    let words = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
    let (own, others) = (words(line), words(other));
    if own.is_empty() {
        return;
    }
    let old = &own[chance.below(own.len())];
    let new = match chance.below(4) {
        0 => own[chance.below(own.len())].clone(),
        1 if !others.is_empty() => others[chance.below(others.len())].clone(),
        2 => String::new(),
        _ => nasty::number(chance).to_owned(),
    };
    let new = format!("{new:>width$}", width = old.len());
    *line = line.replacen(old.as_str(), &new, 1);
}
