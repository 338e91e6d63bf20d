//! Consistency: where normalised errors squared of a filter lie whose covariance fits them (\[BarShalom01\]).

/// Returns the bounds between which chi-square with `degrees` degrees of freedom lies with a probability of 95 %.
/// Wilson and Hilferty: the cube root of chi-square over its degrees of freedom is about normal.
pub fn chi_square(degrees: usize) -> [f64; 2] {
    /// Where a normal variable lies with a probability of 95 %, in standard deviations.
    const INSIDE: f64 = 1.959_963_984_540_054;
    let degrees = degrees as f64;
    let spread = 2.0 / (9.0 * degrees);
    [-INSIDE, INSIDE].map(|deviations| {
        let root = 1.0 - spread + deviations * spread.sqrt();
        degrees * root * root * root
    })
}

#[cfg(test)]
mod tests {
    #[test]
    fn bands_are_those_of_chi_square() {
        // scipy.stats.chi2.ppf([0.025, 0.975], n).
        let exact = [
            (12, [4.403_788_506_981_701_5, 23.336_664_158_645_34]),
            (50, [32.357_363_695_658_655, 71.420_195_187_506_42]),
            (100, [74.221_927_474_923_73, 129.561_197_185_836_6]),
        ];
        for (degrees, exact) in exact {
            for (bound, exact) in super::chi_square(degrees).into_iter().zip(exact) {
                assert!((bound / exact - 1.0).abs() < 5e-3, "{degrees}: {bound}");
            }
        }
    }
}
