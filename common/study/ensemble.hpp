#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/program/failure.hpp"
#include "common/run/result_document.hpp"
#include "common/run/uncertainty.hpp"

/// Ensembles: perturbed runs on one or two grids, whose results get error bars.
namespace drogue::study {

/// Values of `--study ensemble=8,cells=1:1.5,jobs=2`.
struct EnsembleAxes {
  int runs = 1;                       ///< on each grid
  std::vector<double> factors = {1};  ///< of the numbers of cells along each axis, coarse first; one or two
  int jobs = 0;                       ///< runs at once; 0: as many as suit the backend
};

/// True if `--study` names these axes. Throws `Failure` (usage) for a name that is neither one of them nor
/// among `others`, the axes of the other studies of a program, and for names of both.
[[nodiscard]] bool is_ensemble(const std::string& text, const std::vector<std::string>& others);

/// Parses them. Throws `Failure` (usage).
[[nodiscard]] EnsembleAxes parse_ensemble(const std::string& text);

/// Result of a run with the 95 % error of the mean over time that it is; NaN where that is not known.
struct Quantity {
  std::string name;
  double value = 0.0, half_width = 0.0;
};

/// One run of an ensemble.
struct Member {
  std::string folder;    ///< below that of the study
  std::size_t grid = 0;  ///< number of its factor
  int seed = 0;
  ExitCode code = ExitCode::interrupted;
  std::string message;  ///< of a run that failed
  std::int64_t steps = 0;
  double wall_s = 0.0;
  std::string backend, device;  ///< that it ran on
  int threads = 1;
  std::vector<Quantity> quantities;  ///< none unless `is_finished`

  /// True if it reached its end, whether its checks passed or not.
  [[nodiscard]] bool is_finished() const {
    return code == ExitCode::ok || code == ExitCode::verification_failed;
  }
};

/// Reads how a run ended from its result.json: its quantities are the numbers of the groups `canopy_i` and
/// `body_i`, and what checks measured. Without such a file, `exit_code` of the process and `log`, what it
/// printed, describe a failure.
void read_member(const std::filesystem::path& result, int exit_code, const std::string& log, Member& member);

/// What made the finished run of an earlier study, as its result.json states it.
struct Origin {
  std::string version, git, fingerprint;
};

/// Reads a run that an earlier study has finished; nothing if `result` is not of such a run.
[[nodiscard]] std::optional<Origin> read_finished(const std::filesystem::path& result, Member& member);

/// A quantity of all runs that have it.
struct StudyQuantity {
  std::string name;
  std::vector<run::Distribution> grids;  ///< coarse first; without a run where none has it
  run::ErrorBar bar;                     ///< of the finest grid
};

/// Error bars of the quantities of finished runs on the finest grid. Throws only std::bad_alloc.
[[nodiscard]] std::vector<StudyQuantity> summarize(const std::vector<Member>& members,
                                                   const std::vector<double>& factors);

/// "0.790 +- 0.035 (sampling 0.012, grid 0.033)", and of `peak` quantities their distribution.
[[nodiscard]] std::string text_of(const StudyQuantity& quantity);

/// runs.csv: a row for each run.
[[nodiscard]] std::string members_csv(const std::vector<Member>& members, const std::vector<double>& factors);

/// Fills in the group `study` of result.json.
void describe(const EnsembleAxes& axes, const std::vector<Member>& members,
              const std::vector<StudyQuantity>& quantities, run::Metrics& metrics);

}  // namespace drogue::study
