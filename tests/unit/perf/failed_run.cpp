#include "perf/process/child_process.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "common/run/files/temporary_folder.hpp"

namespace drogue::perf {
namespace {

/// Code and sentence of a run on two ranks that wrote `log`.
std::pair<ExitCode, std::string> failed(int status, const std::string& log) {
  const run::TemporaryFolder folder("drogue-test");
  std::ofstream(folder.path() / "log") << log;
  const Failure failure = failed_run("a run on 2 ranks", status, folder.path() / "log");
  return {failure.code(), failure.what()};
}

TEST(FailedRun, HasCodeAndSentenceOfTheProgram) {
  EXPECT_EQ(
      failed(4, "--------\ndrogue-parachute: NaN in cell 1\n--------\nmpirun exits since it runs as root\n"),
      std::pair(ExitCode::numerical_failure,
                std::string("a run on 2 ranks failed: drogue-parachute: NaN in cell 1")));
}

TEST(FailedRun, ExplainsThatMpirunRefusesRoot) {
  const auto [code, sentence] =
      failed(1,
             "-------\nmpirun has detected an attempt to run as root.\n\nRunning as "
             "root is *strongly* discouraged\n------\n");
  EXPECT_EQ(code, ExitCode::usage);
  EXPECT_EQ(
      sentence,
      "a run on 2 ranks failed: mpirun refuses to run as root; run as another user, or, in a container, set "
      "OMPI_ALLOW_RUN_AS_ROOT=1 and OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1");
}

TEST(FailedRun, ExplainsTooFewSlotsOfMpirun) {
  EXPECT_EQ(
      failed(1,
             "-----\nThere are not enough slots available in the system to satisfy the 64\nslots that "
             "were requested by the application:\n\n  true\n"),
      std::pair(ExitCode::usage,
                std::string("a run on 2 ranks failed: mpirun has fewer slots than ranks, by default one "
                            "per core; take fewer ranks, or let them share cores by "
                            "OMPI_MCA_rmaps_base_oversubscribe=1, with Open MPI 5 "
                            "PRTE_MCA_rmaps_default_mapping_policy=:oversubscribe; --ranks of benchmark and "
                            "--most of table set the number")));
}

TEST(FailedRun, JoinsTheFirstParagraphOfALauncher) {
  EXPECT_EQ(failed(1, "-----\nA request for 64\n  nodes was refused:\n\n  a\n"),
            std::pair(ExitCode::usage,
                      std::string("a run on 2 ranks failed: A request for 64 nodes was refused.")));
}

TEST(FailedRun, NamesForeignEndsInsteadOfPassingTheirCodesOn) {
  EXPECT_EQ(failed(139, ""),
            std::pair(ExitCode::io_error, std::string("a run on 2 ranks failed: signal 11 ended it")));
  EXPECT_EQ(
      failed(127, "env: 'x': No such file\n"),
      std::pair(ExitCode::io_error,
                std::string("a run on 2 ranks failed: it ended with code 127: env: 'x': No such file")));
  for (const int status : {0, 5})
    EXPECT_EQ(
        failed(status, ""),
        std::pair(ExitCode::io_error, std::string("a run on 2 ranks failed: it ended without a result")));
  EXPECT_EQ(failed(77, "").first, ExitCode::io_error);
  for (const int status : {2, 3, 4, 6, 77})
    EXPECT_EQ(failed(status, "launcher: a node is lost\n"),
              std::pair(ExitCode::io_error, "a run on 2 ranks failed: it ended with code " +
                                                std::to_string(status) + ": launcher: a node is lost"));
}

TEST(FailedRun, IsInterruptedWhoeverPrintsASentence) {
  for (const std::string sentence :
       {"drogue-parachute: interrupted by a signal", "mpirun: Forwarding signal 2"})
    EXPECT_EQ(failed(130, sentence + "\n"),
              std::pair(ExitCode::interrupted, "a run on 2 ranks failed: " + sentence));
}

}  // namespace
}  // namespace drogue::perf
