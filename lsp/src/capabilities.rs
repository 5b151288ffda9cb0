//! What the client can do, and what the server can.

use lsp_types::notification::{self, Notification as _};
use lsp_types::request::{self, Request as _};
use lsp_types::{
    ClientCapabilities, CodeActionKind, CodeActionOptions, CodeActionProviderCapability, CodeLensOptions,
    CompletionOptions, DiagnosticOptions, DiagnosticServerCapabilities, ExecuteCommandOptions,
    FoldingRangeProviderCapability, HoverProviderCapability, InitializeResult, OneOf, RenameOptions,
    SemanticTokenModifier, SemanticTokensFullOptions, SemanticTokensLegend, SemanticTokensOptions,
    ServerCapabilities, ServerInfo, SignatureHelpOptions, TextDocumentSyncCapability, TextDocumentSyncKind,
    TextDocumentSyncOptions,
};

use crate::convert::legend;
use crate::lines::Encoding;

/// The command of the line above a program: says its verdict.
pub(crate) const VERDICT: &str = "kirk.verdict";

/// What the client can do.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Client {
    refresh_hints: bool,
    refresh_lenses: bool,
    snippets: bool,
    watches: bool,
    pulls: bool,
}

impl Client {
    pub(crate) fn new(capabilities: &ClientCapabilities) -> Client {
        let workspace = capabilities.workspace.as_ref();
        let hints = workspace.and_then(|it| it.inlay_hint.as_ref()).and_then(|it| it.refresh_support);
        let lenses = workspace.and_then(|it| it.code_lens.as_ref()).and_then(|it| it.refresh_support);
        let items = capabilities.text_document.as_ref().and_then(|it| it.completion.as_ref());
        let watches =
            workspace.and_then(|it| it.did_change_watched_files).and_then(|it| it.dynamic_registration);
        let snippets = items.and_then(|it| it.completion_item.as_ref()).and_then(|it| it.snippet_support);
        let text = capabilities.text_document.as_ref();
        let pulls = text.is_some_and(|it| it.diagnostic.is_some());
        // A verdict comes later: whoever is not told to ask again is told of it unasked.
        let again = workspace.and_then(|it| it.diagnostic.as_ref()).and_then(|it| it.refresh_support);
        Client {
            pulls: pulls && again == Some(true),
            refresh_hints: hints == Some(true),
            refresh_lenses: lenses == Some(true),
            snippets: snippets == Some(true),
            watches: watches == Some(true),
        }
    }

    /// True if it says when files change, if it is asked to.
    pub(crate) fn watches_files(self) -> bool {
        self.watches
    }

    /// True if it asks for what there is to say, and need not be told.
    pub(crate) fn pulls_diagnostics(self) -> bool {
        self.pulls
    }

    /// True if it takes pieces with places to fill in.
    pub(crate) fn takes_snippets(self) -> bool {
        self.snippets
    }

    /// What to ask of it when there is a new verdict.
    pub(crate) fn refreshes(self) -> impl Iterator<Item = &'static str> {
        let diagnostics = self.pulls.then_some(request::WorkspaceDiagnosticRefresh::METHOD);
        let hints = self.refresh_hints.then_some(request::InlayHintRefreshRequest::METHOD);
        let lenses = self.refresh_lenses.then_some(request::CodeLensRefresh::METHOD);
        hints.into_iter().chain(lenses).chain(diagnostics)
    }
}

/// To ask for a word when a program changes on the disk.
pub(crate) fn watchers() -> serde_json::Value {
    let globs = ["**/*.rmpl", "**/*.lisp"].map(|glob| serde_json::json!({ "globPattern": glob }));
    serde_json::json!({ "registrations": [{
        "id": "kirk-files",
        "method": notification::DidChangeWatchedFiles::METHOD,
        "registerOptions": { "watchers": globs },
    }] })
}

/// What the server can do.
pub(crate) fn initialized(encoding: Encoding) -> InitializeResult {
    let sync = TextDocumentSyncOptions {
        open_close: Some(true),
        change: Some(TextDocumentSyncKind::INCREMENTAL),
        ..TextDocumentSyncOptions::default()
    };
    InitializeResult {
        server_info: Some(ServerInfo {
            name: "kirk".to_string(),
            version: Some(env!("CARGO_PKG_VERSION").to_string()),
        }),
        capabilities: ServerCapabilities {
            position_encoding: Some(encoding.kind()),
            text_document_sync: Some(TextDocumentSyncCapability::Options(sync)),
            hover_provider: Some(HoverProviderCapability::Simple(true)),
            definition_provider: Some(OneOf::Left(true)),
            references_provider: Some(OneOf::Left(true)),
            document_highlight_provider: Some(OneOf::Left(true)),
            rename_provider: Some(OneOf::Right(RenameOptions {
                prepare_provider: Some(true),
                work_done_progress_options: Default::default(),
            })),
            document_symbol_provider: Some(OneOf::Left(true)),
            completion_provider: Some(CompletionOptions {
                trigger_characters: Some(vec!["(".to_string(), ":".to_string(), " ".to_string()]),
                ..CompletionOptions::default()
            }),
            signature_help_provider: Some(SignatureHelpOptions {
                trigger_characters: Some(vec!["(".to_string(), " ".to_string()]),
                ..SignatureHelpOptions::default()
            }),
            document_formatting_provider: Some(OneOf::Left(true)),
            document_range_formatting_provider: Some(OneOf::Left(true)),
            workspace_symbol_provider: Some(OneOf::Left(true)),
            diagnostic_provider: Some(DiagnosticServerCapabilities::Options(DiagnosticOptions {
                identifier: Some("kirk".to_string()),
                inter_file_dependencies: true,
                workspace_diagnostics: false,
                ..DiagnosticOptions::default()
            })),
            execute_command_provider: Some(ExecuteCommandOptions {
                commands: vec![VERDICT.to_string()],
                ..ExecuteCommandOptions::default()
            }),
            folding_range_provider: Some(FoldingRangeProviderCapability::Simple(true)),
            semantic_tokens_provider: Some(
                SemanticTokensOptions {
                    legend: SemanticTokensLegend {
                        token_types: legend(),
                        token_modifiers: vec![SemanticTokenModifier::DEFINITION],
                    },
                    full: Some(SemanticTokensFullOptions::Bool(true)),
                    ..SemanticTokensOptions::default()
                }
                .into(),
            ),
            code_action_provider: Some(CodeActionProviderCapability::Options(CodeActionOptions {
                code_action_kinds: Some(vec![CodeActionKind::QUICKFIX]),
                ..CodeActionOptions::default()
            })),
            inlay_hint_provider: Some(OneOf::Left(true)),
            code_lens_provider: Some(CodeLensOptions { resolve_provider: Some(false) }),
            ..ServerCapabilities::default()
        },
    }
}
