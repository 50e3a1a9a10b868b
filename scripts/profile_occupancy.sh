#!/usr/bin/env bash
# Profiles the kernels of all mini-apps by ncu on a GPU and compares their resident blocks with the model of occupancy; the CSV files
# and occupancy.jsonl go to FOLDER. FILTER, a regular expression for the names of cases of drogue-perf and of the runs below, replaces
# the choice of cases and limits the runs.
#   scripts/profile_occupancy.sh FOLDER [BUILD [FILTER]]
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"

folder=${1:?usage: scripts/profile_occupancy.sh FOLDER [BUILD [FILTER]]}
bin=${2:-$root/build/cuda}/bin
perf=$bin/drogue-perf
filter=${3:-'^(gas-step/cuda/(8192(/(stages|seed))?|16777216(/(split|on))?)|springs-step/cuda/(2640|1000000(/verlet)?)|springs-contact/cuda/15625|options/cuda/(1|4096)/128x32|options-(surface/cuda/surface/1x33x8|cos/cuda/256)|flow-step/cuda/(64x64x64/periodic|256x256x256/(tunnel/vreman|periodic/(crank-nicolson|diagonalization)))|parachute-flight/cuda/60x60x120/c9-contact)$'}
# Runs of scenes for kernels that no case launches: name, program, scene, and values for --set.
runs='gas-totals drogue-gas sod
gas-limited drogue-gas blast scheme.positivity="on"
springs-catenary drogue-springs catenary time.end_time=0.05
springs-plain drogue-springs catenary time.end_time=0.01 tuning.step.driver="plain"
springs-string drogue-springs string-longitudinal time.end_time=0.01
springs-damped drogue-springs hencky time.end_time=0.01 tuning.step.driver="plain"
springs-contact drogue-springs cloth-on-sphere time.end_time=0.01
springs-twisted drogue-springs twist time.end_time=0.01
springs-hung drogue-springs table-cloth time.end_time=0.01
springs-pulled drogue-springs stress-wave time.end_time=0.001
springs-rings drogue-springs drum time.end_time=0.01 load=[{follower_pressure=1.0}]
springs-stages drogue-springs drum time.end_time=0.002 load=[{follower_pressure=1.0}] tuning.step.driver="plain"
springs-outputs drogue-springs drum time.end_time=0.002 output={fields=["vertex_von_mises"],times=[0.0]}
parachute-walls drogue-parachute oscillating-plate run.end_time=0.2
parachute-outflow drogue-parachute jet run.end_time=0.2
parachute-inflow drogue-parachute uniform run.end_time=0.2 grid.boundary.x="inflow" fluid.velocity=["1+0.1*t",0,0]
parachute-outputs drogue-parachute taylor-green-2d run.end_time=0.02 output={fields=["pressure"],times=[0]}
parachute-sharp drogue-parachute porous-channel-sharp run.end_time=0.1
parachute-moving-grid drogue-parachute c9-drop run.end_time=0.2
parachute-inset drogue-parachute c9-guided run.end_time=0.2
parachute-explicit drogue-parachute c9-heavy run.end_time=0.05
parachute-cluster drogue-parachute cluster-3 run.end_time=0.05
parachute-drop drogue-parachute cloth-drop run.end_time=0.02
parachute-strength drogue-parachute c9-flat run.end_time=0.1 canopy[0].lines.strength=1e5'
# Their kernels; without this choice the launches of a step would use up the number that is profiled.
rare='(Add|Boundary|Check|Copy|Count|Crossing|Damping|Dirichlet|EdgeInset|EndSharp|EndVertex|External|Flush|Force|Gather|Guide|Impose|Initial|Largest|Level|LoadStiff|Mean|Motion|NetInflow|Outflow|Publish|Restore|Rings|Row|RungeKutta|Sample|SaveFaces|Shift|Stress|Sum|Symplectic|Totals|Triangle)\w*Functor'

mkdir -p "$folder"
nvcc="$(find_nvcc)"
PATH="$PATH:${nvcc%/*}"
command -v ncu >/dev/null || fail "ncu is not on the PATH: install Nsight Compute, which the CUDA toolkit holds."
mapfile -t cases < <("$perf" list | grep -E "$filter" || true)
mapfile -t chosen < <(if [ $# -gt 2 ]; then grep -E "^[^ ]*($filter)" <<<"$runs" || true; else printf '%s\n' "$runs"; fi)
[ $((${#cases[@]} + ${#chosen[@]})) -gt 0 ] ||
  fail "no case of '$perf list' and no run matches '$filter': is this a build with CUDA, on a machine with a GPU?"

# profile NAME WORDS...: writes FOLDER/NAME.csv by the command that `drogue-perf ncu WORDS` prints. One must not lose the others.
missing=0
profile() {
  local name="$1" csv="$folder/${1//\//-}.csv" code=0
  shift
  say "$name"
  eval "$("$perf" ncu --out "$csv" "$@")" >"$csv.log" 2>&1 || code=$?
  if [ "$code" -ne 0 ]; then
    # ncu ends the program after the last launch that it profiles; some versions report that as a failure.
    say "ncu ended with $code; its last lines: $(tail -n 2 "$csv.log" | tr '\n' ' ')"
  fi
  if ! grep -q '^"[0-9]' "$csv" 2>/dev/null; then
    say "$name has no profiled kernel: $(grep -hE '^==(ERROR|WARNING)==' "$csv" "$csv.log" 2>/dev/null | head -n 2 | tr '\n' ' ')"
    rm -f "$csv"
    missing=$((missing + 1))
  fi
}

for case in "${cases[@]}"; do profile "$case" "$case"; done
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
for run in "${chosen[@]}"; do
  read -r name program scene values <<<"$run"
  command=("$bin/$program" "$scene" --backend cuda --out "$scratch/$name" --set 'verify={}')
  # The times of outputs may lie behind the new end.
  case "$values" in *end_time*) command+=(--set 'output={}') ;; esac
  for value in $values; do command+=(--set "$value"); done
  profile "$name" --launches 120 --kernels "drogue::.*$rare" --command -- "${command[@]}"
done
total=$((${#cases[@]} + ${#chosen[@]}))
say "$((total - missing)) of $total cases and runs were profiled"
"$perf" table occupancy --profile "$folder" --out "$folder/occupancy.jsonl"
[ "$missing" -eq 0 ] || fail "$missing of them have no profile."
