#!/usr/bin/env bash
# Checks fabric on a GPU and measures it there; the records go to FOLDER.
#   scripts/measure_springs.sh FOLDER [CUDA_BUILD [EXACT_CUDA_BUILD]]
set -euo pipefail

folder=${1:?usage: scripts/measure_springs.sh FOLDER [CUDA_BUILD [EXACT_CUDA_BUILD]]}
build=${2:-build/cuda}
exact=${3:-build/cuda-exact}
mkdir -p "$folder"

"$build/tests/fabric_kernels_test_cuda"
if [ -x "$exact/tests/exact_fabric_test" ]; then "$exact/tests/exact_fabric_test"; fi
"$build/bin/drogue-perf" run --filter '^springs-step/(cuda|serial|scatter-loop)/' --out "$folder/springs-step.jsonl"
"$build/bin/drogue-perf" table transfers --app springs --backend cuda --out "$folder/springs-transfers.jsonl"
"$build/bin/drogue-perf" run --filter '^springs-contact/cuda/' --out "$folder/springs-contact.jsonl"
"$build/bin/drogue-perf" work-precision --app springs --backend cuda --out "$folder/springs-solution.jsonl"
