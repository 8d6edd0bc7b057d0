#pragma once

#include <filesystem>
#include <string_view>

#include "output.hpp"

/// Writes a page that shows the bodies moving: one file that a browser opens from the disk.
///
/// Throws : kreisel::InvalidInput; kreisel::ComputationFailed if it cannot be written
void write_view(const Result& result, const std::filesystem::path& place);

/// view.html, in which RUN_AS_JSON is a placeholder for a run.
extern const std::string_view view_page;
