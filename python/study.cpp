#include "study.hpp"

#include <optional>
#include <utility>

#include <dynamics/file/finite_number.hpp>
#include <dynamics/json/analysis.hpp>
#include <dynamics/json/deviation.hpp>

using namespace kreisel;
using namespace kreisel::scene_analysis;

namespace {

/// Inputs have twice the digits of a double, so that decimals count as exact.
using Real = kreisel::DoubleDouble;

/// Computes the analysis and returns what `text_of` makes of it.
template <class TextOf>
std::string with_analysis(const SceneText& text, const AnalysisRequest& request,
                          const std::stop_token& stop, const TextOf& text_of) {
  const SceneFile scene = text.read();
  StudySystem system(with_longer_guide(scene, request));
  system.stop_by(stop);
  const Analysis analysis = kreisel::scene_analysis::analyze(system, scene, request);
  return text_of(AnalysisResult{scene, system, analysis}).dump();
}

}  // namespace

std::string analyze(const SceneText& scene, const AnalysisRequest& request,
                    const std::stop_token& stop) {
  return with_analysis(scene, request, stop,
                       [](const AnalysisResult& result) { return to_json(result); });
}

std::string state_space(const SceneText& scene, const std::stop_token& stop) {
  return with_analysis(scene, {}, stop, state_space_json);
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
  return json_of(pendulum, site, deviation_at(site, pendulum), 0).dump();
}
