//! Access control of a live run: pages of known or allowed viewers may connect, and programs other than browsers.
//!
//! Any page in a browser may try to connect to this machine, and the browser sends the page's origin. A page whose name
//! was made to resolve to this machine (DNS rebinding) is detected by the host that it requests.

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
/// Largest number of refused origins that are printed on the terminal.
const MAX_PRINTED_ORIGINS: usize = 8;

/// Access control by a request's host and origin.
pub struct AccessControl {
    /// Host name or address of the server.
    own: String,
    /// Additional origins that the user allows.
    allowed: Vec<String>,
    /// Refused origins that have been printed.
    refused_origins: Mutex<BTreeSet<String>>,
}

impl AccessControl {
    /// Returns the access control of a server at this address; `allowed` are origins in addition to the known ones.
    pub fn new(address: &str, allowed: &[String]) -> Self {
        Self { own: host(address).to_owned(), allowed: allowed.to_vec(), refused_origins: Mutex::default() }
    }

    /// Returns an error with the reason if a request must not connect.
    pub fn admit(&self, headers: &HeaderMap) -> Result<(), String> {
        let only = |name| {
            let mut values = headers.get_all(name).iter();
            let first = values.next().map(|value| value.to_str().unwrap_or("?"));
            if values.next().is_some() { Some("?") } else { first }
        };
        let requested_host = only(HOST).unwrap_or_default();
        if !self.is_loopback(host(requested_host)) {
            return Err(format!(
                "this server is not `{requested_host}`: ask for its address, or for localhost"
            ));
        }
        match only(ORIGIN) {
            Some(origin) if !self.is_known_origin(origin) => {
                self.refuse(origin);
                Err(format!("pages of `{origin}` may not connect: --allow-origin lets them"))
            }
            _ => Ok(()),
        }
    }

    /// Returns true if a host always denotes this machine, and is not a name that others could redirect to it.
    fn is_loopback(&self, host: &str) -> bool {
        address(host).is_some() || is_localhost(host) || host.eq_ignore_ascii_case(&self.own)
    }

    fn is_known_origin(&self, origin: &str) -> bool {
        let origin = origin.to_ascii_lowercase();
        let local = |authority| {
            let host = host(authority);
            is_localhost(host) || address(host).is_some_and(|address| address.is_loopback())
        };
        KNOWN.contains(&origin.as_str())
            || self.allowed.contains(&origin)
            || ["http://", "https://"].iter().filter_map(|scheme| origin.strip_prefix(scheme)).any(local)
    }

    fn refuse(&self, origin: &str) {
        let mut reported = self.refused_origins.lock().unwrap_or_else(PoisonError::into_inner);
        let short: String = origin.chars().take(100).collect();
        if reported.len() < MAX_PRINTED_ORIGINS && reported.insert(short.clone()) {
            say!("  live           refused a page of {short}; --allow-origin lets it in");
        }
    }
}

/// Normalises an origin that the user gives to the form that browsers send.
pub fn origin(text: &str) -> Result<String, String> {
    let lower = text.trim_end_matches('/').to_ascii_lowercase();
    let named = lower.split_once("://").filter(|(scheme, host)| {
        let allowed_with =
            |extra: &'static str| move |c: char| c.is_ascii_alphanumeric() || extra.contains(c);
        !scheme.is_empty()
            && scheme.chars().all(allowed_with("+-."))
            && !host.is_empty()
            && host.chars().all(allowed_with("-._:[]"))
    });
    let Some((scheme, host)) = named else {
        return Err(format!("must be an origin such as https://viewer.example, got `{text}`"));
    };
    // Browsers omit the default port.
    let usual = if scheme == "https" { ":443" } else { ":80" };
    let host = if scheme.starts_with("http") { host.strip_suffix(usual).unwrap_or(host) } else { host };
    Ok(format!("{scheme}://{host}"))
}

/// Returns the host of an authority without its port.
fn host(authority: &str) -> &str {
    let end = authority.rfind(']').map_or(0, |end| end + 1);
    authority[end..].rfind(':').map_or(authority, |colon| &authority[..end + colon])
}

/// Returns the IP address of a host, or `None` for a name.
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

    fn admits(gate: &AccessControl, headers: &[(&'static str, &str)]) -> bool {
        let mut map = HeaderMap::new();
        for (name, value) in headers {
            map.append(*name, value.parse().expect("a value"));
        }
        gate.admit(&map).is_ok()
    }

    #[test]
    fn hosts_are_addresses_localhost_or_the_own_name() {
        let gate = AccessControl::new("lab.example:8765", &[]);
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
        let gate = AccessControl::new(
            "127.0.0.1:8765",
            &[origin("https://Viewer.example:443/").expect("an origin")],
        );
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
