#include "perf/caches/host_caches.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "common/run/files/temporary_folder.hpp"

namespace drogue::perf {
namespace {

using Caches = std::map<std::int64_t, int>;

/// The folder in which Linux describes its cores.
class HostCaches : public testing::Test {
 protected:
  void add(int core, const std::string& index, const std::string& level, const std::string& type,
           const std::string& size, const std::string& cores) {
    const std::filesystem::path cache = folder() / ("cpu" + std::to_string(core)) / "cache" / index;
    std::filesystem::create_directories(cache);
    for (const auto& [name, text] :
         {std::pair{"level", level}, {"type", type}, {"size", size}, {"shared_cpu_list", cores}})
      std::ofstream(cache / name) << text << "\n";
  }
  [[nodiscard]] std::filesystem::path folder() const { return _folder.path(); }

 private:
  run::TemporaryFolder _folder{"drogue-caches"};
};

TEST_F(HostCaches, SharedOnesCountOnce) {
  for (int core = 0; core < 4; ++core) {
    const std::string own = std::to_string(core);
    add(core, "index0", "1", "Data", "32K", own);
    add(core, "index1", "1", "Instruction", "64K", own);
    add(core, "index2", "2", "Unified", "256K", own);
    add(core, "index3", "3", "Unified", "20480K", core < 2 ? "0-1" : "2-3");
  }
  std::filesystem::create_directories(folder() / "cpufreq" / "cache");
  EXPECT_EQ(host_caches(1, folder()), (Caches{{32 << 10, 4}}));
  EXPECT_EQ(host_caches(2, folder()), (Caches{{256 << 10, 4}}));
  EXPECT_EQ(host_caches(3, folder()), (Caches{{20 << 20, 2}}));
}

TEST_F(HostCaches, CoresOfTwoKindsHaveSizesOfTheirOwn) {
  add(0, "index2", "2", "Unified", "2048K", "0");
  add(10, "index2", "2", "Unified", "4096K", "10-13");
  add(11, "index2", "2", "Unified", "4096K", "10-13");
  EXPECT_EQ(host_caches(2, folder()), (Caches{{2 << 20, 1}, {4 << 20, 1}}));
  EXPECT_EQ(host_cache_bytes(2, folder()), 6 << 20);
  EXPECT_EQ(host_cache_bytes(3, folder()), 0);
}

TEST_F(HostCaches, LeaveOutCoresWithoutAFolder) {
  add(0, "index2", "2", "Unified", "256K", "0");
  std::filesystem::create_directories(folder() / "cpu1");
  std::ofstream(folder() / "cpu2") << "no folder\n";
  add(3, "index2", "2", "Unified", "256K", "3");
  EXPECT_EQ(host_caches(2, folder()), (Caches{{256 << 10, 2}}));
}

TEST_F(HostCaches, AreUnknownWhereTheSystemStatesTooLittle) {
  EXPECT_EQ(host_caches(3, folder()), Caches{});
  EXPECT_EQ(host_caches(3, folder() / "missing"), Caches{});
  add(0, "index3", "3", "Unified", "0K", "0");
  EXPECT_EQ(host_caches(3, folder()), Caches{});
  add(0, "index3", "3", "Unified", "8192K", "");
  EXPECT_EQ(host_caches(3, folder()), Caches{});
  add(0, "index3", "3", "Unified", "8 MB", "0");
  EXPECT_EQ(host_caches(3, folder()), Caches{});
}

}  // namespace
}  // namespace drogue::perf
