-- Starts the language server for every RMPL file.
vim.api.nvim_create_autocmd("FileType", {
  pattern = "rmpl",
  callback = function(event)
    require("kirk").start(event.buf)
  end,
})
