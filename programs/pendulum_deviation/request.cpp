#include "request.hpp"

#include <cmath>
#include <functional>

#include <motor/error.hpp>

#include "../shared/command_line.hpp"
#include "../shared/exit_status.hpp"

using kreisel::InvalidInput;

namespace {

Real number(const std::string& what, const std::string& text) {
  return kreisel::finite_number<Real>(what, text);
}

/// The quantity of the site that an option or a sweep sets.
Real* quantity(kreisel::EarthSite<Real>& place, const std::string& name) {
  if (name == "latitude") return &place.latitude;
  if (name == "azimuth") return &place.azimuth;
  if (name == "height") return &place.height;
  if (name == "rotation-rate") return &place.rotation_rate;
  return nullptr;
}

/// The sites of a sweep "latitude=-90:90:1": from, to and step; the end counts if a step hits it.
std::vector<Site> sweep_sites(const std::string& text, const kreisel::EarthSite<Real>& base,
                              std::string& swept) {
  const auto refuse = [&text](const std::string& why) -> InvalidInput {
    return InvalidInput(fmt::format("--sweep {}: {}", text, why));
  };
  const std::size_t equals = text.find('=');
  const std::size_t first = text.find(':');
  const std::size_t second = text.find(':', first + 1);
  if (equals == std::string::npos || first == std::string::npos || second == std::string::npos) {
    throw refuse("wanted QUANTITY=FROM:TO:STEP, as latitude=-90:90:1");
  }
  swept = text.substr(0, equals);
  kreisel::EarthSite<Real> place = base;
  Real* const value = quantity(place, swept);
  if (value == nullptr) {
    throw refuse("the quantity is none of latitude, azimuth, height, rotation-rate");
  }
  const Real from = number("--sweep from", text.substr(equals + 1, first - equals - 1));
  const Real to = number("--sweep to", text.substr(first + 1, second - first - 1));
  const Real step = number("--sweep step", text.substr(second + 1));
  const Real steps = floor((to - from) / step + 1e-9);
  if (!(steps >= 0) || step == 0) throw refuse("the step does not lead from FROM to TO");
  if (steps > 1'000'000) throw refuse("more than a million steps; make the step longer");

  std::vector<Site> sites;
  const long last = static_cast<long>(steps);
  for (long i = 0; i <= last; ++i) {
    *value = from + static_cast<Real>(i) * step;
    kreisel::check(place);
    sites.push_back({"", place});
  }
  return sites;
}

}  // namespace

std::optional<Request> read_request(int argc, char** argv) {
  CLI::App app(
      "Where a physical pendulum hangs on the rotating earth, how its period changes, and how far "
      "to\n"
      "trust each number. Angles of the site in degrees, all else in SI units and radians.\n");
  app.name("kreisel deviation");
  app.footer(exit_status::help);
  Request request;
  kreisel::PendulumNumbers body;
  kreisel::EarthSite<Real> place;
  place.azimuth = 90;
  std::string gravity = "normal";
  std::string sites;
  std::string sweep;
  std::string csv;
  std::string plot;

  const auto value = [&app](const std::string& option, auto& target, const std::string& help,
                            const std::string& group) {
    return app
        .add_option_function<std::string>(
            option, [&target, option](const std::string& text) { target = number(option, text); },
            help)
        ->type_name("NUMBER")
        ->group(group);
  };
  CLI::Option* const latitude =
      value("--latitude", place.latitude, "degrees, north positive", "Site");
  CLI::Option* const azimuth =
      value("--azimuth", place.azimuth,
            "of the pendulum's axis, degrees from north through east [90: east-west]", "Site");
  CLI::Option* const height = value("--height", place.height, "above the ellipsoid, m [0]", "Site");
  value("--rotation-rate", place.rotation_rate, "rad/s [7.292115e-5]", "Site");
  app.add_option("--gravity", gravity, "'normal' (WGS84 at the site) or m/s^2 [normal]")
      ->type_name("normal|NUMBER")
      ->group("Site");
  app.add_flag("--gravity-gradient", request.gravity_gradient,
               "take in the gradient of normal gravitation over the body")
      ->group("Site");

  const std::string pendulum = "Pendulum (default: --reduced-length 0.5)";
  value("--reduced-length", body.reduced_length, "m: a thin rod with Theta_C/(m a) of this",
        pendulum);
  value("--rod", body.rod, "m: length of a thin rod held at its end", pendulum);
  value("--mass", body.mass, "kg [1]", pendulum);
  value("--arm", body.arm, "m, from the axis to the centre of mass", pendulum);
  value("--theta-a", body.theta_a, "kg m^2, about the pivot, axis A through the centre of mass",
        pendulum);
  value("--theta-b", body.theta_b, "kg m^2, axis B across", pendulum);
  value("--theta-c", body.theta_c, "kg m^2, the pendulum's axis C", pendulum);
  value("--phi-a", body.phi_a, "kg m^2, product of inertia int BC dm [0]", pendulum);
  value("--phi-b", body.phi_b, "kg m^2, int CA dm [0]", pendulum);
  value("--phi-c", body.phi_c, "kg m^2, int AB dm [0]", pendulum);
  value("--amplitude", request.amplitude, "rad, of the finite oscillation [0.1]", pendulum);

  app.add_option("--sites", sites, "a list: columns name, latitude, height, azimuth")
      ->type_name("FILE.csv")
      ->group("Many at once");
  app.add_option("--sweep", sweep,
                 "latitude, azimuth, height or rotation-rate, as latitude=-90:90:1")
      ->type_name("QUANTITY=FROM:TO:STEP")
      ->group("Many at once");

  app.add_flag("--json", request.json, "one JSON object on standard output")->group("Output");
  app.add_option("--csv", csv, "a row per site")->type_name("FILE")->group("Output");
  app.add_option("--plot", plot, "of a sweep or a list, by gnuplot")
      ->type_name("FILE.svg|png")
      ->group("Output");

  if (!command_line::parse(app, argc, argv)) return {};

  request.body = body.body();
  if (gravity != "normal") request.gravity = number("--gravity", gravity);
  if (!csv.empty()) request.csv = csv;
  if (!plot.empty()) {
    request.plot = plot;
    const auto kind = request.plot->extension();
    if (kind != ".svg" && kind != ".png")
      throw InvalidInput("--plot " + plot + ": neither .svg nor .png");
    if (sites.empty() && sweep.empty()) throw InvalidInput("--plot needs --sweep or --sites");
  }

  if (!sites.empty()) {
    if (!sweep.empty() || *latitude || *azimuth || *height) {
      throw InvalidInput("--sites brings latitude, height and azimuth of its own");
    }
    request.mode = Request::Mode::sites;
    request.list = sites;
    request.sites = listed_sites(sites, place.rotation_rate);
  } else if (!sweep.empty()) {
    request.mode = Request::Mode::sweep;
    request.sites = sweep_sites(sweep, place, request.swept);
    if (!*latitude && request.swept != "latitude") throw InvalidInput("--latitude is missing");
  } else {
    if (!*latitude)
      throw InvalidInput("--latitude is missing (or --sites, or --sweep); see --help");
    kreisel::check(place);
    request.sites = {{"", place}};
  }
  return request;
}
