#include <gtest/gtest.h>

#include <Kokkos_Core.hpp>
#include <random>

#include "kernels/fabric/contact/continuous_detection.hpp"
#include "kernels/reference/fabric/distance.hpp"

// Distances and continuous collision detection in the tested memory space, on random data, against the
// reference in extended precision.

namespace drogue::fabric {
namespace {

using Space = DROGUE_TEST_SPACE;
using Memory = Space::memory_space;
using reference::first_meeting;
using reference::hull_distance;
using reference::Place3;
using Four = std::array<Place3, 4>;
using FourPlaces = Kokkos::View<double* [4][3], Memory>;

KOKKOS_INLINE_FUNCTION Point place_of(const FourPlaces& at, int k, int i) {
  return {at(k, i, 0), at(k, i, 1), at(k, i, 2)};
}

/// Barycentric coordinates and squared distance, m^2, of the closest points: first of a vertex and a
/// triangle, then of two edges.
struct NearestFunctor {
  FourPlaces at;
  Kokkos::View<double* [7], Memory> out;

  KOKKOS_FUNCTION void operator()(const int k) const {
    const Point p = place_of(at, k, 0), q = place_of(at, k, 1), r = place_of(at, k, 2),
                s = place_of(at, k, 3);
    const Point triangle[3] = {q, r, s}, first[2] = {p, q}, second[2] = {r, s};
    const ClosestOnTriangle face = closest_on_triangle(p, triangle);
    const ClosestOfSegments edges = closest_of_segments(first, second);
    for (int i = 0; i < 3; ++i) out(k, i) = face.weight[i];
    out(k, 3) = face.squared;
    out(k, 4) = edges.first, out(k, 5) = edges.second, out(k, 6) = edges.squared;
  }
};

/// Continuous collision detection for a vertex and a triangle, and for two edges, in linear motion.
struct ApartFunctor {
  FourPlaces from, to;
  double thickness;
  Kokkos::View<int* [2], Memory> separated;

  KOKKOS_FUNCTION void operator()(const int k) const {
    Point begin[4], displacement[4];
    double longest[4];
    for (int i = 0; i < 4; ++i) {
      begin[i] = place_of(from, k, i);
      displacement[i] = place_of(to, k, i) - begin[i];
      longest[i] = length(displacement[i]);
    }
    const auto at = [&](int i, double part) { return begin[i] + part * displacement[i]; };
    const auto larger = [](double a, double b) { return a > b ? a : b; };
    const auto of_face = [&](double part) {
      const Point triangle[3] = {at(1, part), at(2, part), at(3, part)};
      return Kokkos::sqrt(closest_on_triangle(at(0, part), triangle).squared);
    };
    const auto of_edges = [&](double part) {
      const Point first[2] = {at(0, part), at(1, part)}, second[2] = {at(2, part), at(3, part)};
      return Kokkos::sqrt(closest_of_segments(first, second).squared);
    };
    const double others = larger(longest[2], longest[3]);
    separated(k, 0) = ccd_keeps_distance(of_face, longest[0] + larger(longest[1], others), thickness);
    separated(k, 1) = ccd_keeps_distance(of_edges, larger(longest[0], longest[1]) + others, thickness);
  }
};

FourPlaces to_device(const std::vector<Four>& places) {
  const FourPlaces view("places", places.size());
  const auto mirror = Kokkos::create_mirror_view(view);
  for (std::size_t k = 0; k < places.size(); ++k)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) mirror(k, i, axis) = places[k][i][axis];
  Kokkos::deep_copy(view, mirror);
  return view;
}

template <class View>
auto to_host(const View& view) {
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view);
}

/// Four random points in a cube of 2 m, or a degenerate configuration of `kind` 1 to 4.
class Random {
 public:
  explicit Random(unsigned seed) : _generator(seed) {}

  Four four(int kind) {
    Four f;
    for (Place3& p : f)
      for (double& c : p) c = number();
    if (kind == 1)  // in a plane
      for (Place3& p : f) p[2] = 0.0;
    if (kind == 2)  // a needle: a triangle of a height of 1e-7, edges that nearly share a line
      for (std::size_t i = 2; i < 4; ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
          f[i][axis] = f[1][axis] + (i == 2 ? 1.0 : 0.4) * (f[2][axis] - f[1][axis]) + 1e-7 * number();
    if (kind == 3)  // parallel edges
      for (std::size_t axis = 0; axis < 3; ++axis) f[3][axis] = f[2][axis] + 0.7 * (f[1][axis] - f[0][axis]);
    if (kind == 4) f[3] = f[2];  // an edge without length
    return f;
  }
  double number() { return std::uniform_real_distribution(-1.0, 1.0)(_generator); }

 private:
  std::mt19937_64 _generator;
};

constexpr int pairs = 1000;

TEST(FabricDistance, MatchesClosestPointsOfTheReference) {
  Random random(1);
  std::vector<Four> places;
  for (int k = 0; k < pairs; ++k) places.push_back(random.four(k % 5));
  const Kokkos::View<double* [7], Memory> out("nearest", places.size());
  Kokkos::parallel_for("distance_test", Kokkos::RangePolicy<Space>(0, pairs),
                       NearestFunctor{to_device(places), out});
  const auto found = to_host(out);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Four& p = places[k];
    const std::span<const Place3> all(p);
    EXPECT_NEAR(std::sqrt(found(k, 3)), hull_distance(all.first(1), all.subspan(1)), 1e-14) << "pair " << k;
    EXPECT_NEAR(std::sqrt(found(k, 6)), hull_distance(all.first(2), all.subspan(2)), 1e-14) << "pair " << k;
    EXPECT_NEAR(found(k, 0) + found(k, 1) + found(k, 2), 1.0, 1e-15);
    double on_face = 0.0, between = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double r = p[0][axis];
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_GE(found(k, i), 0.0);
        r -= found(k, i) * p[1 + i][axis];
      }
      on_face += r * r;
      const double s = found(k, 4), u = found(k, 5);
      const double d = (1.0 - s) * p[0][axis] + s * p[1][axis] - (1.0 - u) * p[2][axis] - u * p[3][axis];
      between += d * d;
    }
    EXPECT_NEAR(std::sqrt(on_face), std::sqrt(found(k, 3)), 1e-14)
        << "the barycentric coordinates define the closest point";
    EXPECT_NEAR(std::sqrt(between), std::sqrt(found(k, 6)), 1e-14);
  }
}

/// Distances, m, in linear motion: at its start, the least sampled one, and the bound of the sampling error,
/// which is the relative displacement in half of a sampling interval.
struct SampledDistances {
  double start, least, sampling_error;
};
SampledDistances sample_distances(const Four& from, const Four& to, std::size_t split) {
  constexpr int samples = 100;
  SampledDistances sampled{0.0, 1e300, 0.0};
  for (std::size_t i = 0; i < 4; ++i)
    sampled.sampling_error =
        std::max(sampled.sampling_error,
                 std::hypot(to[i][0] - from[i][0], to[i][1] - from[i][1], to[i][2] - from[i][2]) / samples);
  for (int sample = 0; sample <= samples; ++sample) {
    Four at;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        at[i][axis] = from[i][axis] + sample * (to[i][axis] - from[i][axis]) / samples;
    const std::span<const Place3> all(at);
    const double distance = hull_distance(all.first(split), all.subspan(split));
    if (sample == 0) sampled.start = distance;
    sampled.least = std::min(sampled.least, distance);
  }
  return sampled;
}

TEST(FabricDistance, DetectsEveryCollisionInLinearMotion) {
  constexpr double thickness = 0.01;
  Random random(2);
  std::vector<Four> from, to;
  for (int k = 0; k < pairs; ++k) {
    from.push_back(random.four(0));
    to.push_back(from.back());
    for (Place3& p : to.back())
      for (double& c : p) c += random.number();
  }
  const Kokkos::View<int* [2], Memory> separated("separated", from.size());
  Kokkos::parallel_for("motion_test", Kokkos::RangePolicy<Space>(0, pairs),
                       ApartFunctor{to_device(from), to_device(to), thickness, separated});
  const auto found = to_host(separated);
  int meetings = 0, free = 0;
  for (std::size_t k = 0; k < from.size(); ++k)
    for (std::size_t split = 1; split <= 2; ++split) {
      const bool accepted = found(k, split - 1) != 0;
      const SampledDistances sampled = sample_distances(from[k], to[k], split);
      if (first_meeting(from[k], to[k], split, 1e-12)) {
        ++meetings;
        EXPECT_FALSE(accepted) << "pair " << k << ", " << split << " against the others";
      }
      if (accepted) {
        EXPECT_GT(sampled.least, 0.9 * least_distance(sampled.start, thickness)) << "pair " << k;
      }
      if (sampled.least - sampled.sampling_error > 2.0 * thickness) {
        ++free;
        EXPECT_TRUE(accepted) << "pair " << k << " is rejected although its distance suffices";
      }
    }
  EXPECT_GT(meetings, pairs / 20);
  EXPECT_GT(free, pairs);
}

}  // namespace
}  // namespace drogue::fabric
