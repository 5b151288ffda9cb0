//! `kirk compile`: prints a stage of the compilation.

use std::io;

use clap::ValueEnum;
use kirk_compiler::{self as compiler, Compilation, Severity, Source, Span, to_sexpr, too_large};
use kirk_network::dispatchable::dispatchable;
use kirk_network::merge::merge;
use kirk_network::precedence::Precedence;
use kirk_network::reduce::{ReduceError, reduce};
use kirk_network::{Network, graphml, json, rmpl, text};
use serde::Serialize;

use crate::args::{Common, Compile, Stage, StageFormat};
use crate::foreign::visible;
use crate::input::{Loaded, load_all};
use crate::json::line;
use crate::judge::judge;
use crate::output::{Status, complain, deliver, remark};
use crate::report::Reporter;
use crate::team;

pub(crate) fn compile(arguments: &Compile, common: &Common) -> io::Result<Status> {
    let mut input = load_all(&arguments.files, &arguments.selection);
    let emitted = emit(arguments, &mut input);
    Reporter::new(&input.sources).show(&input.diagnostics, common)?;
    let text = match emitted {
        Ok(text) => {
            if let (Some(written), None, false) = (input.team(), &arguments.agent, common.quiet) {
                remark(&team::what_else(written));
            }
            text
        }
        Err(Refusal::Input) => return Ok(Status::Wrong),
        Err(Refusal::NotControllable) => return Ok(Status::No),
        Err(Refusal::Options(message)) => {
            complain(&message);
            return Ok(Status::Wrong);
        }
    };
    match (arguments.format, &arguments.output) {
        (StageFormat::Text, None) => deliver(&visible(&text), None),
        (_, output) => deliver(&text, output.as_deref()),
    }
}

/// Why nothing was emitted.
pub(crate) enum Refusal {
    /// The diagnostics say why.
    Input,
    /// The diagnostics say why: there is nothing to execute.
    NotControllable,
    /// The options do not go together.
    Options(String),
}

fn emit(arguments: &Compile, input: &mut Loaded) -> Result<String, Refusal> {
    match &arguments.agent {
        Some(agent) => emit_view(arguments, input, agent),
        None if input.team().is_some() => emit_team(arguments, input),
        None => match arguments.emit {
            Stage::Ast | Stage::Episodes => emit_program(arguments, input),
            _ => {
                let Some(network) = input.network.clone() else { return Err(Refusal::Input) };
                emit_stage(arguments, &network, input)
            }
        },
    }
}

/// What one agent executes: a network, or the program that it is.
fn emit_view(arguments: &Compile, input: &mut Loaded, agent: &str) -> Result<String, Refusal> {
    if input.network.is_none() {
        return Err(Refusal::Input);
    }
    let view = team::view(input, agent)?;
    match arguments.emit {
        Stage::Ast | Stage::Episodes => {
            let source = Source::new(agent, program(&view));
            emit_compilation(&compiler::compile(&[source], &compiler::Options::default()), arguments)
        }
        _ => emit_stage(arguments, &view, input),
    }
}

/// The whole team: what each agent executes is asked for by its name.
fn emit_team(arguments: &Compile, input: &mut Loaded) -> Result<String, Refusal> {
    match arguments.emit {
        Stage::Ast | Stage::Episodes => return emit_program(arguments, input),
        Stage::Stnu => {}
        stage => input.for_one_alone(&format!("`--emit {}`", word(stage))),
    }
    let (Some(network), Some(written)) = (&input.network, input.team()) else { return Err(Refusal::Input) };
    match arguments.format {
        StageFormat::Json => document(&team::NetworkJson::new(written, network)),
        _ => emit_network(&merge(network).network, arguments),
    }
}

/// A network as a program, laid out.
pub(crate) fn program(network: &Network) -> String {
    let text = rmpl::write(network);
    compiler::format(&text).unwrap_or(text)
}

fn emit_stage(arguments: &Compile, network: &Network, input: &mut Loaded) -> Result<String, Refusal> {
    let format = arguments.format;
    if arguments.emit == Stage::Rmpl {
        let is_text = format == StageFormat::Text;
        return if is_text { Ok(program(network)) } else { Err(no_such(arguments)) };
    }
    let merged = merge(network).network;
    if arguments.emit == Stage::Stnu {
        return emit_network(&merged, arguments);
    }
    let reduction = match reduce(&merged) {
        Ok(reduction) => reduction,
        Err(ReduceError::TooLarge) => {
            input.diagnostics.push(too_large(Span::default()));
            return Err(Refusal::Input);
        }
        Err(ReduceError::Never(_)) => {
            judge(input);
            return Err(Refusal::NotControllable);
        }
    };
    if arguments.emit == Stage::Reduced {
        return emit_network(&reduction.to_network(&merged), arguments);
    }
    let net = match dispatchable(&reduction, &Precedence::new(&merged)) {
        Ok(Some(net)) => net,
        Ok(None) => {
            judge(input);
            return Err(Refusal::NotControllable);
        }
        Err(_) => {
            input.diagnostics.push(too_large(Span::default()));
            return Err(Refusal::Input);
        }
    };
    let labels = reduction.labels(&merged);
    let label = |node: u32| labels[node as usize].clone();
    match format {
        StageFormat::Text => Ok(text::dispatchable(&net, label)),
        StageFormat::Json => Ok(json::write_dispatchable(&net, merged.name(), label) + "\n"),
        StageFormat::Sexpr => sexpr_of_json(&json::write_dispatchable(&net, merged.name(), label)),
        StageFormat::Dot => Ok(kirk_network::dot::dispatchable(&net, label)),
        StageFormat::Graphml => Err(no_such(arguments)),
    }
}

fn emit_program(arguments: &Compile, input: &Loaded) -> Result<String, Refusal> {
    let Some(compilation) = input.compilation() else {
        if input.network.is_none() {
            return Err(Refusal::Input);
        }
        let stage = word(arguments.emit);
        return Err(Refusal::Options(format!(
            "`{}` is a network; it has no {stage}. Stages of a network: stnu, reduced, dispatchable",
            arguments.files.join(" ")
        )));
    };
    if input.diagnostics.iter().any(|diagnostic| diagnostic.severity == Severity::Error) {
        return Err(Refusal::Input);
    }
    emit_compilation(compilation, arguments)
}

fn emit_compilation(compilation: &Compilation, arguments: &Compile) -> Result<String, Refusal> {
    match (arguments.emit, &compilation.episodes) {
        (Stage::Ast, _) => emit_serialized(&compilation.ast, arguments),
        (_, Some(episodes)) => emit_serialized(episodes, arguments),
        (_, None) => Err(Refusal::Input),
    }
}

fn emit_serialized(value: &impl Serialize, arguments: &Compile) -> Result<String, Refusal> {
    match arguments.format {
        // The program is Lisp: its text is an s-expression.
        StageFormat::Text | StageFormat::Sexpr => sexpr(value),
        StageFormat::Json => document(value),
        StageFormat::Dot | StageFormat::Graphml => Err(no_such(arguments)),
    }
}

fn emit_network(network: &Network, arguments: &Compile) -> Result<String, Refusal> {
    match arguments.format {
        StageFormat::Text => Ok(text::network(network)),
        StageFormat::Json => Ok(json::write(network) + "\n"),
        StageFormat::Sexpr => sexpr_of_json(&json::write(network)),
        StageFormat::Dot => Ok(kirk_network::dot::network(network)),
        StageFormat::Graphml => {
            let all = |errors: Vec<_>| errors.iter().map(|e| format!("{e}")).collect::<Vec<_>>().join("\n");
            graphml::write(network).map_err(|errors: Vec<graphml::WriteError>| Refusal::Options(all(errors)))
        }
    }
}

fn document(value: &impl Serialize) -> Result<String, Refusal> {
    line(value).map_err(|error| Refusal::Options(format!("cannot write this as JSON: {error}")))
}

fn sexpr(value: &impl Serialize) -> Result<String, Refusal> {
    to_sexpr(value)
        .map(|text| text + "\n")
        .map_err(|error| Refusal::Options(format!("cannot write this as an s-expression: {error}")))
}

fn sexpr_of_json(text: &str) -> Result<String, Refusal> {
    let value: serde_json::Value =
        serde_json::from_str(text).map_err(|error| Refusal::Options(error.to_string()))?;
    sexpr(&value)
}

fn no_such(arguments: &Compile) -> Refusal {
    let others = match arguments.emit {
        Stage::Rmpl => "text",
        Stage::Dispatchable => "text, json, sexpr or dot",
        _ => "text, json or sexpr",
    };
    Refusal::Options(format!(
        "--emit {} cannot be written as {}; try {others}",
        word(arguments.emit),
        word(arguments.format)
    ))
}

/// What a choice is called on the command line.
fn word(choice: impl ValueEnum) -> String {
    choice.to_possible_value().map_or(String::new(), |value| value.get_name().to_string())
}
