#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <vector>

#include "kernels/stepping/state_list.hpp"

// List of the arrays of a state.

namespace drogue::stepping {
namespace {

using Space = DROGUE_TEST_SPACE;
struct Peak {
  double force, time;
};
using Vectors = Kokkos::View<double* [3], Kokkos::LayoutLeft, Space::memory_space>;

TEST(StateList, SavesRollsBackAndRestoresAMemberThatIsAdded) {
  constexpr int rows = 5;
  const Space space;
  // The columns of one member have gaps, as those of padded vertices.
  const Vectors padded("padded", 8), vectors("vectors", rows);
  const Kokkos::View<double* [1], Space::memory_space> list("list", 7);
  const Kokkos::View<double* [2], Space::memory_space> scratch("scratch", rows);
  const Kokkos::View<Peak*, Space::memory_space> peaks("peaks", 2);
  StateList<Space> state;
  state.add("position", "m", padded, rows);
  state.add("at_faces", "m/s", list, 7, {.saved = false});
  state.add("scratch", "N", scratch, rows, {.restarted = false});
  state.add("peak_time", "s", peaks, &Peak::time, {.saved = false, .restarted = false});
  const auto names = [&] {
    std::vector<std::string> all;
    for (const StateArray& array : state.arrays()) all.push_back(array.name);
    return all;
  };
  EXPECT_EQ(names(), (std::vector<std::string>{"position", "at_faces"}));
  state.add("added", "m/s^2", vectors, rows);
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
  const StateList<Space>::Packed saved("saved", state.size());
  const auto copy = [&](bool packs) {
    device::launch_each(space, "copy", state.most_rows(), CopyStateFunctor<Space>{state, saved, packs});
  };
  copy(true);
  fill("position", 15, -1.0), fill("added", 15, -1.0), fill("scratch", 10, -1.0);
  const auto faces = fill("at_faces", 7, 300.0);
  copy(false);
  EXPECT_TRUE(holds("position", position));
  EXPECT_TRUE(holds("added", added));
  EXPECT_TRUE(holds("scratch", others));
  EXPECT_TRUE(holds("at_faces", faces)) << "it is not saved";
  state.clear(space);
  EXPECT_TRUE(holds("added", std::vector<double>(15, 0.0)));
  EXPECT_TRUE(holds("scratch", others)) << "it is not a part of restarts";
  const auto force = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), peaks);
  force(1).force = 7.0;
  Kokkos::deep_copy(peaks, force);
  const auto times = fill("peak_time", 2, 3.0);
  EXPECT_TRUE(holds("peak_time", times));
  Kokkos::deep_copy(force, peaks);
  EXPECT_EQ(force(1).force, 7.0) << "other members of the structs stay";
}

TEST(StateList, RejectsUnknownNamesWrongLengthsAndTooManyMembers) {
  const Space space;
  const Vectors force("force", 2);
  StateList<Space> state;
  state.add("force", "N", force, 2);
  std::vector<double> values(6), few(5);
  EXPECT_NO_THROW(state.download(space, "force", values));
  EXPECT_THROW(state.download(space, "forces", values), std::invalid_argument);
  EXPECT_THROW(state.download(space, "force", few), std::invalid_argument);
  EXPECT_THROW(state.upload(space, "force", few), std::invalid_argument);
  for (int k = 1; k < StateList<Space>::most; ++k) state.add("more", "N", force, 2);
  EXPECT_THROW(state.add("one too many", "N", force, 2), std::length_error);
}

}  // namespace
}  // namespace drogue::stepping
