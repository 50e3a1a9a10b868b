#include "perf/work_precision/flow_scheme.hpp"

#include <string>

#include "miniapps/parachute/scene/scene.hpp"

namespace drogue::perf {

void FlowScheme::apply(flow::Parameters& p) const {
  p.advection = advection;
  p.time_scheme = time;
  p.pressure_solver = pressure;
  p.diffusion = diffusion;
}

void FlowScheme::describe(Solution& s) const {
  const std::string advection_name = parachute_app::name_of(advection),
                    time_name = parachute_app::name_of(time),
                    diffusion_name = parachute_app::name_of(diffusion),
                    pressure_name = parachute_app::name_of(pressure);
  s.label = advection_name + " " + time_name + " " + pressure_name;
  if (diffusion_name != "explicit") s.label += " " + diffusion_name;
  s.scheme = {{"advection", advection_name},
              {"time_scheme", time_name},
              {"pressure", pressure_name},
              {"diffusion", diffusion_name}};
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
