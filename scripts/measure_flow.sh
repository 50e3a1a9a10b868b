#!/usr/bin/env bash
# Checks flow on a backend and measures it there; the records go to FOLDER.
#   scripts/measure_flow.sh FOLDER [BUILD [BACKEND]]
set -euo pipefail

folder=${1:?usage: scripts/measure_flow.sh FOLDER [BUILD [BACKEND]]}
build=${2:-build/cuda}
backend=${3:-cuda}
mkdir -p "$folder"

"$build/tests/flow_kernels_test_$backend"
"$build/tests/linear_kernels_test_$backend"
"$build/bin/drogue-perf" run --filter "^(flow-step/$backend|ceiling/memory/$backend)" --out "$folder/flow-step.jsonl"
"$build/bin/drogue-perf" table memory --backend "$backend" --out "$folder/flow-memory.jsonl"
"$build/bin/drogue-perf" table pressure --backend "$backend" --out "$folder/flow-pressure.jsonl"
"$build/bin/drogue-perf" work-precision --app flow --backend "$backend" --out "$folder/flow-solution.jsonl"
"$build/bin/drogue-perf" work-precision --app parachute --backend "$backend" --out "$folder/parachute-solution.jsonl"
