#include "miniapps/parachute/flags/flag_check.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/scene/read.hpp"
#include "miniapps/parachute/scene/functions.hpp"

namespace drogue::parachute_app {
namespace {

using scene::contradict;
using scene::real_text;
using scene::rounded_text;
using scene::Table;

constexpr double most_flag_vertices = 1048576.0;  // 2^20

/// Checks that a flag resolves its motion on the grid and lies within the domain at the start.
void check_flag(const Table& root, const flow::Parameters& p, const Flag& flag, const std::string& name) {
  const auto spacing = lattice_of(p, flow::StateField::pressure).spacing;
  const double width = flag.has_width() ? std::min({spacing[0], spacing[1], spacing[2]})
                                        : std::min(spacing[0], spacing[1]),
               longest = largest_edge_in_cells * width;
  const std::string key = name + ".edge_length";
  const double along = flag.length / flag.divisions(),
               across = flag.has_width() ? *flag.width / flag.divisions_across() : 0.0;
  if (std::max(along, across) > (1.0 + 1e-9) * longest)
    contradict(root, key,
               key + " = " + real_text(flag.edge_length) + " m is too coarse: the flag leaks on cells of " +
                   real_text(width) + " m; at most " + real_text(longest) + " m");
  if (flag.vertices() > most_flag_vertices)
    contradict(root, key, key + " = " + real_text(flag.edge_length) + " m: the vertices are more than 2^20");
  fabric::Parameters sheets;
  std::vector<fabric::Vector> positions;
  append_flags({flag}, sheets, positions);
  for (std::size_t axis = 0; axis < (flag.has_width() ? 3U : 2U); ++axis) {
    if (p.boundary[2 * axis].kind == flow::BoundaryKind::periodic) {
      const double most = p.high[axis] - p.low[axis] - 2.0 * spacing[axis];
      if (axis == 2 && *flag.width > most)
        contradict(root, name + ".width",
                   name + ".width = " + real_text(*flag.width) +
                       " m: the flag meets itself across the periodic sides; at most " + rounded_text(most) +
                       " m");
      continue;
    }
    const auto [low, high] =
        std::ranges::minmax(positions, {}, [axis](const fabric::Vector& x) { return x[axis]; });
    const double least = p.low[axis] + spacing[axis], most = p.high[axis] - spacing[axis];
    if (low[axis] >= least && high[axis] <= most) continue;
    const bool fits = axis < 2 || *flag.width <= most - least;
    contradict(root,
               name + (axis < 2 ? ".leading_edge"
                       : fits   ? ".middle"
                                : ".width"),
               name + " reaches from " + rounded_text(low[axis]) + " to " + rounded_text(high[axis]) +
                   " m along " + axis_names[axis] +
                   ", beyond the cells beside the sides of the domain: it must lie between " +
                   rounded_text(least) + " and " + rounded_text(most) + " m" +
                   (axis == 2 ? ", by its width and middle" : ""));
  }
}

}  // namespace

void complete_and_check_flags(const Table& root, FlowScene& scene) {
  const flow::Parameters& p = scene.parameters;
  for (std::size_t i = 0; i < scene.flags.size(); ++i) {
    Flag& flag = scene.flags[i];
    const std::string name = "flag[" + std::to_string(i) + "]";
    if (p.cells[0] == 1 || p.cells[1] == 1)
      contradict(root, name, name + " needs a grid with several cells along x and y");
    if (flag.has_width() != (p.cells[2] > 1))
      contradict(root, flag.has_width() ? name + ".width" : name,
                 flag.has_width()
                     ? name + ".width is for several cells along z; without it, the flag spans the domain"
                     : "missing key \"" + name + ".width\" (needed with several cells along z)");
    if (!scene.bodies.empty() || !scene.canopies.empty())
      contradict(root, name, name + " cannot be combined with a [[body]] or a [[canopy]]");
    if (scene.is_explicit())
      contradict(root, "coupling.method", "coupling.method = \"explicit\" is not for a [[flag]]");
    const auto require_same = [&](const char* key, double value, double first) {
      if (value != first)
        contradict(root, name + "." + key,
                   name + "." + key + " differs from that of flag[0]; all flags have the same one");
    };
    require_same("bending_stiffness", flag.bending_stiffness, scene.flags[0].bending_stiffness);
    require_same("membrane_modulus", flag.membrane_modulus, scene.flags[0].membrane_modulus);
    flag.span = {p.low[2], p.high[2]};
    check_flag(root, p, flag, name);
  }
}

}  // namespace drogue::parachute_app
