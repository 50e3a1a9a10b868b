#include <gtest/gtest.h>

#include <cstdint>

#include <Kokkos_Core.hpp>

#include "kernels/device/launch.hpp"

// Launches on an execution-space instance that is not the default one.

namespace drogue::device {
namespace {

using Space = Kokkos::Serial;
using Policy = Kokkos::TeamPolicy<Space>;

/// Stores the address of the scratch memory of the team, which belongs to the instance that runs it.
struct ScratchAddressFunctor {
  Kokkos::View<std::uintptr_t, Kokkos::HostSpace> address;

  KOKKOS_FUNCTION void operator()(const Policy::member_type& member) const {
    address() = reinterpret_cast<std::uintptr_t>(member.team_scratch(0).get_shmem(8));
  }
};

TEST(LaunchTeams, RunsOnTheInstanceOfThePolicy) {
  const auto instances = Kokkos::Experimental::partition_space(Space(), 1, 1);
  std::uintptr_t addresses[2];
  for (std::size_t i = 0; i < 2; ++i) {
    const ScratchAddressFunctor functor{Kokkos::View<std::uintptr_t, Kokkos::HostSpace>("address")};
    launch_teams("scratch_address", Policy(instances[i], 1, 1).set_scratch_size(0, Kokkos::PerTeam(64)),
                 functor);
    instances[i].fence("scratch_address");
    addresses[i] = functor.address();
  }
  EXPECT_NE(addresses[0], addresses[1]);
}

}  // namespace
}  // namespace drogue::device
