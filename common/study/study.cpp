#include "common/study/study.hpp"

#include <algorithm>
#include <iostream>

#include "common/program/plot_program.hpp"
#include "common/run/files/atomic_file.hpp"
#include "common/study/tables.hpp"

namespace drogue::study {
namespace {

void draw(const run::RunDirectory& directory, const std::string& program_name) {
  const std::string folder = directory.path().string();
  if (run_drogue_plot({folder}) != 0)
    std::cerr << program_name << ": no picture was made; run drogue-plot " << folder << '\n';
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
