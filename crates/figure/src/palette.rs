//! Perceptually uniform colours for maps.

use plotters::style::RGBColor;

/// Colour map Viridis (Smith and van der Walt, matplotlib), in tenths.
const VIRIDIS: [RGBColor; 11] = [
    RGBColor(68, 1, 84),
    RGBColor(72, 36, 117),
    RGBColor(65, 68, 135),
    RGBColor(53, 95, 141),
    RGBColor(42, 120, 142),
    RGBColor(33, 145, 140),
    RGBColor(34, 168, 132),
    RGBColor(68, 191, 112),
    RGBColor(122, 209, 81),
    RGBColor(189, 223, 38),
    RGBColor(253, 231, 37),
];

/// Returns `count` colours from the darkest to the lightest.
pub fn viridis(count: usize) -> Vec<RGBColor> {
    let part = |index: usize| if count > 1 { index as f64 / (count - 1) as f64 } else { 0.5 };
    (0..count).map(|index| between(&VIRIDIS, 10.0 * part(index))).collect()
}

/// Interpolates between colours: place 1.5 is halfway between the second and the third.
pub fn between(colours: &[RGBColor], place: f64) -> RGBColor {
    let place = place.clamp(0.0, (colours.len() - 1) as f64);
    let below = (place as usize).min(colours.len().saturating_sub(2));
    let (RGBColor(r, g, b), RGBColor(s, h, c)) =
        (colours[below], colours[(below + 1).min(colours.len() - 1)]);
    let part = place - below as f64;
    let mix = |a: u8, b: u8| (f64::from(a) + part * (f64::from(b) - f64::from(a))).round() as u8;
    RGBColor(mix(r, s), mix(g, h), mix(b, c))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lightness_grows_evenly() {
        // Lightness CIE L* of sRGB.
        let lightness = |RGBColor(r, g, b): RGBColor| {
            let linear = |c: u8| {
                let c = f64::from(c) / 255.0;
                if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
            };
            116.0 * (0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b)).cbrt() - 16.0
        };
        let colours = viridis(64);
        let steps: Vec<f64> =
            colours.windows(2).map(|pair| lightness(pair[1]) - lightness(pair[0])).collect();
        let mean = steps.iter().sum::<f64>() / 63.0;
        assert!(mean > 1.0 && steps.iter().all(|step| (0.3 * mean..2.0 * mean).contains(step)), "{steps:?}");
        assert_eq!(between(&[RGBColor(0, 0, 0), RGBColor(100, 50, 0)], 0.5), RGBColor(50, 25, 0));
    }
}
