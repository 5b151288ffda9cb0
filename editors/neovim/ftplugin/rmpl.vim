" RMPL: how it is written. Colours are in syntax/, indentation in indent/, the language server in plugin/.
if exists("b:did_ftplugin")
  finish
endif
let b:did_ftplugin = 1

setlocal comments=:;;;;,:;;;,:;;,:;,sr:#\|,mb:\|,ex:\|#
setlocal commentstring=;;\ %s
setlocal formatoptions-=t formatoptions+=croql
setlocal iskeyword=33,35-38,42,43,45-58,60-64,65-90,94,95,97-122,126,@
setlocal expandtab shiftwidth=2 softtabstop=2 textwidth=100
let b:undo_ftplugin = "setlocal comments< commentstring< formatoptions< iskeyword< expandtab< shiftwidth< softtabstop< textwidth<"
