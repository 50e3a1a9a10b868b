#pragma once

#include "kernels/device/memory.hpp"
#include "kernels/options/pricer.hpp"
#include "kernels/options/solve.hpp"

namespace drogue::options {

/// What the largest |V(fine) - V(coarse)| near the spot is multiplied by for the stated error of their
/// extrapolation. That error is of an order between two, at kinks, and three: docs/options.md tells how often
/// it is below what is stated. The largest near the spot and not that at it, which changes sign somewhere.
KOKKOS_INLINE_FUNCTION double error_factor(int mesh) {
  const double finer = mesh <= 128 ? 1.0 : 128.0 / mesh;
  return 0.22 * Kokkos::sqrt(finer * Kokkos::sqrt(finer));
}

/// The answer for a put of strike 1 on two grids, extrapolated to steps of length zero (the error of both is
/// of second order), as the contract's price.
KOKKOS_INLINE_FUNCTION Price price_of(const Contract& contract, const Put& put, const Answer& fine,
                                      const Answer& coarse, double change, int mesh, int steps,
                                      double tolerance) {
  const auto limit = [](double f, double c) { return f + (f - c) * (1.0 / 3); };
  const double asset = exponential(put.log_spot);
  const bool exercised = put.early && fine.slope == -asset && fine.decay == 0.0;
  Answer a = fine;
  if (!exercised) {
    a.value = limit(fine.value, coarse.value);
    a.slope = limit(fine.slope, coarse.slope);
    a.bend = limit(fine.bend, coarse.bend);
    a.decay = limit(fine.decay, coarse.decay);
    const double least = put.early && asset < 1.0 ? 1.0 - asset : 0.0;
    if (a.value < least) a.value = least;  // a NaN stays one
  }
  const bool call = contract.type == Type::call;
  const double unit = call ? contract.spot : contract.strike, s = contract.spot;
  const double error = error_factor(mesh) * change + cut_error(mesh);
  Price price;
  price.price = unit * a.value;
  price.error = unit * error;
  price.delta = call ? a.value - a.slope : unit * a.slope / s;
  price.gamma = call ? (a.bend - a.slope) / s : unit * (a.bend - a.slope) / (s * s);
  price.theta = -unit * a.decay;
  price.exercise_boundary = contract.strike * exponential(call ? -fine.boundary : fine.boundary);
  if (!(fine.boundary == fine.boundary)) price.exercise_boundary = fine.boundary;
  price.mesh = mesh;
  price.steps = steps;
  // Nobody pays more for a put than what it can earn at most.
  const double most = put.rate < 0.0 ? exponential(-put.rate * put.maturity) : 1.0;
  const bool finite = a.value <= 1.001 * most && price.error < 1e300;
  if (!finite) price.price = device::portable::not_a_number();
  price.outcome = !finite                                     ? Outcome::failed
                  : price.error > tolerance * contract.strike ? Outcome::coarse
                                                              : Outcome::ok;
  return price;
}

/// The number that a thread of `ExecutionSpace` computes with: one option's, or on hosts several options'.
template <class ExecutionSpace>
using Number = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;

/// Contracts order(0), order(1), ... of one model, priced on one mesh in one launch by a team for each, or on
/// hosts for each pack of them.
template <class ExecutionSpace>
struct PriceBatch {
  using Space = typename ExecutionSpace::memory_space;
  using R = Number<ExecutionSpace>;
  using Member = typename Kokkos::TeamPolicy<ExecutionSpace>::member_type;
  static constexpr int members = device::Access<R>::lanes;

  Kokkos::View<const Contract*, Space> contracts;  ///< (batch)
  Kokkos::View<Price*, Space> prices;              ///< (batch)
  Kokkos::View<const int*, Space> order;           ///< (count)
  Kokkos::View<const double*, Space> panels;       ///< (panels, HankelGrid::panel_size)
  Kokkos::View<const int*, Space> panel_slot;      ///< (HankelGrid::panels)
  Record record{};                                 ///< of the only contract, if at all
  int count = 0, mesh = 0, steps = 0, level = 0;
  double tolerance = 0.0;

  /// Calls `functor.price` with the workers and the memory of a team. For `block` see `solve`.
  template <int block, class Functor>
  KOKKOS_INLINE_FUNCTION void price_group(const Functor& functor, const Member& team) const {
    using Scratch = Memory<R, block>;
    void* place = team.team_scratch(level).get_shmem_aligned(Scratch::bytes(mesh), 64);
    if constexpr (block > 0) place = device::in_shared_memory(place);
    const Scratch memory(place, mesh);
    if constexpr (members == 1 && !device::is_host<ExecutionSpace>) {
      functor.price(WarpWorkers{static_cast<int>(team.team_rank())}, memory, team.league_rank());
    } else {
      functor.price(SerialWorkers<R>{}, memory, team.league_rank());
    }
  }

  /// The contract of member k of a group; the last group repeats the last contract.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION int place(int group, int k) const {
    const int at = group * members + k;
    return order(at < count ? at : count - 1);
  }

  template <int block, class Workers>
  KOKKOS_INLINE_FUNCTION void price(const Workers& workers, const Memory<R, block>& memory, int group) const {
    const int cells = block > 0 ? lanes * block : mesh;  // which a compiler may unroll loops for
    workers.each([=, this](int lane) {
      for (int k = lane; k < members; k += lanes) memory.puts[k] = put_of(contracts(place(group, k)));
    });
    PutPack<R> put = pack_of<R>(memory.puts);
    const Law<R> law =
        law_of(workers, put, memory.puts, panels.data(), panel_slot.data(), memory.law_memory(), memory.slot);
    const Domain<R> domain = domain_of(workers, put, law, cut_error(cells), memory.slot);
    Grid<R> grid = grid_of(domain, cells);
    const Tails<R> tails = tails_of(workers, put, law, grid.h * double(cells), memory.slot);
    const R* fine = solve<block>(workers, put, law, tails, grid, steps, memory, {memory.w, nullptr}, record,
                                 memory.answers);
    R* const kept = memory.kept(cells);
    workers.each([=, this](int lane) {
      for (int i = lane; i < cells / 2; i += lanes) kept[i] = fine[2 * i];
    });
    grid = {cells / 2, 2.0 * grid.h, 0.5 * grid.strike};
    const R* coarse =
        solve<block / 2>(workers, put, law, tails, grid, steps / 2, memory,
                         {memory.coarse_weights(cells), memory.w}, Record{}, memory.answers + members);
    const R deviation = device::square_root((put.variance + law.variance) * put.maturity);
    R* const change = memory.slot;
    workers.each([=, this, &put](int lane) {
      const R window = device::maximum(grid.h, 1.0 * deviation);
      R largest = 0.0;
      for (int i = lane; i < cells / 2; i += lanes) {
        const auto near = device::absolute((double(i) - grid.strike) * grid.h - put.log_spot) <= window;
        largest =
            device::maximum(largest, device::select(near, device::absolute(kept[i] - coarse[i]), R(0.0)));
      }
      change[lane] = largest;
    });
    workers.each([=, this](int lane) {
      for (int k = lane; k < members; k += lanes) {
        if (group * members + k >= count) continue;
        double largest = 0.0;
        for (int m = 0; m < lanes; ++m) {
          const double one = device::Access<R>::lane(change[m], k);
          largest = one > largest || one != one ? one : largest;
        }
        const int at = place(group, k);
        prices(at) = price_of(contracts(at), memory.puts[k], memory.answers[k], memory.answers[members + k],
                              largest, cells, steps, tolerance);
      }
    });
  }
};

/// Prices a batch; with a `block` > 0 its mesh is 32 block.
template <class ExecutionSpace, int block>
struct PriceFunctor {
  using Batch = PriceBatch<ExecutionSpace>;

  Batch batch;

  KOKKOS_FUNCTION void operator()(const typename Batch::Member& team) const {
    batch.template price_group<block>(*this, team);
  }
  template <class Workers>
  KOKKOS_INLINE_FUNCTION void price(const Workers& workers, const Memory<typename Batch::R, block>& memory,
                                    int group) const {
    batch.price(workers, memory, group);
  }
};

/// Where a team's memory is: in that of its multiprocessor, if Kokkos has so much for a team, else (and on
/// hosts) beside.
template <class ExecutionSpace>
[[nodiscard]] int scratch_level(int mesh) {
  const auto most_shared = static_cast<std::size_t>(Kokkos::TeamPolicy<ExecutionSpace>::scratch_size_max(0));
  const bool shared =
      !device::is_host<ExecutionSpace> && Memory<Number<ExecutionSpace>, 0>::bytes(mesh) + 64 <= most_shared;
  return shared ? 0 : 1;
}

/// Enqueues `functor`, which prices its batch.
template <int block, class ExecutionSpace, class Functor>
void launch_batch(const ExecutionSpace& space, const char* label, const Functor& functor) {
  using Batch = PriceBatch<ExecutionSpace>;
  const Batch& batch = functor.batch;
  if (batch.count == 0) return;
  // Warps that share a multiprocessor: as many as registers for the nodes allow without spilling.
  constexpr unsigned teams = block == 0 ? 1 : block < 8 ? 12 : 8;
  using Bounds = std::conditional_t<block == 0, Kokkos::LaunchBounds<>, Kokkos::LaunchBounds<lanes, teams>>;
  const int league = (batch.count + Batch::members - 1) / Batch::members;
  Kokkos::TeamPolicy<ExecutionSpace, Bounds> policy(space, league,
                                                    device::is_host<ExecutionSpace> ? 1 : lanes);
  policy.set_scratch_size(batch.level,
                          Kokkos::PerTeam(Memory<typename Batch::R, block>::bytes(batch.mesh) + 64));
  Kokkos::parallel_for(label, policy, functor);
}

/// Enqueues the launch.
template <class ExecutionSpace>
void price_batch(const ExecutionSpace& space, const PriceBatch<ExecutionSpace>& batch) {
  static_assert(
      Kokkos::SpaceAccessibility<ExecutionSpace, typename decltype(batch.prices)::memory_space>::accessible);
  const auto launch = [&]<int block>(const char* label) {
    launch_batch<block>(space, label, PriceFunctor<ExecutionSpace, block>{batch});
  };
  if constexpr (!device::is_host<ExecutionSpace>) {
    constexpr const char* in_registers = "drogue::options::price in registers";
    if (batch.record.time == nullptr) {
      if (batch.mesh == 64) return launch.template operator()<2>(in_registers);
      if (batch.mesh == 128) return launch.template operator()<4>(in_registers);
      if (batch.mesh == 256) return launch.template operator()<8>(in_registers);
    }
  }
  launch.template operator()<0>("drogue::options::price");
}

}  // namespace drogue::options
