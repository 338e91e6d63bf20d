//! CCSDS Space Packets: the primary header of CCSDS 133.0-B-2, and the packet error control of CCSDS 132.0-B-3 at the end.

/// Bytes of the primary header and of the packet error control.
const HEADER: usize = 6;
const ERROR_CONTROL: usize = 2;
/// Bytes of the longest packet: its length field has 16 bits, and a datagram takes less.
pub const LONGEST_PACKET: usize = 60_000;

/// Kind of packet, by its application process identifier.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum PacketKind {
    /// Request of a client to begin.
    Hello,
    /// Answer to a hello: the session and the layout of its packets.
    Welcome,
    /// Reason why a client cannot begin or go on.
    Refusal,
    /// Request of a client for the next cycle, where it controls the time.
    Request,
    /// Sensors of a cycle.
    Sensors,
    /// Commands of a cycle.
    Command,
    /// End of the run.
    End,
    /// Confirmation of the end.
    Farewell,
}

impl PacketKind {
    /// All kinds, in the order of their identifiers.
    const ALL: [Self; 8] = [
        Self::Hello,
        Self::Welcome,
        Self::Refusal,
        Self::Request,
        Self::Sensors,
        Self::Command,
        Self::End,
        Self::Farewell,
    ];
    /// Identifier of the first kind.
    const FIRST: u16 = 0x2F0;

    /// Returns the application process identifier.
    pub fn apid(self) -> u16 {
        Self::FIRST + self as u16
    }

    /// Returns true if clients send it: a telecommand, and else telemetry.
    pub fn is_telecommand(self) -> bool {
        matches!(self, Self::Hello | Self::Request | Self::Command | Self::Farewell)
    }

    fn from_header(first: u16) -> Option<Self> {
        // Version 0 and no secondary header.
        let kind = Self::ALL.into_iter().find(|kind| kind.apid() == first & 0x7FF)?;
        (first >> 11 == u16::from(kind.is_telecommand()) << 1).then_some(kind)
    }
}

/// Fault of received bytes.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct Damaged;

/// Writer of packets, which counts those of each kind.
#[derive(Clone, Debug, Default)]
pub struct PacketWriter {
    counts: [u16; PacketKind::ALL.len()],
}

impl PacketWriter {
    /// Returns a packet with this content.
    pub fn packet(&mut self, kind: PacketKind, content: &[u8]) -> Vec<u8> {
        let count = &mut self.counts[kind as usize];
        let first = u16::from(kind.is_telecommand()) << 12 | kind.apid();
        let length = content.len() + ERROR_CONTROL - 1;
        let mut packet = Vec::with_capacity(HEADER + content.len() + ERROR_CONTROL);
        for word in [first, 0xC000 | *count, length as u16] {
            packet.extend(word.to_be_bytes());
        }
        *count = (*count + 1) & 0x3FFF;
        packet.extend(content);
        packet.extend(checksum(&packet).to_be_bytes());
        packet
    }
}

/// Returns the kind and the content of a whole packet.
pub fn open(packet: &[u8]) -> Result<(PacketKind, &[u8]), Damaged> {
    if length(packet) != Some(packet.len()) || packet.len() < HEADER + ERROR_CONTROL {
        return Err(Damaged);
    }
    let (data, sum) = packet.split_at(packet.len() - ERROR_CONTROL);
    let kind = PacketKind::from_header(u16::from_be_bytes([packet[0], packet[1]])).ok_or(Damaged)?;
    if checksum(data).to_be_bytes() != sum || data[2] >> 6 != 3 {
        return Err(Damaged);
    }
    Ok((kind, &data[HEADER..]))
}

/// Returns the length of the packet at the start of a stream by its header; `None` if the header is not complete.
pub fn length(stream: &[u8]) -> Option<usize> {
    let header = stream.get(..HEADER)?;
    Some(HEADER + 1 + usize::from(u16::from_be_bytes([header[4], header[5]])))
}

/// Returns the cyclic redundancy check of 16 bits with the polynomial x^16 + x^12 + x^5 + 1, from all ones.
fn checksum(data: &[u8]) -> u16 {
    let shift = |sum: u16| if sum & 0x8000 == 0 { sum << 1 } else { sum << 1 ^ 0x1021 };
    data.iter().fold(0xFFFF, |sum, byte| (0..8).fold(sum ^ u16::from(*byte) << 8, |sum, _| shift(sum)))
}

/// Reader of the big-endian numbers of a packet's content.
pub struct ContentReader<'a>(pub &'a [u8]);

impl ContentReader<'_> {
    fn bytes<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (bytes, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*bytes)
    }

    pub fn u8(&mut self) -> Option<u8> {
        self.bytes().map(|[byte]| byte)
    }

    pub fn u16(&mut self) -> Option<u16> {
        self.bytes().map(u16::from_be_bytes)
    }

    pub fn u32(&mut self) -> Option<u32> {
        self.bytes().map(u32::from_be_bytes)
    }

    pub fn u64(&mut self) -> Option<u64> {
        self.bytes().map(u64::from_be_bytes)
    }

    pub fn f64(&mut self) -> Option<f64> {
        self.bytes().map(f64::from_be_bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_is_that_of_the_standard() {
        // The check value of CRC-16/IBM-3740, in the catalogue of parametrised CRC algorithms.
        assert_eq!(checksum(b"123456789"), 0x29B1);
    }

    #[test]
    fn packets_are_opened_unless_a_bit_changed() {
        let mut writer = PacketWriter::default();
        for kind in PacketKind::ALL {
            let packet = writer.packet(kind, b"content");
            assert_eq!((packet.len(), length(&packet)), (15, Some(15)));
            assert_eq!(open(&packet), Ok((kind, &b"content"[..])));
            for bit in 0..packet.len() * 8 {
                let mut damaged = packet.clone();
                damaged[bit / 8] ^= 1 << (bit % 8);
                assert_eq!(open(&damaged), Err(Damaged), "{kind:?} {bit}");
            }
            assert_eq!(open(&packet[..14]), Err(Damaged));
        }
        assert_eq!(open(&[]), Err(Damaged));
    }

    #[test]
    fn the_header_has_the_fields_of_the_standard() {
        let mut writer = PacketWriter::default();
        writer.counts[PacketKind::Command as usize] = 0x3FFF;
        let packet = writer.packet(PacketKind::Command, &[7]);
        // Telecommand, identifier 0x2F5; unsegmented, count 16383; three bytes follow.
        assert_eq!(packet[..7], [0x12, 0xF5, 0xFF, 0xFF, 0, 2, 7]);
        let packet = writer.packet(PacketKind::Command, &[7]);
        assert_eq!(packet[2..4], [0xC0, 0], "the count wraps");
        assert_eq!(writer.packet(PacketKind::Sensors, &[])[..2], [0x02, 0xF4]);
    }
}
