#!/bin/sh
# The tests of the mode, in a real Emacs without a screen: `KIRK=... editors/emacs/test.sh`. KIRK is the kirk to use, by
# default the one that `cargo build` or `cargo test` left.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
KIRK=${KIRK:-$here/../../target/debug/kirk}
export KIRK
[ -x "$KIRK" ] || { echo "there is no $KIRK: run cargo build first, or set KIRK" >&2; exit 2; }
compiled=$(mktemp -d)
trap 'rm -rf "$compiled"' EXIT
cp "$here/rmpl-mode.el" "$compiled"
# Warnings are errors; what is tested is the compiled mode.
"${EMACS:-emacs}" --batch -Q --eval '(setq byte-compile-error-on-warn t)' -f batch-byte-compile "$compiled/rmpl-mode.el"
# With the packages of the system, as eglot is one of them in Emacs 28.
timeout 300 "${EMACS:-emacs}" --batch -q -L "$compiled" -l rmpl-mode \
  --eval '(setq rmpl-kirk-program (getenv "KIRK"))' -l "$here/rmpl-mode-tests.el" -f ert-run-tests-batch-and-exit </dev/null
