-- What the files beside this one promise, in a real Neovim; `test.sh` runs it. The first failure ends it with status 1.

local project = vim.fn.fnamemodify(debug.getinfo(1, "S").source:sub(2), ":p:h:h:h")
local passed = 0

local function same(expected, found, what)
  if not vim.deep_equal(expected, found) then
    error(("%s: expected %s, found %s"):format(what, vim.inspect(expected), vim.inspect(found)), 2)
  end
end

local function wait(condition, what)
  local found
  local done = vim.wait(20000, function()
    found = condition()
    return found
  end, 20)
  if not done then
    error("waited in vain: " .. what, 2)
  end
  return found
end

local function open(name)
  vim.cmd("edit! " .. vim.fn.fnameescape(project .. "/" .. name))
end

local function lines()
  return vim.api.nvim_buf_get_lines(0, 0, -1, false)
end

-- Puts the cursor on a piece of the text.
local function at(piece)
  vim.fn.cursor(1, 1)
  same(true, vim.fn.search("\\V" .. piece, "cW") > 0, "there is " .. piece)
end

local function request(method, extra)
  local params = vim.lsp.util.make_position_params(0, "utf-16")
  local all = vim.lsp.buf_request_sync(0, method, vim.tbl_extend("force", params, extra or {}), 20000)
  for _, answer in pairs(assert(all, method)) do
    assert(not answer.err and not answer.error, vim.inspect(answer))
    return answer.result
  end
  error("no answer to " .. method)
end

local tests = {
  {
    "a file that ends in .rmpl is RMPL",
    function()
      open("examples/rmpl/robot.rmpl")
      same("rmpl", vim.bo.filetype, "filetype")
      same(";; %s", vim.bo.commentstring, "commentstring")
    end,
  },
  {
    "every line of every example is indented as it is",
    function()
      local files = vim.fn.glob(project .. "/examples/rmpl/*.rmpl", false, true)
      assert(#files > 10, #files)
      for _, file in ipairs(files) do
        vim.cmd("edit! " .. vim.fn.fnameescape(file))
        local before = lines()
        vim.cmd("silent normal! gg=G")
        for number, line in ipairs(lines()) do
          same(before[number], line, ("%s:%d"):format(file, number))
        end
      end
    end,
  },
  {
    "a new line is indented as it is typed",
    function()
      vim.cmd("enew! | setfiletype rmpl")
      vim.api.nvim_feedkeys("i(define-control-program main ()\r(sequence (:slack t)\r(shower)\r(eat)))", "xt", false)
      same({ "(define-control-program main ()", "  (sequence (:slack t)", "    (shower)", "    (eat)))" }, lines(), "text")
    end,
  },
  {
    "nothing is indented within a string or a block comment",
    function()
      vim.cmd("enew! | setfiletype rmpl")
      vim.api.nvim_feedkeys('i(define-control-program a ()\r"One\r\rtwo."\r(eat))', "xt", false)
      local typed = { "(define-control-program a ()", '  "One', "", '  two."', "  (eat))" }
      same(typed, lines(), "what was typed")
      local text = { "#| a", "      b |#", "(define-control-program a ()", '  "One', "", ' two"', "  (eat))" }
      vim.api.nvim_buf_set_lines(0, 0, -1, false, text)
      vim.cmd("silent normal! gg=G")
      same(text, lines(), "what was laid out")
    end,
  },
  {
    "words have the colours of their kind",
    function()
      vim.cmd("enew! | setfiletype rmpl")
      vim.api.nvim_buf_set_lines(0, 0, -1, false, {
        "(define-control-program scan () #| one #| two |# three |#",
        "  (parallel (:slack t) (shower 1/2 *limit*) (delay (minutes 5) :infinity) \"text\")) ; note",
      })
      for piece, group in pairs({
        ["define"] = "Define",
        ["scan"] = "Name",
        ["three"] = "BlockComment",
        ["parallel"] = "Form",
        [":slack"] = "Keyword",
        ["shower"] = "Call",
        ["1/2"] = "Number",
        ["*limit"] = "Named",
        ["minutes"] = "Unit",
        [":infinity"] = "Constant",
        ["text"] = "String",
        ["note"] = "Comment",
      }) do
        at(piece)
        same("rmpl" .. group, vim.fn.synIDattr(vim.fn.synID(vim.fn.line("."), vim.fn.col("."), 1), "name"), piece)
      end
    end,
  },
  {
    "every example of the grammar has the colour of its kind",
    function()
      local readme = table.concat(vim.fn.readfile(project .. "/grammar/README.md"), "\n")
      local checked = 0
      for what, examples in readme:sub((readme:find("## Top level", 1, true))):gmatch("\n| ([^|\n]+) | ([^\n]+) |") do
        for example in examples:gmatch("`(%b())`") do
          vim.cmd("enew! | setfiletype rmpl")
          vim.api.nvim_buf_set_lines(0, 0, -1, false, { example })
          local group = vim.fn.synIDattr(vim.fn.synID(1, 2, 1), "name")
          same(what == "call", group == "rmplCall", ("%s: %s is %s, a call"):format(what, example, group))
          checked = checked + 1
        end
      end
      assert(checked > 30, checked)
    end,
  },
  {
    "a mission that cannot be promised is an error at `main`",
    function()
      open("examples/rmpl/too-late.rmpl")
      local found = wait(function()
        local all = vim.diagnostic.get(0)
        return #all > 0 and all
      end, "diagnostics")
      same(1, #found, "how many")
      same({ 20, 24, "K0601" }, { found[1].lnum, found[1].col, found[1].code or found[1].user_data.lsp.code }, "where")
      local message = "`main` cannot be executed in every case: these bounds do not go together"
      same(message, found[1].message:sub(1, #message), "message")
    end,
  },
  {
    "hover, definition and completion answer",
    function()
      at("(stow)")
      vim.cmd("normal! l")
      local hover = request("textDocument/hover")
      assert(vim.inspect(hover.contents):find("10", 1, true), vim.inspect(hover))
      vim.lsp.buf.definition()
      wait(function()
        return vim.fn.line(".") == 17
      end, "the definition of `stow` in line 17")
      at("(stow)")
      vim.cmd("normal! ll")
      local answer = request("textDocument/completion")
      local labels = vim.tbl_map(function(item)
        return item.label
      end, answer.items or answer)
      assert(vim.tbl_contains(labels, "stow") and vim.tbl_contains(labels, "sequence"), vim.inspect(labels))
    end,
  },
  {
    "a program is renamed wherever it is named",
    function()
      at("(stow)")
      vim.cmd("normal! l")
      vim.lsp.buf.rename("put-away")
      wait(function()
        return lines()[26] == "        (put-away)))))"
      end, "the call in line 26 to be renamed")
      same("(define-control-program put-away ()", lines()[17], "the definition")
    end,
  },
  {
    "formatting lays out as `kirk fmt`",
    function()
      open("examples/rmpl/too-late.rmpl")
      local before = lines()
      vim.cmd([[silent %s/^ \+//]])
      assert(not vim.deep_equal(before, lines()))
      local format = vim.lsp.buf.format or vim.lsp.buf.formatting_sync
      format(vim.lsp.buf.format and { timeout_ms = 20000 } or nil, 20000)
      same(before, lines(), "text")
    end,
  },
  {
    "what is put right is no longer shown",
    function()
      open("examples/rmpl/too-late.rmpl")
      wait(function()
        return #vim.diagnostic.get(0) == 1
      end, "the error")
      at(":upper-bound 20)")
      vim.cmd("normal! W")
      vim.cmd([[silent .s/20)/25)/]])
      wait(function()
        return #vim.diagnostic.get(0) == 0
      end, "the error to disappear")
    end,
  },
  {
    ":make finds the error as well",
    function()
      open("examples/rmpl/too-late.rmpl")
      vim.cmd("compiler kirk")
      vim.bo.makeprg = vim.bo.makeprg:gsub("^kirk", (vim.g.kirk_path:gsub("%%", "\\%%")))
      vim.cmd("silent make")
      local found = vim.fn.getqflist()[1]
      same({ 21, 25, 601 }, { found.lnum, found.col, found.nr }, "where")
      -- The bounds that are to blame come after it.
      local guilty = vim.fn.getqflist()[2]
      same({ 24, "N" }, { guilty.lnum, guilty.type:upper() }, "a bound")
    end,
  },
}

local ok = true
for _, test in ipairs(tests) do
  local name, run = unpack(test)
  local fine, why = pcall(run)
  io.stdout:write(fine and ("ok   %s\n"):format(name) or ("FAIL %s\n     %s\n"):format(name, why))
  if not fine then
    ok = false
    break
  end
  passed = passed + 1
end
io.stdout:write(("%d passed, %d failed\n"):format(passed, ok and 0 or 1))
vim.cmd(ok and "qall!" or "cquit 1")
