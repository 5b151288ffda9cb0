// The colours: what each piece of a text is taken for, on small texts and on every program of the project.
const assert = require("node:assert");
const fs = require("node:fs");
const path = require("node:path");
const { test } = require("node:test");
const { tokenize } = require("./textmate");

const project = path.join(__dirname, "..", "..", "..");

/**
 * The pieces of a text that are not blank, each with its innermost scope.
 * @param {string} text
 * @returns {Promise<{text: string, scope: string, line: number}[]>}
 */
async function pieces(text) {
  const lines = text.split(/\r?\n/);
  const tokens = await tokenize(lines);
  return lines.flatMap((content, line) =>
    tokens[line].flatMap((token) => {
      const piece = content.slice(token.startIndex, token.endIndex).trim();
      const scope = token.scopes[token.scopes.length - 1].replace(/\.rmpl$/, "");
      return piece ? [{ text: piece, scope, line: line + 1 }] : [];
    }),
  );
}

/**
 * Checks what each piece of a text is taken for. What is left out does not matter.
 * @param {string} text
 * @param {Record<string, string>} expected
 */
async function check(text, expected) {
  const found = await pieces(text);
  for (const [piece, scope] of Object.entries(expected)) {
    const scopes = found.filter((it) => it.text === piece).map((it) => it.scope);
    assert(scopes.length > 0, `no piece \`${piece}\` in ${JSON.stringify(found)}`);
    assert.deepStrictEqual([...new Set(scopes)], [scope], piece);
  }
}

test("a program has a name, parameters, declarations and bounds", () =>
  check(
    `(define-control-program Scan (outcrop depth) ; comment
       "Hold it \\"still\\"."
       (declare (primitive)
         (duration (simple :lower-bound (minutes 5) :upper-bound :infinity) :contingent t)))`,
    {
      "define-control-program": "storage.type.function",
      Scan: "entity.name.function.definition",
      outcrop: "variable.parameter",
      depth: "variable.parameter",
      "; comment": "comment.line.semicolon",
      "Hold it": "string.quoted.double",
      '\\"': "constant.character.escape",
      declare: "storage.modifier",
      primitive: "storage.modifier",
      duration: "storage.modifier",
      simple: "support.type",
      ":lower-bound": "constant.other.keyword",
      minutes: "support.function.unit",
      5: "constant.numeric",
      ":infinity": "constant.language",
      t: "constant.language",
    },
  ));

test("a body has forms, calls, labels and events", () =>
  check(
    `(define-control-program main ()
       (sequence (:slack nil) (label (first i) (shower 'north)) (tools:wait (+ i 1) *limit* +day+)
         (rmpl/lang:parallel (:slack t) (eat))
         (between (end (first 2)) (start eat) (simple-temporal :lower-bound -5))))`,
    {
      sequence: "keyword.control",
      label: "keyword.control",
      "rmpl/lang:": "entity.name.namespace",
      parallel: "keyword.control",
      between: "keyword.control",
      nil: "constant.language",
      shower: "entity.name.function",
      north: "constant.other.symbol",
      tools: "entity.name.namespace",
      wait: "entity.name.function",
      "+": "keyword.operator",
      i: "variable.other",
      "*limit*": "variable.other.constant",
      "+day+": "variable.other.constant",
      end: "support.function.event",
      start: "support.function.event",
      "simple-temporal": "support.type",
      "-5": "constant.numeric",
    },
  ));

test("packages, named numbers and classes are definitions", () =>
  check(
    `(rmpl/lang:defpackage #:mission (:use #:tools))
     (in-package #:mission)
     (DefParameter *oxygen* (hours 1.5))
     (defclass glider (vehicle)
       ((location :initform "start" :type (member nil "start") :accessor place)
        (id)))
     (fly)`,
    {
      defpackage: "keyword.control.import",
      "in-package": "keyword.control.import",
      "#:mission": "entity.name.namespace",
      "#:tools": "constant.other.symbol",
      DefParameter: "storage.type.constant",
      "*oxygen*": "variable.other.constant",
      defclass: "storage.type.class",
      glider: "entity.name.type.class",
      vehicle: "entity.other.inherited-class",
      location: "variable.other.member",
      id: "variable.other.member",
      ":accessor": "constant.other.keyword",
      member: "keyword.operator",
      place: "variable.other",
      fly: "entity.name.function",
    },
  ));

test("numbers are numbers and what only begins like one is a name", async () => {
  for (const number of ["15", "15.", "-1.5", "+2", ".5", "1/2", "1e3", "1d0", "1E-3", "2.5f+1"]) {
    await check(`(delay ${number})`, { [number]: "constant.numeric" });
  }
  for (const name of ["1a", "5min", "1/2/3", "1e", "a1", "..", "traverse/0-0", "x#2"]) {
    await check(`(delay ${name})`, { [name]: "variable.other" });
  }
  await check("(dotimes (i 3) (leg (1+ i)))", { "1+": "keyword.operator", leg: "entity.name.function" });
});

test("block comments nest, over several lines", async () => {
  const found = await pieces('(a) #| one #| two\n (sequence "|# still\n |# (eat)');
  const inside = found.filter((it) => it.line === 2 || it.text.includes("one"));
  assert(inside.every((it) => it.scope === "comment.block"), JSON.stringify(inside));
  assert.deepStrictEqual(found.at(-2), { text: "eat", scope: "entity.name.function", line: 3 });
});

test("what kirk does not read is marked", async () => {
  for (const text of ["`", ",", "[", "}", "|odd name|", "#'f", "\\"]) {
    await check(`(eat) ${text}`, { [text]: "invalid.illegal" });
  }
});

test("a definition in the first column is coloured whatever is open before it", () =>
  check("(define-control-program half-typed (a\n(defclass rover ((speed\n(define-control-program main (x)\n  (eat))", {
    "half-typed": "entity.name.function.definition",
    a: "variable.parameter",
    rover: "entity.name.type.class",
    speed: "variable.other.member",
    main: "entity.name.function.definition",
    x: "variable.parameter",
    eat: "entity.name.function",
  }));

test("every example of the grammar has the colour of its kind", async () => {
  const readme = fs.readFileSync(path.join(project, "grammar", "README.md"), "utf8");
  const table = readme.slice(readme.indexOf("## Top level"));
  const rows = table.split("\n").filter((line) => line.startsWith("| ") && line.includes("`"));
  assert(rows.length > 20, `only ${rows.length} rows`);
  for (const row of rows) {
    const [, what, examples] = row.split("|").map((cell) => cell.trim());
    for (const [, example] of examples.matchAll(/`(\([^`]*\))`/g)) {
      const head = (await pieces(example)).find((it) => !/^[()]+$/.test(it.text));
      assert(head);
      const call = /^entity.name.(function|namespace)$/.test(head.scope);
      assert.strictEqual(call, what === "call", `${what}: ${example}: ${head.scope}`);
    }
  }
});

test("in no program that kirk reads is anything marked as wrong", async () => {
  let count = 0;
  for (const folder of ["examples/rmpl", "tests/rmpl/good"]) {
    for (const name of fs.readdirSync(path.join(project, folder)).filter((it) => it.endsWith(".rmpl"))) {
      const text = fs.readFileSync(path.join(project, folder, name), "utf8");
      const found = await pieces(text);
      const wrong = found.filter((it) => it.scope.startsWith("invalid"));
      assert.deepStrictEqual(wrong, [], name);
      const defined = found.filter((it) => it.scope === "entity.name.function.definition").length;
      const code = text.replace(/;.*/g, "").replace(/#\|[^]*?\|#/g, "");
      assert.strictEqual(defined, code.match(/\((?:rmpl\/lang:)?define-control-program\s/gi)?.length ?? 0, name);
      count += 1;
    }
  }
  assert(count > 15, `only ${count} programs`);
});
