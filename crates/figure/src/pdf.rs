//! Figures as PDF: the lines and areas of an SVG, and its text with the used subset of the font.

use std::fmt::Write as _;

use resvg::tiny_skia::{PathSegment, Point, Transform};
use resvg::usvg::fontdb::ID;
use resvg::usvg::{Fill, FillRule, Group, LineCap, LineJoin, Node, Paint, Path, Stroke, Text, Tree};
use subsetter::{GlyphRemapper, subset};

use crate::origin;

/// Points (pt) per pixel.
const POINTS: f32 = 0.75;

/// Converts an SVG to PDF.
pub fn written(tree: &Tree) -> Result<Vec<u8>, String> {
    let mut page = Page::default();
    page.group(tree.root(), 1.0, tree)?;
    let (width, height) = (tree.size().width() * POINTS, tree.size().height() * POINTS);
    let content = format!("{POINTS} 0 0 -{POINTS} 0 {height} cm\n{}", page.content);
    let mut file = File::default();
    let [catalogue, pages, leaf, stream] = [1, 2, 3, 4];
    let mut resources = String::new();
    for (index, opacity) in page.opacities.iter().enumerate() {
        let _ = write!(resources, "/G{index} << /ca {opacity} /CA {opacity} >> ");
    }
    // Each font takes five objects after those of the page.
    let mut fonts = String::new();
    for index in 0..page.fonts.len() {
        let _ = write!(fonts, "/F{index} {} 0 R ", stream + 1 + 5 * index);
    }
    file.object(&format!("<< /Type /Catalog /Pages {pages} 0 R >>"));
    file.object(&format!("<< /Type /Pages /Kids [{leaf} 0 R] /Count 1 >>"));
    file.object(&format!(
        "<< /Type /Page /Parent {pages} 0 R /MediaBox [0 0 {width} {height}] /Contents {stream} 0 R \
         /Resources << /ExtGState << {resources}>> /Font << {fonts}>> >> >>"
    ));
    file.stream("", content.as_bytes());
    for font in &page.fonts {
        font.write(&mut file)?;
    }
    Ok(file.finish(catalogue))
}

/// Content of the page.
#[derive(Default)]
struct Page {
    content: String,
    /// Opacities in use.
    opacities: Vec<f32>,
    fonts: Vec<Font>,
}

impl Page {
    fn group(&mut self, group: &Group, opacity: f32, tree: &Tree) -> Result<(), String> {
        let opacity = opacity * group.opacity().get();
        for node in group.children() {
            match node {
                Node::Group(group) => self.group(group, opacity, tree)?,
                Node::Path(path) if path.is_visible() => self.path(path, opacity),
                Node::Text(text) => self.text(text, opacity, tree)?,
                Node::Path(_) | Node::Image(_) => {}
            }
        }
        Ok(())
    }

    fn path(&mut self, path: &Path, opacity: f32) {
        let transform = path.abs_transform();
        if let Some(fill) = path.fill() {
            self.fill(fill, opacity);
            self.segments(path, transform);
            self.content.push_str(if fill.rule() == FillRule::EvenOdd { "f*\n" } else { "f\n" });
        }
        if let Some(stroke) = path.stroke() {
            self.stroke(stroke, transform, opacity);
            self.segments(path, transform);
            self.content.push_str("S\n");
        }
    }

    fn fill(&mut self, fill: &Fill, opacity: f32) {
        self.opacity(opacity * fill.opacity().get());
        let [r, g, b] = colour(fill.paint());
        let _ = writeln!(self.content, "{r} {g} {b} rg");
    }

    fn stroke(&mut self, stroke: &Stroke, transform: Transform, opacity: f32) {
        self.opacity(opacity * stroke.opacity().get());
        let [r, g, b] = colour(stroke.paint());
        let scale = (transform.sx * transform.sy - transform.kx * transform.ky).abs().sqrt();
        let cap = match stroke.linecap() {
            LineCap::Butt => 0,
            LineCap::Round => 1,
            LineCap::Square => 2,
        };
        let join = match stroke.linejoin() {
            LineJoin::Miter | LineJoin::MiterClip => 0,
            LineJoin::Round => 1,
            LineJoin::Bevel => 2,
        };
        let width = short(stroke.width().get() * scale);
        let dashes = stroke.dasharray().unwrap_or_default().iter();
        let dashes: Vec<String> = dashes.map(|dash| short(dash * scale)).collect();
        let dashes = dashes.join(" ");
        let _ = writeln!(self.content, "{r} {g} {b} RG {width} w {cap} J {join} j [{dashes}] 0 d");
    }

    fn opacity(&mut self, opacity: f32) {
        let known = self.opacities.iter().position(|known| *known == opacity);
        let index = known.unwrap_or_else(|| {
            self.opacities.push(opacity);
            self.opacities.len() - 1
        });
        let _ = writeln!(self.content, "/G{index} gs");
    }

    fn segments(&mut self, path: &Path, transform: Transform) {
        let place = |mut point: Point| {
            transform.map_point(&mut point);
            point
        };
        let text = |points: &[Point]| -> String {
            let mut text = String::new();
            for point in points {
                let _ = write!(text, "{} {} ", short(point.x), short(point.y));
            }
            text
        };
        let mut last = Point::zero();
        for segment in path.data().segments() {
            let line = match segment {
                PathSegment::MoveTo(to) => {
                    last = place(to);
                    text(&[last]) + "m"
                }
                PathSegment::LineTo(to) => {
                    last = place(to);
                    text(&[last]) + "l"
                }
                PathSegment::QuadTo(bend, to) => {
                    let (from, bend) = (last, place(bend));
                    last = place(to);
                    // Quadratic curve as a cubic one.
                    let part = |a: Point| {
                        Point::from_xy(a.x + (bend.x - a.x) * 2.0 / 3.0, a.y + (bend.y - a.y) * 2.0 / 3.0)
                    };
                    text(&[part(from), part(last), last]) + "c"
                }
                PathSegment::CubicTo(first, second, to) => {
                    last = place(to);
                    text(&[place(first), place(second), last]) + "c"
                }
                PathSegment::Close => "h".to_owned(),
            };
            let _ = writeln!(self.content, "{line}");
        }
    }

    fn text(&mut self, text: &Text, opacity: f32, tree: &Tree) -> Result<(), String> {
        for span in text.layouted().iter().filter(|span| span.visible) {
            let Some(fill) = &span.fill else { continue };
            self.fill(fill, opacity);
            for glyph in &span.positioned_glyphs {
                let known = self.fonts.iter().position(|font| font.id == glyph.font);
                let index = if let Some(index) = known {
                    index
                } else {
                    let data = tree.fontdb().with_face_data(glyph.font, |data, _| data.to_vec());
                    self.fonts.push(Font::new(glyph.font, data.ok_or("a font is missing")?)?);
                    self.fonts.len() - 1
                };
                let font = &mut self.fonts[index];
                let Ok(glyph_id) = u16::try_from(glyph.id.0) else { continue };
                let name = font.take(glyph_id, &glyph.text);
                // Scales letters to the unit of the font's matrix.
                let Transform { sx, ky, kx, sy, tx, ty } = text
                    .abs_transform()
                    .pre_concat(glyph.outline_transform())
                    .pre_scale(font.units_per_em, font.units_per_em);
                let [sx, ky, kx, sy, tx, ty] = [sx, ky, kx, sy, tx, ty].map(short);
                let _ = writeln!(
                    self.content,
                    "BT /F{index} 1 Tf {sx} {ky} {kx} {sy} {tx} {ty} Tm <{name:04x}> Tj ET"
                );
            }
        }
        Ok(())
    }
}

/// Returns red, green and blue from 0 to 1.
fn colour(paint: &Paint) -> [String; 3] {
    match paint {
        Paint::Color(colour) => [colour.red, colour.green, colour.blue].map(|c| short(f32::from(c) / 255.0)),
        _ => ["0", "0", "0"].map(str::to_owned),
    }
}

/// Formats a number with at most three decimals.
fn short(number: f32) -> String {
    let text = format!("{number:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Font, with the glyphs in use.
struct Font {
    id: ID,
    data: Vec<u8>,
    units_per_em: f32,
    glyphs: GlyphRemapper,
    /// Text of each glyph by its new number, starting at 1.
    texts: Vec<String>,
}

impl Font {
    fn new(id: ID, data: Vec<u8>) -> Result<Self, String> {
        let head = table(&data, *b"head").ok_or("a font has no head")?;
        let units_per_em = f32::from(number(&data, head + 18).ok_or("a font has no units")?);
        Ok(Self { id, data, units_per_em, glyphs: GlyphRemapper::new(), texts: Vec::new() })
    }

    /// Returns the number of a glyph in the subset of the font, which is extended if necessary.
    fn take(&mut self, glyph: u16, text: &str) -> u16 {
        let name = self.glyphs.remap(glyph);
        if usize::from(name) > self.texts.len() {
            self.texts.push(text.to_owned());
        }
        name
    }

    /// Returns the width of a glyph in thousandths of an em.
    fn width(&self, glyph: u16) -> Option<f32> {
        let hhea = table(&self.data, *b"hhea")?;
        let last = number(&self.data, hhea + 34)?.checked_sub(1)?;
        let row = table(&self.data, *b"hmtx")? + 4 * usize::from(glyph.min(last));
        Some(f32::from(number(&self.data, row)?) * 1000.0 / self.units_per_em)
    }

    /// Writes five objects: the font, its glyphs, their descriptor, their outlines and their text.
    fn write(&self, file: &mut File) -> Result<(), String> {
        let part = subset(&self.data, 0, &self.glyphs).map_err(|error| error.to_string())?;
        // Each subset of a font has its own name.
        let hash = part.iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
        });
        let letter = |place: u32| char::from(b'A' + (hash >> (8 * place)) as u8 % 26);
        let name: String = (0..6).map(letter).chain("+DejaVuSans".chars()).collect();
        let first = file.next();
        let [glyphs, kind, outlines, texts] = [1, 2, 3, 4].map(|offset| first + offset);
        file.object(&format!(
            "<< /Type /Font /Subtype /Type0 /BaseFont /{name} /Encoding /Identity-H \
             /DescendantFonts [{glyphs} 0 R] /ToUnicode {texts} 0 R >>"
        ));
        let widths: Vec<String> =
            self.glyphs.remapped_gids().map(|glyph| short(self.width(glyph).unwrap_or(0.0))).collect();
        file.object(&format!(
            "<< /Type /Font /Subtype /CIDFontType2 /BaseFont /{name} /CIDToGIDMap /Identity \
             /CIDSystemInfo << /Registry (Adobe) /Ordering (Identity) /Supplement 0 >> \
             /FontDescriptor {kind} 0 R /W [0 [{}]] >>",
            widths.join(" ")
        ));
        // Heights of DejaVu Sans in thousandths of an em; the flag marks a symbolic font.
        file.object(&format!(
            "<< /Type /FontDescriptor /FontName /{name} /Flags 4 /FontBBox [-1021 -463 1793 1232] /ItalicAngle 0 \
             /Ascent 928 /Descent -236 /CapHeight 729 /StemV 80 /FontFile2 {outlines} 0 R >>"
        ));
        file.stream(&format!("/Length1 {} ", part.len()), &part);
        file.stream("", self.texts().as_bytes());
        Ok(())
    }

    /// Returns the map from glyphs to text, for searching and copying.
    fn texts(&self) -> String {
        let mut map = "/CIDInit /ProcSet findresource begin 12 dict begin begincmap\n\
            /CIDSystemInfo << /Registry (Adobe) /Ordering (UCS) /Supplement 0 >> def\n\
            /CMapName /Adobe-Identity-UCS def /CMapType 2 def\n\
            1 begincodespacerange <0000> <ffff> endcodespacerange\n"
            .to_owned();
        // Limited to one hundred entries per block.
        for (chunk, texts) in self.texts.chunks(100).enumerate() {
            let _ = writeln!(map, "{} beginbfchar", texts.len());
            for (index, text) in texts.iter().enumerate() {
                let _ = write!(map, "<{:04x}> <", 100 * chunk + index + 1);
                for unit in text.encode_utf16() {
                    let _ = write!(map, "{unit:04x}");
                }
                map.push_str(">\n");
            }
            map.push_str("endbfchar\n");
        }
        map + "endcmap CMapName currentdict /CMap defineresource pop end end\n"
    }
}

/// Returns the offset of a table of a TrueType font.
fn table(font: &[u8], tag: [u8; 4]) -> Option<usize> {
    let count = usize::from(number(font, 4)?);
    let rows = font.get(12..12 + 16 * count)?.chunks(16);
    let row = rows.into_iter().find(|row| row.starts_with(&tag))?;
    Some(u32::from_be_bytes(row[8..12].try_into().ok()?) as usize)
}

/// Returns a 16-bit integer of a TrueType font.
fn number(font: &[u8], offset: usize) -> Option<u16> {
    Some(u16::from_be_bytes(font.get(offset..offset + 2)?.try_into().ok()?))
}

/// Writer of a file's objects in sequence.
struct File {
    bytes: Vec<u8>,
    places: Vec<usize>,
}

impl Default for File {
    fn default() -> Self {
        // The second line marks the file as binary.
        Self { bytes: [&b"%PDF-1.5\n%\xe2\xe3\xcf\xd3\n"[..], origin::PDF].concat(), places: Vec::new() }
    }
}

impl File {
    /// Returns the number of the next object.
    fn next(&self) -> usize {
        self.places.len() + 1
    }

    fn begin(&mut self) {
        let number = self.next();
        self.places.push(self.bytes.len());
        self.bytes.extend(format!("{number} 0 obj\n").into_bytes());
    }

    fn object(&mut self, text: &str) {
        self.begin();
        self.bytes.extend(format!("{text}\nendobj\n").into_bytes());
    }

    fn stream(&mut self, keys: &str, bytes: &[u8]) {
        self.begin();
        self.bytes.extend(format!("<< {keys}/Length {} >>\nstream\n", bytes.len()).into_bytes());
        self.bytes.extend(bytes);
        self.bytes.extend(b"\nendstream\nendobj\n");
    }

    fn finish(mut self, catalogue: usize) -> Vec<u8> {
        let (start, count) = (self.bytes.len(), self.next());
        let mut end = format!("xref\n0 {count}\n0000000000 65535 f \n");
        for place in &self.places {
            // Each line must have twenty bytes.
            let _ = write!(end, "{place:010} 00000 n");
            end.push_str(" \n");
        }
        let _ =
            write!(end, "trailer\n<< /Size {count} /Root {catalogue} 0 R >>\nstartxref\n{start}\n%%EOF\n");
        self.bytes.extend(end.into_bytes());
        self.bytes
    }
}
