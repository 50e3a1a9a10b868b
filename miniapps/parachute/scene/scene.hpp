#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "kernels/flow/parameters.hpp"
#include "miniapps/framework/history_checks.hpp"
#include "miniapps/framework/initial_check.hpp"
#include "miniapps/framework/scene_identity.hpp"
#include "miniapps/framework/scene_keys.hpp"
#include "miniapps/parachute/bodies/body.hpp"
#include "miniapps/parachute/bodies/box.hpp"
#include "miniapps/parachute/canopy/canopy.hpp"
#include "miniapps/parachute/flags/flag.hpp"

/// Scene of `drogue-parachute`: the content of a TOML file, checked and with every default filled in.
namespace drogue::parachute_app {

/// Numbers or muParser expressions of x, y, z (m) and t (s) along x, y and z; all empty if absent.
using VectorExpression = std::array<std::string, 3>;

/// Names of the sides of the domain in scenes and in history.csv, in the order of
/// `flow::Parameters::boundary`.
inline constexpr std::array<const char*, 6> side_names = {"x_low",  "x_high", "y_low",
                                                          "y_high", "z_low",  "z_high"};

inline constexpr std::array<const char*, 3> axis_names = {"x", "y", "z"};

inline constexpr int most_cells_per_axis = 16384;  ///< as of `flow::check_parameters`

/// Frame of reference of the grid.
enum class Frame {
  fixed,   ///< that of fluid.velocity
  follow,  ///< moves with the payload of the first canopy, or with its middle to the canopy
};

/// Coordinates of the faces of an axis, m, or the file that has them, one a line.
struct AxisFaces {
  std::vector<double> values;
  std::string file;
};

enum class AdvectionScheme { central, weno5 };
enum class Weights { js, z };

/// True for a kind of side through which fluid flows in or out. Does not throw.
constexpr bool is_open(flow::BoundaryKind kind) {
  return kind == flow::BoundaryKind::inflow || kind == flow::BoundaryKind::outflow;
}

/// Types of the low and the high side of an axis.
using SidePair = std::array<flow::BoundaryKind, 2>;

/// Exact solution: velocity, m/s, and pressure, Pa, as expressions of x, y, z and t; an empty pressure is not
/// compared.
struct ExactSolution {
  VectorExpression velocity;
  std::string pressure;
};

/// Extreme velocity along a line, m/s, and optionally its coordinate, m.
struct Extremum {
  double value = 0.0;
  double tolerance = 0.0;
  std::optional<double> at, at_tolerance;
};

/// Velocity component along a line parallel to an axis at the end of the run.
struct Profile {
  int component = 0;
  int along = 1;
  std::array<double, 3> through = {};  ///< point of the line, m; the coordinate along the axis is ignored
  std::vector<std::array<double, 2>> points;  ///< coordinate, m, and velocity, m/s
  double tolerance = 0.0;                     ///< of the velocity at `points`, m/s
  std::optional<Extremum> minimum, maximum;
};

/// Leak of a canopy over an interval of time, relative to the means of speed and projected area.
struct CanopyLeak {
  int canopy = 0;
  double from = 0.0, to = 0.0;          ///< s
  double tolerance = 0.0;               ///< largest magnitude of the mean that passes
  std::optional<double> rms_tolerance;  ///< and largest root mean square
};

/// Bounds of the largest force of the lines on the payload of a canopy, N, and of its time, s.
struct CanopyPeak {
  int canopy = 0;
  std::array<double, 2> force{};
  std::optional<std::array<double, 2>> time;
};

/// Largest rate at which the kinetic energy falls, W, and optionally its time, s.
struct DissipationPeak {
  double value = 0.0;
  double tolerance = 0.0;  ///< relative
  std::optional<double> time, time_tolerance;
};

/// Times, s, and values of a quantity then.
struct Curve {
  std::vector<std::array<double, 2>> points;
  double tolerance = 0.0;  ///< relative to the largest value

  /// Largest magnitude of the values. Does not throw.
  [[nodiscard]] double scale() const {
    double largest = 0.0;
    for (const auto& [time, value] : points) largest = std::max(largest, std::abs(value));
    return largest;
  }
};

struct Verify {
  std::optional<ExactSolution> exact;
  std::map<std::string, double> tolerances;                     ///< by name: l1_velocity ... linf_pressure
  std::optional<double> divergence;                             ///< 1/s
  std::optional<double> momentum, energy_growth, speed_growth;  ///< relative
  std::optional<DissipationPeak> dissipation_peak;
  std::vector<Curve> kinetic_energy_curves, dissipation_curves;  ///< J, W
  std::vector<CanopyLeak> leaks;
  std::vector<CanopyPeak> peak_forces;
  std::optional<double> force_balance;  ///< relative
  std::optional<double> intersections;  ///< number
  std::optional<double> energy_drift;   ///< of a cloth drop, relative
  std::vector<Profile> profiles;
  std::vector<framework::HistoryCheck> history;

  /// True if a check needs `flow::Extremes`. Does not throw.
  [[nodiscard]] bool needs_extremes() const { return energy_growth || speed_growth || dissipation_peak; }

  /// True if a check other than `history` is computed from rows. Does not throw.
  [[nodiscard]] bool needs_rows() const {
    return !kinetic_energy_curves.empty() || !dissipation_curves.empty() || !leaks.empty() || force_balance ||
           intersections || energy_drift;
  }
};

/// Solver parameters for air at 15 degrees Celsius: 1.225 kg/m^3, 1.8e-5 Pa s. Does not throw.
inline flow::Parameters air_parameters() {
  flow::Parameters parameters;
  parameters.density = 1.225;
  parameters.viscosity = 1.8e-5;
  return parameters;
}

/// Corrections of the exchange by delta functions, where no key replaces them.
enum class Corrections {
  all,   ///< of leak, free edges and lag
  none,  ///< an acceleration of weight 0.5 in each step alone
};

/// Start of a drop.
struct Drop {
  double speed = 0.0;            ///< of the payload relative to the air, m/s
  double angle = 90.0;           ///< of its path below the horizontal, degrees; 0 is along +x
  std::optional<double> height;  ///< of the payload above the ground, m
};

/// Exchange of sheets with the fluid. What is not given follows from `exchange_parameters`.
struct Exchange {
  coupling::CouplingMethod method = coupling::CouplingMethod::spread;
  Corrections corrections = Corrections::all;
  /// As in `coupling::SheetParameters`.
  std::optional<double> filter, leak_filter, edge_inset;
};

struct FlowScene {
  std::filesystem::path file;
  std::string name;  ///< the file's name without folder and extension
  std::string description;
  std::optional<std::monostate> fluid;  ///< absent: a cloth drop, which has no grid either
  /// Complete once the scene has been read; of a cloth drop, only `fixed_dt` and `max_steps` count.
  flow::Parameters parameters = air_parameters();
  Box domain{};                                   ///< of a grid without `faces`
  std::optional<Box> core;                        ///< of a grid whose cells grow outside of it
  std::array<double, 3> spacing{};                ///< largest widths of cells in `core`, m
  double growth = 1.06;                           ///< largest ratio of the widths of neighbours
  std::optional<std::array<AxisFaces, 3>> faces;  ///< of a grid that is given by them
  Frame frame = Frame::fixed;
  AdvectionScheme advection = AdvectionScheme::weno5;
  Weights weights = Weights::z;
  VectorExpression velocity = {"0.0", "0.0", "0.0"};  ///< inflow, and initial velocity without `initial`, m/s
  VectorExpression initial;                           ///< initial velocity, m/s
  std::array<std::optional<SidePair>, 3> sides;       ///< of each axis
  std::array<VectorExpression, 6> wall_velocity;      ///< m/s
  std::vector<Body> bodies;
  std::vector<Canopy> canopies;
  std::vector<Flag> flags;
  std::optional<Drop> drop;
  Exchange coupling;
  std::array<double, 3> gravity{};  ///< of canopies, payloads and flags, m/s^2
  bool allow_unstable = false;      ///< explicit coupling runs with cloth lighter than its added mass
  bool contact = false;             ///< of canopies and lines with each other and themselves
  double thickness = 0.01;          ///< m, distance of layers in contact
  int contact_block = 0;            ///< threads of a team that resolves contact; 0: its default
  double end_time = 0.0;            ///< s
  framework::OutputRequest output;
  Verify verify;
  std::vector<std::string> notices;  ///< `framework::Scene::notices`

  /// Adds a sentence of parts to the notices. Throws only std::bad_alloc.
  template <class... Parts>
  void note(const Parts&... parts) {
    notices.push_back(scene::sentence(parts...));
  }
  /// Added mass of a canopy, whose longest wave is its diameter, over its own mass. Does not throw.
  [[nodiscard]] double added_mass_ratio(const Canopy& canopy) const;
  /// Largest of these; 0 without canopies. Does not throw.
  [[nodiscard]] double largest_added_mass_ratio() const;
  [[nodiscard]] bool is_explicit() const { return coupling.method == coupling::CouplingMethod::explicit_; }
  [[nodiscard]] bool has_fluid() const { return fluid.has_value(); }
  /// True if a sheet moves by the forces of the fluid. Does not throw.
  [[nodiscard]] bool has_free_sheets() const;
  /// Velocity of the fluid far upstream, m/s; none if it varies. Throws only std::bad_alloc.
  [[nodiscard]] std::optional<std::array<double, 3>> stream() const;
  /// Clause on why the fluid far upstream has no speed relative to a canopy, or one that is 0 all the time;
  /// empty if it has one. Throws only std::bad_alloc.
  [[nodiscard]] std::string lack_of_airspeed(std::size_t canopy) const;
  /// Canopy whose payload carries this one: itself, or that of `payload.shared`. Does not throw.
  [[nodiscard]] std::size_t owner_of(std::size_t canopy) const;
  /// True if gravity pulls the payload of a canopy through the fluid. Does not throw.
  [[nodiscard]] bool descends(std::size_t canopy) const;
  [[nodiscard]] bool has_sheets() const { return !bodies.empty() || !canopies.empty() || !flags.empty(); }
  /// Courant number, the default one if none is given. Does not throw.
  [[nodiscard]] double cfl() const {
    if (parameters.cfl > 0.0) return parameters.cfl;
    return has_sheets() ? coupling::default_cfl : flow::default_cfl(parameters.time_scheme);
  }
  /// Number of cells. Does not throw.
  [[nodiscard]] double cells() const {
    return static_cast<double>(parameters.cells[0]) * parameters.cells[1] * parameters.cells[2];
  }
  /// True if the cells of an axis have widths of their own. Does not throw.
  [[nodiscard]] bool has_stretched_axes() const {
    return std::ranges::any_of(parameters.faces, [](const auto& axis) { return !axis.empty(); });
  }
  /// Axes along which the grid can move: fluid flows in or out at both sides. Does not throw.
  [[nodiscard]] std::array<bool, 3> open_axes() const;
  [[nodiscard]] const VectorExpression& initial_velocity() const {
    return initial[0].empty() ? velocity : initial;
  }
};

/// Fields of fields.h5: velocity, pressure, vorticity, q_criterion; of canopies position, von_mises. Does not
/// throw.
const std::vector<std::string>& field_names();

/// Width of the cells in the core along an axis, m: that of all cells of a uniform axis. Does not throw.
double core_width(const flow::Parameters& p, std::size_t axis);

/// Least of these widths along axes of several cells, m; infinite without any. Does not throw.
double least_width(const flow::Parameters& p);

/// Length of the domain along an axis, m. Does not throw.
inline double length_of(const flow::Parameters& p, std::size_t axis) { return p.high[axis] - p.low[axis]; }
/// Length of a vector. Does not throw.
inline double length_of(const fabric::Vector& v) { return std::hypot(v[0], v[1], v[2]); }

/// Mass of the fluid, kg. Does not throw.
inline double fluid_mass(const flow::Parameters& p) {
  return p.density * length_of(p, 0) * length_of(p, 1) * length_of(p, 2);
}

/// Ends along an axis of the part of the grid that sheets and their forces lie in, m: the domain, or near
/// stretched cells the core without its outermost cells. Does not throw.
std::array<double, 2> sheet_extent(const flow::Parameters& p, std::size_t axis);

/// True for fields of canopies. Does not throw.
bool is_canopy_field(const std::string& name);

/// Source of the numerical scheme. `--seed-mode` replaces that of the scene by the baseline of [Shi].
enum class SchemeSource { scene, baseline };

/// Reads and checks `file` with its `--set` assignments, and evaluates the initial velocity at faces.
/// Throws `Failure`: usage for a missing file, invalid_scene (`FILE:LINE: ...`) otherwise.
FlowScene read_flow_scene(const std::filesystem::path& file, const std::vector<std::string>& sets = {},
                          SchemeSource source = SchemeSource::scene,
                          framework::InitialCheck check = framework::InitialCheck::all_cells);

/// Resolved scene as TOML: every default that applies, no key that does not. It resolves to itself.
std::string print_flow_scene(const FlowScene& scene);

/// Fluid, grid and scheme, for restart files. Output, checks, the end time, the times at which lines are cut
/// and the choice of dt may change between a run and its continuation.
framework::SceneIdentity scene_identity(FlowScene scene);

/// Folder of the shipped scenes: beside the installed or bundled program, else in the source tree.
std::filesystem::path scene_folder();

/// Names in scenes of a pressure solver, a time scheme and a treatment of diffusion, and in studies that of
/// an advection scheme with its weights: central, weno-js, weno-z.
std::string name_of(flow::PressureSolver solver);
std::string name_of(flow::TimeScheme scheme);
std::string name_of(flow::Diffusion diffusion);
std::string name_of(flow::Advection advection);

/// Markdown page docs/scenes-parachute.md: all keys with type, range, unit, default and meaning.
std::string document_flow_scene();

}  // namespace drogue::parachute_app
