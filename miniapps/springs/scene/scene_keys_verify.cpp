#include <algorithm>

#include "common/scene/codec.hpp"
#include "miniapps/springs/scene/scene_keys.hpp"

namespace drogue::springs_app {
namespace {

using scene::between, scene::not_negative, scene::positive, scene::Table;

const scene::Choices<std::string> axis_choices = {{"x", "x"}, {"y", "y"}, {"z", "z"}};

const scene::Choices<FinalQuantity> quantity_choices = {
    {"displacement_x", FinalQuantity::displacement_x}, {"displacement_y", FinalQuantity::displacement_y},
    {"displacement_z", FinalQuantity::displacement_z}, {"von_mises", FinalQuantity::von_mises},
    {"elastic_energy", FinalQuantity::elastic_energy}, {"area_growth", FinalQuantity::area_growth}};

}  // namespace

std::string name_of(FinalQuantity quantity) {
  return std::ranges::find(quantity_choices, quantity, [](const auto& choice) { return choice.second; })
      ->first;
}

void declare_verify(Table& table, Verify& verify) {
  const auto tolerance = [&table](const std::string& name, std::optional<double>& place,
                                  const std::string& help) {
    table.value(name, place, help, {.range = not_negative});
  };
  tolerance(
      "energy_drift", verify.energy_drift,
      "Largest change of the energy in rows of history.csv that passes, over the largest kinetic energy "
      "of a row or of all released energy");
  tolerance("energy_balance", verify.energy_balance,
            "The same after the works of contact and of friction are subtracted; also the largest work that "
            "either returns");
  tolerance("intersections", verify.intersections,
            "Largest number of intersections of cloth with itself or a body that passes, at rows of "
            "history.csv and at the end: 0. Not with a level-set");
  tolerance("penetration", verify.penetration,
            "Largest violation of contact.thickness by a vertex and a body at the end that passes, as a "
            "share of it");
  tolerance("momentum", verify.momentum,
            "Largest change of the momentum in rows of history.csv over the largest sqrt(2 M K) that passes; "
            "M mass, K kinetic "
            "energy as in energy_drift");
  tolerance("angular_momentum", verify.angular_momentum,
            "Largest change of the angular momentum in rows of history.csv over the largest R sqrt(2 M K) "
            "that passes; R extent of the "
            "mesh");
  tolerance("equilibrium", verify.equilibrium,
            "Largest force along a free axis at the end that passes, over the largest reaction or dead load");
  tolerance(
      "young", verify.young,
      "Largest relative error of the apparent modulus of a rectangle or strip pulled along x that passes");
  tolerance("poisson", verify.poisson,
            "Largest difference of the apparent Poisson's ratio from the given one that passes");
  tolerance(
      "hencky", verify.hencky,
      "Largest relative error of the deflection at the centre of a clamped disk under a dead pressure that "
      "passes");
  tolerance("catenary", verify.catenary,
            "Largest distance of a vertex of a hanging string from the elastic catenary, over the span, that "
            "passes");
  tolerance("stretch", verify.stretch,
            "Largest relative error of the stretch of a string that hangs from its first end that passes");
  table.optional_table(
      "frequency", verify.frequency,
      [](Table& t, Frequency& value) {
        t.value("mode",
                [&value] {
                  scene::Codec codec = scene::reals_codec(value.mode, 0, false);
                  codec.type = "array of integers";
                  codec.print = [&value]() -> std::optional<std::string> {
                    if (value.mode.empty()) return std::nullopt;
                    std::string text;
                    for (const double number : value.mode)
                      text +=
                          (text.empty() ? "" : ", ") + scene::toml_text(static_cast<std::int64_t>(number));
                    return "[" + text + "]";
                  };
                  return codec;
                }(),
                "[nodal diameters, circles] of a disk, [number] of the longitudinal mode of a string that is "
                "fixed at its first end",
                {.range = between(0, 1000), .default_text = "none"});
        t.value("value", value.value, "Expected value",
                {.unit = "Hz", .range = positive, .default_text = "closed form of the mode"});
        t.value("tolerance", value.tolerance, "Largest relative error that passes",
                {.range = not_negative, .required = true});
        t.value("probe", value.probe, "Number of the probe, from 0", {.range = between(0, 1e6)});
        t.value("axis", value.axis, axis_choices, "Axis along which it oscillates");
      },
      "The frequency at which a probe oscillates in rows of history.csv");
  table.optional_table(
      "front_speed", verify.front_speed,
      [](Table& t, FrontSpeed& value) {
        t.value("value", value.value, "Expected value", {.unit = "m/s", .range = positive, .required = true});
        t.value("tolerance", value.tolerance, "Largest relative error that passes",
                {.range = not_negative, .required = true});
        t.value("axis", value.axis, axis_choices, "Axis along which the front displaces");
      },
      "The speed of a front between the first two probes, timed at half of their largest displacements in "
      "rows of history.csv");
  table.tables(
      "values", verify.values,
      [](Table& t, FinalValue& value) {
        t.value("quantity", value.quantity, quantity_choices,
                "Displacement (m) or Cauchy's von Mises stress (N/m) of a vertex, the elastic energy (J), or "
                "the "
                "growth of the area of all triangles over that at rest",
                {.required = true});
        t.value("at", optional_vector_codec(value.at),
                "Position at rest, for a quantity of a vertex; the nearest is used", {.unit = "m"});
        t.value("value", value.value, "Expected value, not 0", {.required = true});
        t.value("tolerance", value.tolerance, "Largest relative error that passes",
                {.range = not_negative, .required = true});
      },
      "Values that the final state must have");
  framework::declare_history_checks(table, verify.history);
}

}  // namespace drogue::springs_app
