//! A case of the campaign: everything about it follows from its seed.

use rand::{Rng, SeedableRng, rngs::StdRng};

use crate::effect::{Effect, Hidden};
use crate::effects::{CATALOGUE, Draw, Entry};
use crate::magnitude::scaled;
use crate::many;
use crate::motion::Drive;
use crate::rows::Rows;
use crate::simulate::{Finish, simulate};
use crate::strangers::STRANGERS;
use crate::truth::{HiddenCause, Kind, TrueParameter, Truth, Twin};
use crate::twin::distance;
use crate::visible::Visible;
use crate::world::{Wish, World};

/// Kinds of twenty seeds: seven with nothing, seven with one cause, two each of the others.
const KINDS: [Kind; 20] = {
    use Kind::{Nothing, One, Stranger, Two, Wild};
    [
        Nothing, One, Wild, Nothing, One, Two, Nothing, One, Stranger, Nothing, One, Nothing, One,
        Wild, Nothing, One, Two, Nothing, One, Stranger,
    ]
};
/// Experiments that are drawn until one shows the cause as asked.
const ATTEMPTS: u32 = 30;
/// Share of recordings with a reference, of causes that need none.
const REFERENCE: f64 = 0.3;
/// Where none does, half of the SNR is asked for: what is noise has no more than its samples can tell.
const HALVINGS: u32 = 5;

/// A cause that no drawn experiment shows with the SNR asked for.
#[derive(Debug, thiserror::Error)]
#[error(
    "seed {seed}: {name} shows in no experiment, not even with an SNR of {snr:.1}; more samples would help"
)]
pub struct Unreachable {
    /// Of the case.
    pub seed: u64,
    /// What was to be hidden.
    pub name: &'static str,
    /// And how large.
    pub snr: f64,
}

/// A case.
pub struct Case {
    /// What is hidden.
    pub truth: Truth,
    /// The experiment.
    pub world: World,
    /// The recording, with what is never in the file.
    pub rows: Rows,
}

/// What to hide: a line of the catalogue, or a stranger.
enum Choice {
    Known(&'static Entry, bool),
    Stranger(usize),
}

impl Kind {
    /// What kind of case a seed stands for.
    #[must_use]
    pub fn of_seed(seed: u64) -> Self {
        KINDS[(seed % KINDS.len() as u64) as usize]
    }
}

impl Case {
    /// The cause that a seed hides first, where it stands for this kind.
    #[must_use]
    pub fn first_of_seed(seed: u64, kind: Kind) -> Option<&'static str> {
        let (choices, _) = plan(seed, kind, &mut source(seed));
        choices.first().map(Choice::name)
    }

    /// The case of a seed, with so many samples.
    ///
    /// # Errors
    /// Where no experiment shows the cause as asked.
    pub fn draw(seed: u64, samples: usize) -> Result<Self, Unreachable> {
        Self::of_kind(Kind::of_seed(seed), None, seed, samples)
    }

    /// The same where the seed stands for this kind: for [`Kind::Many`] any can, and none does by itself. The axis is driven this way, or any
    /// way but by hand.
    ///
    /// # Errors
    /// Where no experiment shows the causes as asked.
    pub fn of_kind(
        kind: Kind,
        drive: Option<Drive>,
        seed: u64,
        samples: usize,
    ) -> Result<Self, Unreachable> {
        let mut random = source(seed);
        let (choices, mut snrs) = plan(seed, kind, &mut random);
        for _ in 0..HALVINGS {
            for _ in 0..ATTEMPTS {
                let mut random = StdRng::seed_from_u64(random.random());
                let mut wish = wish(&choices, samples, &mut random);
                wish.drive = drive.unwrap_or(wish.drive);
                if let Some(case) = attempted((seed, kind), &wish, &choices, &snrs, &mut random) {
                    return Ok(case);
                }
            }
            snrs.iter_mut().for_each(|snr| *snr /= 2.0);
        }
        Err(Unreachable {
            seed,
            name: choices.first().map_or("nothing", Choice::name),
            snr: snrs.first().copied().unwrap_or(0.0),
        })
    }

    /// The recording as a file.
    #[must_use]
    pub fn csv(&self) -> String {
        self.rows.csv(&self.world)
    }
}

impl Choice {
    fn name(&self) -> &'static str {
        match self {
            Self::Known(entry, _) => entry.name,
            Self::Stranger(which) => STRANGERS[*which].0,
        }
    }

    fn draw(&self, draw: &mut Draw) -> Box<dyn Effect> {
        match self {
            Self::Known(entry, wild) => {
                draw.wild = *wild;
                (entry.draw)(draw)
            }
            Self::Stranger(which) => (STRANGERS[*which].1)(draw),
        }
    }
}

/// SNR of two causes.
const TWO: [f64; 2] = [60.0, 30.0];
/// SNR of what the catalogue does not have.
const STRANGE: f64 = 40.0;

/// Source of everything random of a seed.
fn source(seed: u64) -> StdRng {
    StdRng::seed_from_u64(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15))
}

/// What to hide, and how large. Names go round, so that all come equally often.
fn plan(seed: u64, kind: Kind, random: &mut StdRng) -> (Vec<Choice>, Vec<f64>) {
    let round = KINDS.len() as u64;
    let place = (seed % round) as usize;
    let before = KINDS[..place].iter().filter(|k| **k == kind).count();
    let each = KINDS.iter().filter(|k| **k == kind).count();
    let turn = seed / round * each as u64 + before as u64;
    let snr = 3.0 * 100f64.powf(random.random());
    match kind {
        Kind::Nothing => (vec![], vec![]),
        Kind::One => {
            let entry = &CATALOGUE[(turn % CATALOGUE.len() as u64) as usize];
            (vec![Choice::Known(entry, false)], vec![snr])
        }
        Kind::Wild => {
            let wild: Vec<&Entry> = CATALOGUE.iter().filter(|e| e.wild).collect();
            let entry = wild[(turn % wild.len() as u64) as usize];
            (vec![Choice::Known(entry, true)], vec![snr])
        }
        Kind::Two => {
            let first = (turn % CATALOGUE.len() as u64) as usize;
            let second = (first + random.random_range(1..CATALOGUE.len())) % CATALOGUE.len();
            let known = |which: usize| Choice::Known(&CATALOGUE[which], false);
            (vec![known(first), known(second)], TWO.to_vec())
        }
        Kind::Stranger => {
            let which = (turn % STRANGERS.len() as u64) as usize;
            (vec![Choice::Stranger(which)], vec![STRANGE])
        }
        Kind::Many => many::plan(seed, random)
            .into_iter()
            .map(|(entry, wild, snr)| (Choice::Known(entry, wild), snr))
            .unzip(),
    }
}

/// How many times as often as another name of the catalogue one is hidden in recordings with a reference, or in those without; none
/// where the other never is. The names come equally often.
fn odds(name: &str, other: &str, reference: bool) -> Option<f64> {
    let often = |name: &str| {
        let entry = CATALOGUE.iter().find(|e| e.name == name)?;
        let with = if entry.reference { 1.0 } else { REFERENCE };
        Some(if reference { with } else { 1.0 - with })
    };
    let (own, other) = (often(name)?, often(other)?);
    (other > 0.0).then_some(own / other)
}

/// An experiment that may show the choices.
fn wish(choices: &[Choice], samples: usize, random: &mut StdRng) -> Wish {
    let needs = |what: fn(&Entry) -> bool| {
        choices.iter().any(|c| match c {
            Choice::Known(entry, _) => what(entry),
            Choice::Stranger(_) => false,
        })
    };
    let drives = [
        Drive::Reversing,
        Drive::Reversing,
        Drive::Constant,
        Drive::Sweeping,
        Drive::StopAndGo,
    ];
    let slow = needs(|e| e.name.ends_with("_drift"));
    Wish {
        samples,
        drive: drives[random.random_range(0..drives.len())],
        reference: random.random_bool(REFERENCE) || needs(|e| e.reference),
        revolution: random.random_bool(0.5) || needs(|e| e.revolution),
        vibration: random.random(),
        temperature: random.random_bool(if slow { 0.3 } else { 0.05 }),
    }
}

fn attempted(
    (seed, kind): (u64, Kind),
    wish: &Wish,
    choices: &[Choice],
    snrs: &[f64],
    random: &mut StdRng,
) -> Option<Case> {
    let world = World::draw(random, wish);
    let noise_seed = random.random();
    let mut effects = vec![];
    let mut truths = vec![];
    for (choice, asked) in choices.iter().zip(snrs) {
        let effect = choice.draw(&mut Draw {
            random,
            world: &world,
            wild: false,
            snr: *asked,
        });
        let known = wish.reference && !effect.takes_reference_along();
        let visible = Visible::new(&world, known, effect.moves_time())?;
        let (m, snr) = scaled(effect.as_ref(), &world, &visible, noise_seed, *asked)?;
        let twins = effect.twins(known).filter(|_| kind == Kind::One);
        let twin = twins.and_then(|twins| {
            Some(Twin {
                odds: odds(effect.name(), twins.other.name(), wish.reference)?,
                distance: distance(&twins, (m, snr), &world, &visible),
            })
        });
        truths.push(HiddenCause {
            name: effect.name().into(),
            brings: effect.brings().iter().map(|&name| name.into()).collect(),
            snr_asked: *asked,
            snr,
            twin,
            magnitude: m,
            parameters: effect
                .parameters(m, &world)
                .into_iter()
                .map(|(name, value, bounded)| TrueParameter {
                    name: name.into(),
                    value,
                    bounded,
                })
                .collect(),
            motion: effect.is_motion(),
            electrical: matches!(choice, Choice::Known(entry, _) if entry.electrical),
        });
        effects.push((effect, m));
    }
    let hidden: Vec<Hidden> = effects.iter().map(|(e, m)| (e.as_ref(), *m)).collect();
    let mut rows = simulate(&world, &hidden, Finish::Recorded(noise_seed));
    let clean = simulate(&world, &hidden, Finish::Clean);
    for channel in [0, 1] {
        let pairs = rows.volts[channel].iter().zip(&clean.volts[channel]);
        rows.noise[channel] = pairs.map(|(shown, clean)| shown - clean).collect();
    }
    let truth = Truth {
        seed,
        kind,
        hidden: truths,
        samples: wish.samples,
        drive: format!("{:?}", wish.drive).to_lowercase(),
        vibration_rad: world.vibration.as_ref().map(|v| v.rms),
        reference: wish.reference,
        noise: world.sigma() / world.mean_amplitude(),
        bits: world.bits,
        rate: world.rate,
    };
    Some(Case { truth, world, rows })
}
