#!/bin/bash
#SBATCH --job-name=drogue-gas
#SBATCH --nodes=1
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=16
#SBATCH --gres=gpu:1
#SBATCH --time=01:00:00
#SBATCH --signal=B:TERM@120
#SBATCH --requeue
#SBATCH --output=%x-%j.log
#
# One run on one GPU that survives the time limit: 120 s before it Slurm sends SIGTERM, the program ends after a whole
# step with its restart file written (exit code 130), and the job is queued again and goes on from there.
#
#   sbatch examples/slurm.sh SCENE [OPTIONS...]
set -u

scene="${1:?the scene to run}"
shift
out="out/$(basename "$scene" .toml)"
build="${DROGUE_BUILD_DIR:-build/cuda}"
export OMP_NUM_THREADS="${SLURM_CPUS_PER_TASK:-1}" OMP_PROC_BIND=spread OMP_PLACES=cores

# With --restart auto a first start begins, and every later one goes on or, killed before its first restart file, begins
# again. In the background, so that this shell can hand the signal on.
"$build/bin/drogue-gas" "$scene" --backend auto --out "$out" --restart auto "$@" &
program=$!
signalled=no
trap 'signalled=yes; kill -TERM "$program"' TERM
wait "$program"
status=$?
# A trapped signal ends the first wait; the second one has the program's own exit code.
if [ "$signalled" = yes ]; then
  wait "$program"
  status=$?
fi

if [ "$status" -eq 130 ]; then
  scontrol requeue "$SLURM_JOB_ID"
fi
exit "$status"
