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
#include "kernels/options/batch/refinement.hpp"
#include "kernels/options/batch/stopwatch.hpp"
#include "kernels/options/levy/hankel_panels.hpp"
#include "kernels/options/surface/strike_group.hpp"
#include "kernels/options/surface/strike_range.hpp"
#include "kernels/options/transforms/roots_of_unity.hpp"

namespace drogue::options {

/// A pricer whose contracts share solves: those that follow one another and differ in the strike alone are
/// one smile. What a strike gets does not depend on the others: docs/options.md, "Surfaces".
template <class ExecutionSpace>
class SurfaceImpl final : public Pricer {
  using Space = typename ExecutionSpace::memory_space;
  template <class T>
  using View = Kokkos::View<T*, Space>;
  template <class T>
  using Staged = std::pmr::vector<T>;

 public:
  /// `single` answers what is asked of one contract.
  SurfaceImpl(const Settings& settings, std::unique_ptr<Pricer> single)
      : _settings(settings), _single(std::move(single)), _instance(1 << 20) {}

  WallTimes price(std::span<const Contract> contracts, std::span<Price> prices) override {
    if (contracts.size() != prices.size())
      throw std::invalid_argument("options pricer: as many prices as contracts are needed");
    WallTimes timing;
    if (contracts.empty()) return timing;
    const Stopwatch building;
    _panels.build(contracts);
    assign_reaches(contracts);
    timing.compute = building.seconds();
    const Stopwatch copying_in;
    _panels.copy_in(_instance.space());
    timing.h2d = copying_in.seconds();
    const int mesh = _settings.mesh != 0 ? _settings.mesh : first_mesh;
    const Resolution first{mesh, steps_of(_settings, mesh, 1)};
    _rows.assign(contracts.size(), Refinement{first});
    for (std::optional<Resolution> effort = first; effort; effort = least_effort(_rows)) {
      for (std::size_t begin = 0; begin < contracts.size();) {
        begin = gather(contracts, *effort, begin);
        price_gathered(*effort, timing);
        for (std::size_t k = 0; k < _places.size(); ++k) prices[_places[k]] = _staged_prices[k];
      }
      for (std::size_t k = 0; k < contracts.size(); ++k) {
        if (_rows[k].next != *effort) continue;
        if (_settings.mesh != 0) {
          _rows[k].next = {};
        } else {
          refine(_rows[k], prices[k], _settings.tolerance * contracts[k].strike, _settings);
        }
      }
    }
    return timing;
  }

  std::vector<BoundaryPoint> boundary_on(const Contract& contract, int mesh, int steps) override {
    return _single->boundary_on(contract, mesh, steps);
  }
  std::vector<ProfilePoint> profile(const Contract& contract) override { return _single->profile(contract); }

 private:
  static constexpr int first_mesh = 128, models = 4;
  static constexpr std::size_t most_values = std::size_t{1} << 23U;  ///< of nodes in memory at a time

  /// Whose smile a contract belongs to, and which of its reaches it needs.
  struct Place {
    int run;
    std::uint8_t reach;
  };

  void assign_reaches(std::span<const Contract> contracts) {
    _place.clear();
    _reaches.clear();
    for (std::size_t k = 0; k < contracts.size(); ++k) {
      if (k == 0 || !differ_in_strike_alone(contracts[k - 1], contracts[k]))
        _reaches.emplace_back(deviation_of(contracts, k));
      _place.push_back({static_cast<int>(_reaches.size()) - 1,
                        _reaches.back().find(contracts[k].spot / contracts[k].strike)});
    }
  }

  double deviation_of(std::span<const Contract> contracts, std::size_t k) {
    const Contract& c = contracts[k];
    if (k == 0 || !have_same_law(contracts[k - 1], c))
      _variance = variance_of(c, _panels.host_series().data(), _panels.host_slots().data());
    return std::sqrt(_variance * c.maturity);
  }

  /// Gathers what contracts from `begin` on ask for with this effort, as far as memory for smiles reaches.
  /// Returns the contract that it ends before.
  std::size_t gather(std::span<const Contract> contracts, const Resolution& effort, std::size_t begin) {
    const std::size_t most = std::max(most_values / SmileNodes::size(effort.mesh), std::size_t{1});
    _staged_contracts.clear();
    _staged_reaches.clear();
    _staged_readings.clear();
    _places.clear();
    int run = -1;
    std::vector<int> smile_at;  // of the run's reaches
    for (std::size_t k = begin; k < contracts.size(); ++k) {
      if (_rows[k].next != effort) continue;
      if (_place[k].run != run) {
        run = _place[k].run;
        smile_at.assign(Reaches::most, -1);
      }
      int& smile = smile_at[_place[k].reach];
      if (smile < 0) {
        if (_staged_contracts.size() == most) return k;
        smile = static_cast<int>(_staged_contracts.size());
        _staged_contracts.push_back(contracts[k]);
        _staged_reaches.push_back(_reaches[static_cast<std::size_t>(run)].reach(_place[k].reach));
      }
      _staged_readings.push_back({smile, contracts[k].spot, contracts[k].strike});
      _places.push_back(k);
    }
    return contracts.size();
  }

  void price_gathered(const Resolution& effort, WallTimes& timing) {
    const ExecutionSpace& space = _instance.space();
    const Stopwatch copying_in;
    copy_in(_contracts, _staged_contracts, "drogue::options::smile contracts");
    copy_in(_reach, _staged_reaches, "drogue::options::reaches");
    copy_in(_readings, _staged_readings, "drogue::options::readings");
    _staged_order.clear();
    int end[models];
    for (int model = 0; model < models; ++model) {
      for (std::size_t k = 0; k < _staged_contracts.size(); ++k)
        if (static_cast<int>(_staged_contracts[k].model) == model)
          _staged_order.push_back(static_cast<int>(k));
      end[model] = static_cast<int>(_staged_order.size());
    }
    copy_in(_order, _staged_order, "drogue::options::order");
    reserve(_smiles, _staged_contracts.size(), "drogue::options::smiles");
    reserve(_values, _staged_contracts.size() * SmileNodes::size(effort.mesh),
            "drogue::options::smile nodes");
    reserve(_prices, _staged_readings.size(), "drogue::options::prices");
    space.fence("drogue::options: smiles are asked for");
    timing.h2d += copying_in.seconds();
    const Stopwatch computing;
    for (int model = 0, begin = 0; model < models; begin = end[model++])
      launch(static_cast<Model>(model), effort, begin, end[model]);
    const int count = static_cast<int>(_staged_readings.size());
    read_smiles(
        space,
        {_contracts, _smiles, _values, _readings, _prices, effort.mesh, effort.steps, _settings.tolerance},
        count);
    space.fence("drogue::options: smiles are read");
    timing.compute += computing.seconds();
    const Stopwatch copying_out;
    _staged_prices.resize(_staged_readings.size());
    device::copy_out(space, _staged_prices.data(), _prices, _staged_prices.size());
    space.fence("drogue::options: prices are there");
    timing.d2h += copying_out.seconds();
  }

  /// Enqueues the solves of the smiles begin .. end - 1 of the order, which have one model.
  void launch(Model model, const Resolution& effort, int begin, int end) {
    if (begin == end) return;
    SmileFunctor<ExecutionSpace, 0, JumpClass::any> work{};
    work.batch.model = model;
    work.batch.contracts = _contracts;
    work.batch.order = Kokkos::View<const int*, Space>(_order.data() + begin, end - begin);
    work.batch.panels = _panels.series();
    work.batch.panel_slot = _panels.slots();
    work.batch.count = end - begin;
    work.batch.mesh = effort.mesh;
    work.batch.steps = effort.steps;
    work.batch.level = scratch_level<ExecutionSpace>(effort.mesh);
    work.batch.roots = _roots.of_mesh(_instance.space(), effort.mesh);
    work.reaches = _reach;
    work.smiles = _smiles;
    work.values = _values;
    solve_smiles(_instance.space(), work);
  }

  template <class T>
  static void reserve(View<T>& view, std::size_t count, const std::string& label) {
    if (view.size() < count) view = View<T>(Kokkos::view_alloc(label, Kokkos::WithoutInitializing), count);
  }

  /// Enqueues a copy; `from` must stay as it is until the next fence.
  template <class T>
  void copy_in(View<T>& to, const Staged<T>& from, const std::string& label) {
    reserve(to, from.size(), label);
    device::copy_in(_instance.space(), to, from.data(), from.size());
  }

  Settings _settings;
  std::unique_ptr<Pricer> _single;
  device::Instance<ExecutionSpace> _instance;
  HankelPanels<ExecutionSpace> _panels;
  RootsOfUnity<ExecutionSpace> _roots;
  std::vector<Refinement> _rows;  ///< of each contract, as the next
  std::vector<Place> _place;
  std::vector<Reaches> _reaches;     ///< of each smile
  double _variance = 0.0;            ///< a year, of the law asked for last
  std::vector<std::size_t> _places;  ///< contracts of the readings
  device::PinnedMemory<ExecutionSpace> _pinned;
  Staged<Contract> _staged_contracts{&_pinned};
  Staged<double> _staged_reaches{&_pinned};
  Staged<Reading> _staged_readings{&_pinned};
  Staged<int> _staged_order{&_pinned};
  Staged<Price> _staged_prices{&_pinned};
  View<Contract> _contracts;
  View<double> _reach, _values;
  View<Reading> _readings;
  View<int> _order;
  View<Smile> _smiles;
  View<Price> _prices;
};

template <class ExecutionSpace>
std::unique_ptr<Pricer> make_surface(const Settings& settings, std::unique_ptr<Pricer> single) {
  return std::make_unique<SurfaceImpl<ExecutionSpace>>(settings, std::move(single));
}

}  // namespace drogue::options
