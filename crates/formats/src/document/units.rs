//! Units of numbers that are written as texts, such as `deg/s`, and their conversion to SI.

use std::f64::consts::{PI, TAU};

/// Unit: its factor to SI, and twice the exponents of metre, kilogram, second, ampere and radian.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Unit {
    factor: f64,
    twice: [i16; 5],
    /// True if the unit counts cycles, which are converted to 2π rad where an angle is expected.
    cycles: bool,
}

const ONE: Unit = Unit { factor: 1.0, twice: [0; 5], cycles: false };
const DEGREE: f64 = PI / 180.0;

/// Units by their symbols: factor, exponents of metre, kilogram, second, ampere and radian, and true if prefixes are
/// allowed.
const SYMBOLS: &[(&str, f64, [i16; 5], bool)] = &[
    ("m", 1.0, [1, 0, 0, 0, 0], true),
    ("g", 1e-3, [0, 1, 0, 0, 0], true),
    ("s", 1.0, [0, 0, 1, 0, 0], true),
    ("A", 1.0, [0, 0, 0, 1, 0], true),
    ("rad", 1.0, [0, 0, 0, 0, 1], true),
    ("min", 60.0, [0, 0, 1, 0, 0], false),
    ("h", 3600.0, [0, 0, 1, 0, 0], false),
    ("d", 86400.0, [0, 0, 1, 0, 0], false),
    // As data sheets write them.
    ("sec", 1.0, [0, 0, 1, 0, 0], false),
    ("hr", 3600.0, [0, 0, 1, 0, 0], false),
    ("day", 86400.0, [0, 0, 1, 0, 0], false),
    ("deg", DEGREE, [0, 0, 0, 0, 1], false),
    ("\u{b0}", DEGREE, [0, 0, 0, 0, 1], false),
    ("arcmin", DEGREE / 60.0, [0, 0, 0, 0, 1], false),
    ("arcsec", DEGREE / 3600.0, [0, 0, 0, 0, 1], false),
    ("mas", DEGREE / 3.6e6, [0, 0, 0, 0, 1], false),
    ("rpm", TAU / 60.0, [0, 0, -1, 0, 1], false),
    ("N", 1.0, [1, 1, -2, 0, 0], true),
    ("Nm", 1.0, [2, 1, -2, 0, 0], true),
    ("Nms", 1.0, [2, 1, -1, 0, 0], true),
    ("J", 1.0, [2, 1, -2, 0, 0], true),
    ("T", 1.0, [0, 1, -2, -1, 0], true),
    ("Hz", 1.0, [0, 0, -1, 0, 0], true),
    ("cycles", 1.0, [0, 0, 0, 0, 0], false),
    ("cycle", 1.0, [0, 0, 0, 0, 0], false),
];

const PREFIXES: &[(&str, f64)] = &[
    ("n", 1e-9),
    ("u", 1e-6),
    ("\u{b5}", 1e-6),
    ("\u{3bc}", 1e-6),
    ("m", 1e-3),
    ("c", 1e-2),
    ("k", 1e3),
    ("M", 1e6),
    ("G", 1e9),
];

/// Common spellings of units, in lower case without points: singular, and the unit that is meant.
const ALIASES: &[(&str, &str)] = &[
    ("amp", "A"),
    ("ampere", "A"),
    ("arcminute", "arcmin"),
    ("arcsecond", "arcsec"),
    ("as", "arcsec"),
    ("asec", "arcsec"),
    ("day", "d"),
    ("degree", "deg"),
    ("gram", "g"),
    ("hertz", "Hz"),
    ("hour", "h"),
    ("hr", "h"),
    ("kilogram", "kg"),
    ("meter", "m"),
    ("metre", "m"),
    ("minute", "min"),
    ("newton", "N"),
    ("radian", "rad"),
    ("rev", "rpm"),
    ("rt", "sqrt"),
    ("sec", "s"),
    ("second", "s"),
    ("tesla", "T"),
];

/// Signs of minutes and seconds of arc, which stand for feet and inches too.
const ARC_SIGNS: [(&str, &str); 6] = [
    ("\"", "arcsec"),
    ("''", "arcsec"),
    ("\u{2033}", "arcsec"),
    ("\u{2032}\u{2032}", "arcsec"),
    ("'", "arcmin"),
    ("\u{2032}", "arcmin"),
];

/// Accepted parts of a unit, for error messages.
pub const KNOWN: &str = "m, g, s, A, rad, N, Nm, Nms, J, T and Hz with prefixes from n to G, min, h, d, deg, arcmin, arcsec, mas, \
                         rpm and cycles, joined as in `N m s/rad` or `deg/sqrt(h)`";

/// The unit that was probably meant by a text that is none.
pub fn meant(text: &str) -> Option<String> {
    if let Some((_, unit)) = ARC_SIGNS.iter().find(|(sign, _)| *sign == text.trim()) {
        return Some((*unit).to_owned());
    }
    let mut rest = text.trim();
    let mut meant = String::new();
    while let Some(first) = rest.chars().next() {
        if !first.is_alphabetic() {
            // A root without brackets is of the word behind it.
            if first == '\u{221a}' {
                meant.push_str("sqrt");
            } else {
                meant.push(first);
            }
            rest = &rest[first.len_utf8()..];
            continue;
        }
        let end = rest.find(|c: char| !c.is_alphabetic()).unwrap_or(rest.len());
        let (word, after) = rest.split_at(end);
        rest = after;
        match word.strip_prefix("rt").map(word_meant) {
            // rtHz, rthr
            Some(Some(radicand)) => meant.extend(["sqrt(", radicand.as_str(), ")"]),
            _ => meant.push_str(&word_meant(word)?),
        }
        // m2, s2
        if rest.starts_with(|c: char| ('2'..='4').contains(&c)) {
            meant.push('^');
        }
    }
    for (written, accepted) in [("sqrt-", "sqrt "), ("rpm/min", "rpm"), ("rpm/s", "Hz")] {
        meant = meant.replace(written, accepted);
    }
    if let Some((before, radicand)) = meant.split_once("sqrt ").or_else(|| split_root(&meant)) {
        meant = format!("{before}sqrt({radicand})");
    }
    (meant != text.trim() && Unit::parse(&meant).is_some()).then_some(meant)
}

/// A root whose radicand stands behind it without brackets.
fn split_root(text: &str) -> Option<(&str, &str)> {
    let (before, radicand) = text.split_once("sqrt")?;
    (!radicand.starts_with('(')).then_some((before, radicand))
}

fn word_meant(word: &str) -> Option<String> {
    if word == "sqrt" || Unit::symbol(word).is_some() {
        return Some(word.to_owned());
    }
    let lower = word.to_lowercase();
    let singular = lower.strip_suffix('s').unwrap_or(&lower);
    let alias = |word: &str| ALIASES.iter().find(|(alias, _)| *alias == word).map(|(_, symbol)| *symbol);
    let symbol = |word: &str| {
        SYMBOLS.iter().map(|symbol| symbol.0).find(|symbol| symbol.to_lowercase() == word && symbol.len() > 1)
    };
    [lower.as_str(), singular]
        .into_iter()
        .find_map(|word| alias(word).or_else(|| symbol(word)))
        .map(str::to_owned)
}

impl Unit {
    /// Parses a unit, such as `N m s/rad`, `deg/sqrt(h)`, `kg m²` or `m/s^2`; a slash applies to the next factor only. Data sheets'
    /// `deg/√h`, `N-m`, `N.m` and `kgm2` are units too.
    pub fn parse(text: &str) -> Option<Self> {
        let apart = ["2", "\u{b2}", "^2"].into_iter().fold(text.trim().to_owned(), |text, power| {
            text.replace(&format!("kgm{power}"), &format!("kg m{power}"))
        });
        let mut rest = Rest(&apart);
        let unit = rest.product()?;
        rest.0.is_empty().then_some(unit)
    }

    /// Returns the ratio of this unit to another one, if they measure the same quantity. Cycles are converted to 2π rad
    /// where an angle is expected.
    pub fn per(self, other: Self) -> Option<f64> {
        if self.twice == other.twice {
            return Some(self.factor / other.factor);
        }
        let mut doubled = other.twice;
        doubled[4] -= 2;
        (self.cycles && self.twice == doubled).then(|| TAU * self.factor / other.factor)
    }

    fn times(self, other: Self) -> Self {
        let mut twice = self.twice;
        for (twice, more) in twice.iter_mut().zip(other.twice) {
            *twice = twice.saturating_add(more);
        }
        Self { factor: self.factor * other.factor, twice, cycles: self.cycles || other.cycles }
    }

    /// Returns the unit raised to the power `power`/2.
    fn to_half(self, power: i16) -> Option<Self> {
        let mut twice = self.twice;
        for exponent in &mut twice {
            let product = exponent.checked_mul(power)?;
            if product % 2 != 0 {
                return None;
            }
            *exponent = product / 2;
        }
        Some(Self { factor: libm::pow(self.factor, f64::from(power) / 2.0), twice, ..self })
    }

    fn symbol(word: &str) -> Option<Self> {
        if word == "1" {
            return Some(ONE);
        }
        let dimension = |(symbol, factor, exponents, _): &(&str, f64, [i16; 5], bool), prefix: f64| {
            let twice = exponents.map(|exponent| 2 * exponent);
            Self { factor: prefix * factor, twice, cycles: ["Hz", "cycles", "cycle"].contains(symbol) }
        };
        if let Some(known) = SYMBOLS.iter().find(|known| known.0 == word) {
            return Some(dimension(known, 1.0));
        }
        PREFIXES.iter().find_map(|(prefix, factor)| {
            let word = word.strip_prefix(prefix)?;
            // The base symbol is `g`, so that `kg` takes no further prefix.
            SYMBOLS.iter().find(|known| known.3 && known.0 == word).map(|known| dimension(known, *factor))
        })
    }
}

/// Remaining text of a unit.
struct Rest<'a>(&'a str);

impl<'a> Rest<'a> {
    fn product(&mut self) -> Option<Unit> {
        let mut product = self.power()?;
        loop {
            self.0 = self.0.trim_start();
            if let Some(rest) = self.0.strip_prefix('/') {
                self.0 = rest.trim_start();
                product = product.times(self.power()?.to_half(-2)?);
            } else if let Some(rest) = self.0.strip_prefix(['*', '\u{b7}']).or_else(|| self.joined()) {
                self.0 = rest.trim_start();
                product = product.times(self.power()?);
            } else if self.0.is_empty() || self.0.starts_with(')') {
                return Some(product);
            } else {
                product = product.times(self.power()?);
            }
        }
    }

    /// Returns the text behind a point or a hyphen between two units.
    fn joined(&self) -> Option<&'a str> {
        self.0.strip_prefix(['.', '-']).filter(|rest| rest.starts_with(char::is_alphabetic))
    }

    fn power(&mut self) -> Option<Unit> {
        if let Some(rest) = self.0.strip_prefix('\u{221a}') {
            self.0 = rest;
            return self.power()?.to_half(1);
        }
        if let Some(rest) = self.0.strip_prefix("sqrt(") {
            self.0 = rest;
            return self.closed()?.to_half(1);
        }
        let base = if let Some(rest) = self.0.strip_prefix('(') {
            self.0 = rest;
            self.closed()?
        } else {
            let end = self.0.find(|c: char| !(c.is_alphabetic() || c == '\u{b0}'));
            let end = if self.0.starts_with('1') { 1 } else { end.unwrap_or(self.0.len()) };
            let (word, rest) = self.0.split_at(end);
            self.0 = rest;
            Unit::symbol(word)?
        };
        for (sign, power) in [('\u{b2}', 4), ('\u{b3}', 6)] {
            if let Some(rest) = self.0.strip_prefix(sign) {
                self.0 = rest;
                return base.to_half(power);
            }
        }
        let digit = self.0.starts_with(|c: char| ('2'..='4').contains(&c)).then_some(self.0);
        let Some(rest) = self.0.strip_prefix('^').or(digit) else { return Some(base) };
        let end = rest.find(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-')).unwrap_or(rest.len());
        let (power, rest) = rest.split_at(end);
        self.0 = rest;
        let twice = 2.0 * power.parse::<f64>().ok()?;
        (twice == libm::trunc(twice) && twice.abs() <= 12.0).then(|| base.to_half(twice as i16))?
    }

    /// Parses a product up to the closing parenthesis.
    fn closed(&mut self) -> Option<Unit> {
        let inner = self.product()?;
        self.0 = self.0.strip_prefix(')')?;
        Some(inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn converted(from: &str, to: &str) -> Option<f64> {
        Unit::parse(from)?.per(Unit::parse(to).expect("a unit"))
    }

    #[test]
    fn units_that_others_write_are_recognised() {
        for (written, accepted) in [
            ("degrees", "deg"),
            ("hz", "Hz"),
            ("RPM", "rpm"),
            ("rev/min", "rpm"),
            ("deg/rt-hr", "deg/sqrt(hr)"),
            ("deg/rthr", "deg/sqrt(hr)"),
            ("deg/\u{221a}h", "deg/sqrt(h)"),
            ("rad/s/rtHz", "rad/s/sqrt(Hz)"),
            ("kg m2", "kg m^2"),
            ("seconds", "s"),
            ("Newton meters", "N m"),
            ("\"", "arcsec"),
            ("''", "arcsec"),
            ("'", "arcmin"),
        ] {
            assert_eq!(meant(written).as_deref(), Some(accepted), "{written}");
        }
        for none in ["fortnights", "", "deg", "foo/s"] {
            assert_eq!(meant(none), None, "{none}");
        }
    }

    #[test]
    fn units_are_what_they_are_in_si() {
        let close =
            |a: Option<f64>, b: f64| assert!(a.is_some_and(|a| (a / b - 1.0).abs() < 1e-15), "{a:?} {b}");
        close(converted("deg", "rad"), 0.017_453_292_519_943_295);
        close(converted("arcsec", "rad"), 4.848_136_811_095_36e-6);
        close(converted("deg/h", "rad/s"), 4.848_136_811_095_36e-6);
        close(converted("rpm", "rad/s"), 0.104_719_755_119_659_77);
        close(converted("Hz", "rad/s"), TAU);
        close(converted("mHz", "1/s"), 1e-3);
        close(converted("cycles/s", "rad/s"), TAU);
        close(converted("cycles/arcsec", "cycles/rad"), 206_264.806_247_096_36);
        close(converted("deg/sqrt(h)", "rad/sqrt(s)"), 2.908_882_086_657_216e-4);
        close(converted("mN m", "N m"), 1e-3);
        close(converted("mNm", "N m"), 1e-3);
        close(converted("kg cm^2", "kg m\u{b2}"), 1e-4);
        close(converted("g cm\u{b2}", "kg m\u{b2}"), 1e-7);
        close(converted("min", "s"), 60.0);
        close(converted("ms", "s"), 1e-3);
        close(converted("\u{b5}T", "T"), 1e-6);
        close(converted("N m s/rad", "N m s/rad"), 1.0);
        close(converted("m sqrt(kg)/s^1.5", "sqrt(kg) m/s^1.5"), 1.0);
        close(converted("(N m)\u{b2} s", "(Nm)^2 s"), 1.0);
        close(converted("km^3/s^2", "m\u{b3}/s\u{b2}"), 1e9);
        for (sheet, plain) in [
            ("deg/\u{221a}h", "deg/sqrt(h)"),
            ("\u{b0}/\u{221a}(h)", "deg/sqrt(h)"),
            ("(deg/h)/\u{221a}Hz", "deg/h/sqrt(Hz)"),
            ("N-m", "N m"),
            ("N.m", "N m"),
            ("mN-m-s", "mN m s"),
            ("kgm2", "kg m^2"),
            ("kgm\u{b2}", "kg m^2"),
            ("kg.m\u{b2}", "kg m^2"),
            ("kg-m2", "kg m^2"),
            ("deg/hr", "deg/h"),
            ("rad/sec", "rad/s"),
            ("m/s2", "m/s^2"),
            ("day", "d"),
        ] {
            close(converted(sheet, plain), 1.0);
        }
    }

    #[test]
    fn what_measures_something_else_is_no_such_unit() {
        assert_eq!(converted("kg", "rad"), None);
        assert_eq!(converted("Hz", "s"), None);
        assert_eq!(converted("deg", "rad/s"), None);
        assert_eq!(converted("rad/s", "1/s"), None);
        for none in [
            "", "foo", "deg/", "mdeg", "kmin", "m^", "sqrt(m", "(m", "m)", "m^0.3", "kkg", "1.5", "N-",
            "N.2", "\u{221a}", "m5",
        ] {
            assert_eq!(Unit::parse(none), None, "{none}");
        }
    }
}
