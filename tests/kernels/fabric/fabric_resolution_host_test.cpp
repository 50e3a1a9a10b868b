#include <gtest/gtest.h>

#include "kernels/device/instance.hpp"
#include "kernels/fabric/contact/contact_impl.hpp"
#include "tests/support/emulated_grid.hpp"
#include "tests/support/fabric_sheets.hpp"

// Contact of an interval in one persistent kernel, emulated by host threads, against the kernels one by one.

namespace drogue::fabric {
namespace {

using ResolutionSpace = Kokkos::Serial;

/// Sheets at the end of an interval, s, in which nothing but their velocities moved them.
class MovedSheets {
 public:
  MovedSheets(const testing::Sheets& start, double duration)
      : _instance(ResolutionSpace()),
        _monitor(stepping::make_monitor<ResolutionSpace>(StepMonitor<ResolutionSpace>::StatusView("status"))),
        x("x", start.x.size()),
        v("v", start.x.size()) {
    const std::size_t n = start.x.size();
    ContactInputs<ResolutionSpace> inputs{_instance, {}, {}, _monitor};
    inputs.inverse_mass = decltype(inputs.inverse_mass)("inverse_mass", n);
    inputs.fixed_dofs = decltype(inputs.fixed_dofs)("fixed_dofs", n);
    for (std::size_t i = 0; i < n; ++i) {
      inputs.inverse_mass(i) = 1.0 / start.p.mass[i];
      for (std::size_t axis = 0; axis < 3; ++axis)
        x(i, axis) = start.x[i][axis], v(i, axis) = start.v[i][axis];
    }
    stepping::reset_monitor(ResolutionSpace(), _monitor, 0);
    Contact every_ten_steps = start.p.contact;
    every_ten_steps.interval = 10;
    contact = std::make_unique<ContactImpl<ResolutionSpace>>(start.p.mesh, every_ten_steps, start.p.driver,
                                                             start.p.dt, inputs);
    contact->begin_interval(x, duration);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) x(i, axis) += duration * v(i, axis);
  }

  [[nodiscard]] bool has_failed() const { return _monitor.has_failed(); }

 private:
  device::Instance<ResolutionSpace> _instance;
  StepMonitor<ResolutionSpace> _monitor;

 public:
  PointsView<ResolutionSpace> x, v;
  std::unique_ptr<ContactImpl<ResolutionSpace>> contact;
};

/// Largest difference of an entry, m or m/s.
double largest_difference(const PointsView<ResolutionSpace>& a, const PointsView<ResolutionSpace>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.extent(0); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      largest = std::max(largest, std::abs(a(i, axis) - b(i, axis)));
  return largest;
}

void expect_the_same_resolution(const testing::Sheets& start, double duration, bool crosses) {
  const MovedSheets untouched(start, duration), one_by_one(start, duration), at_once(start, duration);
  one_by_one.contact->end_interval(one_by_one.x, one_by_one.v);
  const ContactViews<ResolutionSpace>& views = at_once.contact->views();
  testing::EmulatedGrid grid(3, 32, 0, 1);
  grid.launch(PersistentResolutionFunctor<ResolutionSpace>{{views}, at_once.x, at_once.v});
  EXPECT_FALSE(one_by_one.has_failed());
  EXPECT_FALSE(at_once.has_failed());
  EXPECT_GT(views.progress(0).constraints, 0);
  EXPECT_EQ(views.progress(0).crossing[0] != 0, crosses);
  EXPECT_GT(largest_difference(at_once.x, untouched.x), 1e-6);
  EXPECT_LT(largest_difference(at_once.x, one_by_one.x), 1e-13);
  EXPECT_LT(largest_difference(at_once.v, one_by_one.v), 1e-11);
}

TEST(PersistentResolution, MovesSheetsAsKernelsOneByOneDo) {
  expect_the_same_resolution(testing::impact(3.0), 0.002, false);
  expect_the_same_resolution(testing::edge_on(3.0), 0.004, false);
  // Impulses are not enough: parts move as rigid zones.
  expect_the_same_resolution(testing::folded(3.0), 0.006, true);
  expect_the_same_resolution(testing::corner_on(3.0), 0.004, true);
}

TEST(PersistentResolution, NarrowsTheMarginOfCrowdedLists) {
  testing::Sheets layers;
  for (int layer = 0; layer < 24; ++layer)
    layers.add(4, 0.3, testing::level(0.003 * layer, 0.002 * layer, 0.003 * layer),
               {0.0, 0.0, layer < 22 ? 0.0 : -0.5});
  layers.p.contact.thickness = 0.002;
  expect_the_same_resolution(layers, 0.003, false);
}

}  // namespace
}  // namespace drogue::fabric
