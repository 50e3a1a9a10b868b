#include "common/study/study.hpp"

#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "common/run/files/atomic_file.hpp"
#include "common/study/tables.hpp"

namespace drogue::study {
namespace {

/// Starts `drogue-plot`, which lies beside this program.
void draw(const run::RunDirectory& directory, const std::string& program_name) {
  std::error_code error;
  const std::filesystem::path plot =
      std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "drogue-plot";
  std::string program = plot.string(), folder = directory.path().string();
  char* arguments[] = {program.data(), folder.data(), nullptr};
  pid_t child = 0;
  int status = 1;
  if (std::filesystem::exists(plot, error) &&
      posix_spawn(&child, program.c_str(), nullptr, nullptr, arguments, environ) == 0)
    waitpid(child, &status, 0);
  if (status != 0) std::cerr << program_name << ": no picture was made; run drogue-plot " << folder << '\n';
}

}  // namespace

ExitCode run_points(const run::RunDirectory& directory, const run::ResultDocument& facts,
                    const Columns& columns, std::size_t count, const RunPoint& run_point, bool quiet) {
  std::vector<StudyRow> rows;
  for (std::size_t i = 0; i < count; ++i) {
    if (!run_point(i, rows)) return ExitCode::interrupted;
    run::write_file_atomically(directory.file("study.csv"), csv(rows, columns, facts.backend));
    run::write_file_atomically(directory.file("study.json"), json(rows, columns, facts));
    if (!quiet) std::cout << line(rows.back(), columns) << std::flush;
  }
  if (std::ranges::none_of(rows, [](const StudyRow& row) { return row.code == ExitCode::ok; }))
    throw Failure(
        ExitCode::numerical_failure,
        "every run of the study failed; '" + directory.file("study.json").string() + "' has the reasons");
  draw(directory, facts.program);
  return ExitCode::ok;
}

}  // namespace drogue::study
