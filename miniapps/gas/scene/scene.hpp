#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kernels/gas/parameters.hpp"
#include "miniapps/framework/history_checks.hpp"
#include "miniapps/framework/initial_check.hpp"
#include "miniapps/framework/scene_identity.hpp"
#include "miniapps/framework/scene_keys.hpp"

/// Scene of `drogue-gas`: the content of a TOML file, checked and with every default filled in.
namespace drogue::gas_app {

/// State of the gas at a point: density in kg/m^3, velocity in m/s, pressure in Pa.
struct Primitive {
  double rho = 1.0;
  double u = 0.0;
  double p = 1.0;
};

/// Two constant states that meet at `x0` (m).
struct Riemann {
  double x0 = 0.0;
  Primitive left;
  Primitive right;
};

/// Constant state up to `until`, m; the last region has no `until` and reaches the end of the domain.
struct Region {
  std::optional<double> until;
  Primitive state;
};

/// muParser expressions of x (cell centre, m) and dx (cell width, m).
struct ExpressionState {
  std::string rho;
  std::string u = "0";
  std::string p;
};

/// Exactly one of the three is set.
struct Initial {
  std::optional<Riemann> riemann;
  std::vector<Region> regions;
  std::optional<ExpressionState> expression;
};

using Output = framework::OutputRequest;

enum class Exact { riemann, advection, reference };

/// Known value of a quantity and the tolerance of its relative error.
struct Target {
  double value = 0.0;
  double tolerance = 0.0;
};

struct Verify {
  std::optional<Exact> exact;
  std::optional<gas::Parameters> reference;  ///< finer run; set exactly if `exact` is reference
  std::map<std::string, double> tolerances;  ///< by name: l1_density ... linf_pressure
  std::optional<Target> max_density;         ///< maximum over all cells at the end, kg/m^3
  std::optional<double> conservation;        ///< tolerance of the relative change of mass, momentum, energy
  std::vector<framework::HistoryCheck> history;
};

struct GasScene {
  std::filesystem::path file;
  std::string name;  ///< the file's name without folder and extension
  std::string description;
  gas::Parameters parameters;
  Initial initial;
  double end_time = 0.0;  ///< s
  Output output;
  Verify verify;
  std::vector<std::string> notices;  ///< `framework::Scene::notices`
};

/// Source of the numerical scheme. `--seed-mode` replaces the scene's scheme by the baseline of [Shi].
enum class SchemeSource { scene, baseline };

/// Reads and checks `file` with its `--set` assignments, and evaluates the initial state at every cell.
/// Throws `Failure`: usage for a missing file, invalid_scene (`FILE:LINE: ...`) otherwise.
GasScene read_gas_scene(const std::filesystem::path& file, const std::vector<std::string>& sets = {},
                        SchemeSource source = SchemeSource::scene,
                        framework::InitialCheck check = framework::InitialCheck::all_cells);

/// Resolved scene as TOML: every default that applies, no key that does not. It resolves to itself.
std::string print_gas_scene(const GasScene& scene);

/// Mesh, gas and scheme, for restart files. Output, end time and checks may change between a run and its
/// continuation.
framework::SceneIdentity scene_identity(GasScene scene);

/// Folder of the shipped scenes: beside the installed or bundled program, else in the source tree.
std::filesystem::path scene_folder();

/// Name of a reconstruction in scenes: js, z, m, teno5.
std::string weno_name(gas::Weno weno);

/// Name of a flux splitting in scenes: lf-global, lf-single, lf-stencil.
std::string splitting_name(gas::Splitting splitting);

/// Markdown page docs/scenes-gas.md: all keys with type, range, unit, default and meaning.
std::string document_gas_scene();

/// Initial state at a point. Not thread-safe: every thread needs a copy.
class InitialState {
 public:
  explicit InitialState(const GasScene& scene);
  InitialState(const InitialState& other);
  InitialState(InitialState&& other) noexcept;
  InitialState& operator=(const InitialState& other);
  InitialState& operator=(InitialState&& other) noexcept;
  ~InitialState();

  /// `x` is a cell centre (m).
  Primitive operator()(double x) const;

 private:
  struct Evaluator;
  std::unique_ptr<Evaluator> _evaluator;
};

/// Centre of cell `i` (m): x_min + (i + 1/2) dx.
inline double cell_centre(const gas::Parameters& parameters, std::int64_t i) {
  const double dx = (parameters.x_max - parameters.x_min) / static_cast<double>(parameters.cells);
  return parameters.x_min + (static_cast<double>(i) + 0.5) * dx;
}

}  // namespace drogue::gas_app
