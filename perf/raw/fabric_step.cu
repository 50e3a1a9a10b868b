#include "perf/raw/fabric_step.hpp"

#include "perf/raw/device.cuh"

namespace drogue::perf::raw {

namespace {

constexpr int slice = 32, threads = 128;
constexpr unsigned all_lanes = ~0U;

struct Vector {
  double x, y, z;
};

__device__ Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
__device__ Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
__device__ Vector operator*(double s, const Vector& a) { return {s * a.x, s * a.y, s * a.z}; }
__device__ double dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

__device__ Vector point(const double* points, int vertices, int i) {
  return {points[i], points[vertices + i], points[2 * vertices + i]};
}
__device__ void store(double* points, int vertices, int i, const Vector& value) {
  points[i] = value.x, points[vertices + i] = value.y, points[2 * vertices + i] = value.z;
}

/// Positions of a stage that lie in memory.
struct Stored {
  const double* x;
  __device__ Vector at(int vertices, int i) const { return point(x, vertices, i); }
};

/// Positions of a stage that follow from those and the velocities of the step's start.
struct Extrapolated {
  const double *x, *v;
  double time;  ///< s
  __device__ Vector at(int vertices, int i) const {
    return point(x, vertices, i) + time * point(v, vertices, i);
  }
};

/// Edge from a vertex to a neighbour, m, and its squared length, m^2.
struct Edge {
  Vector to;
  double squared;
};

__device__ Edge edge(const Vector& to) { return {to, dot(to, to)}; }

/// Edges to a neighbour in both states and at rest.
struct Side {
  Edge first, second, rest;
};

/// Force of a triangle on its first vertex, N.
__device__ Vector pull(const FabricStep& p, const Edge& j, const Edge& k, double rest_jj, double rest_jk,
                       double rest_kk, double inverse_area) {
  const double jj = j.squared - rest_jj, jk = dot(j.to, k.to) - rest_jk, kk = k.squared - rest_kk;
  const double volumetric = (0.03125 * (p.lambda + p.two_g)) * (inverse_area * inverse_area) *
                            (rest_kk * jj + rest_jj * kk - (rest_jk + rest_jk) * jk);
  const double shear = 0.125 * p.two_g;
  const double tension_j = inverse_area * (volumetric * (rest_kk - rest_jk) + shear * (jk - kk));
  const double tension_k = inverse_area * (volumetric * (rest_jj - rest_jk) + shear * (jk - jj));
  return tension_j * j.to + tension_k * k.to;
}

/// Force of a spring on its vertex, N.
__device__ Vector spring_force(double stiffness, double length, const Vector& to) {
  const double squared = dot(to, to);
  const double tension = squared > 0.0 ? stiffness * (1.0 - length / sqrt(squared)) : 0.0;
  return tension * to;
}

/// Spring of a slot.
struct Spring {
  double stiffness, length;
  Vector to;
};

template <class Positions>
__device__ Spring spring_at(const FabricStep& p, const Positions& positions, int i, int slot) {
  const SlicedEll& s = p.springs;
  return {s.value[slot], s.value[s.slots + slot],
          positions.at(p.vertices, s.neighbour[slot]) - positions.at(p.vertices, i)};
}

/// `sum` plus the forces of all springs on vertex i, N. A warp shares the springs of a vertex beyond a dozen.
template <class Positions>
__device__ Vector with_springs(const FabricStep& p, const Positions& positions, int i, Vector sum) {
  constexpr int most_own = 12, ahead = 4;
  const int lane = i % slice, begin = p.springs.first[i / slice], end = p.springs.first[i / slice + 1],
            shared = min(begin + most_own, end);
  for (int k = begin; k < shared; k += ahead) {
    Spring springs[ahead];
    for (int n = 0; n < ahead; ++n) springs[n] = spring_at(p, positions, i, min(k + n, shared - 1) * slice + lane);
    for (int n = 0; n < ahead; ++n)
      if (k + n < shared) sum = sum + spring_force(springs[n].stiffness, springs[n].length, springs[n].to);
  }
  if (shared == end) return sum;
  unsigned rows = __ballot_sync(all_lanes, p.springs.neighbour[shared * slice + lane] != i ? 1 : 0);
  for (int row = 0; rows != 0U; ++row, rows >>= 1U) {
    if ((rows & 1U) == 0U) continue;
    for (int k = shared; k < end; k += slice) {
      Vector own{0.0, 0.0, 0.0};
      if (k + lane < end) {
        const Spring spring = spring_at(p, positions, i - lane + row, (k + lane) * slice + row);
        own = spring_force(spring.stiffness, spring.length, spring.to);
      }
      for (int n = 0; n < slice && k + n < end; ++n) {
        const Vector of_lane{__shfl_sync(all_lanes, own.x, n), __shfl_sync(all_lanes, own.y, n),
                             __shfl_sync(all_lanes, own.z, n)};
        if (lane == row) sum = sum + of_lane;
      }
    }
  }
  return sum;
}

/// Elastic forces and dead load on vertex i in two states, N.
struct Forces {
  Vector first, second;
};

template <class First, class Second>
__device__ Forces forces(const FabricStep& p, const First& first, const Second& second, int i) {
  const int n = p.vertices;
  Forces sum{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
  const Vector own_first = first.at(n, i), own_second = second.at(n, i);
  const auto read = [&](int neighbour) -> Side {
    return {edge(first.at(n, neighbour) - own_first), edge(second.at(n, neighbour) - own_second),
            edge(point(p.rest, n, neighbour) - point(p.rest, n, i))};
  };
  const int begin = p.ring.first[i / slice], end = p.ring.first[i / slice + 1];
  if (begin != end) {
    const int last = (end - 1) * slice + i % slice;
    int slot = begin * slice + i % slice;
    Side j = read(p.ring.neighbour[slot]);
    // Neighbours are read one slot ahead, so that two dependent memory latencies overlap.
    int ahead = p.ring.neighbour[min(slot + slice, last)];
#pragma unroll 2
    for (slot += slice; slot <= last; slot += slice) {
      const Side k = read(ahead);
      ahead = p.ring.neighbour[min(slot + slice, last)];
      const double jj = j.rest.squared, jk = dot(j.rest.to, k.rest.to), kk = k.rest.squared;
      const double squared = jj * kk - jk * jk;
      const double inverse_area = squared > 0.0 ? 2.0 * root(squared).inverse : 0.0;
      sum.first = sum.first + pull(p, j.first, k.first, jj, jk, kk, inverse_area);
      sum.second = sum.second + pull(p, j.second, k.second, jj, jk, kk, inverse_area);
      j = k;
    }
  }
  return {with_springs(p, first, i, sum.first), with_springs(p, second, i, sum.second)};
}

/// Acceleration of vertex i by the elastic force `elastic`, its load, gravity and damping, m/s^2.
__device__ Vector acceleration(const FabricStep& p, const Vector& elastic, const Vector& now, int i) {
  const Vector force = p.load != nullptr ? elastic + point(p.load, p.vertices, i) : elastic;
  const Vector g{p.gravity[0], p.gravity[1], p.gravity[2]};
  const Vector a = p.inverse_mass[i] * force + g - p.damping * now;
  const unsigned fixed = p.fixed_axes[i];
  return {((fixed & 1U) != 0U ? 0.0 : 1.0) * a.x, ((fixed & 2U) != 0U ? 0.0 : 1.0) * a.y,
          ((fixed & 4U) != 0U ? 0.0 : 1.0) * a.z};
}

/// First two stages.
__global__ void __launch_bounds__(threads, 4) fabric_begin(const __grid_constant__ FabricStep p) {
  const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x), n = p.vertices;
  if (i >= n) return;
  const Extrapolated second{p.x, p.v, 0.5 * p.dt};
  const Forces force = forces(p, Stored{p.x}, second, i);
  const Vector v_n = point(p.v, n, i);
  const Vector v2 = v_n + (0.5 * p.dt) * acceleration(p, force.first, v_n, i);
  const Vector v3 = v_n + (0.5 * p.dt) * acceleration(p, force.second, v2, i);
  const Vector x_n = point(p.x, n, i);
  store(p.third, n, i, x_n + (0.5 * p.dt) * v2);
  store(p.fourth, n, i, x_n + (1.0 * p.dt) * v3);
  store(p.velocity[0], n, i, v2);
  store(p.velocity[1], n, i, v3);
  if (i == 0) p.count.steps[1] = p.count.steps[0];
}

/// Last two stages and the new state.
__global__ void __launch_bounds__(threads, 4) fabric_end(const __grid_constant__ FabricStep p) {
  const int i = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x), n = p.vertices;
  if (i >= n) return;
  const Forces force = forces(p, Stored{p.third}, Stored{p.fourth}, i);
  const Vector v_n = point(p.v, n, i), v2 = point(p.velocity[0], n, i), v3 = point(p.velocity[1], n, i);
  const Vector v4 = v_n + (1.0 * p.dt) * acceleration(p, force.first, v3, i);
  const Vector a4 = acceleration(p, force.second, v4, i);
  const Vector x = point(p.x, n, i) + (p.dt / 6.0) * (v_n + 2.0 * (v2 + v3) + v4);
  const Vector gained = (v2 - v_n) + 2.0 * (v3 - v_n) + (v4 - v_n);
  const Vector v = v_n + ((1.0 / 3.0) * gained + (p.dt / 6.0) * a4);
  store(p.x, n, i, x);
  store(p.v, n, i, v);
  const std::int64_t step = p.count.steps[1] + 1;
  const double size = fabs(x.x) + fabs(x.y) + fabs(x.z) + fabs(v.x) + fabs(v.y) + fabs(v.z);
  if (!(size < 1e100))
    atomicMin(p.count.first_failure,
              static_cast<unsigned long long>(step) << 31U | static_cast<unsigned long long>(i));
  if (i == 0) p.count.steps[0] = step;
}

}  // namespace

void launch_fabric_step(const FabricStep& step, Stream stream) {
  const auto blocks = static_cast<unsigned>((step.vertices + threads - 1) / threads);
  fabric_begin<<<blocks, threads, 0, stream>>>(step);
  check_launch("fabric step, first half");
  fabric_end<<<blocks, threads, 0, stream>>>(step);
  check_launch("fabric step, second half");
}

}  // namespace drogue::perf::raw
