# Shared by the scripts: paths, and the reports of failures. Read with `.`; sets -euo pipefail.
set -euo pipefail

root="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
deps="${DROGUE_DEPS:-$root/build/deps}"
jobs="${DROGUE_JOBS:-$(nproc)}"
# Kokkos too is compiled once for all clones on a machine: its paths count relative to the clone.
export CCACHE_BASEDIR="${CCACHE_BASEDIR:-$root}" CCACHE_NOHASHDIR=1

# fail SENTENCE: prints a sentence with the remedy, and stops.
fail() {
  printf '%s: %s\n' "$(basename "$0")" "$*" >&2
  exit 1
}

# `say SENTENCE`: progress, on standard error so that output stays clean.
say() { printf '== %s\n' "$*" >&2; }

# at_least HAVE WANTED: true when version HAVE is not older than WANTED.
at_least() { [ "$(printf '%s\n%s\n' "$2" "$1" | sort -V | head -n 1)" = "$2" ]; }

# run_logged NAME COMMAND...: output goes to a log; on failure its tail is shown and explain_failure names the reason.
run_logged() {
  local name="$1" log
  shift
  mkdir -p "$deps/log" 2>/dev/null || fail "cannot write to $deps: choose another folder with DROGUE_DEPS."
  log="$deps/log/$name.log"
  if ! "$@" >"$log" 2>&1; then
    tail -n 25 "$log" >&2
    explain_failure "$name" "$log"
  fi
}

# explain_failure NAME LOG: one sentence for the usual reasons.
explain_failure() {
  local log="$2"
  if grep -qiE 'no space left|disk quota|write error.*space' "$log"; then
    fail "the disk is full: free about 3 GB (or set DROGUE_DEPS to a larger disk) and start again."
  elif grep -qiE 'do not match the hashes|hash mismatch' "$log"; then
    fail "the archive of Kokkos has another SHA-256 than scripts/dependencies.env pins: do not use it; check the package index or proxy that pip uses."
  elif grep -qiE 'temporary failure resolving|could not resolve|could not connect|failed to establish a new connection|network is unreachable|connection (timed out|refused)|failed to fetch|no matching distribution found|name resolution|max retries' "$log"; then
    fail "no network, or a server did not answer ($1): check the connection or the proxy settings and start again (log: $log)."
  elif grep -qiE 'permission denied|read-only file system' "$log"; then
    fail "no permission to write ($1): see $log, or set DROGUE_DEPS to a folder of yours."
  fi
  fail "$1 failed: the reason is in $log."
}

# in_background COMMAND...: starts it beside the following commands; wait_for_background stops the script if one of them failed,
# which has printed its reason. Each is a process group, so that its children end with this script.
background=()
in_background() {
  set -m
  "$@" &
  background+=($!)
  set +m
  trap 'kill -- "${background[@]/#/-}" 2>/dev/null || true' EXIT
}
wait_for_background() {
  local group
  for group in ${background[@]+"${background[@]}"}; do wait "$group" || exit 1; done
  trap - EXIT
}

# find_nvcc: prints the path of nvcc, or nothing.
find_nvcc() {
  local candidate
  for candidate in "$(command -v nvcc || true)" "${CUDA_HOME:-/usr/local/cuda}/bin/nvcc" /opt/cuda/bin/nvcc; do
    if [ -n "$candidate" ] && [ -x "$candidate" ]; then
      printf '%s\n' "$candidate"
      return
    fi
  done
}

# find_hipcc: prints the path of hipcc, or nothing.
find_hipcc() { PATH="$PATH:${ROCM_PATH:-/opt/rocm}/bin" command -v hipcc || true; }

# nvcc_compression: the option by which nvcc makes small files of machine code, which unpack when a program starts.
nvcc_compression() {
  if [[ "$("$(find_nvcc)" --help)" == *--compress-mode* ]]; then echo --compress-mode=size; else echo -Xfatbin=-compress-all; fi
}
