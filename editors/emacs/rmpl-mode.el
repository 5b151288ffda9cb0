;;; rmpl-mode.el --- RMPL, the language of kirk's missions  -*- lexical-binding: t; -*-

;; SPDX-License-Identifier: MIT OR Apache-2.0
;; Version: 0.1.0
;; Package-Requires: ((emacs "28.1"))
;; Keywords: languages, lisp

;;; Commentary:

;; Colours and the indentation of `kirk fmt' for files that end in .rmpl, `M-x compile' with `kirk check', and the language
;; server `kirk lsp' by eglot (part of Emacs 29, a package for Emacs 28):
;;
;;     (add-to-list 'load-path "~/kirk/editors/emacs")
;;     (require 'rmpl-mode)
;;     (add-hook 'rmpl-mode-hook #'eglot-ensure)

;;; Code:

(require 'lisp-mode)

(defgroup rmpl nil
  "RMPL, the language of kirk's missions."
  :group 'languages)

(defcustom rmpl-kirk-program "kirk"
  "The kirk to start: a name to look for on the path, or a file."
  :type 'string)

(defconst rmpl--bodies
  '(define-control-program define-team defparameter defconstant defclass defpackage declare sequence parallel with-temporal-constraint dotimes let let* label between with-agent duration)
  "What has a body, which stands two columns in.")

(defun rmpl--operator (open)
  "The operator of the list at OPEN, without its package; nil if it is no name."
  (save-excursion
    (goto-char (1+ open))
    (when (looking-at "\\s-*\\(?:\\(?:\\sw\\|\\s_\\)+:\\)?\\(\\(?:\\sw\\|\\s_\\)+\\)")
      (intern (downcase (match-string-no-properties 1))))))

(defun rmpl--parts-before (open end)
  "How many parts of the list at OPEN stand before END."
  (save-excursion
    (goto-char (1+ open))
    (let ((parts 0))
      (while (progn (forward-comment (point-max)) (< (point) end))
        (setq parts (1+ parts))
        (condition-case nil (forward-sexp) (scan-error (goto-char end))))
      parts)))

(defun rmpl-indent-function (indent-point state)
  "The column of a line of RMPL at INDENT-POINT; nil if below the first argument.
STATE is that of the parser there, as `lisp-indent-function' has it."
  (let* ((open (elt state 1))
         (around (cdr (reverse (elt state 9))))
         (column (save-excursion (goto-char open) (current-column)))
         (operator (rmpl--operator open)))
    (cond
     ;; The slots of a class and the parts of a slot are data.
     ((memq 'defclass (mapcar #'rmpl--operator (seq-take around 2))) (1+ column))
     ((null operator) (1+ column))
     ((not (memq operator rmpl--bodies)) nil)
     ;; The second event stands below the first.
     ((and (eq operator 'between) (< (rmpl--parts-before open indent-point) 3)) nil)
     (t (+ 2 column)))))

(defconst rmpl--font-lock
  (let ((word (lambda (&rest words)
                (concat "(\\(?:\\(?:cl\\|common-lisp\\|rmpl\\(?:/[^][ \t\n():\"';]+\\)?\\)::?\\)?"
                        (regexp-opt words t) "\\_>"))))
    `((,(concat (funcall word "define-control-program") "[ \t]+\\(\\(?:\\sw\\|\\s_\\)+\\)?")
       (1 font-lock-keyword-face) (2 font-lock-function-name-face nil t))
      (,(concat (funcall word "defclass" "define-team") "[ \t]+\\(\\(?:\\sw\\|\\s_\\)+\\)?")
       (1 font-lock-keyword-face) (2 font-lock-type-face nil t))
      (,(concat (funcall word "defparameter" "defconstant") "[ \t]+\\(\\(?:\\sw\\|\\s_\\)+\\)?")
       (1 font-lock-keyword-face) (2 font-lock-variable-name-face nil t))
      (,(funcall word "defpackage" "in-package") (1 font-lock-keyword-face))
      (,(funcall word "sequence" "parallel" "with-temporal-constraint" "delay" "dotimes" "let" "let*" "label" "between" "with-agent")
       (1 font-lock-keyword-face))
      (,(funcall word "declare" "agent" "link" "primitive" "duration" "requires" "effect" "ignore" "ignorable")
       (1 font-lock-preprocessor-face))
      (,(funcall word "simple" "simple-temporal") (1 font-lock-type-face))
      (,(funcall word "microseconds" "seconds" "minutes" "hours" "days"
                 "1+" "1-" "+" "-" "*" "/" "min" "max" "mod" "=" "and" "or" "not" "at" "over" "member")
       (1 font-lock-builtin-face))
      ("(\\(start\\|end\\)[ \t\n]+[^ \t\n)]" (1 font-lock-builtin-face))
      ("\\_<\\(?:t\\|nil\\|:infinity\\)\\_>" . font-lock-constant-face)
      ("\\_<#?:\\(?:\\sw\\|\\s_\\)+" . font-lock-builtin-face)
      ("\\_<\\(?:\\*[^][* \t\n()\"';]+\\*\\|\\+[^][+ \t\n()\"';]+\\+\\)\\_>" . font-lock-variable-name-face)
      ("(\\(\\(?:\\sw\\|\\s_\\)+\\)" 1 font-lock-function-name-face)))
  "The words of RMPL and what they look like.")

(defvar rmpl-mode-syntax-table
  (let ((table (make-syntax-table lisp-data-mode-syntax-table)))
    ;; Block comments, which nest; and `#' may be part of a name.
    (modify-syntax-entry ?# "_ 14" table)
    (modify-syntax-entry ?| ". 23bn" table)
    table)
  "What the characters of RMPL are.")

;;;###autoload
(define-derived-mode rmpl-mode lisp-data-mode "RMPL"
  "The mode of RMPL, the language of kirk's missions."
  (setq-local font-lock-defaults '(rmpl--font-lock nil t nil))
  (setq-local lisp-indent-function #'rmpl-indent-function)
  (setq-local comment-start ";; ")
  (setq-local comment-add 0)
  (setq-local fill-column 100)
  (setq-local indent-tabs-mode nil)
  (setq-local imenu-generic-expression
              '((nil "^(\\(?:rmpl/lang:\\)?define-control-program[ \t]+\\([^][ \t\n()\"';]+\\)" 1)
                ("Classes" "^(defclass[ \t]+\\([^][ \t\n()\"';]+\\)" 1)))
  (when buffer-file-name
    (setq-local compile-command
                (mapconcat #'shell-quote-argument
                           (list rmpl-kirk-program "check" "--quiet" "--format" "short" (file-relative-name buffer-file-name))
                           " "))))

;;;###autoload
(add-to-list 'auto-mode-alist '("\\.rmpl\\'" . rmpl-mode))

(with-eval-after-load 'compile
  (defvar compilation-error-regexp-alist)
  (defvar compilation-error-regexp-alist-alist)
  ;; One line for every place: the bounds that are to blame come after the message they belong to.
  (add-to-list 'compilation-error-regexp-alist-alist
               '(kirk "^\\(.+?\\):\\([0-9]+\\):\\([0-9]+\\): \\(?:error\\|\\(warning\\)\\|\\(note\\)\\)" 1 2 3 (4 . 5)))
  (add-to-list 'compilation-error-regexp-alist 'kirk))

(defun rmpl--server (&rest _)
  "The command that starts the language server."
  (list rmpl-kirk-program "lsp"))

(with-eval-after-load 'eglot
  (defvar eglot-server-programs)
  (add-to-list 'eglot-server-programs '(rmpl-mode . rmpl--server)))

(provide 'rmpl-mode)
;;; rmpl-mode.el ends here
