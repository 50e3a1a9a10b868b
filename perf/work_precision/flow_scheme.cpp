#include "perf/work_precision/flow_scheme.hpp"

#include <string>

#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::perf {

namespace {

const char* name_of(flow::Advection advection) {
  return advection == flow::Advection::central   ? "central"
         : advection == flow::Advection::weno_js ? "weno-js"
                                                 : "weno-z";
}

}  // namespace

void FlowScheme::apply(flow::Parameters& p) const {
  p.advection = advection;
  p.time_scheme = time;
  p.pressure_solver = pressure;
  p.diffusion = diffusion;
}

void FlowScheme::describe(Solution& s) const {
  const std::string time_name = time == flow::TimeScheme::ab2 ? "ab2" : "rk3";
  const bool is_implicit = diffusion == flow::Diffusion::crank_nicolson;
  s.label = std::string(name_of(advection)) + " " + time_name + " " +
            parachute_app::pressure_solver_name(pressure) + (is_implicit ? " crank-nicolson" : "");
  s.scheme = {{"advection", name_of(advection)},
              {"time_scheme", time_name},
              {"pressure", parachute_app::pressure_solver_name(pressure)},
              {"diffusion", is_implicit ? "crank-nicolson" : "explicit"}};
}

std::vector<FlowScheme> flow_schemes(bool quick) {
  using enum flow::PressureSolver;
  std::vector<FlowScheme> schemes;
  for (const flow::Advection advection :
       {flow::Advection::weno_z, flow::Advection::weno_js, flow::Advection::central})
    for (const flow::PressureSolver pressure : {fft, diagonalization, hypre_pfmg}) {
      if (quick && (advection == flow::Advection::weno_js || pressure != fft)) continue;
      // Slow, and its errors are those of the others.
      if (pressure == hypre_pfmg && advection != flow::Advection::weno_z) continue;
      for (const flow::TimeScheme time : {flow::TimeScheme::ab2, flow::TimeScheme::rk3})
        schemes.push_back({advection, time, pressure, flow::Diffusion::explicit_});
      // Implicit diffusion never takes an iterative solver.
      if (pressure != hypre_pfmg)
        schemes.push_back({advection, flow::TimeScheme::ab2, pressure, flow::Diffusion::crank_nicolson});
    }
  return schemes;
}

}  // namespace drogue::perf
