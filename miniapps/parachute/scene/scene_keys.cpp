#include "miniapps/parachute/scene/scene_keys.hpp"

#include "miniapps/parachute/bodies/body_keys.hpp"
#include "miniapps/parachute/canopy/canopy_keys.hpp"
#include "miniapps/parachute/flags/flag_keys.hpp"
#include "miniapps/parachute/scene/codecs.hpp"

namespace drogue::parachute_app {
namespace {

using scene::Choices;
using scene::Table;

constexpr double most_cells_per_axis = 16384;

const Choices<Frame> frame_choices = {{"fixed", Frame::fixed}, {"follow", Frame::follow}};
const Choices<AdvectionScheme> advection_choices = {{"central", AdvectionScheme::central},
                                                    {"weno5", AdvectionScheme::weno5}};
const Choices<Weights> weights_choices = {{"js", Weights::js}, {"z", Weights::z}};
const Choices<flow::Diffusion> diffusion_choices = {{"explicit", flow::Diffusion::explicit_},
                                                    {"crank-nicolson", flow::Diffusion::crank_nicolson}};
const Choices<flow::TimeScheme> time_choices = {{"ab2", flow::TimeScheme::ab2},
                                                {"rk3", flow::TimeScheme::rk3}};
const Choices<flow::PressureSolver> pressure_choices = {
    {"auto", flow::PressureSolver::automatic},
    {"fft", flow::PressureSolver::fft},
    {"diagonalization", flow::PressureSolver::diagonalization},
    {"hypre-pfmg", flow::PressureSolver::hypre_pfmg}};
const Choices<flow::Turbulence> turbulence_choices = {{"none", flow::Turbulence::none},
                                                      {"smagorinsky", flow::Turbulence::smagorinsky},
                                                      {"vreman", flow::Turbulence::vreman}};
const Choices<flow::Driver> driver_choices = {
    {"auto", flow::Driver::automatic}, {"plain", flow::Driver::plain}, {"graph", flow::Driver::graph}};

const std::vector<std::string> place = {"x", "y", "z"};
const std::vector<std::string> place_and_time = {"x", "y", "z", "t"};

void declare_fluid(Table& table, FlowScene& scene) {
  table.value("density", scene::real_codec(scene.parameters.density), "Density")
      .unit("kg/m^3")
      .above(0.0)
      .at_most(1e100);
  table.value("viscosity", scene::real_codec(scene.parameters.viscosity), "Dynamic viscosity")
      .unit("Pa s")
      .at_least(0.0);
  table
      .value("velocity", vector_expression_codec(scene.velocity, place_and_time),
             "Velocity at inflow sides and, if constant, of the fluid outside of outflow sides; at time 0 "
             "everywhere unless [initial] is given")
      .unit("m/s");
}

void declare_grid(Table& table, FlowScene& scene) {
  flow::Parameters& parameters = scene.parameters;
  table
      .value("cells", cells_codec(parameters.cells),
             "Cells along x, y, z; 1 for an axis along which nothing varies")
      .range(1, most_cells_per_axis)
      .required();
  table.value("domain", domain_codec(parameters.low, parameters.high), "Ends of the domain along x, y, z")
      .unit("m")
      .required();
  table.value("frame", scene::choice_codec(scene.frame, frame_choices),
              "The grid is at rest, or moves with the payload of the first canopy along axes with inflow or "
              "outflow sides");
  table.table(
      "boundary",
      [&](Table& sides) {
        for (std::size_t axis = 0; axis < 3; ++axis)
          sides
              .value(
                  axis_names[axis], sides_codec(scene.sides[axis]),
                  std::string("Both sides normal to ") + axis_names[axis] + ", or the low and the high one")
              .default_text("`\"periodic\"` with one cell, else none");
      },
      "The sides of the domain");
  table.table(
      "wall_velocity",
      [&](Table& walls) {
        for (std::size_t side = 0; side < 6; ++side)
          walls
              .value(side_names[side], vector_expression_codec(scene.wall_velocity[side], place_and_time),
                     "Velocity of the wall at this side")
              .unit("m/s")
              .default_text("`[0, 0, 0]` at a wall");
      },
      "Velocities of moving walls");
}

void declare_flow(Table& table, FlowScene& scene) {
  flow::Parameters& parameters = scene.parameters;
  table.value("advection", scene::choice_codec(scene.advection, advection_choices),
              "Advective fluxes: second-order central or fifth-order upwind-biased");
  table
      .value("weno", scene::choice_codec(scene.weights, weights_choices),
             "Nonlinear weights of the reconstruction")
      .when([&scene] { return scene.advection == AdvectionScheme::weno5; }, "with advection = \"weno5\"",
            "advection");
  table.value("diffusion", scene::choice_codec(parameters.diffusion, diffusion_choices),
              "Time integration of viscous stresses: explicit, which limits dt, or implicit");
  table
      .value("time", scene::choice_codec(parameters.time_scheme, time_choices),
             "Time integration: Runge-Kutta of third order with three projections, or Adams-Bashforth of "
             "second order")
      .default_text("`\"rk3\"`; `\"ab2\"` with diffusion = \"crank-nicolson\"");
  table.value("pressure", scene::choice_codec(parameters.pressure_solver, pressure_choices),
              "Solver of the pressure equation; `auto` is the faster direct one, in the preset exact "
              "diagonalization");
  table
      .value("pressure_tolerance", scene::real_codec(parameters.pressure_tolerance),
             "Relative residual at which the iterations end")
      .above(0.0)
      .at_most(1e-2)
      .when([&parameters] { return parameters.pressure_solver == flow::PressureSolver::hypre_pfmg; },
            "with pressure = \"hypre-pfmg\"", "pressure");
  table.value("turbulence", scene::choice_codec(parameters.turbulence, turbulence_choices),
              "Model of unresolved scales; none is implicit large-eddy simulation");
  table
      .value(
          "turbulence_constant",
          standard_if_zero(scene::real_codec(parameters.turbulence_constant), parameters.turbulence_constant,
                           [&parameters] { return flow::default_constant(parameters.turbulence); }),
          "Constant of the model")
      .above(0.0)
      .at_most(1.0)
      .when([&parameters] { return parameters.turbulence != flow::Turbulence::none; },
            "with a turbulence model", "turbulence")
      .default_text("0.17 for Smagorinsky, 0.07 for Vreman");
  table.value("body_force", vector_codec(parameters.body_force), "Force per volume").unit("N/m^3");
  table
      .value("pressure_drop", vector_codec(parameters.pressure_drop),
             "Fall of the mean pressure from the low to the high side of periodic axes")
      .unit("Pa");
}

void declare_run(Table& table, FlowScene& scene) {
  flow::Parameters& parameters = scene.parameters;
  const auto free_step = [&scene] { return scene.has_fluid() && scene.parameters.fixed_dt == 0.0; };
  const char* const free_step_condition = "with [fluid] and dt = \"auto\"";
  table.value("end_time", scene::real_codec(scene.end_time), "End of the run")
      .unit("s")
      .above(0.0)
      .required();
  table
      .value("dt", time_step_codec(parameters.fixed_dt),
             "Time step; `auto` follows from cfl, without [fluid] from the stiffness of the cloth")
      .unit("s")
      .above(0.0);
  table
      .value("cfl",
             standard_if_zero(scene::real_codec(parameters.cfl), parameters.cfl,
                              [&scene] { return scene.cfl(); }),
             "Courant number: dt times the largest sum of speeds over cell widths along the axes; at most "
             "0.7 with ab2")
      .at_least(1e-6)
      .at_most(flow::stable_cfl(flow::TimeScheme::rk3))
      .when(free_step, free_step_condition, "dt")
      .default_text("1 for rk3, 0.5 for ab2 and with a [[body]], [[canopy]] or [[flag]]");
  table
      .value("max_dt", absent_if_zero(scene::real_codec(parameters.max_dt), parameters.max_dt),
             "Upper bound of dt, say for a fluid at rest")
      .unit("s")
      .above(0.0)
      .default_text(
          "with sheets that the fluid moves `cfl` times the least width h of a cell over the largest "
          "number in fluid.velocity and grid.wall_velocity, or over sqrt(g h) with gravity g, if that is "
          "larger, with crank-nicolson at most h^2 density / viscosity, and with a mount at most the step "
          "that resolves its frequency; else none")
      .when(free_step, free_step_condition, "dt");
  table
      .value("max_steps", scene::integer_codec(parameters.max_steps),
             "Limit of steps; a run that reaches it fails")
      .range(1, 1e12);
}

}  // namespace

void declare_flow_scene(Table& root, FlowScene& scene) {
  framework::declare_app(root, "parachute", scene.description);
  const auto of_fluid = with_fluid(scene);
  root.optional_table(
      "fluid", scene.fluid, [&scene](Table& table, std::monostate&) { declare_fluid(table, scene); },
      "The fluid; without it, the scene is a cloth drop");
  root.table(
          "grid", [&](Table& table) { declare_grid(table, scene); }, "The grid and its sides")
      .when(of_fluid, fluid_condition, "fluid")
      .required();
  root.table(
          "initial",
          [&](Table& table) {
            table.value("velocity", vector_expression_codec(scene.initial, place), "Velocity at time 0")
                .unit("m/s")
                .default_text("fluid.velocity at time 0");
          },
          "The state at the start; the gradient part of its velocity is removed")
      .when(of_fluid, fluid_condition, "fluid");
  root.table(
          "flow", [&](Table& table) { declare_flow(table, scene); }, "The numerical scheme and the forces")
      .when(of_fluid, fluid_condition, "fluid");
  root.tables(
      "canopy", scene.canopies,
      [of_fluid](Table& table, Canopy& canopy) { declare_canopy(table, canopy, of_fluid); },
      "Parachutes: cloth, suspension lines and a payload");
  root.tables("flag", scene.flags, declare_flag,
              "Elastic rectangles that are hinged at their leading edge, along z; strips in two dimensions")
      .when(of_fluid, fluid_condition, "fluid");
  root.tables("body", scene.bodies, declare_body, "Rigid sheets in the flow, at rest or in prescribed motion")
      .when(of_fluid, fluid_condition, "fluid");
  root.table(
          "coupling",
          [&](Table& table) {
            declare_coupling(table, scene.coupling, of_fluid);
            table
                .value(
                    "allow_unstable", scene::boolean_codec(scene.allow_unstable),
                    "Run with canopies whose added mass exceeds their own, which the method is unstable for")
                .when([&scene] { return scene.has_fluid() && scene.is_explicit(); },
                      "with method = \"explicit\"", "method");
            table
                .value("gravity", vector_codec(scene.gravity), "Acceleration of canopies, payloads and flags")
                .unit("m/s^2")
                .when([&scene] { return !scene.canopies.empty() || !scene.flags.empty(); },
                      "with a [[canopy]] or a [[flag]]", "canopy");
            table
                .value("contact", scene::boolean_codec(scene.contact),
                       "Contact of cloth and lines with each other and themselves, without friction")
                .when([&scene] { return !scene.canopies.empty(); }, "with a [[canopy]]", "canopy");
            table.value("thickness", scene::real_codec(scene.thickness), "Distance of layers in contact")
                .unit("m")
                .above(0.0)
                .when([&scene] { return scene.contact; }, "with contact = true", "contact");
          },
          "The exchange of forces between the fluid and sheets")
      .when([&scene] { return scene.has_sheets(); }, "with a [[body]], a [[canopy]] or a [[flag]]", "body");
  root.table(
          "run", [&](Table& table) { declare_run(table, scene); }, "Length and steps of the run")
      .required();
  root.table(
      "output", [&](Table& table) { framework::declare_output(table, scene.output, field_names()); },
      "Files of the run directory");
  root.table(
      "verify", [&](Table& table) { declare_verify(table, scene); }, "Checks at the end");
  root.table(
          "tuning",
          [&](Table& table) {
            table.table(
                "stage",
                [&](Table& stage) {
                  stage
                      .value("block", scene::block_codec(scene.parameters.block),
                             "Threads of a team of momentum stage and pressure correction on a GPU, a "
                             "multiple of 32")
                      .range(32, 512)
                      .default_text("128");
                },
                "The kernels of a step of the fluid");
            table
                .table(
                    "contact",
                    [&](Table& contact) {
                      contact
                          .value("block", scene::block_codec(scene.contact_block),
                                 "Threads of a team that resolves contact on a GPU, a multiple of 32")
                          .range(32, 512)
                          .default_text("512");
                    },
                    "The kernel that resolves the contact of an interval")
                .when([&scene] { return scene.contact; }, "with contact = true", "contact");
            table.table(
                "step",
                [&](Table& step) {
                  scene::Codec driver = scene::choice_codec(scene.parameters.driver, driver_choices);
                  driver.print = [print = driver.print, &driver_of = scene.parameters.driver] {
                    return driver_of == flow::Driver::automatic ? std::nullopt : print();
                  };
                  step.value("driver", driver,
                             "Launches of the kernels of a step on a GPU: one by one, or as one graph")
                      .default_text("`\"auto\"`");
                },
                "The launch of a step");
          },
          "Block sizes and launches of kernels; they change speed, not results")
      .when(of_fluid, fluid_condition, "fluid");
}

std::string pressure_solver_name(flow::PressureSolver solver) {
  return scene::choice_name(pressure_choices, solver);
}

std::string time_scheme_name(flow::TimeScheme scheme) { return scene::choice_name(time_choices, scheme); }

std::string diffusion_name(flow::Diffusion diffusion) {
  return scene::choice_name(diffusion_choices, diffusion);
}

std::string advection_name(flow::Advection advection) {
  switch (advection) {
    case flow::Advection::central:
      return "central";
    case flow::Advection::weno_js:
      return "weno-js";
    case flow::Advection::weno_z:
      return "weno-z";
  }
  return "";
}

}  // namespace drogue::parachute_app
