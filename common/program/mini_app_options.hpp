#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace drogue {

/// Command line of a scene-driven mini-app, with the defaults of absent options.
struct MiniAppOptions {
  std::string scene;  ///< TOML file or name of a shipped scene; empty only with list_scenes, version, help
  std::string backend = "auto";  ///< auto | serial | openmp | cuda
  std::vector<std::string> set;  ///< `key.path=value`, in the order given
  std::filesystem::path out;     ///< run directory; empty: out/<scene name>
  std::string restart;           ///< a file, `auto`, or empty: start anew
  std::string study;             ///< `meshes=100:800,...`, or empty: one run
  bool check = false;
  bool print_scene = false;
  bool list_scenes = false;
  bool overwrite = false;
  bool quiet = false;
  bool baseline = false;
  bool version = false;
  std::string help;                 ///< text of --help, else empty
  std::vector<std::string> kokkos;  ///< `--kokkos-*`, untouched
};

/// Parses the command line. `description` heads the output of --help; `has_baseline` adds --seed-mode. Throws
/// `Failure` (usage): unknown option, with the nearest name, no SCENE, `--set` without `=`, unknown backend,
/// mutually exclusive options.
MiniAppOptions parse_mini_app_options(const std::string& program, const std::string& description, int argc,
                                      const char* const* argv, bool has_baseline);

}  // namespace drogue
