//! `kirk generate`: a random network of a family, for experiments and benchmarks.

use std::io;

use kirk_network::generate::{
    Bounds, Exponential, GenerateError, Lambda, LaneOptions, Link, MOST_ATTEMPTS, RepeaterOptions,
    SamplingOptions, controllable, lanes, repeaters, sampling,
};
use kirk_network::{Network, json};

use crate::args::{BoundsKind, Common, Family, Generate, JsonOrRmpl, LinkKind, Size};
use crate::compile::program;
use crate::output::{Status, complain, deliver, remark};

pub(crate) fn generate(arguments: &Generate, common: &Common) -> io::Result<Status> {
    let size = arguments.family.size();
    let network = match make(&arguments.family, size.seed) {
        Err(error) => {
            complain(&error.to_string());
            return Ok(Status::Wrong);
        }
        Ok(network) if !size.controllable => network,
        Ok(_) => match controllable(|seed| make(&arguments.family, seed), size.seed) {
            Ok(Some((seed, network))) => {
                if !common.quiet {
                    let tried = seed.wrapping_sub(size.seed).wrapping_add(1);
                    let plural = if tried == 1 { "" } else { "s" };
                    remark(&format!("seed {seed} gives a controllable network ({tried} seed{plural} tried)"));
                }
                network
            }
            Ok(None) => {
                complain(&format!(
                    "none of the {MOST_ATTEMPTS} seeds from {} on gives a controllable network; fewer agents or tasks, \
                     or shorter delays, make one likelier",
                    size.seed
                ));
                return Ok(Status::No);
            }
            Err(error) => {
                complain(&error.to_string());
                return Ok(Status::Wrong);
            }
        },
    };
    let text = match size.format {
        JsonOrRmpl::Json => json::write(&network) + "\n",
        JsonOrRmpl::Rmpl => program(&network),
    };
    deliver(&text, size.output.as_deref())
}

fn make(family: &Family, seed: u64) -> Result<Network, GenerateError> {
    let Size { agents, tasks, .. } = *family.size();
    let mean = |lambda| Exponential { lambda, lambda_is: Lambda::Mean };
    match family {
        Family::Repeaters { lambda, clean_up, clean_up_at_end, spare, bounds, .. } => {
            let options = RepeaterOptions {
                delay: mean(*lambda),
                last_link: link(*clean_up),
                clean_up_at_end: *clean_up_at_end,
                spare: *spare,
                bounds: match bounds {
                    BoundsKind::Tables => Bounds::Tables,
                    BoundsKind::Text => Bounds::Text,
                },
            };
            repeaters(agents, tasks, seed, &options)
        }
        Family::Sampling { lambda, traverse, .. } => {
            let options = SamplingOptions {
                scan_delay: mean(*lambda),
                message_delay: mean(*lambda),
                traverse: link(*traverse),
            };
            sampling(agents, tasks, seed, &options)
        }
        Family::Lanes { links, cross, slack, delay, .. } => {
            let options = LaneOptions { links: *links, cross: *cross, slack: *slack, delay: *delay };
            lanes(agents, tasks, seed, &options)
        }
    }
}

fn link(kind: LinkKind) -> Link {
    match kind {
        LinkKind::Requirement => Link::Requirement,
        LinkKind::Contingent => Link::Contingent,
    }
}

impl Family {
    fn size(&self) -> &Size {
        match self {
            Family::Repeaters { size, .. } | Family::Sampling { size, .. } | Family::Lanes { size, .. } => {
                size
            }
        }
    }
}
