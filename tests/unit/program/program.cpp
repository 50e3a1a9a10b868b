#include "common/program/program.hpp"

#include <gtest/gtest.h>

#include <CLI/Error.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <new>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "common/program/provenance.hpp"
#include "common/version.hpp"

namespace drogue {
namespace {

struct ChildResult {
  int code;
  std::string error;
};

ChildResult run(const std::function<ExitCode()>& body) {
  ::testing::internal::CaptureStderr();
  const int code = run_program("drogue-gas", body);
  return {code, ::testing::internal::GetCapturedStderr()};
}

TEST(RunProgram, PrintsNothingOnSuccess) {
  const ChildResult outcome = run([] { return ExitCode::ok; });
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.error, "");
  EXPECT_EQ(run([] { return ExitCode::interrupted; }).code, 130);
}

TEST(RunProgram, PrintsAFailureAsOneSentence) {
  for (const ExitCode code : {ExitCode::usage, ExitCode::numerical_failure, ExitCode::verification_failed,
                              ExitCode::io_error, ExitCode::no_backend}) {
    const ChildResult outcome = run([code]() -> ExitCode { throw Failure(code, "it went wrong"); });
    EXPECT_EQ(outcome.code, static_cast<int>(code));
    EXPECT_EQ(outcome.error, "drogue-gas: it went wrong\n");
  }
}

TEST(RunProgram, StartsSceneErrorsWithFileAndLine) {
  const ChildResult outcome =
      run([]() -> ExitCode { throw Failure(ExitCode::invalid_scene, "sod.toml:7: unknown key"); });
  EXPECT_EQ(outcome.code, 3);
  EXPECT_EQ(outcome.error, "sod.toml:7: unknown key\n");
}

TEST(RunProgram, MapsCommandLineErrorsToUsage) {
  const ChildResult outcome = run([]() -> ExitCode { throw CLI::ExtrasError({"--x"}); });
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.error.rfind("drogue-gas: ", 0), 0U) << outcome.error;
}

TEST(RunProgram, MapsUnexpectedExceptionsToADocumentedCode) {
  const ChildResult memory = run([]() -> ExitCode { throw std::bad_alloc(); });
  EXPECT_EQ(memory.code, 6);
  EXPECT_NE(memory.error.find("out of memory"), std::string::npos) << memory.error;
  const ChildResult traced =
      run([]() -> ExitCode { throw std::runtime_error("\nbad index\n#0 main()\n#1 start"); });
  EXPECT_EQ(traced.code, 6);
  EXPECT_EQ(traced.error, "drogue-gas: unexpected error: bad index\n");
  EXPECT_EQ(run([]() -> ExitCode { throw 7; }).code, 6);
}

TEST(RunProgram, NamesWhatTheOperatingSystemRefused) {
  const ChildResult thread = run([]() -> ExitCode {
    throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
  });
  EXPECT_EQ(thread.code, 6);
  EXPECT_EQ(thread.error.rfind("drogue-gas: a thread could not start: ", 0), 0U) << thread.error;
  const ChildResult folder = run([]() -> ExitCode {
    std::filesystem::create_directory("/nowhere/out");
    return ExitCode::ok;
  });
  EXPECT_EQ(folder.code, 6);
  EXPECT_EQ(folder.error, "drogue-gas: cannot use '/nowhere/out': No such file or directory\n");
}

TEST(RunProgram, PrintsOnRankZeroOnly) {
  setenv("OMPI_COMM_WORLD_RANK", "1", 1);
  setenv("OMPI_COMM_WORLD_SIZE", "2", 1);
  const ChildResult outcome = run([]() -> ExitCode { throw Failure(ExitCode::usage, "too many ranks"); });
  ::testing::internal::CaptureStdout();
  std::puts("before");
  const ChildResult printed = run([] {
    std::puts("a scene");
    std::cout << "another\n";
    return ExitCode::ok;
  });
  std::puts("after");
  std::fflush(stdout);
  unsetenv("OMPI_COMM_WORLD_RANK");
  unsetenv("OMPI_COMM_WORLD_SIZE");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.error, "");
  EXPECT_EQ(printed.code, 0);
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "before\nafter\n");
}

TEST(CurrentFailure, KeepsCodeAndMessage) {
  try {
    throw Failure(ExitCode::numerical_failure, "negative density");
  } catch (...) {
    EXPECT_EQ(current_failure().code(), ExitCode::numerical_failure);
    EXPECT_STREQ(current_failure().what(), "negative density");
  }
}

TEST(Provenance, VersionTextNamesEveryPart) {
  const std::string text = version_text("drogue-gas");
  EXPECT_EQ(text.rfind("drogue-gas " + std::string(build_info().version) + "\n", 0), 0U) << text;
  for (const char* name :
       {"git: ", "Kokkos: ", "backends: ", "MPI: ", "HDF5: ", "FFTW: ", "hypre: ", "compiler: "}) {
    EXPECT_NE(text.find(name), std::string::npos) << name;
  }
}

TEST(Provenance, DateIsIso8601) {
  const std::string date = utc_date();
  ASSERT_EQ(date.size(), 20U);
  EXPECT_EQ(date[4], '-');
  EXPECT_EQ(date[10], 'T');
  EXPECT_EQ(date.back(), 'Z');
  EXPECT_GT(date, "2024");
}

TEST(Provenance, MemoryPeakGrowsWithAllocations) {
  const std::int64_t before = host_peak_bytes();
  std::vector<char> used(std::size_t{64} << 20U);
  for (std::size_t i = 0; i < used.size(); i += 4096) static_cast<volatile char&>(used[i]) = 'x';
  EXPECT_GE(host_peak_bytes(), before + (std::int64_t{60} << 20));
}

}  // namespace
}  // namespace drogue
