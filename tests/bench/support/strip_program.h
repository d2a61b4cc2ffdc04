#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "common/image/image_file.h"
#include "tests/bench/support/run_bench.h"

namespace vantage {

/// The whole of a program that writes one strip of pictures for a document, to the file that it is
/// given. `strip`: ColourImage().
template <class Strip>
int run_strip_program(const char* name, const char* summary, int argc, char** argv, Strip strip) {
    return run_bench(name, [&] {
        CLI::App app(summary);
        std::string file;
        app.add_option("picture", file, "Strip to write (.jpg or .png)")->required();
        CLI11_PARSE(app, argc, argv);
        write_colour_image(file, strip());
        return 0;
    });
}

}  // namespace vantage
