// The `kirk` to start: where it is, and whether it is one that will do. Knows nothing of the editor.
const { execFile } = require("node:child_process");
const os = require("node:os");
const path = require("node:path");

/** Why there is no kirk to start, for the user. */
class NoKirk extends Error {}

/**
 * The program the setting `kirk.path` means.
 * @param {string} setting a name to look for on the PATH, or a path that may begin with `~` or `${workspaceFolder}`
 * @param {string | undefined} workspace the folder that is open
 */
function program(setting, workspace) {
  const written = setting.trim() || "kirk";
  const inFolder = /^\$\{workspaceFolder\}[\\/]?/.exec(written);
  if (inFolder) {
    if (workspace === undefined) throw new NoKirk(`\`kirk.path\` is \`${written}\`, and no folder is open.`);
    return path.join(workspace, written.slice(inFolder[0].length));
  }
  return /^~[\\/]/.test(written) ? path.join(os.homedir(), written.slice(2)) : written;
}

/**
 * The version of a kirk that has a language server. Throws a `NoKirk` if there is none.
 * @param {string} file
 * @returns {Promise<string>} such as `0.1.0`
 */
async function version(file) {
  const said = await output(file, ["--version"]).catch((error) => {
    const reason = error.code === "ENOENT" ? "there is no such program" : error.message.trim();
    throw new NoKirk(`\`${file}\` does not start: ${reason}.`);
  });
  const found = /^kirk (\d+\.\d+\.\S+)/.exec(said);
  if (!found) throw new NoKirk(`\`${file}\` is not kirk: it says \`${said.split("\n")[0].trim()}\`.`);
  await output(file, ["lsp", "--help"]).catch(() => {
    throw new NoKirk(`\`${file}\` is kirk ${found[1]}, which has no language server yet.`);
  });
  return found[1];
}

/**
 * What a program prints.
 * @param {string} file
 * @param {string[]} args
 * @returns {Promise<string>}
 */
function output(file, args) {
  return new Promise((resolve, reject) => {
    execFile(file, args, { timeout: 10_000 }, (error, stdout) => (error ? reject(error) : resolve(stdout)));
  });
}

module.exports = { NoKirk, program, version };
