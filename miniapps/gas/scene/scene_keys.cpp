#include "miniapps/gas/scene/scene_keys.hpp"

#include <algorithm>

#include "common/scene/codec.hpp"

namespace drogue::gas_app {
namespace {

using scene::between, scene::ChoiceKey, scene::Choices, scene::Condition, scene::Key, scene::not_negative,
    scene::positive, scene::Table;

constexpr double smallest_mesh = 8;
constexpr double largest_mesh = 268435456;  // 2^28

const Choices<gas::Weno> weno_choices = {
    {"js", gas::Weno::js}, {"z", gas::Weno::z}, {"m", gas::Weno::m}, {"teno5", gas::Weno::teno5}};
const Choices<gas::Splitting> splitting_choices = {{"lf-global", gas::Splitting::lf_global},
                                                   {"lf-single", gas::Splitting::lf_single},
                                                   {"lf-stencil", gas::Splitting::lf_stencil}};
const Choices<gas::TimeScheme> time_choices = {{"ssprk3", gas::TimeScheme::ssprk3},
                                               {"ssprk43", gas::TimeScheme::ssprk43}};
const Choices<gas::FaceAverage> mean_choices = {{"arithmetic", gas::FaceAverage::arithmetic},
                                                {"conserved", gas::FaceAverage::conserved},
                                                {"roe", gas::FaceAverage::roe}};
const Choices<gas::Positivity> positivity_choices = {
    {"off", gas::Positivity::off}, {"on", gas::Positivity::on}, {"auto", gas::Positivity::automatic}};
const Choices<gas::Precision> precision_choices = {{"double", gas::Precision::full},
                                                   {"split", gas::Precision::split}};
const Choices<gas::Boundary> boundary_choices = {{"outflow", gas::Boundary::outflow},
                                                 {"reflecting", gas::Boundary::reflecting},
                                                 {"periodic", gas::Boundary::periodic}};
const Choices<gas::Driver> driver_choices = {{"auto", gas::Driver::automatic},
                                             {"plain", gas::Driver::plain},
                                             {"graph", gas::Driver::graph},
                                             {"persistent", gas::Driver::persistent},
                                             {"stages", gas::Driver::stages}};
const Choices<Exact> exact_choices = {
    {"riemann", Exact::riemann}, {"advection", Exact::advection}, {"reference", Exact::reference}};

/// Declares the scheme keys that a run shares with its finer reference run.
void declare_weights(Table& table, gas::Parameters& scheme) {
  const ChoiceKey weno("weno", scheme.weno, weno_choices);
  table.value(weno, "Nonlinear weights of the reconstruction");
  table.value("weno_power", scheme.weno_power, "Power of the ratio in the weights",
              {.range = between(1, 2), .when = weno.is({gas::Weno::z})});
  table.value("splitting", scheme.splitting, splitting_choices,
              "Alpha of the Lax-Friedrichs splitting: the largest speed of each field, of all, or of each "
              "field's stencil");
  table.value("time", scheme.time_scheme, time_choices, "Runge-Kutta scheme, of 3 or 4 stages");
  table.value("mean", scheme.face_average, mean_choices,
              "Average at a face that gives the eigenvectors: mean of u and H, mean of U, or Roe's");
}

void declare_step(Table& table, gas::Parameters& scheme) {
  const Condition free_step = {[&scheme] { return scheme.fixed_dt <= 0.0; }, "without fixed_dt", "fixed_dt"};
  table.value("cfl", scheme.cfl, "Courant number", {.range = positive.at_most(2.0), .when = free_step});
  table.value("ramp_steps", scheme.ramp_steps, "Steps over which the Courant number grows from a tenth",
              {.range = between(0, 1'000'000), .when = free_step});
  table.value("positivity", scheme.positivity, positivity_choices,
              "Flux limiter that keeps density and pressure positive: never, always, or where a step fails "
              "without it");
}

void declare_scheme(Table& table, gas::Parameters& scheme) {
  declare_weights(table, scheme);
  table.value("fixed_dt", scene::zero_is_unset(scheme.fixed_dt),
              "Step that replaces the one of cfl; a run that cannot take it ends with exit code 4",
              {.unit = "s", .range = positive});
  declare_step(table, scheme);
  table.value("precision", scheme.precision, precision_choices, "All in FP64, or the nonlinear part in FP32");
}

void declare_state(Table& table, Primitive& state) {
  table.value("rho", state.rho, "Density", {.unit = "kg/m^3", .range = positive, .required = true});
  table.value("u", state.u, "Velocity", {.unit = "m/s"});
  table.value("p", state.p, "Pressure", {.unit = "Pa", .range = positive, .required = true});
}

void declare_initial(Table& table, Initial& initial) {
  table.exactly_one_of({"riemann", "regions", "expression"});
  table.optional_table(
      "riemann", initial.riemann,
      [](Table& riemann, Riemann& value) {
        riemann.value("x0", value.x0, "Position of the discontinuity", {.unit = "m"});
        riemann.table("left", value.left, declare_state, "State left of x0", {.required = true});
        riemann.table("right", value.right, declare_state, "State right of x0", {.required = true});
      },
      "Two constant states");
  table.tables(
      "regions", initial.regions,
      [](Table& region, Region& value) {
        region.value("until", value.until, "Right end; the last region has none", {.unit = "m"});
        declare_state(region, value.state);
      },
      "Constant states from left to right");
  table.optional_table(
      "expression", initial.expression,
      [](Table& expression, ExpressionState& value) {
        const std::vector<std::string> variables = {"x", "dx"};
        expression.value("rho", scene::real_or_expression_codec(value.rho, variables), "Density",
                         {.unit = "kg/m^3", .required = true});
        expression.value("u", scene::real_or_expression_codec(value.u, variables), "Velocity",
                         {.unit = "m/s"});
        expression.value("p", scene::real_or_expression_codec(value.p, variables), "Pressure",
                         {.unit = "Pa", .required = true});
      },
      "A state that varies with the cell centre x and may use the cell width dx");
}

void declare_output(Table& table, Output& output) {
  const Key& fields = table.value("fields", scene::names_codec(output.fields, {"rho", "u", "p"}),
                                  "Fields written to fields.h5",
                                  {.default_text = "all three where times are given, else none"});
  framework::declare_output_times(table, output, fields);
  framework::declare_output_intervals(table, output);
}

void declare_verify(Table& table, Verify& verify) {
  const ChoiceKey exact("exact", verify.exact, exact_choices);
  table.value(
      exact,
      "Reference of the errors: the exact Riemann solution, the initial state moved with u, a finer run");
  table.optional_table("reference", verify.reference,
                       [](Table& reference, gas::Parameters& scheme) {
                         reference.value("cells", scheme.cells, "Cells of the finer run",
                                         {.range = between(smallest_mesh, largest_mesh), .required = true});
                         declare_weights(reference, scheme);
                         declare_step(reference, scheme);
                       },
                       "The finer run", {.when = exact.is({Exact::reference}), .required = true});
  for (const std::string norm : {"l1", "l2", "linf"}) {
    for (const std::string quantity : {"density", "velocity", "pressure"}) {
      const std::string unit = quantity == "density" ? "kg/m^3" : quantity == "velocity" ? "m/s" : "Pa";
      const std::string measure = norm == "l1" ? unit + " m" : norm == "l2" ? unit + " m^(1/2)" : unit;
      const std::string name = std::string(norm).append("_").append(quantity);
      table.value(name, scene::real_codec(verify.tolerances, name), "Largest error that passes",
                  {.unit = measure,
                   .range = not_negative,
                   .when = {[&verify] { return verify.exact.has_value(); },
                            "with exact, which names what to compare with", "exact"}});
    }
  }
  table.optional_table(
      "max_density", verify.max_density,
      [](Table& target, Target& value) {
        target.value("value", value.value, "Expected value",
                     {.unit = "kg/m^3", .range = positive, .required = true});
        target.value("tolerance", value.tolerance, "Largest relative deviation that passes",
                     {.range = not_negative, .required = true});
      },
      "The largest density at the end");
  table.value("conservation", verify.conservation,
              "Largest relative change of mass, momentum and energy that passes, net of the fluxes through "
              "the ends",
              {.range = not_negative});
  framework::declare_history_checks(table, verify.history);
}

}  // namespace

void declare_gas_scene(Table& root, GasScene& scene) {
  gas::Parameters& parameters = scene.parameters;
  framework::declare_app(root, "gas", scene.description);
  root.table("gas",
             [&](Table& table) {
               table.value("gamma", parameters.gamma, "Ratio of specific heats",
                           {.range = scene::above(1.0)});
             },
             "The gas", {.required = true});
  root.table("mesh",
             [&](Table& table) {
               table.value("cells", parameters.cells, "Number of cells",
                           {.range = between(smallest_mesh, largest_mesh)});
               table.value("domain", scene::interval_codec(parameters.x_min, parameters.x_max),
                           "Ends of the domain", {.unit = "m"});
             },
             "The mesh", {.required = true});
  root.table("initial", scene.initial, declare_initial, "The state at the start", {.required = true});
  root.table(
      "boundary",
      [&](Table& table) {
        table.value("left", parameters.left, boundary_choices, "Left end");
        table.value("right", parameters.right, boundary_choices, "Right end");
      },
      "The ends of the domain");
  root.table("scheme", parameters, declare_scheme, "The numerical scheme");
  root.table("run",
             [&](Table& table) {
               table.value("end_time", scene.end_time, "End of the run",
                           {.unit = "s", .range = positive, .required = true});
               table.value("max_steps", parameters.max_steps, "Limit of steps; a run that reaches it fails",
                           {.range = between(1, 1e12)});
             },
             "The length of the run", {.required = true});
  root.table("output", scene.output, declare_output, "Files of the run directory");
  root.table("verify", scene.verify, declare_verify, "Checks at the end");
  root.table(
      "tuning",
      [&](Table& table) {
        table.table(
            "stage",
            [&](Table& stage) {
              stage.value("block", scene::block_codec(parameters.block),
                          "Threads of a team on a device, a multiple of 32, and cells of a tile on the host",
                          {.range = between(32, 512), .default_text = "the backend's own"});
            },
            "The kernels of a step");
        table.table(
            "step",
            [&](Table& step) {
              step.value("driver",
                         scene::zero_is_unset(scene::choice_codec(parameters.driver, driver_choices),
                                              parameters.driver),
                         "Launches of steps on a GPU: single kernels, one captured graph per step, or many "
                         "steps per launch where mesh and scheme allow it, else a graph; `stages` is a graph "
                         "with one kernel per stage",
                         {.default_text = "`\"auto\"`"});
            },
            "The launch of a step");
        table.table(
            "seed",
            [&](Table& baseline) {
              baseline.value(
                  "pinned", scene::zero_is_unset(parameters.pinned),
                  "State and fluxes lie in page-locked memory of the host, from which a GPU copies "
                  "faster",
                  {.default_text = "`false`"});
            },
            "The copies of --seed-mode");
      },
      "Block sizes and launches of kernels; they change speed, not results");
}

std::string weno_name(gas::Weno weno) { return scene::choice_name(weno_choices, weno); }

std::string splitting_name(gas::Splitting splitting) {
  return scene::choice_name(splitting_choices, splitting);
}

}  // namespace drogue::gas_app
