//! Several figures on one sheet: in columns of one height, in their order from top to bottom and from left to right.

use crate::layout::rows;
use crate::{Figure, Style, draw};

/// Approximate ratio of width to height of the sheet.
const ASPECT: f64 = 4.0 / 3.0;

/// One SVG that holds several figures. Plots of lower columns are higher, so that no part of the sheet is left blank.
///
/// # Errors
/// A figure that cannot be drawn.
pub fn sheet<'a>(figures: impl IntoIterator<Item = &'a Figure>, style: &Style) -> Result<String, String> {
    let figures: Vec<&Figure> = figures.into_iter().collect();
    let across = style.layout_width();
    if let [only] = figures[..] {
        return only.laid_out(style);
    }
    let heights: Vec<u32> =
        figures.iter().map(|figure| draw::height(figure, across, style.is_titled())).collect();
    let (width, height, columns) = columns(&heights, across, style.columns());
    let mut sheet = format!(
        "<svg width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
         xmlns=\"http://www.w3.org/2000/svg\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"#FFFFFF\"/>\n"
    );
    let mut rest = figures.into_iter().zip(heights);
    for (column, count) in columns.into_iter().enumerate() {
        let own: Vec<(&Figure, u32)> = rest.by_ref().take(count).collect();
        let missing = height - own.iter().map(|(_, height)| height).sum::<u32>();
        let plots = own.iter().map(|(figure, _)| rows(figure).count() as u32).sum::<u32>().max(1);
        let (x, higher, mut y) = (column as u32 * across, missing / plots, 0);
        for (figure, height) in own {
            let svg =
                draw::svg(figure, across, higher, style.is_titled()).map_err(|error| error.to_string())?;
            sheet.push_str(&svg.replacen("<svg ", &format!("<svg x=\"{x}\" y=\"{y}\" "), 1));
            y += height + higher * rows(figure).count() as u32;
        }
    }
    sheet.push_str("</svg>\n");
    Ok(sheet)
}

/// The width and height of a sheet with at most `most` columns of figures of these heights, and how many of them each of its columns has: its
/// shape is near to that wanted, and its columns are near to one height.
fn columns(heights: &[u32], across: u32, most: usize) -> (u32, u32, Vec<usize>) {
    let sheets = (1..=heights.len().min(most)).map(|count| {
        let columns = parted(heights, count);
        let mut rest = heights.iter();
        let each = columns.iter().map(|count| rest.by_ref().take(*count).sum::<u32>());
        let each: Vec<u32> = each.collect();
        let (high, low) = (each.iter().copied().max().unwrap_or(0), each.iter().copied().min().unwrap_or(0));
        (columns.len() as u32 * across, high.max(1), low.max(1), columns)
    });
    let off = |(width, high, low, _): &(u32, u32, u32, Vec<usize>)| {
        let [width, high, low] = [width, high, low].map(|size| f64::from(*size));
        (width / high / ASPECT).ln().abs() + 1.5 * (high / low).ln()
    };
    let best = sheets.min_by(|a, b| off(a).total_cmp(&off(b)));
    best.map_or((across, 1, Vec::new()), |(width, high, _, columns)| (width, high, columns))
}

/// How many of the figures in a row each of `count` columns has, so that the columns are as near to one height as their order
/// allows: the sum of their squared heights is the least.
fn parted(heights: &[u32], count: usize) -> Vec<usize> {
    let mut below = vec![0.0];
    below.extend(heights.iter().scan(0.0, |sum, height| {
        *sum += f64::from(*height);
        Some(*sum)
    }));
    let ends = below.len();
    // The least sum of the first columns that hold the figures before an end, and where the last of these columns begins.
    let mut least = vec![vec![(f64::INFINITY, 0); ends]; count + 1];
    least[0][0].0 = 0.0;
    for columns in 1..=count {
        for end in columns..ends {
            let with =
                |start: usize| (least[columns - 1][start].0 + (below[end] - below[start]).powi(2), start);
            let best = (columns - 1..end).map(with).min_by(|a, b| a.0.total_cmp(&b.0));
            least[columns][end] = best.unwrap_or((f64::INFINITY, 0));
        }
    }
    let mut columns = vec![0; count];
    let mut end = heights.len();
    for column in (0..count).rev() {
        let start = least[column + 1][end].1;
        columns[column] = end - start;
        end = start;
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{FigureAxis, Panel};

    fn figure(panels: usize, panel_height: u32) -> Figure {
        let axis = || FigureAxis::exact("x", "", 0.0..1.0);
        let panel = |_| Panel::new(axis(), axis(), Vec::new());
        Figure { title: "figure".to_owned(), panels: (0..panels).map(panel).collect(), panel_height }
    }

    /// The numbers of an attribute in an SVG, in their order.
    fn numbers(svg: &str, name: &str) -> Vec<u32> {
        let parts = svg.split("<svg ").skip(1);
        let text = parts.filter_map(|part| part.split_once(&format!("{name}=\"")));
        text.filter_map(|(_, rest)| rest.split('"').next()?.parse().ok()).collect()
    }

    #[test]
    fn columns_are_in_order_and_fill_the_sheet() {
        let all = [figure(3, 160), figure(3, 160), figure(1, 220), figure(4, 200), figure(4, 160)];
        let sheet = sheet(&all, &Style::default()).expect("draws");
        let (widths, heights) = (numbers(&sheet, "width"), numbers(&sheet, "height"));
        // The first is the sheet, of two columns.
        assert_eq!(widths[0], 1600);
        let (x, y) = (numbers(&sheet, "x"), numbers(&sheet, "y"));
        assert_eq!((x.len(), y.len()), (5, 5), "{sheet}");
        assert!(x.is_sorted() && x[0] == 0 && x[4] == 800);
        let covered: u32 = heights[1..].iter().map(|height| height * 800).sum();
        let blank = 1.0 - f64::from(covered) / f64::from(widths[0] * heights[0]);
        assert!((0.0..0.01).contains(&blank), "{blank}");
        assert_eq!(super::sheet(&all[..1], &Style::default()), all[0].svg());
    }

    #[test]
    fn columns_are_as_even_as_their_order_allows() {
        assert_eq!(parted(&[500, 300, 300, 200], 2), [1, 3]);
        assert_eq!(parted(&[500, 300, 300, 200], 3), [1, 1, 2]);
        assert_eq!(parted(&[100, 100, 100, 400], 3), [1, 2, 1]);
        assert_eq!(parted(&[100], 1), [1]);
    }
}
