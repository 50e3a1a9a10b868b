#include <algorithm>
#include <cstdio>
#include <new>
#include <numeric>
#include <string>
#include <vector>

#include "common/program/communicator.hpp"
#include "common/program/program.hpp"
#include "miniapps/parachute/simulation/grid_parts.hpp"

// Functions of several ranks, for tests/program/test_communicator.py:
//
//   ranks_together FUNCTION FAILING EXCEPTION     a function of Communicator; FAILING: rank, "all" or "none"
//   ranks_together grid_parts                     arrays of a flow, put together from parts

namespace drogue {
namespace {

void call(Communicator& communicator, const std::string& function, const std::string& failing,
          const std::string& exception) {
  const auto action = [&] {
    if (failing != "all" && failing != std::to_string(communicator.rank())) return;
    if (exception == "failure") throw Failure(ExitCode::numerical_failure, "diverged");
    throw std::bad_alloc();
  };
  if (function == "run_collectively") return communicator.run_collectively(action);
  if (function == "run_on_root") return communicator.run_on_root(action);
  const auto communicate = [&] {
    action();
    communicator.run_collectively([] {});  // waits for all
  };
  communicator.run_or_abort(communicate, [] { std::puts("before the end"), std::fflush(stdout); });
}

/// True if the whole arrays of cells, and of faces normal to each axis, that rank 0 puts together number
/// their entries in order.
bool join_parts() {
  flow::Parameters p;
  p.cells = {4, 7, 9};
  for (flow::Boundary& side : p.boundary) side.kind = flow::BoundaryKind::wall;
  const parachute_app::GridParts parts(p, linear::RankGroup::world());
  bool is_right = true;
  for (std::size_t normal = 0; normal <= flow::at_cells; ++normal) {
    const std::array<int, 3> n = parachute_app::lattice_of(p, normal).n;
    const parachute_app::Lattice lattice = parts.lattice(normal);
    std::vector<double> own;
    for (int k = 0; k < lattice.n[2]; ++k)
      for (int j = 0; j < lattice.n[1]; ++j)
        for (int i = 0; i < lattice.n[0]; ++i)
          own.push_back(((lattice.origin[2] + k) * n[1] + lattice.origin[1] + j) * n[0] + lattice.origin[0] +
                        i);
    const std::vector<double> whole = parts.whole(n, own);
    std::vector<double> expected(parts.group().rank() == 0 ? linear::CellBox{{}, n}.size() : 0);
    std::iota(expected.begin(), expected.end(), 0.0);
    is_right = is_right && whole == expected && own.size() < linear::CellBox{{}, n}.size();
  }
  return is_right;
}

}  // namespace
}  // namespace drogue

int main(int argc, char** argv) {
  using namespace drogue;
  Communicator communicator;
  if (argc != 4) {
    const bool is_right = join_parts();
    std::printf("%d: %s\n", communicator.rank(), is_right ? "whole" : "wrong");
    return 0;
  }
  try {
    call(communicator, argv[1], argv[2], argv[3]);
    std::printf("%d: done\n", communicator.rank());
  } catch (...) {
    const Failure failure = current_failure();
    std::printf("%d: %d, %s\n", communicator.rank(), static_cast<int>(failure.code()), failure.what());
  }
}
