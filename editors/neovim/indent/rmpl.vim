" RMPL: the indentation of `kirk fmt`.
if exists("b:did_indent")
  finish
endif
let b:did_indent = 1

setlocal indentexpr=RmplIndent(v:lnum) indentkeys=!^F,o,O autoindent nolisp
let b:undo_indent = "setlocal indentexpr< indentkeys< autoindent< lisp<"

if exists("*RmplIndent")
  finish
endif

" What has a body, which stands two columns in. The arguments of all else stand below the first one.
let s:bodies = ['define-control-program', 'define-team', 'defparameter', 'defconstant', 'defclass', 'defpackage', 'declare', 'sequence', 'parallel', 'with-temporal-constraint', 'dotimes', 'let', 'let*', 'label', 'between', 'with-agent', 'duration']

" How far a line is indented; -1 within a string or a block comment, where kirk changes nothing.
function RmplIndent(line) abort
  if s:within(a:line)
    return -1
  endif
  let view = winsaveview()
  call cursor(a:line, 1)
  " A parenthesis in the first column ends whatever is open before it.
  let top = search('^(', 'bnW')
  let open = [s:up(top), s:up(top), s:up(top)]
  call winrestview(view)
  if open[0] == [0, 0]
    return 0
  endif
  let [line, column] = open[0]
  let left = strdisplaywidth(strpart(getline(line), 0, column - 1))
  let operator = s:operator(open[0])
  " The slots of a class, and the parts of a slot, are data.
  if operator ==# '' || s:name(open[1]) ==# 'defclass' || s:name(open[2]) ==# 'defclass'
    return left + 1
  endif
  let first = matchstr(strpart(getline(line), column + strlen(operator)), '^\s\+\ze[^; \t]')
  if first ==# '' || index(s:bodies, s:name(open[0])) >= 0
    return left + 2
  endif
  return left + 1 + strdisplaywidth(operator . first)
endfunction

" True if a line begins within a string or a block comment. A new line has no colours yet: the one before it tells.
function s:within(line) abort
  if getline(a:line) =~# '\S'
    return s:opaque(a:line, 1) =~# 'String\|BlockComment' && getline(a:line) !~# '^\%("\|#|\)'
  endif
  let before = prevnonblank(a:line - 1)
  return s:opaque(before, strlen(getline(before))) =~# 'String\|BlockComment' && getline(before) !~# '\%("\||#\)\s*$'
endfunction

" Goes to the parenthesis that is open here, and looks no further up than a line.
function s:up(top) abort
  return searchpairpos('(', '', ')', 'bW', 's:opaque(line("."), col(".")) !=# ""', a:top)
endfunction

" The name behind a parenthesis, as written; empty if there is none.
function s:operator(place) abort
  return matchstr(strpart(getline(a:place[0]), a:place[1]), '^\s*[:#]\@!\k\+')
endfunction

" The same in lower case, without its package.
function s:name(place) abort
  return tolower(matchstr(s:operator(a:place), '[^: \t]*$'))
endfunction

" The kind of string or comment that stands at a place, if any.
function s:opaque(line, column) abort
  return matchstr(synIDattr(synID(a:line, a:column, 1), "name"), 'rmpl\zs\%(String\|BlockComment\|Comment\)')
endfunction
