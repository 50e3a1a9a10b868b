#include "miniapps/parachute/canopy/periodic_images.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "common/scene/node.hpp"
#include "kernels/reference/fabric/intersections.hpp"
#include "miniapps/parachute/bodies/box.hpp"

namespace drogue::parachute_app {
namespace {

using fabric::Vector;

/// Displacement to an image, from which rounding parts what ends at the sides.
Vector beyond(Vector period) {
  for (double& x : period) x *= 1.0 + 1e-9;
  return period;
}

/// Boxes around the vertices of every part, and around its lines to common payloads.
std::vector<Box> boxes_of(std::span<const Vector> positions, std::span<const std::array<int, 2>> lines,
                          const SheetParts& parts) {
  std::vector<Box> boxes(parts.ends.size(), empty_box);
  std::size_t vertex = 0;
  for (std::size_t part = 0; part < boxes.size(); ++part)
    for (; vertex < parts.ends[part]; ++vertex) extend(boxes[part], positions[vertex]);
  for (const auto& [a, b] : lines) extend(boxes[parts.of(a)], positions[static_cast<std::size_t>(b)]);
  return boxes;
}

/// Appends the elements of a part that reach into a box, with numbers of vertices from `first` on.
template <std::size_t n>
void append_part(std::span<const std::array<int, n>> elements, std::span<const Vector> positions,
                 const SheetParts& parts, std::size_t part, const Box& box, int first,
                 std::vector<std::array<int, n>>& result) {
  for (const std::array<int, n>& element : elements)
    if (parts.of(element[0]) == part) append_within(box, element, positions, first, result);
}

}  // namespace

std::vector<Vector> periods_of(const flow::Parameters& p) {
  Vector width{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (p.cells[axis] > 1 && p.boundary[2 * axis].kind == flow::BoundaryKind::periodic)
      width[axis] = p.high[axis] - p.low[axis];
  std::vector<Vector> periods;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -1; k <= 1; ++k) {
        const std::array<int, 3> steps = {i, j, k};
        const bool is_first_of_pair = steps > std::array<int, 3>{0, 0, 0};
        Vector period{};
        bool repeats = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          repeats = repeats && (steps[axis] == 0 || width[axis] > 0.0);
          period[axis] = steps[axis] * width[axis];
        }
        if (is_first_of_pair && repeats) periods.push_back(period);
      }
  return periods;
}

std::size_t SheetParts::of(int vertex) const {
  const auto found = std::ranges::upper_bound(ends, static_cast<std::size_t>(vertex));
  return std::min(static_cast<std::size_t>(found - ends.begin()), ends.size() - 1);
}

std::string SheetParts::name(std::size_t part) const {
  if (part < bodies) return scene::element("body", part);
  if (part < bodies + canopies) return scene::element("canopy", part - bodies);
  return scene::element("flag", part - bodies - canopies);
}

SheetParts parts_of(const std::vector<Body>& bodies, const Sheets& sheets) {
  SheetParts parts;
  std::size_t end = 0;
  for (const Body& body : bodies) {
    parts.ends.push_back(end += static_cast<std::size_t>(body.vertices()));
    parts.moves.push_back(body.moves() || body.mount);
  }
  for (const CanopyRows& rows : sheets.canopies) parts.ends.push_back(rows.end);
  for (const FlagRows& rows : sheets.flags) parts.ends.push_back(rows.end);
  parts.moves.resize(parts.ends.size(), true);
  parts.bodies = bodies.size();
  parts.canopies = sheets.canopies.size();
  return parts;
}

std::vector<ImageIntersection> image_intersections(std::span<const Vector> positions,
                                                   const SheetElements& elements,
                                                   std::span<const Vector> periods, const SheetParts& parts) {
  std::vector<ImageIntersection> found;
  const std::vector<Box> boxes = boxes_of(positions, elements.lines, parts);
  const auto n = static_cast<int>(positions.size());
  std::vector<Vector> both(positions.begin(), positions.end());
  both.resize(2 * positions.size());
  const std::span<Vector> images = std::span(both).subspan(positions.size());
  for (const Vector& period : periods) {
    const Vector by = beyond(period);
    std::ranges::transform(positions, images.begin(), [&](const Vector& x) { return displaced(x, by); });
    for (std::size_t a = 0; a < boxes.size(); ++a)
      for (std::size_t b = 0; b < boxes.size(); ++b) {
        const Box image = displaced(boxes[b], by);
        if ((a == b && a < parts.bodies) || distance(boxes[a], image) > 0.0) continue;
        const Box region = common(boxes[a], image);
        std::vector<std::array<int, 3>> triangles;
        std::vector<std::array<int, 2>> lines;
        append_part(elements.triangles, positions, parts, a, region, 0, triangles);
        append_part(elements.lines, positions, parts, a, region, 0, lines);
        append_part(elements.triangles, images, parts, b, region, n, triangles);
        append_part(elements.lines, images, parts, b, region, n, lines);
        for (const auto& [segment, number] : reference::intersections(both, triangles, lines))
          if (const int one = segment[0], other = triangles[number][0]; (one < n) != (other < n))
            found.push_back({one % n, other % n});
      }
  }
  return found;
}

double distance_from_images(std::span<const Vector> positions, std::span<const std::array<int, 2>> lines,
                            std::span<const Vector> periods, const SheetParts& parts) {
  const std::vector<Box> boxes = boxes_of(positions, lines, parts);
  double least = std::numeric_limits<double>::infinity();
  for (const Vector& period : periods)
    for (std::size_t a = 0; a < boxes.size(); ++a)
      for (std::size_t b = 0; b < boxes.size(); ++b)
        if (!(a == b && a < parts.bodies) && (parts.moves[a] || parts.moves[b]))
          least = std::min(least, distance(boxes[a], displaced(boxes[b], beyond(period))));
  return least;
}

std::vector<std::array<int, 2>> whole_lines(const Sheets& sheets, double time) {
  if (sheets.canopies.empty()) return {};
  const auto& lines = sheets.fabric.mesh.lines;
  std::vector<bool> is_cut(lines.size(), false);
  for (const coupling::LineCut& cut : sheets.cuts)
    for (const int line : cut.lines)
      if (cut.time < time) is_cut[static_cast<std::size_t>(line)] = true;
  std::vector<std::array<int, 2>> whole;
  for (std::size_t line = 0; line < is_cut.size(); ++line)
    if (!is_cut[line]) whole.push_back(lines[line]);
  return whole;
}

}  // namespace drogue::parachute_app
