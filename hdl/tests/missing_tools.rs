//! With nothing on PATH the message says what to install. The test runs itself again with
//! another PATH, because a process must not change its own.

use std::env;
use std::process::Command;

use crate::support::Toy;
use nonius_hdl::progress::silent;
use nonius_hdl::{Options, verify};

#[test]
fn a_missing_tool_is_named_with_its_install_command() {
    if env::var_os("PATH").is_some_and(|it| it.is_empty()) {
        println!(
            "{}",
            verify(Toy::new().path(), &Options::default(), &silent).expect_err("no tools")
        );
        return;
    }
    let child = Command::new(env::current_exe().expect("this test's path"))
        .args([
            "--exact",
            "missing_tools::a_missing_tool_is_named_with_its_install_command",
        ])
        .arg("--nocapture")
        .env("PATH", "")
        .output()
        .expect("it runs");
    let said = String::from_utf8(child.stdout).expect("text");
    assert!(child.status.success(), "{said}");
    assert!(
        said.contains("`vvp` is needed to simulate the Verilog in Icarus"),
        "{said}"
    );
    assert!(
        said.contains("Install them with `apt-get install iverilog verilator g++ make`."),
        "{said}"
    );
}
