// Which kirk is started, and what is said if there is none.
const assert = require("node:assert");
const fs = require("node:fs");
const os = require("node:os");
const path = require("node:path");
const { test } = require("node:test");
const { NoKirk, program, version } = require("../src/kirk");

test("the setting may be a name or a path, in the home or the workspace", () => {
  assert.strictEqual(program("kirk", undefined), "kirk");
  assert.strictEqual(program(" ", undefined), "kirk");
  assert.strictEqual(program("/opt/kirk/bin/kirk", "/missions"), "/opt/kirk/bin/kirk");
  assert.strictEqual(program("~/bin/kirk", undefined), path.join(os.homedir(), "bin", "kirk"));
  assert.strictEqual(program("${workspaceFolder}/target/release/kirk", "/missions"), "/missions/target/release/kirk");
  assert.throws(() => program("${workspaceFolder}/kirk", undefined), /no folder is open/);
});

test("a kirk with a language server has a version, anything else has a reason", async () => {
  const folder = fs.mkdtempSync(path.join(os.tmpdir(), "kirk-"));
  /** @param {string} name @param {string} script */
  const fake = (name, script) => {
    const file = path.join(folder, name);
    fs.writeFileSync(file, `#!/bin/sh\n${script}\n`, { mode: 0o755 });
    return file;
  };
  /** @param {string} file @param {RegExp} reason */
  const refused = (file, reason) => assert.rejects(version(file), (error) => error instanceof NoKirk && reason.test(error.message));

  assert.strictEqual(await version(fake("good", "echo kirk 0.1.0")), "0.1.0");
  await refused(path.join(folder, "nowhere"), /nowhere` does not start: there is no such program\.$/);
  await refused(fake("other", "echo Kirk of Starfleet"), /is not kirk: it says `Kirk of Starfleet`/);
  await refused(fake("old", 'test "$1" = --version && echo kirk 0.0.1'), /is kirk 0\.0\.1, which has no language server yet/);
  await refused(fake("broken", "exit 3"), /does not start/);
  fs.rmSync(folder, { recursive: true });
});
