#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <vector>

#include "kernels/coupling/sheet/state_list.hpp"

// List of the arrays of a state.

namespace drogue::coupling {
namespace {

using Space = DROGUE_TEST_SPACE;
using Vectors = Kokkos::View<double* [3], Kokkos::LayoutLeft, Space::memory_space>;

TEST(StateList, SavesRollsBackAndRestoresAMemberThatIsAdded) {
  constexpr int rows = 5;
  const Space space;
  // The columns of one member have gaps, as those of padded vertices.
  const Vectors padded("padded", 8), vectors("vectors", rows);
  const StateView<Space> list("list", 7, 1), scratch("scratch", rows, 2);
  StateList<Space> state(rows);
  state.add("position", "m", Kokkos::subview(padded, Kokkos::make_pair(0, rows), Kokkos::ALL));
  state.add("at_faces", "m/s", list, {.saved = false});
  state.add("scratch", "N", scratch, {.restarted = false});
  const auto names = [&] {
    std::vector<std::string> all;
    for (const stepping::StateArray& array : state.arrays()) all.push_back(array.name);
    return all;
  };
  EXPECT_EQ(names(), (std::vector<std::string>{"position", "at_faces"}));
  state.add("added", "m/s^2", vectors);
  EXPECT_EQ(names(), (std::vector<std::string>{"position", "at_faces", "added"}));
  EXPECT_EQ(state.arrays()[1].extent, (std::vector<std::size_t>{7}));
  EXPECT_EQ(state.arrays()[2].extent, (std::vector<std::size_t>{rows, 3}));
  EXPECT_EQ(state.arrays()[2].unit, "m/s^2");

  const auto fill = [&](const char* name, std::size_t size, double first) {
    std::vector<double> values(size);
    std::iota(values.begin(), values.end(), first);
    state.upload(space, name, values);
    return values;
  };
  const auto holds = [&](const char* name, const std::vector<double>& expected) {
    std::vector<double> values(expected.size());
    state.download(space, name, values);
    return values == expected;
  };
  const auto position = fill("position", 15, 1.0), added = fill("added", 15, 100.0),
             others = fill("scratch", 10, 200.0);
  const auto mirror = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), vectors);
  EXPECT_EQ(mirror(1, 2), added[5]) << "the last index varies fastest on the host";
  device::launch_each(space, "save", rows, state.save());
  fill("position", 15, -1.0), fill("added", 15, -1.0), fill("scratch", 10, -1.0);
  const auto faces = fill("at_faces", 7, 300.0);
  state.roll_back(space);
  EXPECT_TRUE(holds("position", position));
  EXPECT_TRUE(holds("added", added));
  EXPECT_TRUE(holds("scratch", others));
  EXPECT_TRUE(holds("at_faces", faces)) << "it is not saved";
  state.clear(space);
  EXPECT_TRUE(holds("added", std::vector<double>(15, 0.0)));
  EXPECT_TRUE(holds("scratch", others)) << "it is not a part of restarts";
}

TEST(StateList, RejectsUnknownNamesWrongLengthsAndTooManyMembers) {
  const Space space;
  StateList<Space> state(2);
  state.add("force", "N", Vectors("force", 2));
  std::vector<double> values(6), few(5);
  EXPECT_NO_THROW(state.download(space, "force", values));
  EXPECT_THROW(state.download(space, "forces", values), std::invalid_argument);
  EXPECT_THROW(state.download(space, "force", few), std::invalid_argument);
  EXPECT_THROW(state.upload(space, "force", few), std::invalid_argument);
  for (int k = 1; k < CopyRowsFunctor<Space>::most; ++k) state.add("more", "N", Vectors("more", 2));
  EXPECT_THROW(state.add("one too many", "N", Vectors("more", 2)), std::logic_error);
}

}  // namespace
}  // namespace drogue::coupling
