#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>
#include <toml++/toml.h>

#include "common/base/files/embedded_text.h"

namespace vantage {

/// The size of the demo's rigs and of its programme.
struct DemoSize {
    double rate_hz = 25;  ///< pulses per second
    int latency_budget_ms = 200;
    std::string rate = "50", preset = "balanced";  ///< rate: frames per second of the programme
    std::array<int, 2> picture = {1920, 1080}, rig = {960, 720};
    int match_width_px = 0;  ///< of the pictures that the rigs match; 0: that of their colour
    int disparities = 96;
    /// The processor renders everything; the rigs render the stage's loop before they start.
    bool is_software = false;
};

/// GPU time per second that the rigs' matching may take: half, the rest is the host's.
inline constexpr double matching_ms_a_second = 500;

/// Returns the size for a software renderer, at the highest rate that the demo uses there.
DemoSize software_demo_size();

/// Returns the pulses per second that a software renderer keeps up with besides this many rigs.
/// Above that the host skips instants and shows others later. `match_ms` is the time for one pair.
double software_rate_hz(int rigs, double match_ms);

/// Returns the largest size at which the matching of this many rigs leaves half of the GPU's time
/// to the host, or the smallest size. `match_ms` returns the time for one pair of that size.
DemoSize gpu_demo_size(int rigs, const std::function<double(const DemoSize&)>& match_ms);

/// Returns the flight files in hw_config/moves, which are embedded in the program.
std::span<const EmbeddedText> demo_moves();

/// Returns the flight file of this name: demo.toml and sweep.toml fly around the demo's stage,
/// pair.toml flies 2 m before a single pair with a field of view of 30 degrees. Precondition: it
/// exists.
std::string demo_move(std::string_view name);

/// The files of a stage whose rigs are processes on this computer: the host's and each rig's
/// configuration, and keys that are new at every start.
class DemoStage {
  public:
    /// Creates the folder and deletes keys and configurations of an earlier demo in it. `kept` is
    /// the folder for the rigs' own takes; empty: none. Throws Error if it cannot be written.
    DemoStage(std::filesystem::path folder, std::filesystem::path kept);

    /// Adds a rig. `parts` are [source] and the other tables of its configuration.
    void add_rig(const std::string& name, toml::table parts);
    /// Writes the stage file. Call it after the last add_rig().
    void write(const DemoSize& size) const;

    /// Writes a file into the folder.
    void write(const std::string& name, const toml::table& table) const;

    const std::filesystem::path& folder() const { return folder_; }
    std::filesystem::path stage_file() const { return folder_ / "stage.toml"; }
    const std::vector<std::string>& rigs() const { return names_; }
    std::filesystem::path rig_file(const std::string& name) const {
        return folder_ / (name + ".toml");
    }

  private:
    std::filesystem::path folder_, kept_;
    std::vector<std::string> names_;
    toml::array rigs_;
    std::set<int> ports_;  ///< of the rigs
};

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
