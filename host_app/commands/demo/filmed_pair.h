#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "host_app/commands/demo/demo_stage.h"

namespace vantage {

/// Recorded material of one stereo pair: two pictures, folders, patterns such as 'left*.png', or
/// videos.
struct FilmedPair {
    std::filesystem::path left, right;  ///< right "-": both sides in one picture
    std::filesystem::path calibration;  ///< empty: a rectified pair of unknown cameras
    std::optional<int> disparities;
    std::optional<double> rate_hz;
};

/// Runs one of our programs to its end and returns its --json output. Throws Error with the
/// program's own message if it fails.
using AskProgram = std::function<nlohmann::json(const std::string& program,
                                                const std::vector<std::string>& arguments)>;

/// Returns the [source] table of a rig that plays the pair.
toml::table source_of(const FilmedPair& pair, double rate_hz);

/// Adds a rig that plays the pair to the stage. It measures size, rate and depth of the first pair
/// and adapts `size` to them. Returns the text of a flight file for a flight around the scene.
std::string add_filmed_rig(const FilmedPair& pair, const AskProgram& ask, DemoStage& stage,
                           DemoSize& size);

}  // namespace vantage
