" `:compiler kirk`, then `:make`: what `kirk check` says about this file, in the quickfix list.
if exists("current_compiler")
  finish
endif
let current_compiler = "kirk"

" One line for every place: the bounds that are to blame come after the message they belong to.
CompilerSet makeprg=kirk\ check\ --quiet\ --format\ short\ %:S
CompilerSet errorformat=%f:%l:%c:\ %trror[K%n]:\ %m,%f:%l:%c:\ %tarning[K%n]:\ %m,%f:%l:%c:\ %tote[K%n]:\ %m,%f:%l:%c:\ %tote:\ %m,%-G%.%#
