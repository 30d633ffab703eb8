//! Two thousand seeds against the Cramér–Rao bound: writes docs/offline-statistics.json and .md.
//!
//!     cargo run --release -p nonius-calibration --example statistics [SEEDS]
//!
//! The short form is an ordinary test, and another test runs the first seeds again to see that the files are fresh.

#[path = "../tests/support/campaign.rs"]
mod campaign;
#[path = "../tests/support/table.rs"]
mod table;

use std::thread;

use campaign::{Case, Tally};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let seeds: u64 = std::env::args().nth(1).map_or(Ok(2000), |s| s.parse())?;
    let cases = table::cases();
    let share = |share: f64| ((seeds as f64 * share) as u64).max(table::PROBE);
    // Drawn on a terminal only.
    let bar = ProgressBar::new(cases.iter().map(|(_, s)| share(*s)).sum());
    bar.set_style(ProgressStyle::with_template(
        "{bar:40} {pos}/{len} recordings, {eta} left  {msg}",
    )?);
    let mut rows = vec![];
    for (case, part) in &cases {
        bar.set_message(case.method.name());
        let tally = parallel(case, share(*part), &|| bar.inc(1));
        rows.push(table::row(case, &tally, &case.run(0..table::PROBE, &|| ())));
    }
    bar.finish_and_clear();
    let numbers = json!({"schema": "nonius.offline-statistics/1", "rows": rows});
    write(
        table::NUMBERS,
        &(serde_json::to_string_pretty(&numbers)? + "\n"),
    )?;
    let page = table::page(&numbers);
    write(table::PAGE, &page)?;
    print!("{page}");
    Ok(())
}

fn parallel(case: &Case, seeds: u64, done: &(dyn Fn() + Sync)) -> Tally {
    let cores = thread::available_parallelism().map_or(1, usize::from) as u64;
    thread::scope(|scope| {
        let range = |c: u64| seeds * c / cores..seeds * (c + 1) / cores;
        let work: Vec<_> = (0..cores)
            .map(|c| scope.spawn(move || case.run(range(c), done)))
            .collect();
        let mut all = Tally::default();
        for one in work {
            match one.join() {
                Ok(tally) => all += tally,
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        all
    })
}

fn write(path: &str, text: &str) -> std::io::Result<()> {
    let scratch = format!("{path}.part");
    std::fs::write(&scratch, text)?;
    std::fs::rename(scratch, path)
}
