#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <dynamics/guide/earth.hpp>
#include <motor/double_double_functions.hpp>

/// The number type of inputs: decimals read with its digits count as exact.
using Real = kreisel::DoubleDouble;

struct Site {
  std::string name;  // empty unless the site comes from a list
  kreisel::EarthSite<Real> place;
};

/// A table of sites: columns name, latitude, height, azimuth, in degrees and metres.
///
/// Throws : kreisel::InvalidInput naming file, line and column
[[nodiscard]] std::vector<Site> listed_sites(const std::filesystem::path& file, Real rotation_rate);
