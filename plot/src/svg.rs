//! A plot as a file of its own, for documents.

use std::fmt::Write;

use crate::escaped;
use crate::plot::Plot;

/// Width of the drawing and where its frame stands in it: left, right, top, bottom.
const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 300.0;
const FRAME: [f64; 4] = [72.0, 628.0, 58.0, 250.0];

const STYLE: &str = "text{font:12px sans-serif;fill:#3d4a57}.title{font-weight:600;fill:#1d2733}.grid{stroke:#d5dce3;fill:none}.dots,.bars,.line{fill:none;stroke-linecap:round;stroke-linejoin:round}.dots{stroke-width:2.4}.dots.few{stroke-width:5}.bars{stroke-width:1.8}.line{stroke-width:1.4}.was{stroke:#d55e00}.is{stroke:#0072b2}.line.is{stroke-dasharray:5 3}.model{stroke:#111}.mark{stroke:#7a4f9c;stroke-dasharray:2 3;fill:none}";

impl Plot {
    /// The whole SVG file.
    #[must_use]
    pub fn svg(&self) -> String {
        let [left, right, top, bottom] = FRAME;
        let (width, height) = (right - left, bottom - top);
        let mut out = format!(
            r##"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}"><style>{STYLE}</style><rect width="100%" height="100%" fill="#fff"/><clipPath id="frame"><rect width="{width}" height="{height}"/></clipPath>
<text class="title" x="{left}" y="18">{}</text>
"##,
            escaped(&self.title)
        );
        let mut at = left;
        let names = self
            .series
            .iter()
            .map(|s| (s.name.as_str(), s.look.class(), s.look.is_line()));
        let marks = self.marks.iter().map(|m| (m.text.as_str(), "mark", true));
        for (name, class, line) in names.chain(marks) {
            let path = if line { "h18" } else { "m9 0h0" };
            let _ = writeln!(
                out,
                r#"<path class="{class}" d="M{at:.0} 32{path}"/><text x="{:.0}" y="36">{}</text>"#,
                at + 24.0,
                escaped(name)
            );
            at += 40.0 + 6.4 * name.chars().count() as f64;
        }
        for (place, text) in self.y.ticks() {
            let y = bottom - place * height;
            let _ = writeln!(
                out,
                r#"<path class="grid" d="M{left} {y:.1}H{right}"/><text x="{}" y="{:.1}" text-anchor="end">{text}</text>"#,
                left - 6.0,
                y + 4.0
            );
        }
        for (place, text) in self.x.ticks() {
            let x = left + place * width;
            let _ = writeln!(
                out,
                r#"<path class="grid" d="M{x:.1} {top}V{bottom}"/><text x="{x:.1}" y="{}" text-anchor="middle">{text}</text>"#,
                bottom + 18.0
            );
        }
        let _ = writeln!(
            out,
            r#"<text x="{left}" y="{}">{}</text><text x="{}" y="{}" text-anchor="middle">{}</text><g transform="translate({left} {top})" clip-path="url(#frame)">"#,
            top - 6.0,
            escaped(&self.y.label),
            left + width / 2.0,
            HEIGHT - 12.0,
            escaped(&self.x.label)
        );
        for mark in &self.marks {
            if let Some(place) = self.x.place(mark.x) {
                let _ = writeln!(
                    out,
                    r#"<path class="mark" d="M{:.1} 0V{height}"/>"#,
                    place * width
                );
            }
        }
        for series in &self.series {
            let path = self.path(series, [width, height], 1);
            // A number of points to the line, for those who compare files.
            let path = path.replace('M', "\nM");
            let _ = writeln!(out, r#"<path class="{}" d="{path}"/>"#, series.class());
        }
        out + "</g></svg>\n"
    }
}
