// A new line is indented as `kirk fmt` would: every line of every program that is laid out, from the text before it.
const assert = require("node:assert");
const fs = require("node:fs");
const path = require("node:path");
const { test } = require("node:test");
const { indentation } = require("../src/indent");

const project = path.join(__dirname, "..", "..", "..");

/** What `kirk fmt` makes of every form and of comments: the snapshots of its own tests. */
function formatted() {
  const folder = path.join(project, "compiler", "tests", "snapshots");
  const names = fs.readdirSync(folder).filter((name) => /^format__.*\.snap$/.test(name));
  return names.map((name) => ({ name, text: fs.readFileSync(path.join(folder, name), "utf8").split("---\n")[2] }));
}

function examples() {
  const folder = path.join(project, "examples", "rmpl");
  return fs.readdirSync(folder).map((name) => ({ name, text: fs.readFileSync(path.join(folder, name), "utf8") }));
}

for (const { name, text } of [...examples(), ...formatted()]) {
  test(`every line of ${name} is indented as it is`, () => {
    const lines = text.split("\n");
    let checked = 0;
    for (const [number, line] of lines.entries()) {
      if (line.trim() === "") continue;
      const expected = indentation(lines.slice(0, number).map((it) => it + "\n").join(""));
      if (expected === undefined) continue;
      assert.strictEqual(line.length - line.trimStart().length, expected, `line ${number + 1}: ${line}`);
      checked += 1;
    }
    assert(checked > 5, `only ${checked} lines`);
  });
}

test("in a string or a block comment nothing is changed", () => {
  for (const text of ['(a "b\n', "#| a #| b |#\n", '"']) assert.strictEqual(indentation(text), undefined, text);
  for (const text of ['(a "b\n")\n', "#| a #| b |# |#\n", '; "\n']) assert.strictEqual(indentation(text), 0, text);
});

test("half-typed text has an indentation as well", () => {
  const cases = /** @type {[string, number][]} */ ([
    ["", 0],
    [")))\n", 0],
    ["(\n", 1],
    ["'(\n", 2],
    ["(define-control-program a\n", 2],
    ["(define-control-program a (\n(define-control-program b ()\n", 2],
    ["(a '(b) 'c\n", 3],
    ["(rmpl/lang:sequence (:slack t)\r\n", 2],
    ["(let ((x 1)\n", 6],
    ["(defclass c ()\n  ((a :type t\n", 4],
  ]);
  for (const [text, expected] of cases) assert.strictEqual(indentation(text), expected, JSON.stringify(text));
});
