#!/usr/bin/env bash
# Sets up, builds for this machine, runs every shipped scene, verifies it, draws it and makes one page of all.
#
#   scripts/demo.sh [--system] [SCENE...]
#     --system   install nothing, use the libraries and the Python packages that are there
#     SCENE      run these scenes only (default: all but those that want a GPU's time)
#
# Environment: DROGUE_DEMO_OUT (folder of the page, default out/demo), and that of scripts/setup.sh.
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"

setup_arguments=() scenes=()
for argument in "$@"; do
  case "$argument" in
    --system) setup_arguments+=(--system) ;;
    -h | --help) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0" && exit 0 ;;
    -*) fail "unknown argument $argument: see scripts/demo.sh --help." ;;
    *) scenes+=("$argument") ;;
  esac
done
out="${DROGUE_DEMO_OUT:-$root/out/demo}"

say "set-up"
"$root/scripts/setup.sh" "${setup_arguments[@]}"

preset=host
nvcc="$(find_nvcc)"
if [ -n "$nvcc" ] && nvidia-smi -L >/dev/null 2>&1; then
  preset=cuda
  export CUDACXX="$nvcc"
fi

say "build ($preset)"
mkdir -p "$root/build"
log="$root/build/demo-build.log"
cd "$root"
{ cmake --preset "$preset" && cmake --build --preset "$preset" --parallel "$jobs"; } >"$log" 2>&1 || {
  tail -n 25 "$log" >&2
  fail "the build failed: the first error is in $log."
}

say "scenes"
python="$root/build/venv/bin/python3"
[ -x "$python" ] || python=python3
PYTHONPATH="$root/scripts${PYTHONPATH:+:$PYTHONPATH}" \
  exec "$python" -m plot.demo --bin "$root/build/$preset/bin" --out "$out" "${scenes[@]}"
