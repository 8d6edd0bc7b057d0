#include "study.hpp"

#include <programs/analyze/output.hpp>
#include <programs/analyze/response_output.hpp>
#include <programs/pendulum_deviation/request.hpp>
#include <utility>

#include <dynamics/file/finite_number.hpp>

using namespace kreisel;
using namespace kreisel::scene_analysis;

namespace {

/// Computes the analysis and returns what `text_of` makes of it.
template <class TextOf>
std::string with_analysis(const SceneText& text, const AnalysisRequest& request,
                          const TextOf& text_of) {
  const SceneFile scene = text.read();
  const StudySystem system(with_longer_guide(scene, request));
  const Analysis analysis = kreisel::scene_analysis::analyze(system, scene, request);
  return text_of(Result{scene, system, analysis}).dump();
}

}  // namespace

std::string analyze(const SceneText& scene, const AnalysisRequest& request) {
  return with_analysis(scene, request, [](const Result& result) { return to_json(result); });
}

std::string state_space(const SceneText& scene) {
  return with_analysis(scene, {}, state_space_json);
}

std::string pendulum_deviation(const std::map<std::string, std::string>& options) {
  SitePendulum pendulum;
  PendulumNumbers body;
  EarthSite<Real> site;
  site.azimuth = 90;
  const std::map<std::string, std::optional<Real>*> optional{
      {"reduced_length", &body.reduced_length},
      {"rod", &body.rod},
      {"mass", &body.mass},
      {"arm", &body.arm},
      {"theta_a", &body.theta_a},
      {"theta_b", &body.theta_b},
      {"theta_c", &body.theta_c},
      {"phi_a", &body.phi_a},
      {"phi_b", &body.phi_b},
      {"phi_c", &body.phi_c},
      {"gravity", &pendulum.gravity}};
  const std::map<std::string, Real*> required{{"latitude", &site.latitude},
                                              {"azimuth", &site.azimuth},
                                              {"height", &site.height},
                                              {"rotation_rate", &site.rotation_rate},
                                              {"amplitude", &pendulum.amplitude}};
  for (const auto& [name, text] : options) {
    if (name == "gravity_gradient") {
      pendulum.gravity_gradient = true;
    } else if (const auto at = required.find(name); at != required.end()) {
      *at->second = finite_number<Real>(name, text);
    } else {
      *optional.at(name) = finite_number<Real>(name, text);
    }
  }
  check(site);
  pendulum.body = body.body();
  return to_json(pendulum, Row{deviation_at(site, pendulum), {"", site}, 0}).dump();
}
