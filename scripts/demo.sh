#!/usr/bin/env bash
# Sets up, builds for this machine, runs shipped scenes, verifies and draws them, and makes one page of all.
#
#   scripts/demo.sh [--system] [--all | SCENE...]
#     --system   install nothing, use the libraries and the Python packages that are there
#     --all      run every scene that needs no GPU
#     SCENE      run these scenes (default: some of every mini-app, the last one an opening parachute)
#
# Environment: DROGUE_DEMO_OUT (folder of the page, default out/demo), and that of scripts/setup.sh.
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"

options=() setup=() scenes=()
for argument in "$@"; do
  case "$argument" in
    --system) options+=(--system) ;;
    --all) scenes+=(--all) ;;
    -h | --help) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0" && exit 0 ;;
    -*) fail "unknown argument $argument: see scripts/demo.sh --help." ;;
    *) scenes+=("$argument") ;;
  esac
done

preset=cuda
if [ -z "$(find_nvcc)" ] || ! nvidia-smi -L >/dev/null 2>&1; then
  preset=host setup=(--no-cuda)
fi
"$root/scripts/setup.sh" ${options[@]+"${options[@]}"} ${setup[@]+"${setup[@]}"}
# The mini-apps alone: the tests take longer to build than all scenes to run.
targets=()
for main in "$root"/miniapps/*/main.cpp; do
  targets+=(--target "drogue-$(basename "$(dirname "$main")")")
done
"$root/scripts/build.sh" "$preset" ${options[@]+"${options[@]}"} "${targets[@]}"

say "running the scenes"
python="$root/build/venv/bin/python3"
[ -x "$python" ] || python=python3
"$python" -P -c 'import importlib.util, sys; sys.exit(not all(map(importlib.util.find_spec, sys.argv[1:])))' \
  h5py jinja2 matplotlib PIL ||
  fail "$python lacks the packages of the pictures: install those of scripts/requirements.txt, or start without --system."
exec "$python" -I -X utf8 "$root/scripts/plot/start.py" plot.demo \
  --bin "$root/build/$preset/bin" --out "${DROGUE_DEMO_OUT:-$root/out/demo}" ${scenes[@]+"${scenes[@]}"}
