#include "sites.hpp"

#include <cstddef>
#include <utility>

#include <dynamics/file/csv.hpp>
#include <dynamics/file/finite_number.hpp>
#include <motor/error.hpp>

std::vector<Site> listed_sites(const std::filesystem::path& file, Real rotation_rate) {
  const auto table = kreisel::CsvTable::read(file, {"name", "latitude", "height", "azimuth"});
  std::vector<Site> sites;
  for (std::size_t row = 0; row < table.size(); ++row) {
    const auto read = [&](const char* column) {
      return kreisel::finite_number<Real>(table.where(row) + ": " + column,
                                          table.text(row, column));
    };
    Site site{table.text(row, "name"),
              {read("latitude"), read("azimuth"), read("height"), rotation_rate}};
    try {
      kreisel::check(site.place);
    } catch (const kreisel::InvalidInput& error) {
      throw kreisel::InvalidInput(table.where(row) + ": " + error.what());
    }
    sites.push_back(std::move(site));
  }
  return sites;
}
