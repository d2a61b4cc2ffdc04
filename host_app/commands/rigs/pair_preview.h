#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "host_app/commands/demo/demo_stage.h"

namespace vantage {

/// What a real rig filmed: pictures, a folder, 'pattern*.png' or a video a side.
struct FilmedPair {
    std::filesystem::path left, right;  ///< right "-": both sides in one picture
    std::filesystem::path calibration;  ///< empty: a rectified pair of unknown cameras
    std::optional<int> disparities;
    std::optional<double> rate_hz;
};

/// Runs a program of ours to its end and gives what it printed with --json. Throws Error with what
/// it said where it failed.
using AskProgram = std::function<nlohmann::json(const std::string& program,
                                                const std::vector<std::string>& arguments)>;

/// The source that plays the pair.
toml::table source_of(const FilmedPair& pair, double rate_hz);

/// Looks at the first pair to learn how large, how fast and how far away what was filmed is: adds
/// the rig to the stage, adapts `size`, and gives the move to fly before it, as text of a flight
/// file.
std::string add_filmed_rig(const FilmedPair& pair, const AskProgram& ask, DemoStage& stage,
                           DemoSize& size);

}  // namespace vantage
