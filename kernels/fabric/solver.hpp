#pragma once

#include <memory>
#include <optional>
#include <span>

#include "kernels/device/backend.hpp"
#include "kernels/fabric/parameters.hpp"
#include "kernels/fabric/state.hpp"

namespace drogue::fabric {

/// omega dt up to which an oscillation without damping does not grow. Of Runge and Kutta's method
/// |G|^2 = 1 - z^6/72 + z^8/576 is 1 at z^2 = 8.
[[nodiscard]] constexpr double stability_limit(Integrator integrator) {
  return integrator == Integrator::rk4 ? 2.8284271247461903 : 2.0;
}

/// The largest step, s, that is stable for frequencies up to `frequency`, rad/s, and decays up to `decay`,
/// 1/s (those that a solver gives); infinite for neither. Runge and Kutta's region holds the half disc |z|
/// <= 2.61 left of the imaginary axis; Verlet's needs decay dt <= 1.
[[nodiscard]] constexpr double stable_dt(Integrator integrator, double frequency, double decay) {
  if (integrator == Integrator::rk4 && decay > 0.0) return 2.61 / (frequency > decay ? frequency : decay);
  const double undamped = stability_limit(integrator) / frequency;
  return decay * undamped > 1.0 ? 1.0 / decay : undamped;
}

/// Whether oscillations of `frequency`, rad/s, grow in steps of dt, s, at any damping up to what is given,
/// 1/s: `absolute` of all motion, and `relative` up to a solver's `fastest_decay`. False where it cannot be
/// told. The roots z of z^2 + c dt z + (omega dt)^2 have no smaller modulus than omega dt on the mean, and
/// Runge and Kutta's region reaches 2.9602 from the origin; of Verlet's step the trace and the determinant
/// tell (Jury 1962).
[[nodiscard]] constexpr bool grows(Integrator integrator, double dt, double frequency, double absolute,
                                   double relative) {
  const double z = frequency * dt;
  if (integrator == Integrator::rk4)
    return z > (absolute + relative > 0.0 ? 2.9602 : stability_limit(integrator));
  const double half = 0.25 * absolute * dt, keep = (1.0 - half) / (1.0 + half), drag = 1.0 - relative * dt;
  return drag > 0.0 && drag * z * z > 2.0 * (1.0 + drag * keep * keep) * (1.0 + half) * (1.0 + half);
}

/// Cloth and strings that live on a backend and move there. Needs an initialised runtime.
///
/// Life: `upload`, then `advance` as often as wanted. Once a state is lost (a number that is not finite, or
/// beyond 1e100) the solver goes back to the last state that it had put aside, one of every 256 steps or the
/// one uploaded: `download` and all that looks at the state finds that one, and `clock` tells its step.
class Solver {
 public:
  virtual ~Solver() = default;

  /// Positions, m, and velocities, m/s, of all vertices, at the clock's time; a failure is forgotten. What
  /// is not finite, and spans of another length here and below, throw std::invalid_argument.
  virtual void upload(std::span<const Vector> positions, std::span<const Vector> velocities) = 0;
  virtual void download(std::span<Vector> positions, std::span<Vector> velocities) = 0;

  /// Takes `steps` steps of `time_state().dt`. Returns before they are done, and false once it is known that
  /// a state was lost; then none follow until the next `upload`. How steps are cut into calls changes no bit.
  virtual bool advance(std::int64_t steps) = 0;

  /// Waits for the steps that were asked for; where and when the state was lost, if it was.
  [[nodiscard]] virtual std::optional<Failure> failure() = 0;

  /// Of the steps asked for, and once a failure was told of the state gone back to; begins at step 0, time 0
  /// and `Parameters::dt`.
  [[nodiscard]] virtual TimeState time_state() const = 0;

  /// Sets step, time, and dt, which must be positive (std::invalid_argument).
  virtual void set_time_state(const TimeState& clock) = 0;

  /// From here on steps take dt, s.
  void set_dt(double dt) {
    static_cast<void>(failure());  // which may set the clock back
    const TimeState now = time_state();
    set_time_state({now.step, dt, now.step, now.time()});
  }

  /// The elastic forces and all loads where the vertices are now, N, without gravity and damping.
  virtual void forces(std::span<Vector> forces) = 0;

  /// An upper bound of the angular frequencies of small oscillations about where the vertices are now, rad/s,
  /// under the pressure of now; what is slack counts as taut. `stable_dt` makes a step of it. Stiffness grows
  /// with strain, so ask again when the cloth has stretched.
  [[nodiscard]] virtual double fastest_frequency() = 0;

  /// A lower bound of the largest of them, mostly within 1 % of it, by which steps are surely too long
  /// (`grows`): what Lanczos' method finds from forces about where the vertices are now. It takes a hundred
  /// forces and copies: not for every step.
  [[nodiscard]] virtual double frequency_at_least() = 0;

  /// An upper bound of the rates at which damping slows, 1/s; of Verlet absolute damping does not count,
  /// which is stable whatever it is.
  [[nodiscard]] virtual double fastest_decay() const = 0;

  /// Of every triangle where the vertices are now; lines do not count. Throws std::invalid_argument for
  /// Model::linear_vector, whose forces are not along edges.
  virtual void stress(StressMeasure measure, std::span<Stress> of_triangles) = 0;

  /// The same of every vertex: the mean over its triangles by their areas.
  virtual void vertex_stress(StressMeasure measure, std::span<Stress> of_vertices) = 0;

  /// Energies and momenta where the vertices are now, summed in an order that no backend changes.
  [[nodiscard]] virtual Totals totals() = 0;

  /// How steps reach the device: "persistent", "graph" or "plain".
  [[nodiscard]] virtual const char* driver() const = 0;

  /// Work that contact has done on every vertex since the solver was made; zero without contact. Zones that
  /// move as rigid bodies count to first order. `set_contact_work` brings back what a restart has kept.
  virtual void contact_work(std::span<ContactWork> of_vertices) = 0;
  virtual void set_contact_work(std::span<const ContactWork> of_vertices) = 0;
};

/// Whether a triangle can be computed with: it is not flat to round-off, and its longest side, m, is within
/// 1e-70 and 1e70, so that the square of its area is a number.
[[nodiscard]] bool has_area(const Mesh& mesh, const std::array<int, 3>& triangle);

/// Throws std::invalid_argument, with one sentence that names the fault, for parameters out of range.
void check_parameters(const Parameters& parameters);

/// Makes a solver on a backend, which must be available. Blocks. Throws std::invalid_argument for parameters
/// out of range.
[[nodiscard]] std::unique_ptr<Solver> create_solver(device::Backend backend, const Parameters& parameters);

}  // namespace drogue::fabric
