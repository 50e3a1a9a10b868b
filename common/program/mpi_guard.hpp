#pragma once

#include <string>

namespace drogue {

/// Place of this process among those that one launcher started; needs no MPI_Init.
struct LaunchedRank {
  int rank = 0;
  int ranks = 1;
};

/// Read from what mpirun (Open MPI), MPICH, Intel MPI and srun with PMI or PMIx leave in the environment. The
/// task count of a Slurm job alone says nothing: a job script sees it too.
LaunchedRank launched_rank();

/// Throws Failure(usage) if the launcher started more than one rank; for a `program` without a parallel
/// solver.
void require_one_rank(const std::string& program);

}  // namespace drogue
