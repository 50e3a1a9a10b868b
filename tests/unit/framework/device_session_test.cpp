#include "miniapps/framework/device_session.hpp"

#include <gtest/gtest.h>

#include "kernels/device/host_cores.hpp"
#include "kernels/device/runtime.hpp"

namespace drogue::framework {
namespace {

TEST(ChooseBackend, ReplacesOpenMPBySerialWhereOneThreadDoesTheWork) {
  const device::Backend fastest = device::fastest_backend();
  const bool is_host = fastest == device::Backend::openmp;
  EXPECT_EQ(choose_backend("auto", 1), is_host ? device::Backend::serial : fastest);
  const bool has_threads = device::host_cores().allowed > 1 && device::default_threads() > 1;
  EXPECT_EQ(choose_backend("auto", 2), is_host && !has_threads ? device::Backend::serial : fastest);
}

TEST(ChooseBackend, AcceptsEveryBackendByNameWhateverTheWork) {
  for (const device::Backend backend : device::compiled_backends()) {
    if (device::why_unavailable(backend)) continue;
    EXPECT_EQ(choose_backend(std::string(device::name(backend)), 1), backend);
  }
}

TEST(HostCores, ArePositiveAndCountTheCaller) {
  const device::HostCores cores = device::host_cores();
  EXPECT_GE(cores.allowed, 1);
  EXPECT_GE(cores.online, cores.allowed);
  EXPECT_GE(cores.running, 1);
}

TEST(HostCores, AreSharedWithOtherProgramsAndWithinATooLargePool) {
  EXPECT_FALSE(device::are_cores_shared(4, {4, 4, 1}));
  EXPECT_TRUE(device::are_cores_shared(4, {4, 4, 2}));
  EXPECT_TRUE(device::are_cores_shared(5, {4, 8, 1}));
  // Programs on cores of the machine that this process may not use.
  EXPECT_FALSE(device::are_cores_shared(2, {2, 64, 60}));
  EXPECT_FALSE(device::are_cores_shared(1, {4, 4, 20}));
}

TEST(HostCores, GetAThreadForEveryShareOfTheWork) {
  EXPECT_EQ(device::useful_threads(0, 512), 1);
  EXPECT_EQ(device::useful_threads(511, 512), 1);
  EXPECT_EQ(device::useful_threads(512, 512), 2);
  EXPECT_EQ(device::useful_threads(std::int64_t{1} << 40, 512), 4097);
  EXPECT_EQ(device::useful_threads_on(false, 7), 7);
  EXPECT_EQ(device::useful_threads_on(true, 7), 1);
  EXPECT_EQ(device::useful_threads_on(true, 17), 2);
}

}  // namespace
}  // namespace drogue::framework
