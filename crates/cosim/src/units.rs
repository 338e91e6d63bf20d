//! Units of variables as exponents of the SI base units.

/// Exponents of the SI base units and of the radian.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct BaseExponents {
    /// Exponents of kg, m, s, A, K and rad.
    pub of_base: [i32; 6],
}

/// Names of the base units, in the order of the exponents.
pub const BASES: [&str; 6] = ["kg", "m", "s", "A", "K", "rad"];

/// Derived units with their exponents.
const DERIVED: [(&str, [i32; 6]); 8] = [
    ("N", [1, 1, -2, 0, 0, 0]),
    ("J", [1, 2, -2, 0, 0, 0]),
    ("W", [1, 2, -3, 0, 0, 0]),
    ("Pa", [1, -1, -2, 0, 0, 0]),
    ("T", [1, 0, -2, -1, 0, 0]),
    ("V", [1, 2, -3, -1, 0, 0]),
    ("Hz", [0, 0, -1, 0, 0, 0]),
    ("1", [0; 6]),
];

impl BaseExponents {
    /// Returns the exponents of a unit such as `N m s` or `m/s²`; `None` for one with a root or of another system.
    pub fn from_unit(unit: &str) -> Option<Self> {
        let mut exponents = Self::default();
        let mut sign = 1;
        for (index, part) in unit.split('/').enumerate() {
            if index > 0 {
                sign = -1;
            }
            for word in part.split_whitespace() {
                exponents.add(word, sign)?;
            }
        }
        Some(exponents)
    }

    /// Adds a unit with its power, such as `s²`.
    fn add(&mut self, word: &str, sign: i32) -> Option<()> {
        let (name, power) = match word.char_indices().last()? {
            (at, '²') => (&word[..at], 2),
            (at, '³') => (&word[..at], 3),
            _ => (word, 1),
        };
        if let Some(base) = BASES.iter().position(|base| *base == name) {
            self.of_base[base] += sign * power;
            return Some(());
        }
        let (_, derived) = DERIVED.iter().find(|(own, _)| *own == name)?;
        for (own, of_derived) in self.of_base.iter_mut().zip(derived) {
            *own += sign * power * of_derived;
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_products_of_base_units() {
        let of = |unit| BaseExponents::from_unit(unit).map(|found| found.of_base);
        assert_eq!(of("rad/s²"), Some([0, 0, -2, 0, 0, 1]));
        assert_eq!(of("N m s"), Some([1, 2, -1, 0, 0, 0]));
        assert_eq!(of("kg m²"), Some([1, 2, 0, 0, 0, 0]));
        assert_eq!(of("1/s"), Some([0, 0, -1, 0, 0, 0]));
        assert_eq!(of("A m²"), Some([0, 2, 0, 1, 0, 0]));
        assert_eq!(of("kg/m³"), Some([1, -3, 0, 0, 0, 0]));
        assert_eq!((of("m sqrt(kg)"), of("furlong")), (None, None));
    }
}
