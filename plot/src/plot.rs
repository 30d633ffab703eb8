//! What a plot holds.

use crate::axis::Axis;

/// How a series looks. Every look has its own mark or dash too, for print and for those who see no colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// Measured, or as it was: vermillion points.
    Before,
    /// As it is now: blue points.
    After,
    /// As it was: a vermillion line.
    BeforeLine,
    /// As it is now: a blue dashed line.
    AfterLine,
    /// Simulated, expected or drawn to compare: a black line.
    Model,
    /// Measured, with bars of one standard error: vermillion.
    Bars,
}

impl Look {
    pub(crate) fn class(self) -> &'static str {
        match self {
            Self::Before => "dots was",
            Self::After => "dots is",
            Self::BeforeLine => "line was",
            Self::AfterLine => "line is",
            Self::Model => "line model",
            Self::Bars => "bars was",
        }
    }

    pub(crate) fn is_line(self) -> bool {
        matches!(self, Self::BeforeLine | Self::AfterLine | Self::Model)
    }
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// What the key calls it.
    pub name: String,
    /// How it looks.
    pub look: Look,
    /// Its points.
    pub points: Vec<[f64; 2]>,
    /// Standard errors of [`Look::Bars`].
    pub errors: Vec<f64>,
}

impl Series {
    /// Points without errors.
    #[must_use]
    pub fn new(name: &str, look: Look, points: Vec<[f64; 2]>) -> Self {
        Self {
            name: name.into(),
            look,
            points,
            errors: vec![],
        }
    }
}

/// A place on the horizontal axis that is marked.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Where.
    pub x: f64,
    /// What is there.
    pub text: String,
}

/// A plot.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// What it shows.
    pub title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// What is drawn, the first at the back.
    pub series: Vec<Series>,
    /// Marked places.
    pub marks: Vec<Mark>,
    /// Both axes have one scale, and a circle is round.
    pub round: bool,
}

/// Points of a series below which they are drawn larger.
const FEW: usize = 100;

impl Series {
    /// Classes of its path.
    pub(crate) fn class(&self) -> String {
        let few = if self.points.len() < FEW && !self.look.is_line() {
            " few"
        } else {
            ""
        };
        format!("{}{few}", self.look.class())
    }
}

impl Plot {
    /// The path of a series in a rectangle.
    pub(crate) fn path(&self, series: &Series, [width, height]: [f64; 2], digits: usize) -> String {
        let mut path = String::new();
        let mut broken = true;
        for (i, [x, y]) in series.points.iter().enumerate() {
            let at = |y: f64| self.y.place(y).map(|p| (1.0 - p) * height);
            let (Some(px), Some(py)) = (self.x.place(*x).map(|p| p * width), at(*y)) else {
                broken = true;
                continue;
            };
            path += &match series.look {
                look if look.is_line() && !broken => format!("L{px:.digits$} {py:.digits$}"),
                look if look.is_line() => format!("M{px:.digits$} {py:.digits$}"),
                Look::Bars => {
                    let error = series.errors.get(i).copied().unwrap_or_default();
                    let (low, high) = (at(y - error), at(y + error));
                    let (low, high) = (low.unwrap_or(height), high.unwrap_or(py));
                    // A point, then its bar.
                    format!(
                        "M{px:.digits$} {py:.digits$}h0M{px:.digits$} {low:.digits$}V{high:.digits$}"
                    )
                }
                // A line without length, with round ends.
                _ => format!("M{px:.digits$} {py:.digits$}h0"),
            };
            broken = false;
        }
        path
    }
}
