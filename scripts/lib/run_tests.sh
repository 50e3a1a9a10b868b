#!/usr/bin/env bash
# Runs the test programs of a bundle; those of the CUDA backend only where a GPU is. Arguments: a filter on their names.
# DROGUE_TEST_WRAPPER goes before each program, for example "compute-sanitizer --error-exitcode 1".
cd "$(dirname "${BASH_SOURCE[0]}")" || exit 2
passed=0
failed=()
for program in tests/*"${1:-}"*; do
  case "$program" in *_cuda) [ -e /dev/nvidiactl ] || continue ;; esac
  # shellcheck disable=SC2086  # the wrapper is several words
  if output="$(${DROGUE_TEST_WRAPPER:-} "$program" --gtest_brief=1 2>&1)"; then
    passed=$((passed + 1))
  else
    failed+=("$program")
    printf '%s\n%s\n' "$program" "$output"
  fi
done
printf '%d test programs passed, %d failed%s\n' "$passed" "${#failed[@]}" "${failed[*]:+: ${failed[*]}}"
[ "${#failed[@]}" -eq 0 ] && [ "$passed" -gt 0 ]
