//! Layout of the packets of a scenario, declared once: bytes, description and identity follow from it.

use std::fmt::Write as _;

use flexsc_core::control::law::{Command, CommandQuantity};
use flexsc_core::control::quantity::QuantityDescription;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::{SensorTelemetry, Telemetry, TelemetryLayout};

use super::packet::{ContentReader, LONGEST_PACKET, PacketKind};

/// Version of the protocol.
pub const VERSION: u16 = 1;
/// States of a sensor's reading, in the order of their codes.
pub const STATUS: &[&str] = &["none", "held", "new"];
/// Code with which a client answers, about all axes, that the commands in force stay.
const HOLD: usize = CommandQuantity::ALL.len();
/// Quantities of commands in the order of their codes, and that answer.
const QUANTITIES: &[&str] = &{
    let mut words = ["held"; HOLD + 1];
    let mut code = 0;
    while code < HOLD {
        words[code] = CommandQuantity::LABELS[code];
        code += 1;
    }
    words
};
/// Ends of a run, in the order of their codes.
pub const ENDS: &[&str] = &["complete", "interrupted", "failed"];

/// Type of a field.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum FieldType {
    /// Word of a list, as an unsigned integer of 8 bits.
    Word(&'static [&'static str]),
    /// Unsigned integer of 32 bits.
    U32,
    /// Unsigned integer of 64 bits.
    U64,
    /// Signed integer of 64 bits.
    I64,
    /// Number of IEEE 754 with 64 bits.
    F64,
}

impl FieldType {
    /// Returns the name of the type.
    pub fn name(self) -> &'static str {
        match self {
            Self::Word(_) => "u8",
            Self::U32 => "u32",
            Self::U64 => "u64",
            Self::I64 => "i64",
            Self::F64 => "f64",
        }
    }
}

/// Field of a packet.
#[derive(Clone, Debug)]
pub struct Field {
    pub name: String,
    pub form: FieldType,
    pub unit: &'static str,
    /// Names of the components; empty for a scalar.
    pub components: Vec<String>,
    pub meaning: String,
}

impl Field {
    fn new(name: impl Into<String>, form: FieldType, unit: &'static str, meaning: impl Into<String>) -> Self {
        Self { name: name.into(), form, unit, components: Vec::new(), meaning: meaning.into() }
    }

    fn measured(name: String, quantity: &QuantityDescription) -> Self {
        let components = quantity.shape.components();
        Self { components, ..Self::new(name, FieldType::F64, quantity.unit, quantity.text(0)) }
    }
}

/// Layout of the packets of a scenario.
pub struct PacketLayout {
    pub telemetry: TelemetryLayout,
    /// Number of axes with commands.
    pub axes: usize,
    /// Period of the cycles.
    period: Span,
    /// Date of the run's start (ns since 1970 UTC); 0 if the scenario has none.
    epoch_ns: u64,
}

impl PacketLayout {
    /// Returns the layout of a scenario, or the reason why its packets would be too long.
    pub fn new(telemetry: TelemetryLayout, axes: usize, period: Span, epoch_ns: u64) -> Result<Self, String> {
        let layout = Self { telemetry, axes, period, epoch_ns };
        let longest = layout.text().len() + layout.sensor_fields().len() * 8 * 8;
        if longest > LONGEST_PACKET {
            return Err(format!("its packets would have more than {LONGEST_PACKET} bytes"));
        }
        Ok(layout)
    }

    /// Returns the names of the axes; empty for one axis.
    fn axis_names(&self) -> Vec<String> {
        let names: &[&str] = if self.axes > 1 { &["x", "y", "z"] } else { &[] };
        names.iter().map(|&name| name.to_owned()).collect()
    }

    /// Returns the fields of the packet with the sensors.
    pub fn sensor_fields(&self) -> Vec<Field> {
        let mut fields = Self::cycle_fields();
        let date = "date in ns since 1970 UTC; 0 if the scenario has no epoch";
        fields.push(Field::new("utc_ns", FieldType::U64, "ns", date));
        for sensor in &self.telemetry.sensors {
            let group = &sensor.group;
            let status = "whether a reading has come since the last packet";
            fields.push(Field::new(format!("{group}.status"), FieldType::Word(STATUS), "", status));
            let at = "time at which the reading became available";
            fields.push(Field::new(format!("{group}.time_s"), FieldType::I64, "s", at));
            let past = "femtoseconds past it";
            fields.push(Field::new(format!("{group}.time_fs"), FieldType::I64, "fs", past));
            fields.extend(
                sensor.fields.iter().map(|own| Field::measured(format!("{group}.{}", own.name), own)),
            );
        }
        fields.extend(self.telemetry.law_inputs.iter().map(|own| Field::measured(own.path(), own)));
        fields
    }

    /// Returns the fields of the packet with the commands.
    pub fn command_fields(&self) -> Vec<Field> {
        let meaning =
            "quantity of the command about the axis; held about all axes, if the commands in force stay";
        let words = FieldType::Word(QUANTITIES);
        let mut quantity = Field::new("command.quantity", words, "", meaning);
        let mut value =
            Field::new("command.value", FieldType::F64, "", "command, in the SI unit of its quantity");
        quantity.components = self.axis_names();
        value.components = self.axis_names();
        let mut fields = Self::request_fields();
        fields.extend([quantity, value]);
        fields
    }

    /// Returns the fields of the packet that requests a cycle.
    pub fn request_fields() -> Vec<Field> {
        vec![
            Field::new("session", FieldType::U32, "", "number of the run, from the welcome"),
            Field::new("cycle", FieldType::U64, "", "number of the cycle, from 0"),
        ]
    }

    /// Returns the fields of a packet that begins with the time of a cycle.
    fn cycle_fields() -> Vec<Field> {
        let mut fields = Self::request_fields();
        fields.push(Field::new("time_s", FieldType::I64, "s", "whole seconds of the simulated time"));
        fields.push(Field::new("time_fs", FieldType::I64, "fs", "femtoseconds past them"));
        fields
    }

    /// Returns the fields of the packet that ends a run.
    pub fn end_fields() -> Vec<Field> {
        let mut fields = Self::cycle_fields();
        fields.push(Field::new("end", FieldType::Word(ENDS), "", "how the run has ended"));
        fields
    }

    /// Returns the description of the packets that a client receives: the period, and a line for each field of the sensors
    /// with its type, its components and its unit.
    pub fn text(&self) -> String {
        let (whole, part) = (Instant::START + self.period).parts();
        let mut text = format!("flexsc-lockstep {VERSION} axes {} period {whole} {part}\n", self.axes);
        for Field { name, form, unit, components, .. } in self.sensor_fields() {
            let components = if components.is_empty() { "-".to_owned() } else { components.join(",") };
            let unit = if unit.is_empty() { "-" } else { unit };
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{name} {} {components} {unit}", form.name());
        }
        text
    }

    /// Returns the identity of the layout: the hash FNV-1a of its description.
    pub fn hash(&self) -> u64 {
        let step = |hash: u64, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01B3);
        self.text().bytes().fold(0xCBF2_9CE4_8422_2325, step)
    }

    /// Returns the content of the packet with the sensors at `now`; readings after `before` are new.
    pub fn sensor_content(
        &self,
        [session, cycle]: [u64; 2],
        now: Instant,
        before: Option<Instant>,
        telemetry: &Telemetry,
    ) -> Vec<u8> {
        let mut content = cycle_content([session, cycle], now);
        let date = if self.epoch_ns == 0 { 0 } else { self.epoch_ns + now.nanoseconds() };
        content.extend(date.to_be_bytes());
        for SensorTelemetry { at, values } in &telemetry.sensors {
            let is_new = at.is_some_and(|at| before.is_none_or(|before| at > before));
            content.push(u8::from(at.is_some()) + u8::from(is_new));
            push_time(&mut content, at.unwrap_or(Instant::START));
            content.extend(values.iter().flat_map(|value| value.to_be_bytes()));
        }
        content.extend(telemetry.law_inputs.iter().flat_map(|value| value.to_be_bytes()));
        content
    }

    /// Returns the commands in the content of a packet after its cycle, none if those in force stay; `None` if it has another
    /// length, and a text if a command is none.
    pub fn commands(&self, mut content: ContentReader<'_>) -> Option<Result<Option<[Command; 3]>, String>> {
        let mut quantities = [0; 3];
        let mut commands = [Command::Torque(0.0); 3];
        for quantity in &mut quantities[..self.axes] {
            *quantity = content.u8()?;
        }
        let is_held = quantities[..self.axes].iter().all(|code| usize::from(*code) == HOLD);
        let mut faults = Vec::new();
        for (axis, code) in quantities.into_iter().enumerate().take(self.axes) {
            let value = content.f64()?;
            match CommandQuantity::ALL.get(usize::from(code)) {
                _ if is_held => {}
                Some(quantity) if value.is_finite() => commands[axis] = quantity.command(value),
                Some(_) => faults.push(format!("the command about axis {} is {value}", axis + 1)),
                None => faults.push(format!("the command about axis {} has the quantity {code}", axis + 1)),
            }
        }
        let fault = faults.into_iter().next();
        content.0.is_empty().then_some(fault.map_or(Ok((!is_held).then_some(commands)), Err))
    }
}

/// Returns the content that every packet of a cycle begins with.
pub fn cycle_content([session, cycle]: [u64; 2], now: Instant) -> Vec<u8> {
    let mut content = (session as u32).to_be_bytes().to_vec();
    content.extend(cycle.to_be_bytes());
    push_time(&mut content, now);
    content
}

fn push_time(content: &mut Vec<u8>, at: Instant) {
    let (whole, part) = at.parts();
    content.extend((whole as i64).to_be_bytes());
    content.extend((part as i64).to_be_bytes());
}

/// Packets of the cycles with their fields, by the names that XTCE gives them.
pub fn declared(layout: &PacketLayout) -> [(&'static str, PacketKind, Vec<Field>); 4] {
    [
        ("sensors", PacketKind::Sensors, layout.sensor_fields()),
        ("command", PacketKind::Command, layout.command_fields()),
        ("request", PacketKind::Request, PacketLayout::request_fields()),
        ("end", PacketKind::End, PacketLayout::end_fields()),
    ]
}
