#pragma once

#include "kernels/options/levy/mixture.hpp"
#include "kernels/options/pide/thread_group.hpp"

namespace drogue::options {

/// The puts of a pack (one for R = double), member by member; all have the same model.
template <class R>
struct PutPack {
  Model model;
  bool any_split;
  R early;  ///< 1 or 0, as the next
  R split;
  R log_spot, rate, dividend, maturity, variance;
  R jump[4];
};

/// The laws that a kernel is compiled for. All contracts of a launch have one model, and without the others'
/// code a GPU's compiler inlines all of a solve: of what is too much for that it makes calls, which keep
/// everything in memory.
enum class Laws : unsigned char { all, mixtures, closed_forms };

/// Calls f.operator()<laws>() for the laws that a model belongs to.
template <class F>
void for_laws_of(Model model, const F& f) {
  if (model == Model::generalized_hyperbolic) return f.template operator()<Laws::mixtures>();
  f.template operator()<Laws::closed_forms>();
}

template <class R, Laws laws = Laws::all>
KOKKOS_INLINE_FUNCTION PutPack<R> pack_of(const NormalizedPut* puts) {
  PutPack<R> pack{};
  pack.model = laws == Laws::mixtures ? Model::generalized_hyperbolic : puts[0].model;
  if constexpr (laws == Laws::closed_forms) device::assume(pack.model != Model::generalized_hyperbolic);
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

/// The puts, or the same without early exercise.
template <class R>
KOKKOS_INLINE_FUNCTION PutPack<R> with_exercise(PutPack<R> put, bool allowed) {
  if (!allowed) {
    put.any_split = false;
    put.early = put.split = 0.0;
  }
  return put;
}

/// What a pack's jumps are made of. Terms of a mixture are in scratch memory; the other models have none.
template <class R>
struct LevyMeasure {
  R* s;        ///< (Mixture::size): rates
  R* c;        ///< (Mixture::size): weights
  R* up;       ///< (Mixture::low): 1/(s - beta), the length at which a term decays upwards
  R* down;     ///< (Mixture::low): 1/(s + beta), downwards
  R variance;  ///< of the jumps, a year
  R high;      ///< what terms from Mixture::low on contribute to it
};

/// Rates at which the density of the jumps decays upwards and downwards; of Merton's none limits a tilt.
template <class R>
KOKKOS_INLINE_FUNCTION R decay_up(const PutPack<R>& put) {
  if (put.model == Model::generalized_hyperbolic) return put.jump[1] - put.jump[2];
  return put.model == Model::kou ? put.jump[2] : R(1e4);
}
template <class R>
KOKKOS_INLINE_FUNCTION R decay_down(const PutPack<R>& put) {
  if (put.model == Model::generalized_hyperbolic) return put.jump[1] + put.jump[2];
  return put.model == Model::kou ? put.jump[3] : R(1e4);
}

/// Puts the terms of all members of a pack into `memory`, scratch memory, and sums the variance.
template <class ThreadGroup, class R>
KOKKOS_INLINE_FUNCTION LevyMeasure<R> law_of(const ThreadGroup& workers, const PutPack<R>& pack,
                                             const NormalizedPut* puts, const double* panels,
                                             const int* panel_slot, const LevyMeasure<R>& memory) {
  constexpr int members = device::Access<R>::lanes;
  LevyMeasure<R> law = memory;
  R *s = law.s, *c = law.c, *ups = law.up, *downs = law.down;
  if (pack.model == Model::generalized_hyperbolic) {
    workers.each([=](int thread) {
      for (int k = 0; k < members; ++k) {
        const MixtureGrid grid = mixture_grid(puts[k], panels, panel_slot);
        for (int q = thread; q < Mixture::size; q += workers.threads()) {
          const Term term = mixture_term(puts[k], grid, q);
          reinterpret_cast<double*>(s + q)[k] = term.rate;
          reinterpret_cast<double*>(c + q)[k] = term.weight;
        }
      }
    });
    const R up = -pack.jump[2], down = pack.jump[2];
    const Kokkos::Array<R, 2> variance = sums(workers, [=](int lane) {
      Kokkos::Array<R, 2> sum = {R(0.0), R(0.0)};
      for (int q = lane; q < Mixture::size; q += workers.lanes) {
        const R a = device::reciprocal(s[q] + up), b = device::reciprocal(s[q] + down);
        sum[q < Mixture::low ? 0 : 1] += c[q] * (a * a + b * b);
        if (q >= Mixture::low || !workers.is_writer()) continue;
        ups[q] = a;
        downs[q] = b;
      }
      return sum;
    });
    workers.sync();
    law.high = variance[1];
    law.variance = variance[0] + variance[1];
  } else if (pack.model == Model::merton) {
    law.variance = pack.jump[0] * (pack.jump[1] * pack.jump[1] + pack.jump[2] * pack.jump[2]);
  } else if (pack.model == Model::kou) {
    const R p = pack.jump[1], a = 1.0 / pack.jump[2], b = 1.0 / pack.jump[3];
    law.variance = 2.0 * pack.jump[0] * (p * a * a + (1.0 - p) * b * b);
  }
  return law;
}

/// The deviation of Merton's jumps; they may all be alike.
template <class R>
KOKKOS_INLINE_FUNCTION R merton_deviation(const PutPack<R>& put) {
  return device::maximum(put.jump[2], R(1e-9));
}

/// The integral of (e^{theta y} - 1 - theta y) g(y) dy, a year; a mixture's to 1e-8.
template <class R>
KOKKOS_INLINE_FUNCTION R jump_cumulant(const PutPack<R>& put, const LevyMeasure<R>& law, R theta) {
  if (put.model == Model::merton) {
    const R m = put.jump[1], d = put.jump[2];
    return put.jump[0] * (exponential(theta * (m + 0.5 * theta * d * d)) - 1.0 - theta * m);
  }
  if (put.model == Model::kou) {
    const R p = put.jump[1], up = put.jump[2], down = put.jump[3];
    const R a = theta / (up - theta), b = theta / (down + theta);
    return put.jump[0] * (p * (a - theta / up) - (1.0 - p) * (b - theta / down));
  }
  if (put.model == Model::black_scholes) return R(0.0);
  R sum = 0.5 * theta * theta * law.high;
  constexpr int at_once = 4;  // terms that do not wait for one another
  static_assert(Mixture::low % at_once == 0);
  for (int q = 0; q < Mixture::low; q += at_once) {
    R term[at_once];
    for (int i = 0; i < at_once; ++i) {
      const R a = theta * law.up[q + i], b = theta * law.down[q + i];
      term[i] = law.c[q + i] * (b - a - rough_logarithm((1.0 - a) * (1.0 + b)));
    }
    for (int i = 0; i < at_once; ++i) sum += term[i];
  }
  return sum;
}

}  // namespace drogue::options
