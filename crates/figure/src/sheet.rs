//! Sheet of several figures in columns: each figure is placed below the shortest column.

/// Approximate ratio of width to height of the sheet.
const ASPECT: f64 = 4.0 / 3.0;

/// Combines several SVGs into one.
pub fn sheet(figures: &[String]) -> String {
    if let [only] = figures {
        return only.clone();
    }
    let sizes: Vec<[u32; 2]> =
        figures.iter().map(|svg| ["width", "height"].map(|name| size(svg, name))).collect();
    let off = |columns: &usize| {
        let (_, [width, height]) = places(&sizes, *columns);
        (f64::from(width) / f64::from(height.max(1)) / ASPECT).ln().abs()
    };
    let columns = (1..=figures.len()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(1);
    let (places, [width, height]) = places(&sizes, columns);
    let mut sheet = format!(
        "<svg width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         xmlns=\"http://www.w3.org/2000/svg\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#FFFFFF\"/>\n"
    );
    for (svg, [x, y]) in figures.iter().zip(places) {
        sheet.push_str(&svg.replacen("<svg ", &format!("<svg x=\"{x}\" y=\"{y}\" "), 1));
    }
    sheet.push_str("</svg>\n");
    sheet
}

/// Returns the position of each figure (px), and the size of the sheet (px).
fn places(sizes: &[[u32; 2]], columns: usize) -> (Vec<[u32; 2]>, [u32; 2]) {
    let width = sizes.iter().map(|size| size[0]).max().unwrap_or(0);
    let mut heights = vec![0; columns];
    let mut places = Vec::new();
    for [_, height] in sizes {
        let shortest = (0..columns).min_by_key(|column| heights[*column]).unwrap_or(0);
        places.push([shortest as u32 * width, heights[shortest]]);
        heights[shortest] += height;
    }
    (places, [columns as u32 * width, heights.into_iter().max().unwrap_or(0)])
}

/// Returns a size attribute of an SVG written by this crate, in pixels.
fn size(svg: &str, name: &str) -> u32 {
    let rest = svg.split_once(&format!("{name}=\"")).map_or("", |(_, rest)| rest);
    rest.split('"').next().and_then(|number| number.parse().ok()).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(height: u32) -> String {
        format!("<svg width=\"800\" height=\"{height}\" viewBox=\"0 0 8000 {height}0\"></svg>\n")
    }

    #[test]
    fn figures_lie_beside_and_below_one_another() {
        let all: Vec<String> = [500, 300, 300, 200].map(figure).into();
        let sheet = sheet(&all);
        // Two columns: 500 + 200 and 300 + 300 high.
        assert!(sheet.starts_with("<svg width=\"1600\" height=\"700\""), "{sheet}");
        for place in [(0, 0), (800, 0), (800, 300), (0, 500)] {
            assert!(
                sheet.contains(&format!("<svg x=\"{}\" y=\"{}\" width=\"800\"", place.0, place.1)),
                "{sheet}"
            );
        }
        assert_eq!(super::sheet(&all[..1]), all[0]);
    }
}
