#pragma once

namespace drogue {

/// Rank of this process in its launch; needs no MPI_Init.
struct LaunchedRank {
  int rank = 0;
  int ranks = 1;
};

/// Reads the environment variables of Open MPI, MPICH, Intel MPI, and srun with PMI or PMIx. The task count
/// of a Slurm job alone is ignored: a job script has it too. Does not throw.
LaunchedRank launched_rank();

/// Throws `Failure` (usage) if the launcher started more than one rank. For programs without a parallel
/// solver.
void require_one_rank();

}  // namespace drogue
