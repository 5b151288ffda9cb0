// What the extension contributes is there, in the package as well, and in agreement with the code.
const assert = require("node:assert");
const { execFileSync } = require("node:child_process");
const fs = require("node:fs");
const path = require("node:path");
const { test } = require("node:test");

const home = path.join(__dirname, "..");
/** @param {string} name */
const read = (name) => fs.readFileSync(path.join(home, name), "utf8");
const manifest = JSON.parse(read("package.json"));
const { contributes } = manifest;

/** @type {string[]} */
const contributed = [
  manifest.main,
  manifest.icon,
  ...contributes.languages.map((/** @type {any} */ it) => it.configuration),
  ...contributes.grammars.map((/** @type {any} */ it) => it.path),
  ...contributes.snippets.map((/** @type {any} */ it) => it.path),
].map((file) => path.posix.normalize(file));

test("the package has every file that is contributed, and no others than these and its texts", () => {
  const listed = execFileSync(process.execPath, ["node_modules/@vscode/vsce/vsce", "ls", "--no-dependencies"], {
    cwd: home,
    encoding: "utf8",
  });
  const packaged = listed.split("\n").filter((line) => /^[\w./-]+$/.test(line) && fs.existsSync(path.join(home, line)));
  assert.deepStrictEqual(packaged.sort(), [...contributed, "LICENSE", "README.md", "dist/LICENSES.txt", "package.json"].sort());
});

test("the licence of every package that is in the extension is with it", () => {
  const licences = read("dist/LICENSES.txt");
  for (const name of ["vscode-languageclient", "vscode-jsonrpc", "semver"]) assert.match(licences, new RegExp(`^${name} \\d`, "m"));
});

test("every file of the configuration is JSON", () => {
  const files = contributed.filter((file) => file.endsWith(".json"));
  assert.strictEqual(files.length, 3);
  for (const file of files) JSON.parse(read(file));
});

test("every command that is offered is registered, and every setting that is offered is read", () => {
  const code = read("src/extension.js");
  const registered = [...code.matchAll(/registerCommand\("([^"]+)"/g)].map((it) => it[1]);
  const offered = contributes.commands.map((/** @type {any} */ it) => it.command);
  assert.deepStrictEqual(registered.sort(), offered.sort());
  // `<id>.trace.server` is read by the language client of that id.
  assert.deepStrictEqual(Object.keys(contributes.configuration.properties), ["kirk.path", "kirk.trace.server"]);
  assert.match(code, /getConfiguration\("kirk"\)\.get\("path"/);
  assert.match(code, /new LanguageClient\(\s*"kirk"/);
});

test("the versions of the extension and of kirk are the same", () => {
  const cargo = fs.readFileSync(path.join(home, "..", "..", "Cargo.toml"), "utf8");
  assert.strictEqual(manifest.version, /\[workspace\.package\]\s+version = "([^"]+)"/.exec(cargo)?.[1]);
});

test("the language configuration is that of the language", () => {
  const configuration = JSON.parse(read("language-configuration.json"));
  const word = new RegExp(configuration.wordPattern, "g");
  const words = "(robot-drilling 'north :lower-bound *x* tools:wait #:p \"a b\") ; c".match(word);
  assert.deepStrictEqual(words, ["robot-drilling", "north", ":lower-bound", "*x*", "tools:wait", "#:p", "a", "b", "c"]);
  const [comment] = configuration.onEnterRules;
  assert.match(";; where the text", new RegExp(comment.beforeText));
  assert.doesNotMatch("(shower) ;; cold", new RegExp(comment.beforeText));
});
