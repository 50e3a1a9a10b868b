#pragma once

#include "kernels/device/memory.hpp"
#include "kernels/options/pricer.hpp"
#include "kernels/options/solve.hpp"

namespace drogue::options {

/// Why a put has no price on a grid of steps h.
KOKKOS_INLINE_FUNCTION Failure failure_of(const Put& put, double h) {
  if (put.rate * put.maturity < -650.0) return Failure::too_large;
  return h < 100.0 ? Failure::grown : Failure::no_grid;
}

/// The node next to the spot of a put.
KOKKOS_INLINE_FUNCTION int node_beside(const Put& put, double strike, double h, int mesh) {
  const double t = put.log_spot / h + strike + 0.5;
  return t > 0.0 ? t < mesh ? static_cast<int>(t) : mesh - 1 : 0;
}

/// The answer for a put of strike 1 on two grids, the coarser one with steps h, extrapolated to steps of
/// length zero (the error of both is of second order), as the contract's price. `largest`: |V(fine) -
/// V(coarse)| near the spot.
KOKKOS_INLINE_FUNCTION Price price_of(const Contract& contract, const Put& put, const Answer& fine,
                                      const Answer& coarse, const Doubt<double>& doubt, double largest,
                                      double h, int mesh, int steps, double tolerance) {
  const auto limit = [](double f, double c) { return f + (f - c) * (1.0 / 3); };
  const double asset = exponential(put.log_spot);
  const bool exercised = put.early && fine.slope == -asset && fine.decay == 0.0;
  Answer a = fine;
  if (!exercised) {
    a.value = limit(fine.value, coarse.value);
    a.slope = limit(fine.slope, coarse.slope);
    a.bend = limit(fine.bend, coarse.bend);
    a.decay = limit(fine.decay, coarse.decay);
  }
  const bool call = contract.type == Type::call;
  const double unit = call ? contract.spot : contract.strike, s = contract.spot;
  // The extrapolation has 4/3 of what the fine grid misses and a third of what the coarse one does. Twice
  // that, since beside a sharp kink the terms that follow are no smaller.
  const double missed = 2.0 * (4.0 * fine.missed + coarse.missed) * (1.0 / 3);
  const double near = nearness(put, fine.boundary, 0.5 * h), unseen = doubt.gap + cut_doubt(mesh);
  const double contact = near > 0.0 ? doubt_of_contact(fine) : 0.0;
  // Where the payoff is the price nothing is in doubt but whether the boundary lies above.
  const double stated = exercised && near > 0.0 ? near * near * (contact + unseen) + no_time_value
                                                : doubt.factor * largest + near * contact + missed + unseen;
  // Nobody pays more for a put than what it can earn at most, and no error is larger; nor less than what
  // exercise now or at expiry, whatever happens, is worth. A value that is not a number stays one.
  const double bond = exponential(-put.rate * put.maturity);
  const double most = put.rate < 0.0 ? bond : 1.0;
  const double late = bond - exponential(put.log_spot - put.dividend * put.maturity);
  const double least = device::maximum(put.early ? 1.0 - asset : 0.0, device::maximum(0.0, late));
  const bool finite = fine.value <= 1.001 * most && largest <= 4.0 * most && unit * most < 1e300 &&
                      put.rate * put.maturity >= -650.0 && h < 100.0;
  if (a.value < least) a.value = least;
  if (a.value > most) a.value = most;
  // Grids that differ by a quarter of all there is to know say nothing of the error.
  const double error = stated < most && largest < 0.25 * most ? stated : most;
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
  if (!finite) price.price = device::portable::not_a_number();
  price.outcome = !finite                                     ? Outcome::failed
                  : price.error > tolerance * contract.strike ? Outcome::coarse
                                                              : Outcome::ok;
  if (!finite) price.failure = failure_of(put, h);
  return price;
}

/// The larger of two; not a number if one of them is none.
template <class R>
KOKKOS_INLINE_FUNCTION R larger(R a, R b) {
  return device::select(b >= b, device::select(b > a, b, a), b);
}

/// The number that a thread of `ExecutionSpace` computes with: one option's, or on hosts several options'.
template <class ExecutionSpace>
using Number = std::conditional_t<device::is_host<ExecutionSpace>, device::HostPack<double>, double>;

/// Contracts order(0), order(1), ... of one model, priced on one mesh in one launch by a team for one or two
/// of them, or on hosts for each pack of them.
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
  FourierRoots roots{};                            ///< in the memory of the backend
  Record record{};                                 ///< of the only contract, if at all
  int count = 0, mesh = 0, steps = 0, level = 0;
  int lanes = most_lanes;  ///< of an option on hosts
  double tolerance = 0.0;
  bool split = false;     ///< exercise is, wherever it pays
  bool one_grid = false;  ///< no second solve: the price is not extrapolated and has no error

  /// Groups, of an option or of a pack of them, that a team prices side by side.
  static KOKKOS_INLINE_FUNCTION constexpr int groups(int fixed) {
    return device::is_host<ExecutionSpace> ? 1 : most_lanes / lanes_of(fixed);
  }

  /// Calls `functor.price` with the workers and the memory of a group. For `fixed` see `solve`.
  template <int fixed, class Functor>
  KOKKOS_INLINE_FUNCTION void price_group(const Functor& functor, const Member& team) const {
    using Scratch = Memory<R, fixed>;
    const std::size_t bytes = Scratch::bytes(mesh);
    void* place = team.team_scratch(level).get_shmem_aligned(groups(fixed) * bytes, 64);
    if constexpr (fixed > 0) place = device::in_shared_memory(place);
    if constexpr (members == 1 && !device::is_host<ExecutionSpace>) {
      constexpr int width = lanes_of(fixed);
      const int rank = static_cast<int>(team.team_rank()), own = rank / width;
      functor.price(WarpWorkers<width>{rank % width},
                    Scratch(static_cast<std::byte*>(place) + own * bytes, mesh),
                    team.league_rank() * groups(fixed) + own);
    } else {
      functor.price(SerialWorkers<R>{lanes}, Scratch(place, mesh), team.league_rank());
    }
  }

  /// The contract of member k of a group; the last group repeats the last contract.
  [[nodiscard]] KOKKOS_INLINE_FUNCTION int place(int group, int k) const {
    const int at = group * members + k;
    return order(at < count ? at : count - 1);
  }

  template <int fixed, class Workers>
  KOKKOS_INLINE_FUNCTION void price(const Workers& workers, const Memory<R, fixed>& memory, int group) const {
    const int cells = fixed > 0 ? fixed : mesh;  // which a compiler may unroll loops for
    workers.each([=, this](int lane) {
      for (int k = lane; k < members; k += workers.lanes) {
        memory.puts[k] = put_of(contracts(place(group, k)));
        if (split) memory.puts[k].split = memory.puts[k].early;
      }
    });
    PutPack<R> put = pack_of<R>(memory.puts);
    put.any_split = !workers.all(!put.any_split);
    const Law<R> law =
        law_of(workers, put, memory.puts, panels.data(), panel_slot.data(), memory.law_memory());
    const Domain<R> domain = domain_of(workers, put, law, cut_error(cells), memory.slot);
    Grid<R> grid = grid_of(domain, cells);
    const Tails<R> tails = tails_of(workers, put, law, grid.h * double(cells));
    const Solution<R> fine = solve<fixed>(workers, put, law, tails, grid, steps, memory,
                                          {memory.w, nullptr, roots}, record, memory.answers);
    R* const kept = memory.kept(cells);
    workers.each([=, this](int lane) {
      for (int i = lane; i < cells / 2; i += workers.lanes) kept[i] = fine.value[2 * i];
    });
    grid = {cells / 2, 2.0 * grid.h, 0.5 * grid.strike};
    const R* coarse = kept;
    Answer* const coarse_answers = one_grid ? memory.answers : memory.answers + members;
    const auto beside_spot = [&memory, &grid](const R* nodes, int k) {
      const auto own = [k](const R& number) { return device::Access<R>::lane(number, k); };
      return column_of(nodes, k)(node_beside(memory.puts[k], own(grid.strike), own(grid.h), grid.mesh));
    };
    const bool knows_premium = !split && !one_grid;
    if (!one_grid) {
      // Where exercise has to be split off, once more without it before: the premium tells what that misses.
      for (int exercise = put.any_split && knows_premium ? 0 : 1; exercise < 2; ++exercise) {
        coarse = solve<fixed / 2>(workers, exercise == 0 ? unexercised(put) : put, law, tails, grid,
                                  steps / 2, memory, {memory.coarse_weights(cells), memory.w, roots},
                                  Record{}, coarse_answers)
                     .value;
        if (exercise == 0)
          workers.each([=](int lane) {
            for (int k = lane; k < members; k += workers.lanes)
              memory.unexercised[k] = beside_spot(coarse, k);
          });
      }
    }
    const R deviation = device::square_root((put.variance + law.variance) * put.maturity);
    const R window = device::maximum(grid.h, deviation);
    const auto largest_change = [=, this, &put](int lane) {
      Kokkos::Array<R, 1> largest = {R(0.0)};
      for (int i = lane; i < cells / 2; i += workers.lanes) {
        const auto near = device::absolute((double(i) - grid.strike) * grid.h - put.log_spot) <= window;
        largest[0] = larger(largest[0], device::select(near, device::absolute(kept[i] - coarse[i]), R(0.0)));
      }
      return largest;
    };
    const R largest = workers.reduce(largest_change, [](const R& a, const R& b) { return larger(a, b); })[0];
    workers.each([=, this](int lane) {
      for (int k = lane; k < members; k += workers.lanes) {
        if (group * members + k >= count) continue;
        const int at = place(group, k);
        const auto own = [k](const R& number) { return device::Access<R>::lane(number, k); };
        Doubt<double> doubt = doubt_without_premium(fine.doubt, memory.puts[k], k);
        if (knows_premium && memory.puts[k].split) {
          const double premium = beside_spot(coarse, k) - memory.unexercised[k];
          doubt = {own(fine.doubt.factor),
                   own(fine.doubt.gap) + doubt_of_splitting(premium, cells, steps, own(largest))};
        }
        prices(at) = price_of(contracts(at), memory.puts[k], memory.answers[k], coarse_answers[k], doubt,
                              own(largest), own(grid.h), cells, steps, tolerance);
        if (one_grid) prices(at).error = device::portable::not_a_number();
      }
    });
  }
};

/// Prices a batch; for `fixed` see `solve`.
template <class ExecutionSpace, int fixed>
struct PriceFunctor {
  using Batch = PriceBatch<ExecutionSpace>;

  Batch batch;

  KOKKOS_FUNCTION void operator()(const typename Batch::Member& team) const {
    batch.template price_group<fixed>(*this, team);
  }
  template <class Workers>
  KOKKOS_INLINE_FUNCTION void price(const Workers& workers, const Memory<typename Batch::R, fixed>& memory,
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
template <int fixed, class ExecutionSpace, class Functor>
void launch_batch(const ExecutionSpace& space, const char* label, const Functor& functor) {
  using Batch = PriceBatch<ExecutionSpace>;
  const Batch& batch = functor.batch;
  if (batch.count == 0) return;
  // Warps that share a multiprocessor: as many as registers for the nodes allow without spilling.
  constexpr unsigned teams = fixed == 0 ? 1 : fixed < 128 ? 12 : 8;
  using Bounds =
      std::conditional_t<fixed == 0, Kokkos::LaunchBounds<>, Kokkos::LaunchBounds<most_lanes, teams>>;
  constexpr int options = Batch::members * Batch::groups(fixed);
  const int league = (batch.count + options - 1) / options;
  Kokkos::TeamPolicy<ExecutionSpace, Bounds> policy(space, league,
                                                    device::is_host<ExecutionSpace> ? 1 : most_lanes);
  policy.set_scratch_size(
      batch.level,
      Kokkos::PerTeam(Batch::groups(fixed) * Memory<typename Batch::R, fixed>::bytes(batch.mesh) + 64));
  Kokkos::parallel_for(label, policy, functor);
}

/// Enqueues the launch.
template <class ExecutionSpace>
void price_batch(const ExecutionSpace& space, PriceBatch<ExecutionSpace> batch) {
  static_assert(
      Kokkos::SpaceAccessibility<ExecutionSpace, typename decltype(batch.prices)::memory_space>::accessible);
  if (batch.record.time == nullptr) batch.lanes = lanes_of(batch.mesh);
  const auto launch = [&]<int fixed>(const char* label) {
    launch_batch<fixed>(space, label, PriceFunctor<ExecutionSpace, fixed>{batch});
  };
  if constexpr (!device::is_host<ExecutionSpace>) {
    constexpr const char* in_registers = "drogue::options::price in registers";
    if (batch.record.time == nullptr) {
      if (batch.mesh == 64) return launch.template operator()<64>(in_registers);
      if (batch.mesh == 128) return launch.template operator()<128>(in_registers);
      if (batch.mesh == 256) return launch.template operator()<256>(in_registers);
    }
  }
  launch.template operator()<0>("drogue::options::price");
}

}  // namespace drogue::options
