#include "kernels/mesh/generators.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "kernels/mesh/round_surfaces.hpp"

namespace drogue::mesh {
namespace {

/// Numbers of cells.
struct Counts {
  int columns, rows;
};

/// Numbers of cells of size h by h such that (width/h + 1)(height/h + 1) is about `vertices`.
Counts counts(double width, double height, int vertices) {
  const double area = width * height, half = 0.5 * (width + height);
  const double per_metre = (std::sqrt(half * half + area * (vertices - 1.0)) - half) / area;
  const auto cells = [&](double length) {
    return std::max(1, static_cast<int>(std::lround(length * per_metre)));
  };
  return {cells(width), cells(height)};
}

/// Positive n at which an increasing function is closest to `requested`.
template <class Function>
int closest_count(int requested, const Function& vertices_of) {
  int n = 1;
  while (vertices_of(n) < requested) ++n;
  return n > 1 && requested - vertices_of(n - 1) <= vertices_of(n) - requested ? n - 1 : n;
}

/// Pseudo-random number in [-1, 1), identical on every machine (SplitMix, Steele et al. 2014).
double pseudo_random(std::uint64_t seed) {
  seed = (seed + 1) * 0x9e3779b97f4a7c15U;
  seed = (seed ^ (seed >> 30U)) * 0xbf58476d1ce4e5b9U;
  seed = (seed ^ (seed >> 27U)) * 0x94d049bb133111ebU;
  return std::ldexp(static_cast<double>(seed >> 11U), -52) - 1.0;
}

/// Displaces the interior vertices of a rectangle.
void distort(const Rectangle& shape, const Counts& counts, Mesh& mesh) {
  for (std::size_t n = 0; n < mesh.rest.size(); ++n) {
    const int i = static_cast<int>(n) % (counts.columns + 1), j = static_cast<int>(n) / (counts.columns + 1);
    if (i == 0 || i == counts.columns || j == 0 || j == counts.rows) continue;
    mesh.rest[n][0] += shape.distortion * shape.width / counts.columns * pseudo_random(2 * n);
    mesh.rest[n][1] += shape.distortion * shape.height / counts.rows * pseudo_random(2 * n + 1);
  }
}

}  // namespace

Mesh rectangle(double width, double height, int columns, int rows) {
  Mesh mesh;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) mesh.rest.push_back({width * i / columns, height * j / rows, 0.0});
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int a = j * (columns + 1) + i, b = a + 1, c = a + columns + 1, d = c + 1;
      if ((i + j) % 2 == 0) {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({a, d, c});
      } else {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({b, d, c});
      }
    }
  return mesh;
}

Mesh generate(const Rectangle& shape) {
  const Counts cells = counts(shape.width, shape.height, shape.vertices);
  Mesh mesh = rectangle(shape.width, shape.height, cells.columns, cells.rows);
  if (shape.distortion > 0.0) distort(shape, cells, mesh);
  return mesh;
}

Mesh generate(const Disk& shape) {
  return disk(shape.radius, closest_count(shape.vertices, [](int n) { return 1 + 3 * n * (n + 1); }));
}

Mesh generate(const Strip& shape) {
  // The height of a row is sqrt(3)/2 of an edge.
  const auto [columns, rows] = counts(shape.length, 2.0 * shape.width / std::numbers::sqrt3, shape.vertices);
  Mesh mesh;
  std::vector<int> first;  // first vertex of every row, and the end
  for (int j = 0; j <= rows; ++j) {
    first.push_back(static_cast<int>(mesh.rest.size()));
    // Odd rows are shifted by half an edge and have one more vertex at their straight end.
    const bool odd = j % 2 == 1;
    for (int i = 0; i <= columns + (odd ? 1 : 0); ++i) {
      const double place = odd ? std::clamp(i - 0.5, 0.0, static_cast<double>(columns)) : i;
      mesh.rest.push_back({shape.length * place / columns, shape.width * j / rows, 0.0});
    }
  }
  first.push_back(static_cast<int>(mesh.rest.size()));
  for (std::size_t j = 0; j < static_cast<std::size_t>(rows); ++j) {
    const bool even_below = j % 2 == 0;
    const int even = first[even_below ? j : j + 1], odd = first[even_below ? j + 1 : j];
    const auto add = [&](int a, int b, int c) {
      mesh.triangles.push_back(even_below ? std::array{a, b, c} : std::array{a, c, b});
    };
    for (int i = 0; i <= columns; ++i) {
      add(even + i, odd + i + 1, odd + i);
      if (i < columns) add(even + i, even + i + 1, odd + i + 1);
    }
  }
  return mesh;
}

Mesh generate(const Triangle& shape) {
  const int n = closest_count(shape.vertices, [](int k) { return (k + 1) * (k + 2) / 2; });
  Mesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n - j; ++i)
      mesh.rest.push_back(
          {shape.side * (i + 0.5 * j) / n, shape.side * 0.5 * std::numbers::sqrt3 * j / n, 0.0});
  for (int j = 0, row = 0; j < n; row += n - j + 1, ++j)
    for (int i = 0; i < n - j; ++i) {
      const int a = row + i, above = row + (n - j + 1) + i;
      mesh.triangles.push_back({a, a + 1, above});
      if (i + 1 < n - j) mesh.triangles.push_back({a + 1, above + 1, above});
    }
  return mesh;
}

Mesh generate(const String& shape) {
  Mesh mesh;
  for (int i = 0; i < shape.vertices; ++i) {
    const double s = static_cast<double>(i) / (shape.vertices - 1);
    Vector point;
    for (std::size_t axis = 0; axis < 3; ++axis)
      point[axis] = (1.0 - s) * shape.from[axis] + s * shape.to[axis];
    mesh.rest.push_back(point);
    if (i > 0) mesh.lines.push_back({i - 1, i});
  }
  return mesh;
}

}  // namespace drogue::mesh
