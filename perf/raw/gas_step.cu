#include "perf/raw/gas_step.hpp"

#include "perf/raw/device.cuh"

namespace drogue::perf::raw {

namespace {

constexpr int ghosts = 3;
constexpr int outflow = 0, periodic = 2;          // gas::Boundary
constexpr int arithmetic = 0, conserved = 1;      // gas::FaceAverage
constexpr unsigned density = 0, pressure_of = 1;  // gas::FailureReason
constexpr unsigned not_finite = 2;

/// Rows of shared memory: cell values, then three rows of face fluxes and three of U^n.
enum Row : int { rho, m, energy, flux_m, flux_energy, u, enthalpy, slow, fast, flux, start = flux + 3, rows = start + 3 };

/// Density, momentum and energy per volume, or their fluxes.
struct Conserved {
  double rho, m, energy;
};

/// Values of a cell.
struct Cell {
  Conserved state;
  double u, p, enthalpy, c;
};

__device__ double pressure(double gamma, double momentum, double total, double velocity) {
  return (gamma - 1.0) * (total - 0.5 * (momentum * velocity));
}

__device__ Cell cell_of(double gamma, const Conserved& state) {
  const double inverse = reciprocal(state.rho);
  const double velocity = state.m * inverse;
  const double p = pressure(gamma, state.m, state.energy, velocity);
  return {state, velocity, p, (state.energy + p) * inverse, root(gamma * (p * inverse)).value};
}

__device__ double larger(double a, double b) { return a > b ? a : b; }

/// Eigensystem of the flux at a face; the left acoustic vectors are scaled by 2 c^2/(gamma - 1).
struct Eigensystem {
  double u, c, enthalpy, kinetic, unit, inverse_unit, width;
};

__device__ Eigensystem eigensystem(double gamma, double velocity, double total_enthalpy) {
  const double gamma_1 = gamma - 1.0;
  const double kinetic = 0.5 * (velocity * velocity);
  const double unit = total_enthalpy - kinetic;
  const Root c = root(gamma_1 * unit);
  return {velocity, c.value, total_enthalpy, kinetic, unit, gamma_1 * c.reciprocal, unit * c.inverse};
}

struct Characteristic {
  double slow, entropy, fast;
};

__device__ Characteristic project(const Eigensystem& e, double d_rho, double d_m, double d_energy) {
  const double s = e.kinetic * d_rho + (d_energy - e.u * d_m);
  const double t = e.u * d_rho - d_m;
  return {s + e.width * t, d_rho - e.inverse_unit * s, s - e.width * t};
}

/// Split differences of a field: the right-going part, and the left-going one in reverse order.
struct Split {
  double right[4], left[4];

  __device__ void set(int k, double df, double du, double alpha) {
    if (k < 4) right[k] = df + alpha * du;
    if (k > 0) left[4 - k] = df - alpha * du;
  }
};

/// Three times the fifth-order correction to the central flux (Jiang and Shu 1996).
template <int scale>
__device__ double correction(const double (&d)[4], double unit) {
  constexpr double indicator_scale = 0.75 * scale * scale;
  const double epsilon = (1e-6 * indicator_scale) * (unit * unit) + 1e-75;
  const double left = d[0] - 1.375 * d[1], middle = d[1] - 0.625 * d[2], right = d[3] - 1.375 * d[2];
  const double b_part = 0.609375 * (d[1] * d[1]) + epsilon, c_part = 0.609375 * (d[2] * d[2]) + epsilon;
  const double b0 = left * left + b_part, b1 = middle * middle + c_part, b2 = right * right + c_part;
  const double b12 = b1 * b2, b02 = b0 * b2, b01 = b0 * b1;
  const double q0 = b12 * b12, q1 = b02 * b02, q2 = b01 * b01;
  const double inverse = reciprocal(q0 + (6.0 * q1 + 3.0 * q2));
  const double first = d[0] - 2.0 * d[1] + d[2], last = d[1] - 2.0 * d[2] + d[3];
  return inverse * (q0 * first + 1.5 * (q2 * last)) - 0.25 * last;
}

template <int scale>
__device__ double corrected(const Split& split, double unit) {
  return correction<scale>(split.right, unit) - correction<scale>(split.left, unit);
}

__device__ double central_flux(double sum, double before, double after) {
  return 0.5 * sum - (1.0 / 12.0) * (after - before);
}

/// Cell that provides the value at `index`, which may lie outside the mesh, and the sign of its momentum.
struct Image {
  std::int64_t cell;
  double sign;
};

__device__ Image image_of(const GasStep& p, std::int64_t index) {
  const std::int64_t n = p.cells;
  if (index >= 0 && index < n) return {index, 1.0};
  const bool left = index < 0;
  const int kind = left ? p.left : p.right;
  if (kind == periodic) {
    while (index < 0) index += n;
    while (index >= n) index -= n;
    return {index, 1.0};
  }
  const std::int64_t beyond = left ? -1 - index : index - n;
  if (kind == outflow || beyond >= ghosts) return {left ? 0 : n - 1, 1.0};
  return {left ? beyond : n - 1 - beyond, -1.0};
}

/// Range of indices, both ends included.
struct Range {
  int first, last;
};

/// Cell of the tile that a slot represents; a slot beyond a wall represents a reflected one.
struct SlotImage {
  int slot;
  double sign;
};

/// Largest rate of a thread's cells, m/s, and 0 in place of 1 after an inadmissible one.
struct Reduced {
  double speed, admissible;
};

/// Tile of cells with their halo in shared memory.
struct Tile {
  const GasStep& p;
  double* data;
  std::int64_t first;
  int cells, slots;

  __device__ double& at(int row, int i) const { return data[row * p.slots + i]; }
  __device__ Conserved vector(int row, int i) const { return {at(row, i), at(row + 1, i), at(row + 2, i)}; }
  __device__ void store(int row, int i, const Conserved& value) const {
    at(row, i) = value.rho, at(row + 1, i) = value.m, at(row + 2, i) = value.energy;
  }
  __device__ std::int64_t cell(int slot) const { return first - p.halo + slot; }

  __device__ void store_cell(int i, const Cell& s) const {
    store(rho, i, s.state);
    at(flux_m, i) = s.state.m * s.u + s.p;
    at(flux_energy, i) = (s.state.energy + s.p) * s.u;
    at(u, i) = s.u;
    at(enthalpy, i) = s.enthalpy;
    at(slow, i) = fabs(s.u - s.c);
    at(fast, i) = fabs(s.u + s.c);
  }

  __device__ void load(const double* from) const {
    const std::int64_t n = p.cells;
    for (int i = static_cast<int>(threadIdx.x); i < slots; i += static_cast<int>(blockDim.x)) {
      const Image image = image_of(p, cell(i));
      const Conserved state{from[image.cell], image.sign * from[n + image.cell], from[2 * n + image.cell]};
      store(start, i, state);
      store_cell(i, cell_of(p.gamma, state));
    }
  }

  /// Slots of the cells of the mesh; a periodic mesh covers all slots.
  __device__ Range mesh_slots() const {
    const std::int64_t left = p.halo - first, right = left + p.cells - 1;
    const bool open_left = p.left != periodic && left > 0, open_right = p.right != periodic && right < slots - 1;
    return {open_left ? static_cast<int>(left) : 0, open_right ? static_cast<int>(right) : slots - 1};
  }

  /// Faces whose stencils are valid at the start of a stage.
  __device__ Range faces_of(int stage) const {
    const Range mesh = mesh_slots();
    const int lost = ghosts * stage;
    return {max(lost, mesh.first - ghosts), min(slots - 2 * ghosts - lost, mesh.last - ghosts + 1)};
  }

  __device__ Eigensystem face_eigensystem(int l, int r) const {
    if (p.average == arithmetic)
      return eigensystem(p.gamma, 0.5 * (at(u, l) + at(u, r)), 0.5 * (at(enthalpy, l) + at(enthalpy, r)));
    if (p.average == conserved) {
      const double inverse = reciprocal(at(rho, l) + at(rho, r));
      const double momentum = at(m, l) + at(m, r), total = at(energy, l) + at(energy, r);
      const double velocity = momentum * inverse;
      return eigensystem(p.gamma, velocity, (total + pressure(p.gamma, momentum, total, velocity)) * inverse);
    }
    const double wl = sqrt(at(rho, l)), wr = sqrt(at(rho, r)), inverse = reciprocal(wl + wr);
    return eigensystem(p.gamma, (wl * at(u, l) + wr * at(u, r)) * inverse,
                       (wl * at(enthalpy, l) + wr * at(enthalpy, r)) * inverse);
  }

  /// Characteristic WENO5 flux at a face, from the six cells around it.
  __device__ Conserved face_flux(int face) const {
    double d_rho[5], d_m[5], d_energy[5], d_flux_m[5], d_flux_energy[5];
    for (int k = 0; k < 5; ++k) {
      const int i = face + k;
      d_rho[k] = at(rho, i + 1) - at(rho, i);
      d_m[k] = at(m, i + 1) - at(m, i);
      d_energy[k] = at(energy, i + 1) - at(energy, i);
      d_flux_m[k] = at(flux_m, i + 1) - at(flux_m, i);
      d_flux_energy[k] = at(flux_energy, i + 1) - at(flux_energy, i);
    }
    double alpha_slow = at(slow, face), alpha_fast = at(fast, face), alpha_entropy = fabs(at(u, face));
    for (int k = 1; k < 6; ++k) {
      alpha_slow = larger(alpha_slow, at(slow, face + k));
      alpha_fast = larger(alpha_fast, at(fast, face + k));
      alpha_entropy = larger(alpha_entropy, fabs(at(u, face + k)));
    }
    const Eigensystem e = face_eigensystem(face + 2, face + 3);
    Split of_slow, of_entropy, of_fast;
    for (int k = 0; k < 5; ++k) {
      const Characteristic du = project(e, d_rho[k], d_m[k], d_energy[k]);
      const Characteristic df = project(e, d_m[k], d_flux_m[k], d_flux_energy[k]);
      of_slow.set(k, df.slow, du.slow, alpha_slow);
      of_entropy.set(k, df.entropy, du.entropy, alpha_entropy);
      of_fast.set(k, df.fast, du.fast, alpha_fast);
    }
    const double k1 = corrected<4>(of_slow, e.unit), k2 = (1.0 / 6.0) * corrected<2>(of_entropy, 1.0),
                 k3 = corrected<4>(of_fast, e.unit);
    const double acoustic = (1.0 / 12.0) * e.inverse_unit;
    const double sum = acoustic * (k1 + k3), difference = acoustic * e.c * (k3 - k1);
    const int l = face + 2, r = face + 3;
    return {central_flux(at(m, l) + at(m, r), d_m[1], d_m[3]) - (sum + k2),
            central_flux(at(flux_m, l) + at(flux_m, r), d_flux_m[1], d_flux_m[3]) -
                (e.u * (sum + k2) + difference),
            central_flux(at(flux_energy, l) + at(flux_energy, r), d_flux_energy[1], d_flux_energy[3]) -
                (e.enthalpy * sum + e.kinetic * k2 + e.u * difference)};
  }

  __device__ SlotImage image_in(const Range& mesh, int i) const {
    if (i >= mesh.first && i <= mesh.last) return {i, 1.0};
    const int end = i < mesh.first ? mesh.first : mesh.last;
    if ((i < mesh.first ? p.left : p.right) == outflow) return {end, 1.0};
    return {end + (end - i) + (i < mesh.first ? -1 : 1), -1.0};
  }

  template <bool last_stage>
  __device__ void update(int i, const SlotImage& image, const GasStage& stage, double dt_over_dx, double* out,
                         Reduced& reduced) const {
    Conserved state = vector(rho, i);
    state.m = image.sign * state.m;
    const Conserved before = vector(flux, image.slot - ghosts), after = vector(flux, image.slot - ghosts + 1);
    state = {state.rho + dt_over_dx * (before.rho - after.rho), state.m + dt_over_dx * (before.m - after.m),
             state.energy + dt_over_dx * (before.energy - after.energy)};
    if (stage.share != 1.0) {
      Conserved u_n = vector(start, i);
      u_n.m = image.sign * u_n.m;
      state = {u_n.rho + stage.share * (state.rho - u_n.rho), u_n.m + stage.share * (state.m - u_n.m),
               u_n.energy + stage.share * (state.energy - u_n.energy)};
    }
    Cell s = cell_of(p.gamma, state);
    // Every comparison is false for a NaN.
    if (!(s.p > 0.0) || !(s.p <= 1.7e308) || !(state.rho > 0.0) || !(state.rho <= 1.7e308))
      reduced.admissible = 0.0;
    if constexpr (last_stage) {
      const std::int64_t at_cell = cell(i);
      out[at_cell] = state.rho, out[p.cells + at_cell] = state.m, out[2 * p.cells + at_cell] = state.energy;
      reduced.speed = larger(reduced.speed, larger(fabs(s.u - s.c), fabs(s.u + s.c)));
    } else {
      s.state.m = image.sign * s.state.m, s.u = image.sign * s.u;
      store_cell(i, s);
    }
  }

  /// Records the inadmissible cells among those of a thread.
  template <bool last_stage>
  __device__ void report(int stage, int begin, int end, const double* out) const {
    for (int i = begin + static_cast<int>(threadIdx.x); i < end; i += static_cast<int>(blockDim.x)) {
      const std::int64_t at_cell = image_of(p, cell(i)).cell;
      const Conserved s =
          last_stage ? Conserved{out[at_cell], out[p.cells + at_cell], out[2 * p.cells + at_cell]} : vector(rho, i);
      const double pressure_now = pressure(p.gamma, s.m, s.energy, s.m * reciprocal(s.rho));
      if (s.rho > 0.0 && s.rho <= 1.7e308 && pressure_now > 0.0 && pressure_now <= 1.7e308) continue;
      const unsigned reason = s.rho <= 0.0 ? density : pressure_now <= 0.0 ? pressure_of : not_finite;
      const auto index = static_cast<unsigned long long>(at_cell) << 2U | reason;
      atomicMin(&p.control->first_inadmissible, static_cast<unsigned long long>(stage) << 31U | index);
    }
  }

  template <bool last_stage>
  __device__ void update_all(const Range& faces, int stage, double dt, int current) const {
    const GasStage& weights = p.stage[stage];
    const double dt_over_dx = weights.dt_factor * dt * p.inverse_dx;
    double* out = p.buffer[(current + weights.out) % 3];
    int begin = faces.first + ghosts, end = faces.last + ghosts;
    const Range mesh = mesh_slots();
    const int more = last_stage ? 0 : ghosts;
    if (begin == mesh.first) begin = max(begin - more, 0);
    if (end == mesh.last + 1) end = min(end + more, slots);
    Reduced reduced{0.0, 1.0};
    for (int i = begin + static_cast<int>(threadIdx.x); i < end; i += static_cast<int>(blockDim.x))
      update<last_stage>(i, image_in(mesh, i), weights, dt_over_dx, out, reduced);
    if (reduced.admissible < 1.0) report<last_stage>(stage, begin, end, out);
    if constexpr (last_stage) raise_speed(reduced.speed);
  }

  /// Raises the largest speed of the step, once a warp.
  __device__ void raise_speed(double mine) const {
    const int after = static_cast<int>(blockDim.x - threadIdx.x / 32 * 32);
    const unsigned lanes = after >= 32 ? ~0U : (1U << static_cast<unsigned>(after)) - 1U;
    const auto own = static_cast<unsigned long long>(__double_as_longlong(mine));
    const auto own_high = static_cast<unsigned>(own >> 32U);
    const unsigned high = __reduce_max_sync(lanes, own_high);
    const unsigned low = __reduce_max_sync(lanes, own_high == high ? static_cast<unsigned>(own) : 0U);
    if (threadIdx.x % 32 != 0) return;
    const unsigned long long bits = static_cast<unsigned long long>(high) << 32U | low;
    unsigned long long* slot = &p.control->speed;
    if (gridDim.x < 1024 || bits > *static_cast<volatile unsigned long long*>(slot)) atomicMax(slot, bits);
  }

  /// Stores the fluxes through the ends of the mesh, by one thread of the outermost tiles.
  __device__ void store_boundary_fluxes(int stage) const {
    if (threadIdx.x != blockDim.x - 1) return;
    for (int side = 0; side < 2; ++side) {
      if (side == 0 ? first != 0 : first + cells != p.cells) continue;
      const Conserved f = vector(flux, side == 0 ? p.halo - ghosts : p.halo - ghosts + cells);
      double(&to)[3] = p.control->boundary_flux[stage][side];
      to[0] = f.rho, to[1] = f.m, to[2] = f.energy;
    }
  }
};

/// All stages of a step of one tile; `least_blocks` as in `gas::launch`.
template <int least_blocks>
__global__ void __launch_bounds__(128, least_blocks) gas_step(const __grid_constant__ GasStep p) {
  extern __shared__ double gas_scratch[];
  const int stopped = p.control->stopped, limited = p.control->limited, current = p.control->current;
  const double dt = p.control->dt;
  if (stopped != 0 || limited != 0) return;
  const std::int64_t first = static_cast<std::int64_t>(blockIdx.x) * p.tile_cells;
  const int cells = static_cast<int>(min(static_cast<long long>(p.tile_cells), static_cast<long long>(p.cells - first)));
  const Tile tile{p, gas_scratch, first, cells, cells + 2 * p.halo};
  tile.load(p.buffer[current]);
  for (int stage = 0; stage < p.stages; ++stage) {
    const Range faces = tile.faces_of(stage);
    __syncthreads();
    for (int face = faces.first + static_cast<int>(threadIdx.x); face <= faces.last;
         face += static_cast<int>(blockDim.x))
      tile.store(flux, face, tile.face_flux(face));
    __syncthreads();
    tile.store_boundary_fluxes(stage);
    if (stage < p.stages - 1)
      tile.update_all<false>(faces, stage, dt, current);
    else
      tile.update_all<true>(faces, stage, dt, current);
  }
}

}  // namespace

void launch_gas_step(const GasStep& step, Stream stream) {
  const auto tiles = static_cast<unsigned>((step.cells + step.tile_cells - 1) / step.tile_cells);
  const auto threads = static_cast<unsigned>(step.threads);
  const std::size_t bytes = sizeof(double) * rows * static_cast<std::size_t>(step.slots);
  // Four tiles fill a multiprocessor with shared memory, which the driver need not choose by itself.
  static const cudaError_t prepared = cudaFuncSetAttribute(
      gas_step<4>, cudaFuncAttributePreferredSharedMemoryCarveout, cudaSharedmemCarveoutMaxShared);
  static_cast<void>(prepared);
  // Tiles with more slots than threads need fewer registers, as in `gas::launch`.
  if (step.slots > step.threads)
    gas_step<4><<<tiles, threads, bytes, stream>>>(step);
  else
    gas_step<3><<<tiles, threads, bytes, stream>>>(step);
  check_launch("gas step");
}

}  // namespace drogue::perf::raw
