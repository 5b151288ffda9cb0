//! `kirk explain CODE`: the page on a diagnostic code.

use std::io;

use crate::args::Explain;
use crate::output::{Status, complain, print};

pub(crate) fn explain(arguments: &Explain) -> io::Result<Status> {
    match kirk_compiler::explain(&arguments.code) {
        Some(page) => {
            print(&page)?;
            Ok(Status::Yes)
        }
        None => {
            complain(&format!(
                "there is no diagnostic `{}`; codes look like K0203 and stand in brackets in every message",
                arguments.code
            ));
            Ok(Status::Wrong)
        }
    }
}
