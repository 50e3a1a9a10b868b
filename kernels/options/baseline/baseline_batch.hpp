#pragma once

#include "kernels/options/batch/price_batch.hpp"

namespace drogue::options {

/// Half width of the grid of [Shi] in x = ln(spot/strike), with the strike in the middle.
inline constexpr double baseline_half_width = 4.0;

/// Jumps of [Shi], section 4.6.2: all integrals over |y| > epsilon = h are sums of nodal values h g(k h), of
/// which those at k = -1 and 1 count half. Beyond the last node of a sum the integral is exact, as are
/// `jumps.exit_mass` and `exit_price`, the B_l of Listing 4.6 for jumps to below the grid. The variance of
/// the jumps within epsilon is diffusion. Values above the grid are 0.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION Jumps<R> baseline_jumps(const ThreadGroup& group, const PutPack<R>& put,
                                               const LevyMeasure<R>& measure, const Grid<R>& grid, R* w,
                                               R* exit_mass, R* exit_price) {
  const int mesh = grid.mesh, nodes = node_count(mesh);
  const R h = grid.h, beta = put.jump[2];
  const WeightLayout<R> layout(mesh);
  const R *s = measure.s, *c = measure.c;
  // Integral of e^{side k y} g over y > length, upwards (side 1) or downwards (-1).
  const auto beyond = [=](R length, double side, double k) {
    R sum = 0.0;
    for (int q = 0; q < Mixture::size; ++q)
      sum += c[q] * exponential_integral((s[q] - side * (beta + k)) * length);
    return sum;
  };
  group.each([=](int thread) {
    for (int k = thread; k < layout.size(); k += group.threads()) w[k] = 0.0;
    for (int k = thread; k < nodes; k += group.threads()) exit_mass[k] = exit_price[k] = 0.0;
  });
  group.each([=](int thread) {
    for (int d = 1 + thread; d <= mesh; d += group.threads()) {
      R up = 0.0, down = 0.0;
      for (int q = 0; q < Mixture::size; ++q) {
        up += c[q] * exponential((beta - s[q]) * (double(d) * h));
        down += c[q] * exponential((-beta - s[q]) * (double(d) * h));
      }
      const double part = (d == 1 ? 0.5 : 1.0) / d;
      w[layout.place(d)] = part * up;
      w[layout.place(-d)] = part * down;
      if (d < mesh) {
        exit_mass[d] = beyond((d + 0.5) * h, -1.0, 0.0);
        exit_price[d] = exponential((double(d) - grid.strike) * h) * beyond((d + 0.5) * h, -1.0, 1.0);
      }
    }
  });
  const Kokkos::Array<R, 2> nodal = sums(group, [=](int lane) {
    R rate = 0.0, price = 0.0;
    for (int d = 1 + lane; d <= mesh; d += group.lanes) {
      const R up = w[layout.place(d)], down = w[layout.place(-d)], growth = exponential(double(d) * h);
      rate += up + down;
      price += (growth - 1.0) * (up - down * device::reciprocal(growth));
    }
    return Kokkos::Array<R, 2>{rate, price};
  });
  const R end = (mesh + 0.5) * h;
  const R tails = beyond(end, 1.0, 0.0) + beyond(end, -1.0, 0.0);
  Jumps<R> jumps{};
  jumps.w = w;
  jumps.exit_mass = exit_mass;
  jumps.exit_price = exit_price;
  jumps.rate = nodal[0] + tails;
  R small_variance = measure.variance;
  for (int q = 0; q < Mixture::size; ++q)
    for (int side = -1; side <= 1; side += 2) {
      const R decay = s[q] - double(side) * beta;
      small_variance = small_variance - c[q] * (h + 1.0 / decay) / decay * exponential(-decay * h);
    }
  jumps.diffusion = 0.5 * (put.variance + small_variance);
  jumps.drift = put.rate - put.dividend - jumps.diffusion -
                (nodal[1] + beyond(end, 1.0, 1.0) + beyond(end, -1.0, 1.0) - tails);
  return jumps;
}

/// Scheme of [Shi], Listing 4.6, for `batch`: implicit diffusion, explicit remainder, equal steps, and f =
/// max(payoff, f) after each. epsilon = h and the domain are choices of this implementation. Provides no
/// error estimate: `Price::error` is NaN.
template <class ExecutionSpace>
struct BaselineBatch {
  using Batch = PriceBatch<ExecutionSpace>;
  using R = typename Batch::R;
  using Member = typename Batch::Member;
  static constexpr int members = Batch::members;

  Batch batch;

  KOKKOS_FUNCTION void operator()(const Member& team) const { batch.template price_pack<0>(*this, team); }

  template <class ThreadGroup>
  KOKKOS_INLINE_FUNCTION void price(const ThreadGroup& group, const SolveMemory<R, 0>& memory,
                                    int pack) const {
    const int mesh = batch.mesh, steps = batch.steps, count = node_count(mesh),
              block = block_of(mesh, group.lanes);
    group.each([=, this](int thread) {
      for (int k = thread; k < members; k += group.threads())
        memory.puts[k] = normalize(batch.contracts(batch.contract_index(pack, k)));
    });
    const PutPack<R> put = pack_puts<R>(memory.puts);
    const LevyMeasure<R> measure = make_levy_measure(group, put, memory.puts, batch.panels.data(),
                                                     batch.panel_slot.data(), memory.measure_memory());
    const Grid<R> grid{mesh, R(2.0 * baseline_half_width / mesh), R(0.5 * mesh)};
    const Jumps<R> jumps =
        baseline_jumps(group, put, measure, grid, memory.w, memory.row(9, mesh), memory.row(10, mesh));
    R *now = memory.row(0, mesh), *value = memory.row(1, mesh);
    R *sum = memory.row(2, mesh), *second_half = memory.row(3, mesh), *y = memory.row(4, mesh),
      *payoff = memory.row(5, mesh), *no_floor = memory.row(6, mesh), *time_derivative = memory.row(7, mesh);
    group.each([=](int thread) {
      for (int i = thread; i < count; i += group.threads()) {
        const R paid = device::maximum(R(0.0), 1.0 - exponential((double(i) - grid.strike) * grid.h));
        payoff[i] = paid;
        value[i] = i < mesh ? paid : R(0.0);
        now[i] = time_derivative[i] = 0.0;
        no_floor[i] = -unbounded;
      }
    });
    const R h = grid.h, dt = put.maturity * (1.0 / steps), lowest = -baseline_half_width;
    const R implicit = jumps.diffusion / (h * h), diagonal = 1.0 / dt + 2.0 * implicit;
    const R pivot = 0.5 * (diagonal + device::square_root(diagonal * diagonal - 4.0 * implicit * implicit));
    const R inverse = 1.0 / pivot, slope = 0.5 * jumps.drift / h, reaction = -jumps.rate - put.rate;
    const R early = put.early;
    const auto left_discount = [=](R tau) {
      const DiscountFactors<R> late{exponential(-put.rate * tau), exponential(-put.dividend * tau)};
      return DiscountFactors<R>{device::select(early > R(0.0), R(1.0), late.strike),
                                device::select(early > R(0.0), R(1.0), late.asset)};
    };
    for (int n = 1; n <= steps; ++n) {
      convolve(group, mesh, jumps.w, value, sum, second_half);
      const DiscountFactors<R> discount = left_discount(double(n - 1) * dt),
                               ended = left_discount(double(n) * dt);
      group.each([=, &jumps](int lane) {
        for (int i = lane * block; i < (lane + 1) * block; ++i) {
          if (i == 0 || i >= mesh) {
            y[i] = 0.0;
            continue;
          }
          const R outside = discount.strike * jumps.exit_mass[i] - discount.asset * jumps.exit_price[i];
          const R right = value[i] / dt + slope * (value[i + 1] - value[i - 1]) + reaction * value[i] +
                          (sum[i] + second_half[i]) + outside;
          y[i] = right * inverse;
        }
      });
      recur_backward(group, {y}, block, implicit * inverse, memory.scratch);
      const R left_value = ended.strike - ended.asset * exponential(lowest);
      recur_forward(group, now, y, no_floor, block, mesh, implicit * inverse, left_value, memory.scratch);
      group.each([=](int thread) {
        for (int i = 1 + thread; i < mesh; i += group.threads()) {
          now[i] = device::select(early > R(0.0), device::maximum(payoff[i], now[i]), now[i]);
          time_derivative[i] = (now[i] - value[i]) / dt;
        }
      });
      R* const swapped = now;
      now = value;
      value = swapped;
    }
    group.each([=, this](int thread) {
      for (int k = thread; k < members; k += group.threads()) {
        if (pack * members + k >= batch.count) continue;
        const int at = batch.contract_index(pack, k);
        const MemberValues values{reinterpret_cast<const double*>(value) + k, members};
        const double width = 2.0 * baseline_half_width / mesh;
        const SolutionAtSpot solution = solution_at_spot(
            memory.puts[k], values, {reinterpret_cast<const double*>(time_derivative) + k, members},
            {mesh, mesh / 2, last_exercised(values, mesh / 2, width), width});
        Price price = price_of(batch.contracts(at), memory.puts[k], solution, solution, {}, 0.0, width, mesh,
                               steps, 1.0);
        price.error = device::portable::not_a_number();
        batch.prices(at) = price;
      }
    });
  }
};

/// Enqueues the launch; asynchronous.
template <class ExecutionSpace>
void price_baseline(const ExecutionSpace& space, const PriceBatch<ExecutionSpace>& batch) {
  launch_batch<0>(space, "drogue::options::baseline", BaselineBatch<ExecutionSpace>{batch});
}

}  // namespace drogue::options
