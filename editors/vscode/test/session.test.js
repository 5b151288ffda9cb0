// A session with `kirk lsp` over the protocol, as the extension's client has it: every feature once, on the examples.
const assert = require("node:assert");
const fs = require("node:fs");
const path = require("node:path");
const { after, before, test } = require("node:test");
const { pathToFileURL } = require("node:url");
const lsp = require("vscode-languageserver-protocol/node");
const { open, project, start } = require("./server");

const late = path.join(project, "examples", "rmpl", "too-late.rmpl");

/** @type {Awaited<ReturnType<typeof start>>} */
let server;
/** @type {lsp.ProtocolConnection} */
let connection;
/** What was published of each document, the newest last. @type {lsp.PublishDiagnosticsParams[]} */
const published = [];
let heard = () => {};
let version = 0;

before(async () => {
  server = await start({ textDocument: { publishDiagnostics: { relatedInformation: true, versionSupport: true } } });
  connection = server.connection;
  connection.onNotification(lsp.PublishDiagnosticsNotification.type, (params) => {
    published.push(params);
    heard();
  });
  assert.strictEqual(server.result.serverInfo?.name, "kirk");
});

after(() => server.leave());

/**
 * The diagnostics of a document as soon as they are as wanted.
 * @param {string} uri
 * @param {(diagnostics: lsp.Diagnostic[]) => boolean} wanted
 */
async function diagnostics(uri, wanted) {
  for (;;) {
    const newest = published.filter((it) => it.uri === uri).at(-1);
    if (newest && newest.version === version && wanted(newest.diagnostics)) return newest.diagnostics;
    await new Promise((resolve, reject) => {
      const timer = setTimeout(() => reject(new Error(`still ${JSON.stringify(newest)}`)), 20_000);
      heard = () => resolve(clearTimeout(timer));
    });
  }
}

/**
 * Opens a text under a name, or changes it.
 * @param {string} uri
 * @param {string} text
 */
async function show(uri, text) {
  version += 1;
  if (published.some((it) => it.uri === uri)) {
    await connection.sendNotification(lsp.DidChangeTextDocumentNotification.type, {
      textDocument: { uri, version },
      contentChanges: [{ text }],
    });
  } else {
    await open(connection, uri, version, text);
  }
}

const uri = pathToFileURL(late).href;
const text = fs.readFileSync(late, "utf8");

/**
 * Where a piece of the text stands, one character in.
 * @param {string} piece
 * @param {number} [offset] further in
 */
function at(piece, offset = 1) {
  assert(text.includes(piece), piece);
  const lines = text.slice(0, text.indexOf(piece) + offset).split("\n");
  return { textDocument: { uri }, position: { line: lines.length - 1, character: lines[lines.length - 1].length } };
}

test("a mission that cannot be promised is an error at `main`, with the lines to blame", async () => {
  await show(uri, text);
  const [error] = await diagnostics(uri, (it) => it.length > 0);
  assert.strictEqual(error.code, "K0601");
  assert.match(String(error.message), /^`main` cannot be executed in every case: these bounds do not go together/);
  assert.deepStrictEqual(error.range.start, { line: 20, character: 24 });
  const lines = error.relatedInformation?.map((it) => it.location.range.start.line + 1).sort();
  assert.deepStrictEqual(lines, [14, 19, 24]);
});

test("hover tells what a program is", async () => {
  const hover = await connection.sendRequest(lsp.HoverRequest.type, at("(stow)))"));
  assert.match(JSON.stringify(hover?.contents), /10/);
});

test("the definition and the uses of a program are found", async () => {
  const definition = /** @type {lsp.Location[]} */ (await connection.sendRequest(lsp.DefinitionRequest.type, at("(scan)\n")));
  assert.deepStrictEqual([definition].flat().map((it) => it.range.start.line), [10]);
  const uses = await connection.sendRequest(lsp.ReferencesRequest.type, { ...at("(scan)\n"), context: { includeDeclaration: true } });
  assert.deepStrictEqual(uses?.map((it) => it.range.start.line).sort((a, b) => a - b), [10, 22]);
});

test("a program is renamed wherever it is named", async () => {
  const edit = await connection.sendRequest(lsp.RenameRequest.type, { ...at("(scan)\n"), newName: "look" });
  assert(edit);
  const edits = edit.changes?.[uri] ?? edit.documentChanges?.flatMap((it) => ("edits" in it ? it.edits : [])) ?? [];
  const lines = edits.map((it) => `${it.range.start.line} ${"newText" in it ? it.newText : ""}`).sort();
  assert.deepStrictEqual(lines, ["10 look", "22 look"]);
});

test("completion offers forms and programs", async () => {
  const answer = await connection.sendRequest(lsp.CompletionRequest.type, at("(stow)))", 2));
  const labels = (Array.isArray(answer) ? answer : (answer?.items ?? [])).map((it) => it.label);
  for (const label of ["stow", "scan", "sequence"]) assert(labels.includes(label), `${label} in ${labels}`);
});

test("the outline has the programs", async () => {
  const symbols = await connection.sendRequest(lsp.DocumentSymbolRequest.type, { textDocument: { uri } });
  assert.deepStrictEqual(symbols?.map((it) => it.name), ["scan", "stow", "main"]);
});

test("formatting lays out as `kirk fmt`", async () => {
  const options = { tabSize: 8, insertSpaces: false };
  const none = await connection.sendRequest(lsp.DocumentFormattingRequest.type, { textDocument: { uri }, options });
  assert.deepStrictEqual(none ?? [], []);
  await show(uri, text.replaceAll("\n  ", "\n"));
  const edits = await connection.sendRequest(lsp.DocumentFormattingRequest.type, { textDocument: { uri }, options });
  assert.strictEqual(apply(text.replaceAll("\n  ", "\n"), edits ?? []), text);
});

test("what is put right is no longer shown", async () => {
  await show(uri, text.replace(":upper-bound 20)\n", ":upper-bound 25)\n"));
  assert.deepStrictEqual(await diagnostics(uri, (it) => it.length === 0), []);
});

test("a program that is only half typed gets its messages and every other answer", async () => {
  await show(uri, text.replace("(scan)\n", "(scann\n"));
  const [error] = await diagnostics(uri, (it) => it.length > 0);
  assert.strictEqual(error.code, "K0101");
  assert.match(JSON.stringify(error), /the form `\(scann` is never closed/);
  await connection.sendRequest(lsp.HoverRequest.type, at("scan"));
});

/**
 * A text after edits, none of which overlap.
 * @param {string} before
 * @param {lsp.TextEdit[]} edits
 */
function apply(before, edits) {
  const lines = before.split("\n");
  const offset = (/** @type {lsp.Position} */ it) =>
    lines.slice(0, it.line).reduce((sum, line) => sum + line.length + 1, 0) + it.character;
  const last = [...edits].sort((a, b) => offset(b.range.start) - offset(a.range.start));
  return last.reduce((now, it) => now.slice(0, offset(it.range.start)) + it.newText + now.slice(offset(it.range.end)), before);
}
