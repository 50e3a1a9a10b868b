#pragma once

#include <memory>
#include <optional>
#include <span>

#include "kernels/device/backend.hpp"
#include "kernels/fabric/parameters.hpp"
#include "kernels/fabric/results.hpp"

namespace drogue::fabric {

/// Stability limit of omega dt, dimensionless, for undamped oscillations. For the classical Runge-Kutta
/// method |G|^2 = 1 - z^6/72 + z^8/576 is 1 at z^2 = 8. Does not throw.
[[nodiscard]] constexpr double stability_limit(Integrator integrator) {
  return integrator == Integrator::rk4 ? 2.8284271247461903 : 2.0;
}

/// Largest stable step, s, for angular frequencies up to `frequency`, rad/s, and rates of damping up to
/// `decay`, 1/s, as a solver bounds them; infinite if both are zero. The stability region of the Runge-Kutta
/// method contains the half disc |z| <= 2.61 left of the imaginary axis; Verlet's method needs decay dt <= 1,
/// the symplectic Euler method (omega dt)^2 + 2 decay dt <= 4. Does not throw.
[[nodiscard]] constexpr double stable_dt(Integrator integrator, double frequency, double decay) {
  if (integrator == Integrator::rk4 && decay > 0.0) return 2.61 / (frequency > decay ? frequency : decay);
  if (integrator == Integrator::symplectic_euler) return 2.0 / (frequency + decay);
  const double undamped = stability_limit(integrator) / frequency;
  return decay * undamped > 1.0 ? 1.0 / decay : undamped;
}

/// True if oscillations of `frequency`, rad/s, grow in steps of dt, s, for every damping up to the given
/// rates, 1/s: `absolute` of all motion, and `relative` up to a solver's `fastest_decay`. False in undecided
/// cases. The roots z of z^2 + c dt z + (omega dt)^2 have a mean modulus of omega dt at least, and the
/// stability region of the Runge-Kutta method ends 2.9602 from the origin. For Verlet's step, the trace and
/// the determinant decide (Jury 1962); damping does not stabilise the symplectic Euler method. Does not
/// throw.
[[nodiscard]] constexpr bool grows(Integrator integrator, double dt, double frequency, double absolute,
                                   double relative) {
  const double z = frequency * dt;
  if (integrator == Integrator::rk4)
    return z > (absolute + relative > 0.0 ? 2.9602 : stability_limit(integrator));
  if (integrator == Integrator::symplectic_euler) return z > stability_limit(integrator);
  const double half = 0.25 * absolute * dt, retained = (1.0 - half) / (1.0 + half),
               dashpot_factor = 1.0 - relative * dt;
  return dashpot_factor > 0.0 && dashpot_factor * z * z > 2.0 * (1.0 + dashpot_factor * retained * retained) *
                                                              (1.0 + half) * (1.0 + half);
}

/// Cloth and strings on a backend that a program chooses at run time. Needs an initialised runtime. To couple
/// other kernels on the device, use `FabricSolver`, which is this class with the functions that they need.
///
/// Call `upload`, then `enqueue_steps` as often as needed. A step fails if its state is not finite or exceeds
/// 1e100, or if contact fails. The solver then returns to its last checkpoint: one of every 256 steps, or the
/// uploaded state. All functions that read the state then refer to the checkpoint, and `time_state` returns
/// its step.
class Solver {
 public:
  virtual ~Solver() = default;

  /// Sets positions, m, and velocities, m/s, of all vertices at the present time and forgets a failure.
  /// Blocks. Throws std::invalid_argument for values that are not finite and spans of the wrong length.
  virtual void upload(std::span<const Vector> positions, std::span<const Vector> velocities) = 0;

  /// Copies positions, m, and velocities, m/s. Blocks. Throws std::invalid_argument for spans of the wrong
  /// length.
  virtual void download(std::span<Vector> positions, std::span<Vector> velocities) = 0;

  /// Enqueues `steps` steps of `time_state().dt` and a checkpoint after every 256th step. Asynchronous but
  /// for a bound on the steps in flight of some 0.1 s, and at least 2048 steps. Returns false, and enqueues
  /// nothing more, once a failure is known on the host; no steps follow until the next `upload`. The
  /// distribution of steps over calls changes no bit, except with an interval of contact. Throws
  /// std::invalid_argument for a negative number, and one that ends beyond step 2^53.
  virtual bool enqueue_steps(std::int64_t steps) = 0;

  /// First failed step, if any. Blocks until all steps are done. Throws only after a failed kernel.
  [[nodiscard]] virtual std::optional<StepFailure> failure() = 0;

  /// Step count, dt and time, s, after the steps enqueued; after a failure was reported, those of the
  /// checkpoint. The initial values are step 0, time 0 and `Parameters::dt`. Does not throw.
  [[nodiscard]] virtual TimeState time_state() const = 0;

  /// Sets step count, time and dt, s. Blocks. Throws std::invalid_argument unless dt is positive, time
  /// finite, and 0 <= since <= step.
  virtual void set_time_state(const TimeState& time) = 0;

  /// Sets dt, s, of the following steps. Blocks. Throws std::invalid_argument unless dt is positive.
  void set_dt(double dt) {
    static_cast<void>(failure());  // a failure sets the time back
    const TimeState now = time_state();
    set_time_state({now.step, dt, now.step, now.time()});
  }

  /// Elastic forces and all loads at the present positions, N, without gravity and damping. Blocks. Throws
  /// std::invalid_argument for a span of the wrong length.
  virtual void forces(std::span<Vector> forces) = 0;

  /// Upper bound of the angular frequencies of small oscillations about the present positions, rad/s, at the
  /// present pressure. Slack elements count as taut. Pass the result to `stable_dt`. Stiffness grows with
  /// strain: compute it again after the cloth has stretched. Blocks. Throws only after a failed kernel.
  [[nodiscard]] virtual double fastest_frequency() = 0;

  /// Lower bound of the largest angular frequency, rad/s, mostly within 1 % of it, from Lanczos' method on
  /// differences of forces. Use it with `grows` to detect unstable steps. It evaluates and copies forces
  /// about a hundred times. Blocks. Throws only after a failed kernel.
  [[nodiscard]] virtual double frequency_at_least() = 0;

  /// Upper bound of the rates of damping, 1/s. It excludes absolute damping in Verlet's method, which is
  /// stable for every rate. Does not throw.
  [[nodiscard]] virtual double fastest_decay() const = 0;

  /// Stress of every triangle at the present positions, N/m; lines do not contribute. Blocks. Throws
  /// std::invalid_argument for a span of the wrong length, and for Model::linear_vector, whose forces are not
  /// along edges.
  virtual void stress(StressMeasure measure, std::span<Stress> of_triangles) = 0;

  /// Stress of every vertex, N/m: the mean over its triangles, weighted by area. Blocks. Throws as `stress`.
  virtual void vertex_stress(StressMeasure measure, std::span<Stress> of_vertices) = 0;

  /// Energies, J, and momenta, kg m/s and kg m^2/s, of the present state. The order of summation is the same
  /// on every backend. Blocks. Throws only after a failed kernel.
  [[nodiscard]] virtual Totals totals() = 0;

  /// Sets E A of every line of the mesh, N; 0 cuts a line, which is then no obstacle in contact. Blocks.
  /// Throws std::invalid_argument for values that are negative or not finite, and spans of the wrong length.
  virtual void set_line_stiffness(std::span<const double> of_lines) = 0;

  /// Records the largest forces of lines on vertices, N, from now on, those of the present state included:
  /// after every step of the velocity Verlet method, on the device. Replaces former pulls. Blocks. Throws
  /// std::invalid_argument for lines that do not end at their vertex, for other integrators, and with an
  /// interval of contact, which changes states after they were recorded.
  virtual void watch_pulls(std::span<const Pull> pulls) = 0;

  /// Peaks of the pulls that are watched. Blocks. Throws only after a failed kernel.
  [[nodiscard]] virtual std::vector<PeakPull> peak_pulls() = 0;

  /// Restores the peaks, N and s. Blocks. Throws std::invalid_argument for another number than that of the
  /// pulls.
  virtual void set_peak_pulls(std::span<const PeakPull> peaks) = 0;

  /// Name of the driver of steps: "persistent", "graph" or "plain". Does not throw.
  [[nodiscard]] virtual const char* driver() const = 0;

  /// Work of contact on every vertex since the solver was made, J; zero without contact. Zones that move as
  /// rigid bodies count to first order. Blocks. Throws std::invalid_argument for a span of the wrong length.
  virtual void contact_work(std::span<ContactWork> of_vertices) = 0;

  /// Restores the work of contact, J, from a restart. Blocks. Throws std::invalid_argument for a span of the
  /// wrong length.
  virtual void set_contact_work(std::span<const ContactWork> of_vertices) = 0;
};

/// True if a triangle is not flat to round-off and its longest side, m, lies between 1e-70 and 1e70, so that
/// the square of its area is finite. Does not throw.
[[nodiscard]] bool has_area(const Mesh& mesh, const std::array<int, 3>& triangle);

/// Throws std::invalid_argument, with one sentence that names the fault, for parameters out of range.
void check_parameters(const Parameters& parameters);

/// Solver on a backend, which must be available. Blocks. Throws std::invalid_argument for parameters
/// out of range.
[[nodiscard]] std::unique_ptr<Solver> create_solver(device::Backend backend, const Parameters& parameters);

}  // namespace drogue::fabric
