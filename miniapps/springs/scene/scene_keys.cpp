#include "miniapps/springs/scene/scene_keys.hpp"

#include <algorithm>

#include "common/scene/codec.hpp"
#include "miniapps/springs/simulation/stress_fields.hpp"

namespace drogue::springs_app {
namespace {

using fabric::Integrator;
using fabric::Model;
using scene::between, scene::not_negative, scene::positive, scene::Table;
using scene::Choices, scene::Codec, scene::Condition, scene::Key;

constexpr double most_vertices = 16777216;  // 2^24

const Choices<Model> model_choices = {{"linear-vector", Model::linear_vector},
                                      {"edge", Model::edge},
                                      {"quadratic", Model::quadratic},
                                      {"biquadratic", Model::biquadratic}};
const Choices<fabric::Lumping> mass_choices = {{"area", fabric::Lumping::area},
                                               {"equal", fabric::Lumping::equal}};
const Choices<fabric::Driver> driver_choices = {{"auto", fabric::Driver::automatic},
                                                {"plain", fabric::Driver::plain},
                                                {"graph", fabric::Driver::graph},
                                                {"persistent", fabric::Driver::persistent}};
const Choices<Integrator> integrator_choices = {{"rk4", Integrator::rk4}, {"verlet", Integrator::verlet}};
const Choices<std::string> axes_choices = {{"x", "x"},   {"y", "y"},   {"z", "z"},    {"xy", "xy"},
                                           {"xz", "xz"}, {"yz", "yz"}, {"xyz", "xyz"}};
const std::vector<std::string> of_place = {"x", "y", "z"}, of_place_and_time = {"x", "y", "z", "t"};

/// Subset of x, y and z in any order; stored in ascending order.
Codec axes_codec(std::string& axes) {
  Codec codec = scene::choice_codec(axes, axes_choices);
  codec.type += ", in any order";
  codec.read = [read = codec.read, &axes](const scene::Node& node, const scene::Limits& limits) {
    if (const auto* text = node.as<std::string>()) {
      std::string sorted = *text;
      std::ranges::sort(sorted);
      if (std::ranges::any_of(axes_choices, [&](const auto& choice) { return choice.first == sorted; })) {
        axes = sorted;
        return std::string();
      }
    }
    return read(node, limits);
  };
  return codec;
}

/// "auto", which stands for no value, or a number.
Codec real_or_auto_codec(std::optional<double>& value) {
  return scene::make_codec(
      "\"auto\" | real", value,
      [](const scene::Node& node, const scene::Limits& limits, std::optional<double>& dt) -> std::string {
        const auto* text = node.as<std::string>();
        if (text == nullptr) return scene::read_real(node, limits, dt.emplace());
        dt.reset();
        return *text == "auto" ? "" : "must be \"auto\" or a number, not " + scene::describe(node);
      },
      [](const std::optional<double>& dt) { return dt ? scene::toml_text(*dt) : "\"auto\""; });
}

Codec fields_codec(std::vector<std::string>& fields) {
  std::vector<std::string> names = stress_field_names();
  names.insert(names.begin(), {"position", "velocity"});
  Codec codec = scene::names_codec(fields, names);
  codec.type = "array of names";
  return codec;
}

void declare_vector(Table& table, ExpressionVector& value, const std::vector<std::string>& variables,
                    const std::string& what, const std::string& unit) {
  const std::pair<std::string, std::string&> components[] = {{"x", value.x}, {"y", value.y}, {"z", value.z}};
  for (const auto& [axis, component] : components)
    table.value(axis, scene::real_or_expression_codec(component, variables), what + " along " + axis,
                {.unit = unit});
}

void declare_vertices(Table& table, int& vertices, double least) {
  table.value("vertices", vertices, "Number of vertices, about", {.range = between(least, most_vertices)});
}

void declare_length(Table& table, const std::string& name, double& value, const std::string& help) {
  table.value(name, value, help, {.unit = "m", .range = positive});
}

void declare_mesh(Table& table, MeshSource& source) {
  table.exactly_one_of({"rectangle", "disk", "strip", "triangle", "string", "file"});
  table.optional_table(
      "rectangle", source.rectangle,
      [](Table& t, mesh::Rectangle& value) {
        declare_length(t, "width", value.width, "Extent along x, from 0");
        declare_length(t, "height", value.height, "Extent along y, from 0");
        declare_vertices(t, value.vertices, 4);
        t.value("distortion", value.distortion,
                "Largest pseudo-random displacement of inner vertices, as a share of a cell",
                {.range = between(0.0, 0.2)});
      },
      "Nearly square cells with alternating diagonals in the plane z = 0");
  table.optional_table(
      "disk", source.disk,
      [](Table& t, mesh::Disk& value) {
        declare_length(t, "radius", value.radius, "Radius about the origin");
        declare_vertices(t, value.vertices, 7);
      },
      "Rings of triangles in the plane z = 0, with the nearest number of vertices of the form 1 + 3 n (n + "
      "1)");
  table.optional_table(
      "strip", source.strip,
      [](Table& t, mesh::Strip& value) {
        declare_length(t, "length", value.length, "Extent along x, from 0");
        declare_length(t, "width", value.width, "Extent along y, from 0");
        declare_vertices(t, value.vertices, 4);
      },
      "Rows of nearly equilateral triangles in the plane z = 0");
  table.optional_table(
      "triangle", source.triangle,
      [](Table& t, mesh::Triangle& value) {
        declare_length(t, "side", value.side, "Side, along x from the origin");
        declare_vertices(t, value.vertices, 3);
      },
      "An equilateral triangle in the plane z = 0, divided into n^2, with the nearest (n + 1)(n + 2)/2 "
      "vertices");
  table.optional_table(
      "string", source.string,
      [](Table& t, mesh::String& value) {
        t.value("from", vector_codec(value.from), "First end", {.unit = "m"});
        t.value("to", vector_codec(value.to), "Last end", {.unit = "m"});
        t.value("vertices", value.vertices, "Number of vertices", {.range = between(2, most_vertices)});
      },
      "A string of equal pieces");
  table.value(
      "file", scene::text_codec(source.file),
      "A Wavefront OBJ file (v, f, l for strings), relative to the scene; larger faces are divided into "
      "triangles",
      {.default_text = "none"});
  table.value("scale", source.scale, "Metres per unit of length of the file",
              {.range = positive, .when = scene::with_given("file", source.file)});
}

void declare_material(Table& table, SpringsScene& scene) {
  Fabric& f = scene.fabric;
  const auto is_spring = [&f] {
    return f.material.model == Model::edge || f.material.model == Model::linear_vector;
  };
  const Condition cloth = {[&scene] { return scene.has_triangles(); }, "with triangles"},
                  lines = {[&scene] { return scene.has_lines(); }, "with lines"},
                  membrane = {[=, &scene] { return scene.has_triangles() && !is_spring(); },
                              "with triangles and model quadratic or biquadratic", "model"};
  Codec model = scene::choice_codec(f.material.model, model_choices);
  model.print = [print = model.print, &scene] { return scene.has_triangles() ? print() : std::nullopt; };
  table.value("model", model,
              "Constitutive model of triangles: Models I (linear-vector) and II (edge) of [Shi] have springs "
              "along edges, the others are membranes; strings are springs in every model");
  table.value("membrane_modulus", f.material.membrane_modulus, "Young's modulus times thickness",
              {.unit = "N/m", .range = positive, .when = membrane});
  table.value("poisson", f.material.poisson, "Poisson's ratio",
              {.range = between(-0.99, 0.5), .when = membrane});
  table.value("stiffness", f.stiffness, "Stiffness of an edge, and of strings without axial_stiffness",
              {.unit = "N/m",
               .range = positive,
               .when = {[=, &scene] { return scene.has_lines() || is_spring(); }, "with lines, or model edge",
                        "model"},
               .default_text = "1000 for model edge"});
  table.value("area_density", f.area_density, "Mass per area of cloth at rest",
              {.unit = "kg/m^2", .range = positive, .when = cloth});
  table.value("mass", f.mass, mass_choices,
              "Mass of a vertex: a third of its triangles and half of its lines, or the same for all",
              {.default_text = "`\"area\"`"});
  table.value("line_density", f.line_density, "Mass per length of strings at rest",
              {.unit = "kg/m", .range = positive, .when = lines});
  table.value("axial_stiffness", f.axial_stiffness, "E A of strings",
              {.unit = "N",
               .range = positive,
               .when = {[=, &scene, &f] {
                          return scene.has_lines() &&
                                 (!f.stiffness || (scene.has_triangles() && is_spring()));
                        },
                        "with lines and without stiffness, or with model edge", "stiffness"},
               .default_text = "5000 without stiffness"});
  table.value("bending_stiffness", f.material.bending_stiffness,
              "Bending stiffness of cloth that is flat at rest: of cloth bent to a cylinder. A free strip of "
              "triangles is softer, and hangs 10 to 22 % lower than the beam (docs/springs.md, Limits)",
              {.unit = "N m", .range = not_negative, .when = cloth});
  table.value("tension_only", f.material.tension_only,
              "No compression: cloth wrinkles and strings go slack without energy",
              {.when = {[&f] { return f.material.model != Model::linear_vector; },
                        "with another model than linear-vector", "model"}});
}

void declare_load(Table& table, Load& load) {
  table.exactly_one_of({"gravity", "pressure", "follower_pressure", "force"});
  table.value("gravity", optional_vector_codec(load.gravity), "Acceleration of all masses",
              {.unit = "m/s^2", .default_text = "none"});
  table.value("pressure", scene::real_or_expression_codec(load.pressure, of_place_and_time),
              "Force per area at rest along the normal at rest; the normal of a counter-clockwise triangle "
              "points up",
              {.unit = "N/m^2"});
  table.value("follower_pressure", scene::real_or_expression_codec(load.follower_pressure, of_place_and_time),
              "Force per present area along the present normal", {.unit = "N/m^2"});
  table.optional_table(
      "force", load.force,
      [](Table& t, ExpressionVector& value) {
        declare_vector(t, value, of_place_and_time, "Force on each vertex", "N");
      },
      "A force on vertices");
  table.value("where", scene::expression_codec(load.where, of_place),
              "Vertices that the force acts on: where this is not 0",
              {.when = scene::with_given("force", load.force), .default_text = "all"});
}

void declare_output(Table& table, Output& output) {
  const Key& fields =
      table.value("fields", fields_codec(output.fields),
                  "Fields written to fields.h5: position, velocity, and for every triangle stress, "
                  "major_stress, minor_stress, major_direction, minor_direction, von_mises; with the prefix "
                  "vertex_ for every vertex, with nominal_ before the name for nominal instead of Cauchy's "
                  "stress, as in vertex_nominal_stress",
                  {.default_text = "position where times are given, else none"});
  framework::declare_output_times(table, output, fields);
  table.tables(
      "probes", output.probes,
      [](Table& t, Probe& probe) {
        t.value("at", optional_vector_codec(probe.at), "Position at rest; the nearest vertex is used",
                {.unit = "m", .required = true});
      },
      "Vertices whose positions are columns of history.csv");
  framework::declare_output_intervals(table, output);
}

void declare_time(Table& table, Time& time) {
  table.value(
      "integrator", time.integrator, integrator_choices,
      "Velocity Verlet, which keeps energy in violent motion, or classical Runge-Kutta, for vibrations "
      "that its steps resolve");
  table.value(
      "dt", real_or_auto_codec(time.dt),
      "Step; auto: from the fastest frequency, and short enough to resolve pins and loads that change",
      {.unit = "s", .range = positive});
  table.value("safety", time.safety, "Share of the largest stable step",
              {.range = scene::at_least(1e-6).at_most(1.0),
               .when = {[&time] { return !time.dt; }, "with dt = \"auto\"", "dt"}});
  table.value("end_time", time.end_time, "End of the run",
              {.unit = "s", .range = not_negative, .required = true});
}

}  // namespace

scene::Codec optional_vector_codec(std::vector<double>& value) {
  Codec codec = scene::reals_codec(value, 3, false);
  codec.type = "[real, real, real]";
  codec.print = [print = codec.print, &value] { return value.empty() ? std::nullopt : print(); };
  return codec;
}

scene::Codec vector_codec(fabric::Vector& value) {
  return scene::make_codec(
      "[real, real, real]", value,
      [](const scene::Node& node, const scene::Limits& limits, fabric::Vector& vector) {
        std::vector<double> numbers;
        std::string complaint = scene::reals_codec(numbers, 3, false).read(node, limits);
        if (complaint.empty()) std::copy(numbers.begin(), numbers.end(), vector.begin());
        return complaint;
      },
      scene::toml_text<double, 3>);
}

void declare_springs_scene(Table& root, SpringsScene& scene) {
  framework::declare_app(root, "springs", scene.description);
  root.table("mesh", scene.source, declare_mesh, "Cloth and strings at rest", {.required = true});
  root.table("material", scene, declare_material, "Material of cloth and strings");
  root.tables(
      "reinforcement", scene.reinforcements,
      [](Table& table, Reinforcement& reinforcement) {
        table.value("where", scene::expression_codec(reinforcement.where, of_place),
                    "The edges at both ends of which this is not 0; an edge has at most one reinforcement",
                    {.required = true});
        table.value("axial_stiffness", reinforcement.axial_stiffness,
                    "E A of each edge, added to the stiffness of the cloth",
                    {.unit = "N", .range = positive, .required = true});
        table.value("line_density", reinforcement.line_density,
                    "Mass per length at rest, added to that of the cloth",
                    {.unit = "kg/m", .range = not_negative});
      },
      "Strings along edges of cloth, such as seams. For lines of the mesh they replace the values of "
      "[material]");
  root.table(
      "initial",
      [&](Table& table) {
        table.table(
            "displacement",
            [&](Table& t) { declare_vector(t, scene.initial.displacement, of_place, "Displacement", "m"); },
            "Displacement from rest");
        table.table(
            "velocity",
            [&](Table& t) { declare_vector(t, scene.initial.velocity, of_place, "Velocity", "m/s"); },
            "Velocity");
        table.value(
            "prestretch", scene.initial.prestretch,
            "Strain by which all coordinates at rest are stretched before they are displaced; lengths at "
            "rest stay those of the mesh",
            {.range = between(-0.5, 10.0)});
      },
      "The state at the start");
  root.tables(
      "pin", scene.pins,
      [](Table& table, Pin& pin) {
        table.value("where", scene::expression_codec(pin.where, of_place),
                    "Vertices that are fixed: where this is not 0", {.required = true});
        table.value("axes", axes_codec(pin.axes), "Axes along which they are fixed");
        table.table(
            "motion",
            [&](Table& t) {
              declare_vector(t, pin.motion, of_place_and_time, "Displacement from rest", "m");
            },
            "Prescribed motion; without it vertices keep their initial position");
      },
      "Fixed vertices; several pins may fix a vertex along different axes");
  root.tables("load", scene.loads, declare_load, "Loads, which add up");
  root.tables(
      "mass", scene.payloads,
      [](Table& table, Payload& payload) {
        table.value("where", scene::expression_codec(payload.where, of_place),
                    "Vertices: where this is not 0", {.required = true});
        table.value("add", payload.add, "Mass added to each",
                    {.unit = "kg", .range = positive, .required = true});
      },
      "Payloads");
  root.table(
      "damping",
      [&](Table& table) {
        table.value("absolute", scene.damping.absolute, "Deceleration over the velocity",
                    {.unit = "1/s", .range = not_negative});
        table.value("relative", scene.damping.relative,
                    "Rate at which two isolated vertices of an edge lose their relative velocity along it",
                    {.unit = "1/s", .range = not_negative});
      },
      "Damping");
  root.table("contact", scene.contact, declare_contact, "Contact of cloth and strings");
  root.table("time", scene.time, declare_time, "Steps and the length of the run", {.required = true});
  root.table("output", scene.output, declare_output, "Files of the run directory");
  root.table("verify", scene.verify, declare_verify, "Checks at the end");
  root.table(
      "tuning",
      [&](Table& table) {
        table.table(
            "step",
            [&](Table& step) {
              step.value("driver", scene.driver, driver_choices,
                         "Launches of Runge-Kutta steps on a GPU: single kernels, one captured graph per "
                         "step, or many steps per launch where mesh and loads allow it, else a graph");
            },
            "The launch of a step");
      },
      "Launches of kernels; they change speed, not results");
}

std::string model_name(fabric::Model model) { return scene::choice_name(model_choices, model); }

}  // namespace drogue::springs_app
