//! The command `nonius`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(nonius::run(std::env::args_os()))
}
