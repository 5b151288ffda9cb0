" RMPL: the indentation of `kirk fmt`. It is that of Lisp, and classes are lists of data.
if exists("b:did_indent")
  finish
endif
let b:did_indent = 1

setlocal lispwords=define-control-program,defclass,defpackage,defparameter,defconstant
setlocal lispwords+=declare,duration,sequence,parallel,with-temporal-constraint,dotimes,let,let*,label,between
setlocal indentexpr=RmplIndent(v:lnum) indentkeys=!^F,o,O autoindent nolisp
let b:undo_indent = "setlocal lispwords< indentexpr< indentkeys< autoindent< lisp<"

if exists("*RmplIndent")
  finish
endif

" How far a line is indented; -1 within a string or a block comment, where kirk changes nothing.
function RmplIndent(line) abort
  if s:opaque(a:line - 1, max([1, strlen(getline(a:line - 1))])) =~# 'String\|BlockComment' && s:opaque(a:line, 1) =~# 'String\|BlockComment'
        \ && getline(a:line) !~# '^\s*\("\|#|\)'
    return -1
  endif
  let view = winsaveview()
  call cursor(a:line, 1)
  let inner = s:up()
  let around = [s:up(), s:up()]
  call winrestview(view)
  " The slots of a class and the parts of a slot stand one column in.
  for place in around
    if place != [0, 0] && getline(place[0])[place[1] - 1 :] =~? '^(\s*\%(\k\+:\)\?defclass\>'
      return inner[1]
    endif
  endfor
  return lispindent(a:line)
endfunction

" Goes to the parenthesis that is open here.
function s:up() abort
  return searchpairpos('(', '', ')', 'bW', 's:opaque(line("."), col(".")) !=# ""', 0, 100)
endfunction

" The kind of string or comment that stands at a place, if any.
function s:opaque(line, column) abort
  return matchstr(synIDattr(synID(a:line, a:column, 1), "name"), 'rmpl\zs\%(String\|BlockComment\|Comment\)')
endfunction
