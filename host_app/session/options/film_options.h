#pragma once

#include <functional>
#include <string>

#include <CLI/CLI.hpp>

#include "host_app/exports/film_export.h"
#include "host_app/session/options/common_options.h"

namespace vantage {

/// The options of `vantage take export --as film`.
struct FilmOptions {
    std::string path, rate, size, synthesiser;
    StereoscopicOptions stereoscopic;

    void add_to(CLI::App& command);
    /// Whether any of them was given; they do not apply to other exports.
    bool is_any() const;
    /// Renders a film of a part of a take. `has_part` is set if --from or --to was given. Throws
    /// Error as film_of(), film_of_cameras() and export_film() do, and after Ctrl-C; the parts that
    /// are rendered stay, and the next call continues with them.
    ExportStats write(const std::filesystem::path& take, const TakePart& part, bool has_part,
                      const std::filesystem::path& file,
                      const std::function<void(double)>& progress) const;
};

}  // namespace vantage
