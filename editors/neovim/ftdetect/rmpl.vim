autocmd BufNewFile,BufRead *.rmpl setfiletype rmpl
