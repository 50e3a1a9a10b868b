#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "kernels/device/captured_graph.hpp"
#include "kernels/device/copy.hpp"
#include "kernels/device/instance.hpp"
#include "perf/raw/kernel_pair.hpp"

namespace drogue::perf::raw {

/// Launches and comparison of a pair. A derived class enqueues steps, and reads results to the host.
class CudaPair : public KernelPair {
 public:
  void run(Version version, Launches launches, long count) override {
    if (launches == Launches::graph) {
      const device::CapturedGraph<Kokkos::Cuda>& graph = captured(version);
      for (long k = 0; k < count; k += graph_steps) graph.launch();
    } else {
      for (long k = 0; k < count; ++k) enqueue(version);
    }
    _instance.space().fence("drogue::perf::raw: steps done");
  }

  [[nodiscard]] double difference(Launches launches) override {
    Results results[2];
    for (const Version version : {Version::kokkos, Version::hand_written}) {
      reset(version);
      const Results before = read(version);
      run(version, launches, graph_steps);
      results[static_cast<int>(version)] = read(version);
      if (!(largest_difference(before, results[static_cast<int>(version)]) > 0.0)) return infinite;
    }
    return largest_difference(results[0], results[1]);
  }

 protected:
  /// Arrays of numbers; those of one unit share a scale.
  using Results = std::vector<std::vector<double>>;

  [[nodiscard]] const device::Instance<Kokkos::Cuda>& instance() const { return _instance; }
  [[nodiscard]] const Kokkos::Cuda& space() const { return _instance.space(); }

  virtual void enqueue(Version version) = 0;
  [[nodiscard]] virtual Results read(Version version) = 0;

  /// Copy of a View on the host. Blocking.
  template <class View>
  [[nodiscard]] std::vector<double> to_host(const View& view, std::size_t count) const {
    std::vector<double> values(count);
    device::copy_out(space(), values.data(), view, count);
    _instance.space().fence("drogue::perf::raw: read");
    return values;
  }
  /// Copies values or one structure to a View. Blocking.
  template <class View>
  void to_device(const View& view, const typename View::value_type* from, std::size_t count) const {
    device::copy_in(space(), view, from, count);
    _instance.space().fence("drogue::perf::raw: written");
  }

 private:
  static constexpr double infinite = std::numeric_limits<double>::infinity();

  static double largest_difference(const Results& a, const Results& b) {
    double worst = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k) {
      double scale = 0.0, difference = 0.0;
      for (std::size_t i = 0; i < a[k].size(); ++i) {
        if (!std::isfinite(a[k][i]) || !std::isfinite(b[k][i])) return infinite;
        scale = std::max(scale, std::abs(a[k][i]));
        scale = std::max(scale, std::abs(b[k][i]));
        difference = std::max(difference, std::abs(a[k][i] - b[k][i]));
      }
      if (difference > 0.0) worst = std::max(worst, difference / scale);
    }
    return worst;
  }

  const device::CapturedGraph<Kokkos::Cuda>& captured(Version version) {
    std::unique_ptr<device::CapturedGraph<Kokkos::Cuda>>& graph = _graph[version];
    if (!graph)
      graph = std::make_unique<device::CapturedGraph<Kokkos::Cuda>>(_instance, [&](const Kokkos::Cuda&) {
        for (long k = 0; k < graph_steps; ++k) enqueue(version);
      });
    return *graph;
  }

  device::Instance<Kokkos::Cuda> _instance{1};
  std::map<Version, std::unique_ptr<device::CapturedGraph<Kokkos::Cuda>>> _graph;
};

}  // namespace drogue::perf::raw
