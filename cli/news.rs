//! How the plan treats the news of each contingent event, for `--verbose`.

use kirk_network::Network;
use kirk_network::news::{Treatment, treatments};

/// One line for each contingent event. Empty if there are none.
pub(crate) fn treatment(network: &Network) -> String {
    let line = |Treatment { event, heard, how }| format!("  `{event}`: {heard}; {how}\n");
    treatments(network).into_iter().map(line).collect()
}
