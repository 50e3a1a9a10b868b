#pragma once

#include "perf/sheet.hpp"

/// A square sheet of nearly equilateral triangles, 1 m long, rolled up tight: steps in contact are timed on
/// it. Each layer lies as near to the next as contact lets it, and waves run round the roll that drive
/// neighbouring layers against one another, so that every vertex meets cloth on either side. The
/// thickness is a share of an edge, and the layers lie that far apart: as much is in touch whatever the mesh.
namespace drogue::perf::roll {

/// About `vertices` of them, numbered as the mini-app does.
fabric::Parameters parameters(int vertices);

sheet::State start(const fabric::Parameters& p);

/// Half of the largest stable step from the start, s, and no more than moves a vertex by a tenth of an edge.
double usual_dt(const fabric::Parameters& p, fabric::Solver& solver);

/// `count` steps from the start. `solver`, made for `p`, must outlive the sample.
Sample steps(const fabric::Parameters& p, fabric::Solver& solver, long count);

/// How far the energy, less the work of contact, is from that of the start, over the kinetic energy there.
/// Infinite where the state was lost, where contact did nothing, or where the exact checker finds cloth that
/// meets cloth; it is asked about meshes of up to `most_checked` vertices, for others it takes minutes.
double imbalance(const fabric::Parameters& p, fabric::Solver& solver);
inline constexpr std::size_t most_checked = 30'000;

/// As the scenes' that let cloth meet itself: what friction and the step leave unaccounted for.
inline constexpr double tolerance = 2e-2;

}  // namespace drogue::perf::roll
