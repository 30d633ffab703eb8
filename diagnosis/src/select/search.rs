//! Accepts causes one after the other, the one that explains most first.

use crate::causes::angle::is_a_circle;
use crate::causes::candidate::{Candidate, Domain};
use crate::causes::{self, Catalogue};
use crate::doubt::curves;
use crate::doubt::simpler::simpler;
use crate::doubt::{self, LEFTOVER, doubt, gain_of, lines_at_orders};
use crate::drifts::channels::Channels;
use crate::finding::Cause;
use crate::model::exact::{self, Start};
use crate::model::{Fit, Halves, Residual, System, atoms_of};
use crate::noise::flicker::{self, records::Records};
use crate::noise::louder::{beyond_uneven_noise, widen_where_slow, widen_where_uneven};
use crate::select::beside::Beside;
use crate::select::contender::{Contender, contender};
use crate::select::examined::{Nameless, paid_where_noise_shows};
use crate::select::rounds::Anew;
use crate::select::score::{CLEAR, SHOWN, Scored, retain_likely, score, worth};
use crate::select::selection::{Accepted, Selection};
use crate::select::{anew, astray, both, keep_used};
use crate::shapes::library::Shape;
use crate::unnamed::unexplained::leftover;

/// Most causes of one recording.
const MOST: usize = 8;
/// Share of what could not be named that a cause has to explain beside it to be named.
const BEYOND_UNKNOWN: f64 = 0.5;
/// What is there once: the direction turns over in one way only, of two high passes in a row the faster is nearly all, and two delays
/// are one.
pub(crate) const ONCE: [Cause; 4] = [
    Cause::Hysteresis,
    Cause::AcCoupling,
    Cause::ChannelSkew,
    Cause::BandwidthMismatch,
];

/// Beside flicker noise, what is slow in the channels is that noise: drift cannot be told from it, nor can these.
pub(crate) const SLOW_CAUSES: [Cause; 2] = [Cause::Hysteresis, Cause::AcCoupling];

/// Log-likelihood, its numbers paid for (an SNR of 25), below which a drift may be what is seen of slow noise: a stronger one has its
/// own shape.
const FAINT: f64 = 300.0;

/// What is not looked for any more.
struct Closed {
    domains: Vec<Domain>,
    names: Vec<Cause>,
    /// Orders of which a harmonic would be a circle: it is no cause, but what is seen of it may look like another.
    circles: Vec<usize>,
}

impl Closed {
    /// What flicker noise closes, where there is any.
    fn beside(system: &System) -> Self {
        let mut closed = Self {
            domains: vec![],
            names: vec![],
            circles: vec![],
        };
        if system.flicker.is_some() {
            closed.close_slow();
        }
        closed
    }

    /// What is slow is flicker noise.
    fn close_slow(&mut self) {
        self.domains.push(Domain::Time);
        self.names.extend(SLOW_CAUSES);
    }

    /// Whether a cause is looked for beside those that are accepted.
    fn admits(&self, candidate: &Candidate, accepted: &[Accepted]) -> bool {
        let one = |c: &Candidate| c.name == candidate.name;
        let again = || ONCE.contains(&candidate.name) && accepted.iter().any(|a| one(&a.candidate));
        let closed = self.domains.contains(&candidate.domain);
        !(closed || self.names.contains(&candidate.name) || again())
    }

    /// Whether a cause is looked for only as another that what is accepted may be.
    fn is_only_a_rival(&self, candidate: &Candidate) -> bool {
        candidate.order.is_some_and(|n| self.circles.contains(&n))
    }
}

/// Accepts causes from what is known on, see [`select`](super::select).
pub(super) fn search(
    system: &mut System,
    catalogue: &Catalogue,
    mut found: Selection,
    (known, may): (usize, Anew),
) -> Selection {
    if may.with(false) {
        found.again.extend(anew(system, &found));
    }
    if !found.again.is_empty() {
        return found;
    }
    let mut closed = Closed::beside(system);
    let partial = system.every() > 1;
    while found.accepted.len() + found.unnamed.len() < MOST {
        let residual = system.residual(&found.fit);
        let (scored, only_rivals) = candidates(system, catalogue, &found, &closed, &residual);
        if scored.first().is_none_or(|best| best.log_p > SHOWN.ln()) {
            // Weak noise that is slow explains more than any slow change, where no such change is to be seen.
            let known = !found.unnamed.is_empty() || closed.domains.contains(&Domain::Time);
            let change = || best_change(system, &found.fit, &scored);
            if !partial && !known && slow_noise(system, &residual, change()) {
                closed.close_slow();
                continue;
            }
            break;
        }
        // What is left of an unknown shape can look like anything.
        let unknown = found.unnamed.iter().map(|u| u.gain).fold(0.0, f64::max);
        let most = scored.iter().map(|s| s.gain).fold(0.0, f64::max);
        // In a part of a long recording only what is clear is named.
        if most < BEYOND_UNKNOWN * unknown || partial && most < CLEAR {
            break;
        }
        let all = (scored, &only_rivals[..]);
        match contender(system, catalogue, &found.fit, &residual, all) {
            Contender::Unnamed(_) if partial => break,
            Contender::Unnamed(one) => {
                leave_unnamed(system, catalogue, &mut found, &mut closed, &residual, one);
            }
            Contender::Named(cause, others) => {
                accept(
                    system,
                    &mut found,
                    &mut closed,
                    &residual,
                    (*cause, others, may),
                );
            }
        }
        keep_used(system, catalogue.atoms, &mut found);
        if !found.again.is_empty() {
            return found;
        }
    }
    let joined = found.accepted.len() > known;
    let seen =
        may.with(joined) && !exact::tangents_do(system, &found.fit, &found.accepted, exact::SEEN);
    if seen || !partial && simpler(system, catalogue, &mut found, !may.with(true)) {
        found.again = vec![exact::start(system, &found.fit, &found.accepted)];
        return found;
    }
    if !partial {
        look_over(system, catalogue, &mut found, closed.domains);
    }
    keep_used(system, catalogue.atoms, &mut found);
    found
}

/// Every cause that is open and explains something, the likeliest first; and harmonics that cannot be what they seem, but that another may be.
fn candidates(
    system: &mut System,
    catalogue: &Catalogue,
    found: &Selection,
    closed: &Closed,
    residual: &Residual,
) -> (Vec<Scored>, Vec<Scored>) {
    let (fixed, fit) = (catalogue.atoms, &found.fit);
    let open = |c: &Candidate| closed.admits(c, &found.accepted);
    let (context, coloured) = (system.context, system.flicker.is_some());
    let mut shown = causes::shown(context, residual, coloured, &mut system.samples.library);
    shown.retain(open);
    let beside = Beside::all_that_moves(system, &fit.shapes);
    let known = catalogue.candidates.iter().filter(|c| open(c));
    let (mut only_rivals, mut scored): (Vec<Scored>, Vec<Scored>) = known
        .filter_map(|c| score(&beside, c.clone()))
        .partition(|s| closed.is_only_a_rival(&s.candidate));
    let most = scored.iter().map(|s| s.gain).fold(0.0, f64::max);
    let worth = worth(system, fit, shown, most);
    scored.extend(take_in(system, fixed, fit, worth));
    only_rivals.extend(retain_likely(system, &mut scored));
    scored.sort_by(|a, b| a.log_p.total_cmp(&b.log_p));
    scored = with_weighed(system, fixed, fit, residual, open, scored);
    if system.every() == 1 {
        scored = beyond_uneven_noise(system, fit, scored);
    }
    (scored, only_rivals)
}

/// Where a line or motion is the best that was found, or nothing was: what stands out of the noise as it is weighed may
/// be another.
fn with_weighed(
    system: &mut System,
    fixed: usize,
    fit: &Fit,
    residual: &Residual,
    open: impl Fn(&Candidate) -> bool,
    mut scored: Vec<Scored>,
) -> Vec<Scored> {
    let line = |s: &Scored| matches!(s.candidate.domain, Domain::Line | Domain::Motion);
    let best = scored.first().filter(|s| s.log_p < SHOWN.ln());
    let most = best.map_or(0.0, |s| s.gain);
    if best.is_some_and(|s| !line(s)) {
        return scored;
    }
    let Some(weighed) = system.weighed(residual) else {
        return scored;
    };
    let (context, coloured) = (system.context, system.flicker.is_some());
    let library = &mut system.samples.library;
    let mut list = causes::shown_weighed(context, &weighed, coloured, library);
    list.retain(open);
    scored.extend(worth(system, fit, list, most));
    scored = take_in(system, fixed, fit, scored);
    scored.sort_by(|a, b| a.log_p.total_cmp(&b.log_p));
    scored
}

/// Keeps the functions of these candidates, and drops those of all others.
fn take_in(system: &mut System, fixed: usize, fit: &Fit, mut list: Vec<Scored>) -> Vec<Scored> {
    let own = list.iter().flat_map(|s| &s.candidate.shapes);
    let used = atoms_of(&own.chain(&fit.shapes).cloned().collect::<Vec<_>>());
    // What the fit has stands before what is new, so that its numbers stay.
    let map = system.retain(|i| i < fixed || used.binary_search(&i).is_ok());
    for shape in list.iter_mut().flat_map(|s| &mut s.candidate.shapes) {
        *shape = shape.mapped(&map);
    }
    list
}

/// Keeps in mind what cannot be named, and fits its domain by shapes of any kind.
fn leave_unnamed(
    system: &mut System,
    catalogue: &Catalogue,
    found: &mut Selection,
    closed: &mut Closed,
    residual: &Residual,
    one: Nameless,
) {
    // Real motion that is no line is the axis at work, and no error; and slow noise has a name.
    if one.domain == Some(Domain::Motion) || one.is_noise {
        closed.names.extend(one.name);
    } else if one.domain == Some(Domain::Time) && slow_noise(system, residual, one.paid) {
        closed.close_slow();
    } else {
        let gain = one.unnamed.gain;
        let left_over = one.domain == Some(Domain::Time) && is_left_over(system, found, gain);
        found.unnamed.push(one.unnamed);
        closed.domains.extend(one.domain);
        if left_over {
            return;
        }
        let generic = one.domain.map_or(&[][..], |d| catalogue.basis(d));
        let generic = both(&found.fit.shapes, generic);
        found.fit = system.fit(both(&generic, &one.shapes));
    }
}

/// Whether what explains so much is so little beside a cause that is slow itself that shapes of any kind, which hold most of that, must not
/// stand beside it.
fn is_left_over(system: &System, found: &Selection, gain: f64) -> bool {
    let slow = |i: &usize| SLOW_CAUSES.contains(&found.accepted[*i].candidate.name);
    let mut slow = (0..found.accepted.len()).filter(slow);
    slow.any(|i| gain < LEFTOVER * gain_of(system, found, &[i]))
}

/// Accepts a cause, unless it is a circle, slow noise, or does not hold on data that was not fitted. Of `others` one may turn out to
/// be the better where tangents are exact.
fn accept(
    system: &mut System,
    found: &mut Selection,
    closed: &mut Closed,
    residual: &Residual,
    (mut cause, others, may): (Accepted, Vec<Accepted>, Anew),
) {
    cause.first = found.fit.shapes.len();
    let shapes = both(&found.fit.shapes, &cause.candidate.shapes);
    let halves = system.halves(&shapes);
    let fit = system.fit(shapes);
    let amounts = &fit.solution.x[cause.first..];
    let circle = || is_a_circle(&cause.candidate, amounts, system.vibrates());
    if system.context.against_reference.is_none() && circle() {
        closed.circles.extend(cause.candidate.order);
        return;
    }
    if !closed.circles.is_empty() && is_motion(system, &found.fit, &cause.candidate) {
        closed.names.push(cause.candidate.name);
        return;
    }
    let slow = cause.candidate.domain == Domain::Time;
    if slow && is_faint(system, &found.fit, &fit) {
        let own = &fit.shapes[cause.first..];
        let seen = paid_where_noise_shows(system, &found.fit, own, own.len() as f64);
        if slow_noise(system, residual, seen) {
            closed.close_slow();
            return;
        }
    }
    let own = found.base.shapes.len();
    // What is slow may be noise that is, and whitening would hide how far off it goes on.
    let held_out = if system.vibrates() && !slow {
        Halves::held_out_in_noise
    } else {
        Halves::held_out
    };
    let before = held_out(&halves, &found.fit, own, 0);
    let fails = held_out(&halves, &fit, own, cause.candidate.given()) > 1.01 * before;
    let (name, turns) = (cause.candidate.name, cause.candidate.factor.is_some());
    let mut accepted = found.accepted.clone();
    accepted.push(cause);
    let anew = may.with(true) && astray(system, &fit, &accepted);
    // What does not hold on data that was not fitted is no cause, unless it turns the pair so far that its tangents do not.
    if fails && !(turns && anew) {
        closed.names.push(name);
        return;
    }
    let before = std::mem::replace(&mut found.fit, fit);
    found.accepted = accepted;
    // Second orders may decide between causes long before they show beside one of them.
    if anew || may.with(true) && !others.is_empty() {
        found.again = starts(system, &before, found, others);
    }
}

/// Whether what codes seem to do is nearly all along the circle, where the axis has been seen to move: the radius sees all but the middle
/// one as well.
fn is_motion(system: &System, fit: &Fit, candidate: &Candidate) -> bool {
    /// Share that the radius has to show.
    const IN_RADIUS: f64 = 0.05;
    if candidate.domain != Domain::Code {
        return false;
    }
    let gain = |known: &[Shape], own: &[Shape]| Beside::new(&system.total, known).gain(own).0;
    let own = &candidate.shapes;
    let shown = gain(&system.in_radius(&fit.shapes), &system.in_radius(own));
    shown < IN_RADIUS * gain(&fit.shapes, own)
}

/// Whether what a fit has beyond another, its numbers paid for, is so weak that it may be what is seen of slow noise.
fn is_faint(system: &System, without: &Fit, with: &Fit) -> bool {
    let gain = with.solution.gain() - without.solution.gain();
    let numbers = (with.shapes.len() - without.shapes.len()) as f64;
    gain - system.price() * numbers < FAINT
}

/// Doubts what was found, and looks at what is left of all.
fn look_over(
    system: &mut System,
    catalogue: &Catalogue,
    found: &mut Selection,
    mut closed: Vec<Domain>,
) {
    closed.extend(doubt(system, catalogue, found));
    let curves = curves::of_drifts(system, found);
    found.unnamed.extend(curves);
    if let Some(noise) = Records::of(system) {
        closed.extend(doubt::SLOW_DOMAINS);
        widen_where_slow(system, found, &noise);
    }
    widen_where_uneven(system, found);
    found.left = leftover(system, catalogue, &found.fit, &closed);
    lines_at_orders(system, found);
}

/// Whether what is slow is flicker noise, which goes to the system then.
fn slow_noise(system: &mut System, residual: &Residual, change: f64) -> bool {
    if system.only_white || system.flicker.is_some() {
        return false;
    }
    system.flicker = flicker::instead(Channels::of(system, residual), change);
    system.flicker.is_some()
}

/// Most that a slow change explains where noise of the channels is looked for.
fn best_change(system: &System, fit: &Fit, scored: &[Scored]) -> f64 {
    let slow = scored.iter().filter(|s| s.candidate.domain == Domain::Time);
    let best = slow.max_by(|a, b| a.gain.total_cmp(&b.gain));
    best.map_or(0.0, |s| {
        paid_where_noise_shows(system, fit, &s.candidate.shapes, s.freedom as f64).max(0.0)
    })
}

/// Where to look anew from: with the cause that was accepted last, or with another in its place.
pub(super) fn starts(
    system: &System,
    before: &Fit,
    found: &Selection,
    others: Vec<Accepted>,
) -> Vec<Start> {
    let mut list = vec![exact::start(system, &found.fit, &found.accepted)];
    for mut other in others {
        other.first = before.shapes.len();
        let fit = system.fit(both(&before.shapes, &other.candidate.shapes));
        let mut accepted = found.accepted.clone();
        accepted.pop();
        accepted.push(other);
        list.push(exact::start(system, &fit, &accepted));
    }
    list
}
