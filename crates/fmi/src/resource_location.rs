//! Directory of the resources, as a path (FMI 3.0) or as a URI of the scheme `file` (FMI 2.0).

use std::path::PathBuf;

/// Returns the directory that a path or a URI names.
pub fn directory(location: &str) -> PathBuf {
    let Some(rest) = location.strip_prefix("file:") else { return PathBuf::from(location) };
    // After an authority, which is empty or `localhost`, the path begins with a slash.
    let path = rest.strip_prefix("//").map_or(rest, |rest| rest.find('/').map_or("", |slash| &rest[slash..]));
    let path = decoded(path);
    let is_drive = path.as_bytes().get(2) == Some(&b':') && cfg!(windows);
    PathBuf::from(if is_drive { &path[1..] } else { &path })
}

/// Returns a text with its percent-encoded bytes decoded.
fn decoded(text: &str) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((first, after)) = rest.split_first() {
        let digits = after.get(..2).and_then(|digits| std::str::from_utf8(digits).ok());
        let coded = digits.and_then(|digits| u8::from_str_radix(digits, 16).ok());
        if let Some(byte) = coded.filter(|_| *first == b'%') {
            bytes.push(byte);
            rest = &after[2..];
        } else {
            bytes.push(*first);
            rest = after;
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_and_uris_name_directories() {
        let is = |location: &str, path: &str| assert_eq!(directory(location), PathBuf::from(path));
        is("/tmp/a b/resources/", "/tmp/a b/resources/");
        is("file:///tmp/a%20b/resources", "/tmp/a b/resources");
        is("file://localhost/tmp/%C3%A9", "/tmp/\u{e9}");
        is("file:/tmp/100%", "/tmp/100%");
    }
}
