#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "tests/support/counted.hpp"

namespace drogue::testing {

/// Split exercise alone has exponentials in its steps; it is not counted.
inline Counted exponential(Counted) { throw std::logic_error("an exponential in a step"); }

}  // namespace drogue::testing

// These headers must follow the definition of the counted type.
#include "kernels/options/pide/march.hpp"
#include "perf/models/options_march.hpp"

// Checks the table of perf/models/options_march.hpp by counting the operations of `options::step`.

namespace drogue::perf {
namespace {

using testing::arithmetic_of;
using testing::Counted;

/// Arrays of a march whose numbers are inputs.
class CountedMarch {
 public:
  CountedMarch(int mesh, int lanes) : _mesh(mesh), _group{lanes} {}

  Arithmetic operations_of_a_step() {
    return arithmetic_of([this] {
      const auto row = static_cast<std::size_t>(options::node_count(_mesh));
      _nodes = inputs(12 * row);
      _weights = inputs(static_cast<std::size_t>(options::WeightLayout<Counted>(_mesh).size()));
      _scratch.assign(9 * options::max_lanes, Counted(0.0));
      _roots = options::fourier_roots();
      const auto place = [&](std::size_t k) { return _nodes.data() + k * row; };
      const options::March<Counted> march{{place(0), place(1), place(2)},
                                          {place(3), place(4)},
                                          place(5),
                                          place(6),
                                          place(7),
                                          place(8),
                                          _scratch.data()};
      options::PutPack<Counted> put{};
      put.any_split = false, put.rate = input();
      options::Jumps<Counted> jumps{};
      jumps.w = _weights.data(), jumps.exit_mass = place(9), jumps.exit_price = place(10),
      jumps.rate = input();
      _spectrum.resize(static_cast<std::size_t>(options::padded(_mesh)));
      for (options::ComplexNumber<Counted>& number : _spectrum) number = {input(), input()};
      const options::JumpSpectrum<Counted> spectrum{options::FourierRoots::from_table(_roots.data()),
                                                    _spectrum.data()};
      options::StepFactors<Counted> f{};
      for (Counted* factor : {&f.value, &f.before, &f.explicit_now, &f.explicit_before, &f.from_left,
                              &f.from_right, &f.left_value})
        *factor = input();
      const options::DiscountFactors<Counted> discount{input(), input()};
      options::step(_group, put, jumps, {_mesh, input(), input()}, spectrum, march, f, discount);
      for (int i = 0; i < _mesh; ++i) march.value[0][i].keep(), march.jump[0][i].keep();
    });
  }

 private:
  static Counted input() { return Counted::input(0.5); }
  static std::vector<Counted> inputs(std::size_t count) {
    std::vector<Counted> made;
    for (std::size_t i = 0; i < count; ++i) made.push_back(input());
    return made;
  }

  int _mesh;
  options::SerialThreadGroup<Counted> _group;
  std::vector<Counted> _nodes, _weights, _scratch;
  std::vector<options::ComplexNumber<Counted>> _spectrum;
  std::vector<double> _roots;
};

TEST(OptionsWork, TableOfStepsMatchesTheCount) {
  for (const auto& [mesh, lanes] : {std::pair{32, 16}, {64, 16}, {128, 16}, {128, 32}, {256, 32}})
    EXPECT_EQ(CountedMarch(mesh, lanes).operations_of_a_step(), options_step_arithmetic(mesh, lanes))
        << mesh << " intervals, " << lanes << " lanes";
  EXPECT_EQ(options_step_arithmetic(512, 32), Arithmetic{});
}

TEST(OptionsWork, LanesAreThoseOfThePricer) {
  for (const int mesh : {32, 64, 100, 128, 256, 512})
    EXPECT_EQ(option_lanes(mesh), options::lanes_of(mesh)) << mesh;
}

TEST(OptionsWork, TransformsNeedFewerOperationsThanSums) {
  EXPECT_LT(options_step_arithmetic(128, 16).flops(), options_step_arithmetic(128, 32).flops());
  // A sum over all pairs of nodes.
  EXPECT_GT(options_step_arithmetic(128, 32).flops(), 2 * 128 * 128);
}

TEST(OptionsWork, MarchesHaveHalfOfTheStepsOnTheCoarserMesh) {
  EXPECT_EQ(options_march_arithmetic(128, 32),
            32 * options_step_arithmetic(128, 16) + 16 * options_step_arithmetic(64, 16));
  EXPECT_EQ(options_march_arithmetic(256, 64),
            64 * options_step_arithmetic(256, 32) + 32 * options_step_arithmetic(128, 32));
  EXPECT_EQ(options_march_arithmetic(512, 64), Arithmetic{});
}

}  // namespace
}  // namespace drogue::perf
