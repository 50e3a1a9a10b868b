#!/bin/bash
#SBATCH --job-name=drogue-parachute
#SBATCH --nodes=2
#SBATCH --ntasks-per-node=4
#SBATCH --gpus-per-node=4
#SBATCH --cpus-per-task=8
#SBATCH --time=04:00:00
#SBATCH --signal=TERM@120
#SBATCH --output=%x-%j.log
#
# One flow on several GPUs, one rank each, which divide its planes along z. All GPUs of a node are visible to each of its
# ranks, and a rank takes the one of its number on the node (SLURM_LOCALID). 120 s before the time limit Slurm sends SIGTERM
# to all ranks, and the run ends with its restart file written (exit code 130); the next job goes on from there.
#
#   sbatch examples/slurm-gpus.sh SCENE [OPTIONS...]
set -u

scene="${1:?the scene to run}"
shift
build="${DROGUE_BUILD_DIR:-build/cuda}"
export OMP_NUM_THREADS=1

# --mpi=pmix for Open MPI; `srun --mpi=list` names those of the cluster.
exec srun --mpi=pmix --gpu-bind=none "$build/bin/drogue-parachute" "$scene" --backend cuda --out "out/$(basename "$scene" .toml)" \
  --restart auto "$@"
