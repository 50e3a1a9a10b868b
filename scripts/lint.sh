#!/usr/bin/env bash
# Runs clang-tidy 14 on our host sources, by .clang-tidy; needs the host build's compile commands.
#
#   scripts/lint.sh [FILE...]      default: every .cpp of common/, kernels/reference/ and miniapps/
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"

tool="$(command -v clang-tidy-14 || true)"
[ -n "$tool" ] || fail "there is no clang-tidy-14: run scripts/setup.sh --developer."
[ -e "$root/build/host/compile_commands.json" ] || fail "there are no compile commands: run scripts/build.sh host."

cd "$root"
files=("$@")
[ $# -gt 0 ] || mapfile -t files < <(git ls-files -- 'common/*.cpp' 'kernels/reference/*.cpp' 'miniapps/*.cpp')
# The counts of warnings in system headers are noise.
printf '%s\0' "${files[@]}" | xargs -0 -n 4 -P "$jobs" "$tool" -p build/host --quiet 2> >(grep -v 'warnings generated' >&2) ||
  fail "clang-tidy objects to the lines above: change them, or say NOLINT(check) with the reason beside them."
