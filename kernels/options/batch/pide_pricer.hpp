#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/device/instance.hpp"
#include "kernels/device/pinned_memory.hpp"
#include "kernels/device/stopwatch.hpp"
#include "kernels/options/baseline/baseline_batch.hpp"
#include "kernels/options/batch/price_functors.hpp"
#include "kernels/options/batch/refinement.hpp"
#include "kernels/options/levy/hankel_panels.hpp"
#include "kernels/options/transforms/fourier_roots.hpp"

namespace drogue::options {

/// Finite-difference pricer on the caller's instance of an execution space, which must outlive it. Contracts
/// come from host memory, since tables of their jump measures are computed there. Functions that `Pricer`
/// declares are documented in `Pricer`.
template <class ExecutionSpace>
class PidePricer {
  using Space = typename ExecutionSpace::memory_space;
  template <class T>
  using View = Kokkos::View<T*, Space>;

 public:
  /// Allocates nothing. Does not throw.
  PidePricer(const device::Instance<ExecutionSpace>& instance, const Settings& settings)
      : _settings(settings), _instance(instance) {}

  WallTimes price(std::span<const Contract> contracts, std::span<Price> prices) {
    if (contracts.size() != prices.size())
      throw std::invalid_argument("options pricer: as many prices as contracts are needed");
    if (_settings.method == Method::baseline)
      for (const Contract& contract : contracts)
        if (contract.model != JumpModel::generalized_hyperbolic)
          throw std::invalid_argument(
              "options pricer: method seed, the scheme of [Shi], prices generalized hyperbolic jumps only");
    WallTimes times;
    if (contracts.empty()) return times;
    const device::Stopwatch total;
    try {
      price_all(contracts, prices, times);
    } catch (...) {  // enqueued work may access memory of the caller
      _instance.space().fence("drogue::options: batch is abandoned");
      throw;
    }
    if (!_settings.time_copies) times = {0.0, total.seconds(), 0.0};
    return times;
  }

  std::pmr::memory_resource& memory() { return _pinned; }

  std::vector<BoundaryPoint> boundary(const Contract& contract, int mesh, int steps) {
    const RecordedSolve recorded =
        record(contract, mesh != 0 ? Resolution{mesh, steps} : recorded_resolution());
    std::vector<BoundaryPoint> points;
    for (std::size_t k = recorded.time.size(); k-- > 0;)
      if (std::isfinite(recorded.boundary[k]))
        points.push_back({contract.maturity - recorded.time[k], spot_at(contract, recorded.boundary[k])});
    return points;
  }

  std::vector<ProfilePoint> profile(const Contract& contract) {
    const RecordedSolve recorded = record(contract, recorded_resolution());
    std::vector<ProfilePoint> points;
    for (std::size_t k = 0; k < recorded.x.size(); ++k) {
      const double spot = spot_at(contract, recorded.x[k]);
      points.push_back({spot, recorded.value[k] * (contract.type == Type::call ? spot : contract.strike)});
    }
    if (contract.type == Type::call) std::reverse(points.begin(), points.end());
    return points;
  }

 private:
  /// Views of a launch, in the memory of the backend or in pinned memory of the host.
  struct BatchViews {
    Kokkos::View<const Contract*, Space> contracts;
    View<Price> prices;
  };

  void price_to_tolerance(std::span<const Contract> contracts, std::span<Price> prices, WallTimes& times) {
    const Resolution first{first_mesh, steps_of(first_mesh)};
    std::vector<Refinement> rows(contracts.size(), Refinement{first});
    for (std::optional<Resolution> resolution = first; resolution; resolution = lowest_resolution(rows)) {
      const device::Stopwatch computing;
      launch_models({_contracts, _prices}, contracts, *resolution,
                    [&](std::size_t k) { return rows[k].next == *resolution; });
      times.compute += computing.seconds();
      copy_out(prices, times);
      for (std::size_t k = 0; k < contracts.size(); ++k)
        if (rows[k].next == *resolution)
          refine(rows[k], prices[k], _settings.tolerance * contracts[k].strike, _settings);
    }
  }

  void price_all(std::span<const Contract> contracts, std::span<Price> prices, WallTimes& times) {
    const int mesh =
        _settings.mesh == 0 && _settings.method == Method::baseline ? baseline_mesh : _settings.mesh;
    reserve(contracts.size());
    if (mesh != 0 && is_priced_in_place(contracts.size()))
      return price_in_place(contracts, prices, {mesh, steps_of(mesh)});
    const device::Stopwatch copying_in;
    device::copy_in(_instance.space(), _contracts, staging_buffer(contracts), contracts.size());
    if (_settings.time_copies) _instance.space().fence("drogue::options: contracts are copied");
    times.h2d = copying_in.seconds();
    if (mesh == 0) return price_to_tolerance(contracts, prices, times);
    const device::Stopwatch computing;
    launch_all({_contracts, _prices}, contracts, {mesh, steps_of(mesh)});
    times.compute = computing.seconds();
    copy_out(prices, times);
  }

  /// Whether a batch is so small that direct access of the device to pinned host memory is faster than two
  /// copies.
  [[nodiscard]] bool is_priced_in_place(std::size_t count) const {
    return !device::is_host<ExecutionSpace> && !_settings.time_copies && count <= 64;
  }

  void price_in_place(std::span<const Contract> contracts, std::span<Price> prices,
                      const Resolution& resolution) {
    Price* const to = landing_buffer(prices);
    launch_all({Kokkos::View<const Contract*, Space>(staging_buffer(contracts), contracts.size()),
                View<Price>(to, prices.size())},
               contracts, resolution);
    wait_for_prices(to, prices);
  }

  void launch_all(const BatchViews& views, std::span<const Contract> contracts,
                  const Resolution& resolution) {
    launch_models(views, contracts, resolution, [](std::size_t) { return true; });
  }

  static constexpr int first_mesh = 64, baseline_mesh = 128, record_mesh = 512, models = 4;
  /// Contracts per launch; the host gathers them while a device processes the previous launch.
  static constexpr std::size_t launch_capacity = 1 << 17;

  struct RecordedSolve {
    std::vector<double> time, boundary, x, value;
  };

  /// Spot at ln(spot/strike) = x of the put as which a contract is solved.
  [[nodiscard]] static double spot_at(const Contract& contract, double x) {
    return contract.strike * std::exp(contract.type == Type::call ? -x : x);
  }

  /// Solves one contract and copies the recorded arrays to the host.
  RecordedSolve record(const Contract& contract, const Resolution& resolution) {
    const std::span<const Contract> one(&contract, 1);
    reserve(1);
    _panels.build(one);
    device::copy_in(_instance.space(), _contracts, &contract, 1);
    const auto steps = static_cast<std::size_t>(resolution.steps),
               nodes = static_cast<std::size_t>(resolution.mesh) + 1;
    const View<double> all("drogue::options::record", 2 * (steps + nodes));
    double* const at = all.data();
    constexpr int first[] = {0};
    launch({_contracts, _prices}, first, contract.model, 0, resolution,
           {at, at + steps, at + 2 * steps, at + 2 * steps + nodes});
    std::vector<double> values(all.size());
    device::copy_out(_instance.space(), values.data(), all, values.size());
    _instance.space().fence("drogue::options: record is copied");
    auto part = [begin = values.cbegin()](std::size_t count) mutable {
      const auto end = begin + static_cast<std::ptrdiff_t>(count);
      return std::vector<double>(std::exchange(begin, end), end);
    };
    RecordedSolve recorded;
    recorded.time = part(steps);
    recorded.boundary = part(steps);
    recorded.x = part(nodes);
    recorded.value = part(nodes);
    return recorded;
  }

  [[nodiscard]] Resolution recorded_resolution() const {
    const int mesh = _settings.mesh != 0 ? _settings.mesh : record_mesh;
    return {mesh, steps_of(mesh)};
  }

  [[nodiscard]] int steps_of(int mesh) const {
    return _settings.method == Method::baseline && _settings.steps == 0
               ? mesh
               : options::steps_of(_settings, mesh, 1);
  }

  void reserve(std::size_t count) {
    if (_contracts.size() >= count) return;
    _prices = View<Price>(Kokkos::view_alloc("drogue::options::prices", Kokkos::WithoutInitializing), count);
    _order = View<int>(Kokkos::view_alloc("drogue::options::order", Kokkos::WithoutInitializing), count);
    _host_order.assign(count, -1);
    // Last, since its size is the capacity that `reserve` checks.
    _contracts =
        View<Contract>(Kokkos::view_alloc("drogue::options::contracts", Kokkos::WithoutInitializing), count);
  }

  /// Contracts in memory from which a device copies directly: those of the caller, or a pinned copy.
  const Contract* staging_buffer(std::span<const Contract> contracts) {
    if (device::is_host<ExecutionSpace> || _pinned.holds(contracts.data())) return contracts.data();
    _staged_contracts.resize(contracts.size());
    std::ranges::copy(contracts, _staged_contracts.begin());
    return _staged_contracts.data();
  }

  /// Memory to which a device copies prices directly: that of the caller, or a pinned buffer.
  Price* landing_buffer(std::span<Price> prices) {
    if (device::is_host<ExecutionSpace> || _pinned.holds(prices.data())) return prices.data();
    _staged_prices.resize(prices.size());
    return _staged_prices.data();
  }

  /// Waits for prices in `landed`, a result of `landing_buffer`, and copies them to `prices` if necessary.
  void wait_for_prices(const Price* landed, std::span<Price> prices) {
    _instance.space().fence("drogue::options: prices are copied");
    if (landed != prices.data()) std::copy_n(landed, prices.size(), prices.begin());
  }

  void copy_out(std::span<Price> prices, WallTimes& times) {
    const device::Stopwatch copying;
    Price* const to = landing_buffer(prices);
    device::copy_out(_instance.space(), to, _prices, prices.size());
    wait_for_prices(to, prices);
    times.d2h += copying.seconds();
  }

  /// Enqueues the launches for the contracts k with `is_selected(k)`, one per model and `launch_capacity`
  /// contracts.
  template <class Selection>
  void launch_models(const BatchViews& views, std::span<const Contract> contracts,
                     const Resolution& resolution, const Selection& is_selected) {
    std::vector<int> rows[models];
    std::size_t first = 0, gathered = 0;
    const auto launch_gathered = [&] {
      for (int model = 0; model < models; ++model) {
        std::vector<int>& of_model = rows[model];
        launch(views, of_model, static_cast<JumpModel>(model), first, resolution, MarchRecord{});
        first += of_model.size();
        of_model.clear();
      }
      gathered = 0;
    };
    rows[static_cast<std::size_t>(contracts.front().model)].reserve(
        std::min(launch_capacity, contracts.size()));
    for (std::size_t k = 0; k < contracts.size(); ++k) {
      if (!is_selected(k)) continue;
      _panels.build(contracts.subspan(k, 1));
      rows[static_cast<std::size_t>(contracts[k].model)].push_back(static_cast<int>(k));
      if (++gathered == launch_capacity) launch_gathered();
    }
    launch_gathered();
    if (_settings.time_copies) _instance.space().fence("drogue::options: priced");
  }

  /// Enqueues the launch for `rows`, which are stored from `first` on in the order.
  void launch(const BatchViews& views, std::span<const int> rows, JumpModel model, std::size_t first,
              const Resolution& resolution, const MarchRecord& record) {
    if (rows.empty()) return;
    const auto order = Kokkos::subview(_order, std::pair(first, first + rows.size()));
    int* const host_order = _host_order.data() + first;
    if (!std::equal(rows.begin(), rows.end(), host_order)) {
      std::ranges::copy(rows, host_order);
      device::copy_in(_instance.space(), order, host_order, rows.size());
    }
    _panels.copy_in(_instance.space());
    PriceBatch<ExecutionSpace> batch;
    batch.contracts = views.contracts;
    batch.prices = views.prices;
    batch.order = order;
    batch.panels = _panels.series();
    batch.panel_slot = _panels.slots();
    batch.roots = _roots.for_mesh(_instance.space(), resolution.mesh);
    batch.record = record;
    batch.model = model;
    batch.count = static_cast<int>(rows.size());
    batch.mesh = resolution.mesh;
    batch.steps = resolution.steps;
    batch.tolerance = tolerance_of(_settings);
    batch.split = _settings.exercise == ExerciseRule::split;
    batch.single_grid = _settings.single_grid;
    batch.level = scratch_level<ExecutionSpace>(resolution.mesh);
    if (_settings.method == Method::baseline && record.time == nullptr) {
      price_baseline(_instance.space(), batch);
    } else {
      price_batch(_instance.space(), batch);
    }
  }

  Settings _settings;
  const device::Instance<ExecutionSpace>& _instance;
  View<Contract> _contracts;
  View<Price> _prices;
  View<int> _order;
  device::PinnedMemory<ExecutionSpace> _pinned;
  std::pmr::vector<int> _host_order{&_pinned};  ///< contents of _order
  std::pmr::vector<Contract> _staged_contracts{&_pinned};
  std::pmr::vector<Price> _staged_prices{&_pinned};
  HankelPanels<ExecutionSpace> _panels;
  FourierRootsTable<ExecutionSpace> _roots;
};

DROGUE_EXTERN_INSTANCES(class PidePricer)

}  // namespace drogue::options
