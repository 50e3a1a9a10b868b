#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "kernels/device/copy.hpp"
#include "kernels/device/instance.hpp"
#include "kernels/device/pinned_memory.hpp"
#include "kernels/device/stopwatch.hpp"
#include "kernels/options/batch/refinement.hpp"
#include "kernels/options/levy/hankel_panels.hpp"
#include "kernels/options/surface/strike_group.hpp"
#include "kernels/options/surface/strike_range.hpp"
#include "kernels/options/transforms/fourier_roots.hpp"

namespace drogue::options {

/// Pricer whose contracts share solves. Consecutive contracts that differ only in the strike form runs, which
/// are divided into strike groups. The price of a strike does not depend on the other strikes:
/// docs/options-implementation.md, "Surfaces".
template <class ExecutionSpace>
class SurfaceImpl final : public Pricer {
  using Space = typename ExecutionSpace::memory_space;
  template <class T>
  using View = Kokkos::View<T*, Space>;
  template <class T>
  using Staged = std::pmr::vector<T>;

 public:
  /// `single` computes boundaries and profiles, which concern one contract.
  SurfaceImpl(const Settings& settings, std::unique_ptr<Pricer> single)
      : _settings(settings), _single(std::move(single)), _instance(1 << 20) {}

  WallTimes price(std::span<const Contract> contracts, std::span<Price> prices) override {
    if (contracts.size() != prices.size())
      throw std::invalid_argument("options pricer: as many prices as contracts are needed");
    WallTimes times;
    if (contracts.empty()) return times;
    const device::Stopwatch building;
    _panels.build(contracts);
    assign_strike_ranges(contracts);
    times.compute = building.seconds();
    const device::Stopwatch copying_in;
    _panels.copy_in(_instance.space());
    times.h2d = copying_in.seconds();
    const int mesh = _settings.mesh != 0 ? _settings.mesh : first_mesh;
    const Resolution first{mesh, steps_of(_settings, mesh, 1)};
    _rows.assign(contracts.size(), Refinement{first});
    for (std::optional<Resolution> resolution = first; resolution; resolution = lowest_resolution(_rows)) {
      for (std::size_t begin = 0; begin < contracts.size();) {
        begin = gather(contracts, *resolution, begin);
        price_gathered(*resolution, times);
        for (std::size_t k = 0; k < _query_contracts.size(); ++k)
          prices[_query_contracts[k]] = _staged_prices[k];
      }
      for (std::size_t k = 0; k < contracts.size(); ++k) {
        if (_rows[k].next != *resolution) continue;
        if (_settings.mesh != 0) {
          _rows[k].next = {};
        } else {
          refine(_rows[k], prices[k], _settings.tolerance * contracts[k].strike, _settings);
        }
      }
    }
    return times;
  }

  std::vector<BoundaryPoint> boundary(const Contract& contract, int mesh, int steps) override {
    return _single->boundary(contract, mesh, steps);
  }
  std::vector<ProfilePoint> profile(const Contract& contract) override { return _single->profile(contract); }

 private:
  static constexpr int first_mesh = 128, models = 4;
  static constexpr std::size_t max_values = std::size_t{1}
                                            << 23U;  ///< maximum number of node values in memory

  /// Run and range of strikes of a contract.
  struct Membership {
    int run;
    std::uint8_t range;
  };

  void assign_strike_ranges(std::span<const Contract> contracts) {
    _memberships.clear();
    _ranges.clear();
    for (std::size_t k = 0; k < contracts.size(); ++k) {
      if (k == 0 || !differ_only_in_strike(contracts[k - 1], contracts[k]))
        _ranges.emplace_back(deviation_of(contracts, k));
      _memberships.push_back({static_cast<int>(_ranges.size()) - 1,
                              _ranges.back().index_of(contracts[k].spot / contracts[k].strike)});
    }
  }

  double deviation_of(std::span<const Contract> contracts, std::size_t k) {
    const Contract& c = contracts[k];
    if (k == 0 || !have_same_process(contracts[k - 1], c))
      _variance = annual_variance(c, _panels.host_series().data(), _panels.host_slots().data());
    return std::sqrt(_variance * c.maturity);
  }

  /// Gathers the queries of contracts from `begin` on with this resolution, as far as the memory for strike
  /// groups suffices. Returns the first contract that is not gathered.
  std::size_t gather(std::span<const Contract> contracts, const Resolution& resolution, std::size_t begin) {
    const std::size_t capacity =
        std::max(max_values / StrikeGroupNodes::size(resolution.mesh), std::size_t{1});
    _staged_contracts.clear();
    _staged_ranges.clear();
    _staged_queries.clear();
    _query_contracts.clear();
    int run = -1;
    std::vector<int> group_at;  // per range of the run
    for (std::size_t k = begin; k < contracts.size(); ++k) {
      if (_rows[k].next != resolution) continue;
      if (_memberships[k].run != run) {
        run = _memberships[k].run;
        group_at.assign(StrikeRanges::count, -1);
      }
      int& strike_group = group_at[_memberships[k].range];
      if (strike_group < 0) {
        if (_staged_contracts.size() == capacity) return k;
        strike_group = static_cast<int>(_staged_contracts.size());
        _staged_contracts.push_back(contracts[k]);
        _staged_ranges.push_back(_ranges[static_cast<std::size_t>(run)].half_width(_memberships[k].range));
      }
      _staged_queries.push_back({strike_group, contracts[k].spot, contracts[k].strike});
      _query_contracts.push_back(k);
    }
    return contracts.size();
  }

  void price_gathered(const Resolution& resolution, WallTimes& times) {
    const ExecutionSpace& space = _instance.space();
    const device::Stopwatch copying_in;
    copy_in(_contracts, _staged_contracts, "drogue::options::strike group contracts");
    copy_in(_device_ranges, _staged_ranges, "drogue::options::strike ranges");
    copy_in(_queries, _staged_queries, "drogue::options::strike queries");
    _staged_order.clear();
    int end[models];
    for (int model = 0; model < models; ++model) {
      for (std::size_t k = 0; k < _staged_contracts.size(); ++k)
        if (static_cast<int>(_staged_contracts[k].model) == model)
          _staged_order.push_back(static_cast<int>(k));
      end[model] = static_cast<int>(_staged_order.size());
    }
    copy_in(_order, _staged_order, "drogue::options::order");
    reserve(_strike_groups, _staged_contracts.size(), "drogue::options::strike groups");
    reserve(_values, _staged_contracts.size() * StrikeGroupNodes::size(resolution.mesh),
            "drogue::options::strike group nodes");
    reserve(_prices, _staged_queries.size(), "drogue::options::prices");
    space.fence("drogue::options: strike groups are copied");
    times.h2d += copying_in.seconds();
    const device::Stopwatch computing;
    for (int model = 0, begin = 0; model < models; begin = end[model++])
      launch(static_cast<JumpModel>(model), resolution, begin, end[model]);
    const int count = static_cast<int>(_staged_queries.size());
    interpolate_prices(space,
                       {.contracts = _contracts,
                        .strike_groups = _strike_groups,
                        .values = _values,
                        .queries = _queries,
                        .prices = _prices,
                        .mesh = resolution.mesh,
                        .steps = resolution.steps,
                        .tolerance = tolerance_of(_settings)},
                       count);
    space.fence("drogue::options: strikes are priced");
    times.compute += computing.seconds();
    const device::Stopwatch copying_out;
    _staged_prices.resize(_staged_queries.size());
    device::copy_out(space, _staged_prices.data(), _prices, _staged_prices.size());
    space.fence("drogue::options: prices are copied");
    times.d2h += copying_out.seconds();
  }

  /// Enqueues the solves of the strike groups begin .. end - 1 of the order, which have one model.
  void launch(JumpModel model, const Resolution& resolution, int begin, int end) {
    if (begin == end) return;
    StrikeGroupFunctor<ExecutionSpace, 0, JumpClass::any> work{};
    work.batch.model = model;
    work.batch.contracts = _contracts;
    work.batch.order = Kokkos::View<const int*, Space>(_order.data() + begin, end - begin);
    work.batch.panels = _panels.series();
    work.batch.panel_slot = _panels.slots();
    work.batch.count = end - begin;
    work.batch.mesh = resolution.mesh;
    work.batch.steps = resolution.steps;
    work.batch.level = scratch_level<ExecutionSpace>(resolution.mesh);
    work.batch.roots = _roots.for_mesh(_instance.space(), resolution.mesh);
    work.strike_ranges = _device_ranges;
    work.strike_groups = _strike_groups;
    work.values = _values;
    solve_strike_groups(_instance.space(), work);
  }

  template <class T>
  static void reserve(View<T>& view, std::size_t count, const std::string& label) {
    if (view.size() < count) view = View<T>(Kokkos::view_alloc(label, Kokkos::WithoutInitializing), count);
  }

  /// Enqueues a copy; `from` must not change until the next fence.
  template <class T>
  void copy_in(View<T>& to, const Staged<T>& from, const std::string& label) {
    reserve(to, from.size(), label);
    device::copy_in(_instance.space(), to, from.data(), from.size());
  }

  Settings _settings;
  std::unique_ptr<Pricer> _single;
  device::Instance<ExecutionSpace> _instance;
  HankelPanels<ExecutionSpace> _panels;
  FourierRootsTable<ExecutionSpace> _roots;
  std::vector<Refinement> _rows;  ///< (contracts), as are the memberships
  std::vector<Membership> _memberships;
  std::vector<StrikeRanges> _ranges;          ///< (runs)
  double _variance = 0.0;                     ///< per year, of the latest process
  std::vector<std::size_t> _query_contracts;  ///< contracts of the queries
  device::PinnedMemory<ExecutionSpace> _pinned;
  Staged<Contract> _staged_contracts{&_pinned};
  Staged<double> _staged_ranges{&_pinned};
  Staged<StrikeQuery> _staged_queries{&_pinned};
  Staged<int> _staged_order{&_pinned};
  Staged<Price> _staged_prices{&_pinned};
  View<Contract> _contracts;
  View<double> _device_ranges, _values;
  View<StrikeQuery> _queries;
  View<int> _order;
  View<StrikeGroup> _strike_groups;
  View<Price> _prices;
};

template <class ExecutionSpace>
std::unique_ptr<Pricer> make_surface(const Settings& settings, std::unique_ptr<Pricer> single) {
  return std::make_unique<SurfaceImpl<ExecutionSpace>>(settings, std::move(single));
}

}  // namespace drogue::options
