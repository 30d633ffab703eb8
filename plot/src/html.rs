//! A plot as a part of a page.

use std::fmt::Write;

use crate::axis::Scale;
use crate::escaped;
use crate::plot::Plot;

/// Units of the drawing from one end of an axis to the other.
pub(crate) const UNITS: f64 = 1000.0;

impl Plot {
    /// A `<figure>` that fills the width it is given; it needs [`crate::STYLE`], and [`crate::script()`] to be zoomed.
    #[must_use]
    pub fn html(&self) -> String {
        let kind = |s: Scale| match s {
            Scale::Linear => "lin",
            Scale::Logarithmic => "log",
        };
        let mut out = format!(
            r#"<figure class="plot{}" data-x="{:e} {:e} {}" data-y="{:e} {:e} {}"><div class="head"><figcaption>{}</figcaption></div><p class="key">"#,
            if self.round { " round" } else { "" },
            self.x.ends[0],
            self.x.ends[1],
            kind(self.x.scale),
            self.y.ends[0],
            self.y.ends[1],
            kind(self.y.scale),
            escaped(&self.title)
        );
        for series in &self.series {
            let _ = write!(
                out,
                r#"<span><svg class="sample" viewBox="0 0 24 10" aria-hidden="true"><path class="{}" d="{}"/></svg>{}</span> "#,
                series.look.class(),
                if series.look.is_line() {
                    "M1 5H23"
                } else {
                    "M12 5h0"
                },
                escaped(&series.name)
            );
        }
        for mark in &self.marks {
            let _ = write!(
                out,
                r#"<span><svg class="sample" viewBox="0 0 24 10" aria-hidden="true"><path class="mark" d="M12 0V10"/></svg>{}</span> "#,
                escaped(&mark.text)
            );
        }
        let _ = write!(
            out,
            r#"</p><p class="label">{}</p><div class="frame"><div class="ticks y">"#,
            escaped(&self.y.label)
        );
        let (x_ticks, y_ticks) = (self.x.ticks(), self.y.ticks());
        for (place, text) in &y_ticks {
            let _ = write!(
                out,
                r#"<span style="top:{:.2}%">{text}</span>"#,
                100.0 * (1.0 - place)
            );
        }
        let mut grid = String::new();
        for (place, _) in &x_ticks {
            let _ = write!(grid, "M{:.2} 0V{UNITS}", place * UNITS);
        }
        for (place, _) in &y_ticks {
            let _ = write!(grid, "M0 {:.2}H{UNITS}", (1.0 - place) * UNITS);
        }
        let _ = write!(
            out,
            r#"</div><svg class="area" viewBox="0 0 {UNITS} {UNITS}" preserveAspectRatio="none" role="img" aria-label="{}"><path class="grid" d="{grid}"/>"#,
            escaped(&self.title)
        );
        for mark in &self.marks {
            if let Some(place) = self.x.place(mark.x) {
                let _ = write!(
                    out,
                    r#"<path class="mark" d="M{:.2} 0V{UNITS}"/>"#,
                    place * UNITS
                );
            }
        }
        for series in &self.series {
            let _ = write!(
                out,
                r#"<path class="series {}" data-name="{}" d="{}"/>"#,
                series.class(),
                escaped(&series.name),
                self.path(series, [UNITS, UNITS], 2)
            );
        }
        out += r#"</svg><div class="ticks x">"#;
        for (place, text) in &x_ticks {
            let _ = write!(
                out,
                r#"<span style="left:{:.2}%">{text}</span>"#,
                100.0 * place
            );
        }
        let _ = write!(
            out,
            r#"</div></div><p class="label below">{}</p><p class="read" aria-live="polite"></p></figure>"#,
            escaped(&self.x.label)
        );
        out
    }
}
