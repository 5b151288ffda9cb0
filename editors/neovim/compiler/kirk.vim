" `:compiler kirk`, then `:make`: what `kirk check` says about this file, in the quickfix list.
if exists("current_compiler")
  finish
endif
let current_compiler = "kirk"

CompilerSet makeprg=kirk\ check\ --quiet\ --color\ never\ %:S
CompilerSet errorformat=%E%trror[K%n]:\ %m,%W%tarning[K%n]:\ %m,%I%tote[K%n]:\ %m,%C\ %#┌─\ %f:%l:%c,%-G%.%#
