// A `kirk lsp` to talk to: that of the environment variable KIRK, else the one that `cargo build` or `cargo test` left.
const assert = require("node:assert");
const { spawn } = require("node:child_process");
const { once } = require("node:events");
const fs = require("node:fs");
const path = require("node:path");
const lsp = require("vscode-languageserver-protocol/node");

const project = path.join(__dirname, "..", "..", "..");
const kirk = process.env.KIRK ?? path.join(project, "target", "debug", "kirk");

/**
 * Starts a server; `leave` takes leave of it.
 * @param {lsp.ClientCapabilities} capabilities
 */
async function start(capabilities) {
  assert(fs.existsSync(kirk), `${kirk} is not there: run \`cargo build\` first, or set KIRK`);
  const server = spawn(kirk, ["lsp"]);
  const connection = lsp.createProtocolConnection(server.stdout, server.stdin);
  connection.listen();
  const result = await connection.sendRequest(lsp.InitializeRequest.type, {
    processId: process.pid,
    rootUri: null,
    capabilities,
  });
  await connection.sendNotification(lsp.InitializedNotification.type, {});
  const leave = async () => {
    await connection.sendRequest(lsp.ShutdownRequest.type);
    await connection.sendNotification(lsp.ExitNotification.type);
    const [code] = await once(server, "exit");
    connection.dispose();
    assert.strictEqual(code, 0, "the server takes leave");
  };
  return { connection, result, leave };
}

/**
 * Opens a text.
 * @param {lsp.ProtocolConnection} connection
 * @param {string} uri
 * @param {number} version
 * @param {string} text
 */
function open(connection, uri, version, text) {
  const textDocument = { uri, languageId: "rmpl", version, text };
  return connection.sendNotification(lsp.DidOpenTextDocumentNotification.type, { textDocument });
}

module.exports = { open, project, start };
