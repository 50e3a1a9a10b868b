#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "common/program/command_line.hpp"
#include "kernels/device/backend_list.hpp"

namespace {

using namespace drogue;

TEST(BackendChoices, EqualTheBackendsOfTheSourcesInTheirOrder) {
  std::vector<std::string> expected = {"auto"};
  device::for_each_backend<device::KnownBackends>(
      [&](const auto& entry) { expected.emplace_back(entry.name); });
  EXPECT_EQ(expected, backend_choices());
}

}  // namespace
