// analyze: equilibria, linear equations, stability and precession check of a scene file.

#include <fmt/core.h>

#include <cstdio>

#include "../shared/exit_status.hpp"
#include "output.hpp"
#include "request.hpp"
#include "response_output.hpp"

using namespace kreisel;
using namespace kreisel::scene_analysis;

namespace {

int run(const Request& request) {
  const kreisel::SceneFile scene = kreisel::read_scene(request.scene, request.solve);
  const kreisel::StudySystem system(with_longer_guide(scene, request));
  const Analysis analysis = analyze(system, scene, request);
  const AnalysisResult result{scene, system, analysis};
  if (request.response_file) write_response(*analysis.response, *request.response_file);
  if (request.state_space) write_state_space(result, *request.state_space);
  if (request.plot) draw(result, *request.plot);
  if (request.json) {
    fmt::print("{}\n", to_json(result).dump(2));
  } else {
    print_summary(result);
  }
  if (std::fflush(stdout) != 0) throw kreisel::ComputationFailed("standard output: not written");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return exit_status::of("analyze", [&] {
    const std::optional<Request> request = read_request(argc, argv);
    return request ? run(*request) : 0;
  });
}
