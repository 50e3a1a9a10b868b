#pragma once

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <vector>

#include "kernels/coupling/sheet/porous_law.hpp"
#include "kernels/device/launch.hpp"
#include "kernels/spatial/points.hpp"

namespace drogue::coupling {

/// Vector along an axis with a length in any unit. Does not throw.
KOKKOS_INLINE_FUNCTION spatial::Point along_axis(int axis, double length) {
  return {axis == 0 ? length : 0.0, axis == 1 ? length : 0.0, axis == 2 ? length : 0.0};
}

/// Closing sheets on a device, and what they change in a step.
template <class ExecutionSpace>
struct ClosingSheetViews {
  using Memory = typename ExecutionSpace::memory_space;

  Kokkos::View<ClosingSheet*, Memory> sheets;
  Kokkos::View<PorousLaw*, Memory> law;    ///< of the vertices
  Kokkos::View<int*, Memory> sheet_of;     ///< of the vertices, or -1; empty without closing sheets
  Kokkos::View<double*, Memory> impulse;   ///< foretold, per area of each sheet, along its axis, Pa s
  Kokkos::View<double[3], Memory> column;  ///< change of the velocity along each axis by all of these, m/s

  /// Number of the closing sheet of a vertex, or -1.
  KOKKOS_FUNCTION int operator()(int vertex) const { return sheet_of.extent(0) > 0 ? sheet_of(vertex) : -1; }
};

/// Sums of a part of a sheet: weight and weighted velocity of the sheet relative to the air, m/s.
struct ClosingMean {
  double weight = 0.0, sum = 0.0;
};

/// Adds the velocities of each chunk of vertices, or of triangles, in ascending order. `Velocity` has
/// `operator()(const ClosingSheet&, int which, ClosingMean&)`.
template <class ExecutionSpace, class Velocity>
struct AddClosingChunksFunctor {
  using Memory = typename ExecutionSpace::memory_space;

  Velocity velocity;
  Kokkos::View<ClosingSheet*, Memory> sheets;
  Kokkos::View<int* [3], Memory> chunks;  ///< sheet, begin, end
  Kokkos::View<ClosingMean*, Memory> means;

  KOKKOS_FUNCTION void operator()(const int chunk) const {
    ClosingMean mean;
    const ClosingSheet sheet = sheets(chunks(chunk, 0));
    for (int i = chunks(chunk, 1); i < chunks(chunk, 2); ++i) velocity(sheet, i, mean);
    means(chunk) = mean;
  }
};

/// Foretells the impulses of all closing sheets, with one thread. Along an axis they give the air of the
/// whole channel one change of velocity c:
///   c = sum of m I,  I = dt (alpha + beta |w - c|) (w - c)
/// with the inverse masses m and the velocities w of the sheets relative to the air without their forces.
template <class ExecutionSpace>
struct ForetellImpulsesFunctor {
  using Memory = typename ExecutionSpace::memory_space;

  ClosingSheetViews<ExecutionSpace> views;
  Kokkos::View<int* [3], Memory> chunks;
  Kokkos::View<ClosingMean*, Memory> means;
  Kokkos::View<double*, Memory> relative;  ///< mean velocity of each sheet, m/s
  double dt;

  [[nodiscard]] KOKKOS_FUNCTION PorousLaw law_of(int k) const { return views.law(views.sheets(k).begin); }
  [[nodiscard]] KOKKOS_FUNCTION bool is_along(int k, int axis) const { return views.sheets(k).axis == axis; }

  /// Sum of m I of the porous sheets along an axis for a change of velocity c, m/s.
  [[nodiscard]] KOKKOS_FUNCTION double change_by_porous(int axis, double c) const {
    double sum = 0.0;
    for (int k = 0; k < static_cast<int>(relative.extent(0)); ++k)
      if (is_along(k, axis) && !law_of(k).impermeable)
        sum += views.sheets(k).inverse_mass * porous_impulse(law_of(k), relative(k) - c, dt, 0.0);
    return sum;
  }

  /// The change of velocity: that of an impermeable sheet, or by bisection, since the sum falls with c.
  [[nodiscard]] KOKKOS_FUNCTION double change_of_velocity(int axis) const {
    double low = 0.0, high = 0.0;
    for (int k = 0; k < static_cast<int>(relative.extent(0)); ++k) {
      if (!is_along(k, axis)) continue;
      if (law_of(k).impermeable) return relative(k);
      low = Kokkos::fmin(low, relative(k)), high = Kokkos::fmax(high, relative(k));
    }
    constexpr int halvings = 80;
    for (int i = 0; i < halvings; ++i) {
      const double middle = 0.5 * (low + high);
      (change_by_porous(axis, middle) > middle ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

  KOKKOS_FUNCTION void operator()(int) const {
    const int count = static_cast<int>(relative.extent(0));
    int chunk = 0;
    for (int k = 0; k < count; ++k) {
      ClosingMean mean;
      for (; chunk < static_cast<int>(chunks.extent(0)) && chunks(chunk, 0) == k; ++chunk)
        mean.weight += means(chunk).weight, mean.sum += means(chunk).sum;
      relative(k) = mean.weight > 0.0 ? mean.sum / mean.weight : 0.0;
    }
    for (int axis = 0; axis < 3; ++axis) {
      const double c = views.column(axis) = change_of_velocity(axis);
      for (int k = 0; k < count; ++k) {
        if (!is_along(k, axis)) continue;
        views.impulse(k) = law_of(k).impermeable
                               ? (c - change_by_porous(axis, c)) / views.sheets(k).inverse_mass
                               : porous_impulse(law_of(k), relative(k) - c, dt, 0.0);
      }
      if (count > 0 && !(Kokkos::fabs(c) <= 1e100)) views.column(axis) = 0.0;
    }
  }
};

/// Sheets that close a channel, and so move all of its air at once: the mean motion of the air, whose inertia
/// is that of the whole channel and not that of the cells beside a sheet. The filtered acceleration, which
/// stands for the air farther away, would follow it only within some L / h steps.
///
/// In each step the mean impulse of each sheet follows in closed form from the porous law and the inertia of
/// the channel (`ForetellImpulsesFunctor`). What it changes at a vertex besides the change that the vertex
/// makes by itself is then known in advance, and the filtered acceleration is that of the rest. Uniform flow
/// thus obeys the law in every step, by the backward Euler method; other motions have their local masses.
///
/// Allocates in its constructor alone; all else is asynchronous on the given instance.
template <class ExecutionSpace>
class ClosingSheets {
 public:
  using Memory = typename ExecutionSpace::memory_space;
  using Views = ClosingSheetViews<ExecutionSpace>;

  /// `law`: of the vertices; `corners`: of the triangles whose velocities are averaged, or none for those of
  /// the vertices. Blocks. Throws std::invalid_argument for sheets out of range.
  ClosingSheets(const ExecutionSpace& space, const std::vector<ClosingSheet>& sheets,
                const Kokkos::View<PorousLaw*, Memory>& law, std::span<const std::array<int, 3>> corners)
      : _views{.sheets =
                   Kokkos::View<ClosingSheet*, Memory>("drogue::coupling::closing_sheets", sheets.size()),
               .law = law,
               .sheet_of = Kokkos::View<int*, Memory>("drogue::coupling::closing_sheet_of",
                                                      sheets.empty() ? 0 : law.extent(0)),
               .impulse = Kokkos::View<double*, Memory>("drogue::coupling::closing_impulse", sheets.size()),
               .column = Kokkos::View<double[3], Memory>("drogue::coupling::closing_column")},
        _relative("drogue::coupling::closing_velocity", sheets.size()) {
    if (sheets.empty()) return;
    const auto host_sheets = Kokkos::create_mirror_view(_views.sheets);
    const auto sheet_of = Kokkos::create_mirror_view(_views.sheet_of);
    Kokkos::deep_copy(sheet_of, -1);
    std::vector<std::array<int, 3>> chunks;
    for (std::size_t k = 0; k < sheets.size(); ++k) {
      const ClosingSheet& sheet = sheets[k];
      if (sheet.axis < 0 || sheet.axis > 2 || sheet.begin < 0 || sheet.begin >= sheet.end ||
          sheet.end > static_cast<int>(law.extent(0)) || !(sheet.inverse_mass >= 0.0))
        throw std::invalid_argument("immersed sheet: a closing sheet is out of range");
      host_sheets(k) = sheet;
      for (int i = sheet.begin; i < sheet.end; ++i) sheet_of(i) = static_cast<int>(k);
      int first = sheet.begin, last = sheet.end;
      if (!corners.empty()) {
        const auto is_of_sheet = [&](const auto& of) { return of[0] >= sheet.begin && of[0] < sheet.end; };
        const auto at = std::ranges::find_if(corners, is_of_sheet);
        first = static_cast<int>(at - corners.begin());
        last = static_cast<int>(std::find_if_not(at, corners.end(), is_of_sheet) - corners.begin());
      }
      constexpr int chunk = 64;
      for (int i = first; i < last; i += chunk)
        chunks.push_back({static_cast<int>(k), i, std::min(i + chunk, last)});
    }
    _chunks = Kokkos::View<int* [3], Memory>("drogue::coupling::closing_chunks", chunks.size());
    _means = Kokkos::View<ClosingMean*, Memory>("drogue::coupling::closing_means", chunks.size());
    const auto host_chunks = Kokkos::create_mirror_view(_chunks);
    for (std::size_t i = 0; i < chunks.size(); ++i)
      for (std::size_t j = 0; j < 3; ++j) host_chunks(i, j) = chunks[i][j];
    Kokkos::deep_copy(space, _views.sheets, host_sheets);
    Kokkos::deep_copy(space, _views.sheet_of, sheet_of);
    Kokkos::deep_copy(space, _chunks, host_chunks);
    space.fence("drogue::coupling::closing_sheets");
  }

  [[nodiscard]] bool empty() const { return _views.sheets.extent(0) == 0; }
  [[nodiscard]] const Views& views() const { return _views; }

  /// Enqueues the impulses of a step of dt, s, from the velocities of the sheets relative to the air at the
  /// end of the step without their forces. Throws only after a failed kernel.
  template <class Velocity>
  void foretell(const ExecutionSpace& space, const Velocity& velocity, double dt) const {
    device::launch_each(
        space, "drogue::coupling::add_closing_chunks", static_cast<int>(_chunks.extent(0)),
        AddClosingChunksFunctor<ExecutionSpace, Velocity>{velocity, _views.sheets, _chunks, _means});
    device::launch_each(
        space, "drogue::coupling::foretell_impulses", 1,
        ForetellImpulsesFunctor<ExecutionSpace>{
            .views = _views, .chunks = _chunks, .means = _means, .relative = _relative, .dt = dt});
  }

 private:
  Views _views;
  Kokkos::View<double*, Memory> _relative;
  Kokkos::View<int* [3], Memory> _chunks;
  Kokkos::View<ClosingMean*, Memory> _means;
};

}  // namespace drogue::coupling
