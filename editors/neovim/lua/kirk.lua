-- The language server `kirk lsp` in Neovim, from 0.7 on. `vim.g.kirk_path` says where kirk is, if it is not on the PATH.
local M = {}

-- The server of Neovim 0.7, which does not look for one that runs already.
local client

-- Before 0.8 nothing of this is set when a server attaches.
local function on_attach(_, buffer)
  vim.bo[buffer].omnifunc = "v:lua.vim.lsp.omnifunc"
  vim.bo[buffer].tagfunc = "v:lua.vim.lsp.tagfunc"
  vim.bo[buffer].formatexpr = "v:lua.vim.lsp.formatexpr()"
end

--- Starts the server for a buffer, or hands the buffer to the server that runs already.
--- @param buffer integer
function M.start(buffer)
  local path = vim.g.kirk_path or "kirk"
  if vim.fn.executable(path) == 0 then
    local advice = "put kirk on your PATH, or say in vim.g.kirk_path where it is"
    vim.notify_once(("There is no `%s`, so RMPL has colours only: %s"):format(path, advice), vim.log.levels.WARN)
    return
  end
  -- A mission is judged by itself: one server for all files, wherever they are.
  local config = { name = "kirk", cmd = { path, "lsp" } }
  if vim.lsp.start then
    vim.lsp.start(config, { bufnr = buffer })
    return
  end
  config.on_attach = on_attach
  config.on_exit = function()
    client = nil
  end
  client = client or vim.lsp.start_client(config)
  if client then
    vim.lsp.buf_attach_client(buffer, client)
  end
end

return M
