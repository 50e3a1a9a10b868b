#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "common/program/program.hpp"
#include "miniapps/options/app.hpp"
#include "tests/support/damaged.hpp"

namespace drogue::options_app {
namespace {

constexpr const char* sound_batch =
    "id,style,type,spot,strike,rate,dividend,maturity,lambda,alpha,beta,delta,variance\n"
    "0,american,put,0.8,1,0.1,0,1,1,8.15,-2.5,0.767,0.4\n"
    "1,european,call,0.9,1,0.05,0.02,0.5,-0.5,15,-5,0.5,0\n"
    "2,american,call,1.1,1,-0.01,0.03,2,2,11,-5,0,0.01\n"
    "\"quoted, \"\"id\"\"\",european,put,1,1,0.1,0,1,-0.5,15,-5,0.5,0.0\n";

class DamagedBatch : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directory(folder); }
  void TearDown() override { std::filesystem::remove_all(folder); }

  /// How the program ends with a batch, in a process of its own, since Kokkos starts once in each; what it
  /// says goes to `said`.
  int end_of(const std::string& batch, std::string& said) const {
    const std::string input = folder / "batch.csv", output = folder / "prices.csv", errors = folder / "said";
    std::ofstream(input, std::ios::binary) << batch;
    std::fflush(nullptr);
    const pid_t child = ::fork();
    if (child == 0) {
      if (std::freopen(errors.c_str(), "w", stderr) == nullptr) ::_exit(99);
      const char* words[] = {"drogue-options", "price",   input.c_str(), "--out", output.c_str(), "--backend",
                             "serial",         "--quiet", "--mesh",      "32",    "--steps",      "8"};
      const int code = run_program("drogue-options", [&] {
        return run_app(parse_command(static_cast<int>(std::size(words)), words));
      });
      std::fflush(stderr);
      ::_exit(code);
    }
    int status = -1;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    std::ifstream in(errors, std::ios::binary);
    said.assign(std::istreambuf_iterator<char>(in), {});
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("drogue-damaged-" + std::to_string(::getpid()));
};

// The program never ends by a signal or with a code other than these, and says one sentence where it refuses.
TEST_F(DamagedBatch, IsRefusedOrPriced) {
  constexpr unsigned mutations = 500;
  std::set<int> codes;
  for (unsigned seed = 0; seed < mutations; ++seed) {
    std::string said;
    const int code = end_of(testing::damaged(sound_batch, seed), said);
    EXPECT_TRUE(code == 0 || code == 3 || code == 4) << "mutation " << seed << ": " << code << "\n" << said;
    EXPECT_EQ(std::ranges::count(said, '\n'), code == 0 ? 0 : 1) << "mutation " << seed << ": " << said;
    codes.insert(code);
  }
  EXPECT_TRUE(codes.contains(0) && codes.contains(3));
}

}  // namespace
}  // namespace drogue::options_app
