// How far a new line is indented: the layout of `kirk fmt`, known before the line is written. The rules are those of
// compiler/src/format/rules.rs, and the tests hold them to every program of the project.

/** Further to the right than this nothing is aligned. */
const RIGHTMOST = 60;

/** What has a body, which stands two columns in. The arguments of all else stand below the first one. */
const BODIES = new Set([
  "define-control-program",
  "define-team",
  "defparameter",
  "defconstant",
  "defclass",
  "defpackage",
  "declare",
  "sequence",
  "parallel",
  "with-temporal-constraint",
  "dotimes",
  "let",
  "let*",
  "label",
  "between",
  "with-agent",
  "duration",
]);

const TOKEN = /\s+|;.*|#\||"(?:\\[^]|[^"\\])*("?)|[()']|[^\s()"';]+/y;

/**
 * A list that is open.
 * @typedef {object} List
 * @property {number} line the offset at which its line begins
 * @property {number} column where its parenthesis stands
 * @property {boolean} data true for the slots of a class, each slot, and the names of a `let`
 * @property {string} operator in lower case and without its package; empty if it does not begin with a name
 * @property {number} parts how many are in it
 * @property {number} [align] where the first argument stands, if on the line of the operator
 */

/**
 * How many columns the line after `text` is indented; undefined within a string or a block comment, where kirk changes nothing.
 * @param {string} text everything before the line
 * @returns {number | undefined}
 */
function indentation(text) {
  const open = openLists(text);
  const list = open?.at(-1);
  if (!list) return open && 0;
  if (list.data || list.parts === 0 || !list.operator) return list.column + 1;
  // The second event stands below the first.
  const aligned = !BODIES.has(list.operator) || (list.operator === "between" && list.parts < 3);
  return aligned && list.align !== undefined && list.align <= RIGHTMOST ? list.align : list.column + 2;
}

/**
 * The lists that are open at the end of a text, the outermost first; undefined if it ends in a string or a block comment.
 * @param {string} text
 * @returns {List[] | undefined}
 */
function openLists(text) {
  /** @type {List[]} */
  let open = [];
  /** @type {number | undefined} */
  let quote;
  TOKEN.lastIndex = 0;
  for (let match = TOKEN.exec(text); match; match = TOKEN.exec(text)) {
    const [token, closed] = match;
    if (token === "#|") {
      const end = blockCommentEnd(text, match.index);
      if (end === undefined) return undefined;
      TOKEN.lastIndex = end;
      continue;
    }
    if (/^[\s;]/.test(token)) continue;
    if (closed === "") return undefined;
    if (token === ")") {
      open.pop();
      continue;
    }
    const start = quote ?? match.index;
    const line = text.lastIndexOf("\n", start - 1) + 1;
    quote = token === "'" ? start : undefined;
    if (quote !== undefined) continue;
    // A definition in the first column ends whatever was left open before it.
    if (token === "(" && match.index === line) open = [];
    const list = open.at(-1);
    const data = list !== undefined && isData(list);
    if (list) {
      if (list.parts === 0 && !/^[("':#]/.test(token)) list.operator = token.replace(/^.*:/, "").toLowerCase();
      if (list.parts === 1 && line === list.line) list.align = start - line;
      list.parts += 1;
    }
    if (token === "(") open.push({ line, column: match.index - line, data, operator: "", parts: 0 });
  }
  return open;
}

/**
 * True if the next part of a list is data, and no form.
 * @param {List} list
 */
function isData(list) {
  if (list.data) return !list.operator;
  return (list.operator === "defclass" && list.parts === 3) || (/^let\*?$/.test(list.operator) && list.parts === 1);
}

/**
 * Where the block comment ends that begins at an offset.
 * @param {string} text
 * @param {number} start
 */
function blockCommentEnd(text, start) {
  const mark = /#\||\|#/g;
  mark.lastIndex = start;
  let depth = 0;
  for (let match = mark.exec(text); match; match = mark.exec(text)) {
    depth += match[0] === "#|" ? 1 : -1;
    if (depth === 0) return mark.lastIndex;
  }
  return undefined;
}

module.exports = { indentation };
