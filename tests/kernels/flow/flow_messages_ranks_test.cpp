#include <gtest/gtest.h>
#include <mpi.h>

#include <array>
#include <cstdint>
#include <memory>

#include "kernels/flow/halo/decomposition.hpp"
#include "kernels/flow/solver.hpp"
#include "tests/support/backend.hpp"
#include "tests/support/ranks.hpp"

// The estimate of the numbers that a rank sends against those that MPI gets.

namespace {

/// Numbers that this rank has given to MPI for others, each for every receiver.
double sent_by_mpi = 0.0;

}  // namespace

// These take the place of the functions of MPI in this program (MPI standard, profiling interface).
extern "C" {

int MPI_Isend(const void* values, int count, MPI_Datatype type, int to, int tag, MPI_Comm group,
              MPI_Request* request) {
  sent_by_mpi += count;
  return PMPI_Isend(values, count, type, to, tag, group, request);
}

int MPI_Allgather(const void* mine, int count, MPI_Datatype type, void* all, int all_count,
                  MPI_Datatype all_type, MPI_Comm group) {
  int ranks = 0;
  MPI_Comm_size(group, &ranks);
  sent_by_mpi += static_cast<double>(all_count) * (ranks - 1);
  return PMPI_Allgather(mine, count, type, all, all_count, all_type, group);
}

int MPI_Alltoallv(const void* sent, const int* counts, const int* offsets, MPI_Datatype type, void* received,
                  const int* received_counts, const int* received_offsets, MPI_Datatype received_type,
                  MPI_Comm group) {
  int ranks = 0, own = 0;
  MPI_Comm_size(group, &ranks);
  MPI_Comm_rank(group, &own);
  for (int rank = 0; rank < ranks; ++rank) sent_by_mpi += rank == own ? 0 : counts[rank];
  return PMPI_Alltoallv(sent, counts, offsets, type, received, received_counts, received_offsets,
                        received_type, group);
}
}

namespace drogue::flow {
namespace {

/// Numbers that this rank sends in a step in a periodic box.
double sent_in_a_step(const Parameters& p, const linear::RankGroup& group) {
  const std::unique_ptr<Solver> solver = create_solver(testing::tested_backend, p, group);
  solver->start();
  std::int64_t end = 0;
  const auto sent_in = [&](int steps) {
    const double before = sent_by_mpi;
    EXPECT_EQ(Stop::pause, solver->advance(1e300, end += steps, {}));
    return sent_by_mpi - before;
  };
  sent_in(1);
  const double few = sent_in(2);  // with the ghost cells at the end of an advance
  return sent_in(3) - few;
}

TEST(FlowMessages, AreAsManyAsTheDivisionExpects) {
  if (linear::RankGroup::world().size() != 4) GTEST_SKIP() << "needs mpirun with four ranks";
  if (device::needs_device(testing::tested_backend)) GTEST_SKIP() << "devices have messages without MPI";
  struct Division {
    std::array<int, 3> cells;
    int ranks;
    bool slabs;
    std::array<int, 3> parts;
  };
  for (const Division& each : {Division{{16, 16, 8}, 2, true, {1, 1, 2}},
                               {{16, 16, 16}, 4, true, {1, 1, 4}},
                               {{16, 16, 4}, 2, false, {1, 2, 1}},
                               {{16, 16, 4}, 4, false, {1, 4, 1}},
                               {{24, 8, 8}, 4, false, {1, 2, 2}}}) {
    Parameters p;
    p.cells = each.cells;
    p.slabs = each.slabs;
    p.time_scheme = TimeScheme::ab2;
    p.fixed_dt = 0.01;
    const linear::RankGroup group = testing::first_ranks(each.ranks);
    if (!testing::belongs_to_first(each.ranks)) continue;
    ASSERT_EQ(each.parts, ranks_of(p, each.ranks, group.rank(), false).parts);
    // The line without shunts has a third number for each other rank.
    const double third = each.slabs ? each.ranks - 1 : 0;
    EXPECT_DOUBLE_EQ(numbers_sent(each.cells, each.parts[1], each.parts[2]) + third, sent_in_a_step(p, group))
        << each.parts[1] << " x " << each.parts[2];
  }
}

}  // namespace
}  // namespace drogue::flow
