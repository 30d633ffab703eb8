//! Figure 7 drawn.

use plotters::chart::SeriesLabelPosition;
use plotters::style::RGBColor;

use crate::figure_7::{Row, SOURCES};
use crate::plot::{self, COLOURS, Line};

/// The course of the parameters against periods travelled.
pub(crate) fn plot(rows: &[Row]) -> Result<String, Box<dyn std::error::Error>> {
    let drawn: Vec<Line> = (0..5 * SOURCES.len()).map(|n| line(n, rows)).collect();
    plot::lines(
        "Five parameters: paper (thick), bit-true chip (thin, light), Heydemann (dashed)",
        ["periods travelled", "theta"],
        (0.0..80.0, -0.2..1.3),
        SeriesLabelPosition::MiddleRight,
        &drawn,
    )
}

/// Lines 0 … 4 are the paper's, then the chip's, then Heydemann's.
fn line(n: usize, rows: &[Row]) -> Line {
    let [r, g, b] = {
        let RGBColor(r, g, b) = COLOURS[n % 5];
        let lighter = |x: u8| if n / 5 == 1 { x / 2 + 127 } else { x };
        [r, g, b].map(lighter)
    };
    let at = |(periods, theta): &Row| (*periods, theta[n / 5][n % 5]);
    Line {
        name: if n < 5 {
            format!("theta {}", n + 1)
        } else {
            String::new()
        },
        colour: RGBColor(r, g, b),
        dashed: n >= 10,
        width: if n < 5 { 4 } else { 2 },
        points: rows.iter().map(at).collect(),
    }
}
