//! Plots of the reports. They are drawn here, as SVG: they show without a script, and print as lines. A small script in the
//! page ([`script()`]) zooms them and reads points off. All text beside a plot is HTML, so that it keeps its size on any
//! screen. Colours are those of Okabe and Ito, and dashes and marks tell the series apart where there is no colour.

mod axis;
mod html;
mod plot;
mod svg;

pub use axis::{Axis, Scale};
pub use plot::{Look, Mark, Plot, Series};

/// The styles of [`Plot::html`], for a `<style>` element.
pub const STYLE: &str = include_str!("style.css");

/// The script that zooms and reads off, for a `<script>` element at the end of the page. It numbers the axes as the pictures
/// do, by the same thresholds.
#[must_use]
pub fn script() -> String {
    use axis::{FEW, INTERVALS, LARGE, LINEAR, SMALL};
    let script = include_str!("script.js").trim_end();
    format!(
        "{script}({{ UNITS: {UNITS}, INTERVALS: {INTERVALS}, LINEAR: {LINEAR}, FEW: {FEW}, LARGE: {LARGE:e}, SMALL: {SMALL:e} }});\n",
        UNITS = html::UNITS
    )
}

/// Text that stands in HTML or SVG as it is.
pub(crate) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}
