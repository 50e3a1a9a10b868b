#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "common/program/failure.hpp"
#include "common/run/run_directory.hpp"
#include "common/study/repeats.hpp"
#include "kernels/device/backend.hpp"
#include "miniapps/springs/scene.hpp"

namespace drogue::springs_app {

/// A folder where runs write what they are verified by; gone with its object.
class Scratch {
 public:
  explicit Scratch(const std::filesystem::path& folder);
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  [[nodiscard]] run::RunDirectory& directory() { return _directory; }

 private:
  std::filesystem::path _folder;
  run::RunDirectory _directory;
};

/// The runs of one scene.
struct RepeatedRun {
  std::vector<double> samples;  ///< compute time of each run, s
  std::int64_t steps = 0;
  std::map<std::string, double> errors;  ///< of the checks that the scene asks for
  std::vector<std::string> checks;       ///< their names, in the order of [verify]
  /// Of the first run, at the scene's output times: `time`, `kinetic`, `elastic`, `length` of strings and
  /// `area` of cloth.
  std::map<std::string, std::vector<double>> series;
  ExitCode code = ExitCode::ok;  ///< a failure, with `message`, leaves all else empty
  std::string message;
};

/// Runs `scene` until `repeats` says stop. `code` is `interrupted` after a signal.
RepeatedRun run_repeatedly(const SpringsScene& scene, device::Backend backend, const study::Repeats& repeats,
                           Scratch& scratch);

}  // namespace drogue::springs_app
