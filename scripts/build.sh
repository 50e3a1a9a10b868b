#!/usr/bin/env bash
# Configures and builds one preset into build/PRESET.
#
#   scripts/build.sh [PRESET] [--system] [-DNAME=VALUE ...] [--target NAME ...]
#     PRESET    host (default), cuda, hip, exact, cuda-exact, asan, debug
#     --system  take Kokkos and all libraries from find_package, not from scripts/setup.sh
#     -D...     an option of CMake; docs/building.md lists those of Drogue
#     --target  a program such as drogue-gas instead of everything
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"

preset=host options=() targets=()
while [ $# -gt 0 ]; do
  case "$1" in
    --system) options+=(-DDROGUE_SYSTEM=ON) ;;
    -D*) options+=("$1") ;;
    --target) targets+=(--target "${2:?--target needs a name}") && shift ;;
    -h | --help) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0" && exit 0 ;;
    -*) fail "unknown argument $1: see scripts/build.sh --help." ;;
    *) preset="$1" ;;
  esac
  shift
done

cd "$root"
nvcc="$(find_nvcc)"
# Defaults come first: the last of two settings counts.
case "$preset" in
  cuda*)
    [ -n "$nvcc" ] || fail "preset $preset needs nvcc: install the CUDA toolkit, or build preset host."
    options=("-DDROGUE_CUDA_ARCH=${DROGUE_CUDA_ARCH:-90}" ${options[@]+"${options[@]}"})
    ;;
  hip)
    hipcc="$(find_hipcc)"
    [ -n "$hipcc" ] || fail "preset $preset needs hipcc: run scripts/setup.sh --hip, load a module of ROCm, or build preset host."
    options=("-DCMAKE_CXX_COMPILER=$hipcc" ${options[@]+"${options[@]}"})
    ;;
esac
# The log is short when all is well; on failure the part that matters is shown.
run_logged "configure-$preset" cmake --preset "$preset" ${options[@]+"${options[@]}"}
# Warnings, which libraries were taken, and what the build lacks for them.
sed -n '/^CMake Warning/,/^-- /{/^-- /!p}; s/^-- \(Kokkos\|HDF5\) /== \1 /p' "$deps/log/configure-$preset.log" >&2
say "building preset $preset in build/$preset"
log="$deps/log/build-$preset.log"
if ! cmake --build "build/$preset" --parallel "$jobs" ${targets[@]+"${targets[@]}"} >"$log" 2>&1; then
  grep -E -A 12 'error|FAILED' "$log" | head -n 60 >&2 || tail -n 40 "$log" >&2
  explain_failure "build of $preset" "$log"
fi
grep -A 6 'warning:' "$log" >&2 || true
