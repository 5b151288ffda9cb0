" RMPL: colours.
if exists("b:current_syntax")
  finish
endif

syntax case ignore
syntax iskeyword 33,35-38,42,43,45-58,60-64,65-90,94,95,97-122,126,@
syntax sync minlines=200

" What comes later wins: names, then the words of the language.
syntax match rmplCall       "(\@1<=\k\+"
syntax match rmplNumber     "\k\@1<![+-]\=\%(\d\+/\d\+\|\%(\d\+\%(\.\d*\)\=\|\.\d\+\)\%([edfsl][+-]\=\d\+\)\=\)\k\@!"
syntax match rmplKeyword    "\k\@1<!#\=:\k\+"
syntax match rmplConstant   "\k\@1<!\%(t\|nil\|:infinity\)\k\@!"
syntax match rmplNamed      "\k\@1<!\%(\*\k\+\*\|+\k\++\)\k\@!"
syntax match rmplQuoted     "'\k\+"
syntax match rmplEvent      "(\@1<=\%(start\|end\)\ze\s\+[^[:space:])]"
syntax match rmplOperator   "(\@1<=\%(1+\|1-\|[-+*/=]\|min\|max\|mod\|and\|or\|not\|at\|over\|member\)\k\@!"
syntax match rmplUnit       "(\@1<=\%(microseconds\|seconds\|minutes\|hours\|days\)\k\@!"
syntax match rmplBounds     "(\@1<=\%(simple-temporal\|simple\)\k\@!"
syntax match rmplDeclare    "(\@1<=\%(\k\+:\)\=\%(declare\|agent\|link\|primitive\|duration\|requires\|effect\|ignore\|ignorable\)\k\@!"
syntax match rmplForm       "(\@1<=\%(\k\+:\)\=\%(sequence\|parallel\|with-temporal-constraint\|delay\|dotimes\|let\|let\*\|label\|between\|with-agent\)\k\@!"
syntax match rmplDefine     "(\@1<=\%(\k\+:\)\=\%(define-control-program\|define-team\|defclass\|defparameter\|defconstant\|defpackage\|in-package\)\k\@!" nextgroup=rmplName skipwhite
syntax match rmplName       "\k\+" contained
syntax match rmplError      "[][{}`,\\]\|#'\k*"
syntax region rmplString       start=+"+ skip=+\\.+ end=+"+ contains=@Spell
syntax match  rmplComment      ";.*" contains=@Spell,rmplTodo
syntax region rmplBlockComment start="#|" end="|#" contains=rmplBlockComment,@Spell,rmplTodo
syntax keyword rmplTodo TODO FIXME XXX contained

highlight default link rmplCall         Function
highlight default link rmplNumber       Number
highlight default link rmplKeyword      Identifier
highlight default link rmplConstant     Constant
highlight default link rmplNamed        Constant
highlight default link rmplQuoted       Constant
highlight default link rmplEvent        Special
highlight default link rmplOperator     Operator
highlight default link rmplUnit         Special
highlight default link rmplBounds       Type
highlight default link rmplDeclare      PreProc
highlight default link rmplForm         Statement
highlight default link rmplDefine       Keyword
highlight default link rmplName         Function
highlight default link rmplError        Error
highlight default link rmplString       String
highlight default link rmplComment      Comment
highlight default link rmplBlockComment Comment
highlight default link rmplTodo         Todo

let b:current_syntax = "rmpl"
