//! Who may connect: pages of viewers that are known or named, and programs that are no pages.
//!
//! Any page that a browser shows may try to connect to this machine, and the browser sends its origin. A page whose
//! name was made to lead here (DNS rebinding) is known by the host that it asks for.

use std::collections::BTreeSet;
use std::io::Write;
use std::net::{IpAddr, Ipv6Addr};
use std::sync::{Mutex, PoisonError};

use tungstenite::http::HeaderMap;
use tungstenite::http::header::{HOST, ORIGIN};

use crate::say;

/// Origins of hosted viewers, and of installed ones.
const KNOWN: [&str; 4] = [
    "https://app.foxglove.dev",
    "https://studio.foxglove.dev",
    "https://lichtblick-suite.github.io",
    "file://",
];
/// So many refused origins are printed on the terminal.
const MOST_TOLD: usize = 8;

/// Who may connect.
pub struct Gate {
    /// The name at which the server serves.
    own: String,
    /// The origins that the user lets in.
    allowed: Vec<String>,
    /// The refused origins that were printed.
    told: Mutex<BTreeSet<String>>,
}

impl Gate {
    /// A server at this host and port, for these origins beside those that are known.
    pub fn new(address: &str, allowed: &[String]) -> Self {
        Self { own: host(address).to_owned(), allowed: allowed.to_vec(), told: Mutex::default() }
    }

    /// Whether a request may connect, or why not.
    pub fn admit(&self, headers: &HeaderMap) -> Result<(), String> {
        let only = |name| {
            let mut values = headers.get_all(name).iter();
            let first = values.next().map(|value| value.to_str().unwrap_or("?"));
            if values.next().is_some() { Some("?") } else { first }
        };
        let asked = only(HOST).unwrap_or_default();
        if !self.is_own(host(asked)) {
            return Err(format!("this server is not `{asked}`: ask for its address, or for localhost"));
        }
        match only(ORIGIN) {
            Some(origin) if !self.knows(origin) => {
                self.tell(origin);
                Err(format!("pages of `{origin}` may not connect: --allow-origin lets them"))
            }
            _ => Ok(()),
        }
    }

    /// Whether a host can only be this one, and not a name that others could point here.
    fn is_own(&self, host: &str) -> bool {
        address(host).is_some() || is_localhost(host) || host.eq_ignore_ascii_case(&self.own)
    }

    fn knows(&self, origin: &str) -> bool {
        let origin = origin.to_ascii_lowercase();
        let local = |authority| {
            let host = host(authority);
            is_localhost(host) || address(host).is_some_and(|address| address.is_loopback())
        };
        KNOWN.contains(&origin.as_str())
            || self.allowed.contains(&origin)
            || ["http://", "https://"].iter().filter_map(|scheme| origin.strip_prefix(scheme)).any(local)
    }

    fn tell(&self, origin: &str) {
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        let short: String = origin.chars().take(100).collect();
        if told.len() < MOST_TOLD && told.insert(short.clone()) {
            say!("  live           refused a page of {short}; --allow-origin lets it in");
        }
    }
}

/// An origin that a user gives, as browsers write it.
pub fn origin(text: &str) -> Result<String, String> {
    let lower = text.trim_end_matches('/').to_ascii_lowercase();
    let named = lower.split_once("://").filter(|(scheme, host)| {
        let of = |extra: &'static str| move |c: char| c.is_ascii_alphanumeric() || extra.contains(c);
        !scheme.is_empty()
            && scheme.chars().all(of("+-."))
            && !host.is_empty()
            && host.chars().all(of("-._:[]"))
    });
    let Some((scheme, host)) = named else {
        return Err(format!("must be an origin such as https://viewer.example, got `{text}`"));
    };
    // Browsers leave out the port that goes without saying.
    let usual = if scheme == "https" { ":443" } else { ":80" };
    let host = if scheme.starts_with("http") { host.strip_suffix(usual).unwrap_or(host) } else { host };
    Ok(format!("{scheme}://{host}"))
}

/// A host without its port.
fn host(authority: &str) -> &str {
    let end = authority.rfind(']').map_or(0, |end| end + 1);
    authority[end..].rfind(':').map_or(authority, |colon| &authority[..end + colon])
}

/// The address that a host is, if it is no name.
fn address(host: &str) -> Option<IpAddr> {
    let inner = host.strip_prefix('[').and_then(|host| host.strip_suffix(']'));
    inner.map_or_else(|| host.parse().ok(), |host| host.parse().ok().map(|v6: Ipv6Addr| v6.into()))
}

fn is_localhost(host: &str) -> bool {
    let host = host.trim_end_matches('.').to_ascii_lowercase();
    host == "localhost" || host.ends_with(".localhost")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn admits(gate: &Gate, headers: &[(&'static str, &str)]) -> bool {
        let mut map = HeaderMap::new();
        for (name, value) in headers {
            map.append(*name, value.parse().expect("a value"));
        }
        gate.admit(&map).is_ok()
    }

    #[test]
    fn hosts_are_addresses_localhost_or_the_own_name() {
        let gate = Gate::new("lab.example:8765", &[]);
        for (host, expected) in [
            ("127.0.0.1:8765", true),
            ("192.168.1.20:8765", true),
            ("[::1]:8765", true),
            ("[fe80::1]", true),
            ("localhost:8765", true),
            ("LOCALHOST", true),
            ("a.localhost:1", true),
            ("Lab.example:8765", true),
            ("evil.example:8765", false),
            ("127.0.0.1.evil.example", false),
            ("localhost.evil.example", false),
            ("[::1].evil.example", false),
            ("", false),
        ] {
            assert_eq!(admits(&gate, &[("host", host)]), expected, "{host}");
        }
        assert!(!admits(&gate, &[]), "no host");
        assert!(!admits(&gate, &[("host", "localhost"), ("host", "localhost")]), "two hosts");
    }

    #[test]
    fn origins_are_known_local_or_named() {
        let gate = Gate::new("127.0.0.1:8765", &[origin("https://Viewer.example:443/").expect("an origin")]);
        for (origin, expected) in [
            ("https://app.foxglove.dev", true),
            ("https://studio.foxglove.dev", true),
            ("https://lichtblick-suite.github.io", true),
            ("file://", true),
            ("http://localhost:8080", true),
            ("https://localhost", true),
            ("http://127.0.0.1:3000", true),
            ("http://127.4.5.6", true),
            ("http://[::1]:8080", true),
            ("https://viewer.example", true),
            ("http://viewer.example", false),
            ("https://viewer.example:8443", false),
            ("http://app.foxglove.dev", false),
            ("https://app.foxglove.dev.evil.example", false),
            ("http://localhost.evil.example", false),
            ("http://192.168.1.20", false),
            ("https://evil.example", false),
            ("null", false),
            ("", false),
        ] {
            assert_eq!(admits(&gate, &[("host", "localhost"), ("origin", origin)]), expected, "{origin}");
        }
        let two = [("host", "localhost"), ("origin", "file://"), ("origin", "https://evil.example")];
        assert!(!admits(&gate, &two), "two origins");
        assert!(admits(&gate, &[("host", "localhost")]), "no page");
    }

    #[test]
    fn what_is_no_origin_is_refused() {
        for text in
            ["", "null", "*", "viewer.example", "https://", "https://a/b", "https://a b", "https://a@b"]
        {
            assert!(origin(text).is_err(), "{text}");
        }
        assert_eq!(origin("http://a:80").as_deref(), Ok("http://a"));
        assert_eq!(origin("https://a:80").as_deref(), Ok("https://a:80"));
        assert_eq!(origin("vscode-webview://id").as_deref(), Ok("vscode-webview://id"));
    }
}
