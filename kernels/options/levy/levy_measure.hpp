#pragma once

#include "kernels/options/levy/mixture.hpp"
#include "kernels/options/pide/thread_group.hpp"

namespace drogue::options {

/// Puts of a pack (one for R = double) as a structure of packs. All have the same model.
template <class R>
struct PutPack {
  JumpModel model;
  bool any_split;  ///< `split` holds for at least one member
  R early;         ///< `NormalizedPut::early` as 1 or 0
  R split;         ///< `NormalizedPut::split` as 1 or 0
  R log_spot, rate, dividend, maturity, variance;
  R jump[4];
};

/// Class of models that a kernel is compiled for. All contracts of a launch have one model. With the code of
/// one class only, a GPU compiler inlines the whole solve; otherwise it emits calls, which spill registers to
/// memory.
enum class JumpClass : unsigned char {
  any,          ///< all models
  mixture,      ///< generalized hyperbolic jumps, a mixture of exponentials
  closed_form,  ///< all other models
};

/// Calls f.operator()<jump_class>() with the class of `model`.
template <class F>
void dispatch_jump_class(JumpModel model, const F& f) {
  if (model == JumpModel::generalized_hyperbolic) return f.template operator()<JumpClass::mixture>();
  f.template operator()<JumpClass::closed_form>();
}

/// Packs as many puts as R has lanes.
template <class R, JumpClass jump_class = JumpClass::any>
KOKKOS_INLINE_FUNCTION PutPack<R> pack_puts(const NormalizedPut* puts) {
  PutPack<R> pack{};
  pack.model = jump_class == JumpClass::mixture ? JumpModel::generalized_hyperbolic : puts[0].model;
  if constexpr (jump_class == JumpClass::closed_form)
    device::assume(pack.model != JumpModel::generalized_hyperbolic);
  for (int k = 0; k < device::Access<R>::lanes; ++k) {
    const auto set = [k](R& number, double value) { reinterpret_cast<double*>(&number)[k] = value; };
    const NormalizedPut& put = puts[k];
    pack.any_split = pack.any_split || put.split;
    set(pack.early, put.early ? 1.0 : 0.0);
    set(pack.split, put.split ? 1.0 : 0.0);
    set(pack.log_spot, put.log_spot);
    set(pack.rate, put.rate);
    set(pack.dividend, put.dividend);
    set(pack.maturity, put.maturity);
    set(pack.variance, put.variance);
    for (int m = 0; m < 4; ++m) set(pack.jump[m], put.jump[m]);
  }
  return pack;
}

/// The puts, without early exercise unless `allowed`.
template <class R>
KOKKOS_INLINE_FUNCTION PutPack<R> with_exercise(PutPack<R> put, bool allowed) {
  if (!allowed) {
    put.any_split = false;
    put.early = put.split = 0.0;
  }
  return put;
}

/// Jumps of a pack of puts. The terms of a mixture are in scratch memory; other models have no terms.
template <class R>
struct LevyMeasure {
  R* s;        ///< decay rates, shape (Mixture::size)
  R* c;        ///< weights, 1/year, shape (Mixture::size)
  R* up;       ///< decay lengths of upward jumps, 1/(s - beta), shape (Mixture::low)
  R* down;     ///< decay lengths of downward jumps, 1/(s + beta), shape (Mixture::low)
  R variance;  ///< variance of the jumps per year
  R high;      ///< the part of `variance` due to the terms from Mixture::low on
};

/// Exponential decay rate of the density of upward jumps. Merton's density decays faster than any
/// exponential; its value limits no Esscher tilt.
template <class R>
KOKKOS_INLINE_FUNCTION R decay_up(const PutPack<R>& put) {
  if (put.model == JumpModel::generalized_hyperbolic) return put.jump[1] - put.jump[2];
  return put.model == JumpModel::kou ? put.jump[2] : R(1e4);
}
/// As `decay_up`, for downward jumps.
template <class R>
KOKKOS_INLINE_FUNCTION R decay_down(const PutPack<R>& put) {
  if (put.model == JumpModel::generalized_hyperbolic) return put.jump[1] + put.jump[2];
  return put.model == JumpModel::kou ? put.jump[3] : R(1e4);
}

/// Computes the mixture terms of all puts of a pack into `memory`, which is scratch memory, and the variance
/// of their jumps. Collective over the thread group.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION LevyMeasure<R> make_levy_measure(const ThreadGroup& group, const PutPack<R>& pack,
                                                        const NormalizedPut* puts, const double* panels,
                                                        const int* panel_slot, const LevyMeasure<R>& memory) {
  constexpr int members = device::Access<R>::lanes;
  LevyMeasure<R> measure = memory;
  R *s = measure.s, *c = measure.c, *up_lengths = measure.up, *down_lengths = measure.down;
  if (pack.model == JumpModel::generalized_hyperbolic) {
    group.each([=](int thread) {
      for (int k = 0; k < members; ++k) {
        const MixtureGrid grid = mixture_grid(puts[k], panels, panel_slot);
        for (int q = thread; q < Mixture::size; q += group.threads()) {
          const MixtureTerm term = mixture_term(puts[k], grid, q);
          reinterpret_cast<double*>(s + q)[k] = term.rate;
          reinterpret_cast<double*>(c + q)[k] = term.weight;
        }
      }
    });
    const R up = -pack.jump[2], down = pack.jump[2];
    const Kokkos::Array<R, 2> variance = sums(group, [=](int lane) {
      Kokkos::Array<R, 2> sum = {R(0.0), R(0.0)};
      for (int q = lane; q < Mixture::size; q += group.lanes) {
        const R a = device::reciprocal(s[q] + up), b = device::reciprocal(s[q] + down);
        sum[q < Mixture::low ? 0 : 1] += c[q] * (a * a + b * b);
        if (q >= Mixture::low || !group.is_writer()) continue;
        up_lengths[q] = a;
        down_lengths[q] = b;
      }
      return sum;
    });
    group.sync();
    measure.high = variance[1];
    measure.variance = variance[0] + variance[1];
  } else if (pack.model == JumpModel::merton) {
    measure.variance = pack.jump[0] * (pack.jump[1] * pack.jump[1] + pack.jump[2] * pack.jump[2]);
  } else if (pack.model == JumpModel::kou) {
    const R p = pack.jump[1], a = 1.0 / pack.jump[2], b = 1.0 / pack.jump[3];
    measure.variance = 2.0 * pack.jump[0] * (p * a * a + (1.0 - p) * b * b);
  }
  return measure;
}

/// Standard deviation of Merton's jumps, bounded away from 0.
template <class R>
KOKKOS_INLINE_FUNCTION R merton_deviation(const PutPack<R>& put) {
  return device::maximum(put.jump[2], R(1e-9));
}

/// Integral of (e^{theta y} - 1 - theta y) g(y) dy, 1/year; relative error 1e-8 for a mixture.
template <class R>
KOKKOS_INLINE_FUNCTION R jump_cumulant(const PutPack<R>& put, const LevyMeasure<R>& measure, R theta) {
  if (put.model == JumpModel::merton) {
    const R m = put.jump[1], d = put.jump[2];
    return put.jump[0] * (exponential(theta * (m + 0.5 * theta * d * d)) - 1.0 - theta * m);
  }
  if (put.model == JumpModel::kou) {
    const R p = put.jump[1], up = put.jump[2], down = put.jump[3];
    const R a = theta / (up - theta), b = theta / (down + theta);
    return put.jump[0] * (p * (a - theta / up) - (1.0 - p) * (b - theta / down));
  }
  if (put.model == JumpModel::black_scholes) return R(0.0);
  R sum = 0.5 * theta * theta * measure.high;
  constexpr int chains = 4;  // independent chains hide latency
  static_assert(Mixture::low % chains == 0);
  for (int q = 0; q < Mixture::low; q += chains) {
    R term[chains];
    for (int i = 0; i < chains; ++i) {
      const R a = theta * measure.up[q + i], b = theta * measure.down[q + i];
      term[i] = measure.c[q + i] * (b - a - rough_logarithm((1.0 - a) * (1.0 + b)));
    }
    for (int i = 0; i < chains; ++i) sum += term[i];
  }
  return sum;
}

}  // namespace drogue::options
