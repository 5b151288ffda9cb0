//! Reading: from characters to forms.

use super::Page;

pub(super) const UNCLOSED_FORM: Page = Page {
    meaning: "A parenthesis was opened and never closed. The message points at the form that is open: at the one whose
contents are indented as if it had been closed, if there is one, else at the definition itself. The next
definition that begins in the first column is read as usual, so the rest of the file is checked all the same.",
    wrong: "(define-control-program main ()
  (sequence (:slack t)
    (shower)
    (eat))

(define-control-program shower () (declare (primitive)))",
    right: "(define-control-program main ()
  (sequence (:slack t)
    (shower)
    (eat)))

(define-control-program shower () (declare (primitive)))",
};

pub(super) const STRAY_CLOSE: Page = Page {
    meaning: "There is a `)` although every form is closed already. Usually the definition before it was closed too early: a
parenthesis too many stands somewhere inside of it. The second place in the message shows where it ended.",
    wrong: "(define-control-program main ()
  (sequence (:slack t)
    (shower)))
    (eat)))",
    right: "(define-control-program main ()
  (sequence (:slack t)
    (shower)
    (eat)))",
};

pub(super) const UNCLOSED_STRING: Page = Page {
    meaning: r##"A quotation mark opens a string, and the string has no end before the end of the text or before the next
definition. Kirk goes on with the line after it. Inside a string, a quotation mark is written `\"` and a
backslash `\\`."##,
    wrong: r##"(define-control-program main ()
  "Takes a picture.
  (declare (primitive)))"##,
    right: r##"(define-control-program main ()
  "Takes a picture."
  (declare (primitive)))"##,
};

pub(super) const UNCLOSED_COMMENT: Page = Page {
    meaning: r##"A comment that begins with `#|` goes on to the matching `|#`. Comments can be nested, so each `#|` inside
needs a `|#` of its own. Without it, everything to the end of the text is a comment, and programs defined
there are not known."##,
    wrong: r##"#| to do: #| later |#
(define-control-program main () (declare (primitive)))"##,
    right: r##"#| to do: #| later |# |#
(define-control-program main () (declare (primitive)))"##,
};

pub(super) const TOO_DEEP: Page = Page {
    meaning: "Forms may be nested a thousand deep, which is far more than people write and less than the machine could take.
A generated program that needs more gives its inner parts names of their own with `define-control-program` and
calls them.",
    wrong: "",
    right: "",
};

pub(super) const NOT_TEXT: Page = Page {
    meaning: "The source contains characters that no text contains, such as NUL. It is probably a binary file: a compressed
archive, a compiled program, a picture, or text in an encoding other than UTF-8 (UTF-16, for example, has a
NUL in every second place). Kirk reads RMPL as UTF-8 text, with tabs and either kind of line end.",
    wrong: "",
    right: "",
};

pub(super) const UNREADABLE: Page = Page {
    meaning: r##"RMPL is written in a part of Lisp's syntax: lists, names, keywords, numbers, strings, `'quote`, `#:name` and
comments. Reader macros (`#+sbcl`, `#'f`), backquotes, names in bars and square brackets are not part of it."##,
    wrong: "(define-control-program main ()
  [sequence (:slack t) (a)])",
    right: "(define-control-program main ()
  (sequence (:slack t) (a)))",
};

pub(super) const NOT_RMPL: Page = Page {
    meaning: "The text is certainly something else: JSON, XML, a program in another language, or what was typed at a shell
prompt and pasted with the program. Kirk says so once and does not try to make sense of every line. Network
files are read by kirk as well, but they are recognised by the end of their name (`.json`, `.stnu`), not by
their contents.",
    wrong: "$ kirk run mission.rmpl
(define-control-program main () (declare (primitive)))",
    right: ";; $ kirk run mission.rmpl
(define-control-program main () (declare (primitive)))",
};

pub(super) const EMPTY_SOURCE: Page = Page {
    meaning: "The source is empty or has only comments in it. A mission needs at least one program, by default one called
`main`; is this the file you meant?",
    wrong: ";; nothing here yet",
    right: "(define-control-program main ()
  (declare (primitive) (duration (simple :upper-bound 10))))",
};

pub(super) const STRAY_TEXT: Page = Page {
    meaning: "Between the definitions there may be comments and blanks, and nothing else. Kirk leaves the lines out up to
the next one that begins with a parenthesis, and reports them once.",
    wrong: "The mission of Monday.
(define-control-program main () (declare (primitive)))",
    right: ";; The mission of Monday.
(define-control-program main () (declare (primitive)))",
};

pub(super) const TOO_MANY_PROBLEMS: Page = Page {
    meaning: "Kirk reports all problems of a source at once, but not without end: after two hundred it only counts. That
many problems mostly follow from a few: put the first ones right and look again.",
    wrong: "",
    right: "",
};

pub(super) const TOO_LONG: Page = Page {
    meaning: "A source may have 16 MiB, several times what the largest program needs that kirk can unfold. A longer file is
probably not the one you meant. A program that generates missions can generate a network in kirk's JSON form
instead, which needs no compiling.",
    wrong: "",
    right: "",
};
