#!/usr/bin/env bash
# Measures all tables on this machine: a file of records each, then one page of them. Starts where a killed one ended.
#
#   scripts/bench.sh [FOLDER] [--solutions] [--only REGEX] [--quick] [--backend B] [--bin DIR]
#     FOLDER       of the records and of report.html (default: out/bench)
#     --solutions  times to solution of all problems too, which take longer than all other tables
#     --only       the records whose name matches a regular expression; --list prints the names
#     --quick      few cases, few samples
#     --backend    cuda, openmp or serial (default: cuda if this machine has a GPU, else all of the host)
#     --bin        folder of built programs; without it they are built, with what they need
#
# A finished record is not made again; FOLDER/NAME.txt holds its command and what that printed. Exit code: 0; 5 if a row failed its check;
# 130 after a signal; else that of the first command that failed, after all others have run. scripts/publish_records.py copies the
# records into docs/evidence, and renews the tables of documents.
. "$(dirname "${BASH_SOURCE[0]}")/lib/common.sh"

folder="$root/out/bench" bin='' backend='' only='' solutions=no list=no quick=()
usage() { printf 'bench.sh: %s\n' "$*" >&2 && exit 2; }
while [ $# -gt 0 ]; do
  case "$1" in
    --solutions) solutions=yes ;;
    --list) list=yes ;;
    --quick) quick=(--quick) ;;
    --only | --backend | --bin)
      [ $# -gt 1 ] || usage "$1 needs a value."
      case "$1" in --only) only="$2" ;; --backend) backend="$2" ;; *) bin="$2" ;; esac
      shift
      ;;
    -h | --help) sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0" && exit 0 ;;
    -*) usage "unknown argument $1: see scripts/bench.sh --help." ;;
    *) folder="$1" ;;
  esac
  shift
done
code=0
[[ '' =~ $only ]] 2>/dev/null || code=$?
[ "$code" -lt 2 ] || usage "--only '$only' is no regular expression."
case "$backend" in '' | cuda | openmp | serial) ;; *) usage "there is no backend '$backend'; valid are cuda, openmp and serial." ;; esac

preset=host
if [ -z "$bin" ]; then
  [ "$backend" = openmp ] || [ "$backend" = serial ] || [ -z "$(find_nvcc)" ] || ! nvidia-smi -L >/dev/null 2>&1 || preset=cuda
  [ "$list" = yes ] || { "$root/scripts/setup.sh" && "$root/scripts/build.sh" "$preset" --target drogue-perf --target drogue-parachute; }
  bin="$root/build/$preset/bin"
fi
perf="$bin/drogue-perf"
[ -x "$perf" ] || [ "$list" = no ] || usage "there is no program $perf, which --list needs: build it by scripts/build.sh $preset, or name its folder by --bin."
[ -x "$perf" ] || usage "there is no program $perf: leave out --bin to build it."
cases="$("$perf" list ${quick[@]+"${quick[@]}"})" || fail "$perf list failed."
# CUDA alone in a build for it: its host backends are not vectorised, and a GPU that waits for a host lowers its clock.
if [ -z "$backend" ] && grep -q '/cuda/' <<<"$cases"; then backend=cuda; fi
case "$backend" in
  '') here='(serial|openmp|dense-loop|scatter-loop)' one=auto ;;
  serial) here='(serial|dense-loop|scatter-loop)' one=serial ;;
  *) here="$backend" one="$backend" ;;
esac

started=$SECONDS worst=0 child='' lock="$folder/.lock" partial="$folder/.partial"
stop() {
  [ -z "$child" ] || { kill -TERM "$child" 2>/dev/null && wait "$child"; } || true
  rm -rf "$partial"
  say "stopped by a signal; the same command goes on from here"
  exit 130
}

# command_line WORDS...: prints them as a shell reads them.
command_line() {
  local word
  for word in "$@"; do
    case "$word" in *[!A-Za-z0-9_./=:,-]*) printf "'%s' " "$word" ;; *) printf '%s ' "$word" ;; esac
  done
}

# is_selected NAMES...: whether --only matches one of them.
is_selected() {
  local name
  for name in "$@"; do [[ -z "$only" || "$name" =~ $only ]] && return 0; done
  return 1
}

# record NAME WORDS...: makes FOLDER/NAME.jsonl by drogue-perf WORDS --out, unless it is there.
record() {
  local name="$1" file="$folder/$1.jsonl" begin=$SECONDS code=0
  shift
  is_selected "$name" || return 0
  [ "$list" = no ] || { printf '%s\n' "$name" && return 0; }
  if [ -e "$file" ]; then
    if [ ! -e "$file.failed" ]; then say "$name is there" && return 0; fi
    say "$name is there; a row failed its check: remove $file to measure it again"
    if [ "$worst" = 0 ]; then worst=5; fi
    return 0
  fi
  mkdir -p "$(dirname "$file")" "$partial"
  # Beside this shell, which a signal reaches at once then.
  "$perf" "$@" ${quick[@]+"${quick[@]}"} --out "$partial/record.jsonl" >"$partial/text" 2>"$partial/reason" &
  child=$!
  wait "$child" || code=$?
  child=''
  if [ "$code" = 130 ]; then stop; fi
  if [ "$code" = 0 ] || [ "$code" = 5 ]; then
    { command_line drogue-perf "$@" ${quick[@]+"${quick[@]}"} && printf '\n' && cat "$partial/text"; } >"$folder/$name.txt"
    rm -f "$file.failed"
    [ "$code" = 0 ] || : >"$file.failed"
    mv "$partial/record.jsonl" "$file"
    say "[$((SECONDS - started)) s] $name: $((SECONDS - begin)) s$([ "$code" = 0 ] || echo '; a row failed its check')"
  else
    printf 'bench.sh: %s: exit code %s: %s\n' "$name" "$code" "$(tail -n 1 "$partial/reason")" >&2
  fi
  rm -rf "$partial"
  if [ "$worst" = 0 ] || [ "$worst" = 5 ]; then worst=$((code == 0 ? worst : code)); fi
}

# cases NAME KINDS: the cases of `run` whose name begins with one of KINDS, if this machine has some.
cases() {
  local filter="^($2)/$here(/|$)"
  if grep -qE "$filter" <<<"$cases"; then record "$1" run --filter "$filter"; fi
}

# ranks_here: number of cores, if mpirun starts as many ranks; else fails. Open MPI has no slots for hardware threads. --list starts
# no ranks: it needs an mpirun alone.
ranks_here() {
  local cores
  cores="$(lscpu -p=core,socket 2>/dev/null | grep -v '^#' | sort -u | wc -l)"
  cores="$((cores < $(nproc) ? cores : $(nproc)))"
  [ "$cores" -gt 1 ] && [ -n "$(command -v mpirun)" ] || return 1
  [ "$list" = yes ] || timeout 60 mpirun -n "$cores" true >/dev/null 2>&1 </dev/null || return 1
  printf '%s\n' "$cores"
}

# all_records: makes or lists all records of this machine that --only matches.
all_records() {
  cases gas-step 'gas-step|ceiling/[^/]+'
  cases springs-step springs-step
  cases springs-contact springs-contact
  cases options 'options|options-surface'
  cases options-cos options-cos
  cases tridiagonal tridiagonal
  cases flow-step flow-step
  cases flight parachute-flight
  # Batches of options without other cases in turns, which change what is in the caches.
  for count in $(grep -oE '^options/cuda/[0-9]+/' <<<"$cases" | sort -ut / -k 3n | cut -d / -f 3); do
    [ "$backend" != cuda ] || record "alone/options-$count" run --filter "^options/cuda/$count/"
  done
  record machine table machine --backend "$one"
  record occupancy table occupancy
  if [ "$backend" = cuda ]; then
    for app in gas options flow parachute; do record "$app-block" table block-size --app $app --backend cuda; done
    for app in gas springs flow; do record "$app-abstraction" table abstraction --app $app --backend cuda; done
  fi
  for app in gas springs options parachute; do record "$app-transfers" table transfers --app $app --backend "$one"; done
  record flow-pressure table pressure --backend "$one"
  record flow-memory table memory --backend "$one"
  for app in gas springs options flow; do record "scaling-$app" table scaling --app $app --backend "$one"; done
  if [ "$backend" != cuda ]; then
    [ "$one" = serial ] || record scaling-flow-weak table scaling --weak --backend "$one"
    if [ -n "$ranks" ]; then
      record scaling-flow-ranks table scaling --over ranks --most "$ranks" --backend "$one"
      record scaling-flow-ranks-weak table scaling --over ranks --weak --most "$ranks" --backend "$one"
    fi
  fi
  for ladder in weno springs options transfers; do record "ladder-$ladder" ladder $ladder --backend "$one"; done
  solver="$([ "$one" != auto ] && echo "$one" || echo serial)"
  if [ "$solutions" = no ]; then
    # It is none of the quick problems.
    [ ${#quick[@]} -gt 0 ] || record gas-shu-osher work-precision --app gas --filter '^shu-osher$' --backend "$solver"
    record springs-drum work-precision --app springs --filter '^drum$' --backend "$solver"
  else
    for app in gas springs options flow parachute; do record "$app-solution" work-precision --app $app --backend "$solver"; done
  fi
}

ranks=''
if [ "$backend" != cuda ] && is_selected scaling-flow-ranks scaling-flow-ranks-weak && ! ranks="$(ranks_here)"; then
  say "no scaling over ranks: this is one core, or mpirun does not start a rank on each of its cores"
fi
names="$(list=yes && all_records)"
[ -n "$names" ] || usage "no record of this machine matches --only '$only': --list prints the names of all."
[ "$list" = no ] || { printf '%s\n' "$names" && exit 0; }

mkdir -p "$folder" && [ -w "$folder" ] || fail "cannot write to $folder."
exec 9>"$lock"
flock -w 1 9 || fail "another bench.sh, or a program that it started, works in $folder."
# A killed one leaves the record that it had begun.
rm -rf "$partial"
build="$("$perf" --version) ${quick[*]-}"
[ -e "$folder/build.txt" ] || printf '%s\n' "$build" >"$folder/build.txt"
[ "$(cat "$folder/build.txt")" = "$build" ] ||
  fail "$folder holds records of another build or with other options ($(head -n 1 "$folder/build.txt")): name another folder, or remove it."
trap stop INT TERM HUP
all_records

code=0
"$perf" report "$folder" || code=$?
[ "$worst" != 0 ] || worst=$code
say "all tables after $((SECONDS - started)) s"
exit "$worst"
