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

constexpr const char* valid_batch =
    "id,style,type,spot,strike,rate,dividend,maturity,lambda,alpha,beta,delta,variance\n"
    "0,american,put,0.8,1,0.1,0,1,1,8.15,-2.5,0.767,0.4\n"
    "1,european,call,0.9,1,0.05,0.02,0.5,-0.5,15,-5,0.5,0\n"
    "2,american,call,1.1,1,-0.01,0.03,2,2,11,-5,0,0.01\n"
    "\"quoted, \"\"id\"\"\",european,put,1,1,0.1,0,1,-0.5,15,-5,0.5,0.0\n";

class DamagedBatch : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directory(folder); }
  void TearDown() override { std::filesystem::remove_all(folder); }

  /// Exit code of the program for a batch, -1 if a signal ended it; its standard error in `errors`. Runs in a
  /// process of its own, since Kokkos can be initialized only once per process.
  int exit_code(const std::string& batch, std::string& errors) const {
    const std::string input = folder / "batch.csv", output = folder / "prices.csv",
                      error_file = folder / "errors";
    std::ofstream(input, std::ios::binary) << batch;
    std::fflush(nullptr);
    const pid_t child = ::fork();
    if (child == 0) {
      if (std::freopen(error_file.c_str(), "w", stderr) == nullptr) ::_exit(99);
      const char* words[] = {"drogue-options", "price",   input.c_str(), "--out", output.c_str(), "--backend",
                             "serial",         "--quiet", "--mesh",      "32",    "--steps",      "8"};
      const int code = run_program("drogue-options", [&] {
        return run_command(parse_command(static_cast<int>(std::size(words)), words));
      });
      std::fflush(stderr);
      ::_exit(code);
    }
    int status = -1;
    EXPECT_EQ(::waitpid(child, &status, 0), child);
    std::ifstream in(error_file, std::ios::binary);
    errors.assign(std::istreambuf_iterator<char>(in), {});
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("drogue-damaged-" + std::to_string(::getpid()));
};

TEST_F(DamagedBatch, EndsWithDocumentedCodeAndOneSentence) {
  constexpr unsigned mutations = 500;
  std::set<int> codes;
  for (unsigned seed = 0; seed < mutations; ++seed) {
    std::string errors;
    const int code = exit_code(testing::damaged(valid_batch, seed), errors);
    EXPECT_TRUE(code == 0 || code == 3 || code == 4) << "mutation " << seed << ": " << code << "\n" << errors;
    EXPECT_EQ(std::ranges::count(errors, '\n'), code == 0 ? 0 : 1) << "mutation " << seed << ": " << errors;
    codes.insert(code);
  }
  EXPECT_TRUE(codes.contains(0) && codes.contains(3));
}

}  // namespace
}  // namespace drogue::options_app
