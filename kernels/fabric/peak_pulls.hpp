#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <vector>

#include "kernels/device/launch.hpp"
#include "kernels/device/portable_math.hpp"
#include "kernels/fabric/results.hpp"
#include "kernels/fabric/state.hpp"
#include "kernels/fabric/views.hpp"
#include "kernels/mesh/edges.hpp"
#include "kernels/spatial/points.hpp"
#include "kernels/stepping/step_monitor.hpp"

namespace drogue::fabric {

/// Lines that pull on common vertices, one pull after the other, and the peaks.
template <class ExecutionSpace>
struct PullViews {
  ListView<ExecutionSpace, int> first;                 ///< lines of pull k: first(k) to first(k + 1) - 1
  ListView<ExecutionSpace, int> pulled, from;          ///< vertices of each line
  ListView<ExecutionSpace, double> stiffness, length;  ///< E A, N; without tension, m
  PointsView<ExecutionSpace> force;                    ///< of each line on its vertex, N
  ListView<ExecutionSpace, PeakPull> peak;             ///< of each pull
};

/// Force of a line at the present positions.
template <class ExecutionSpace>
struct PullOfLineFunctor {
  PullViews<ExecutionSpace> pulls;
  PointsView<ExecutionSpace> x;

  KOKKOS_FUNCTION void operator()(const int line) const {
    const spatial::Point along =
        spatial::load_vector(x, pulls.from(line)) - spatial::load_vector(x, pulls.pulled(line));
    const double length = device::square_root(dot(along, along)),
                 tension = pulls.stiffness(line) * (length / pulls.length(line) - 1.0);
    spatial::store_vector(pulls.force, line,
                          tension > 0.0 ? (tension / length) * along : spatial::Point{0.0, 0.0, 0.0});
  }
};

/// Compares the present force of pull k with its peak. `step_time(time)` sets the time of the state, s;
/// false: the state is not that of a completed step.
template <class ExecutionSpace, class StepTime>
struct RecordPullsFunctor {
  PullViews<ExecutionSpace> pulls;
  StepTime step_time;

  KOKKOS_FUNCTION void operator()(const int k) const {
    double time = 0.0;
    if (!step_time(time)) return;
    spatial::Point sum{0.0, 0.0, 0.0};
    for (int line = pulls.first(k); line < pulls.first(k + 1); ++line)
      sum = sum + spatial::load_vector(pulls.force, line);
    const double force = device::square_root(dot(sum, sum));
    if (force > pulls.peak(k).force) pulls.peak(k) = {force, time};
  }
};

/// Time of the steps of a fabric solver, which refuses those after a failure.
template <class ExecutionSpace>
struct CompletedStep {
  stepping::StageTime<ExecutionSpace> now;

  KOKKOS_FUNCTION bool operator()(double& time) const {
    time = now.time();
    return !now.monitor.has_failed();
  }
};

/// Largest forces of lines without compression on vertices, over the steps that are recorded: no step visits
/// the host.
template <class ExecutionSpace>
class PeakPulls {
 public:
  PeakPulls() = default;

  /// Pulls of lines of `mesh`, whose E A is `stiffness`, N. The peaks are zero. Blocks. Throws
  /// std::invalid_argument for a line that the mesh lacks or that does not end at the vertex.
  PeakPulls(const ExecutionSpace& space, const Mesh& mesh, std::span<const double> stiffness,
            std::span<const Pull> pulls) {
    std::vector<int> first = {0}, pulled, from;
    std::vector<double> length;
    for (const Pull& pull : pulls) {
      for (const int line : pull.lines) {
        if (line < 0 || static_cast<std::size_t>(line) >= mesh.lines.size())
          throw std::invalid_argument("pulls: the mesh lacks a line");
        const auto [a, b] = mesh.lines[static_cast<std::size_t>(line)];
        if (a != pull.vertex && b != pull.vertex)
          throw std::invalid_argument("pulls: a line does not end at the vertex that it pulls");
        pulled.push_back(pull.vertex);
        from.push_back(a == pull.vertex ? b : a);
        length.push_back(mesh::rest_length(mesh, static_cast<std::size_t>(line)));
        _lines.push_back(line);
      }
      first.push_back(static_cast<int>(pulled.size()));
    }
    const std::vector<PeakPull> none(pulls.size());
    _views = {.first = list_view(space, "drogue::fabric::first_line", first),
              .pulled = list_view(space, "drogue::fabric::pulled_vertices", pulled),
              .from = list_view(space, "drogue::fabric::pulling_vertices", from),
              .stiffness = list_view(space, "drogue::fabric::pulling_stiffness", length),
              .length = list_view(space, "drogue::fabric::pulling_length", length),
              .force = PointsView<ExecutionSpace>("drogue::fabric::pulls_of_lines", _lines.size()),
              .peak = list_view(space, "drogue::fabric::peak_pulls", none)};
    _pulls = pulls.size();
    set_stiffness(space, stiffness);
  }

  /// Number of pulls. Does not throw.
  [[nodiscard]] std::size_t size() const { return _pulls; }

  /// Sets E A of every line of the mesh, N. Blocks. Throws only after a failed kernel.
  void set_stiffness(const ExecutionSpace& space, std::span<const double> of_lines) const {
    if (_lines.empty()) return;
    std::vector<double> values;
    for (const int line : _lines) values.push_back(of_lines[static_cast<std::size_t>(line)]);
    write(space, std::span<const double>(values), _views.stiffness);
  }

  /// Enqueues the comparison of the forces at positions, m, with the peaks. Allocates nothing. Throws only if
  /// the launch fails.
  template <class StepTime>
  void record(const ExecutionSpace& space, const PointsView<ExecutionSpace>& positions,
              const StepTime& step_time) const {
    if (_lines.empty()) return;
    device::launch_each(space, "drogue::fabric::pulls_of_lines", static_cast<int>(_lines.size()),
                        PullOfLineFunctor<ExecutionSpace>{_views, positions});
    device::launch_each(space, "drogue::fabric::record_pulls", static_cast<int>(_pulls),
                        RecordPullsFunctor<ExecutionSpace, StepTime>{_views, step_time});
  }

  /// Peaks so far, N and s, on the device. Does not throw.
  [[nodiscard]] const ListView<ExecutionSpace, PeakPull>& present() const { return _views.peak; }

  /// Peaks so far. Blocks. Throws only after a failed kernel.
  [[nodiscard]] std::vector<PeakPull> peaks(const ExecutionSpace& space) const {
    std::vector<PeakPull> result(_pulls);
    if (_pulls == 0) return result;
    const auto mirror = Kokkos::create_mirror_view(_views.peak);
    device::copy(space, mirror, _views.peak);
    space.fence("drogue::fabric::peaks");
    for (std::size_t k = 0; k < _pulls; ++k) result[k] = mirror(k);
    return result;
  }

  /// Sets the peaks to zero. Blocks. Throws only after a failed kernel.
  void reset(const ExecutionSpace& space) const {
    const std::vector<PeakPull> none(_pulls);
    write(space, std::span<const PeakPull>(none), _views.peak);
  }

 private:
  template <class T>
  static void write(const ExecutionSpace& space, std::span<const T> from,
                    const ListView<ExecutionSpace, T>& to) {
    if (from.empty()) return;
    const auto mirror = Kokkos::create_mirror_view(to);
    for (std::size_t k = 0; k < from.size(); ++k) mirror(k) = from[k];
    device::copy(space, to, mirror);
    space.fence("drogue::fabric::peak_pulls");
  }

  PullViews<ExecutionSpace> _views;
  std::vector<int> _lines;
  std::size_t _pulls = 0;
};

}  // namespace drogue::fabric
