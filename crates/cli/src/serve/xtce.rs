//! Description of the packets of a scenario in XTCE 1.2 (OMG formal/18-10-04), for ground systems.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::layout::{Field, FieldType, PacketLayout, declared};

/// Fields of the primary header, with their bits.
const HEADER: [(&str, u8); 7] = [
    ("packet_version", 3),
    ("packet_type", 1),
    ("secondary_header", 1),
    ("apid", 11),
    ("sequence_flags", 2),
    ("sequence_count", 14),
    ("packet_length", 16),
];
/// Last field of every packet.
const CHECKSUM: &str = "packet_error_control";

/// Returns the description as XML.
pub fn document(scenario: &str, layout: &PacketLayout) -> String {
    let packets = declared(layout);
    let mut types = String::new();
    let mut parameters = String::new();
    let mut containers = String::new();
    let mut known_types = BTreeSet::new();
    let mut known = BTreeSet::new();
    for (name, bits) in HEADER.into_iter().chain([(CHECKSUM, 16)]) {
        types += &integer_type(name, bits, false, "");
        parameters += &parameter(name, name, "");
    }
    containers += "      <SequenceContainer name=\"CCSDSPacket\" abstract=\"true\">\n        <EntryList>\n";
    for (name, _) in HEADER {
        containers += &entry(name);
    }
    containers += "        </EntryList>\n      </SequenceContainer>\n";
    for (packet, kind, fields) in &packets {
        let _ = writeln!(containers, "      <SequenceContainer name=\"{packet}\">\n        <EntryList>");
        for field in fields {
            let type_name = format!("{}_type", identifier(&field.name));
            if known_types.insert(type_name.clone()) {
                types += &field_type(&type_name, field);
            }
            for name in names(field) {
                if known.insert(name.clone()) {
                    parameters += &parameter(&name, type_name.trim_end_matches("_type"), &field.meaning);
                }
                containers += &entry(&name);
            }
        }
        containers += &entry(CHECKSUM);
        let _ = writeln!(
            containers,
            "        </EntryList>\n        <BaseContainer containerRef=\"CCSDSPacket\">\n          <RestrictionCriteria>\n            \
             <Comparison parameterRef=\"apid\" value=\"{}\" useCalibratedValue=\"false\"/>\n          \
             </RestrictionCriteria>\n        </BaseContainer>\n      </SequenceContainer>",
            kind.apid()
        );
    }
    let description =
        escaped(&format!("Packets of flexsc serve, scenario {scenario}; layout {:016x}", layout.hash()));
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <SpaceSystem xmlns=\"http://www.omg.org/spec/XTCE/20180204\" name=\"flexsc\" shortDescription=\"{description}\">\n  \
         <TelemetryMetaData>\n    <ParameterTypeSet>\n{types}    </ParameterTypeSet>\n    \
         <ParameterSet>\n{parameters}    </ParameterSet>\n    \
         <ContainerSet>\n{containers}    </ContainerSet>\n  </TelemetryMetaData>\n</SpaceSystem>\n"
    )
}

/// Returns the names of the parameters of a field, one for each component.
fn names(field: &Field) -> Vec<String> {
    let name = identifier(&field.name);
    if field.components.is_empty() {
        return vec![name];
    }
    field.components.iter().map(|component| format!("{name}_{component}")).collect()
}

/// Returns a name without the separators that XTCE reserves for paths.
fn identifier(name: &str) -> String {
    name.replace('.', "_")
}

fn parameter(name: &str, kind: &str, meaning: &str) -> String {
    let meaning = if meaning.is_empty() {
        String::new()
    } else {
        format!(" shortDescription=\"{}\"", escaped(meaning))
    };
    format!("      <Parameter name=\"{name}\" parameterTypeRef=\"{kind}_type\"{meaning}/>\n")
}

fn entry(name: &str) -> String {
    format!("          <ParameterRefEntry parameterRef=\"{name}\"/>\n")
}

fn unit_set(unit: &str) -> String {
    if unit.is_empty() {
        return "        <UnitSet/>\n".to_owned();
    }
    format!("        <UnitSet>\n          <Unit>{}</Unit>\n        </UnitSet>\n", escaped(unit))
}

fn integer_type(name: &str, bits: u8, signed: bool, unit: &str) -> String {
    let encoding = if signed { "twosComplement" } else { "unsigned" };
    format!(
        "      <IntegerParameterType name=\"{name}_type\" sizeInBits=\"{bits}\" signed=\"{signed}\">\n{}        \
         <IntegerDataEncoding sizeInBits=\"{bits}\" encoding=\"{encoding}\"/>\n      </IntegerParameterType>\n",
        unit_set(unit)
    )
}

fn field_type(type_name: &str, field: &Field) -> String {
    let name = type_name.trim_end_matches("_type");
    match field.form {
        FieldType::U32 => integer_type(name, 32, false, field.unit),
        FieldType::U64 => integer_type(name, 64, false, field.unit),
        FieldType::I64 => integer_type(name, 64, true, field.unit),
        FieldType::F64 => format!(
            "      <FloatParameterType name=\"{type_name}\" sizeInBits=\"64\">\n{}        \
             <FloatDataEncoding sizeInBits=\"64\" encoding=\"IEEE754_1985\"/>\n      </FloatParameterType>\n",
            unit_set(field.unit)
        ),
        FieldType::Word(words) => {
            let words = words.iter().enumerate().fold(String::new(), |mut text, (code, word)| {
                let _ = writeln!(text, "          <Enumeration value=\"{code}\" label=\"{word}\"/>");
                text
            });
            format!(
                "      <EnumeratedParameterType name=\"{type_name}\">\n{}        \
                 <IntegerDataEncoding sizeInBits=\"8\" encoding=\"unsigned\"/>\n        \
                 <EnumerationList>\n{words}        </EnumerationList>\n      </EnumeratedParameterType>\n",
                unit_set(field.unit)
            )
        }
    }
}

/// Returns a text with the characters of XML's markup replaced.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
