// The extension: starts `kirk lsp` for RMPL files, and has the commands that are not the server's.
const vscode = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");
const { indentation } = require("./indent");
const { NoKirk, program, version } = require("./kirk");

const INSTALL = "How to install kirk";
const SETTINGS = "Open Settings";
const MANUAL = "In a terminal, in the folder of kirk's source: `cargo install --path .` puts `kirk` on your path.";

/** @type {LanguageClient | undefined} */
let client;
/** The start or stop under way; the next one waits for it. */
let turn = Promise.resolve();

/** @param {vscode.ExtensionContext} context */
function activate(context) {
  const log = vscode.window.createOutputChannel("kirk", { log: true });
  const restart = () => (turn = turn.then(stop).then(() => start(log)));
  context.subscriptions.push(
    log,
    vscode.commands.registerCommand("kirk.restart", restart),
    vscode.commands.registerCommand("kirk.check", () => inTerminal("check", [])),
    vscode.commands.registerCommand("kirk.simulate", () => inTerminal("run", ["--simulate"])),
    vscode.languages.registerOnTypeFormattingEditProvider({ language: "rmpl" }, { provideOnTypeFormattingEdits }, "\n"),
    vscode.workspace.onDidChangeConfiguration((change) => change.affectsConfiguration("kirk.path") && restart()),
  );
  return restart();
}

function deactivate() {
  return (turn = turn.then(stop));
}

/**
 * Starts the server; if that cannot be, says so and what to do.
 * @param {vscode.LogOutputChannel} log
 */
async function start(log) {
  try {
    const command = configured();
    log.info(`kirk ${await version(command)} at ${command}`);
    client = new LanguageClient(
      "kirk",
      "kirk",
      { command, args: ["lsp"] },
      {
        documentSelector: [
          { scheme: "file", language: "rmpl" },
          { scheme: "untitled", language: "rmpl" },
        ],
        outputChannel: log,
      },
    );
    await client.start();
  } catch (error) {
    const why = error instanceof NoKirk ? error.message : `The language server does not start: ${error}`;
    log.error(why);
    // Not awaited: the message may stay for long, and a restart must not wait for it.
    vscode.window.showErrorMessage(`kirk: ${why}`, INSTALL, SETTINGS).then((choice) => {
      if (choice === SETTINGS) vscode.commands.executeCommand("workbench.action.openSettings", "kirk.path");
      if (choice === INSTALL) vscode.window.showInformationMessage(MANUAL, { modal: true });
    });
  }
}

async function stop() {
  const running = client;
  client = undefined;
  // One that has died or never started cannot be stopped: all that matters is that it does not come back.
  await running?.dispose().catch(() => {});
}

/** The kirk of the settings. */
function configured() {
  const setting = vscode.workspace.getConfiguration("kirk").get("path", "kirk");
  return program(setting, vscode.workspace.workspaceFolders?.[0]?.uri.fsPath);
}

/**
 * Runs kirk on the file that is shown, as a task: no shell reads its name.
 * @param {string} command
 * @param {string[]} options
 */
async function inTerminal(command, options) {
  const document = vscode.window.activeTextEditor?.document;
  if (document?.languageId !== "rmpl") {
    vscode.window.showInformationMessage("kirk: open an RMPL file first.");
    return;
  }
  if (document.isUntitled || !(await document.save())) {
    vscode.window.showInformationMessage("kirk: save the file first.");
    return;
  }
  try {
    const args = [command, document.uri.fsPath, ...options];
    const folder = vscode.workspace.getWorkspaceFolder(document.uri);
    const task = new vscode.Task(
      { type: "kirk", command },
      folder ?? vscode.TaskScope.Workspace,
      `${command} ${vscode.workspace.asRelativePath(document.uri)}`,
      "kirk",
      new vscode.ProcessExecution(configured(), args),
    );
    task.presentationOptions = { clear: true, focus: false };
    await vscode.tasks.executeTask(task);
  } catch (error) {
    vscode.window.showErrorMessage(`kirk: ${error instanceof Error ? error.message : error}`);
  }
}

/**
 * Indents the line that has just been begun.
 * @param {vscode.TextDocument} document
 * @param {vscode.Position} position
 */
function provideOnTypeFormattingEdits(document, position) {
  const line = document.lineAt(position.line);
  const columns = indentation(document.getText(new vscode.Range(0, 0, position.line, 0)));
  const blank = line.text.slice(0, line.firstNonWhitespaceCharacterIndex);
  if (columns === undefined || blank === " ".repeat(columns)) return [];
  return [vscode.TextEdit.replace(new vscode.Range(position.line, 0, position.line, blank.length), " ".repeat(columns))];
}

module.exports = { activate, deactivate };
