//! The plots.

use std::ops::Range;

use plotters::prelude::*;

/// A line of a plot.
pub(crate) struct Line {
    pub(crate) name: String,
    pub(crate) colour: RGBColor,
    /// Broken up, for what the others are to be compared with.
    pub(crate) dashed: bool,
    /// Pixels.
    pub(crate) width: u32,
    pub(crate) points: Vec<(f64, f64)>,
}

pub(crate) const COLOURS: [RGBColor; 5] = [
    RGBColor(31, 119, 180),
    RGBColor(214, 39, 40),
    RGBColor(44, 160, 44),
    RGBColor(148, 103, 189),
    RGBColor(255, 127, 14),
];

/// Lines over one axis, as SVG.
pub(crate) fn lines(
    title: &str,
    axes: [&str; 2],
    (x, y): (Range<f64>, Range<f64>),
    legend: SeriesLabelPosition,
    lines: &[Line],
) -> Result<String, Box<dyn std::error::Error>> {
    let mut svg = String::new();
    {
        let area = SVGBackend::with_string(&mut svg, (800, 420)).into_drawing_area();
        area.fill(&WHITE)?;
        let mut chart = ChartBuilder::on(&area)
            .caption(title, ("sans-serif", 18))
            .margin(12)
            .x_label_area_size(40)
            .y_label_area_size(60)
            .build_cartesian_2d(x, y)?;
        chart
            .configure_mesh()
            .light_line_style(WHITE)
            .x_desc(axes[0])
            .y_desc(axes[1])
            .draw()?;
        for line in lines {
            let style = line.colour.stroke_width(line.width);
            let points = line.points.iter().copied();
            let drawn = if line.dashed {
                chart.draw_series(DashedLineSeries::new(points, 5, 5, style))?
            } else {
                chart.draw_series(LineSeries::new(points, style))?
            };
            if !line.name.is_empty() {
                drawn
                    .label(&line.name)
                    .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], style));
            }
        }
        chart
            .configure_series_labels()
            .position(legend)
            .background_style(WHITE.mix(0.8))
            .border_style(BLACK)
            .draw()?;
        area.present()?;
    }
    Ok(svg)
}
