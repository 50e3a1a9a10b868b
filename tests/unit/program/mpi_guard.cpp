#include "common/program/mpi_guard.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <utility>
#include <vector>

#include "tests/support/refusal.hpp"

namespace drogue {
namespace {

/// Environment of one launcher for the length of a test, without variables of other launchers.
class Launcher {
 public:
  explicit Launcher(const std::vector<std::pair<const char*, const char*>>& variables) {
    clear();
    for (const auto& [name, value] : variables) setenv(name, value, 1);
  }
  ~Launcher() { clear(); }
  Launcher(const Launcher&) = delete;
  Launcher& operator=(const Launcher&) = delete;

 private:
  static void clear() {
    for (const char* name : {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE", "PMI_RANK", "PMI_SIZE",
                             "PMIX_RANK", "SLURM_NTASKS", "SLURM_PROCID"}) {
      unsetenv(name);
    }
  }
};

TEST(MpiGuard, FindsOneRankWithoutALauncher) {
  const Launcher none({});
  EXPECT_EQ(launched_rank().ranks, 1);
  EXPECT_NO_THROW(require_one_rank());
}

TEST(MpiGuard, RecognizesLaunchers) {
  const std::vector<std::vector<std::pair<const char*, const char*>>> launchers = {
      {{"OMPI_COMM_WORLD_RANK", "2"}, {"OMPI_COMM_WORLD_SIZE", "4"}},
      {{"PMI_RANK", "2"}, {"PMI_SIZE", "4"}},
      {{"PMIX_RANK", "2"}, {"SLURM_NTASKS", "4"}},
  };
  for (const auto& variables : launchers) {
    const Launcher launcher(variables);
    EXPECT_EQ(launched_rank().rank, 2) << variables[0].first;
    EXPECT_EQ(launched_rank().ranks, 4) << variables[0].first;
    const std::string refusal = testing::refusal_of(require_one_rank, ExitCode::usage);
    EXPECT_NE(refusal.find("not 4"), std::string::npos) << variables[0].first << refusal;
    // `run_program` prints the name of the program.
    EXPECT_EQ(refusal.find("drogue-"), std::string::npos) << refusal;
  }
}

TEST(MpiGuard, AcceptsOneRankUnderALauncher) {
  const Launcher launcher({{"OMPI_COMM_WORLD_RANK", "0"}, {"OMPI_COMM_WORLD_SIZE", "1"}});
  EXPECT_NO_THROW(require_one_rank());
}

TEST(MpiGuard, IgnoresTheTaskCountOfAJobScript) {
  const Launcher job({{"SLURM_NTASKS", "64"}, {"SLURM_PROCID", "0"}});
  EXPECT_EQ(launched_rank().ranks, 1);
}

TEST(MpiGuard, AcceptsTheNumberOfRanksAlone) {
  const std::vector<std::pair<const char*, const char*>> variables = {{"OMPI_COMM_WORLD_SIZE", "2"}};
  const Launcher launcher(variables);
  EXPECT_EQ(launched_rank().rank, 0);
  EXPECT_EQ(launched_rank().ranks, 2);
}

TEST(MpiGuard, IgnoresInvalidValues) {
  const Launcher nonsense({{"OMPI_COMM_WORLD_RANK", "0"}, {"OMPI_COMM_WORLD_SIZE", "many"}});
  EXPECT_EQ(launched_rank().ranks, 1);
}

}  // namespace
}  // namespace drogue
