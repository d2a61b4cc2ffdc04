#pragma once

#include <cstdio>
#include <string>

#include <CLI/CLI.hpp>
#include <opencv2/core.hpp>

namespace vantage {

/// The word of an option: "WIDTHxHEIGHT", each at least 16.
inline cv::Size size_of(const std::string& text) {
    int width = 0, height = 0;
    if (std::sscanf(text.c_str(), "%dx%d", &width, &height) != 2 || width < 16 || height < 16)
        throw CLI::ValidationError("a size is WIDTHxHEIGHT, each at least 16, not " + text);
    return {width, height};
}

}  // namespace vantage
