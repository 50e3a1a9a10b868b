#!/usr/bin/env bash
# Climbs all ladders on one backend; the records go to FOLDER. scripts/lesson_tables.py makes tables of those in docs/evidence/ladders.
#   scripts/measure_ladders.sh FOLDER BACKEND MACHINE [BUILD]
set -euo pipefail

usage='usage: scripts/measure_ladders.sh FOLDER BACKEND MACHINE [BUILD]'
folder=${1:?$usage} backend=${2:?$usage} machine=${3:?$usage}
build=${4:-build/$([ "$backend" = cuda ] && echo cuda || echo host)}
mkdir -p "$folder"
for ladder in weno springs options transfers; do
  "$build/bin/drogue-perf" ladder "$ladder" --backend "$backend" --out "$folder/$ladder-$backend-$machine.jsonl"
done
