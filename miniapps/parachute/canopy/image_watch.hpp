#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "miniapps/parachute/canopy/periodic_images.hpp"
#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::parachute_app {

/// State of sheets after a step of the flow.
struct SheetMotion {
  std::int64_t step = 0;
  double time = 0.0, dt = 0.0;                            ///< s; the last dt
  std::span<const fabric::Vector> positions, velocities;  ///< m and m/s
};

/// Watches over a run that no sheet meets an image beyond periodic sides, where contact does not act. Boxes
/// around the sheets bound the number of steps in which none can meet; where boxes overlap, the sheets
/// themselves are compared.
class ImageWatch {
 public:
  /// Keeps a reference to `sheets`, of the scene, which has a fluid. Throws only std::bad_alloc.
  ImageWatch(const FlowScene& scene, const Sheets& sheets);

  /// False if nothing can meet. Does not throw.
  [[nodiscard]] bool applies() const { return _next != never; }
  /// Step of the flow after which to look. Does not throw.
  [[nodiscard]] std::int64_t next() const { return _next; }

  /// Compares sheets with images, and sets `next`. Returns what meets, and where, as a part of a sentence.
  /// Throws only std::bad_alloc.
  [[nodiscard]] std::optional<std::string> look(const SheetMotion& now);

 private:
  static constexpr auto never = std::numeric_limits<std::int64_t>::max();

  const Sheets& _sheets;
  SheetParts _parts;
  std::vector<fabric::Vector> _periods;
  std::int64_t _next = 0;
};

}  // namespace drogue::parachute_app
