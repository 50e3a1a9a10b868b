#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kernels/fabric/body.hpp"
#include "kernels/fabric/elastic/lumped_mass.hpp"
#include "kernels/fabric/integrator.hpp"
#include "kernels/mesh/generators.hpp"
#include "kernels/stepping/motion_interval.hpp"
#include "miniapps/framework/history_checks.hpp"
#include "miniapps/framework/scene_identity.hpp"
#include "miniapps/framework/scene_keys.hpp"

/// Scene of `drogue-springs`: the content of a TOML file, checked and with every default filled in.
namespace drogue::springs_app {

/// Vector of expressions; an empty component is zero or absent.
struct ExpressionVector {
  std::string x, y, z;

  [[nodiscard]] const std::string& of(std::size_t axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
  [[nodiscard]] bool given() const { return !(x.empty() && y.empty() && z.empty()); }
};

/// Exactly one of the generators or a file is set.
struct MeshSource {
  std::optional<mesh::Rectangle> rectangle;
  std::optional<mesh::Disk> disk;
  std::optional<mesh::Strip> strip;
  std::optional<mesh::Triangle> triangle;
  std::optional<mesh::String> string;
  std::string file;    ///< as the scene names it, relative to the scene
  double scale = 1.0;  ///< m per unit of length of the file
};

struct Fabric {
  fabric::Material material;
  double area_density = 0.756;  ///< kg/m^2
  fabric::Lumping mass = fabric::Lumping::area;
  double line_density = 0.001;            ///< kg/m
  std::optional<double> axial_stiffness;  ///< of strings, N
  std::optional<double> stiffness;        ///< N/m per edge; also of strings without axial stiffness
};

/// Reinforced edges of triangles and lines of the mesh, which become strings.
struct Reinforcement {
  std::string where;             ///< of x, y, z at rest, for both ends
  double axial_stiffness = 0.0;  ///< E A, N
  double line_density = 0.0;     ///< kg/m, in addition to the cloth
};

struct Initial {
  ExpressionVector displacement, velocity;  ///< of x, y, z at rest
  double prestretch = 0.0;                  ///< rest coordinates grow by this strain
};

struct Pin {
  std::string where;  ///< of x, y, z at rest
  std::string axes = "xyz";
  ExpressionVector motion;  ///< displacement from rest, of x, y, z, t
};

/// Exactly one of the four is set.
struct Load {
  std::vector<double> gravity;            ///< m/s^2
  std::string pressure;                   ///< dead, N per m^2 at rest along the normal at rest
  std::string follower_pressure;          ///< N per m^2 along the normal now
  std::optional<ExpressionVector> force;  ///< N on each vertex
  std::string where;                      ///< with force; empty: all
};

struct Payload {
  std::string where;
  double add = 0.0;  ///< kg to each vertex
};

struct Damping {
  double absolute = 0.0, relative = 0.0;  ///< 1/s
};

/// Rigid body. Members that its kind does not use are ignored.
struct ContactObject {
  fabric::BodyKind kind = fabric::BodyKind::disk;
  fabric::Vector centre{}, normal{0.0, 0.0, 1.0};
  double radius = 0.0;     ///< m
  std::string expression;  ///< of x, y, z; negative within
  double friction = 0.0;

  /// Body for the solver, without the program of the expression.
  [[nodiscard]] fabric::Body body() const;
};

struct SpringsContact {
  std::vector<ContactObject> objects;
  bool self = false;
  double thickness = 0.002;  ///< m
  double friction = 0.0;     ///< between layers

  [[nodiscard]] bool is_enabled() const { return self || !objects.empty(); }
};

inline constexpr double most_steps = 1e15;

struct Time {
  fabric::Integrator integrator = fabric::Integrator::verlet;
  std::optional<double> dt;  ///< s; none: from the fastest frequency
  /// Share of the largest stable step. The default keeps energy in violent motion.
  double safety = 0.4;
  double end_time = 0.0;  ///< s
};

struct Probe {
  std::vector<double> at{0.0, 0.0, 0.0};  ///< rest coordinates, m
};

/// `fields` holds position, velocity and names of stresses.
struct Output : framework::OutputRequest {
  Output() { history_every = 100; }
  std::vector<Probe> probes;
};

/// Oscillation frequency of a probe.
struct Frequency {
  std::vector<double> mode;     ///< of a disk (diameters, circles) or of a string (number)
  std::optional<double> value;  ///< Hz; none: the closed form of the mode
  double tolerance = 0.0;       ///< relative
  int probe = 0;
  std::string axis = "z";
};

/// Speed of a front from the first probe to the second.
struct FrontSpeed {
  double value = 0.0;      ///< m/s
  double tolerance = 0.0;  ///< relative
  std::string axis = "x";
};

/// Quantity of the final state.
enum class FinalQuantity {
  displacement_x,
  displacement_y,
  displacement_z,
  von_mises,
  elastic_energy,
  area_growth  ///< of all triangles, over their area at rest
};

/// True for a quantity of a vertex, false for one of the whole mesh.
constexpr bool is_of_vertex(FinalQuantity quantity) {
  return quantity != FinalQuantity::elastic_energy && quantity != FinalQuantity::area_growth;
}

/// Expected value of the final state, of the vertex nearest to `at` or of the whole mesh.
struct FinalValue {
  FinalQuantity quantity = FinalQuantity::elastic_energy;
  std::vector<double> at;  ///< rest coordinates, m; empty unless `is_of_vertex`
  double value = 0.0;      ///< m, N/m, J or 1
  double tolerance = 0.0;  ///< relative
};

/// Relative tolerances.
struct Verify {
  std::optional<double> intersections, energy_balance, penetration;
  std::optional<double> energy_drift, momentum, angular_momentum, equilibrium;
  std::optional<double> young, poisson, hencky, catenary, stretch;
  std::optional<Frequency> frequency;
  std::optional<FrontSpeed> front_speed;
  std::vector<FinalValue> values;
  std::vector<framework::HistoryCheck> history;
};

struct SpringsScene {
  std::filesystem::path file;
  std::string name;  ///< the file's name without folder and extension
  std::string description;
  MeshSource source;
  fabric::Mesh mesh;      ///< mesh of the source, in its own numbering, then lines of reinforcements
  std::size_t lines = 0;  ///< number of lines of the source
  Fabric fabric;
  std::vector<Reinforcement> reinforcements;
  Initial initial;
  std::vector<Pin> pins;
  std::vector<Load> loads;
  std::vector<Payload> payloads;
  Damping damping;
  SpringsContact contact;
  Time time;
  Output output;
  Verify verify;
  fabric::Driver driver = fabric::Driver::automatic;
  /// Divisions of the run by prescribed motion and loads that change in time.
  std::vector<std::vector<stepping::MotionInterval>> changes;
  std::vector<std::string> notices;  ///< `framework::Scene::notices`

  /// True if the source has triangles, or lines; both for a file that is not read yet.
  [[nodiscard]] bool has_triangles() const;
  [[nodiscard]] bool has_lines() const;
};

/// Reads and checks `file` with its `--set` assignments, makes the mesh, and evaluates every expression
/// without t at every vertex. Throws `Failure`: usage for a missing file, invalid_scene (`FILE:LINE: ...`)
/// for errors in the scene or its mesh.
SpringsScene read_springs_scene(const std::filesystem::path& file, const std::vector<std::string>& sets = {});

/// Resolved scene as TOML: every default that applies, no key that does not. It resolves to itself in the
/// folder of the scene.
std::string print_springs_scene(const SpringsScene& scene);

/// The mesh, the fabric and everything that acts on it, for restart files. Output, end time, step lengths and
/// checks may change between a run and its continuation.
framework::SceneIdentity scene_identity(SpringsScene scene);

/// Folder of the shipped scenes: beside the installed or bundled program, else in the source tree.
std::filesystem::path scene_folder();

/// Name of a constitutive model in scenes: linear-vector, edge, quadratic, biquadratic.
std::string model_name(fabric::Model model);

/// Markdown page docs/scenes-springs.md: all keys with type, range, unit, default and meaning.
std::string document_springs_scene();

}  // namespace drogue::springs_app
