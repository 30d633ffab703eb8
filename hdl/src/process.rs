//! One program, run to its end or to its limit.
//!
//! Output goes to unnamed files, not pipes: a program's own children may hold a pipe open
//! after it was stopped, and nobody has to read along. The program stays in the caller's
//! process group, so that Ctrl-C ends it too.

use std::ffi::{OsStr, OsString};
use std::fs::File;
use std::io::{self, Read, Seek};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::error::Error;

/// A program that writes more than this is stopped: it hangs in a loop that prints.
const OUTPUT_LIMIT: u64 = 64 << 20;

/// A program with its arguments, environment, working directory and time limit.
pub(crate) struct Job<'a> {
    program: &'a Path,
    arguments: Vec<OsString>,
    environment: Vec<(&'static str, OsString)>,
    folder: &'a Path,
    limit: Duration,
}

/// How it ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum End {
    Exit(ExitStatus),
    TimeLimit(Duration),
    OutputLimit,
}

/// What it said.
pub(crate) struct Output {
    pub(crate) stdout: String,
    pub(crate) stderr: String,
    pub(crate) end: End,
    pub(crate) seconds: f64,
}

impl<'a> Job<'a> {
    pub(crate) fn new(program: &'a Path, folder: &'a Path, limit: Duration) -> Self {
        Job {
            program,
            arguments: Vec::new(),
            environment: Vec::new(),
            folder,
            limit,
        }
    }

    pub(crate) fn arg(mut self, argument: impl AsRef<OsStr>) -> Self {
        self.arguments.push(argument.as_ref().to_owned());
        self
    }

    pub(crate) fn args<S: AsRef<OsStr>>(mut self, arguments: impl IntoIterator<Item = S>) -> Self {
        self.arguments
            .extend(arguments.into_iter().map(|it| it.as_ref().to_owned()));
        self
    }

    pub(crate) fn env(mut self, name: &'static str, value: impl AsRef<OsStr>) -> Self {
        self.environment.push((name, value.as_ref().to_owned()));
        self
    }

    pub(crate) fn run(self) -> Result<Output, Error> {
        let mut stdout = tempfile::tempfile().map_err(Error::Scratch)?;
        let mut stderr = tempfile::tempfile().map_err(Error::Scratch)?;
        let start = Instant::now();
        let end = self
            .start(&stdout, &stderr)
            .and_then(|mut child| {
                let end = wait(&mut child, self.limit, &[&stdout, &stderr]);
                if !matches!(end, Ok(End::Exit(_))) {
                    child.kill()?;
                    child.wait()?;
                }
                end
            })
            .map_err(|source| Error::Start {
                program: PathBuf::from(self.program),
                source,
            })?;
        Ok(Output {
            seconds: start.elapsed().as_secs_f64(),
            stdout: read_back(&mut stdout).map_err(Error::Scratch)?,
            stderr: read_back(&mut stderr).map_err(Error::Scratch)?,
            end,
        })
    }

    fn start(&self, stdout: &File, stderr: &File) -> io::Result<Child> {
        Command::new(self.program)
            .args(&self.arguments)
            .envs(self.environment.iter().map(|(name, value)| (name, value)))
            .current_dir(self.folder)
            .stdin(Stdio::null())
            .stdout(stdout.try_clone()?)
            .stderr(stderr.try_clone()?)
            .spawn()
    }
}

fn wait(child: &mut Child, limit: Duration, outputs: &[&File]) -> io::Result<End> {
    let start = Instant::now();
    let mut pause = Duration::from_micros(500);
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(End::Exit(status));
        }
        if start.elapsed() >= limit {
            return Ok(End::TimeLimit(limit));
        }
        for file in outputs {
            if file.metadata()?.len() > OUTPUT_LIMIT {
                return Ok(End::OutputLimit);
            }
        }
        sleep(pause);
        pause = (pause * 2).min(Duration::from_millis(20));
    }
}

fn read_back(file: &mut File) -> io::Result<String> {
    let mut bytes = Vec::new();
    file.rewind()?;
    file.take(OUTPUT_LIMIT).read_to_end(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

impl Output {
    /// Why the program did not end as it should; `None` after exit code 0.
    pub(crate) fn trouble(&self) -> Option<String> {
        match self.end {
            End::Exit(status) if status.success() => None,
            End::Exit(status) => Some(format!("ended with {status}")),
            End::TimeLimit(limit) => Some(format!(
                "was stopped at its time limit of {} s",
                limit.as_secs_f64()
            )),
            End::OutputLimit => Some(format!(
                "was stopped after {} MB of output",
                OUTPUT_LIMIT >> 20
            )),
        }
    }

    /// The last lines of both streams.
    pub(crate) fn tail(&self) -> String {
        let lines: Vec<&str> = self
            .stdout
            .lines()
            .chain(self.stderr.lines())
            .filter(|line| !line.trim().is_empty())
            .collect();
        lines[lines.len().saturating_sub(20)..].join("\n")
    }
}
