#!/usr/bin/env bash
# Formats our C++ sources with clang-format 14; with --check changes nothing and fails where something would change.
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"

tool="$(command -v clang-format-14 || command -v clang-format || true)"
[ -n "$tool" ] || fail "there is no clang-format: run scripts/setup.sh --developer."
"$tool" --version | grep -q 'version 14\.' || fail "$tool is not version 14, and other versions format otherwise: run scripts/setup.sh --developer."

cd "$root"
mapfile -t files < <(git ls-files --cached --others --exclude-standard -- '*.hpp' '*.cpp')
case "${1:-}" in
  --check)
    if ! "$tool" --dry-run --Werror "${files[@]}" 2>"${TMPDIR:-/tmp}/drogue-format.$$"; then
      grep 'error:' "${TMPDIR:-/tmp}/drogue-format.$$" | cut -d : -f 1 | sort -u >&2 || true
      rm -f "${TMPDIR:-/tmp}/drogue-format.$$"
      fail "the files above are not formatted: run scripts/format.sh."
    fi
    rm -f "${TMPDIR:-/tmp}/drogue-format.$$"
    ;;
  '') "$tool" -i "${files[@]}" ;;
  *) fail "unknown argument $1: it takes --check or nothing." ;;
esac
