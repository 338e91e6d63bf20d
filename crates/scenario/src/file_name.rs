//! Names of scenarios, which are names of files on every system.

use flexsc_formats::document::ConfigError;

/// Names of devices on Windows, in place of which no file can be written there.
const DEVICES: [&str; 4] = ["con", "prn", "aux", "nul"];
/// Devices that have a number from 1 to 9 in addition.
const NUMBERED_DEVICES: [&str; 2] = ["com", "lpt"];

/// Returns an error if a scenario's name cannot name its files.
pub fn validate(name: &str) -> Result<(), ConfigError> {
    let why = if name.contains(['/', '\\']) || name.contains(char::is_control) || name.len() > 200 {
        "at most 200 bytes, no slash, no control character"
    } else if name.is_empty() || name.starts_with(['.', '-']) {
        "it must begin with neither a dot nor a hyphen, and not be empty"
    } else if is_device(name) {
        "it must not be the name of a device on Windows"
    } else if name.contains(is_hidden_format) {
        "it must not contain invisible characters, or characters that reverse the direction of the text"
    } else {
        return Ok(());
    };
    Err(ConfigError::new("name", format!("is used for file names: {why}")))
}

/// Returns true for a device of Windows, with or without an extension.
fn is_device(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or_default().trim_end().to_ascii_lowercase();
    let is_numbered = NUMBERED_DEVICES
        .iter()
        .filter_map(|device| stem.strip_prefix(device))
        .any(|rest| matches!(rest.as_bytes(), [b'1'..=b'9']));
    DEVICES.contains(&&*stem) || is_numbered
}

/// Returns true for a character that is not shown and may change the order of others.
fn is_hidden_format(c: char) -> bool {
    matches!(c, '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' | '\u{feff}')
}

#[cfg(test)]
mod tests {
    use super::validate;

    #[test]
    fn names_of_any_language_are_file_names_and_traps_are_not() {
        for name in [
            "relay",
            "a b",
            "weiß",
            "卫星",
            "it's \"x\"",
            "a.b",
            "console",
            "com",
            "com10",
            "x-1",
            "$(x)",
            "%n",
        ] {
            assert_eq!(validate(name).map_err(|fault| fault.why), Ok(()), "{name}");
        }
        let refused = [
            "",
            ".",
            "..",
            ".hidden",
            "-o",
            "--help",
            "con",
            "NUL",
            "Aux.x",
            "com1",
            "lpt9.log",
            "a/b",
            "a\\b",
            "a\nb",
            "a\u{202e}b",
            "a\u{200b}",
            "\u{feff}a",
        ];
        for name in refused {
            assert!(validate(name).is_err(), "{name:?}");
        }
        assert!(validate(&"x".repeat(201)).is_err());
    }
}
