#include <algorithm>
#include <cmath>

#include "miniapps/parachute/scene/functions.hpp"
#include "miniapps/parachute/scene/scene_check.hpp"

namespace drogue::parachute_app {
namespace {

using scene::Place, scene::rounded_text;

/// Checks that a flag resolves its motion on the grid and lies within the domain at the start.
void check_flag(const Place& at, const flow::Parameters& p, const Flag& flag) {
  const double width = least_width(p), longest = largest_edge_in_cells * width;
  const double along = flag.length / flag.divisions(),
               across = flag.has_width() ? *flag.width / flag.divisions_across() : 0.0;
  at.refuse_if(std::max(along, across) > (1.0 + 1e-9) * longest, "edge_length", " = ", flag.edge_length,
               " m is too coarse: the flag leaks on cells of ", width, " m; at most ", longest, " m");
  at.refuse_if(flag.vertices() > most_vertices, "edge_length", " = ", flag.edge_length,
               " m: the vertices are more than 2^20");
  fabric::Parameters sheets;
  std::vector<fabric::Vector> positions;
  append_flags({flag}, sheets, positions);
  for (std::size_t axis = 0; axis < (flag.has_width() ? 3U : 2U); ++axis) {
    if (!is_bounded(p, axis)) {
      const double most = length_of(p, axis) - 2.0 * core_width(p, axis);
      at.refuse_if(axis == 2 && *flag.width > most, "width", " = ", flag.width.value_or(0.0),
                   " m: the flag meets itself across the periodic sides; at most ", rounded_text(most), " m");
      continue;
    }
    const auto [begin, end] = sheet_extent(p, axis);
    const bool fits = axis < 2 || *flag.width <= end - begin - 2.0 * core_width(p, axis);
    check_margin(at, p,
                 axis < 2 ? "leading_edge"
                 : fits   ? "middle"
                          : "width",
                 at.path(), axis, positions, axis < 2 ? "" : ", by its width and middle");
  }
}

}  // namespace

void complete_and_check_flags(const Place& root, FlowScene& scene) {
  const flow::Parameters& p = scene.parameters;
  for (const auto& [at, flag] : root.each("flag", scene.flags)) {
    at.refuse_if(p.cells[0] == 1 || p.cells[1] == 1, "", " needs a grid with several cells along x and y");
    at.refuse_if(flag.has_width() && p.cells[2] == 1, "width",
                 " is for several cells along z; without it, the flag spans the domain");
    if (!flag.has_width() && p.cells[2] > 1)
      at.contradict("", "missing key \"", at.path("width"), "\" (needed with several cells along z)");
    at.refuse_if(!scene.bodies.empty() || !scene.canopies.empty(), "",
                 " cannot be combined with a [[body]] or a [[canopy]]");
    root.refuse_if(scene.is_explicit(), "coupling.method", " = \"explicit\" is not for a [[flag]]");
    const char* const differs = " differs from that of flag[0]; all flags have the same one";
    at.refuse_if(flag.bending_stiffness != scene.flags[0].bending_stiffness, "bending_stiffness", differs);
    at.refuse_if(flag.membrane_modulus != scene.flags[0].membrane_modulus, "membrane_modulus", differs);
    flag.span = {p.low[2], p.high[2]};
    check_flag(at, p, flag);
  }
}

}  // namespace drogue::parachute_app
