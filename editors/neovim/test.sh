#!/bin/sh
# The tests of the files here, in a real Neovim without a screen: `KIRK=... editors/neovim/test.sh`. KIRK is the kirk to use,
# by default the one that `cargo build` or `cargo test` left.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
kirk=${KIRK:-$here/../../target/debug/kirk}
[ -x "$kirk" ] || { echo "there is no $kirk: run cargo build first, or set KIRK" >&2; exit 2; }
exec timeout 300 "${NVIM:-nvim}" --clean --headless -n -i NONE \
  --cmd "let g:kirk_path = '$kirk'" --cmd "set runtimepath^=$here" -S "$here/test.lua" </dev/null
