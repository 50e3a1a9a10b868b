#include "kernels/fabric/solver.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace drogue::fabric {

#define DROGUE_DECLARE(backend) std::unique_ptr<Solver> create_solver_##backend(const Parameters& parameters);
DROGUE_FOR_EACH_BACKEND(DROGUE_DECLARE)
#undef DROGUE_DECLARE

namespace {

void check(const Parameters& p) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(std::string("fabric solver: ") + what);
  };
  const std::size_t n = p.mesh.rest.size();
  const auto is_vertex = [&](int i) { return i >= 0 && static_cast<std::size_t>(i) < n; };
  require(n > 0, "there must be a vertex");
  for (const auto& t : p.mesh.triangles)
    require(std::ranges::all_of(t, is_vertex), "a triangle names a vertex that is not there");
  for (const auto& line : p.mesh.lines)
    require(std::ranges::all_of(line, is_vertex), "a line names a vertex that is not there");
  require(p.mass.size() == n && std::ranges::all_of(p.mass, [](double m) { return m > 0.0; }),
          "every vertex needs a positive mass");
  require(p.pinned.empty() || p.pinned.size() == n, "pins must be given for every vertex, or for none");
  require(p.load.empty() || p.load.size() == n, "loads must be given for every vertex, or for none");
  require(p.dt > 0.0, "dt must be positive");
  require(p.material.poisson > -1.0 && p.material.poisson <= 0.5,
          "Poisson's ratio must lie between -1 and 1/2");
}

}  // namespace

std::unique_ptr<Solver> create_solver(device::Backend backend, const Parameters& parameters) {
  check(parameters);
  switch (backend) {
#define DROGUE_CREATE(name)   \
  case device::Backend::name: \
    return create_solver_##name(parameters);
    DROGUE_FOR_EACH_BACKEND(DROGUE_CREATE)
#undef DROGUE_CREATE
    default:
      throw std::invalid_argument("fabric solver: this build lacks the backend");
  }
}

}  // namespace drogue::fabric
