#include "common/program/mini_app_options.hpp"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>

#include "common/program/command_line.hpp"
#include "common/program/failure.hpp"

namespace drogue {
namespace {

void declare(CLI::App& app, MiniAppOptions& options, bool has_baseline) {
  app.add_option("SCENE", options.scene, "TOML file, or name of a shipped scene");
  add_backend_option(app, options.backend);
  app.add_option("--set", options.set, "change a value of the scene: key.path=value; may be repeated")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  app.add_option("--out", options.out, "run directory (default: out/<scene name>)")->type_name("DIR");
  auto* restart =
      app.add_option("--restart", options.restart,
                     "continue from a restart file; auto: from that of the run directory, if any");
  restart->type_name("FILE|auto");
  app.add_flag("--overwrite", options.overwrite, "replace the run that is in the run directory")
      ->excludes(restart);
  auto* check = app.add_flag("--check", options.check, "validate the scene and end");
  app.add_flag("--print-scene", options.print_scene,
               "print the scene with every default that applies, and end")
      ->excludes(check);
  app.add_flag("--list-scenes", options.list_scenes, "list the shipped scenes, and end");
  app.add_flag("--quiet", options.quiet, "show no progress and no summary");
  CLI::Option* baseline = nullptr;
  if (has_baseline)
    baseline = app.add_flag("--seed-mode", options.baseline,
                            "run the algorithm of [Shi], the dissertation that README.md cites");
  auto* study = app.add_option(
      "--study", options.study,
      "run the scene over meshes and schemes, say meshes=100:800 (two meshes: and every doubling "
      "between them)");
  study->type_name("LISTS")->excludes(restart);
  if (baseline != nullptr) study->excludes(baseline);
  app.add_flag("--version", options.version, "print version, backends and libraries, and end");
}

void check_words(const CLI::App& app, const MiniAppOptions& options) {
  for (const std::string& assignment : options.set) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw Failure(ExitCode::usage, "--set needs key.path=value, not '" + assignment + "'");
    }
  }
  require_nonempty_values(app);
  if (options.scene.empty() && !options.list_scenes && !options.version) {
    throw Failure(ExitCode::usage,
                  "no SCENE given; --list-scenes shows the shipped ones, --help the options");
  }
}

}  // namespace

MiniAppOptions parse_mini_app_options(const std::string& program, const std::string& description, int argc,
                                      const char* const* argv, bool has_baseline) {
  MiniAppOptions options;
  CLI::App app(description, program);
  declare(app, options, has_baseline);
  app.footer("--kokkos-* options are passed to Kokkos.");
  Arguments arguments = split_arguments(argc, argv);
  options.help = parse_command_line(app, arguments.program);
  options.kokkos = std::move(arguments.kokkos);
  if (options.help.empty()) check_words(app, options);
  return options;
}

}  // namespace drogue
