#!/usr/bin/env bash
# Profiles the main kernels of all mini-apps by ncu on a GPU and compares their resident blocks with the model of occupancy; the CSV
# files and occupancy.jsonl go to FOLDER. FILTER, a regular expression for the names of the cases, replaces the choice below.
#   scripts/profile_occupancy.sh FOLDER [BUILD [FILTER]]
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"

folder=${1:?usage: scripts/profile_occupancy.sh FOLDER [BUILD [FILTER]]}
perf=${2:-$root/build/cuda}/bin/drogue-perf
filter=${3:-'^(gas-step/cuda/(8192(/(stages|seed))?|16777216(/(split|on))?)|springs-step/cuda/(2640|1000000(/verlet)?)|springs-contact/cuda/15625|options/cuda/(1|4096)/128x32|options-(surface/cuda/surface/1x33x8|cos/cuda/256)|flow-step/cuda/(64x64x64/periodic|256x256x256/(tunnel/vreman|periodic/(crank-nicolson|diagonalization)))|parachute-flight/cuda/60x60x120/c9-contact)$'}
mkdir -p "$folder"
nvcc="$(find_nvcc)"
PATH="$PATH:${nvcc%/*}"
command -v ncu >/dev/null || fail "ncu is not on the PATH: install Nsight Compute, which the CUDA toolkit holds."
mapfile -t cases < <("$perf" list | grep -E "$filter" || true)
[ ${#cases[@]} -gt 0 ] || fail "no case of '$perf list' matches '$filter': is this a build with CUDA, on a machine with a GPU?"

# One case must not lose the others.
missing=0
for case in "${cases[@]}"; do
  csv="$folder/${case//\//-}.csv"
  say "$case"
  code=0
  eval "$("$perf" ncu "$case" --out "$csv")" >"$csv.log" 2>&1 || code=$?
  if [ "$code" -ne 0 ]; then
    # ncu ends the program after the last launch that it profiles; some versions report that as a failure.
    say "ncu ended with $code; its last lines: $(tail -n 2 "$csv.log" | tr '\n' ' ')"
  fi
  if ! grep -q '^"[0-9]' "$csv" 2>/dev/null; then
    say "$case has no profiled kernel: $(grep -hE '^==(ERROR|WARNING)==' "$csv" "$csv.log" 2>/dev/null | head -n 2 | tr '\n' ' ')"
    rm -f "$csv"
    missing=$((missing + 1))
  fi
done
say "$((${#cases[@]} - missing)) of ${#cases[@]} cases were profiled"
"$perf" table occupancy --profile "$folder" --out "$folder/occupancy.jsonl"
[ "$missing" -eq 0 ] || fail "$missing cases have no profile."
