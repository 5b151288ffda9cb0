// The colours as VS Code has them: its own engine, with the grammar of the extension.
const assert = require("node:assert");
const fs = require("node:fs");
const path = require("node:path");
const oniguruma = require("vscode-oniguruma");
const textmate = require("vscode-textmate");

const wasm = fs.readFileSync(require.resolve("vscode-oniguruma/release/onig.wasm"));
const registry = new textmate.Registry({
  onigLib: oniguruma.loadWASM(wasm).then(() => ({
    createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
    createOnigString: (text) => new oniguruma.OnigString(text),
  })),
  loadGrammar: async () => {
    const file = path.join(__dirname, "..", "syntaxes", "rmpl.tmLanguage.json");
    return textmate.parseRawGrammar(fs.readFileSync(file, "utf8"), file);
  },
});

/**
 * The tokens of each line of a text.
 * @param {string[]} lines
 * @returns {Promise<textmate.IToken[][]>}
 */
async function tokenize(lines) {
  const grammar = await registry.loadGrammar("source.rmpl");
  assert(grammar);
  let stack = textmate.INITIAL;
  return lines.map((line) => {
    const { tokens, ruleStack } = grammar.tokenizeLine(line, stack);
    stack = ruleStack;
    return tokens;
  });
}

module.exports = { tokenize };
