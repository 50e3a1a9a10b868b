#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "kernels/device/runtime.hpp"
#include "kernels/linear/parallel/rank_group.hpp"

namespace {

bool is_launched() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"})
    if (std::getenv(name) != nullptr) return true;
  return false;
}

/// Replaces this process by four ranks of the program. Returns if there is no mpirun.
void launch_four_ranks(char** argv) {
  // Open MPI otherwise refuses to run as root, and more ranks than cores.
  setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
  setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  setenv("OMPI_MCA_rmaps_base_oversubscribe", "1", 1);
  // It leaks memory at its end.
  const char* options = std::getenv("ASAN_OPTIONS");
  setenv("ASAN_OPTIONS", (std::string(options != nullptr ? options : "") + ":detect_leaks=0").c_str(), 1);
  std::vector<std::string> words = {"mpirun", "-n", "4"};
  for (char** word = argv; *word != nullptr; ++word) words.emplace_back(*word);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execvp("mpirun", arguments.data());
}

/// Prints the failures of a rank other than 0.
class FailurePrinter final : public ::testing::EmptyTestEventListener {
 public:
  explicit FailurePrinter(int rank) : _rank(rank) {}
  void OnTestPartResult(const ::testing::TestPartResult& result) override {
    if (result.failed()) std::cout << "rank " << _rank << ": " << result.summary() << std::endl;
  }

 private:
  int _rank;
};

}  // namespace

/// Main function of tests on four ranks. Started without a launcher, it starts itself by mpirun; without that
/// it runs on one rank, where the tests skip themselves.
int main(int argc, char** argv) {
  std::vector<char*> words(argv, argv + argc + 1);  // GoogleTest removes its own
  ::testing::InitGoogleTest(&argc, argv);
  if (::testing::FLAGS_gtest_list_tests) return RUN_ALL_TESTS();
  if (!is_launched()) launch_four_ranks(words.data());
  const int rank = drogue::linear::RankGroup::world().rank();
  const drogue::device::Runtime runtime(std::vector<std::string>(argv + 1, argv + argc));
  auto& listeners = ::testing::UnitTest::GetInstance()->listeners();
  if (rank != 0) {
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new FailurePrinter(rank));
  }
  return RUN_ALL_TESTS();
}
