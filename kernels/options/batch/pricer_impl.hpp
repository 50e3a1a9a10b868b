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
#include "kernels/options/baseline/baseline_batch.hpp"
#include "kernels/options/batch/price_functors.hpp"
#include "kernels/options/batch/refinement.hpp"
#include "kernels/options/batch/stopwatch.hpp"
#include "kernels/options/levy/hankel_panels.hpp"
#include "kernels/options/transforms/roots_of_unity.hpp"

namespace drogue::options {

/// The pricer on `ExecutionSpace`.
template <class ExecutionSpace>
class PricerImpl final : public Pricer {
  using Space = typename ExecutionSpace::memory_space;
  template <class T>
  using View = Kokkos::View<T*, Space>;

 public:
  explicit PricerImpl(const Settings& settings) : _settings(settings), _instance(1 << 20) {}

  WallTimes price(std::span<const Contract> contracts, std::span<Price> prices) override {
    if (contracts.size() != prices.size())
      throw std::invalid_argument("options pricer: as many prices as contracts are needed");
    if (_settings.method == Method::baseline)
      for (const Contract& contract : contracts)
        if (contract.model != Model::generalized_hyperbolic)
          throw std::invalid_argument(
              "options pricer: the dissertation's scheme has generalized hyperbolic jumps");
    WallTimes timing;
    if (contracts.empty()) return timing;
    const Stopwatch all;
    try {
      price_all(contracts, prices, timing);
    } catch (...) {  // what is under way may read and write memory of the caller's
      _instance.space().fence("drogue::options: a batch is given up");
      throw;
    }
    if (!_settings.time_copies) timing = {0.0, all.seconds(), 0.0};
    return timing;
  }

  std::pmr::memory_resource& memory() override { return _pinned; }

  std::vector<BoundaryPoint> boundary_on(const Contract& contract, int mesh, int steps) override {
    const Recorded all = record(contract, mesh != 0 ? Resolution{mesh, steps} : recorded_effort());
    std::vector<BoundaryPoint> points;
    for (std::size_t k = all.time.size(); k-- > 0;)
      if (std::isfinite(all.boundary[k]))
        points.push_back({contract.maturity - all.time[k], spot_at(contract, all.boundary[k])});
    return points;
  }

  std::vector<ProfilePoint> profile(const Contract& contract) override {
    const Recorded all = record(contract, recorded_effort());
    std::vector<ProfilePoint> points;
    for (std::size_t k = 0; k < all.x.size(); ++k) {
      const double spot = spot_at(contract, all.x[k]);
      points.push_back({spot, all.value[k] * (contract.type == Type::call ? spot : contract.strike)});
    }
    if (contract.type == Type::call) std::reverse(points.begin(), points.end());
    return points;
  }

 private:
  /// What launches read and write, in the memory of the backend or in page-locked memory of the host.
  struct Places {
    Kokkos::View<const Contract*, Space> contracts;
    View<Price> prices;
  };

  void price_to_tolerance(std::span<const Contract> contracts, std::span<Price> prices, WallTimes& timing) {
    const Resolution first{first_mesh, steps_of(first_mesh)};
    std::vector<Refinement> rows(contracts.size(), Refinement{first});
    for (std::optional<Resolution> effort = first; effort; effort = least_effort(rows)) {
      const Stopwatch computing;
      launch_models({_contracts, _prices}, contracts, *effort,
                    [&](std::size_t k) { return rows[k].next == *effort; });
      timing.compute += computing.seconds();
      copy_out(prices, timing);
      for (std::size_t k = 0; k < contracts.size(); ++k)
        if (rows[k].next == *effort)
          refine(rows[k], prices[k], _settings.tolerance * contracts[k].strike, _settings);
    }
  }

  void price_all(std::span<const Contract> contracts, std::span<Price> prices, WallTimes& timing) {
    const int mesh = _settings.mesh == 0 && _settings.method == Method::baseline ? seed_mesh : _settings.mesh;
    reserve(contracts.size());
    if (mesh != 0 && is_priced_in_place(contracts.size()))
      return price_in_place(contracts, prices, {mesh, steps_of(mesh)});
    const Stopwatch copying_in;
    device::copy_in(_instance.space(), _contracts, staged(contracts), contracts.size());
    if (_settings.time_copies) _instance.space().fence("drogue::options: contracts are copied");
    timing.h2d = copying_in.seconds();
    if (mesh == 0) return price_to_tolerance(contracts, prices, timing);
    const Stopwatch computing;
    launch_all({_contracts, _prices}, contracts, {mesh, steps_of(mesh)});
    timing.compute = computing.seconds();
    copy_out(prices, timing);
  }

  /// Whether contracts are so few that a device rather reads and writes them in the host's memory than waits
  /// for two copies.
  [[nodiscard]] bool is_priced_in_place(std::size_t count) const {
    return !device::is_host<ExecutionSpace> && !_settings.time_copies && count <= 64;
  }

  void price_in_place(std::span<const Contract> contracts, std::span<Price> prices,
                      const Resolution& effort) {
    Price* const to = landing(prices);
    launch_all({Kokkos::View<const Contract*, Space>(staged(contracts), contracts.size()),
                View<Price>(to, prices.size())},
               contracts, effort);
    await(to, prices);
  }

  void launch_all(const Places& places, std::span<const Contract> contracts, const Resolution& effort) {
    launch_models(places, contracts, effort, [](std::size_t) { return true; });
  }

  static constexpr int first_mesh = 64, seed_mesh = 128, record_mesh = 512, models = 4;
  /// Contracts that the host gathers for its next launches, while a device is busy with those before.
  static constexpr std::size_t slab = 1 << 17;

  struct Recorded {
    std::vector<double> time, boundary, x, value;
  };

  /// The spot at ln(spot/strike) = x of the put that a contract is solved as.
  [[nodiscard]] static double spot_at(const Contract& contract, double x) {
    return contract.strike * std::exp(contract.type == Type::call ? -x : x);
  }

  /// Solves one contract and brings what a solve leaves to the host.
  Recorded record(const Contract& contract, const Resolution& effort) {
    const std::span<const Contract> one(&contract, 1);
    reserve(1);
    _panels.build(one);
    device::copy_in(_instance.space(), _contracts, &contract, 1);
    const auto steps = static_cast<std::size_t>(effort.steps),
               nodes = static_cast<std::size_t>(effort.mesh) + 1;
    const View<double> all("drogue::options::record", 2 * (steps + nodes));
    double* const at = all.data();
    constexpr int first[] = {0};
    launch({_contracts, _prices}, first, contract.model, 0, effort,
           {at, at + steps, at + 2 * steps, at + 2 * steps + nodes});
    std::vector<double> values(all.size());
    device::copy_out(_instance.space(), values.data(), all, values.size());
    _instance.space().fence("drogue::options: record is there");
    auto part = [begin = values.cbegin()](std::size_t count) mutable {
      const auto end = begin + static_cast<std::ptrdiff_t>(count);
      return std::vector<double>(std::exchange(begin, end), end);
    };
    Recorded recorded;
    recorded.time = part(steps);
    recorded.boundary = part(steps);
    recorded.x = part(nodes);
    recorded.value = part(nodes);
    return recorded;
  }

  [[nodiscard]] Resolution recorded_effort() const {
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
    _rows.assign(count, -1);
    // Last, since it tells that there is room.
    _contracts =
        View<Contract>(Kokkos::view_alloc("drogue::options::contracts", Kokkos::WithoutInitializing), count);
  }

  /// The contracts where a device copies them from without a detour.
  const Contract* staged(std::span<const Contract> contracts) {
    if (device::is_host<ExecutionSpace> || _pinned.holds(contracts.data())) return contracts.data();
    _staged_contracts.resize(contracts.size());
    std::ranges::copy(contracts, _staged_contracts.begin());
    return _staged_contracts.data();
  }

  /// Where prices arrive from a device without a detour.
  Price* landing(std::span<Price> prices) {
    if (device::is_host<ExecutionSpace> || _pinned.holds(prices.data())) return prices.data();
    _staged_prices.resize(prices.size());
    return _staged_prices.data();
  }

  /// Waits for prices that arrive at `landed`, which `landing` has given.
  void await(const Price* landed, std::span<Price> prices) {
    _instance.space().fence("drogue::options: prices are there");
    if (landed != prices.data()) std::copy_n(landed, prices.size(), prices.begin());
  }

  void copy_out(std::span<Price> prices, WallTimes& timing) {
    const Stopwatch copying;
    Price* const to = landing(prices);
    device::copy_out(_instance.space(), to, _prices, prices.size());
    await(to, prices);
    timing.d2h += copying.seconds();
  }

  /// Prices the contracts k for which `asked(k)`, those of a model and a slab in a launch.
  template <class Asked>
  void launch_models(const Places& places, std::span<const Contract> contracts, const Resolution& effort,
                     const Asked& asked) {
    std::vector<int> rows[models];
    std::size_t place = 0, gathered = 0;
    const auto launch_gathered = [&] {
      for (int model = 0; model < models; ++model) {
        std::vector<int>& of_model = rows[model];
        launch(places, of_model, static_cast<Model>(model), place, effort, Record{});
        place += of_model.size();
        of_model.clear();
      }
      gathered = 0;
    };
    rows[static_cast<std::size_t>(contracts.front().model)].reserve(std::min(slab, contracts.size()));
    for (std::size_t k = 0; k < contracts.size(); ++k) {
      if (!asked(k)) continue;
      _panels.build(contracts.subspan(k, 1));
      rows[static_cast<std::size_t>(contracts[k].model)].push_back(static_cast<int>(k));
      if (++gathered == slab) launch_gathered();
    }
    launch_gathered();
    if (_settings.time_copies) _instance.space().fence("drogue::options: priced");
  }

  /// Enqueues the launch for `rows`, which are put at `place` of the order.
  void launch(const Places& places, std::span<const int> rows, Model model, std::size_t place,
              const Resolution& effort, const Record& record) {
    if (rows.empty()) return;
    const auto order = Kokkos::subview(_order, std::pair(place, place + rows.size()));
    int* const known = _rows.data() + place;
    if (!std::equal(rows.begin(), rows.end(), known)) {
      std::ranges::copy(rows, known);
      device::copy_in(_instance.space(), order, known, rows.size());
    }
    _panels.copy_in(_instance.space());
    PriceBatch<ExecutionSpace> batch;
    batch.contracts = places.contracts;
    batch.prices = places.prices;
    batch.order = order;
    batch.panels = _panels.series();
    batch.panel_slot = _panels.slots();
    batch.roots = _roots.of_mesh(_instance.space(), effort.mesh);
    batch.record = record;
    batch.model = model;
    batch.count = static_cast<int>(rows.size());
    batch.mesh = effort.mesh;
    batch.steps = effort.steps;
    batch.tolerance = _settings.tolerance;
    batch.split = _settings.exercise == ExerciseRule::split;
    batch.single_grid = _settings.single_grid;
    batch.level = scratch_level<ExecutionSpace>(effort.mesh);
    if (_settings.method == Method::baseline && record.time == nullptr) {
      seed_batch(_instance.space(), batch);
    } else {
      price_batch(_instance.space(), batch);
    }
  }

  Settings _settings;
  device::Instance<ExecutionSpace> _instance;
  View<Contract> _contracts;
  View<Price> _prices;
  View<int> _order;
  device::PinnedMemory<ExecutionSpace> _pinned;
  std::pmr::vector<int> _rows{&_pinned};  ///< what _order holds
  std::pmr::vector<Contract> _staged_contracts{&_pinned};
  std::pmr::vector<Price> _staged_prices{&_pinned};
  HankelPanels<ExecutionSpace> _panels;
  RootsOfUnity<ExecutionSpace> _roots;
};

template <class ExecutionSpace>
std::unique_ptr<Pricer> make_pide(const Settings& settings) {
  return std::make_unique<PricerImpl<ExecutionSpace>>(settings);
}

}  // namespace drogue::options
