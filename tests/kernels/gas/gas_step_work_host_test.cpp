// ctest-label: exact
#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/counted_step.hpp"

// Checks the tables of perf/models/gas_step.hpp by counting the operations of the kernels. A changed number
// means a changed cost per step.

namespace drogue::gas {
namespace {

using namespace drogue::perf;  // NOLINT: the counts that are tested
using drogue::testing::arithmetic_of;
using drogue::testing::Counted;
using Counting = drogue::testing::CountedStep<Counted>;
using Plain = drogue::testing::CountedStep<double>;

constexpr StageTable ssprk3 = stage_table(TimeScheme::ssprk3);

template <Reconstruction value>
using Scheme = std::integral_constant<Reconstruction, value>;

/// Calls `check(scheme, parameters)` for every scheme.
template <class Check>
void for_schemes(const Check& check) {
  const auto with = [&](auto scheme, Weno weno, int power) {
    Parameters p;
    p.cells = Counting::cells;
    p.weno = weno;
    p.weno_power = power;
    check(scheme, p);
  };
  with(Scheme<Reconstruction::js>{}, Weno::js, 1);
  with(Scheme<Reconstruction::z1>{}, Weno::z, 1);
  with(Scheme<Reconstruction::z2>{}, Weno::z, 2);
  with(Scheme<Reconstruction::m>{}, Weno::m, 1);
  with(Scheme<Reconstruction::teno5>{}, Weno::teno5, 1);
}

// ---- the counting itself ----

TEST(GasWork, IgnoresOperationsThatACompilerRemoves) {
  const double memory[2] = {2.0, 3.0};
  double result = 0.0;
  const Arithmetic cost = arithmetic_of([&] {
    const Counted x = Counted::load(memory), y = Counted::load(memory + 1);
    const Counted unused = x / y;
    const Counted constant = Counted(2.0) * 3.0 + 1.0;
    const Counted product = x * y, again = Counted::load(memory + 1) * x;
    (device::absolute(-product) + constant * again).store(&result);
    static_cast<void>(unused);
  });
  EXPECT_EQ(result, 48.0);
  EXPECT_EQ(cost, (Arithmetic{1, 2, 0, 0, 0}));
}

TEST(GasWork, CountsEveryKindOfOperation) {
  const Arithmetic cost = arithmetic_of([] {
    const Counted x = Counted::input(4.0), y = Counted::input(2.0);
    const auto [root, inverse, reciprocal] = device::root(x);
    EXPECT_EQ(root.value, 2.0);
    EXPECT_EQ(inverse.value, 0.5);
    EXPECT_EQ(reciprocal.value, 0.25);
    const Counted chosen = device::select(x > y, x - y, x / y);
    EXPECT_EQ(chosen.value, 2.0);
    (root + inverse * device::maximum(chosen, device::minimum(x, y))).keep();
  });
  EXPECT_EQ(cost, (Arithmetic{2, 2, 2, 1, 4}));
}

TEST(GasWork, CountedTypeComputesLikeDouble) {
#if defined(DROGUE_EXACT)
  constexpr double tolerance = 0.0;
#else
  constexpr double tolerance = 1e-13;  // fused multiply-adds
#endif
  for_schemes([&](auto scheme, const Parameters&) {
    Counting counted(ssprk3, 1);
    Plain plain(ssprk3, 1);
    counted.run_fused<scheme.value>();
    plain.run_fused<scheme.value>();
    for (std::size_t i = 0; i < plain.result().size(); ++i)
      ASSERT_LE(std::abs(counted.result()[i] - plain.result()[i]), tolerance);
  });
}

// ---- the tables ----

TEST(GasWork, FaceTableMatchesTheCount) {
  for_schemes([](auto scheme, const Parameters& p) {
    Counting count(ssprk3, 1);
    count.for_tiles(count.fused<scheme.value>().shape, [&](const auto& thread, const auto& tile) {
      count.load(thread, tile, 0);
      EXPECT_EQ(count.compute_face<scheme.value>(tile, 0), face_arithmetic(p.weno, p.weno_power));
    });
  });
}

TEST(GasWork, CellTableMatchesTheCount) {
  Counting count(ssprk3, 1);
  const auto step = count.fused<Reconstruction::js>();
  count.for_tiles(step.shape, [&](const auto& thread, const auto& tile) {
    EXPECT_EQ(count.load(thread, tile, 0), tile.slots * load_arithmetic);
    EXPECT_EQ(count.update<false>(step, tile, tile.halo, 0), update_arithmetic);
    EXPECT_EQ(count.update<true>(step, tile, tile.halo, 0), last_update_arithmetic);
  });
  const auto input = [] {
    return ConservedVector<Counted>{Counted::input(1), Counted::input(2), Counted::input(3)};
  };
  EXPECT_EQ(arithmetic_of([&] {
              const ConservedVector<Counted> u = runge_kutta_combination(input(), 0.75, input());
              u.rho.keep(), u.m.keep(), u.energy.keep();
            }),
            combined_arithmetic);
  EXPECT_EQ(arithmetic_of([&] {
              const auto [rho, m, energy] = input();
              const CellState<Counted> s = cell_state(1.4, rho, m, energy);
              s.u.keep(), s.p.keep(), s.enthalpy.keep(), s.c.keep();
            }),
            (Arithmetic{2, 7, 1, 1, 0}));
}

// Denominators of the weights of three fields from two sides, and c with 1/c of the eigenvectors.
TEST(GasWork, DividesOncePerWeightAndOncePerFace) {
  const auto divisions = [](Weno weno, int power) { return face_arithmetic(weno, power).divisions; };
  EXPECT_EQ(divisions(Weno::js, 1), 6 + 1);
  EXPECT_EQ(divisions(Weno::z, 1), 6 + 1);
  EXPECT_EQ(divisions(Weno::z, 2), 6 + 1);
  EXPECT_EQ(divisions(Weno::teno5, 1), 6 + 1);
  EXPECT_EQ(divisions(Weno::m, 1), 5 * 6 + 1) << "and the first weights, and three maps";
  for_schemes([](auto, const Parameters& p) { EXPECT_EQ(face_arithmetic(p.weno, p.weno_power).roots, 1); });
}

// ---- whole steps ----

template <Reconstruction scheme>
void expect_fused_work(const Parameters& p) {
  const StageTable table = stage_table(p.time_scheme);
  Counting count(table, 1);
  count.run_fused<scheme>();
  StepWork expected = step_work(p, {Counting::tile_cells, ghost_cells * table.stages, true});
  EXPECT_EQ(count.work.bytes, expected.bytes);
  // The host, which keeps no U^n in scratch memory, multiplies it by the sign of the boundary image.
  expected.arithmetic.multiplications += count.times_combined;
  EXPECT_EQ(count.work.arithmetic, expected.arithmetic);
}

TEST(GasWork, FusedStepMatchesTheTileModel) {
  for_schemes([](auto scheme, Parameters p) {
    expect_fused_work<scheme.value>(p);
    p.time_scheme = TimeScheme::ssprk43;
    if (p.weno == Weno::js) expect_fused_work<scheme.value>(p);
  });
}

TEST(GasWork, StageKernelsMatchTheTileModel) {
  for (const TimeScheme time : {TimeScheme::ssprk3, TimeScheme::ssprk43}) {
    Parameters p;
    p.cells = Counting::cells;
    p.time_scheme = time;
    Counting count(stage_table(time), 1);
    count.run_stages<Reconstruction::js>();
    EXPECT_EQ(count.work.bytes, step_work(p, {Counting::tile_cells, ghost_cells, false}).bytes);
  }
}

TEST(GasWork, BytesWithoutHaloEqualTheStates) {
  Parameters p;
  EXPECT_EQ(step_work(p, {50, 0, true}).bytes, 48 * p.cells);
  EXPECT_EQ(step_work(p, {50, 0, false}).bytes, 192 * p.cells);
}

// Tiles of 384 slots, those of a large mesh on a device; docs/gas-notebook.md quotes these numbers.
TEST(GasWork, OperationsPerCellAndStageMatchTheDocumentation) {
  const auto operations = [](Weno weno, int power) {
    Parameters p;
    p.cells = 366;
    p.weno = weno;
    p.weno_power = power;
    return std::lround(static_cast<double>(step_work(p, {366, 9, true}).arithmetic.flops()) / (3.0 * 366.0));
  };
  EXPECT_EQ(operations(Weno::js, 1), 517);
  EXPECT_EQ(operations(Weno::z, 1), 541);
  EXPECT_EQ(operations(Weno::z, 2), 615);
  EXPECT_EQ(operations(Weno::m, 1), 688);
  EXPECT_EQ(operations(Weno::teno5, 1), 645);
}

TEST(GasWork, UncountedVariantsReportZero) {
  const Tiling fused{50, 9, true};
  Parameters p;
  EXPECT_GT(step_work(p, fused).arithmetic.flops(), 0);
  p.precision = Precision::split;
  EXPECT_EQ(step_work(p, fused).arithmetic, Arithmetic{});
  p.precision = Precision::full;
  p.face_average = FaceAverage::roe;
  EXPECT_EQ(step_work(p, fused).arithmetic, Arithmetic{});
  p.face_average = FaceAverage::arithmetic;
  p.positivity = Positivity::on;
  EXPECT_EQ(step_work(p, fused).arithmetic, Arithmetic{});
  p.positivity = Positivity::off;
  EXPECT_EQ(step_work(p, {50, 3, false}).arithmetic, Arithmetic{});
  EXPECT_EQ(step_work(p, {}).bytes, 0);
}

TEST(GasWork, SolversReportTheirTiling) {
  Parameters p;
  p.cells = 1000;
  const auto tiling = [&] { return create_solver(device::Backend::serial, p)->tiling(); };
  EXPECT_EQ(tiling().cells, 256);
  EXPECT_EQ(tiling().halo, 9);
  EXPECT_TRUE(tiling().fused);
  p.splitting = Splitting::lf_global;
  EXPECT_EQ(tiling().halo, 3);
  EXPECT_FALSE(tiling().fused);
}

}  // namespace
}  // namespace drogue::gas
