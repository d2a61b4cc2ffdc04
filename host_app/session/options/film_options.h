#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "host_app/exports/film_export.h"
#include "host_app/session/options/stereoscopic_options.h"

namespace vantage {

/// What `vantage take export --as film` takes.
struct FilmOptions {
    std::string path, rate, size, synthesiser;
    StereoscopicOptions stereoscopic;

    void add_to(CLI::App& command);
    /// One was given; they say nothing of another export.
    bool is_any() const;
    /// Throws Error as film_of(), film_of_cameras() and export_film(). Ctrl-C leaves the
    /// film's parts to go on with, and throws Error then. `has_part`: somebody said which part.
    ExportStats write(const std::filesystem::path& take, const TakePart& part, bool has_part,
                      const std::filesystem::path& file,
                      const std::function<void(double)>& progress) const;
};

}  // namespace vantage
