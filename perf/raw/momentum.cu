#include "perf/raw/momentum.hpp"

#include "perf/raw/device.cuh"

namespace drogue::perf::raw {

namespace {

constexpr int tile_x = 32, tile_y = 4;

/// Value at a face from three cells upwind and two downwind of it (Borges et al. 2008), in difference form.
__device__ double upwind_face_value(double m2, double m1, double q0, double p1, double p2, double epsilon) {
  const double a = m1 - m2, b = q0 - m1, c = p1 - q0, d = p2 - p1;
  const double left = a - 1.375 * b, middle = b - 0.625 * c, right = d - 1.375 * c;
  const double b_part = 0.609375 * (b * b) + epsilon, c_part = 0.609375 * (c * c) + epsilon;
  const double b0 = left * left + b_part, b1 = middle * middle + c_part, b2 = right * right + c_part;
  const double tau = fabs(b0 - b2);
  const double r0 = (b0 + tau) * (b1 * b2), r1 = (b1 + tau) * (b0 * b2), r2 = (b2 + tau) * (b0 * b1);
  const double w1 = 6.0 * r1, w2 = 3.0 * r2;
  const double sum = r0 + (w1 + w2);
  const double increment = r0 * (5.0 * b - 2.0 * a) + (w1 * (b + 2.0 * c) + w2 * (4.0 * c - d));
  return q0 + increment * reciprocal(6.0 * sum);
}

/// Flux of momentum component c through the low face along d of its control volume, per density, m^2/s^2.
__device__ double flux(const Momentum& p, int c, int d, std::int64_t at) {
  const double *q = p.stage + c * p.component + at, *carrier = p.stage + d * p.component + at;
  const std::int64_t stride = p.stride[d], along = p.n[c] > 1 ? p.stride[c] : 0;
  const double speed = 0.5 * (__ldg(carrier - along) + __ldg(carrier));
  const double q_m1 = __ldg(q - stride), q_0 = __ldg(q);
  const double q_m3 = __ldg(q - 3 * stride), q_m2 = __ldg(q - 2 * stride), q_1 = __ldg(q + stride),
               q_2 = __ldg(q + 2 * stride);
  const bool forward = speed > 0.0;
  const double carried =
      upwind_face_value(forward ? q_m3 : q_2, forward ? q_m2 : q_1, forward ? q_m1 : q_0,
                        forward ? q_0 : q_m1, forward ? q_1 : q_m2, p.epsilon);
  return speed * carried - p.nu * p.inverse_h[d] * (q_0 - q_m1);
}

__global__ void __launch_bounds__(tile_x* tile_y, 4) momentum_stage(const __grid_constant__ Momentum p, int tiles_x, int tiles_y) {
  if (p.control->stopped != 0) return;
  const double dt = p.control->dt, last_dt = p.control->last_dt;
  const double half_ratio = last_dt > 0.0 ? 0.5 * dt / last_dt : 0.0;
  const double of_rate = (1.0 + half_ratio) * dt, of_old_rate = -half_ratio * dt;
  const double of_force = dt * p.specific_volume;
  const int tile = static_cast<int>(blockIdx.x), thread = static_cast<int>(threadIdx.x);
  const int i = tile % tiles_x * tile_x + thread % tile_x;
  const int j = tile / tiles_x % tiles_y * tile_y + thread / tile_x;
  const int k_begin = tile / (tiles_x * tiles_y) * p.planes;
  if (i >= p.n[0] || j >= p.n[1]) return;
  const int k_end = min(k_begin + p.planes, p.n[2]);
  std::int64_t at = p.first + i + j * p.stride[1] + k_begin * p.stride[2];
  double below[3] = {0.0, 0.0, 0.0};
  if (p.n[2] > 1)
    for (int c = 0; c < 3; ++c) below[c] = flux(p, c, 2, at);
  for (int k = k_begin; k < k_end; ++k, at += p.stride[2]) {
    double value[3], rates[3];
#pragma unroll 1  // code for three components would not fit the instruction cache
    for (int c = 0; c < 3; ++c) {
      const std::int64_t place = c * p.component + at;
      const double other = of_old_rate * p.old_rate[place];
      double rate = p.acceleration[c];
      if (p.n[0] > 1) rate -= p.inverse_h[0] * (flux(p, c, 0, at + p.stride[0]) - flux(p, c, 0, at));
      if (p.n[1] > 1) rate -= p.inverse_h[1] * (flux(p, c, 1, at + p.stride[1]) - flux(p, c, 1, at));
      if (p.n[2] > 1) {
        const double above = flux(p, c, 2, at + p.stride[2]);
        rate -= p.inverse_h[2] * (above - below[c]);
        below[c] = above;
      }
      if (p.eddy != nullptr) rate += p.eddy[place];
      value[c] = __ldg(p.stage + place) + of_rate * rate;
      // A store here would hold back the loads of the next component.
      rates[c] = rate;
      value[c] += other;
    }
    for (int c = 0; c < 3; ++c) {
      const std::int64_t place = c * p.component + at;
      if (p.force != nullptr) value[c] += of_force * p.force[place];
      p.old_rate[place] = rates[c];
      p.out[place] = value[c];
    }
  }
}

}  // namespace

void launch_momentum(const Momentum& momentum, Stream stream) {
  const auto parts = [](int n, int size) { return (n + size - 1) / size; };
  const int tiles_x = parts(momentum.n[0], tile_x), tiles_y = parts(momentum.n[1], tile_y);
  const auto blocks = static_cast<unsigned>(tiles_x * tiles_y * parts(momentum.n[2], momentum.planes));
  momentum_stage<<<blocks, tile_x * tile_y, 0, stream>>>(momentum, tiles_x, tiles_y);
  check_launch("momentum stage");
}

}  // namespace drogue::perf::raw
