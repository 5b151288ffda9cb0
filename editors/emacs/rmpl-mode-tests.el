;;; rmpl-mode-tests.el --- Tests of rmpl-mode  -*- lexical-binding: t; -*-

;;; Commentary:

;; `test.sh' runs them.  Those of the language server need eglot and are skipped without it.

;;; Code:

(require 'ert)
(require 'rmpl-mode)
(require 'seq)

(defconst rmpl-tests-project
  (expand-file-name "../../" (file-name-directory (or load-file-name buffer-file-name))))

(defun rmpl-tests-example (name)
  "The file of the example NAME."
  (expand-file-name (concat "examples/rmpl/" name) rmpl-tests-project))

(defun rmpl-tests-wait (what condition)
  "Wait until CONDITION has a value and return it; WHAT says what it is."
  (let ((end (+ (float-time) 20)) found)
    (while (not (or (setq found (funcall condition)) (> (float-time) end)))
      (accept-process-output nil 0.05))
    (or found (error "Waited in vain for %s" what))))

(ert-deftest rmpl-every-line-of-every-example-is-indented-as-it-is ()
  (let ((files (directory-files (rmpl-tests-example "") t "\\.rmpl\\'")))
    (should (> (length files) 10))
    (dolist (file files)
      (with-temp-buffer
        (insert-file-contents file)
        (rmpl-mode)
        (let ((before (buffer-string))
              (inhibit-message t))
          (indent-region (point-min) (point-max))
          (should (equal before (buffer-string))))))))

(ert-deftest rmpl-half-typed-text-is-indented-as-well ()
  (dolist (case '(("" . 0) ("(" . 1) ("'(" . 2) ("(define-control-program a" . 2) ("(rmpl/lang:sequence (:slack t)" . 2)
                  ("(let ((x 1)" . 6) ("(defclass c ()\n  ((a :type t" . 4) ("(a '(b) 'c" . 3)))
    (with-temp-buffer
      (rmpl-mode)
      (insert (car case) "\n")
      (indent-according-to-mode)
      (should (equal (cons (car case) (current-column)) case)))))

(ert-deftest rmpl-words-have-the-colours-of-their-kind ()
  (with-temp-buffer
    (insert "(define-control-program scan () #| one #| two |# three |#\n"
            "  (parallel (:slack t) (shower *limit*) (delay (minutes 5) :infinity) \"text\")) ; note")
    (rmpl-mode)
    (font-lock-ensure)
    (pcase-dolist (`(,piece . ,face)
                   '(("define" . font-lock-keyword-face) ("scan" . font-lock-function-name-face)
                     ("three" . font-lock-comment-face) ("parallel" . font-lock-keyword-face)
                     (":slack" . font-lock-builtin-face) ("shower" . font-lock-function-name-face)
                     ("*limit" . font-lock-variable-name-face) ("minutes" . font-lock-builtin-face)
                     (":infinity" . font-lock-constant-face) ("text" . font-lock-string-face)
                     ("note" . font-lock-comment-face)))
      (goto-char (point-min))
      (search-forward piece)
      (should (equal (list piece (get-text-property (match-beginning 0) 'face)) (list piece face))))))

;; A row of the table there: what it is, and examples between backquotes.
(ert-deftest rmpl-every-example-of-the-grammar-has-the-colour-of-its-kind ()
  (let ((checked 0))
    (with-temp-buffer
      (insert-file-contents (expand-file-name "grammar/README.md" rmpl-tests-project))
      (search-forward "## Top level")
      (while (re-search-forward "^| \\([^|\n]+?\\) | \\(.+\\) |$" nil t)
        (let ((what (match-string 1)) (examples (match-string 2)) (start 0))
          (while (string-match "`\\(([^`]*)\\)`" examples start)
            (setq start (match-end 0) checked (1+ checked))
            (let* ((example (match-string 1 examples))
                   (face (with-temp-buffer
                           (insert example)
                           (rmpl-mode)
                           (font-lock-ensure)
                           (get-text-property 2 'face))))
              (should (equal (list example (equal what "call"))
                             (list example (eq face 'font-lock-function-name-face)))))))))
    (should (> checked 30))))

(ert-deftest rmpl-compile-finds-the-error ()
  (require 'compile)
  (with-current-buffer (find-file-noselect (rmpl-tests-example "too-late.rmpl"))
    (should (eq major-mode 'rmpl-mode))
    (let* ((finished nil)
           (compilation-finish-functions (list (lambda (&rest _) (setq finished t))))
           (buffer (let ((inhibit-message t)) (compile compile-command))))
      (rmpl-tests-wait "the compilation" (lambda () finished))
      (set-buffer buffer)
      (let ((inhibit-message t)) (next-error))
      (set-buffer (window-buffer))
      (should (equal (list (file-name-nondirectory buffer-file-name) (line-number-at-pos) (current-column)) '("too-late.rmpl" 21 24))))))

(declare-function eglot--guess-contact "eglot")
(defvar eglot-sync-connect)
(declare-function eglot-current-server "eglot")
(declare-function eglot-rename "eglot")
(declare-function eglot-format-buffer "eglot")
(declare-function eglot-shutdown "eglot")
(declare-function flymake-start "flymake")
(declare-function flymake-diagnostics "flymake")
(declare-function flymake-diagnostic-beg "flymake")
(declare-function flymake-diagnostic-text "flymake")

(ert-deftest rmpl-a-session-with-kirk-lsp ()
  (skip-unless (require 'eglot nil t))
  (let* ((folder (make-temp-file "rmpl" t))
         (file (expand-file-name "too-late.rmpl" folder))
         (inhibit-message t))
    (copy-file (rmpl-tests-example "too-late.rmpl") file)
    (with-current-buffer (find-file-noselect file)
      (let ((original (buffer-string)))
        (let ((eglot-sync-connect 20))
          (apply #'eglot (eglot--guess-contact)))
        (should (eglot-current-server))
        ;; What kirk says is shown.
        (let ((found (car (rmpl-tests-wait "the error" (lambda () (flymake-start) (flymake-diagnostics))))))
          (should (string-match-p "`main` cannot be executed in every case: these bounds do not go together"
                                  (flymake-diagnostic-text found)))
          (should (equal (line-number-at-pos (flymake-diagnostic-beg found)) 21)))
        ;; A program is renamed wherever it is named.
        (goto-char (point-min))
        (search-forward "(stow")
        (eglot-rename "put-away")
        (should (string-match-p "(define-control-program put-away ()" (buffer-string)))
        (should (string-match-p "^        (put-away)" (buffer-string)))
        ;; The layout is that of `kirk fmt'.
        (erase-buffer)
        (insert (replace-regexp-in-string "^ +" "" original))
        (eglot-format-buffer)
        (should (equal (buffer-string) original))
        (set-buffer-modified-p nil)
        (eglot-shutdown (eglot-current-server))))
    (delete-directory folder t)))

(provide 'rmpl-mode-tests)
;;; rmpl-mode-tests.el ends here
