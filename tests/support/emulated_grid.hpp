#pragma once

#include <atomic>
#include <barrier>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "kernels/device/persistent_kernel.hpp"

namespace drogue::testing {

/// Persistent kernel emulated by host threads: the interface of device::PersistentMember, and detection of
/// values that are overwritten before all readers have read them.
class EmulatedGrid {
 public:
  EmulatedGrid(int teams, int team_size, std::size_t scratch_bytes, std::size_t places)
      : _team_size(team_size),
        _published(static_cast<std::size_t>(teams)),
        _boards(2 * places),
        _places(places) {
    for (int team = 0; team < teams; ++team) {
      _scratch.emplace_back((scratch_bytes + sizeof(double) - 1) / sizeof(double));
      _barriers.push_back(std::make_unique<std::barrier<>>(team_size));
    }
  }

  class Member {
   public:
    Member(EmulatedGrid& grid, int team, int rank) : _grid(grid), _team(team), _rank(rank) {}

    [[nodiscard]] int team_rank() const { return _rank; }
    [[nodiscard]] int team_size() const { return _grid._team_size; }
    [[nodiscard]] int league_rank() const { return static_cast<int>(_team); }
    [[nodiscard]] int league_size() const { return static_cast<int>(_grid._scratch.size()); }
    void team_barrier() const { _grid._barriers[_team]->arrive_and_wait(); }
    [[nodiscard]] const Member& team_scratch(int) const { return *this; }
    [[nodiscard]] void* get_shmem_aligned(std::size_t bytes, std::size_t alignment) const {
      _used = (_used + alignment - 1) / alignment * alignment;
      std::vector<double>& scratch = _grid._scratch[_team];
      void* place = reinterpret_cast<char*>(scratch.data()) + _used;
      _used += bytes;
      if (_used > scratch.size() * sizeof(double)) throw std::logic_error("a team has too little memory");
      return place;
    }

    [[nodiscard]] std::uint64_t epoch() const { return _grid._published[_team]; }
    void publish(std::uint64_t epoch) const { _grid._published[_team] = epoch; }
    void await(int other, std::uint64_t epoch) const {
      while (_grid._published[static_cast<std::size_t>(other)] < epoch) std::this_thread::yield();
    }

    void put(std::uint64_t epoch, std::size_t place, const device::HaloValue& numbers) const {
      Place& at = _grid.at(epoch, place);
      for (std::size_t k = 0; k < 3; ++k) at.value[k] = numbers.value[k];
      at.epoch = epoch;
    }
    [[nodiscard]] device::HaloValue get(std::uint64_t epoch, std::size_t place) const {
      const Place& at = _grid.at(epoch, place);
      while (at.epoch < epoch) std::this_thread::yield();
      const device::HaloValue numbers{{at.value[0], at.value[1], at.value[2]}};
      if (at.epoch != epoch) _grid._overwritten = true;
      return numbers;
    }

   private:
    EmulatedGrid& _grid;
    std::size_t _team;
    int _rank;
    mutable std::size_t _used = 0;
  };

  /// Runs `functor(member)` in every thread. Blocking.
  template <class Functor>
  void launch(const Functor& functor) {
    std::vector<std::jthread> threads;
    for (int team = 0; team < static_cast<int>(_scratch.size()); ++team)
      for (int rank = 0; rank < _team_size; ++rank)
        threads.emplace_back([this, &functor, team, rank] { functor(Member(*this, team, rank)); });
  }

  /// True if a value was overwritten by one of a later epoch before all readers had read it.
  [[nodiscard]] bool overwritten() const { return _overwritten; }

 private:
  struct Place {
    std::atomic<std::uint64_t> epoch{0};
    std::atomic<double> value[3] = {};
  };

  Place& at(std::uint64_t epoch, std::size_t place) { return _boards[epoch % 2 * _places + place]; }

  int _team_size;
  std::vector<std::atomic<std::uint64_t>> _published;  ///< last epoch that each team has completed
  std::vector<std::vector<double>> _scratch;
  std::vector<std::unique_ptr<std::barrier<>>> _barriers;
  std::vector<Place> _boards;
  std::size_t _places;
  std::atomic<bool> _overwritten{false};
};

}  // namespace drogue::testing
