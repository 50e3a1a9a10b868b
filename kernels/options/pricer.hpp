#pragma once

#include <memory>
#include <memory_resource>
#include <span>
#include <vector>

#include "kernels/device/backend.hpp"
#include "kernels/options/contract.hpp"

namespace drogue::options {

enum class Method : unsigned char {
  pide,  ///< finite differences of the integro-differential equation
  cos,   ///< Fourier cosine series
  seed,  ///< the dissertation's scheme (Listing 4.6)
};

/// How early exercise that pays on a half line is imposed; between two boundaries it is always split off.
enum class ExerciseRule : unsigned char {
  exact,  ///< in the solve of a step (Brennan and Schwartz 1977)
  split,  ///< after it (Ikonen and Toivanen 2004), to compare
};

/// How to price. Either mesh and steps are given, or the tolerance chooses them.
struct Settings {
  Method method = Method::pide;
  int mesh = 0;             ///< intervals in space; 0: chosen by `tolerance`
  int steps = 0;            ///< steps in time; 0: chosen by `tolerance`
  double tolerance = 1e-4;  ///< of |price - true price|, relative to the strike
  bool greeks = false;      ///< `cos` computes delta, gamma and theta; the other methods always do
  int host_threads = 0;     ///< by which `cos` makes its tables on the host; 0: as many as there are cores
  bool surface = false;     ///< contracts in a row that differ in the strike alone share solves; for `pide`
  ExerciseRule exercise = ExerciseRule::exact;  ///< `pide` alone, as the next
  bool one_grid = false;  ///< with `mesh`: nothing is extrapolated and no error stated, to compare
  bool timed_apart =
      false;  ///< copies from the rest, which waits for each; `surface` always does, `cos` never
};

/// Wall time of a batch's parts, s; where they are not timed apart it is all in `compute`.
struct WallTimes {
  double h2d = 0.0;
  double compute = 0.0;  ///< with tables of Bessel functions and what else the host does for it
  double d2h = 0.0;
};

/// A point of an early exercise boundary.
struct BoundaryPoint {
  double time;  ///< from now, years
  double spot;  ///< money: at it and beyond exercise is right
};

/// A price of an option at another spot, money both.
struct ProfilePoint {
  double spot, price;
};

/// Prices batches on a backend. Needs an initialised runtime.
class Pricer {
 public:
  virtual ~Pricer() = default;

  /// Prices every contract; `prices` has the length of `contracts`, each of which must satisfy
  /// `violated_condition` (std::invalid_argument for spans of different lengths). Returns when the prices
  /// are there. A contract's bits do not depend on the others of the batch.
  virtual WallTimes price(std::span<const Contract> contracts, std::span<Price> prices) = 0;

  /// Memory from which and to which a device copies without a detour: contracts and prices may lie there. It
  /// lasts as long as the pricer.
  [[nodiscard]] virtual std::pmr::memory_resource& memory() { return *std::pmr::new_delete_resource(); }

  /// The early exercise boundary of an American contract from now on to its expiry, a point for each step of
  /// the solve; empty where exercise is never right.
  [[nodiscard]] std::vector<BoundaryPoint> boundary(const Contract& contract) {
    return boundary_on(contract, 0, 0);
  }

  /// The same on a mesh and with steps, say those of a price. A mesh of 0 intervals is that of the settings,
  /// or 512.
  virtual std::vector<BoundaryPoint> boundary_on(const Contract& contract, int mesh, int steps) = 0;

  /// Prices now at the spots of the nodes of one solve, which rise; the contract's own spot only has a say in
  /// how far they reach. Prices are as good as one grid makes them. Since V(c spot, c strike) = c V they are
  /// those of other strikes as well.
  virtual std::vector<ProfilePoint> profile(const Contract& contract) = 0;
};

/// Throws std::invalid_argument for settings out of range; the backend must be available.
[[nodiscard]] std::unique_ptr<Pricer> create_pricer(device::Backend backend, const Settings& settings);

}  // namespace drogue::options
