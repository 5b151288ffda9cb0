//! How the plan treats the news of each contingent event, for `--verbose`.

use kirk_network::Network;
use kirk_network::news::{Treatment, treatments};

use crate::foreign::one_line;

/// One line for each contingent event. Empty if there are none.
pub(crate) fn treatment(network: &Network) -> String {
    let line =
        |Treatment { event, heard, how }| format!("  {}\n", one_line(&format!("`{event}`: {heard}; {how}")));
    treatments(network).into_iter().map(line).collect()
}
