#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>

#include "common/scene/read.hpp"
#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/scene/scene.hpp"

/// Checks of a parachute scene, which throw `Failure` (invalid_scene) at the key in error.
namespace drogue::parachute_app {

/// Fills in the parameters of the solver and the defaults that depend on other keys; checks combinations of
/// keys, the velocities of the sides at time 0 and the initial velocity in the points of `stride_of_check`.
void complete_and_check(const scene::Place& root, FlowScene& scene, framework::InitialCheck check);

/// Distance of the points of a lattice in which functions are checked as a scene is read, those along x in
/// turn: of lattices of more than 4 194 304 points every n-th. A velocity that is not finite in another point
/// fails at the start of the run, an exact solution in the check at its end. Does not throw.
inline std::size_t stride_of_check(framework::InitialCheck check, const Lattice& lattice) {
  constexpr std::size_t most = 1U << 22U;
  const std::size_t points = lattice.size();
  std::size_t stride = std::max(framework::check_stride(check, points), 1 + (points - 1) / most);
  while (std::gcd(stride, static_cast<std::size_t>(lattice.n[0])) > 1)
    ++stride;  // meets all planes normal to x
  return stride;
}

/// Checks [verify] against the rest of the scene, and the exact solution in the cells of `check`.
void check_verify(const scene::Place& root, const FlowScene& scene, framework::InitialCheck check);

/// Sets cells, domain and faces of a grid with a core or faces, and checks its size.
void complete_and_check_grid(const scene::Place& root, FlowScene& scene);

/// Fills in defaults of bodies that depend on their kind, and checks bodies against the grid and the steps.
void complete_and_check_bodies(const scene::Place& root, FlowScene& scene);

/// Refuses bodies that move against each other and cross, at one of several times of the run, and notes
/// others that overlap. They may touch.
void check_body_overlaps(const scene::Place& root, FlowScene& scene);

/// Refuses bodies that close a channel where no flow is possible, or whose flow the coupling would follow
/// only after many steps, without a given bound of dt.
void check_closed_channels(const scene::Place& root, const FlowScene& scene);

/// Checks the coefficients that follow from the porosity of a body or canopy.
void check_porosity(const scene::Place& at, const flow::Parameters& p, const Porosity& porosity);

/// Sets the velocities at the start of canopies, and the gravity of a drop; checks [drop] and
/// payload.velocity.
void complete_drop(const scene::Place& root, FlowScene& scene);

/// Places canopies that share payloads, and checks every canopy against the grid, the steps, the bodies and
/// the canopies before it.
void complete_and_check_canopies(const scene::Place& root, FlowScene& scene);

/// Checks the thickness of contact against the `mesh` of all sheets.
void check_contact(const scene::Place& root, const FlowScene& scene, const fabric::Mesh& mesh);

/// Checks that the grid can move with the first payload where it has to.
void check_frame(const scene::Place& root, const FlowScene& scene);

/// Checks that the canopies suit the coupling: explicit coupling needs cloth that outweighs the air that
/// moves with it, sharp coupling prescribed motion.
void check_method(const scene::Place& root, const FlowScene& scene);

/// Largest part of a section that open canopies, or bodies, may cover in free air.
inline constexpr double most_blockage = 0.02;

/// Notes canopies with lines whose drag and speed are not those in free air, or depend on the cells: a narrow
/// or short domain, its sides, coarse cells, edges that act beyond the cloth, long lines, dimensions of
/// another canopy.
void note_unfit_canopies(const scene::Place& root, FlowScene& scene);

/// Notes bodies at rest whose drag is not that in free air: the part of the section that they cover, and a
/// run that ends while their wake starts up.
void note_unfit_bodies(FlowScene& scene);

/// Sentence on a core that a canopy leaves once it leans by an angle about its payload, or about the middle
/// between both where the grid follows that: "one that leans by N degrees" and `when`. Empty if it has room.
[[nodiscard]] std::string narrow_core_text(const FlowScene& scene, std::size_t canopy, double degrees,
                                           const char* when = "");

/// Lean of a canopy for which `note_unfit_canopies` looks at the room in the core, degrees.
inline constexpr double expected_lean = 30.0;

/// Refuses canopies that cross a body at the start, with their cloth or their lines. `sheets`: of the scene.
void check_canopies_beside_bodies(const scene::Place& root, const FlowScene& scene, const Sheets& sheets);

/// Lets flags span the domain along z, and checks them against the grid, the steps and each other.
void complete_and_check_flags(const scene::Place& root, FlowScene& scene);

/// Refuses sheets that meet an image beyond periodic sides at the start, and bodies in prescribed motion that
/// meet the image of another one at one of several times of the run.
void check_images(const scene::Place& root, const FlowScene& scene, const Sheets& sheets);

/// Notes sheets of a complete scene that leave so little of a channel open that nearly all of the fluid has
/// to stop before them, which the coupling follows within many steps, without a given bound of dt.
void note_narrow_channels(const scene::Place& root, FlowScene& scene, const Sheets& sheets);

/// Program of an expression for kernels. Refuses the key of one that is too long.
device::ExpressionProgram checked_program(const scene::Place& at, const std::string& key,
                                          const std::string& text);

/// True if an axis has ends that sheets keep from: sides that are not periodic, or those of a core. Does not
/// throw.
bool is_bounded(const flow::Parameters& p, std::size_t axis);

/// Part of the sheets, and where it reaches along an axis, m. `when`: clause on the time, where that matters.
struct SheetReach {
  std::string name;
  std::size_t axis;
  double low, high;
  std::string when = "";
};

/// "body[0] reaches from -1 to 1 m along x". Throws only std::bad_alloc.
std::string reach_text(const SheetReach& sheet);

/// Refuses, as a fault of a key, what does not keep more than `margin`, m, to the ends that it may reach
/// (`sheet_extent`): exactly a cell from a side, round-off decides whether the grid has all faces around a
/// vertex. With a margin of 0 it may touch the ends. `remedy`: the end of the sentence.
void check_margin(const scene::Place& at, const flow::Parameters& p, const std::string& key,
                  const SheetReach& sheet, double margin, const std::string& remedy = "");

/// The same of cloth, whose forces act up to one cell beyond it.
void check_margin(const scene::Place& at, const flow::Parameters& p, const std::string& key,
                  const std::string& name, std::size_t axis, const std::vector<fabric::Vector>& positions,
                  const std::string& remedy = "");

}  // namespace drogue::parachute_app
