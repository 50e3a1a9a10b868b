#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "kernels/device/captured_graph.hpp"
#include "kernels/device/persistent_kernel.hpp"
#include "kernels/stepping/driver.hpp"

namespace drogue::stepping {

/// Enqueues steps by the selected driver. A solver has up to `variants` kinds of step, each with a graph of
/// its own; the solver itself launches its persistent kernel.
template <class ExecutionSpace, int variants = 1>
class StepLauncher {
 public:
  static constexpr bool has_graph =
      std::string_view(device::CapturedGraph<ExecutionSpace>::driver) == "graph";

  /// True if the backend supports persistent kernels and `requested` permits one. The solver then decides
  /// whether its problem fits.
  static constexpr bool may_be_persistent(Driver requested) {
    return device::PersistentKernel<ExecutionSpace>::available &&
           select_driver(requested, true, has_graph) == Driver::persistent;
  }

  /// `instance` must outlive the launcher. Does not throw.
  StepLauncher(const device::Instance<ExecutionSpace>& instance, Driver requested)
      : _instance(&instance), _driver(select_driver(requested, false, has_graph)) {}

  /// Declares that the solver has set up its persistent kernel. Does not throw.
  void use_persistent() { _driver = Driver::persistent; }

  /// Selected driver. Does not throw.
  [[nodiscard]] Driver driver() const { return _driver; }
  [[nodiscard]] bool is_persistent() const { return _driver == Driver::persistent; }

  /// Enqueues one step. `enqueue(space)` launches its kernels; a graph driver captures them on the first call
  /// per variant and replays the graph, so that they must neither fence nor allocate. Asynchronous.
  /// Throws std::runtime_error if the capture or the launch fails.
  template <class Enqueue>
  void launch(int variant, const Enqueue& enqueue) {
    if (_driver == Driver::plain) return enqueue(_instance->space());
    auto& graph = _graphs[static_cast<std::size_t>(variant)];
    if (!graph)
      graph = std::make_unique<device::CapturedGraph<ExecutionSpace>>(
          *_instance, typename device::CapturedGraph<ExecutionSpace>::Enqueue(enqueue));
    graph->launch();
  }

  /// Discards the captured graphs. Required after a change of values that kernels hold by copy, such as dt.
  /// Does not throw.
  void discard_graphs() {
    for (auto& graph : _graphs) graph.reset();
  }

 private:
  const device::Instance<ExecutionSpace>* _instance;
  Driver _driver;
  std::array<std::unique_ptr<device::CapturedGraph<ExecutionSpace>>, variants> _graphs;
};

}  // namespace drogue::stepping
