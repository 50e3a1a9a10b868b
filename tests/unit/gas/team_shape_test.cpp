#include "kernels/gas/tile/team_shape.hpp"

#include <gtest/gtest.h>

namespace drogue::gas {
namespace {

// Kokkos refuses a launch that exceeds the limit; 384 slots of all rows did.
TEST(TeamShape, EveryTeamSizeFitsItsSharedMemory) {
  constexpr int largest_halo = 12;  // of a scheme with four stages
  for (const int rows : {cell_rows, device_rows})
    for (int team = 32; team <= largest_team; team += 32) {
      const int slots = fitting_slots(rows, team, team);
      EXPECT_LE(shared_bytes(rows, slots, team), max_shared_bytes) << team;
      EXPECT_GT(slots, 2 * largest_halo) << team;
      EXPECT_TRUE(slots == team || shared_bytes(rows, slots + 1, team) > max_shared_bytes) << team;
    }
  EXPECT_EQ(fitting_slots(device_rows, largest_tile, default_team), largest_tile);
}

}  // namespace
}  // namespace drogue::gas
