#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "kernels/coupling/interpolate.hpp"
#include "kernels/coupling/spread.hpp"
#include "kernels/device/captured_graph.hpp"
#include "kernels/reference/coupling/grid_transfer.hpp"
#include "tests/support/other_space.hpp"
#include "tests/support/profiled.hpp"

// Interpolation and spreading against the oracle, and their conservation, adjointness and reproducibility.

namespace drogue::coupling {
namespace {

using Space = DROGUE_TEST_SPACE;
using OtherSpace = testing::OtherHostSpace<Space>;
using reference::FaceField;
using Vector = std::array<double, 3>;
using Vectors = std::vector<Vector>;

constexpr DeltaFunction deltas[] = {DeltaFunction::cbs43, DeltaFunction::cbs32, DeltaFunction::ib4};

#if defined(DROGUE_EXACT)
constexpr double backend_tolerance = 0.0;
#else
constexpr double backend_tolerance = 1e-12;
#endif

template <class E>
using FieldView = Kokkos::View<double***, Kokkos::LayoutLeft, typename E::memory_space>;
template <class E>
using PointView = Kokkos::View<double* [3], Kokkos::LayoutLeft, typename E::memory_space>;
template <class E>
using NumberView = Kokkos::View<double*, typename E::memory_space>;

/// Random numbers with a fixed seed.
class Random {
 public:
  explicit Random(unsigned seed) : _engine(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * std::generate_canonical<double, 53>(_engine);
  }
  Vectors vectors(std::size_t n, double size) {
    Vectors result(n);
    for (Vector& row : result)
      for (double& value : row) value = (*this)(-size, size);
    return result;
  }
  FaceField field(const StaggeredGrid& grid) {
    FaceField result = reference::zero_field(grid);
    for (auto& values : result)
      for (double& value : values) value = (*this)(-1.0, 1.0);
    return result;
  }
  /// Points up to `margin` cells inside of all sides; outside for a negative margin.
  Vectors points(const StaggeredGrid& grid, std::size_t n, double margin) {
    Vectors result(n);
    for (Vector& row : result)
      for (std::size_t axis = 0; axis < 3; ++axis)
        row[axis] = grid.origin[axis] + grid.spacing[axis] * (*this)(margin, grid.cells[axis] - margin);
    return result;
  }

 private:
  std::mt19937 _engine;
};

/// Bounded, mixed and periodic grids, also with axes of one cell and of fewer cells than a delta function.
std::vector<StaggeredGrid> all_grids() {
  const std::array<double, 3> origin{-0.3, 1.7, 100.0}, spacing{0.1, 0.25, 0.2};
  return {{{9, 8, 7}, origin, spacing, {false, false, false}},
          {{6, 7, 5}, origin, spacing, {true, true, true}},
          {{7, 9, 1}, origin, spacing, {false, true, true}},
          {{3, 1, 2}, origin, spacing, {true, false, true}}};
}

template <class E>
PointView<E> on_device(const E& space, const Vectors& rows) {
  const PointView<E> view("rows", rows.size());
  const auto mirror = Kokkos::create_mirror_view(view);
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) mirror(i, axis) = rows[i][axis];
  Kokkos::deep_copy(space, view, mirror);
  space.fence();
  return view;
}

template <class E>
NumberView<E> on_device(const E& space, const std::vector<double>& numbers) {
  const NumberView<E> view("numbers", numbers.size());
  const auto mirror = Kokkos::create_mirror_view(view);
  for (std::size_t i = 0; i < numbers.size(); ++i) mirror(i) = numbers[i];
  Kokkos::deep_copy(space, view, mirror);
  space.fence();
  return view;
}

template <class View>
Vectors on_host(const View& view) {
  Kokkos::fence();
  const auto mirror = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, view);
  Vectors rows(view.extent(0));
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) rows[i][axis] = mirror(i, axis);
  return rows;
}

/// Calls `visit(component, n, i, j, k)` for each face, n counting in the order of FaceField.
template <class Visit>
void for_each_face(const StaggeredGrid& grid, const Visit& visit) {
  for (int d = 0; d < 3; ++d) {
    std::size_t n = 0;
    for (int k = 0; k < faces_along(grid, d, 2); ++k)
      for (int j = 0; j < faces_along(grid, d, 1); ++j)
        for (int i = 0; i < faces_along(grid, d, 0); ++i) visit(static_cast<std::size_t>(d), n++, i, j, k);
  }
}

template <class E>
FaceViews<FieldView<E>> on_device(const E& space, const StaggeredGrid& grid, const FaceField& field) {
  FaceViews<FieldView<E>> views;
  FaceViews<typename FieldView<E>::host_mirror_type> mirrors;
  for (int d = 0; d < 3; ++d) {
    const auto extent = [&](int axis) { return static_cast<std::size_t>(faces_along(grid, d, axis)); };
    views.component[d] = FieldView<E>("field", extent(0), extent(1), extent(2));
    mirrors.component[d] = Kokkos::create_mirror_view(views.component[d]);
  }
  for_each_face(grid, [&](std::size_t d, std::size_t n, int i, int j, int k) {
    mirrors.component[d](i, j, k) = field[d][n];
  });
  for (int d = 0; d < 3; ++d) Kokkos::deep_copy(space, views.component[d], mirrors.component[d]);
  space.fence();
  return views;
}

template <class View>
FaceField on_host(const StaggeredGrid& grid, const FaceViews<View>& views) {
  Kokkos::fence();
  FaceViews<typename View::host_mirror_type> mirrors;
  for (int d = 0; d < 3; ++d)
    mirrors.component[d] = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, views.component[d]);
  FaceField field = reference::zero_field(grid);
  for_each_face(grid, [&](std::size_t d, std::size_t n, int i, int j, int k) {
    field[d][n] = mirrors.component[d](i, j, k);
  });
  return field;
}

/// Transfer with frozen positions on a backend, and its results on the host.
template <class E>
struct Case {
  E space;
  GridTransfer<E> transfer;

  Case(const StaggeredGrid& grid, DeltaFunction delta, const Vectors& points)
      : transfer(space, grid, delta, static_cast<int>(points.size())) {
    const PointView<E> x = on_device(space, points);
    const PointView<E> v("at rest", points.size());
    freeze_positions(space, transfer, x, v, 0.0);
  }
  Vectors interpolated(const FaceField& field) const {
    const PointView<E> result("result", static_cast<std::size_t>(transfer.points));
    interpolate(space, transfer, on_device(space, transfer.grid, field), result);
    return on_host(result);
  }
  FaceField densities(const Vectors& forces, double bound = 0.0) const {
    const auto density = on_device(space, transfer.grid, reference::zero_field(transfer.grid));
    spread(space, transfer, on_device(space, forces), density, bound);
    return on_host(transfer.grid, density);
  }
  Vectors row_sums(const std::vector<double>& areas, double density) const {
    const PointView<E> result("result", static_cast<std::size_t>(transfer.points));
    spread_row_sums(space, transfer, on_device(space, areas), density, result);
    return on_host(result);
  }
  TransferCounts counts() const { return transfer_counts(space, transfer); }
};

void expect_near(const Vectors& a, const Vectors& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(a[i][k], b[i][k], tolerance) << i << ' ' << k;
}

void expect_near(const FaceField& a, const FaceField& b, double tolerance) {
  for (std::size_t d = 0; d < 3; ++d) {
    ASSERT_EQ(a[d].size(), b[d].size());
    for (std::size_t n = 0; n < a[d].size(); ++n) ASSERT_NEAR(a[d][n], b[d][n], tolerance) << d << ' ' << n;
  }
}

double sum(const std::vector<double>& values) {
  double result = 0.0;
  for (const double value : values) result += value;
  return result;
}

double cell_volume_of(const StaggeredGrid& grid) {
  return grid.spacing[0] * grid.spacing[1] * grid.spacing[2];
}

std::vector<double> random_areas(Random& random, std::size_t n) {
  std::vector<double> areas(n);
  for (double& area : areas) area = random(0.0, 0.01);
  return areas;
}

TEST(GridTransfer, InterpolationMatchesTheOracleInsideAndOutsideOfTheGrid) {
  for (const StaggeredGrid& grid : all_grids())
    for (const DeltaFunction delta : deltas) {
      Random random(1);
      const FaceField field = random.field(grid);
      for (const double margin : {0.0, -20.0}) {
        const Vectors points = random.points(grid, 60, margin);
        expect_near(Case<Space>(grid, delta, points).interpolated(field),
                    reference::interpolate(grid, delta, field, points), 3e-13);
      }
    }
}

// ctest-label: smoke
TEST(GridTransfer, SpreadingMatchesTheOracleInsideAndOutsideOfTheGrid) {
  for (const StaggeredGrid& grid : all_grids())
    for (const DeltaFunction delta : deltas) {
      Random random(2);
      const Vectors forces = random.vectors(60, 10.0);
      for (const double margin : {0.0, -20.0}) {
        const Vectors points = random.points(grid, 60, margin);
        expect_near(Case<Space>(grid, delta, points).densities(forces),
                    reference::spread(grid, delta, points, forces), 1e-10 / cell_volume_of(grid) / 100.0);
      }
    }
}

TEST(GridTransfer, RowSumsMatchTheOracle) {
  for (const StaggeredGrid& grid : all_grids())
    for (const DeltaFunction delta : deltas) {
      Random random(3);
      const Vectors points = random.points(grid, 60, 0.0);
      const std::vector<double> areas = random_areas(random, points.size());
      const Case<Space> run(grid, delta, points);
      const Vectors expected = reference::spread_row_sums(grid, delta, points, areas, 1.2);
      expect_near(run.row_sums(areas, 1.2), expected, 1e-12);
      // The sums are reset: a second call has the same bits.
      expect_near(run.row_sums(areas, 1.2), run.row_sums(areas, 1.2), 0.0);
    }
}

/// Faces of the ranks that divide the cells of a grid along y and z.
std::vector<FaceWindow> windows_of(const StaggeredGrid& grid) {
  std::vector<FaceWindow> windows;
  const std::array<int, 3> parts{1, std::min(3, grid.cells[1]), std::min(2, grid.cells[2])};
  for (int place_z = 0; place_z < parts[2]; ++place_z)
    for (int place_y = 0; place_y < parts[1]; ++place_y) {
      FaceWindow& window = windows.emplace_back();
      const std::array<int, 3> place{0, place_y, place_z};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const int n = grid.cells[axis], a = static_cast<int>(axis);
        const int begin = n * place[axis] / parts[axis], end = n * (place[axis] + 1) / parts[axis];
        for (int d = 0; d < 3; ++d)
          window.set(d, a, begin, (end < n ? end : faces_along(grid, d, a)) - begin);
      }
    }
  return windows;
}

/// Part of the values at all faces.
template <class View>
auto part_of(const FaceViews<View>& whole, const FaceWindow& window) {
  const auto part = [&](int d) {
    const auto range = [&](int axis) {
      return std::pair<int, int>(window.first(d, axis), window.first(d, axis) + window.faces(d, axis));
    };
    return Kokkos::subview(whole.component[d], range(0), range(1), range(2));
  };
  return FaceViews<decltype(part(0))>{{part(0), part(1), part(2)}};
}

/// Difference of densities by kernels that are compiled apart, for a part of the faces and for all, relative
/// to the largest: the compiler may fuse other operations.
#if defined(DROGUE_EXACT)
constexpr double other_kernel_tolerance = 0.0;
#else
constexpr double other_kernel_tolerance = 1e-14;
#endif

TEST(GridTransfer, RanksThatDivideTheFacesSpreadTheBitsOfOneAndInterpolateItsSum) {
  const Space space;
  for (const StaggeredGrid& grid : all_grids())
    for (const DeltaFunction delta : deltas) {
      Random random(31);
      const FaceField field = random.field(grid);
      const Vectors points = random.points(grid, 60, -1.0), forces = random.vectors(60, 10.0);
      const std::vector<double> areas = random_areas(random, points.size());
      const Case<Space> whole(grid, delta, points);
      const auto density = on_device(space, grid, reference::zero_field(grid));
      Vectors velocities(points.size(), Vector{}), row_sums = velocities;
      const auto add = [](Vectors& sums, const Vectors& values) {
        for (std::size_t i = 0; i < sums.size(); ++i)
          for (std::size_t k = 0; k < 3; ++k) sums[i][k] += values[i][k];
      };
      std::vector<GridTransfer<Space>> parts;
      for (const FaceWindow& window : windows_of(grid)) {
        Case<Space> part = whole;
        part.transfer = GridTransfer<Space>(space, grid, delta, static_cast<int>(points.size()), window);
        EXPECT_EQ(part.transfer.is_divided(), window != whole_window(grid));
        freeze_positions(space, part.transfer, on_device(space, points),
                         PointView<Space>("at rest", points.size()), 0.0);
        EXPECT_EQ(part.counts().incomplete_points, whole.counts().incomplete_points);
        spread(space, part.transfer, on_device(space, forces), part_of(density, window));
        const PointView<Space> result("result", points.size());
        interpolate(space, part.transfer, part_of(on_device(space, grid, field), window), result);
        add(velocities, on_host(result));
        add(row_sums, part.row_sums(areas, 1.2));
        parts.push_back(part.transfer);
      }
      const FaceField expected = whole.densities(forces);
      double largest = 0.0;
      for (const std::vector<double>& component : expected)
        for (const double value : component) largest = std::max(largest, std::abs(value));
      expect_near(on_host(grid, density), expected, other_kernel_tolerance * largest);
      expect_near(velocities, whole.interpolated(field), 1e-14);
      expect_near(row_sums, whole.row_sums(areas, 1.2), 1e-13);
      for (std::size_t i = 0; i < parts.size(); ++i)
        clear_spread(space, parts[i], part_of(density, parts[i].window));
      expect_near(on_host(grid, density), reference::zero_field(grid), 0.0);
    }
}

TEST(GridTransfer, ConstantFieldsAreReproducedEverywhere) {
  for (const StaggeredGrid& grid : all_grids())
    for (const DeltaFunction delta : deltas) {
      FaceField field = reference::zero_field(grid);
      for (std::size_t d = 0; d < 3; ++d) std::ranges::fill(field[d], 1.0 + static_cast<double>(d));
      const Vectors points = Random(4).points(grid, 100, -10.0);
      expect_near(Case<Space>(grid, delta, points).interpolated(field), Vectors(100, {1.0, 2.0, 3.0}), 4e-15);
    }
}

TEST(GridTransfer, LinearFieldsAreReproducedAwayFromBoundedSides) {
  const StaggeredGrid grid = all_grids()[0];
  const std::array<Vector, 3> slope{{{1.0, -2.0, 0.5}, {3.0, 0.25, -1.0}, {-0.5, 2.0, 4.0}}};
  const auto value = [&](std::size_t d, const Vector& x) {
    return slope[d][0] * x[0] + slope[d][1] * x[1] + slope[d][2] * (x[2] - 100.0);
  };
  FaceField field = reference::zero_field(grid);
  for_each_face(grid, [&](std::size_t d, std::size_t n, int i, int j, int k) {
    Vector x{i + 0.5, j + 0.5, k + 0.5};
    x[d] -= 0.5;
    for (std::size_t axis = 0; axis < 3; ++axis) x[axis] = grid.origin[axis] + grid.spacing[axis] * x[axis];
    field[d][n] = value(d, x);
  });
  for (const DeltaFunction delta : deltas) {
    const Vectors points = Random(5).points(grid, 200, delta == DeltaFunction::ib4 ? 1.5 : 1.0);
    Vectors expected;
    for (const Vector& x : points) expected.push_back({value(0, x), value(1, x), value(2, x)});
    const Case<Space> run(grid, delta, points);
    expect_near(run.interpolated(field), expected, 1e-12);
    EXPECT_EQ(run.counts().incomplete_points, 0);
  }
}

TEST(GridTransfer, CountsPointsWhoseDeltaFunctionLeavesTheGrid) {
  const StaggeredGrid grid{{8, 8, 8}, {0.0, 0.0, 0.0}, {0.5, 0.5, 0.5}, {false, true, false}};
  const double infinite = std::numeric_limits<double>::infinity(), nan = std::nan("");
  // Distance in cells that the delta function needs from a bounded side.
  for (const auto& [delta, needed] :
       {std::pair{DeltaFunction::cbs43, 1.0}, std::pair{DeltaFunction::cbs32, 0.5},
        std::pair{DeltaFunction::ib4, 1.5}}) {
    const double near = 0.5 * (needed - 0.01), enough = 0.5 * (needed + 0.01);
    const Vectors complete{{enough, 0.0, 2.0}, {2.0, -50.0, 4.0 - enough}, {4.0 - enough, 3.9, enough}};
    EXPECT_EQ(Case<Space>(grid, delta, complete).counts().incomplete_points, 0);
    const Vectors incomplete{{near, 0.0, 2.0},     {2.0, 2.0, 4.0 - near}, {4.0 - near, 3.9, near},
                             {-7.0, 2.0, 2.0},     {2.0, 2.0, 1e300},      {nan, 2.0, 2.0},
                             {2.0, infinite, 2.0}, {2.0, 2.0, -infinite},  {2.0, nan, 2.0},
                             {2.0, 1e300, 2.0}};
    EXPECT_EQ(Case<Space>(grid, delta, incomplete).counts().incomplete_points, 10);
  }
}

TEST(GridTransfer, FreezesPositionsAlongVelocities) {
  const Space space;
  const StaggeredGrid grid = all_grids()[0];
  const Vectors x = Random(6).points(grid, 20, 2.0), v = Random(7).vectors(20, 1.0);
  const GridTransfer<Space> transfer(space, grid, DeltaFunction::cbs43, 20);
  freeze_positions(space, transfer, on_device(space, x), on_device(space, v), 0.01);
  Vectors expected = x;
  for (std::size_t i = 0; i < 20; ++i)
    for (std::size_t k = 0; k < 3; ++k) expected[i][k] += 0.01 * v[i][k];
  expect_near(on_host(transfer.positions), expected, 2e-14);
}

TEST(GridTransfer, InterpolationIsTheAdjointOfSpreading) {
  for (const StaggeredGrid& grid : all_grids())
    for (const DeltaFunction delta : deltas) {
      Random random(8);
      const FaceField field = random.field(grid);
      const Vectors points = random.points(grid, 80, -1.0), forces = random.vectors(80, 1.0);
      const Case<Space> run(grid, delta, points);
      const Vectors velocities = run.interpolated(field);
      const FaceField densities = run.densities(forces);
      double power_of_points = 0.0, power_of_faces = 0.0;
      for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) power_of_points += velocities[i][k] * forces[i][k];
      for (std::size_t d = 0; d < 3; ++d)
        for (std::size_t n = 0; n < field[d].size(); ++n)
          power_of_faces += cell_volume_of(grid) * densities[d][n] * field[d][n];
      EXPECT_NEAR(power_of_points, power_of_faces, 1e-12);
    }
}

TEST(GridTransfer, SpreadingKeepsTheTotalForceExactly) {
  const StaggeredGrid grid{{9, 8, 7}, {0.0, 0.0, 0.0}, {0.25, 0.5, 0.125}, {false, true, false}};
  for (const DeltaFunction delta : deltas) {
    Random random(9);
    const Vectors points = random.points(grid, 64, -2.0);
    Vectors forces = random.vectors(64, 1.0);
    Vector total{};
    for (Vector& force : forces)
      for (std::size_t d = 0; d < 3; ++d) {
        force[d] = std::ldexp(std::round(std::ldexp(force[d], 20)), -20);  // a multiple of the unit
        total[d] += force[d];
      }
    // With this bound a unit is 2^-45 N, and no sum of densities rounds.
    const FaceField densities = Case<Space>(grid, delta, points).densities(forces, 1024.0);
    for (std::size_t d = 0; d < 3; ++d) EXPECT_EQ(cell_volume_of(grid) * sum(densities[d]), total[d]);
  }
}

TEST(GridTransfer, ResultDoesNotDependOnTheOrderOfPoints) {
  for (const StaggeredGrid& grid : all_grids())
    for (const DeltaFunction delta : deltas) {
      Random random(10);
      Vectors points = random.points(grid, 500, 0.0), forces = random.vectors(500, 1.0);
      const FaceField densities = Case<Space>(grid, delta, points).densities(forces);
      for (std::size_t i = points.size(); i > 1; --i) {
        const auto other = static_cast<std::size_t>(random(0.0, static_cast<double>(i)));
        std::swap(points[i - 1], points[other]);
        std::swap(forces[i - 1], forces[other]);
      }
      expect_near(Case<Space>(grid, delta, points).densities(forces), densities, 0.0);
    }
}

TEST(GridTransfer, BackendsAgree) {
  for (const StaggeredGrid& grid : all_grids())
    for (const DeltaFunction delta : deltas) {
      Random random(11);
      const FaceField field = random.field(grid);
      const Vectors points = random.points(grid, 300, -0.5), forces = random.vectors(300, 1.0);
      const std::vector<double> areas = random_areas(random, 300);
      const Case<Space> run(grid, delta, points);
      const Case<OtherSpace> other(grid, delta, points);
      expect_near(run.interpolated(field), other.interpolated(field), backend_tolerance);
      expect_near(run.densities(forces), other.densities(forces),
                  backend_tolerance / cell_volume_of(grid) * 100.0);
      expect_near(run.row_sums(areas, 1.2), other.row_sums(areas, 1.2), backend_tolerance);
    }
}

TEST(GridTransfer, SpreadingAddsToTheDensities) {
  const Space space;
  const StaggeredGrid grid = all_grids()[0];
  Random random(12);
  const Vectors points = random.points(grid, 50, 1.5), forces = random.vectors(50, 1.0);
  const Case<Space> run(grid, DeltaFunction::cbs43, points);
  const FaceField once = run.densities(forces), before = random.field(grid);
  const auto density = on_device(space, grid, before);
  spread(space, run.transfer, on_device(space, forces), density);
  spread(space, run.transfer, on_device(space, forces), density);
  FaceField expected = before;
  for (std::size_t d = 0; d < 3; ++d)
    for (std::size_t n = 0; n < expected[d].size(); ++n) expected[d][n] += 2.0 * once[d][n];
  expect_near(on_host(grid, density), expected, 1e-10);
}

TEST(GridTransfer, ClearsTheFacesAroundPointsAndNoOthers) {
  for (const StaggeredGrid& grid : all_grids())
    for (const DeltaFunction delta : deltas) {
      Random random(5);
      const Case<Space> run(grid, delta, random.points(grid, 2, 0.0));
      FaceField ones = reference::zero_field(grid);
      for (auto& values : ones) values.assign(values.size(), 1.0);
      const auto field = on_device(run.space, grid, ones);
      clear_spread(run.space, run.transfer, field);
      const FaceField cleared = on_host(grid, field), spread = run.densities(Vectors(2, {1.0, 1.0, 1.0}));
      for (std::size_t d = 0; d < 3; ++d)
        for (std::size_t n = 0; n < ones[d].size(); ++n)
          EXPECT_TRUE(cleared[d][n] == 0.0 || (cleared[d][n] == 1.0 && spread[d][n] == 0.0)) << d << ' ' << n;
      // Two delta functions cover 128 of 567 faces at most.
      if (grid.cells[0] == 9) {
        EXPECT_GE(std::ranges::count(cleared[0], 1.0), 400);
      }
    }
}

TEST(GridTransfer, CoincidentPointsWithTheLargestForceDoNotOverflow) {
  const StaggeredGrid grid{{5, 5, 5}, {0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}, {false, false, false}};
  // 4097 is just above a power of two. Of component 0 one face receives three quarters.
  for (const std::size_t n : {1U, 4096U, 4097U}) {
    const Vectors points(n, {2.0, 2.5, 2.5}), forces(n, {1e30, -1e30, 1e30});
    const FaceField densities = Case<Space>(grid, DeltaFunction::cbs32, points).densities(forces);
    const auto count = static_cast<double>(n);
    // The unit of the sums is below M n / 2^60, and a point errs by at most 20 units.
    const double tolerance = 20.0 * count * std::ldexp(1e30 * count, -60) + 1e-15 * count * 1e30;
    EXPECT_NEAR(sum(densities[0]), count * 1e30, tolerance);
    EXPECT_NEAR(sum(densities[1]), -count * 1e30, tolerance);
    EXPECT_NEAR(*std::ranges::max_element(densities[0]), 0.75 * count * 1e30, tolerance);
  }
}

TEST(GridTransfer, ResolvesForcesOfAnyMagnitude) {
  const StaggeredGrid grid = all_grids()[0];
  Random random(13);
  const Vectors points = random.points(grid, 30, 1.5), forces = random.vectors(30, 1.0);
  const Case<Space> run(grid, DeltaFunction::cbs43, points);
  const FaceField densities = run.densities(forces);
  for (const int exponent : {-800, -30, 30, 800}) {
    Vectors scaled = forces;
    for (Vector& force : scaled)
      for (double& value : force) value = std::ldexp(value, exponent);
    FaceField result = run.densities(scaled);
    for (auto& values : result)
      for (double& value : values) value = std::ldexp(value, -exponent);
    expect_near(result, densities, 0.0);
  }
  expect_near(run.densities(Vectors(30, Vector{})), reference::zero_field(grid), 0.0);
}

TEST(GridTransfer, RejectsForcesAboveTheBoundAndNonFiniteOnes) {
  const StaggeredGrid grid = all_grids()[0];
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  Random random(14);
  Vectors points = random.points(grid, 10, 1.5);
  const Vectors forces = random.vectors(10, 1.0);
  const FaceField expected = Case<Space>(grid, DeltaFunction::cbs43, points).densities(forces, 1.0);
  points.resize(13, {0.0, 0.0, nan});
  Vectors more = forces;
  more.resize(13, {1.0, 0.0, 0.0});  // one component each at a position that is not finite
  // The number of points has an effect on the resolution alone: 10 and 14 have the same power of two.
  points.push_back(points[0]), more.push_back({nan, 1.5, -infinite});
  const Case<Space> bounded(grid, DeltaFunction::cbs43, points);
  expect_near(bounded.densities(more, 1.0), expected, 0.0);
  EXPECT_EQ(bounded.counts().rejected_forces, 6);
  more.back()[1] = -1e300;
  const Case<Space> unbounded(grid, DeltaFunction::cbs43, points);
  expect_near(unbounded.densities(more), expected, 1e-10);
  EXPECT_EQ(unbounded.counts().rejected_forces, 6);
}

TEST(GridTransfer, RejectsForcesThatFixedPointCannotScaleWhateverTheBound) {
  const StaggeredGrid grid = all_grids()[0];
  Random random(15);
  const Vectors points = random.points(grid, 2, 1.5);
  const Case<Space> bounded(grid, DeltaFunction::cbs43, points);
  const FaceField result = bounded.densities({{1e290, 0.0, 0.0}, {1.0, 0.0, 0.0}}, 1e300);
  EXPECT_EQ(bounded.counts().rejected_forces, 1);
  for (const auto& values : result)
    for (const double value : values) EXPECT_LT(std::abs(value), 1e270);
}

TEST(GridTransfer, PositionsThatAreNotFiniteInterpolateToNaN) {
  const StaggeredGrid grid = all_grids()[0];
  const Vectors result = Case<Space>(grid, DeltaFunction::cbs43, {{0.0, 2.0, std::nan("")}})
                             .interpolated(Random(15).field(grid));
  for (const double value : result[0]) EXPECT_TRUE(std::isnan(value));
}

/// Discrete curl of a random potential at the edges: its discrete divergence vanishes.
FaceField divergence_free_field(const StaggeredGrid& grid) {
  Random random(16);
  const auto at = [&](const StaggeredGrid& g, int i, int j, int k) {
    const auto wrap = [&](std::size_t axis, int n) { return g.periodic[axis] ? n % g.cells[axis] : n; };
    return (static_cast<std::size_t>(wrap(2, k)) * 64 + static_cast<std::size_t>(wrap(1, j))) * 64 +
           static_cast<std::size_t>(wrap(0, i));
  };
  std::array<std::vector<double>, 3> potential;
  for (auto& values : potential) {
    values.resize(64 * 64 * 16);
    for (double& value : values) value = random(-1.0, 1.0);
  }
  FaceField field = reference::zero_field(grid);
  for_each_face(grid, [&](std::size_t d, std::size_t n, int i, int j, int k) {
    const std::size_t e = (d + 1) % 3, f = (d + 2) % 3;
    std::array<int, 3> low{i, j, k}, next_e = low, next_f = low;
    ++next_e[e], ++next_f[f];
    const auto value = [&](std::size_t component, const std::array<int, 3>& p) {
      return potential[component][at(grid, p[0], p[1], p[2])];
    };
    field[d][n] = (value(f, next_e) - value(f, low)) / grid.spacing[e] -
                  (value(e, next_f) - value(e, low)) / grid.spacing[f];
  });
  return field;
}

/// Largest divergence of the interpolated field, by central differences, over the points.
double interpolated_divergence(const StaggeredGrid& grid, DeltaFunction delta, const FaceField& field,
                               const Vectors& points) {
  constexpr double step = 1e-6;
  Vectors neighbours;
  for (const Vector& x : points)
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const double side : {1.0, -1.0}) {
        neighbours.push_back(x);
        neighbours.back()[axis] += side * step * grid.spacing[axis];
      }
  const Vectors u = Case<Space>(grid, delta, neighbours).interpolated(field);
  double largest = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    double divergence = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      divergence += (u[6 * i + 2 * axis][axis] - u[6 * i + 2 * axis + 1][axis]) /
                    (neighbours[6 * i + 2 * axis][axis] - neighbours[6 * i + 2 * axis + 1][axis]);
    largest = std::max(largest, std::abs(divergence));
  }
  return largest;
}

TEST(GridTransfer, CompositeSplinesInterpolateDivergenceFreeFieldsWithoutDivergence) {
  for (const bool periodic : {false, true}) {
    const StaggeredGrid grid{{9, 8, 7}, {0.0, 0.0, 0.0}, {0.5, 0.25, 1.0}, {periodic, periodic, periodic}};
    const FaceField field = divergence_free_field(grid);
    const Vectors points = Random(17).points(grid, 100, periodic ? -3.0 : 1.6);
    // Gradients are of order 10; differences resolve 1e-8 of them away from the knots.
    EXPECT_LT(interpolated_divergence(grid, DeltaFunction::cbs43, field, points), 1e-6);
    EXPECT_LT(interpolated_divergence(grid, DeltaFunction::cbs32, field, points), 1e-6);
    EXPECT_GT(interpolated_divergence(grid, DeltaFunction::ib4, field, points), 0.1);
  }
}

/// Mean row sum along the normal of a plane sheet askew to the cells, times density and spacing: vertices
/// within a cell of its middle, `part` cells apart.
double row_sum_of_plane(double part) {
  constexpr double spacing = 0.2, density = 1.2;
  const StaggeredGrid grid = {{16, 16, 16}, {}, {spacing, spacing, spacing}, {true, true, true}};
  constexpr Vector normal = {2.0 / 3.0, 1.0 / 3.0, 2.0 / 3.0}, first = {2.0 / 3.0, -2.0 / 3.0, -1.0 / 3.0},
                   second = {1.0 / 3.0, 2.0 / 3.0, -2.0 / 3.0}, middle = {1.626, 1.654, 1.538};
  const double distance = part * spacing;
  // Delta functions reach at most two cells from a vertex.
  const int count = static_cast<int>(std::lround(5.0 / part));
  Vectors points;
  std::vector<std::size_t> inner;
  for (int a = -count; a <= count; ++a)
    for (int b = -count; b <= count; ++b) {
      if (std::abs(a) * part <= 1.0 && std::abs(b) * part <= 1.0) inner.push_back(points.size());
      Vector& place = points.emplace_back();
      for (std::size_t axis = 0; axis < 3; ++axis)
        place[axis] = middle[axis] + distance * (a * first[axis] + b * second[axis]);
    }
  const std::vector<double> areas(points.size(), distance * distance);
  const Vectors sums = Case<Space>(grid, DeltaFunction::cbs43, points).row_sums(areas, density);
  double mean = 0.0;
  for (const std::size_t i : inner)
    for (std::size_t axis = 0; axis < 3; ++axis) mean += normal[axis] * normal[axis] * sums[i][axis];
  return mean / static_cast<double>(inner.size()) * density * spacing;
}

TEST(GridTransfer, RowSumsDoNotDependOnTheDistanceOfVertices) {
  const double finest = row_sum_of_plane(1.0 / 16.0);
  for (const double part : {0.5, 0.25, 0.125})
    EXPECT_NEAR(row_sum_of_plane(part) / finest, 1.0, 1e-4) << part;
  EXPECT_NEAR(row_sum_of_plane(1.0 / 1.4) / finest, 1.0, 1e-3);
}

TEST(GridTransfer, RowSumsBoundTheEnergyOfSpreadImpulses) {
  // Impulses J = a f on a crumpled sheet give the fluid at most the energy of the local masses (D - A >= 0).
  const StaggeredGrid grid = all_grids()[0];
  Random random(18);
  const Vectors points = random.points(grid, 60, 2.0);
  const std::vector<double> areas = random_areas(random, 60);
  for (const DeltaFunction delta : deltas) {
    const Case<Space> run(grid, delta, points);
    const Vectors row_sums = run.row_sums(areas, 1.2);
    for (int trial = 0; trial < 8; ++trial) {
      // Smooth impulses come close to the bound.
      const double noise = trial < 4 ? 0.0 : 1.0;
      Vectors impulses(60);
      double bound = 0.0, energy = 0.0;
      for (std::size_t i = 0; i < 60; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
          const double f = 1.0 + noise * random(-1.0, 1.0);
          impulses[i][k] = areas[i] * f;
          bound += row_sums[i][k] * areas[i] * f * f;
        }
      const FaceField densities = run.densities(impulses);
      for (const auto& values : densities)
        for (const double value : values) energy += cell_volume_of(grid) * value * value / 1.2;
      EXPECT_LE(energy, bound * (1.0 + 1e-12));
      if (noise == 0.0) {
        EXPECT_NEAR(energy, bound, 1e-12 * bound);
      }
    }
  }
}

TEST(GridTransfer, ReadsAndWritesFieldsOfAnyLayout) {
  const Space space;
  const StaggeredGrid grid = all_grids()[0];
  Random random(19);
  const FaceField field = random.field(grid);
  const Vectors points = random.points(grid, 40, 1.0), forces = random.vectors(40, 1.0);
  const Case<Space> run(grid, DeltaFunction::cbs43, points);
  using Padded = Kokkos::View<double***, Kokkos::LayoutRight, Space::memory_space>;
  using Strided = Kokkos::View<double***, Kokkos::LayoutStride, Space::memory_space>;
  FaceViews<Strided> values, densities;
  const auto source = on_device(space, grid, field);
  for (int d = 0; d < 3; ++d) {
    const auto inner = [&](const std::string& label) {
      const auto& like = source.component[d];
      const Padded padded(label, like.extent(0) + 2, like.extent(1) + 3, like.extent(2) + 4);
      const auto range = [&](std::size_t axis, std::size_t begin) {
        return Kokkos::make_pair(begin, begin + like.extent(axis));
      };
      return Strided(Kokkos::subview(padded, range(0, 1), range(1, 2), range(2, 1)));
    };
    values.component[d] = inner("values"), densities.component[d] = inner("densities");
    Kokkos::deep_copy(values.component[d], source.component[d]);
  }
  const PointView<Space> result("result", points.size());
  interpolate(space, run.transfer, values, result);
  expect_near(on_host(result), run.interpolated(field), 0.0);
  spread(space, run.transfer, on_device(space, forces), densities);
  const auto contiguous = on_device(space, grid, reference::zero_field(grid));
  for (int d = 0; d < 3; ++d) Kokkos::deep_copy(contiguous.component[d], densities.component[d]);
  expect_near(on_host(grid, contiguous), run.densities(forces), 0.0);
}

TEST(GridTransfer, TransfersWithoutFenceAllocationOrCopyAndReplaysFromAGraph) {
  const device::Instance<Space> instance(1);
  const Space& space = instance.space();
  const StaggeredGrid grid = all_grids()[0];
  Random random(20);
  const Vectors points = random.points(grid, 40, 1.5);
  const PointView<Space> x = on_device(space, points), v = on_device(space, random.vectors(40, 0.1)),
                         force = on_device(space, random.vectors(40, 1.0)), velocity("u", 40),
                         row_sums("row sums", 40);
  const NumberView<Space> area = on_device(space, random_areas(random, 40));
  const FaceField start = random.field(grid);
  const auto field = on_device(space, grid, start);
  const GridTransfer<Space> transfer(space, grid, DeltaFunction::cbs43, 40);
  const auto enqueue = [&](const Space& on) {
    freeze_positions(on, transfer, x, v, 0.01);
    spread_row_sums(on, transfer, area, 1.2, row_sums);
    interpolate(on, transfer, field, velocity);
    spread(on, transfer, force, field, 2.0);
    spread(on, transfer, velocity, field);
  };
  const auto before = testing::profiled();
  enqueue(space);
  enqueue(space);
  const auto after = testing::profiled();
  EXPECT_EQ(after.fences, before.fences);
  EXPECT_EQ(after.allocations, before.allocations);
  EXPECT_EQ(after.copies, before.copies);
  EXPECT_LE(after.kernel_launches - before.kernel_launches, 2 * (1 + 4 + 1 + 2 + 3));
  const FaceField direct = on_host(grid, field);
  const Vectors direct_velocity = on_host(velocity);

  const auto fresh = on_device(space, grid, start);
  for (int d = 0; d < 3; ++d) Kokkos::deep_copy(space, field.component[d], fresh.component[d]);
  space.fence();
  const device::CapturedGraph<Space> graph(instance, enqueue);
  graph.launch();
  graph.launch();
  expect_near(on_host(grid, field), direct, 0.0);
  expect_near(on_host(velocity), direct_velocity, 0.0);
}

TEST(GridTransfer, RejectsInvalidGridsViewsAndParameters) {
  const Space space;
  const auto expect_invalid = [&](const StaggeredGrid& grid) {
    EXPECT_THROW(GridTransfer<Space>(space, grid, DeltaFunction::cbs43, 1), std::invalid_argument);
  };
  StaggeredGrid grid = all_grids()[0];
  grid.cells[1] = 0;
  expect_invalid(grid);
  for (const double wrong : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    grid = all_grids()[0], grid.spacing[2] = wrong;
    expect_invalid(grid);
  }
  grid = all_grids()[0], grid.origin[0] = std::nan("");
  expect_invalid(grid);
  grid = all_grids()[0];
  EXPECT_THROW(GridTransfer<Space>(space, grid, DeltaFunction::cbs43, -1), std::invalid_argument);

  const GridTransfer<Space> transfer(space, grid, DeltaFunction::cbs43, 3);
  const PointView<Space> rows("rows", 3), few("few", 2);
  const NumberView<Space> numbers("numbers", 3);
  const auto field = on_device(space, grid, reference::zero_field(grid));
  auto swapped = field;
  std::swap(swapped.component[0], swapped.component[1]);
  EXPECT_THROW(freeze_positions(space, transfer, few, rows, 0.0), std::invalid_argument);
  EXPECT_THROW(interpolate(space, transfer, field, few), std::invalid_argument);
  EXPECT_THROW(interpolate(space, transfer, swapped, rows), std::invalid_argument);
  EXPECT_THROW(spread(space, transfer, few, field), std::invalid_argument);
  EXPECT_THROW(spread(space, transfer, rows, swapped), std::invalid_argument);
  EXPECT_THROW(spread(space, transfer, rows, field, -1.0), std::invalid_argument);
  EXPECT_THROW(spread(space, transfer, rows, field, std::nan("")), std::invalid_argument);
  EXPECT_THROW(spread_row_sums(space, transfer, numbers, 0.0, rows), std::invalid_argument);
  const GridTransfer<Space> empty(space, grid, DeltaFunction::cbs43, 0);
  spread(space, empty, PointView<Space>("none", 0), field);
  expect_near(on_host(grid, field), reference::zero_field(grid), 0.0);
}

}  // namespace
}  // namespace drogue::coupling
