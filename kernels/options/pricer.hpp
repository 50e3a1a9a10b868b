#pragma once

#include <memory>
#include <memory_resource>
#include <span>
#include <vector>

#include "kernels/device/backend.hpp"
#include "kernels/options/contract.hpp"

namespace drogue::options {

/// Numerical method.
enum class Method : unsigned char {
  pide,      ///< finite differences of the partial integro-differential equation
  cos,       ///< Fourier cosine series (American) and Fourier inversion (European)
  baseline,  ///< scheme of [Shi], listing 4.6
};

/// Treatment of early exercise that pays on a half line. Between two exercise boundaries `split` is always
/// used.
enum class ExerciseRule : unsigned char {
  exact,  ///< within the solve of a step (Brennan and Schwartz 1977)
  split,  ///< after the solve, by operator splitting (Ikonen and Toivanen 2004); for comparison
};

/// Settings of a pricer. Either mesh and steps are given, or the tolerance chooses them. `cos` has no mesh.
struct Settings {
  Method method = Method::pide;
  int mesh = 0;   ///< spatial intervals; 0: chosen by `tolerance`
  int steps = 0;  ///< time steps (`cos`: dates of American options); 0: chosen by `tolerance`
  /// Bound of |price - true price|, relative to the strike, beyond which a price is `PriceStatus::coarse`. A
  /// given mesh has none.
  double tolerance = 1e-4;
  bool greeks = false;   ///< `cos` computes delta, gamma and theta; the other methods always do
  int host_threads = 0;  ///< host threads for the tables of `cos`; 0: one per core
  int block = 0;         ///< threads of a team of `cos` on a device, a multiple of 32 up to 512; 0: of Kokkos
  bool surface = false;  ///< consecutive contracts that differ only in the strike share solves; `pide` only
  ExerciseRule exercise = ExerciseRule::exact;  ///< `pide` only
  bool single_grid = false;  ///< with `mesh`, `pide` only: no extrapolation and no error; for comparison
  /// Times copies separately, with a fence after each. Surfaces always do, `cos` never does.
  bool time_copies = false;
};

/// Wall times of a batch, s. If copies are not timed separately, `compute` holds the total.
struct WallTimes {
  double h2d = 0.0;
  double compute = 0.0;  ///< includes work on the host, such as tables of Bessel functions
  double d2h = 0.0;

  /// Adds the times of another batch. Does not throw.
  void add(const WallTimes& other) {
    h2d += other.h2d;
    compute += other.compute;
    d2h += other.d2h;
  }
};

/// Point of an early exercise boundary.
struct BoundaryPoint {
  double time;  ///< from now, years
  double spot;  ///< critical spot, money: at and beyond it exercise is optimal
};

/// Price of an option at another spot.
struct ProfilePoint {
  double spot, price;  ///< money
};

/// Prices batches of contracts on a backend. Requires an initialized runtime. All functions block until their
/// results are on the host.
class Pricer {
 public:
  virtual ~Pricer() = default;

  /// Prices every contract, all of which satisfy `violated_condition`; `prices` (money) has the length of
  /// `contracts`. Returns wall times, s. The bits of a price do not depend on the other contracts. Throws
  /// std::invalid_argument for spans of different lengths.
  virtual WallTimes price(std::span<const Contract> contracts, std::span<Price> prices) = 0;

  /// Host memory that the device copies directly from and to, for contracts and prices. Valid for the life of
  /// the pricer. Does not throw.
  [[nodiscard]] virtual std::pmr::memory_resource& memory() { return *std::pmr::new_delete_resource(); }

  /// Early exercise boundary of an American contract from now to expiry, one point (years, money) per time
  /// step; empty if exercise is never optimal. Throws std::invalid_argument for the method `cos`.
  [[nodiscard]] std::vector<BoundaryPoint> boundary(const Contract& contract) {
    return boundary(contract, 0, 0);
  }

  /// As `boundary`, with `mesh` intervals and `steps` time steps, say those of a price. 0 intervals: those of
  /// the settings, or 512. Throws std::invalid_argument for the method `cos`.
  virtual std::vector<BoundaryPoint> boundary(const Contract& contract, int mesh, int steps) = 0;

  /// Current prices (money) at the nodes of one solve, in ascending order of the spot (money). The contract's
  /// spot only affects the extent of the grid. Prices have the error of a single grid. By homogeneity,
  /// V(c spot, c strike) = c V, they are prices of other strikes as well. Throws std::invalid_argument for
  /// the method `cos`.
  virtual std::vector<ProfilePoint> profile(const Contract& contract) = 0;
};

/// Creates a pricer on `backend`, which must be available. Throws std::invalid_argument for settings out of
/// range.
[[nodiscard]] std::unique_ptr<Pricer> create_pricer(device::Backend backend, const Settings& settings);

}  // namespace drogue::options
