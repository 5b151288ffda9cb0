//! A proven network, compiled for execution.

use std::sync::Arc;

use kirk_network::merge::merge;
use kirk_network::precedence::Precedence;
use kirk_network::reduce::{Progress, ReduceError, Reduction, reduce, reduce_rest};
use kirk_network::stnu::TooLarge;
use kirk_network::{Conflict, Dispatchable, Network, Verdict, check, dispatchable};

/// What an execution needs: the merged network, how its news is used, and the dispatchable form.
#[derive(Clone, Debug)]
pub struct Plan {
    pub(crate) network: Arc<Network>,
    pub(crate) reduction: Reduction,
    pub(crate) net: Dispatchable,
    pub(crate) precedence: Arc<Precedence>,
}

/// Why a network cannot be executed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoPlan {
    /// It is not controllable; the conflict is in terms of the network given.
    Uncontrollable(Conflict),
    /// Its numbers are too large to compute with.
    TooLarge,
}

impl From<TooLarge> for NoPlan {
    fn from(_: TooLarge) -> NoPlan {
        NoPlan::TooLarge
    }
}

impl Plan {
    /// Merges, reduces, proves and compiles a network.
    pub fn new(network: &Network) -> Result<Plan, NoPlan> {
        let merged = merge(network).network;
        let precedence = Arc::new(Precedence::new(&merged));
        match compile(reduce(&merged), &precedence) {
            Ok(Some((reduction, net))) => Ok(Plan { network: Arc::new(merged), reduction, net, precedence }),
            // The check has the last word on both, so that a plan is refused exactly where it says so.
            Ok(None) | Err(TooLarge) => match check(network)? {
                Verdict::Uncontrollable(conflict) => Err(NoPlan::Uncontrollable(conflict)),
                Verdict::Controllable => unreachable!("a controllable network has a dispatchable form"),
            },
        }
    }

    /// What must not come before what in it.
    pub fn precedence(&self) -> &Precedence {
        &self.precedence
    }

    /// The merged network that is executed.
    pub fn network(&self) -> &Network {
        &self.network
    }
}

/// The plan for what is left of an execution, `None` if there is none.
pub(crate) fn rest(
    network: &Network,
    precedence: &Precedence,
    progress: &Progress,
) -> Option<(Reduction, Dispatchable)> {
    compile(reduce_rest(network, progress), precedence).ok().flatten()
}

fn compile(
    reduction: Result<Reduction, ReduceError>,
    precedence: &Precedence,
) -> Result<Option<(Reduction, Dispatchable)>, TooLarge> {
    match reduction {
        Err(ReduceError::TooLarge) => Err(TooLarge),
        Err(ReduceError::Never(_)) => Ok(None),
        Ok(reduction) => Ok(dispatchable(&reduction, precedence)?.map(|net| (reduction, net))),
    }
}
