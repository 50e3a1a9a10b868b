#pragma once

#include "kernels/options/batch/price_batch.hpp"

namespace drogue::options {

/// The grid of the dissertation's scheme: x in [-4, 4], the strike in the middle.
inline constexpr double seed_reach = 4.0;

/// Jumps as section 4.6.2 of the dissertation has them: exact masses of cells of the density, none within
/// epsilon = h; the variance of those is diffusion. `jumps.left` and `left_price` are the B_l of Listing 4.6,
/// what leaves the grid downwards; what leaves it upwards is worth nothing.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION Jumps<R> seed_jumps(const ThreadGroup& workers, const PutPack<R>& put,
                                           const LevyMeasure<R>& law, const Grid<R>& grid, R* w, R* left,
                                           R* left_price) {
  const int mesh = grid.mesh, nodes = node_count(mesh);
  const R h = grid.h, beta = put.jump[2];
  const WeightLayout<R> layout(mesh);
  const R *s = law.s, *c = law.c;
  // The integral over y > length, upwards (side 1) or downwards (-1), of e^{side k y} g.
  const auto beyond = [=](R length, double side, double k) {
    R sum = 0.0;
    for (int q = 0; q < Mixture::size; ++q)
      sum += c[q] * exponential_integral((s[q] - side * (beta + k)) * length);
    return sum;
  };
  workers.each([=](int thread) {
    for (int k = thread; k < layout.size(); k += workers.threads()) w[k] = 0.0;
    for (int k = thread; k < nodes; k += workers.threads()) left[k] = left_price[k] = 0.0;
  });
  workers.each([=](int thread) {
    for (int d = 1 + thread; d <= mesh; d += workers.threads()) {
      const R near = d == 1 ? h : (d - 0.5) * h, far = (d + 0.5) * h;
      w[layout.place(d)] = beyond(near, 1.0, 0.0) - beyond(far, 1.0, 0.0);
      w[layout.place(-d)] = beyond(near, -1.0, 0.0) - beyond(far, -1.0, 0.0);
      if (d < mesh) {
        left[d] = beyond((d + 0.5) * h, -1.0, 0.0);
        left_price[d] = exponential((double(d) - grid.strike) * h) * beyond((d + 0.5) * h, -1.0, 1.0);
      }
    }
  });
  Jumps<R> jumps{};
  jumps.w = w;
  jumps.left = left;
  jumps.left_price = left_price;
  jumps.rate = beyond(h, 1.0, 0.0) + beyond(h, -1.0, 0.0);
  R small = law.variance;
  for (int q = 0; q < Mixture::size; ++q)
    for (int side = -1; side <= 1; side += 2) {
      const R decay = s[q] - double(side) * beta;
      small = small - c[q] * (h + 1.0 / decay) / decay * exponential(-decay * h);
    }
  jumps.diffusion = 0.5 * (put.variance + small);
  jumps.drift =
      put.rate - put.dividend - jumps.diffusion - (beyond(h, 1.0, 1.0) + beyond(h, -1.0, 1.0) - jumps.rate);
  return jumps;
}

/// The dissertation's scheme on `batch`: diffusion implicit, the rest explicit, steps of equal length, and
/// f = max(payoff, f) after each. What it leaves open is chosen here: epsilon = h and the domain.
template <class ExecutionSpace>
struct BaselineBatch {
  using Batch = PriceBatch<ExecutionSpace>;
  using R = typename Batch::R;
  using Member = typename Batch::Member;
  static constexpr int members = Batch::members;

  Batch batch;

  KOKKOS_FUNCTION void operator()(const Member& team) const { batch.template price_group<0>(*this, team); }

  template <class ThreadGroup>
  KOKKOS_INLINE_FUNCTION void price(const ThreadGroup& workers, const Memory<R, 0>& memory, int group) const {
    const int mesh = batch.mesh, steps = batch.steps, count = node_count(mesh),
              block = block_of(mesh, workers.lanes);
    workers.each([=, this](int thread) {
      for (int k = thread; k < members; k += workers.threads())
        memory.puts[k] = normalize(batch.contracts(batch.place(group, k)));
    });
    const PutPack<R> put = pack_puts<R>(memory.puts);
    const LevyMeasure<R> law = make_levy_measure(workers, put, memory.puts, batch.panels.data(),
                                                 batch.panel_slot.data(), memory.law_memory());
    const Grid<R> grid{mesh, R(2.0 * seed_reach / mesh), R(0.5 * mesh)};
    const Jumps<R> jumps =
        seed_jumps(workers, put, law, grid, memory.w, memory.row(9, mesh), memory.row(10, mesh));
    R *now = memory.row(0, mesh), *value = memory.row(1, mesh);
    R *sum = memory.row(2, mesh), *other = memory.row(3, mesh), *y = memory.row(4, mesh),
      *payoff = memory.row(5, mesh), *none = memory.row(6, mesh), *change = memory.row(7, mesh);
    workers.each([=](int thread) {
      for (int i = thread; i < count; i += workers.threads()) {
        const R paid = device::maximum(R(0.0), 1.0 - exponential((double(i) - grid.strike) * grid.h));
        payoff[i] = paid;
        value[i] = i < mesh ? paid : R(0.0);
        now[i] = change[i] = 0.0;
        none[i] = -unbounded;
      }
    });
    const R h = grid.h, dt = put.maturity * (1.0 / steps), lowest = -seed_reach;
    const R implicit = jumps.diffusion / (h * h), diagonal = 1.0 / dt + 2.0 * implicit;
    const R pivot = 0.5 * (diagonal + device::square_root(diagonal * diagonal - 4.0 * implicit * implicit));
    const R inverse = 1.0 / pivot, slope = 0.5 * jumps.drift / h, stay = -jumps.rate - put.rate;
    const R early = put.early;
    const auto deep = [=](R tau) {
      const Certain<R> late{exponential(-put.rate * tau), exponential(-put.dividend * tau)};
      return Certain<R>{device::select(early > R(0.0), R(1.0), late.strike),
                        device::select(early > R(0.0), R(1.0), late.asset)};
    };
    for (int n = 1; n <= steps; ++n) {
      convolve(workers, mesh, jumps.w, value, sum, other);
      const Certain<R> begun = deep(double(n - 1) * dt), ended = deep(double(n) * dt);
      workers.each([=, &jumps](int lane) {
        for (int i = lane * block; i < (lane + 1) * block; ++i) {
          if (i == 0 || i >= mesh) {
            y[i] = 0.0;
            continue;
          }
          const R outside = begun.strike * jumps.left[i] - begun.asset * jumps.left_price[i];
          const R right = value[i] / dt + slope * (value[i + 1] - value[i - 1]) + stay * value[i] +
                          (sum[i] + other[i]) + outside;
          y[i] = right * inverse;
        }
      });
      recur_backward(workers, {y}, block, implicit * inverse, memory.slot);
      const R edge = ended.strike - ended.asset * exponential(lowest);
      recur_forward(workers, now, y, none, block, mesh, implicit * inverse, edge, memory.slot);
      workers.each([=](int thread) {
        for (int i = 1 + thread; i < mesh; i += workers.threads()) {
          now[i] = device::select(early > R(0.0), device::maximum(payoff[i], now[i]), now[i]);
          change[i] = (now[i] - value[i]) / dt;
        }
      });
      R* const swapped = now;
      now = value;
      value = swapped;
    }
    workers.each([=, this](int thread) {
      for (int k = thread; k < members; k += workers.threads()) {
        if (group * members + k >= batch.count) continue;
        const int at = batch.place(group, k);
        const Column values{reinterpret_cast<const double*>(value) + k, members};
        const double width = 2.0 * seed_reach / mesh;
        const SolutionAtSpot answer =
            answer_of(memory.puts[k], values, {reinterpret_cast<const double*>(change) + k, members},
                      {mesh, mesh / 2, last_exercised(values, mesh / 2, width), width});
        Price price =
            price_of(batch.contracts(at), memory.puts[k], answer, answer, {}, 0.0, width, mesh, steps, 1.0);
        price.error = device::portable::not_a_number();
        batch.prices(at) = price;
      }
    });
  }
};

/// Enqueues the launch.
template <class ExecutionSpace>
void seed_batch(const ExecutionSpace& space, const PriceBatch<ExecutionSpace>& batch) {
  launch_batch<0>(space, "drogue::options::seed", BaselineBatch<ExecutionSpace>{batch});
}

}  // namespace drogue::options
