//! The kept tables, page and plots of docs/convergence are what the study says today.

#[path = "../examples/study_convergence/costs.rs"]
mod costs;
#[path = "../examples/study_convergence/figure_7.rs"]
mod figure_7;
#[path = "../examples/study_convergence/figure_7_plot.rs"]
mod figure_7_plot;
#[path = "../examples/study_convergence/limit.rs"]
mod limit;
#[path = "../examples/study_convergence/method.rs"]
mod method;
#[path = "../examples/study_convergence/on_chip.rs"]
mod on_chip;
#[path = "../examples/study_convergence/page.rs"]
mod page;
#[path = "../examples/study_convergence/plot.rs"]
mod plot;
#[path = "../examples/study_convergence/scenario.rs"]
mod scenario;
#[path = "../examples/study_convergence/singular.rs"]
mod singular;
mod support;
#[path = "../examples/study_convergence/table.rs"]
mod table;
#[path = "../examples/study_convergence/truth.rs"]
mod truth;

use std::path::Path;

use support::shipped;

use nonius_kept::every;
use nonius_model::design::Design;
use scenario::Scenario;

const COMMAND: &str = "cargo run --release -p nonius-model --example study_convergence -- designs/optical.toml docs/convergence docs/on-line-costs.csv";

/// What may differ on another machine: it has other last digits of the sine, and noise takes it from there.
struct Slack {
    share: f64,
    more: f64,
}

/// Cell by cell; a cell without a number says the same.
fn compare(kept: &str, found: &str, slack: impl Fn(&str, &str) -> Slack) {
    assert_eq!(kept.lines().count(), found.lines().count(), "{COMMAND}");
    let header: Vec<&str> = kept.lines().next().expect("a header").split(',').collect();
    for (kept_row, row) in kept.lines().zip(found.lines()) {
        // Commas in quotes are in the first cell alone.
        let (was, is) = (kept_row.rsplit(','), row.rsplit(','));
        for ((was, is), column) in was.zip(is).zip(header.iter().rev()) {
            let near = match (was.parse::<f64>(), is.parse::<f64>()) {
                (Ok(was), Ok(is)) => {
                    let Slack { share, more } = slack(column, kept_row);
                    (was - is).abs() <= share * was.abs() + more
                }
                _ => was == is,
            };
            assert!(
                near,
                "{column}: {is}, kept {was}, in\n{row}\nIf that is right: {COMMAND}"
            );
        }
    }
}

fn kept(name: &str) -> String {
    let path = format!("{}/../docs/{name}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).expect("a kept table")
}

/// Every column of every third scenario, in the long form of all; clocks and LUTs are those of the costs.
#[test]
fn the_kept_table_is_fresh() {
    let design = Design::new(&support::optical()).expect("a shipped design");
    let costs = costs::Costs::read(&kept("on-line-costs.csv"));
    let scenarios: Vec<Scenario> = every(3, Scenario::ALL).collect();
    let found = table::methods(&design, &scenarios, &costs);
    let whole = kept("convergence/methods.csv");
    let of_these = |row: &&str| {
        let one = |s: &Scenario| row.contains(&format!("\",{},", s.name()));
        scenarios.iter().any(one) || row.starts_with("method,")
    };
    let some: Vec<&str> = whole.lines().filter(of_these).collect();
    compare(
        &some.join("\n"),
        found.trim_end(),
        |column, row| match column {
            "products" | "clocks" | "lut4" => Slack {
                share: 0.0,
                more: 0.0,
            },
            // With much noise they hang on single samples. Else a millionth of the noise moves none, a thousandth few.
            "periods" => Slack {
                share: 0.3,
                more: if row.contains(",noisy,") { 20.0 } else { 2.0 },
            },
            "parameter_error" => Slack {
                share: 0.3,
                more: 1e-5,
            },
            _ => Slack {
                share: 0.1,
                more: 1e-3,
            },
        },
    );
}

/// The page is made of the kept table, to the last character.
#[test]
fn the_kept_page_is_that_of_the_kept_table() {
    let page = page::page(&kept("convergence/methods.csv"));
    assert!(page == kept("convergence/methods.md"), "{COMMAND}");
}

/// A kept plot is drawn like this, within the pixel that another machine may round to.
fn drawn(name: &str, svg: &str) {
    let file = format!("{}/../docs/convergence/{name}", env!("CARGO_MANIFEST_DIR"));
    nonius_kept::near(Path::new(&file), svg, |_| 1.0, COMMAND);
}

#[test]
fn the_kept_plots_of_the_null_direction_are_fresh() {
    drawn("null_direction.svg", &singular::effect().expect("a plot"));
    drawn("third_harmonics.svg", &singular::order_2().expect("a plot"));
}

#[test]
fn the_kept_figure_7_is_fresh() {
    let course = figure_7::figure_7(&support::optical()).expect("a shipped design");
    compare(
        kept("convergence/figure_7.csv").trim_end(),
        figure_7::csv(&course).trim_end(),
        |_, _| Slack {
            share: 0.0,
            more: 2e-6,
        },
    );
    drawn(
        "figure_7.svg",
        &figure_7_plot::plot(&course).expect("a plot"),
    );
    // And both are where Heydemann's least squares are: within what noise leaves of the last γ, and of a single one.
    let (_, [paper, chip, heydemann]) = course[course.len() - 1];
    for i in 0..5 {
        let off = [paper[i], chip[i]].map(|theta| (theta - heydemann[i]).abs());
        println!("theta {}: {off:?}", i + 1);
        assert!(off[1] < 1e-4 && off[0] < 3e-4, "theta {}: {off:?}", i + 1);
    }
}

/// Products beside those of the bare loop, counted in the recorded graph of every search and set. The paper promises six for
/// four parameters; the chip needs five, one of them for what the loop lags, and seven for five.
#[test]
fn products_of_every_search() {
    use shipped::variants::{fixed, searches};
    let bare = fixed().design().graph.products();
    assert_eq!(bare, 10);
    let counted: Vec<(String, u32, usize)> = searches()
        .into_iter()
        .map(|v| {
            let more = v.design().graph.products() - bare;
            (v.what, v.spec.calibration.parameters, more)
        })
        .collect();
    let expected = [
        ("final form", 4, 5),
        ("final form", 5, 7),
        ("radius alone", 8, 19),
        ("radius alone", 9, 21),
        ("completed", 8, 22),
        ("completed", 9, 24),
        ("exact", 4, 19),
        ("exact", 5, 25),
        ("sum of squares", 4, 6),
        ("sum of squares", 5, 8),
        ("sum of squares, completed", 8, 22),
        ("sum of squares, completed", 9, 24),
        ("batch", 4, 6),
        ("batch", 5, 8),
        ("batch, completed", 8, 22),
        ("batch, completed", 9, 24),
        ("started", 4, 12),
        ("started", 5, 16),
        ("completed, started", 8, 29),
        ("completed, started", 9, 34),
        ("exact, started", 4, 26),
        ("exact, started", 5, 34),
    ];
    assert_eq!(
        counted,
        expected.map(|(what, set, more)| (what.to_owned(), set, more))
    );
}
