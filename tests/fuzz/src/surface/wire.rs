//! Mutations of protobuf messages, whatever they mean: schemas are such messages too.

use crate::chance::Chance;
use crate::nasty;

/// The fields of a message: number, and value.
type Fields = Vec<(u64, Value)>;

enum Value {
    Varint(u64),
    Fixed64([u8; 8]),
    Bytes(Vec<u8>),
    Message(Fields),
    Fixed32([u8; 4]),
}

/// Changes a message in a few places.
pub fn change(data: &mut Vec<u8>, chance: &mut Chance) {
    let Some(mut fields) = read(data, 0) else {
        return crate::mutate::bytes(data, chance);
    };
    let mut words = Vec::new();
    gather(&fields, &mut words);
    for _ in 0..chance.times() {
        fields_once(&mut fields, &words, chance);
    }
    data.clear();
    write(&fields, data);
}

fn varint(data: &mut &[u8]) -> Option<u64> {
    let mut value = 0;
    for shift in (0..64).step_by(7) {
        let (byte, rest) = data.split_first()?;
        *data = rest;
        value |= u64::from(byte & 0x7f) << shift;
        if byte & 0x80 == 0 {
            return Some(value);
        }
    }
    None
}

fn read(mut data: &[u8], depth: usize) -> Option<Fields> {
    let mut fields = Vec::new();
    while !data.is_empty() {
        let tag = varint(&mut data)?;
        let value = match tag & 7 {
            0 => Value::Varint(varint(&mut data)?),
            1 => {
                let (bytes, rest) = data.split_first_chunk()?;
                data = rest;
                Value::Fixed64(*bytes)
            }
            2 => {
                let length = varint(&mut data)? as usize;
                let bytes = data.get(..length)?;
                data = &data[length..];
                // What reads as a message and not as a word most likely is one.
                let word = bytes.iter().all(|b| (0x20..0x7f).contains(b));
                match read(bytes, depth + 1) {
                    Some(fields) if depth < 8 && !word => Value::Message(fields),
                    _ => Value::Bytes(bytes.to_vec()),
                }
            }
            5 => {
                let (bytes, rest) = data.split_first_chunk()?;
                data = rest;
                Value::Fixed32(*bytes)
            }
            _ => return None,
        };
        if tag >> 3 == 0 {
            return None;
        }
        fields.push((tag >> 3, value));
    }
    Some(fields)
}

/// Every string: among them the names of types.
fn gather(fields: &Fields, words: &mut Vec<Vec<u8>>) {
    for (_, value) in fields {
        match value {
            Value::Bytes(bytes) => words.push(bytes.clone()),
            Value::Message(fields) => gather(fields, words),
            _ => {}
        }
    }
}

fn fields_once(fields: &mut Fields, words: &[Vec<u8>], chance: &mut Chance) {
    let place = chance.below(fields.len());
    if fields.is_empty() {
        return fields.push((1 + chance.number() % 12, Value::Varint(1)));
    }
    if let Value::Message(inner) = &mut fields[place].1
        && chance.percent(85)
    {
        return fields_once(inner, words, chance);
    }
    match chance.below(8) {
        0 => drop(fields.remove(place)),
        1 => {
            let mut bytes = Vec::new();
            write(&fields[place..=place], &mut bytes);
            if let Some(again) = read(&bytes, 0) {
                fields.extend(again);
            }
        }
        2 => fields[place].0 = 1 + nasty::whole(chance, fields[place].0) % (1 << 29),
        3 => {
            // The message stands within itself.
            let mut bytes = Vec::new();
            write(fields, &mut bytes);
            fields.push((1 + chance.number() % 10, Value::Bytes(bytes)));
        }
        4 => {
            // An option of a message of a schema: it is the entry of a map.
            fields.push((7, Value::Message(vec![(7, Value::Varint(1))])));
        }
        _ => value(&mut fields[place].1, words, chance),
    }
}

fn value(value: &mut Value, words: &[Vec<u8>], chance: &mut Chance) {
    match value {
        Value::Varint(number) if chance.percent(50) => *number = chance.number() % 20,
        Value::Varint(number) => *number = nasty::whole(chance, *number),
        Value::Fixed64(bytes) => {
            let nasty = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, 5e-324, -0.0, 1e300, 1e-300];
            *bytes = if chance.percent(50) {
                nasty[chance.below(nasty.len())].to_le_bytes()
            } else {
                nasty::whole(chance, 0).to_le_bytes()
            };
        }
        Value::Fixed32(bytes) => *bytes = (nasty::whole(chance, 0) as u32).to_le_bytes(),
        Value::Bytes(bytes) if chance.percent(60) && !words.is_empty() => {
            bytes.clone_from(&words[chance.below(words.len())]);
        }
        Value::Bytes(bytes) => crate::mutate::bytes(bytes, chance),
        Value::Message(fields) => fields.clear(),
    }
}

fn write_varint(mut value: u64, data: &mut Vec<u8>) {
    while value >= 0x80 {
        data.push(value as u8 | 0x80);
        value >>= 7;
    }
    data.push(value as u8);
}

fn write(fields: &[(u64, Value)], data: &mut Vec<u8>) {
    for (number, value) in fields {
        let kind = match value {
            Value::Varint(_) => 0,
            Value::Fixed64(_) => 1,
            Value::Bytes(_) | Value::Message(_) => 2,
            Value::Fixed32(_) => 5,
        };
        write_varint(number << 3 | kind, data);
        match value {
            Value::Varint(value) => write_varint(*value, data),
            Value::Fixed64(bytes) => data.extend(bytes),
            Value::Fixed32(bytes) => data.extend(bytes),
            Value::Bytes(bytes) => {
                write_varint(bytes.len() as u64, data);
                data.extend(bytes);
            }
            Value::Message(fields) => {
                let mut inner = Vec::new();
                write(fields, &mut inner);
                write_varint(inner.len() as u64, data);
                data.extend(inner);
            }
        }
    }
}
