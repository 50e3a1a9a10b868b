#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace drogue {

/// What the command line of a mini-app asks for; the defaults are those of an option not given.
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
  bool seed_mode = false;
  bool version = false;
  std::string help;                 ///< the text asked for by --help, else empty
  std::vector<std::string> kokkos;  ///< `--kokkos-*`, untouched
};

/// Reads the command line. `description` is the sentence under which --help lists the options.
/// Throws Failure(usage): unknown option (with the nearest name), no SCENE, `--set` without `=`, an unknown
/// backend, options that exclude each other.
MiniAppOptions parse_mini_app_options(const std::string& program, const std::string& description, int argc,
                                      const char* const* argv);

}  // namespace drogue
