// The grammar of the colours and kirk itself agree on what is a comment, a string and a number: in every program of the project, good
// or bad, by the semantic tokens of the server.
const assert = require("node:assert");
const fs = require("node:fs");
const path = require("node:path");
const { after, before, test } = require("node:test");
const { pathToFileURL } = require("node:url");
const lsp = require("vscode-languageserver-protocol/node");
const { open, project, start } = require("./server");
const { tokenize } = require("./textmate");

/** @type {Awaited<ReturnType<typeof start>>} */
let server;

before(async () => {
  server = await start({});
});

after(() => server.leave());

/** One letter for each character of each line: of a comment, a string, a number, or of neither. */
const LETTERS = new Map(Object.entries({ comment: "c", string: "s", number: "n" }));

/**
 * What the server takes each character for.
 * @param {string} file
 * @param {string[]} lines
 */
async function byServer(file, lines) {
  const uri = pathToFileURL(file).href;
  await open(server.connection, uri, 1, lines.join("\n"));
  const answer = await server.connection.sendRequest(lsp.SemanticTokensRequest.type, { textDocument: { uri } });
  const legend = server.result.capabilities.semanticTokensProvider?.legend.tokenTypes ?? [];
  const data = answer?.data ?? [];
  const taken = lines.map((line) => [...line].map(() => "."));
  let [line, column] = [0, 0];
  for (let at = 0; at < data.length; at += 5) {
    const [lineStep, columnStep, length, type] = data.slice(at, at + 4);
    column = lineStep === 0 ? column + columnStep : columnStep;
    line += lineStep;
    const letter = LETTERS.get(legend[type]);
    // A string where a name belongs: kirk shows the name that is in it.
    const named = !letter && lines[line][column - 1] === '"' && lines[line][column + length] === '"';
    if (named) taken[line].fill("s", column - 1, column + length + 1);
    else taken[line].fill(letter ?? ".", column, column + length);
  }
  return taken.map((letters) => letters.join(""));
}

/**
 * What the grammar takes each character for.
 * @param {string[]} lines
 */
async function byGrammar(lines) {
  const tokens = await tokenize(lines);
  return lines.map((line, number) =>
    tokens[number]
      .map(({ startIndex, endIndex, scopes }) => {
        const is = (/** @type {string} */ prefix) => scopes.some((scope) => scope.startsWith(prefix));
        const letter = is("comment") ? "c" : is("string") ? "s" : is("constant.numeric") ? "n" : ".";
        return letter.repeat(Math.min(endIndex, line.length) - startIndex);
      })
      .join(""),
  );
}

test("the grammar of the colours reads as kirk does", async () => {
  let count = 0;
  for (const folder of ["examples/rmpl", "tests/rmpl/good", "tests/rmpl/bad"]) {
    for (const name of fs.readdirSync(path.join(project, folder)).filter((it) => it.endsWith(".rmpl"))) {
      // What is never closed goes on to the end for the grammar, which sees one line after the other.
      if (/^K010[34]/.test(name)) continue;
      const file = path.join(project, folder, name);
      const lines = fs.readFileSync(file, "utf8").split(/\r?\n/);
      // Blanks have no colour that can be seen.
      const shown = (/** @type {string[]} */ letters) =>
        letters.map((it, number) => [...it].map((letter, column) => (/\s/.test(lines[number][column]) ? " " : letter)).join(""));
      const [kirk, colours] = [shown(await byServer(file, lines)), shown(await byGrammar(lines))];
      for (const [number, line] of lines.entries()) {
        assert.strictEqual(colours[number], kirk[number], `${folder}/${name}:${number + 1}: ${line}`);
      }
      count += 1;
    }
  }
  assert(count > 80, `only ${count} programs`);
});
