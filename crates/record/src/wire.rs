//! Protobuf wire format: keys, numbers, and blocks of bytes, none of which is longer than the available bytes.

/// Remaining bytes of a message.
#[derive(Copy, Clone)]
pub struct WireMessage<'a>(&'a [u8]);

/// Value of a field in the wire format.
#[derive(Copy, Clone)]
pub enum WireValue<'a> {
    /// Number of up to 64 bits.
    Varint(u64),
    /// Number of eight bytes.
    Fixed64(u64),
    /// Number of four bytes.
    Fixed32(u32),
    /// Bytes preceded by their length.
    Block(&'a [u8]),
    /// Group, whose fields are skipped.
    Group,
}

impl<'a> WireMessage<'a> {
    /// Creates the reader of a message.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self(bytes)
    }

    /// Reads the next field's number and value; `None` at the end.
    pub fn field(&mut self) -> Result<Option<(u32, WireValue<'a>)>, String> {
        if self.0.is_empty() {
            return Ok(None);
        }
        self.next().map(Some).ok_or_else(|| "a message ends within a field".to_owned())
    }

    fn next(&mut self) -> Option<(u32, WireValue<'a>)> {
        let (number, mut raw) = self.one()?;
        if matches!(raw, Some(WireValue::Group)) {
            // Nested groups end before their group does.
            let mut open = 1_u64;
            while open > 0 {
                match self.one()?.1 {
                    Some(WireValue::Group) => open += 1,
                    None => open -= 1,
                    Some(_) => {}
                }
            }
            raw = Some(WireValue::Group);
        }
        Some((number, raw?))
    }

    /// Reads a field, the beginning of a group or, without a value, its end.
    fn one(&mut self) -> Option<(u32, Option<WireValue<'a>>)> {
        let key = self.varint()?;
        let number = u32::try_from(key >> 3).ok()?;
        let raw = match key & 7 {
            0 => WireValue::Varint(self.varint()?),
            1 => WireValue::Fixed64(self.fixed64()?),
            2 => {
                let length = usize::try_from(self.varint()?).ok()?;
                WireValue::Block(self.read_bytes(length)?)
            }
            3 => WireValue::Group,
            4 => return Some((number, None)),
            5 => WireValue::Fixed32(self.fixed32()?),
            _ => return None,
        };
        Some((number, Some(raw)))
    }

    /// Returns true if no bytes are left.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Reads a number in groups of seven bits.
    pub fn varint(&mut self) -> Option<u64> {
        let mut value = 0;
        for place in 0..10 {
            let (byte, rest) = self.0.split_first()?;
            self.0 = rest;
            value |= u64::from(byte & 0x7f) << (7 * place);
            if byte & 0x80 == 0 {
                return Some(value);
            }
        }
        None
    }

    /// Reads eight bytes.
    pub fn fixed64(&mut self) -> Option<u64> {
        let (now, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(u64::from_le_bytes(*now))
    }

    /// Reads four bytes.
    pub fn fixed32(&mut self) -> Option<u32> {
        let (now, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(u32::from_le_bytes(*now))
    }

    fn read_bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        let (now, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(now)
    }
}
