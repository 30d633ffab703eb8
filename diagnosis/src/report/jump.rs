//! The picture of samples that are missing or doubled: the angle against the smooth motion, by the samples' numbers as they
//! are and as they are once the time base is repaired.

use nonius_plot::{Axis, Look, Mark, Plot, Series};
use nonius_recording::Recording;

use crate::diagnose::Diagnosis;
use crate::finding::{Finding, Place};
use crate::numerics::continuous::nearest;
use crate::numerics::solve::Normal;

/// Samples on either side of the place that is shown.
const AROUND: usize = 24;
/// Order of the curve that the motion follows over so many samples.
const ORDER: i32 = 3;

/// A sample: its number, and where it stands in time; nothing where it is left out.
type Numbered = (usize, Option<f64>);

/// The samples around a place.
fn numbered(place: Place, samples: usize) -> Option<(usize, Vec<Numbered>)> {
    let at = match place {
        Place::Gap { sample, .. } | Place::Repeat { sample, .. } => sample,
        Place::Sample(_) | Place::Code { .. } | Place::Missing { .. } | Place::Rail { .. } => {
            return None;
        }
    };
    let range = at.saturating_sub(AROUND)..(at + AROUND).min(samples);
    let time = |k: usize| {
        let own = k as f64;
        match place {
            Place::Gap { missing, .. } if k >= at => Some(own + missing as f64),
            Place::Repeat { .. } if k == at => None,
            Place::Repeat { inserted: true, .. } if k > at => Some(own - 1.0),
            _ => Some(own),
        }
    };
    Some((at, range.map(|k| (k, time(k))).collect()))
}

/// Continuous angles of samples that stand at these times: each from where the two before it lead.
fn continuous(angles: &mut [f64], times: &[f64]) {
    for k in 1..angles.len() {
        let speed = match k {
            1 => 0.0,
            _ => (angles[k - 1] - angles[k - 2]) / (times[k - 1] - times[k - 2]),
        };
        let expected = angles[k - 1] + speed * (times[k] - times[k - 1]);
        angles[k] = nearest(angles[k], expected);
    }
}

/// The picture; none where there are too few samples around the place.
pub(super) fn of(finding: &Finding, found: &Diagnosis, recording: &Recording) -> Vec<Plot> {
    let near = finding.place.and_then(|p| numbered(p, recording.samples()));
    let Some((at, near)) = near else {
        return vec![];
    };
    let ellipse = &found.context.ellipse;
    let angle = |k: usize| {
        let (c, s) = ellipse.corrected(recording.cos[k], recording.sin[k]);
        s.atan2(c)
    };
    let kept: Vec<(usize, f64)> = near.iter().filter_map(|(k, t)| Some((*k, (*t)?))).collect();
    let times: Vec<f64> = kept.iter().map(|p| p.1).collect();
    let mut angles: Vec<f64> = kept.iter().map(|p| angle(p.0)).collect();
    continuous(&mut angles, &times);
    let place = |time: f64| (time - at as f64) / AROUND as f64;
    let column = |order: i32| times.iter().map(|t| place(*t).powi(order)).collect();
    let columns: Vec<Vec<f64>> = (0..=ORDER).map(column).collect();
    let curve = Normal::of_columns(&angles, &columns).solve().x;
    let motion = |time: f64| -> f64 {
        let terms = (0..=ORDER).zip(&curve);
        terms.map(|(order, x)| x * place(time).powi(order)).sum()
    };
    let off = |k: usize, time: f64| {
        let off = angle(k) - motion(time);
        [k as f64, 1e3 * nearest(off, 0.0)]
    };
    let before: Vec<[f64; 2]> = near.iter().map(|(k, _)| off(*k, *k as f64)).collect();
    let after: Vec<[f64; 2]> = kept.iter().map(|(k, t)| off(*k, *t)).collect();
    let heights = before.iter().chain(&after).map(|p| p[1]);
    let what = match finding.place {
        Some(Place::Gap { .. }) => "first gap",
        _ => "first repeated sample",
    };
    vec![Plot {
        title: format!("Angle less the smooth motion, around the {what}"),
        x: Axis::fitted("sample", before.iter().map(|p| p[0])),
        y: Axis::fitted("angle less motion, mrad (electrical)", heights),
        series: vec![
            Series::new("as recorded", Look::Before, before.clone()),
            Series::new("time base repaired", Look::After, after),
        ],
        marks: vec![Mark {
            x: at as f64,
            text: format!("sample {at}"),
        }],
        round: false,
    }]
}
