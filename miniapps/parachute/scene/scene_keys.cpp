#include "miniapps/parachute/scene/scene_keys.hpp"

#include "miniapps/parachute/scene/codecs.hpp"

namespace drogue::parachute_app {
namespace {

using coupling::CouplingMethod;
using scene::between, scene::ChoiceKey, scene::Choices, scene::Condition, scene::not_negative,
    scene::positive, scene::Table, scene::with_given, scene::with_true;

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
const Choices<flow::Advection> scheme_names = {{"central", flow::Advection::central},
                                               {"weno-js", flow::Advection::weno_js},
                                               {"weno-z", flow::Advection::weno_z}};
const Choices<CouplingMethod> method_choices = {{"spread", CouplingMethod::spread},
                                                {"explicit", CouplingMethod::explicit_},
                                                {"sharp", CouplingMethod::sharp}};

const Choices<Corrections> corrections_choices = {{"default", Corrections::all},
                                                  {"plain", Corrections::none}};

const std::vector<std::string> place = {"x", "y", "z"}, place_and_time = {"x", "y", "z", "t"};

void declare_fluid(Table& table, FlowScene& scene) {
  table.value("density", scene.parameters.density, "Density",
              {.unit = "kg/m^3", .range = positive.at_most(1e100)});
  table.value("viscosity", scene.parameters.viscosity, "Dynamic viscosity",
              {.unit = "Pa s", .range = not_negative});
  table.value("velocity", vector_expression_codec(scene.velocity, place_and_time),
              "Velocity at inflow sides and, if constant, of the fluid outside of outflow sides; at time 0 "
              "everywhere unless [initial] is given",
              {.unit = "m/s"});
}

void declare_grid(Table& table, FlowScene& scene) {
  flow::Parameters& p = scene.parameters;
  const Condition core = with_given("core", scene.core);
  table.value("cells", p.cells, "Cells of one width along x, y, z; 1 for an axis along which nothing varies",
              {.range = between(1, most_cells_per_axis),
               .when = {[&scene] { return !scene.core && !scene.faces; }, "without core and faces", "core"}});
  table.value("domain", box_codec(scene.domain), "Ends of the domain along x, y, z",
              {.unit = "m",
               .when = {[&scene] { return !scene.faces; }, "without faces, which have them", "faces"},
               .required = true});
  table.value("core", box_codec(scene.core),
              "Box in the domain with cells of one width, outside of which they grow up to its ends; for "
              "canopies, flags and bodies",
              {.unit = "m"});
  table.value("spacing", spacing_codec(scene.spacing),
              "Largest width of a cell in the core, of which each axis has the fewest that are no wider",
              {.unit = "m", .range = positive, .when = core, .required = true});
  table.value("growth", scene.growth, "Largest ratio of the widths of neighbouring cells outside the core",
              {.range = scene::above(1.0).at_most(1.1), .when = core});
  table.value("faces", faces_codec(scene.faces),
              "Coordinates of the faces of the cells along x, y, z, ascending, or files with one a line",
              {.unit = "m"});
  table.exactly_one_of({"cells", "core", "faces"});
  table.value(
      "frame", scene.frame, frame_choices,
      "The grid is at rest, or moves along axes with inflow or outflow sides: with the payload of the "
      "first canopy, or on a stretched grid with the middle between it and its canopies");
  table.table(
      "boundary",
      [&scene](Table& sides) {
        for (std::size_t axis = 0; axis < 3; ++axis)
          sides.value(
              axis_names[axis], sides_codec(scene.sides[axis]),
              scene::sentence("Both sides normal to ", axis_names[axis], ", or the low and the high one"),
              {.default_text = "`\"periodic\"` with one cell, else none"});
      },
      "The sides of the domain");
  table.table(
      "wall_velocity",
      [&scene](Table& walls) {
        for (std::size_t side = 0; side < 6; ++side)
          walls.value(side_names[side], vector_expression_codec(scene.wall_velocity[side], place_and_time),
                      "Velocity of the wall at this side",
                      {.unit = "m/s", .default_text = "`[0, 0, 0]` at a wall"});
      },
      "Velocities of moving walls");
}

void declare_flow(Table& table, FlowScene& scene) {
  flow::Parameters& p = scene.parameters;
  const ChoiceKey advection("advection", scene.advection, advection_choices);
  const ChoiceKey pressure("pressure", p.pressure_solver, pressure_choices);
  table.value(advection, "Advective fluxes: second-order central or fifth-order upwind-biased");
  table.value("weno", scene.weights, weights_choices, "Nonlinear weights of the reconstruction",
              {.when = advection.is({AdvectionScheme::weno5})});
  table.value("diffusion", p.diffusion, diffusion_choices,
              "Time integration of viscous stresses: explicit, which limits dt, or implicit");
  table.value("time", p.time_scheme, time_choices,
              "Time integration: Runge-Kutta of third order with three projections, or Adams-Bashforth of "
              "second order",
              {.default_text = "`\"rk3\"`; `\"ab2\"` with diffusion = \"crank-nicolson\""});
  table.value(pressure,
              "Solver of the pressure equation; `auto` is the faster direct one, in the preset exact "
              "diagonalization");
  table.value("pressure_tolerance", p.pressure_tolerance, "Relative residual at which the iterations end",
              {.range = positive.at_most(1e-2), .when = pressure.is({flow::PressureSolver::hypre_pfmg})});
  table.value("turbulence", p.turbulence, turbulence_choices,
              "Model of unresolved scales; none is implicit large-eddy simulation");
  table.value("turbulence_constant",
              standard_if_zero(p.turbulence_constant, [&p] { return flow::default_constant(p.turbulence); }),
              "Constant of the model",
              {.range = positive.at_most(1.0),
               .when = {[&p] { return p.turbulence != flow::Turbulence::none; }, "with a turbulence model",
                        "turbulence"},
               .default_text = "0.17 for Smagorinsky, 0.07 for Vreman"});
  table.value("body_force", p.body_force, "Force per volume", {.unit = "N/m^3"});
  table.value("pressure_drop", p.pressure_drop,
              "Fall of the mean pressure from the low to the high side of periodic axes", {.unit = "Pa"});
}

void declare_drop(Table& table, Drop& drop) {
  table.value("speed", drop.speed, "Speed of the payload relative to the air at the start",
              {.unit = "m/s", .range = not_negative, .required = true});
  table.value("angle", drop.angle,
              "Angle of its path below the horizontal: 90 straight down, 0 along +x as from an aircraft",
              {.unit = "degrees", .range = between(-90.0, 90.0)});
  table.value(
      "height", drop.height,
      "Height of the payload above the ground, the fall through which gives time and speed of its touch-down",
      {.unit = "m", .range = positive, .default_text = "none"});
}

void declare_coupling(Table& table, FlowScene& scene) {
  Exchange& coupling = scene.coupling;
  const Condition fluid = with_fluid(scene);
  const ChoiceKey method("method", coupling.method, method_choices);
  table.value(method,
              "Coupling of sheets to the fluid: by smoothed delta functions, against which canopies relax in "
              "each step of the cloth; likewise, but the cloth takes the force of the last step of the flow "
              "and imposes its velocity, as in [Shi]; or pressure jumps between the cells that a body "
              "separates",
              {.when = fluid});
  table.value(
      "corrections", coupling.corrections, corrections_choices,
      "Corrections of delta functions where the keys below do not replace them: `default` against leak, wide "
      "edges and late forces; `plain` has none",
      {.when = fluid && method.is({CouplingMethod::spread})});
  table.value(
      "filter", coupling.filter,
      "Weight of the present step in the running mean of the acceleration of the fluid at sheets",
      {.range = between(0.0, 1.0),
       .when = fluid,
       .default_text = "of canopies with default corrections the largest with which light cloth is stable: 1 "
                       "and a trend of porous cloth, 0.2 if it is impermeable; else 0.5"});
  table.value("leak_filter", coupling.leak_filter,
              "Weight of the present step in the running mean of what delta functions give the fluid at a "
              "vertex less what the vertex expects, smoothed along the sheet; 0: none, so that curved sheets "
              "leak in proportion to dt",
              {.range = between(0.0, 1.0),
               .when = fluid && method.is({CouplingMethod::spread}),
               .default_text = "0.5 with default corrections, else 0; 0 with a [[flag]]"});
  table.former("defect_filter", "\"coupling.leak_filter\", by default 0.5");
  table.value("edge_inset", coupling.edge_inset,
              "Cells by which free edges of sheets lie farther inwards where they exchange forces with the "
              "fluid, to make up for the width of the delta function, which else acts beyond the edges; "
              "the fluid passes between sheets that touch",
              {.range = between(0.0, 1.0),
               .when = fluid && method.is({CouplingMethod::spread, CouplingMethod::explicit_}),
               .default_text = "with default corrections 0.59 cells at a Courant number of 0.5 and 0.07 more "
                               "at half of it; 0 without, and with a retraction"});
  table.value("allow_unstable", scene.allow_unstable,
              "Run with canopies whose added mass exceeds their own, which the method is unstable for",
              {.when = method.is({CouplingMethod::explicit_})});
  table.value("gravity", scene.gravity, "Acceleration of canopies, payloads and flags",
              {.unit = "m/s^2",
               .when = {[&scene] { return !scene.canopies.empty() || !scene.flags.empty(); },
                        "with a [[canopy]] or a [[flag]]", "canopy"}});
  table.value("contact", scene.contact,
              "Contact of cloth and lines with each other and themselves, without friction",
              {.when = {[&scene] { return !scene.canopies.empty(); }, "with a [[canopy]]", "canopy"}});
  table.value("thickness", scene.thickness, "Distance of layers in contact",
              {.unit = "m", .range = positive, .when = with_true("contact", scene.contact)});
}

void declare_run(Table& table, FlowScene& scene) {
  flow::Parameters& p = scene.parameters;
  const Condition free_step =
      with_fluid(scene) && Condition{[&p] { return p.fixed_dt == 0.0; }, "with dt = \"auto\"", "dt"};
  table.value("end_time", scene.end_time, "End of the run",
              {.unit = "s", .range = positive, .required = true});
  table.value("dt", time_step_codec(p.fixed_dt),
              "Time step; `auto` follows from cfl, without [fluid] from the stiffness of the cloth",
              {.unit = "s", .range = positive});
  table.value("cfl", standard_if_zero(p.cfl, [&scene] { return scene.cfl(); }),
              "Courant number: dt times the largest sum of speeds over cell widths along the axes; at most "
              "0.7 with ab2",
              {.range = scene::at_least(1e-6).at_most(flow::stable_cfl(flow::TimeScheme::rk3)),
               .when = free_step,
               .default_text = "1 for rk3, 0.5 for ab2 and with a [[body]], [[canopy]] or [[flag]]"});
  table.value("max_dt", scene::zero_is_unset(p.max_dt), "Upper bound of dt, say for a fluid at rest",
              {.unit = "s",
               .range = positive,
               .when = free_step,
               .default_text =
                   "with sheets that the fluid moves `cfl` times the least width h of a cell over the "
                   "largest number in fluid.velocity and grid.wall_velocity, or over sqrt(g h) with gravity "
                   "g, if that is larger, with crank-nicolson at most h^2 density / viscosity, and with a "
                   "mount at most the step that resolves its frequency; else none"});
  table.value("max_steps", p.max_steps, "Limit of steps; a run that reaches it fails",
              {.range = between(1, 1e12)});
}

/// Block of a kernel whose team has `standard` threads unless it is given.
void declare_block(Table& table, int& block, const std::string& team, const std::string& standard) {
  table.value("block", scene::block_codec(block), "Threads of a team " + team + " on a GPU, a multiple of 32",
              {.range = between(32, 512), .default_text = standard});
}

void declare_tuning(Table& table, FlowScene& scene) {
  table.table(
      "stage",
      [&](Table& stage) {
        declare_block(stage, scene.parameters.block, "of momentum stage and pressure correction", "128");
      },
      "The kernels of a step of the fluid");
  table.table(
      "contact",
      [&](Table& contact) { declare_block(contact, scene.contact_block, "that resolves contact", "512"); },
      "The kernel that resolves the contact of an interval", {.when = with_true("contact", scene.contact)});
  table.table(
      "step",
      [&driver = scene.parameters.driver](Table& step) {
        step.value("driver", scene::zero_is_unset(scene::choice_codec(driver, driver_choices), driver),
                   "Launches of the kernels of a step on a GPU: one by one, or as one graph",
                   {.default_text = "`\"auto\"`"});
      },
      "The launch of a step");
}

}  // namespace

Condition with_fluid(const FlowScene& scene) {
  return {[&scene] { return scene.has_fluid(); }, "with [fluid]", "fluid"};
}

void declare_flow_scene(Table& root, FlowScene& scene) {
  const Condition fluid = with_fluid(scene);
  framework::declare_app(root, "parachute", scene.description);
  root.optional_table(
      "fluid", scene.fluid, [&scene](Table& table, std::monostate&) { declare_fluid(table, scene); },
      "The fluid; without it, the scene is a cloth drop");
  root.table("grid", scene, declare_grid, "The grid and its sides", {.when = fluid, .required = true});
  root.table("initial",
             [&scene](Table& table) {
               table.value("velocity", vector_expression_codec(scene.initial, place), "Velocity at time 0",
                           {.unit = "m/s", .default_text = "fluid.velocity at time 0"});
             },
             "The state at the start; the gradient part of its velocity is removed", {.when = fluid});
  root.table("flow", scene, declare_flow, "The numerical scheme and the forces", {.when = fluid});
  root.optional_table(
      "drop", scene.drop, declare_drop,
      "A drop: all canopies with their payloads start with one velocity, and coupling.gravity is "
      "[0, 0, -9.81] unless given");
  root.tables(
      "canopy", scene.canopies,
      [fluid, &scene](Table& table, Canopy& canopy) {
        declare_canopy(table, canopy, fluid, [&scene] { return scene.drop.has_value(); });
      },
      "Parachutes: cloth, suspension lines and a payload");
  root.tables("flag", scene.flags, declare_flag,
              "Elastic rectangles that are hinged at their leading edge, along z; strips in two dimensions",
              {.when = fluid});
  root.tables("body", scene.bodies, declare_body, "Rigid sheets in the flow, at rest or in prescribed motion",
              {.when = fluid});
  root.table("coupling", scene, declare_coupling, "The exchange of forces between the fluid and sheets",
             {.when = {[&scene] { return scene.has_sheets(); }, "with a [[body]], a [[canopy]] or a [[flag]]",
                       "body"}});
  root.table("run", scene, declare_run, "Length and steps of the run", {.required = true});
  root.table(
      "output", [&](Table& table) { framework::declare_output(table, scene.output, field_names()); },
      "Files of the run directory");
  root.table("verify", scene, declare_verify, "Checks at the end");
  root.table("tuning", scene, declare_tuning,
             "Block sizes and launches of kernels; they change speed, not results", {.when = fluid});
}

std::string name_of(flow::PressureSolver solver) { return scene::choice_name(pressure_choices, solver); }
std::string name_of(flow::TimeScheme scheme) { return scene::choice_name(time_choices, scheme); }
std::string name_of(flow::Diffusion diffusion) { return scene::choice_name(diffusion_choices, diffusion); }
std::string name_of(flow::Advection advection) { return scene::choice_name(scheme_names, advection); }

}  // namespace drogue::parachute_app
