#pragma once

#include "perf/ladders/options/options_rung.hpp"

namespace drogue::perf::ladder {

/// Sum of jumps to a node: one after the other.
struct PlainJumps {
  static constexpr int block = 1;

  /// `jumped[b]` of the nodes i + b, b < `block`, from the values v(j) of all nodes.
  template <class Weights, class V>
  KOKKOS_FUNCTION static void sum(const Weights& weights, const V& v, int i, double (&jumped)[block]) {
    jumped[0] = 0.0;
    for (int j = 0; j < option_nodes; ++j) jumped[0] += weights(j - i + option_nodes - 1) * v(j);
  }
};

/// All steps of an option by a team: `Jumps` sums blocks of nodes, one thread solves the tridiagonal system.
/// With `scratch` all arrays of the option and the weights lie in scratch memory.
template <class Arrays, class ExecutionSpace, class Jumps, bool scratch>
struct OptionTeamFunctor {
  using Member = typename Kokkos::TeamPolicy<ExecutionSpace>::member_type;
  using Row = Kokkos::View<double*, Kokkos::LayoutRight, typename ExecutionSpace::scratch_memory_space,
                           Kokkos::MemoryTraits<Kokkos::Unmanaged>>;
  static constexpr int weights = 2 * option_nodes - 1;

  Arrays arrays;

  static std::size_t scratch_bytes() {
    return scratch ? 3 * Row::shmem_size(option_nodes) + Row::shmem_size(weights) : 0;
  }

  KOKKOS_FUNCTION void operator()(const Member& member) const {
    const int k = member.league_rank();
    const auto all = Kokkos::ALL;
    const auto v = Kokkos::subview(arrays.v, k, all);
    if constexpr (scratch) {
      const Row fast(member.team_scratch(0), option_nodes), right(member.team_scratch(0), option_nodes),
          pivots(member.team_scratch(0), option_nodes), fast_weights(member.team_scratch(0), weights);
      const auto copy = [&](const auto& to, const auto& from, int count) {
        for (int i = member.team_rank(); i < count; i += member.team_size()) to(i) = from(i);
      };
      copy(fast, v, option_nodes);
      copy(fast_weights, arrays.weights, weights);
      member.team_barrier();
      solve(member, arrays.step(k), fast_weights, fast, right, pivots);
      copy(v, fast, option_nodes);
    } else {
      solve(member, arrays.step(k), arrays.weights, v, Kokkos::subview(arrays.right, k, all),
            Kokkos::subview(arrays.pivots, k, all));
    }
  }

  template <class Weights, class V, class Right, class Pivots>
  KOKKOS_FUNCTION void solve(const Member& member, const OptionStep& s, const Weights& w, const V& v,
                             const Right& right, const Pivots& pivots) const {
    constexpr int block = Jumps::block;
    for (int step = 1; step <= option_steps; ++step) {
      for (int i = member.team_rank() * block; i < option_nodes; i += member.team_size() * block) {
        double jumped[block];
        Jumps::sum(w, v, i, jumped);
        for (int b = 0; b < block; ++b) right(i + b) = v(i + b) + s.jumps * jumped[b];
      }
      member.team_barrier();
      if (member.team_rank() == 0) solve_step(s, arrays.boundary(s, step), right, pivots, v);
      member.team_barrier();
    }
  }
};

/// Rungs with a team per option, of `threads` threads on a GPU; on a host a team is one thread.
template <class ExecutionSpace, class Jumps, bool scratch>
class TeamRung final : public OptionsRung<ExecutionSpace, Kokkos::LayoutRight> {
  using Base = OptionsRung<ExecutionSpace, Kokkos::LayoutRight>;

 public:
  TeamRung(const OptionsProblem& problem, const char* label, int threads)
      : Base(problem), _label(label), _threads(threads) {}

 protected:
  void solve() override {
    using Functor = OptionTeamFunctor<typename Base::Arrays, ExecutionSpace, Jumps, scratch>;
    Kokkos::TeamPolicy<ExecutionSpace> policy(this->space(), this->problem().options(),
                                              device::is_host<ExecutionSpace> ? 1 : _threads);
    policy.set_scratch_size(0, Kokkos::PerTeam(static_cast<int>(Functor::scratch_bytes())));
    Kokkos::parallel_for(_label, policy, Functor{this->arrays()});
  }

 private:
  const char* _label;
  int _threads;
};

}  // namespace drogue::perf::ladder
