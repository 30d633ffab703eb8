//! A page in headless Chromium: whether anything is wrong with it, seen as a reader sees it.

use std::path::Path;
use std::process::Command;

use serde::Deserialize;

/// What a page looks like.
#[derive(Debug, Deserialize)]
pub(crate) struct Verdict {
    /// Of the window, pixels.
    pub(crate) width: u32,
    /// Number of plots.
    pub(crate) plots: usize,
    /// Kind, colon, what.
    pub(crate) faults: Vec<String>,
}

/// Opens a page in a window of this width and looks at everything in it.
pub(crate) fn look(html: &str, width: u32, scratch: &Path) -> Verdict {
    let watched = html.replacen(
        "<head>",
        &format!("<head><script>{}</script>", include_str!("watch.js")),
        1,
    );
    let checked = watched.replacen(
        "</body>",
        &format!("<script>{}</script></body>", include_str!("check.js")),
        1,
    );
    // A window of the browser is at least 500 pixels wide, a frame in it as wide as it is told to be.
    let framed = checked.replace('&', "&amp;").replace('"', "&quot;");
    let frame = format!(
        r#"<!doctype html><meta charset="utf-8"><iframe style="border:0;width:{width}px;height:1000px" srcdoc="{framed}"></iframe>"#
    );
    let page = scratch.join(format!("page-{width}.html"));
    std::fs::write(&page, frame).expect("scratch page");
    let output = Command::new("chromium")
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-dev-shm-usage",
            "--hide-scrollbars",
            "--enable-logging=stderr",
            "--timeout=120000",
            "--dump-dom",
        ])
        .arg("--window-size=1400,1100")
        .arg(format!(
            "--user-data-dir={}",
            scratch.join("browser").display()
        ))
        .arg(&page)
        .output()
        .unwrap_or_else(|error| {
            panic!("chromium does not start ({error}); install it: apt-get install chromium")
        });
    let (dom, log) = (
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr),
    );
    let verdict = dom
        .rsplit_once(r#"<pre id="verdict">"#)
        .and_then(|(_, rest)| rest.split_once("</pre>"))
        .unwrap_or_else(|| panic!("the page was not looked at; chromium said:\n{log}"));
    let mut verdict: Verdict = serde_json::from_str(verdict.0).expect("a verdict");
    let said = log.lines().filter(|line| line.contains(":CONSOLE"));
    verdict
        .faults
        .extend(said.map(|line| format!("console: {line}")));
    verdict
}
