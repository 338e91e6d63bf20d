//! Pieces of a page: texts, tables, figures and commands.

use std::fmt::Write;

use flexsc_core::requirement_verdict::Decision;

/// Returns a text for HTML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Table of a page.
#[derive(Default)]
pub struct HtmlTable {
    /// Heads of the columns.
    pub heads: Vec<HtmlHead>,
    /// Rows.
    pub rows: Vec<HtmlRow>,
    /// True if each row becomes a card on a narrow screen.
    pub is_cards: bool,
}

/// Head of a column.
pub struct HtmlHead {
    text: String,
    is_number: bool,
}

/// Row of a table.
#[derive(Default)]
pub struct HtmlRow {
    /// Cells, the first of which is the head of the row.
    pub cells: Vec<HtmlCell>,
    /// True if something in the row is missed.
    pub is_missed: bool,
}

/// Cell of a table.
#[derive(Clone, Default)]
pub struct HtmlCell {
    html: String,
    class: &'static str,
}

/// Returns the head of a column of texts.
pub fn head(text: &str) -> HtmlHead {
    HtmlHead { text: text.to_owned(), is_number: false }
}

/// Returns the head of a column of numbers.
pub fn number_head(text: impl Into<String>) -> HtmlHead {
    HtmlHead { text: text.into(), is_number: true }
}

/// Returns a cell with a text.
pub fn cell(text: &str) -> HtmlCell {
    HtmlCell { html: escaped(text), class: "" }
}

impl HtmlCell {
    /// Returns the cell of a verdict.
    pub fn verdict(decision: Decision) -> Self {
        let class = match decision {
            Decision::Met => "met",
            Decision::NotExercised => "",
            Decision::Missed | Decision::Undecided => "missed",
        };
        Self { html: format!("<span class=\"v {class}\">{}</span>", decision.word()), class: "" }
    }

    /// Returns the cell with a second line in small letters.
    #[must_use]
    pub fn small(mut self, text: &str) -> Self {
        if !text.is_empty() {
            let _ = write!(self.html, "<small>{}</small>", escaped(text));
        }
        self
    }

    /// Returns the cell as one that fails.
    #[must_use]
    pub fn hot(self, is_hot: bool) -> Self {
        Self { class: if is_hot { "hot" } else { self.class }, ..self }
    }
}

impl HtmlTable {
    /// Returns the table as HTML.
    pub fn html(&self) -> String {
        let class = if self.is_cards { " class=\"cards\"" } else { "" };
        let mut html = format!("<div class=\"scroll\"><table{class}>");
        if self.heads.iter().any(|head| !head.text.is_empty()) {
            html.push_str("<thead><tr>");
            for head in &self.heads {
                let class = if head.is_number { " class=\"n\"" } else { "" };
                let _ = write!(html, "<th{class}>{}</th>", escaped(&head.text));
            }
            html.push_str("</tr></thead>");
        }
        html.push_str("<tbody>\n");
        for row in &self.rows {
            html.push_str(if row.is_missed { "<tr class=\"bad\">" } else { "<tr>" });
            for (place, cell) in row.cells.iter().enumerate() {
                self.add_cell(&mut html, place, cell);
            }
            html.push_str("</tr>\n");
        }
        html.push_str("</tbody></table></div>\n");
        html
    }

    fn add_cell(&self, html: &mut String, place: usize, cell: &HtmlCell) {
        let head = self.heads.get(place);
        let is_number = head.is_some_and(|head| head.is_number);
        let classes = [if is_number { "n" } else { "" }, cell.class];
        let classes = classes.iter().filter(|class| !class.is_empty()).copied().collect::<Vec<_>>().join(" ");
        let class = if classes.is_empty() { String::new() } else { format!(" class=\"{classes}\"") };
        let tag = if place == 0 { "th scope=\"row\"" } else { "td" };
        let label = match head {
            Some(head) if self.is_cards && place > 1 && !head.text.is_empty() => {
                format!(" data-l=\"{}\"", escaped(&head.text))
            }
            _ => String::new(),
        };
        let _ = write!(html, "<{tag}{class}{label}>{}</{}>", cell.html, &tag[..2]);
    }
}

/// Place of the number of a figure until the page is complete.
const NUMBER: &str = "\u{1}";
/// Start of a figure.
const FIGURE: &str = "<figure ";

/// Returns a figure with its caption, which opens to the whole window at a click. [`numbered`] gives it its number.
pub fn picture(svg: &str, caption: &str) -> String {
    // The figure begins with its element.
    let from = svg.find("<svg").unwrap_or(0);
    let inner = format!(
        "<input class=\"zoom\" type=\"checkbox\" id=\"zoom-{NUMBER}\" \
         aria-label=\"enlarge figure {NUMBER}\"><label class=\"z\" for=\"zoom-{NUMBER}\">{}</label>",
        svg[from..].trim_end()
    );
    figure("figscroll", &inner, caption)
}

/// Returns a figure of a class with its contents and its caption.
pub fn figure(class: &str, inner: &str, caption: &str) -> String {
    format!(
        "{FIGURE}class=\"{class}\">{inner}<figcaption><b>Figure {NUMBER}.</b> {}</figcaption></figure>\n",
        escaped(caption)
    )
}

/// Returns a page with the numbers of its figures, in their order.
pub fn numbered(page: &str) -> String {
    let mut pieces = page.split(FIGURE);
    let mut all = pieces.next().unwrap_or_default().to_owned();
    for (place, piece) in pieces.enumerate() {
        all.push_str(FIGURE);
        all.push_str(&piece.replace(NUMBER, &(place + 1).to_string()));
    }
    all
}

/// Returns the command that repeats a block.
pub fn command(words: &str) -> String {
    format!("<p class=\"cmd\"><code>{}</code></p>\n", escaped(words))
}

/// Returns a paragraph.
pub fn paragraph(text: &str) -> String {
    format!("<p>{}</p>\n", escaped(text))
}

/// Returns a list of sentences.
pub fn list(items: &[String]) -> String {
    let items: Vec<String> = items.iter().map(|item| format!("<li>{}</li>\n", escaped(item))).collect();
    format!("<ul>{}</ul>\n", items.concat())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_numbered_in_their_order() {
        let page = numbered(&format!("a{}b{}", picture("<svg/>", "one"), picture("<?xml?><svg/>", "two")));
        assert!(page.contains("Figure 1.</b> one") && page.contains("Figure 2.</b> two"), "{page}");
        assert!(page.contains("id=\"zoom-2\"") && !page.contains(NUMBER) && !page.contains("xml"), "{page}");
    }

    #[test]
    fn a_table_has_rows_with_heads_and_marks() {
        let table = HtmlTable {
            heads: vec![head("No."), head("Name"), number_head("Value")],
            rows: vec![HtmlRow {
                cells: vec![cell("R1"), cell("a < b"), cell("3").hot(true)],
                is_missed: true,
            }],
            is_cards: true,
        };
        let html = table.html();
        let row = "<tr class=\"bad\"><th scope=\"row\">R1</th><td>a &lt; b</td><td class=\"n hot\" data-l=\"Value\">3</td></tr>";
        assert!(html.contains(row), "{html}");
    }
}
