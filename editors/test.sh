#!/usr/bin/env bash
# The tests of every editor that is on this machine, against KIRK or the kirk that `cargo build` or `cargo test` left.
set -euo pipefail
cd "$(dirname "$0")"
export KIRK=${KIRK:-$PWD/../target/debug/kirk}

# Runs a test if its program is there: NAME PROGRAM COMMAND...
with() {
  local name=$1 program=$2
  shift 2
  printf '\n-- %s\n' "$name"
  if command -v "$program" >/dev/null; then "$@"; else echo "skipped: there is no $program on this machine"; fi
}

vscode() {
  cd vscode
  npm ci --no-audit --no-fund --loglevel=error
  npm test
  npm run --silent package
}

# In a shell of its own, so that it may change the folder and fail by any command.
with "VS Code" npm bash -euc "$(declare -f vscode); vscode"
with "Neovim" "${NVIM:-nvim}" neovim/test.sh
with "Emacs" "${EMACS:-emacs}" emacs/test.sh
