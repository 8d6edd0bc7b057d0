#pragma once

#include <nlohmann/json.hpp>

#include <dynamics/guide/earth.hpp>
#include <dynamics/pendulum/site_deviation.hpp>

namespace kreisel {

/// The deviation of a pendulum at a site: the object of  pendulum_deviation --json.
///
/// Units : degrees for the site, else SI and radian; run_time in s
[[nodiscard]] nlohmann::ordered_json json_of(const SitePendulum& request,
                                             const EarthSite<DoubleDouble>& site,
                                             const SiteDeviation& found, double run_time);

}  // namespace kreisel
